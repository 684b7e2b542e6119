/* Every allocation fails once without a leak, and a steady state allocates nothing. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/methods.h"
#include "tests/support/packed.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static scene s; /* large; one test at a time */

/* The result of a run of the whole library. */
typedef struct memory_outcome {
    cscd_status status;
    size_t contacts, intersections;
} memory_outcome;

static cscd_status use_detector(cscd_detector *detector, memory_outcome *out) {
    cscd_contacts contacts = {.count = 4711};
    cscd_intersections crossing = {.count = 4711};
    cscd_status status = step_packed(detector, s.x0, s.x1, &contacts);
    assert_true(status == CSCD_OK || contacts.count == 4711);
    if (status != CSCD_OK) return status;
    out->contacts = contacts.count;
    status = check_packed(detector, s.x1, &crossing);
    assert_true(status == CSCD_OK || crossing.count == 4711);
    out->intersections = crossing.count;
    return status;
}

/* Runs everything from the context to a step and a check. After a failure for lack of memory the same
 * objects are used once more, and must then succeed. */
static memory_outcome run_library(counting_allocator *counter, uint32_t thread_count, cscd_method method) {
    memory_outcome out = {CSCD_OK, 0, 0};
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.allocator = counting_allocator_interface(counter);
    options.thread_count = thread_count;
    cscd_plan_options plan_options = cscd_plan_defaults();
    plan_options.method = CSCD_METHOD_KMEANS;
    plan_options.k = 2;
    cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    out.status = cscd_context_create(&options, &context);
    if (out.status == CSCD_OK) out.status = cscd_mesh_create(context, &desc, 1, &mesh);
    if (out.status == CSCD_OK) out.status = plan_create_packed(mesh, s.x0, &plan_options, &plan);
    cscd_detector_options detector_options = cscd_detector_defaults();
    detector_options.method = method;
    if (out.status == CSCD_OK) out.status = detector_create_here(mesh, plan, &detector_options, &detector);
    if (out.status == CSCD_OK) {
        out.status = use_detector(detector, &out);
        if (out.status == CSCD_OUT_OF_MEMORY) {
            assert_non_null(strstr(cscd_context_detail(context), "out of memory"));
            assert_int_equal(use_detector(detector, &out), CSCD_OK);
        }
    } else {
        assert_true(out.status == CSCD_OUT_OF_MEMORY);
    }
    assert_true(context == NULL || cscd_context_bytes(context) == counter->bytes);
    cscd_detector_destroy(detector);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    assert_int_equal(counter->live, 0);
    assert_int_equal(counter->bytes, 0);
    return out;
}

static void fail_each(scene_family family, uint64_t seed, uint32_t thread_count, cscd_method method) {
    scene_make(family, seed, &s);
    counting_allocator counter = counting_allocator_start();
    memory_outcome good = run_library(&counter, thread_count, method);
    assert_int_equal(good.status, CSCD_OK);
    size_t calls = counter.calls, compared = 0;
    assert_true(calls > 20 && good.contacts > 0);
    for (size_t n = 0; n < calls; n++) {
        counter = counting_allocator_start();
        counter.fail_at = n;
        memory_outcome failed = run_library(&counter, thread_count, method);
        assert_int_equal(failed.status, CSCD_OUT_OF_MEMORY);
        if (failed.contacts == 0) continue; /* failed before there was a detector */
        assert_int_equal(failed.contacts, good.contacts);
        assert_int_equal(failed.intersections, good.intersections);
        compared++;
    }
    assert_true(compared > 0);
    print_message("  %zu allocations, %zu while the detector was used\n", calls, compared);
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    fail_each(SCENE_TWO_SPHERES, 3, 1, CSCD_METHOD_AUTO);
    fail_each(SCENE_FOLDED_SHEET, 7, 1, CSCD_METHOD_AUTO);
    fail_each(SCENE_SOUP, 11, 1, CSCD_METHOD_AUTO);
    fail_each(SCENE_BOW_TIE, 3, 3, CSCD_METHOD_AUTO);
    fail_each(SCENE_TWO_SPHERES, 3, 1, method_or_none(CSCD_METHOD_ICCD));
    fail_each(SCENE_FOLDED_SHEET, 7, 3, method_or_none(CSCD_METHOD_ICCD));
    fail_each(SCENE_SOUP, 11, 1, method_or_none(CSCD_METHOD_ICCD_PUBLISHED));
}

static void expect_steady_state(cscd_method method) {
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.allocator = counting_allocator_interface(&counter);
    options.thread_count = 2;
    cscd_detector_options detector_options = cscd_detector_defaults();
    detector_options.method = method;
    scene_make(SCENE_NESTED_SPHERES, 2, &s);
    cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    memory_outcome out;
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(detector_create_here(mesh, NULL, &detector_options, &detector), CSCD_OK);
    for (int i = 0; i < 8; i++) /* a change of what is culled allocates, too */
        assert_int_equal(use_detector(detector, &out), CSCD_OK);
    size_t calls = counter.calls;
    for (int i = 0; i < 20; i++) assert_int_equal(use_detector(detector, &out), CSCD_OK);
    assert_int_equal(counter.calls, calls);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}

static void steady_state_allocates_nothing(void **state) {
    (void)state;
    expect_steady_state(CSCD_METHOD_AUTO);
    expect_steady_state(method_or_none(CSCD_METHOD_ICCD));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_allocation_may_fail),
                                       cmocka_unit_test(steady_state_allocates_nothing)};
    return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
