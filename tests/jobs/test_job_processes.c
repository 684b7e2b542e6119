/* Jobs in processes: each is taken or fails once, whatever happens to the process of one of them. */
#include "tool/jobs/job_list.h"

#include "tests/support/test.h"
#include "tool/common/terminal.h"

#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { JOBS = 300, WORKERS = 5 };

typedef enum job_fate { FATE_NONE, FATE_KILLED, FATE_CRASH, FATE_EXIT, FATE_LATE, FATE_DEAF } job_fate;

/* What all processes see. */
typedef struct shared_counts {
    atomic_int runs[JOBS];
    atomic_int busy, most_busy, born;
} shared_counts;

typedef struct watched {
    shared_counts *shared;
    unsigned char fates[JOBS]; /* job_fate */
    uint32_t taken[JOBS];
    char reasons[JOBS][200]; /* "": the job was taken */
    uint32_t count;
    uint32_t stop_after; /* takes no more after so many; 0: takes all */
    int signal;          /* sent to this process by the job behind that; 0: none */
    const char *refusal; /* why workers cannot begin; NULL: they can */
    int32_t barren;      /* so many workers are killed before they begin; -1: all */
    bool has_left;       /* in a worker */
} watched;

static watched w;

static void watch_nothing(void) {
    shared_counts *shared = w.shared;
    w = (watched){.shared = shared};
    memset(shared, 0, sizeof *shared);
}

