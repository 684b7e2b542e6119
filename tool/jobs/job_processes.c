/* Processes that take jobs from a board in shared memory, and send their results through sockets. */
#include "tool/jobs/job_list.h"

#include "tool/common/terminal.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#ifdef __linux__
#include <sys/prctl.h>
#endif

/* macOS lacks it; the tool ignores SIGPIPE anyway. */
#ifndef MSG_NOSIGNAL
#define MSG_NOSIGNAL 0
#endif

enum {
    NO_JOB = -1,
    WAKE_MS = 200,   /* a signal may come just before the wait for results */
    GRACE_MS = 5000, /* that a job has to close its files after its time is over */
    BARREN_MAX = 20  /* workers in a row that die before they have taken a job */
};

/* The state of a worker; its successor goes on with it. */
typedef struct job_slot {
    atomic_llong job;      /* runs now; NO_JOB: none */
    atomic_llong again;    /* comes first: it was given up for another's sake; NO_JOB: none */
    atomic_llong begun_ms; /* when the job began */
} job_slot;

/* Shared by all processes. */
typedef struct job_board {
    atomic_llong next; /* the first job that nobody has taken */
    job_slot slots[];
} job_board;

typedef enum message_kind { MESSAGE_DONE, MESSAGE_FAILED, MESSAGE_GIVEN_UP, MESSAGE_REFUSED } message_kind;

/* Comes before `size` bytes: the result, or why there is none. */
typedef struct job_message {
    int64_t job;
    uint64_t size;
    uint32_t kind;
} job_message;

typedef struct job_worker {
    pid_t pid;       /* 0: none runs */
    int socket;      /* to it, or in it to the calling process */
    int64_t late;    /* this job has been told to stop; NO_JOB: none */
    int64_t stop_ms; /* when that was */
} job_worker;

typedef struct job_pool {
    const job_set *set;
    job_board *board;
    job_worker *workers;
    unsigned char *ended; /* per job: it was taken, or has failed */
    struct pollfd *polled;
    uint32_t done;
    uint32_t barren; /* workers that have died without a job since the last job ended */
    bool stopping;   /* no further job begins */
    char *result;    /* of the message read last */
    size_t result_size;
    io_error refusal; /* "": none */
} job_pool;

static int64_t now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* ---- in a worker --------------------------------------------------------------------------------------- */

static bool send_bytes(int socket, const void *bytes, size_t size) {
    const char *at = bytes;
    while (size > 0) {
        const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0) return false;
        at += sent;
        size -= (size_t)sent;
    }
    return true;
}

static bool send_message(int socket, message_kind kind, int64_t job, const char *text, size_t size) {
    const job_message message = {.job = job, .size = size, .kind = kind};
    return send_bytes(socket, &message, sizeof message) && send_bytes(socket, text, size);
}

static int64_t take_job(const job_pool *pool, job_slot *slot) {
    const int64_t again = atomic_exchange(&slot->again, NO_JOB);
    if (again != NO_JOB) return again;
    const int64_t job = atomic_fetch_add(&pool->board->next, 1);
    return job < pool->set->count ? job : NO_JOB;
}

/* False: nobody takes the result. */
static bool work_on_job(const job_pool *pool, int socket, uint32_t job) {
    char *text = NULL;
    size_t size = 0;
    FILE *result = open_memstream(&text, &size);
    const bool done = result != NULL && pool->set->run(pool->set->user, job, result);
    if (result == NULL || ferror(result) || fclose(result) != 0 || text == NULL) {
        static const char reason[] = "out of memory for its result";
        return send_message(socket, MESSAGE_FAILED, job, reason, sizeof reason - 1);
    }
    const bool sent =
        send_message(socket, done ? MESSAGE_DONE : MESSAGE_GIVEN_UP, job, text, done ? size : 0);
    free(text);
    return sent;
}

