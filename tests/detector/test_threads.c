/* Contacts and counters are the same, bit for bit, for any number of threads, whichever thread does the
 * work. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "src/core/context.h"
#include "tests/support/methods.h"
#include "tests/support/packed.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { INTERVALS = 4, COUNTS = 5, TASKS_MAX = 1000 };

static const uint32_t thread_counts[COUNTS] = {1, 2, 3, 8, 16};

static scene s; /* large; one test at a time */

/* ---- a body large enough for several threads ----------------------------------------------------------- */

/* A tube along z whose wall moves in waves, and whose upper part comes down on the lower one. */
static void tube_at(const scene *tube, double time, double *out) {
    for (uint32_t v = 0; v < tube->vertex_count; v++) {
        const double *x = tube->x0 + (size_t)v * 3;
        double bend = 1.2 * time * x[2], wave = 1.0 + 0.1 * sin(3.0 * x[2] + 5.0 * time);
        out[v * 3] = wave * x[0] * cos(bend) + (1.0 - cos(bend)) * 1.5;
        out[v * 3 + 1] = wave * x[1];
        out[v * 3 + 2] = x[2] + sin(bend) * (1.5 - x[0]) - 0.8 * time * x[2];
    }
}

typedef struct outcome {
    cscd_contact *contacts;
    size_t count;
    cscd_counters counters;
} outcome;

/* Runs the intervals one after the other, on a tube whose rest shape is in s. */
static void run_intervals(uint32_t thread_count, const cscd_detector_options *options,
                          outcome out[INTERVALS]) {
    static double x[INTERVALS + 1][SCENE_VERTICES_MAX * 3];
    rig r = rig_create(&s, thread_count, options);
    for (int i = 0; i <= INTERVALS; i++) tube_at(&s, 0.3 * i, x[i]);
    for (int i = 0; i < INTERVALS; i++) {
        cscd_contacts found;
        assert_int_equal(step_packed(r.detector, x[i], x[i + 1], &found), CSCD_OK);
        out[i].count = found.count;
        out[i].counters = cscd_detector_counters(r.detector);
        out[i].contacts = malloc((found.count + 1) * sizeof *found.items);
        assert_non_null(out[i].contacts);
        if (found.count > 0) memcpy(out[i].contacts, found.items, found.count * sizeof *found.items);
    }
    rig_destroy(&r);
}

static void discard_outcomes(outcome of[INTERVALS]) {
    for (int i = 0; i < INTERVALS; i++) free(of[i].contacts);
}

static size_t compare_methods(const cscd_detector_options *options) {
    outcome expected[INTERVALS], found[INTERVALS];
    size_t contacts = 0;
    run_intervals(1, options, expected);
    for (int k = 1; k < COUNTS; k++) {
        run_intervals(thread_counts[k], options, found);
        for (int i = 0; i < INTERVALS; i++) {
            assert_int_equal(found[i].count, expected[i].count);
            assert_memory_equal(found[i].contacts, expected[i].contacts,
                                found[i].count * sizeof *found[i].contacts);
            assert_memory_equal(&found[i].counters, &expected[i].counters, sizeof found[i].counters);
            contacts += found[i].count;
        }
        discard_outcomes(found);
    }
    discard_outcomes(expected);
    return contacts;
}

static void every_method_gives_the_same(void **state) {
    (void)state;
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_ICCD,
                                          CSCD_METHOD_ICCD_PUBLISHED, CSCD_METHOD_BRUTE};
    scene_clear(&s);
    scene_add_capsule(&s, 6.0, 0.5, 44, 22);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        cscd_detector_options options = cscd_detector_defaults();
        options.method = method_or_none(methods[i]);
        assert_true(compare_methods(&options) > 0);
    }
}

static void separation_gives_the_same(void **state) {
    (void)state;
    cscd_detector_options options = cscd_detector_defaults();
    scene_clear(&s);
    scene_add_capsule(&s, 6.0, 0.5, 30, 16);
    options.min_separation = 0.01;
    assert_true(compare_methods(&options) > 0);
}

/* ---- the helper threads -------------------------------------------------------------------------------- */

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
static void each_task_runs_once(void **state) {
    (void)state;
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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_method_gives_the_same),
                                       cmocka_unit_test(separation_gives_the_same),
                                       cmocka_unit_test(each_task_runs_once)};
    return cmocka_run_group_tests_name("threads", tests, NULL, NULL);
}
