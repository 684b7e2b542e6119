/* Every allocation of the calls that solvers use fails once, and a steady state allocates nothing. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/methods.h"
#include "tests/support/packed.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static scene interval; /* large; one test at a time */

static const cscd_method methods[] = {CSCD_METHOD_SINGLE, CSCD_METHOD_NONE, CSCD_METHOD_ICCD,
                                      CSCD_METHOD_BRUTE};
enum { METHOD_COUNT = sizeof methods / sizeof *methods };

static const double distance = 0.3;

typedef struct counted {
    counting_allocator counter;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
} counted;

static bool go_on(void *user, const char *stage, double fraction) {
    (void)user;
    (void)stage;
    (void)fraction;
    return true;
}

/* Creates a detector with a progress function, so that a failed call restores what it has changed. */
static void counted_create(counted *c, cscd_method method, uint32_t threads) {
    c->counter = counting_allocator_start();
    cscd_context_options context_options = cscd_context_defaults();
    context_options.allocator = counting_allocator_interface(&c->counter);
    context_options.thread_count = threads;
    context_options.progress.report = go_on;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method_or_none(method);
    cscd_object_desc desc =
        cscd_object_of_triangles(interval.vertex_count, interval.triangle_count, interval.triangles);
    assert_int_equal(cscd_context_create(&context_options, &c->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(c->context, &desc, 1, &c->mesh), CSCD_OK);
    assert_int_equal(detector_create_here(c->mesh, NULL, &options, &c->detector), CSCD_OK);
}

static void counted_destroy(counted *c) {
    cscd_detector_destroy(c->detector);
    cscd_mesh_destroy(c->mesh);
    cscd_context_destroy(c->context);
    assert_int_equal(c->counter.live, 0);
}

/* Makes a spike that goes through the far wall. */
static void make_limited(void) {
    for (uint64_t seed = 1;; seed++) {
        scene_make(SCENE_SPIKE, seed, &interval);
        rig r = rig_create(&interval, 1, NULL);
        size_t count = rig_step(&r, &interval).count;
        rig_destroy(&r);
        if (count > 0) return;
    }
}

/* The results of the calls; a call that fails leaves its part untouched. */
typedef struct solver_answer {
    cscd_free_step step;
    double end[SCENE_VERTICES_MAX * 3];
    size_t near, candidates;
} solver_answer;

typedef cscd_status question(counted *c, solver_answer *out);

static cscd_status ask_near(counted *c, solver_answer *out) {
    cscd_proximities found = {.count = 4711};
    cscd_status status = find_near_packed(c->detector, interval.x0, distance, &found);
    assert_true(status == CSCD_OK || found.count == 4711);
    out->near = found.count;
    return status;
}

/* The same without repetitions, and with lengths at rest. */
static cscd_status ask_unique(counted *c, solver_answer *out) {
    cscd_proximities found = {.count = 4711};
    cscd_status status = set_rest_packed(c->detector, interval.x0);
    if (status == CSCD_OK) status = find_unique_packed(c->detector, interval.x0, distance, &found);
    if (status != CSCD_OK) assert_true(found.count == 4711);
    out->near = found.count;
    return status;
}

static cscd_status ask_max_step(counted *c, solver_answer *out) {
    return max_step_packed(c->detector, interval.x0, interval.x1, out->end, &out->step);
}

static cscd_status ask_bounds(counted *c, solver_answer *out) {
    cscd_displacement_bounds found = {.near_count = 4711};
    cscd_status status = displacement_bounds_packed(c->detector, interval.x0, distance, out->end, &found);
    assert_true(status == CSCD_OK || found.near_count == 4711);
    if (status == CSCD_OK) out->near = found.near_count;
    return status;
}

static cscd_status ask_truncation(counted *c, solver_answer *out) {
    cscd_truncation found = {.near_count = 4711};
    cscd_status status = truncate_packed(c->detector, interval.x0, interval.x1, distance, out->end, &found);
    assert_true(status == CSCD_OK || found.near_count == 4711);
    if (status == CSCD_OK) out->near = found.near_count;
    return status;
}

/* Runs the whole life of a line search. A call that fails is repeated at once, and must then succeed. */
static cscd_status ask_line(counted *c, solver_answer *out) {
    cscd_line_search *line = NULL;
    cscd_proximities found = {.count = 4711};
    cscd_status status = cscd_line_search_create(c->detector, &line), first = status;
    assert_true(status == CSCD_OK || line == NULL);
    if (status != CSCD_OK) return status;
    status = line_begin_packed(line, interval.x0, interval.x1, distance);
    if (status != CSCD_OK) {
        assert_int_equal(line_max_step_packed(line, 1.0, NULL, &out->step), CSCD_INVALID_ARGUMENT);
        assert_int_equal(line_begin_packed(line, interval.x0, interval.x1, distance), CSCD_OK);
        first = status;
    }
    out->candidates = cscd_line_search_candidate_count(line);
    status = cscd_line_search_find_near(line, 0.25, distance, CSCD_NEAR_PAIRS, &found);
    if (status != CSCD_OK) {
        assert_true(found.count == 4711);
        assert_int_equal(cscd_line_search_find_near(line, 0.25, distance, CSCD_NEAR_PAIRS, &found), CSCD_OK);
        first = status;
    }
    out->near = found.count;
    status = line_max_step_packed(line, 1.0, out->end, &out->step);
    cscd_line_search_destroy(line);
    return first == CSCD_OK ? status : first;
}

/* Each allocation fails once; the repeated question then has the usual answer. */
static size_t fail_each(question *ask, cscd_method method, uint32_t threads) {
    static solver_answer good, other;
    size_t failures = 0;
    counted c;
    memset(&good, 0, sizeof good);
    counted_create(&c, method, threads);
    assert_int_equal(ask(&c, &good), CSCD_OK);
    counted_destroy(&c);
    for (bool failed = true; failed; failures += failed) {
        memset(&other, 0, sizeof other);
        counted_create(&c, method, threads);
        c.counter.fail_at = c.counter.calls + failures;
        cscd_status status = ask(&c, &other);
        failed = status != CSCD_OK;
        if (failed) {
            assert_int_equal(status, CSCD_OUT_OF_MEMORY);
            assert_int_equal(ask(&c, &other), CSCD_OK);
        }
        assert_true(other.step.fraction == good.step.fraction && other.near == good.near &&
                    other.candidates == good.candidates);
        assert_memory_equal(other.end, good.end, sizeof good.end);
        counted_destroy(&c);
    }
    return failures;
}

static void memory_may_run_out(void **state) {
    (void)state;
    static question *const questions[] = {ask_near, ask_unique, ask_max_step,
                                          ask_line, ask_bounds, ask_truncation};
    size_t failures = 0;
    make_limited();
    for (size_t q = 0; q < sizeof questions / sizeof *questions; q++) {
        for (int m = 0; m < METHOD_COUNT; m++) failures += fail_each(questions[q], methods[m], 1);
    }
    failures += fail_each(ask_line, CSCD_METHOD_SINGLE, 3);
    print_message("  %zu failures\n", failures);
    assert_true(failures > 100);
}

/* A failed step keeps the known states of the start: the next step checks it once, and no more. */
static void states_outlast_a_failure(void **state) {
    (void)state;
    static double end[SCENE_VERTICES_MAX * 3];
    make_limited();
    bool failed = true;
    for (size_t n = 0; failed; n++) {
        counted c;
        cscd_contacts found;
        cscd_intersections crossing;
        cscd_free_step step;
        counted_create(&c, CSCD_METHOD_SINGLE, 1);
        assert_int_equal(check_packed(c.detector, interval.x0, &crossing), CSCD_OK);
        c.counter.fail_at = c.counter.calls + n;
        failed = max_step_packed(c.detector, interval.x0, interval.x1, end, &step) != CSCD_OK;
        const double *at = failed ? interval.x0 : end;
        c.counter.fail_at = SIZE_MAX;
        assert_int_equal(step_packed(c.detector, at, interval.x1, &found), CSCD_OK);
        assert_true(found.count > 0);
        assert_int_equal(cscd_detector_counters(c.detector).static_checks, 0);
        assert_int_equal(cscd_detector_counters(c.detector).clean, interval.triangle_count);
        counted_destroy(&c);
    }
}

/* The states of one moment are not taken for those of another whose check has failed: a start with
 * intersections is never culled. */
static void a_failed_check_tells_nothing(void **state) {
    (void)state;
    make_limited();
    rig plain = rig_create(&interval, 1, NULL);
    cscd_contacts expected;
    cscd_intersections crossing;
    assert_int_equal(check_packed(plain.detector, interval.x1, &crossing), CSCD_OK);
    assert_true(crossing.count > 0);
    assert_int_equal(step_packed(plain.detector, interval.x1, interval.x0, &expected), CSCD_OK);
    bool failed = true;
    for (size_t n = 0; failed; n++) {
        counted c;
        cscd_contacts found;
        counted_create(&c, CSCD_METHOD_SINGLE, 1);
        assert_int_equal(check_packed(c.detector, interval.x0, &crossing), CSCD_OK);
        c.counter.fail_at = c.counter.calls + n;
        failed = check_packed(c.detector, interval.x1, &crossing) != CSCD_OK;
        c.counter.fail_at = SIZE_MAX;
        assert_int_equal(step_packed(c.detector, interval.x1, interval.x0, &found), CSCD_OK);
        assert_false(cscd_detector_guarantee(c.detector, 0).start_embedded);
        assert_int_equal(found.count, expected.count);
        assert_memory_equal(found.items, expected.items, found.count * sizeof *found.items);
        counted_destroy(&c);
    }
    rig_destroy(&plain);
}

/* Makes one round of calls as a solver does. */
static void ask_all(counted *c, cscd_line_search *line, double *x) {
    static double bounds[SCENE_VERTICES_MAX];
    cscd_free_step step;
    cscd_proximities found;
    cscd_displacement_bounds bounded;
    cscd_truncation truncated;
    memcpy(x, interval.x0, interval.vertex_count * sizeof(double[3]));
    for (int i = 0; i < 6; i++) {
        assert_int_equal(find_near_packed(c->detector, x, distance, &found), CSCD_OK);
        assert_int_equal(find_unique_packed(c->detector, x, distance, &found), CSCD_OK);
        assert_int_equal(max_step_packed(c->detector, x, interval.x1, NULL, &step), CSCD_OK);
        assert_int_equal(displacement_bounds_packed(c->detector, x, distance, bounds, &bounded), CSCD_OK);
        assert_int_equal(truncate_packed(c->detector, x, interval.x1, distance, x, &truncated), CSCD_OK);
        assert_int_equal(line_begin_packed(line, x, interval.x1, distance), CSCD_OK);
        assert_int_equal(cscd_line_search_find_near(line, 0.5, 0.5 * distance, CSCD_NEAR_PAIRS, &found),
                         CSCD_OK);
        assert_int_equal(line_max_step_packed(line, 0.7, x, &step), CSCD_OK);
    }
}

static void steady_state_allocates_nothing(void **state) {
    (void)state;
    static double x[SCENE_VERTICES_MAX * 3];
    make_limited();
    for (int m = 0; m < METHOD_COUNT; m++) {
        counted c;
        cscd_line_search *line = NULL;
        size_t calls = 0;
        counted_create(&c, methods[m], 2);
        assert_int_equal(cscd_line_search_create(c.detector, &line), CSCD_OK);
        for (int round = 0; round < 10; round++) {
            ask_all(&c, line, x);
            if (round == 1) calls = c.counter.calls;
        }
        assert_int_equal(c.counter.calls, calls);
        cscd_line_search_destroy(line);
        counted_destroy(&c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_may_run_out), cmocka_unit_test(states_outlast_a_failure),
        cmocka_unit_test(a_failed_check_tells_nothing), cmocka_unit_test(steady_state_allocates_nothing)};
    return cmocka_run_group_tests_name("solver_memory", tests, NULL, NULL);
}
