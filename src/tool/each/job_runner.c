/* Runs many jobs on several threads, and passes on what they found in the order of the jobs. */
#include "src/tool/each/job_runner.h"

#include "src/tool/common/terminal.h"

#include <pthread.h>
#include <stdlib.h>

typedef enum job_state { JOB_WAITING, JOB_DONE, JOB_GIVEN_UP } job_state;

/* What the threads share, under the lock. */
typedef struct job_board {
    const job_set *set;
    pthread_mutex_t lock;
    unsigned char *states; /* a job_state for each job */
    uint32_t next;         /* the first job that nobody has taken */
    uint32_t passed_on;    /* so many jobs from the first on need no more attention */
    uint32_t done;
} job_board;

typedef struct job_worker {
    job_board *board;
    uint32_t index;
    pthread_t thread;
} job_worker;

/* Whoever holds the lock passes on what is done, up to the first job that is not. Jobs are taken in their order, so that
 * the last one to end leaves none behind. */
static void pass_on_results(job_board *board) {
    const job_set *set = board->set;
    for (; board->passed_on < set->count; board->passed_on++) {
        const unsigned char state = board->states[board->passed_on];
        if (state == JOB_WAITING) return;
        if (state == JOB_DONE) set->pass_on(set->user, board->passed_on);
    }
}

static void *work_on_jobs(void *user) {
    const job_worker *worker = user;
    job_board *board = worker->board;
    pthread_mutex_lock(&board->lock);
    while (board->next < board->set->count && !interrupted()) {
        const uint32_t job = board->next++;
        pthread_mutex_unlock(&board->lock);
        const bool done = board->set->run(board->set->user, worker->index, job);
        pthread_mutex_lock(&board->lock);
        board->states[job] = done ? JOB_DONE : JOB_GIVEN_UP;
        board->done += done;
        pass_on_results(board);
    }
    pthread_mutex_unlock(&board->lock);
    return NULL;
}

bool jobs_run(const job_set *set, uint32_t *done, io_error *error) {
    job_board board = {.set = set, .lock = PTHREAD_MUTEX_INITIALIZER};
    job_worker *workers = calloc(set->worker_count, sizeof *workers);
    board.states = calloc((size_t)set->count + 1, 1);
    const bool allocated = workers != NULL && board.states != NULL;
    uint32_t started = 1; /* this thread is the first worker */
    for (uint32_t i = 0; allocated && i < set->worker_count; i++)
        workers[i] = (job_worker){.board = &board, .index = i};
    while (allocated && started < set->worker_count &&
           pthread_create(&workers[started].thread, NULL, work_on_jobs, &workers[started]) == 0)
        started++;
    if (allocated) work_on_jobs(&workers[0]);
    for (uint32_t i = 1; i < started; i++) pthread_join(workers[i].thread, NULL);
    *done = board.done;
    pthread_mutex_destroy(&board.lock);
    free(workers);
    free(board.states);
    return allocated || io_fail(error, "out of memory for %u jobs", set->count);
}
