/* Jobs on several threads: each is done once, by one worker at a time, and passed on in order, also after an interrupt. */
#include "src/tool/each/job_runner.h"

#include "src/tool/common/terminal.h"
#include "tests/support/test.h"

#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

enum { JOBS = 400, WORKERS = 5, STOP_AT = 150, NOBODY = -1 };

typedef struct watched {
    atomic_int busy[WORKERS]; /* jobs that run with this worker now */
    atomic_int runs[JOBS], passing;
    uint32_t passed_on[JOBS], passed_count;
    int stop_at;   /* this job interrupts the program; */
    bool gives_up; /* and has no result then */
} watched;

/* The first job and every fiftieth one take long, so that those behind them are done before. */
static bool watch_run(void *user, uint32_t worker, uint32_t job) {
    watched *w = user;
    assert_true(worker < WORKERS);
    assert_int_equal(atomic_fetch_add(&w->busy[worker], 1), 0);
    atomic_fetch_add(&w->runs[job], 1);
    if (job % 50 == 0) usleep(3000);
    const bool stops = (int)job == w->stop_at;
    if (stops) raise(SIGINT);
    atomic_fetch_sub(&w->busy[worker], 1);
    return !(stops && w->gives_up);
}

static void watch_pass_on(void *user, uint32_t job) {
    watched *w = user;
    assert_int_equal(atomic_fetch_add(&w->passing, 1), 0);
    assert_int_equal(atomic_load(&w->runs[job]), 1);
    w->passed_on[w->passed_count++] = job;
    atomic_fetch_sub(&w->passing, 1);
}

static uint32_t run_watched(watched *w, uint32_t workers) {
    const job_set set = {
        .count = JOBS, .worker_count = workers, .user = w, .run = watch_run, .pass_on = watch_pass_on};
    io_error error;
    uint32_t done = UINT32_MAX;
    assert_true(jobs_run(&set, &done, &error));
    assert_int_equal(done, w->passed_count);
    for (uint32_t i = 1; i < w->passed_count; i++) assert_true(w->passed_on[i - 1] < w->passed_on[i]);
    for (uint32_t i = 0; i < JOBS; i++) assert_true(atomic_load(&w->runs[i]) <= 1);
    return done;
}

static void every_job_is_passed_on_once_and_in_order(void **state) {
    (void)state;
    for (uint32_t workers = 1; workers <= WORKERS; workers++) {
        watched w = {.stop_at = NOBODY};
        assert_int_equal(run_watched(&w, workers), JOBS);
    }
}

static void no_jobs_are_done_at_once(void **state) {
    (void)state;
    watched w = {.stop_at = NOBODY};
    const job_set set = {.worker_count = 3, .user = &w, .run = watch_run, .pass_on = watch_pass_on};
    io_error error;
    uint32_t done = UINT32_MAX;
    assert_true(jobs_run(&set, &done, &error));
    assert_int_equal(done, 0);
}

/* The flag of an interrupt stays, so this comes last. A job that was given up leaves a gap, and what others have done
 * behind it is passed on all the same. */
static void an_interrupt_keeps_what_is_done(void **state) {
    (void)state;
    interrupt_catch();
    watched w = {.stop_at = STOP_AT, .gives_up = true};
    const uint32_t done = run_watched(&w, WORKERS);
    assert_true(done >= STOP_AT && done < JOBS);
    uint32_t ran = 0;
    for (uint32_t i = 0; i < JOBS; i++) ran += (uint32_t)atomic_load(&w.runs[i]);
    assert_int_equal(done, ran - 1);
    for (uint32_t i = 0; i < done; i++) assert_int_not_equal(w.passed_on[i], STOP_AT);
    watched later = {.stop_at = NOBODY};
    assert_int_equal(run_watched(&later, 2), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_job_is_passed_on_once_and_in_order),
        cmocka_unit_test(no_jobs_are_done_at_once),
        cmocka_unit_test(an_interrupt_keeps_what_is_done),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
