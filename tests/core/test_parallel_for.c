/* With a parallel loop of the host's own, the context starts no threads and gives the same results. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"
#include "tests/support/workload.h"

#include <dirent.h>
#include <pthread.h>
#include <stdatomic.h>

static sequence q; /* large; one test at a time */

/* A thread that has been joined may be counted for a moment more, so that an earlier count may be too large. */
static uint32_t threads_of_process(void) {
    DIR *folder = opendir("/proc/self/task");
    assert_non_null(folder);
    uint32_t count = 0;
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;) count += entry->d_name[0] != '.';
    closedir(folder);
    return count;
}

/* ---- loops of hosts ------------------------------------------------------------------------------------ */

typedef void task_function(void *data, uint32_t index);

typedef struct host {
    uint32_t runs, tasks, most_threads;
} host;

static void count_run(host *h, uint32_t task_count) {
    h->runs++;
    h->tasks += task_count;
}

/* Runs the tasks backwards on the calling thread. */
static void run_backwards(void *user, uint32_t task_count, task_function *task, void *data) {
    host *h = user;
    count_run(h, task_count);
    uint32_t threads = h->runs % 64 == 1 ? threads_of_process() : 0;
    h->most_threads = threads > h->most_threads ? threads : h->most_threads;
    for (uint32_t i = task_count; i-- > 0;) task(data, i);
}

typedef struct share {
    task_function *task;
    void *data;
    uint32_t task_count;
    atomic_uint next;
} share;

static void *take_tasks(void *argument) {
    share *s = argument;
    for (uint32_t i; (i = atomic_fetch_add(&s->next, 1)) < s->task_count;) s->task(s->data, i);
    return NULL;
}

enum { HOST_THREADS = 3 };

/* Runs the tasks on threads of the host's own, while the calling thread only waits. */
static void run_elsewhere(void *user, uint32_t task_count, task_function *task, void *data) {
    pthread_t threads[HOST_THREADS];
    share s = {.task = task, .data = data, .task_count = task_count};
    count_run(user, task_count);
    for (int i = 0; i < HOST_THREADS; i++) {
        if (pthread_create(&threads[i], NULL, take_tasks, &s) != 0) fail_msg("no thread");
    }
    for (int i = 0; i < HOST_THREADS; i++) pthread_join(threads[i], NULL);
}

/* ---- results ------------------------------------------------------------------------------------------- */

static workload_result run_with(uint32_t thread_count, cscd_parallel_for loop, const workload *w) {
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = thread_count;
    options.parallel_for = loop;
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    workload_result result = workload_run(context, w);
    cscd_context_destroy(context);
    assert_false(result.failed);
    return result;
}

static const uint32_t counts[] = {3, 1, 2, 8};
enum { COUNTS = PACED(4, 1) };

static void compare_loops(const workload *w) {
    static workload_result expected, found;
    expected = run_with(1, (cscd_parallel_for){NULL, NULL}, w);
    for (uint32_t i = 0; i < COUNTS; i++) {
        for (int loop = 0; loop < 3; loop++) {
            host h = {0, 0, 0};
            cscd_parallel_for loops[] = {{NULL, NULL}, {run_backwards, &h}, {run_elsewhere, &h}};
            uint32_t threads = threads_of_process();
            found = run_with(counts[i], loops[loop], w);
            assert_int_equal(found.call_count, expected.call_count);
            assert_memory_equal(found.digests, expected.digests, found.call_count * sizeof *found.digests);
            if (counts[i] > 1) assert_int_equal(h.runs > 0, loop > 0);
            if (loop == 1) assert_true(h.most_threads <= threads);
        }
    }
}

TEST(steps_are_the_same) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_ICCD};
    workload_tube(&q, 36, 18, 5);
    for (uint32_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        workload w = {.sequence = &q, .options = cscd_detector_defaults()};
        w.options.method = method_or_none(methods[i]);
        compare_loops(&w);
    }
}

/* Charges and regions agree bit for bit, because any number of threads factorizes in the same tasks. */
TEST(plans_are_the_same) {
    workload_tube(&q, 36, 18, 1);
    workload w = {.sequence = &q, .plan = CSCD_METHOD_CHARGE, .options = cscd_detector_defaults()};
    assert_true(q.shape.triangle_count > 3 * 256); /* several panels */
    compare_loops(&w);
}

/* ---- the context --------------------------------------------------------------------------------------- */

TEST(thread_count_is_how_work_is_cut) {
    cscd_context *context = NULL;
    host h = {0, 0, 0};
    cscd_context_options options = cscd_context_defaults();
    options.parallel_for = (cscd_parallel_for){run_backwards, &h};
    options.thread_count = 5;
    uint32_t threads = threads_of_process();
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    assert_int_equal(cscd_context_describe(context).thread_count, 5);
    assert_true(threads_of_process() <= threads);
    cscd_context_destroy(context);
    options.thread_count = 0;
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    assert_true(cscd_context_describe(context).thread_count >= 1);
    cscd_context_destroy(context);
    assert_int_equal(h.runs, 0);
}
