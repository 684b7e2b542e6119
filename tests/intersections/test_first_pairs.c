/* The first pairs of triangles that intersect are the same for any number of threads, and the search ends there. */
#include "runtime/detector/detector.h"
#include "tests/support/calls.h"
#include "tests/support/intersections/answer_lists.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { REPETITIONS = 2 };

static scene s; /* large; one test at a time */

static bool ignore_a_third(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    (void)user;
    return kind == CSCD_CONTACT_TT && (a + b) % 3 == 0;
}

static void compare_first_pairs(bool ignores) {
    static cscd_intersection before[1000];
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = ignores ? ignore_a_third : NULL;
    rig rigs[4];
    for (uint32_t threads = 1; threads <= 4; threads++) rigs[threads - 1] = rig_create(&s, threads, &options);
    for (size_t stop_after = 1; stop_after <= 1000; stop_after = stop_after * 3 - stop_after / 2) {
        for (uint32_t threads = 1; threads <= 4; threads++) {
            cscd_detector *detector = rigs[threads - 1].detector;
            cscd_intersections found = find_kinds_of(&s, detector, CSCD_ANSWER_LIST, stop_after);
            if (threads == 1) memcpy(before, found.items, found.count * sizeof *before);
            assert_true(found.stopped || stop_after > 300);
            assert_int_equal(found.count == stop_after, found.stopped);
            assert_memory_equal(before, found.items, found.count * sizeof *before);
            for (size_t i = 0; i < found.count && ignores; i++)
                assert_true((found.items[i].a + found.items[i].b) % 3 != 0);
            assert_int_equal(find_kinds_of(&s, detector, CSCD_ANSWER_ANY, stop_after).count, 1);
        }
    }
    for (int i = 0; i < 4; i++) rig_destroy(&rigs[i]);
}

TEST(first_pairs_are_the_same) {
    make_wavy_spheres(0.02, &s);
    rig r = rig_create(&s, 3, NULL);
    cscd_intersections found = find_kinds_of(&s, r.detector, CSCD_ANSWER_LIST, 0);
    assert_true(compare_with_each_pair(&s, &found) > 300);
    rig_destroy(&r);
    compare_first_pairs(false);
    compare_first_pairs(true);
}

enum {
    GRID_SIDE = 120,
    GRID = GRID_SIDE * GRID_SIDE,
    GRID_TRIANGLES = 2 * (GRID_SIDE - 1) * (GRID_SIDE - 1)
};

/* Two sheets that cross in nearly every triangle of some patches, so that some tasks have pairs enough, and others of the
 * same size none. */
static cscd_detector *make_sheets(cscd_context *context, uint32_t patches, double *x) {
    uint32_t *triangles = malloc(sizeof *triangles * 3 * GRID_TRIANGLES), count = 0;
    for (uint32_t v = 0; v < 2 * GRID; v++) {
        bool upper = v >= GRID;
        x[3 * v] = v % GRID / GRID_SIDE + (upper ? 0.3 : 0.0);
        x[3 * v + 1] = v % GRID_SIDE + (upper ? 0.2 : 0.0);
        bool crossing = (v % GRID / GRID_SIDE / 15 * 5 + v % GRID_SIDE / 15 * 3 + patches) % 7 == 0;
        x[3 * v + 2] = (v * 7 + upper) % 5 * 0.3 + (upper && !crossing ? 1.3 : 0.0);
    }
    for (uint32_t i = 0; i + 1 < GRID_SIDE; i++) {
        for (uint32_t j = 0; j + 1 < GRID_SIDE; j++) {
            uint32_t k = i * GRID_SIDE + j;
            uint32_t both[6] = {k, k + GRID_SIDE, k + 1, k + 1, k + GRID_SIDE, k + GRID_SIDE + 1};
            memcpy(triangles + 3 * (size_t)count, both, sizeof both);
            count += 2;
        }
    }
    const cscd_object_desc sheet = cscd_object_of_triangles(GRID, GRID_TRIANGLES, triangles);
    const cscd_object_desc sheets[2] = {sheet, sheet};
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    expect_ok(cscd_mesh_create(context, sheets, 2, &mesh));
    expect_ok(cscd_detector_create(context, mesh, NULL, NULL, &detector));
    cscd_mesh_destroy(mesh);
    free(triangles);
    return detector;
}

/* Whichever thread is first, and though threads leave tasks that others have made needless. */
TEST(first_pairs_do_not_depend_on_luck) {
    static const size_t stops[] = {1, 30, 100, 300};
    static double x[2 * GRID * 3];
    static cscd_intersection before[4][300];
    for (uint32_t i = 0; i < 4 * REPETITIONS; i++) {
        cscd_context_options context_options = cscd_context_defaults();
        cscd_context *context = NULL;
        cscd_intersections found;
        context_options.thread_count = 1 + i % 4;
        expect_ok(cscd_context_create(&context_options, &context));
        cscd_detector *detector = make_sheets(context, i / 4, x);
        detector->space.traversal.tasks_wanted = 60;
        for (int k = 0; k < PACED(16, 4); k++) {
            cscd_intersection_options options =
                intersection_options(CSCD_ANSWER_LIST, UINT64_MAX, stops[k % 4]);
            expect_ok(find_intersections_packed(detector, x, &options, &found));
            assert_int_equal(found.count, stops[k % 4]);
            if (i % 4 == 0) memcpy(before[k % 4], found.items, found.count * sizeof *found.items);
            assert_memory_equal(before[k % 4], found.items, found.count * sizeof *found.items);
        }
        cscd_detector_destroy(detector);
        cscd_context_destroy(context);
    }
}

/* The first pair ends the search: with one thread few boxes are compared. */
TEST(searches_end_early) {
    make_wavy_spheres(0.02, &s);
    rig r = rig_create(&s, 1, NULL);
    find_kinds_of(&s, r.detector, CSCD_ANSWER_LIST, 0);
    uint64_t all = traversal_boxes_tested(&r.detector->space.traversal);
    find_kinds_of(&s, r.detector, CSCD_ANSWER_ANY, 0);
    assert_true(traversal_boxes_tested(&r.detector->space.traversal) * 2 < all);
    find_kinds_of(&s, r.detector, CSCD_ANSWER_COUNT, 10);
    assert_true(traversal_boxes_tested(&r.detector->space.traversal) * 2 < all);
    rig_destroy(&r);
    make_wavy_spheres(3.0, &s);
    r = rig_create(&s, 1, NULL);
    assert_int_equal(find_kinds_of(&s, r.detector, CSCD_ANSWER_ANY, 0).count, 0);
    rig_destroy(&r);
}
