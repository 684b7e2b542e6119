/* Lists of pairs and calls that fail: whatever a cancelled call, or one without memory, was about to do, the call that is made
 * again does what it would have done at once. */
#include "runtime/detector/detector.h"
#include "src/core/context.h"
#include "tests/support/calls.h"
#include "tests/support/culling/march.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { INTERVALS = 300, FIRST_LIST = 2, ALLOCATIONS_MAX = 64 };

/* A detector of a march, in a context that may be cancelled or run out of memory. */
typedef struct walker {
    counting_allocator memory;
    int reports_left; /* until a report cancels the call; below 0: none does */
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
} walker;

static bool report_to_walker(void *user, const char *stage, double fraction) {
    walker *w = user;
    (void)stage;
    (void)fraction;
    return w->reports_left < 0 || w->reports_left-- > 0;
}

static void walker_begin(walker *w, const march *m) {
    *w = (walker){.memory = counting_allocator_start(), .reports_left = -1};
    cscd_context_options options = cscd_context_defaults();
    options.allocator = counting_allocator_interface(&w->memory);
    options.progress = (cscd_progress){report_to_walker, w};
    assert_int_equal(cscd_context_create(&options, &w->context), CSCD_OK);
    w->context->progress.interval_ms = 0.0;
    assert_int_equal(cscd_mesh_create(w->context, m->objects, m->object_count, &w->mesh), CSCD_OK);
    cscd_detector_options chosen = cscd_detector_defaults();
    chosen.method = CSCD_METHOD_SINGLE;
    assert_int_equal(detector_create_here(w->mesh, NULL, &chosen, &w->detector), CSCD_OK);
}

static void walker_end(walker *w) {
    cscd_detector_destroy(w->detector);
    cscd_mesh_destroy(w->mesh);
    cscd_context_destroy(w->context);
    assert_int_equal(w->memory.live, 0);
}

typedef struct walked_interval {
    cscd_contacts found;
    cscd_counters counters;
} walked_interval;

static cscd_status walk_once(walker *w, const double *x0, const double *x1, walked_interval *out) {
    cscd_status status = step_packed(w->detector, x0, x1, &out->found);
    if (status == CSCD_OK) out->counters = cscd_detector_counters(w->detector);
    return status;
}

static void assert_same_intervals(const walked_interval *a, const walked_interval *b) {
    assert_int_equal(a->found.count, b->found.count);
    if (a->found.count > 0)
        assert_memory_equal(a->found.items, b->found.items, a->found.count * sizeof *a->found.items);
    assert_memory_equal(&a->counters, &b->counters, sizeof a->counters);
}

static double *make_positions(const march *m) {
    double *x = malloc(m->vertex_count * sizeof(double[3]));
    assert_non_null(x);
    return x;
}

/* Makes a call again until it is not cancelled; returns how often it was. */
static uint32_t walk_at_last(walker *w, const double *x0, const double *x1, walked_interval *out) {
    for (uint32_t cancelled = 0;; cancelled++) {
        w->reports_left = cancelled < 3 && random_integer(0, 1) == 0 ? random_integer(0, 4) : -1;
        cscd_status status = walk_once(w, x0, x1, out);
        w->reports_left = -1;
        if (status == CSCD_OK) return cancelled;
        assert_int_equal(status, CSCD_CANCELLED);
    }
}

/* Two walkers go the same way, and one is stopped now and then, at any report of a call. */
TEST(cancelled_calls_leave_lists_as_they_were) {
    march m = march_make(MARCH_APPROACH);
    double *x0 = make_positions(&m), *x1 = make_positions(&m), s = 0.0;
    uint32_t answered = 0, cancelled = 0, with_contacts = 0;
    walker whole, stopped;
    walker_begin(&whole, &m);
    walker_begin(&stopped, &m);
    march_place(&m, s, x1);
    for (int i = 0; i < INTERVALS; i++) {
        walked_interval expected, found;
        memcpy(x0, x1, m.vertex_count * sizeof(double[3]));
        s += ldexp(0.02, -random_integer(0, 3)) * (i < 2 * INTERVALS / 3 ? 1.0 : -1.0);
        march_place(&m, s, x1);
        assert_int_equal(walk_once(&whole, x0, x1, &expected), CSCD_OK);
        cancelled += walk_at_last(&stopped, x0, x1, &found);
        assert_same_intervals(&found, &expected);
        answered += found.counters.coherent != 0;
        with_contacts += found.found.count > 0;
    }
    printf("%u of %d intervals from lists, %u with contacts, %u calls cancelled\n", answered, INTERVALS,
           with_contacts, cancelled);
    assert_true(answered > 20 && cancelled > 20 && with_contacts > 0);
    walker_end(&whole);
    walker_end(&stopped);
    free(x0);
    free(x1);
    march_free(&m);
}

/* Then what is there may be of two lists. */
TEST(a_list_that_was_replaced_has_ended) {
    for (int replaced = 0; replaced < 2; replaced++) {
        verlet_list v = {.now = {.exists = true, .revision = 7, .served = 5, .was_quiet = true}};
        verlet_list_begin_call(&v);
        v.now = (verlet_state){.exists = true, .revision = 7, .pause = 4};
        v.serving = true;
        v.remade = replaced != 0;
        verlet_list_undo(&v);
        assert_true(v.now.exists && v.now.was_quiet && v.now.served == 5 && v.now.pause == 0 && !v.serving);
        assert_int_equal(v.now.revision == 7, !replaced);
    }
}

/* The first list takes memory. Where an allocation fails, the interval goes the usual way. */
TEST(without_memory_there_is_no_list) {
    march m = march_make(MARCH_APPROACH);
    double *x[FIRST_LIST + 2];
    uint32_t without = 0, failed = 0;
    for (int i = 0; i < FIRST_LIST + 2; i++) {
        x[i] = make_positions(&m);
        march_place(&m, 0.001 * i, x[i]);
    }
    for (size_t at = 0;; at++) {
        walker w;
        walked_interval found = {.found = {.count = 1}};
        assert_true(at < ALLOCATIONS_MAX);
        walker_begin(&w, &m);
        for (int i = 0; i + 1 < FIRST_LIST; i++)
            assert_int_equal(walk_once(&w, x[i], x[i + 1], &found), CSCD_OK);
        w.memory.fail_at = w.memory.calls + at;
        cscd_status status = walk_once(&w, x[FIRST_LIST - 1], x[FIRST_LIST], &found);
        bool reached = w.memory.calls > w.memory.fail_at;
        w.memory.fail_at = SIZE_MAX;
        if (status != CSCD_OK) {
            assert_int_equal(status, CSCD_OUT_OF_MEMORY);
            failed++;
            assert_int_equal(walk_once(&w, x[FIRST_LIST - 1], x[FIRST_LIST], &found), CSCD_OK);
        }
        assert_int_equal(found.found.count, 0);
        without += found.counters.coherent == 0;
        if (!reached) assert_true(found.counters.coherent == 1);
        assert_int_equal(walk_once(&w, x[FIRST_LIST], x[FIRST_LIST + 1], &found), CSCD_OK);
        assert_int_equal(found.found.count, 0);
        walker_end(&w);
        if (!reached) break;
    }
    printf("%u times no list, %u calls failed\n", without, failed);
    assert_true(without > 3);
    for (int i = 0; i < FIRST_LIST + 2; i++) free(x[i]);
    march_free(&m);
}

static int seed_walk(void **state) {
    (void)state;
    random_seed(25);
    return 0;
}

AROUND_EACH(seed_walk, NULL)
