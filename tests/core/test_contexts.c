/* Contexts are independent: several threads of a host, each with one of its own, at the same time. */
#include "cscd/cscd.h"
#include "tests/support/test.h"
#include "tests/support/workload.h"

#include <pthread.h>
#include <stdlib.h>

enum { HOSTS = PACED(3, 3), ROUNDS = PACED(2, 1) };

/* One thread of the host, and what it does with its context. */
typedef struct worker {
    pthread_t thread;
    workload work;
    uint32_t thread_count;
    workload_result result; /* what the last round gave */
} worker;

static cscd_context *make_context(uint32_t thread_count) {
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = thread_count;
    return cscd_context_create(&options, &context) == CSCD_OK ? context : NULL;
}

static void *run_worker(void *argument) {
    worker *w = argument;
    for (int i = 0; i < ROUNDS; i++) {
        cscd_context *context = make_context(w->thread_count);
        w->result = (workload_result){.failed = true};
        if (context != NULL) w->result = workload_run(context, &w->work);
        cscd_context_destroy(context);
    }
    return NULL;
}

/* Runs all workers at once, then each workload alone, and compares what they gave. */
static void compare_with_alone(worker workers[HOSTS]) {
    for (int i = 0; i < HOSTS; i++)
        assert_int_equal(pthread_create(&workers[i].thread, NULL, run_worker, &workers[i]), 0);
    for (int i = 0; i < HOSTS; i++) assert_int_equal(pthread_join(workers[i].thread, NULL), 0);
    for (int i = 0; i < HOSTS; i++) {
        cscd_context *context = make_context(1);
        assert_non_null(context);
        workload_result alone = workload_run(context, &workers[i].work);
        cscd_context_destroy(context);
        assert_false(alone.failed);
        assert_false(workers[i].result.failed);
        assert_int_equal(workers[i].result.call_count, alone.call_count);
        assert_memory_equal(workers[i].result.digests, alone.digests,
                            alone.call_count * sizeof *alone.digests);
    }
}

static worker *make_workers(sequence **shapes) {
    worker *workers = calloc(HOSTS, sizeof *workers);
    *shapes = calloc(HOSTS, sizeof **shapes);
    assert_non_null(workers);
    assert_non_null(*shapes);
    for (int i = 0; i < HOSTS; i++) {
        workers[i].work = (workload){.sequence = &(*shapes)[i], .options = cscd_detector_defaults()};
        workers[i].thread_count = 1 + (uint32_t)i % 2;
    }
    return workers;
}

TEST(steps_and_checks) {
    sequence *shapes;
    worker *workers = make_workers(&shapes);
    for (int i = 0; i < HOSTS; i++) {
        sequence_make(SEQUENCE_SCENE, (uint64_t)i + 7, 12, &shapes[i]);
        workers[i].work.options.method = i == 0 ? CSCD_METHOD_NONE : CSCD_METHOD_SINGLE;
        workers[i].work.plan = i == 2 ? CSCD_METHOD_KMEANS : CSCD_METHOD_AUTO;
    }
    compare_with_alone(workers);
    free(workers);
    free(shapes);
}

TEST(plans_by_charge) {
    sequence *shapes;
    worker *workers = make_workers(&shapes);
    for (int i = 0; i < HOSTS; i++) {
        workload_tube(&shapes[i], 28 + 2 * i, 16, 1);
        workers[i].work.plan = workers[i].work.options.method = CSCD_METHOD_CHARGE;
    }
    compare_with_alone(workers);
    free(workers);
    free(shapes);
}