static bool work_on_jobs(const job_pool *pool, uint32_t worker) {
    job_slot *slot = &pool->board->slots[worker];
    const int socket = pool->workers[worker].socket;
    io_error error = {""};
    pool->set->leave(pool->set->user);
    if (!pool->set->begin(pool->set->user, &error)) {
        send_message(socket, MESSAGE_REFUSED, NO_JOB, error.text, strlen(error.text));
        return true;
    }
    while (!interrupted()) {
        const int64_t job = take_job(pool, slot);
        if (job == NO_JOB) return true;
        atomic_store(&slot->begun_ms, now_ms());
        atomic_store(&slot->job, job);
        if (!work_on_job(pool, socket, (uint32_t)job)) return false;
        atomic_store(&slot->job, NO_JOB);
    }
    return true;
}

/* Who stops a whole group of processes signals a worker as well as the process that then tells it to stop: it
 * closes its files all the same. Ends without writing what the calling process has left in its buffers. */
static _Noreturn void be_worker(const job_pool *pool, uint32_t worker, pid_t parent) {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if (getppid() != parent) _exit(EXIT_FAILURE);
    interrupt_outlast();
    for (uint32_t i = 0; i < pool->set->worker_count; i++)
        if (i != worker && pool->workers[i].pid != 0) close(pool->workers[i].socket);
    _exit(work_on_jobs(pool, worker) ? EXIT_SUCCESS : EXIT_FAILURE);
}

/* ---- workers that come and go ---------------------------------------------------------------------------- */

static bool start_worker(job_pool *pool, uint32_t worker) {
    int sockets[2];
    const pid_t parent = getpid();
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, sockets) != 0) return false;
    fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0) {
        close(sockets[0]);
        pool->workers[worker].socket = sockets[1];
        be_worker(pool, worker, parent);
    }
    close(sockets[1]);
    if (pid < 0) {
        close(sockets[0]);
        return false;
    }
    pool->workers[worker] = (job_worker){.pid = pid, .socket = sockets[0], .late = NO_JOB};
    return true;
}

static bool jobs_left(const job_pool *pool, uint32_t worker) {
    return !pool->stopping && (atomic_load(&pool->board->next) < pool->set->count ||
                               atomic_load(&pool->board->slots[worker].again) != NO_JOB);
}

static void end_job(job_pool *pool, uint32_t job, const char *reason) {
    const job_set *set = pool->set;
    if (pool->ended[job]) return;
    pool->ended[job] = 1;
    pool->done++;
    pool->barren = 0;
    const bool kept = reason == NULL ? set->take(set->user, job, pool->result, pool->result_size)
                                     : set->fail(set->user, job, reason);
    if (!kept) pool->stopping = true;
}

static void fail_late_job(job_pool *pool, uint32_t job) {
    char reason[100];
    snprintf(reason, sizeof reason, "it took longer than %g s, which is its time limit", pool->set->seconds);
    end_job(pool, job, reason);
}

/* Did the worker give the job up, or was it told to stop for the sake of another? */
static bool job_comes_again(const job_worker *w, const job_slot *slot, int64_t job) {
    return atomic_load(&slot->again) == job || (w->late != NO_JOB && w->late != job);
}

enum { DEATH_TEXT_SIZE = 200 };

/* "killed by signal 11 (Segmentation fault)" */
static void describe_death(int status, char text[DEATH_TEXT_SIZE]) {
    const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (number == SIGKILL)
        snprintf(text, DEATH_TEXT_SIZE,
                 "was killed by signal 9 (Killed), as the system does when memory is short");
    else if (number != 0)
        snprintf(text, DEATH_TEXT_SIZE, "was killed by signal %d (%s)", number, strsignal(number));
    else
        snprintf(text, DEATH_TEXT_SIZE, "ended with code %d", WEXITSTATUS(status));
}

/* A worker that dies before it has taken a job would be started again and again. */
static void count_barren(job_pool *pool, int status) {
    char death[DEATH_TEXT_SIZE];
    if (status == 0 || ++pool->barren < BARREN_MAX || pool->stopping) return;
    describe_death(status, death);
    io_fail(&pool->refusal, "the processes for the jobs end before they begin one; the last of them %s",
            death);
    pool->stopping = true;
}

