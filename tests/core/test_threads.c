/* Each task of a parallel loop runs once, whichever thread does the work. */
#include "src/core/context.h"
#include "tests/support/test.h"

#include <stdatomic.h>
#include <string.h>

enum { COUNTS = 5, TASKS_MAX = 1000 };

static const uint32_t thread_counts[COUNTS] = {1, 2, 3, 8, 16};

typedef struct threads_tally {
    uint32_t runs[TASKS_MAX]; /* written by the thread that has the task */
    atomic_uint total;
} threads_tally;

static void count_task(void *data, uint32_t task) {
    threads_tally *t = data;
    t->runs[task]++;
    atomic_fetch_add(&t->total, 1);
}

/* Runs of all lengths; some follow at once, some after the helper threads have gone to sleep. */
TEST(each_task_runs_once) {
    for (int k = 0; k < COUNTS; k++) {
        cscd_context *context = NULL;
        cscd_context_options options = cscd_context_defaults();
        options.thread_count = thread_counts[k];
        assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
        for (uint32_t count = 0; count < TASKS_MAX; count += 1 + count / 64) {
            static threads_tally t;
            memset(&t, 0, sizeof t);
            parallel_run(context->threads, count, count_task, &t);
            assert_int_equal(atomic_load(&t.total), count);
            for (uint32_t i = 0; i < count; i++) assert_int_equal(t.runs[i], 1);
            for (volatile int i = 0; count % 7 == 0 && i < 200000; i++) {
            }
        }
        cscd_context_destroy(context);
    }
}
