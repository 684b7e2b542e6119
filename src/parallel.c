/* A fixed crew of threads that runs independent tasks; results never depend on who ran which. */
#include "src/parallel.h"

#include "src/context.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

struct parallel {
    uint32_t thread_count; /* the caller included */
    uint32_t started;      /* helpers that were really started */
    pthread_t *helpers;

    pthread_mutex_t lock;
    pthread_cond_t work_ready, work_done;
    uint64_t generation; /* of the work on offer; a helper joins each generation once */
    uint32_t busy;       /* helpers still in this generation */
    bool quit;

    parallel_task *task;
    void *data;
    uint32_t task_count;
    atomic_uint next_task;
};

static void run_tasks(parallel *threads) {
    for (;;) {
        uint32_t task = atomic_fetch_add(&threads->next_task, 1);
        if (task >= threads->task_count) return;
        threads->task(threads->data, task);
    }
}

static void *helper_main(void *argument) {
    parallel *threads = argument;
    uint64_t seen = 0;
    pthread_mutex_lock(&threads->lock);
    for (;;) {
        while (threads->generation == seen && !threads->quit)
            pthread_cond_wait(&threads->work_ready, &threads->lock);
        if (threads->quit) break;
        seen = threads->generation;
        pthread_mutex_unlock(&threads->lock);
        run_tasks(threads);
        pthread_mutex_lock(&threads->lock);
        if (--threads->busy == 0) pthread_cond_signal(&threads->work_done);
    }
    pthread_mutex_unlock(&threads->lock);
    return NULL;
}

static cscd_status start_helpers(parallel *threads) {
    for (uint32_t i = 0; i + 1 < threads->thread_count; i++) {
        if (pthread_create(&threads->helpers[i], NULL, helper_main, threads) != 0) return CSCD_SYSTEM_ERROR;
        threads->started++;
    }
    return CSCD_OK;
}

cscd_status parallel_create(cscd_context *context, uint32_t thread_count, parallel **out) {
    if (thread_count == 0) {
        long processors = sysconf(_SC_NPROCESSORS_ONLN);
        thread_count = processors < 1 ? 1 : processors > 256 ? 256 : (uint32_t)processors;
    }
    parallel *threads = context_allocate(context, 1, sizeof *threads);
    if (threads == NULL) return CSCD_OUT_OF_MEMORY;
    threads->thread_count = thread_count;
    pthread_mutex_init(&threads->lock, NULL);
    pthread_cond_init(&threads->work_ready, NULL);
    pthread_cond_init(&threads->work_done, NULL);
    threads->helpers = context_allocate(context, thread_count, sizeof *threads->helpers);
    cscd_status status = threads->helpers != NULL ? start_helpers(threads) : CSCD_OUT_OF_MEMORY;
    if (status != CSCD_OK) {
        parallel_destroy(context, threads);
        return status;
    }
    *out = threads;
    return CSCD_OK;
}

void parallel_destroy(cscd_context *context, parallel *threads) {
    if (threads == NULL) return;
    pthread_mutex_lock(&threads->lock);
    threads->quit = true;
    pthread_cond_broadcast(&threads->work_ready);
    pthread_mutex_unlock(&threads->lock);
    for (uint32_t i = 0; i < threads->started; i++) pthread_join(threads->helpers[i], NULL);
    pthread_cond_destroy(&threads->work_done);
    pthread_cond_destroy(&threads->work_ready);
    pthread_mutex_destroy(&threads->lock);
    context_free(context, threads->helpers);
    context_free(context, threads);
}

uint32_t parallel_thread_count(const parallel *threads) {
    return threads->thread_count;
}

void parallel_run(parallel *threads, uint32_t task_count, parallel_task *task, void *data) {
    if (threads->started == 0 || task_count < 2) {
        for (uint32_t i = 0; i < task_count; i++) task(data, i);
        return;
    }
    pthread_mutex_lock(&threads->lock);
    threads->task = task;
    threads->data = data;
    threads->task_count = task_count;
    atomic_store(&threads->next_task, 0);
    threads->busy = threads->started;
    threads->generation++;
    pthread_cond_broadcast(&threads->work_ready);
    pthread_mutex_unlock(&threads->lock);

    run_tasks(threads);

    pthread_mutex_lock(&threads->lock);
    while (threads->busy != 0) pthread_cond_wait(&threads->work_done, &threads->lock);
    pthread_mutex_unlock(&threads->lock);
}