/* The process has ended by itself, or was killed; its job has no result then. */
static void bury_worker(job_pool *pool, uint32_t worker) {
    job_worker *w = &pool->workers[worker];
    job_slot *slot = &pool->board->slots[worker];
    int status = 0;
    close(w->socket); /* who still wants to send ends then */
    while (waitpid(w->pid, &status, 0) < 0 && errno == EINTR) continue;
    int64_t job = atomic_exchange(&slot->job, NO_JOB);
    if (job != NO_JOB && pool->ended[job]) job = NO_JOB; /* its result came just before */
    if (job != NO_JOB && job == w->late)
        fail_late_job(pool, (uint32_t)job);
    else if (job != NO_JOB && job_comes_again(w, slot, job))
        atomic_store(&slot->again, job);
    else if (job != NO_JOB && !pool->stopping) {
        char death[DEATH_TEXT_SIZE], reason[DEATH_TEXT_SIZE + 20];
        describe_death(status, death);
        snprintf(reason, sizeof reason, "its process %s", death);
        end_job(pool, (uint32_t)job, reason);
    } else if (job == NO_JOB)
        count_barren(pool, status);
    w->pid = 0;
}

/* ---- messages ------------------------------------------------------------------------------------------ */

static bool receive_bytes(int socket, void *bytes, size_t size) {
    char *at = bytes;
    while (size > 0) {
        const ssize_t received = recv(socket, at, size, 0);
        if (received < 0 && errno == EINTR) continue;
        if (received <= 0) return false;
        at += received;
        size -= (size_t)received;
    }
    return true;
}

/* False: the worker is no more. */
static bool receive_message(job_pool *pool, int socket, job_message *message) {
    if (!receive_bytes(socket, message, sizeof *message)) return false;
    char *room = realloc(pool->result, message->size + 1);
    if (room == NULL) return false;
    pool->result = room;
    pool->result_size = message->size;
    room[message->size] = '\0';
    return receive_bytes(socket, room, message->size);
}

/* A job is given up by a worker that was told to stop: because it was late itself, or the job before it
 * was. */
static void hear_given_up(job_pool *pool, uint32_t worker, int64_t job) {
    if (pool->workers[worker].late == job)
        fail_late_job(pool, (uint32_t)job);
    else
        atomic_store(&pool->board->slots[worker].again, job);
}

static void hear_worker(job_pool *pool, uint32_t worker) {
    job_message message;
    if (!receive_message(pool, pool->workers[worker].socket, &message))
        bury_worker(pool, worker);
    else if (message.kind == MESSAGE_REFUSED) {
        io_fail(&pool->refusal, "%s", pool->result);
        pool->stopping = true;
    } else if (message.kind == MESSAGE_GIVEN_UP)
        hear_given_up(pool, worker, message.job);
    else
        end_job(pool, (uint32_t)message.job, message.kind == MESSAGE_FAILED ? pool->result : NULL);
}

/* ---- time limits --------------------------------------------------------------------------------------- */

/* A job that is late is told to stop, so that it closes its files; if it does not, it is killed. */
static void watch_worker(job_pool *pool, uint32_t worker, int64_t now) {
    job_worker *w = &pool->workers[worker];
    job_slot *slot = &pool->board->slots[worker];
    if (w->late != NO_JOB) {
        if (now - w->stop_ms > GRACE_MS) kill(w->pid, SIGKILL);
        return;
    }
    const int64_t job = atomic_load(&slot->job), begun = atomic_load(&slot->begun_ms);
    if (job == NO_JOB || (double)(now - begun) <= 1e3 * pool->set->seconds || atomic_load(&slot->job) != job)
        return;
    w->late = job;
    w->stop_ms = now;
    kill(w->pid, SIGTERM);
}