static int share_counts(void **state) {
    (void)state;
    w.shared = mmap(NULL, sizeof *w.shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(w.shared != MAP_FAILED);
    return 0;
}

/* ---- jobs ------------------------------------------------------------------------------------------------ */

static void leave_watched(void *user) {
    ((watched *)user)->has_left = true;
}

static bool begin_watched(void *user, io_error *error) {
    const watched *watch = user;
    const int born = atomic_fetch_add(&watch->shared->born, 1);
    if (watch->barren < 0 || born < watch->barren) raise(SIGKILL);
    if (!watch->has_left) return io_fail(error, "has not left the calling process");
    return watch->refusal == NULL || io_fail(error, "%s", watch->refusal);
}

/* No core dump, and no report of a sanitizer. */
static void crash_quietly(int number) {
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
    signal(number, SIG_DFL);
    raise(number);
}

enum { RUNS_MOST = 5 }; /* of a job that its worker gives up; it would be run again for ever otherwise */

static void meet_fate(job_fate fate, int runs) {
    if (fate == FATE_LATE && runs > RUNS_MOST) _exit(8);
    if (fate == FATE_KILLED) raise(SIGKILL);
    if (fate == FATE_CRASH) crash_quietly(SIGSEGV);
    if (fate == FATE_EXIT) _exit(7);
    while (fate == FATE_LATE && !interrupted()) usleep(1000);
    for (int i = 0; i < 60000 && fate == FATE_DEAF; i++)
        usleep(1000); /* whoever forgets it has no process for ever */
}

/* Some results are empty, and some larger than what a socket holds. */
static size_t size_of(uint32_t job) {
    return job % 7 == 0 ? 0 : job % 50 == 1 ? 700000 : 10 * (size_t)job;
}

static bool run_watched(void *user, uint32_t job, FILE *result) {
    const watched *watch = user;
    shared_counts *shared = watch->shared;
    const int busy = atomic_fetch_add(&shared->busy, 1) + 1;
    if (busy > atomic_load(&shared->most_busy)) atomic_store(&shared->most_busy, busy);
    const int runs = atomic_fetch_add(&shared->runs[job], 1) + 1;
    if (job % 50 == 0) usleep(3000);
    if (watch->signal != 0 && job == watch->stop_after) kill(getppid(), watch->signal);
    atomic_fetch_sub(&shared->busy, 1);
    meet_fate((job_fate)watch->fates[job], runs);
    for (size_t i = 0; i < size_of(job); i++) fputc((int)(job + i) % 251, result);
    return !interrupted();
}

static bool take_watched(void *user, uint32_t job, const char *result, size_t size) {
    watched *watch = user;
    assert_int_equal(watch->taken[job]++, 0);
    assert_int_equal(size, size_of(job));
    for (size_t i = 0; i < size; i++) assert_int_equal((unsigned char)result[i], (job + i) % 251);
    watch->count++;
    return watch->signal != 0 || watch->stop_after == 0 || watch->count < watch->stop_after;
}

static bool fail_watched(void *user, uint32_t job, const char *reason) {
    watched *watch = user;
    assert_int_equal(watch->taken[job]++, 0);
    snprintf(watch->reasons[job], sizeof watch->reasons[job], "%s", reason);
    return true;
}

static bool run_all(uint32_t count, uint32_t workers, double seconds, uint32_t *done, io_error *error) {
    const job_set set = {.count = count,
                         .worker_count = workers,
                         .seconds = seconds,
                         .user = &w,
                         .leave = leave_watched,
                         .begin = begin_watched,
                         .run = run_watched,
                         .take = take_watched,
                         .fail = fail_watched};
    *done = UINT32_MAX;
    const bool ran = jobs_run(&set, done, error);
    assert_false(w.has_left); /* here */
    return ran;
}

/* All jobs have ended once; those with a fate, for its reason. */
static void expect_all(const char *const *reasons) {
    for (uint32_t i = 0; i < JOBS; i++) {
        const char *expected = reasons[w.fates[i]];
        assert_int_equal(w.taken[i], 1);
        if (strncmp(w.reasons[i], expected, strlen(expected)) != 0 ||
            (expected[0] == '\0' && w.reasons[i][0] != '\0'))
            fail_msg("job %u: '%s' instead of '%s'", i, w.reasons[i], expected);
    }
}

/* ---- tests ----------------------------------------------------------------------------------------------- */

TEST(every_job_is_taken_once) {
    for (uint32_t workers = 1; workers <= WORKERS; workers++) {
        uint32_t done;
        io_error error;
        watch_nothing();
        assert_true(run_all(JOBS, workers, 0.0, &done, &error));
        assert_int_equal(done, JOBS);
        expect_all((const char *const[]){""});
        for (uint32_t i = 0; i < JOBS; i++) assert_int_equal(atomic_load(&w.shared->runs[i]), 1);
        assert_true(atomic_load(&w.shared->most_busy) <= (int)workers);
    }
}

TEST(no_jobs_are_done_at_once) {
    uint32_t done;
    io_error error;
    watch_nothing();
    assert_true(run_all(0, 3, 0.0, &done, &error));
    assert_int_equal(done, 0);
}

/* The others are taken all the same, also those that the process of the one would have run. */
TEST(a_process_that_dies_fails_its_job_alone) {
    static const char *const reasons[] = {[FATE_NONE] = "",
                                          [FATE_KILLED] =
                                              "its process was killed by signal 9 (Killed), as the system",
                                          [FATE_CRASH] = "its process was killed by signal 11",
                                          [FATE_EXIT] = "its process ended with code 7"};
    for (uint32_t workers = 1; workers <= 3; workers += 2) {
        uint32_t done;
        io_error error;
        watch_nothing();
        for (uint32_t i = 0; i < JOBS; i += 20) w.fates[i] = (unsigned char)(FATE_KILLED + i / 20 % 3);
        w.fates[JOBS - 1] = FATE_KILLED;
        assert_true(run_all(JOBS, workers, 0.0, &done, &error));
        assert_int_equal(done, JOBS);
        expect_all(reasons);
    }
}

/* One that is told to stop does; one that does not listen is killed. */
TEST(a_job_that_takes_too_long_fails) {
    static const char *const reasons[] = {[FATE_NONE] = "",
                                          [FATE_LATE] = "it took longer than 0.3 s, which is its time limit",
                                          [FATE_DEAF] = "it took longer than 0.3 s, which is its time limit"};
    uint32_t done;
    io_error error;
    interrupt_catch();
    watch_nothing();
    w.fates[0] = w.fates[100] = w.fates[101] = FATE_LATE;
    w.fates[200] = FATE_DEAF;
    assert_true(run_all(JOBS, 2, 0.3, &done, &error));
    assert_int_equal(done, JOBS);
    expect_all(reasons);
}

TEST(a_worker_that_cannot_begin_ends_the_run) {
    uint32_t done;
    io_error error;
    watch_nothing();
    w.refusal = "no threads today";
    assert_false(run_all(JOBS, 3, 0.0, &done, &error));
    assert_string_equal(error.text, "no threads today");
    assert_int_equal(done, 0);
}

/* As the system does when memory is short for a moment, or for good. */
TEST(workers_that_die_at_once_end_the_run) {
    uint32_t done;
    io_error error;
    watch_nothing();
    w.barren = 15;
    assert_true(run_all(JOBS, 2, 0.0, &done, &error));
    assert_int_equal(done, JOBS);
    watch_nothing();
    w.barren = -1;
    assert_false(run_all(JOBS, 2, 0.0, &done, &error));
    assert_int_equal(done, 0);
    assert_non_null(strstr(error.text, "end before they begin one; the last of them was killed by signal 9"));
}

/* As after a full disk. */
TEST(a_result_that_is_not_kept_is_the_last) {
    uint32_t done;
    io_error error;
    watch_nothing();
    w.stop_after = 40;
    assert_true(run_all(JOBS, 2, 0.0, &done, &error));
    assert_true(done >= 40 && done < JOBS);
    uint32_t taken = 0;
    for (uint32_t i = 0; i < JOBS; i++) {
        taken += w.taken[i];
        assert_string_equal(w.reasons[i], "");
    }
    assert_int_equal(taken, done);
}

/* What a killed process leaves running would compute for nobody. */
TEST(workers_die_with_the_process) {
    watch_nothing();
    for (uint32_t i = 0; i < JOBS; i++) w.fates[i] = FATE_DEAF;
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    const pid_t pid = fork();
    if (pid == 0) {
        uint32_t done;
        io_error error;
        run_all(JOBS, 3, 0.0, &done, &error);
        _exit(0);
    }
    close(ends[1]);
    for (int i = 0; i < 20000 && atomic_load(&w.shared->runs[2]) == 0; i++) usleep(1000);
    assert_int_equal(atomic_load(&w.shared->runs[2]), 1);
    kill(pid, SIGKILL);
    waitpid(pid, NULL, 0);
    char byte;
    struct pollfd end = {.fd = ends[0], .events = POLLIN};
    assert_int_equal(poll(&end, 1, 20000), 1); /* nobody is left who could write */
    assert_int_equal(read(ends[0], &byte, 1), 0);
    close(ends[0]);
}

/* The flag of an interrupt stays, so this comes last. */
TEST(an_interrupt_keeps_what_is_done) {
    uint32_t done;
    io_error error;
    signal(SIGINT, SIG_DFL); /* who runs the tests in the background ignores it */
    interrupt_catch();
    watch_nothing();
    w.signal = SIGINT;
    w.stop_after = 100;
    assert_true(run_all(JOBS, WORKERS, 0.0, &done, &error));
    assert_true(interrupted());
    assert_true(done >= 50 && done < JOBS);
    assert_int_equal(done, w.count);
    for (uint32_t i = 0; i < JOBS; i++) assert_string_equal(w.reasons[i], "");
}

AROUND_ALL(share_counts, NULL)