static void stop_workers(job_pool *pool) {
    pool->stopping = true;
    for (uint32_t i = 0; i < pool->set->worker_count; i++)
        if (pool->workers[i].pid != 0) kill(pool->workers[i].pid, SIGTERM);
}

/* ---- the pool ------------------------------------------------------------------------------------------ */

/* Waits for messages, but not beyond the next look at the clock. */
static uint32_t await_workers(job_pool *pool) {
    uint32_t running = 0;
    for (uint32_t i = 0; i < pool->set->worker_count; i++) {
        const job_worker *w = &pool->workers[i];
        pool->polled[i] = (struct pollfd){.fd = w->pid != 0 ? w->socket : -1, .events = POLLIN};
        running += w->pid != 0;
    }
    if (running > 0 && poll(pool->polled, pool->set->worker_count, WAKE_MS) <= 0)
        for (uint32_t i = 0; i < pool->set->worker_count; i++) pool->polled[i].revents = 0;
    return running;
}

static void run_pool(job_pool *pool) {
    bool told = false;
    while (await_workers(pool) > 0) {
        for (uint32_t i = 0; i < pool->set->worker_count; i++)
            if (pool->polled[i].revents != 0) hear_worker(pool, i);
        if (interrupted()) pool->stopping = true;
        if (pool->stopping && !told) stop_workers(pool);
        told = pool->stopping;
        for (uint32_t i = 0; i < pool->set->worker_count; i++) {
            if (pool->workers[i].pid != 0 && pool->set->seconds > 0.0) watch_worker(pool, i, now_ms());
            if (pool->workers[i].pid == 0 && jobs_left(pool, i)) start_worker(pool, i);
        }
    }
}

static bool start_pool(job_pool *pool, io_error *error) {
    const uint32_t count = pool->set->worker_count;
    uint32_t started = 0;
    for (uint32_t i = 0; i < count; i++) {
        job_slot *slot = &pool->board->slots[i];
        atomic_init(&slot->job, NO_JOB);
        atomic_init(&slot->again, NO_JOB);
    }
    for (uint32_t i = 0; i < count; i++) started += start_worker(pool, i);
    return started > 0 || io_fail(error, "the system starts no process for the jobs: %s", strerror(errno));
}

/* A process may be killed between taking a job and saying so. */
static void fail_lost_jobs(job_pool *pool) {
    const int64_t taken = atomic_load(&pool->board->next);
    for (uint32_t i = 0; i < pool->set->count && i < taken && !pool->stopping; i++)
        end_job(pool, i, "its process was killed before it began");
}

bool jobs_run(const job_set *set, uint32_t *done, io_error *error) {
    const size_t board_size = sizeof(job_board) + set->worker_count * sizeof(job_slot);
    job_pool pool = {.set = set,
                     .workers = calloc(set->worker_count, sizeof *pool.workers),
                     .polled = calloc(set->worker_count, sizeof *pool.polled),
                     .ended = calloc((size_t)set->count + 1, 1)};
    void *shared = mmap(NULL, board_size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    bool good = (pool.workers != NULL && pool.polled != NULL && pool.ended != NULL && shared != MAP_FAILED) ||
                io_fail(error, "out of memory for %u jobs", set->count);
    pool.board = shared;
    void (*const before)(int) = signal(SIGCHLD, SIG_DFL); /* else nobody learns how a process ended */
    good = good && start_pool(&pool, error);
    if (good) {
        run_pool(&pool);
        fail_lost_jobs(&pool);
        if (!pool.stopping && pool.done < set->count)
            io_fail(&pool.refusal, "the system starts no further process for the jobs; %u of %u ran",
                    pool.done, set->count);
        good = pool.refusal.text[0] == '\0' || io_fail(error, "%s", pool.refusal.text);
    }
    if (before != SIG_ERR) signal(SIGCHLD, before);
    *done = pool.done;
    if (shared != MAP_FAILED) munmap(shared, board_size);
    free(pool.workers);
    free(pool.polled);
    free(pool.ended);
    free(pool.result);
    return good;
}
