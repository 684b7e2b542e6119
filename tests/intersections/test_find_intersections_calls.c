/* Calls for intersections by kind: caps, pairs that wait, what is known afterwards, calls that are cancelled, lack of
 * memory, and options that are wrong. */
#include "cscd/research.h"
#include "runtime/detector/detector.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/intersections/answer_lists.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static scene s; /* large; one test at a time */

/* ---- caps ------------------------------------------------------------------------------------------------ */

TEST(caps_bound_lists) {
    make_wavy_spheres(0.02, &s);
    rig r = rig_create(&s, 2, NULL);
    size_t all = find_kinds_of(&s, r.detector, CSCD_ANSWER_LIST, 0).count;
    for (size_t beside = 0; beside < 200; beside += 50) {
        cscd_intersections found = {.count = 0};
        expect_ok(cscd_detector_set_longest_list(r.detector, all - 1));
        r.detector->interval.cap.beside = beside;
        assert_int_equal(find_intersections_packed(r.detector, s.x0, NULL, &found), CSCD_LIST_TOO_LONG);
        assert_int_equal(found.count, all);
        assert_int_equal(found.crossing + found.touching, all);
        assert_null(found.items);
        assert_int_equal(find_kinds_of(&s, r.detector, CSCD_ANSWER_COUNT, 0).count, all);
        assert_int_equal(find_kinds_of(&s, r.detector, CSCD_ANSWER_ANY, 0).count, 1);
        found = find_kinds_of(&s, r.detector, CSCD_ANSWER_LIST, 20);
        assert_true(found.stopped && found.count == 20);
        expect_ok(cscd_detector_set_longest_list(r.detector, all / 2));
        cscd_intersection_options options = intersection_options(CSCD_ANSWER_LIST, UINT64_MAX, all - 3);
        assert_int_equal(find_intersections_packed(r.detector, s.x0, &options, &found), CSCD_LIST_TOO_LONG);
        assert_int_equal(found.count, all);
        expect_ok(cscd_detector_set_longest_list(r.detector, all));
        r.detector->interval.cap.beside = beside;
        found = find_kinds_of(&s, r.detector, CSCD_ANSWER_LIST, all + 1);
        assert_false(found.stopped);
        assert_int_equal(compare_with_each_pair(&s, &found), all);
    }
    rig_destroy(&r);
}

/* ---- states ---------------------------------------------------------------------------------------------- */

static void expect_same_knowledge(const rig *a, const rig *b) {
    for (uint32_t t = 0; t < s.triangle_count; t++)
        assert_int_equal(start_state_of(a->detector, t), start_state_of(b->detector, t));
}

/* A whole search tells a later step as much as a check; one that may stop early tells nothing. */
TEST(states_are_known_afterwards) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_intersections plain;
    options.method = CSCD_METHOD_SINGLE;
    make_wavy_spheres(0.02, &s);
    for (uint64_t kinds = 1; kinds < 32; kinds *= 2) {
        rig checked = rig_create(&s, 2, &options), asked = rig_create(&s, 2, &options);
        cscd_intersection_options all = intersection_options(CSCD_ANSWER_COUNT, kinds, 0);
        cscd_intersection_options some = intersection_options(CSCD_ANSWER_LIST, kinds, SIZE_MAX);
        cscd_intersections found;
        expect_ok(find_intersections_packed(asked.detector, s.x0, &some, &found));
        expect_same_knowledge(&checked, &asked);
        expect_ok(check_packed(checked.detector, s.x0, &plain));
        expect_ok(find_intersections_packed(asked.detector, s.x0, &all, &found));
        expect_same_knowledge(&checked, &asked);
        assert_int_equal(start_state_of(asked.detector, 0) == TRIANGLE_UNKNOWN, false);
        rig_destroy(&checked);
        rig_destroy(&asked);
    }
}

/* ---- pairs that wait --------------------------------------------------------------------------------------- */

/* Triangles 0 and 1 cross, 1 and 2 are duplicates. */
static void make_trio(double height) {
    static const double x[] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, 1, 1, -1, 3, 1, 0};
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5, 4, 5, 3};
    scene_clear(&s);
    s.vertex_count = 6;
    s.triangle_count = 3;
    memcpy(s.triangles, triangles, sizeof triangles);
    memcpy(s.x0, x, sizeof x);
    for (uint32_t v = 3; v < 6; v++) s.x0[v * 3 + 2] += height;
}

static void expect_trio(cscd_detector *detector, size_t crossing, size_t duplicate, size_t waiting) {
    cscd_intersections found = find_kinds_of(&s, detector, CSCD_ANSWER_LIST, 0);
    assert_int_equal(found.count, crossing + duplicate);
    assert_int_equal(found.crossing, crossing);
    assert_int_equal(found.duplicate, duplicate);
    assert_int_equal(cscd_detector_waiting(detector).triangles, waiting);
    for (size_t i = 0; i < found.count; i++)
        assert_int_equal(found.items[i].kind == CSCD_INTERSECTION_DUPLICATE, found.items[i].a == 1);
}

TEST(waiting_pairs_are_left_out) {
    static const uint32_t ignored[][2] = {{1, 0}, {0, 2}, {2, 1}};
    make_trio(0.0);
    rig r = rig_create(&s, 2, NULL);
    expect_trio(r.detector, 2, 1, 0);
    expect_ok(cscd_detector_set_ignored(r.detector, ignored[0], 3));
    expect_trio(r.detector, 0, 0, 0);
    expect_ok(cscd_detector_set_ignored(r.detector, NULL, 0));
    expect_trio(r.detector, 0, 1, 2); /* a duplicate never comes apart, so it does not wait */
    make_trio(5.0);
    expect_trio(r.detector, 0, 1, 0);
    make_trio(0.0);
    expect_trio(r.detector, 2, 1, 0);
    rig_destroy(&r);
}

/* What is known afterwards does not depend on duplicates. */
TEST(duplicates_mark_nothing) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_intersections plain;
    options.method = CSCD_METHOD_SINGLE;
    make_trio(5.0);
    rig checked = rig_create(&s, 1, &options), asked = rig_create(&s, 1, &options);
    expect_ok(check_packed(checked.detector, s.x0, &plain));
    assert_int_equal(plain.count, 0);
    expect_trio(asked.detector, 0, 1, 0);
    assert_true(start_state_of(asked.detector, 1) != TRIANGLE_CROSSING);
    expect_same_knowledge(&checked, &asked);
    rig_destroy(&checked);
    rig_destroy(&asked);
}

/* A seam may even unite two corners of one triangle: nothing is refused. */
TEST(odd_seams_are_taken) {
    static const uint32_t seams[][2] = {{3, 4}, {4, 0}};
    cscd_detector_options options = cscd_detector_defaults();
    make_trio(0.0);
    options.seams = seams[0];
    options.seam_count = 2;
    options.seam_reach = INFINITY;
    rig r = rig_create(&s, 1, &options);
    cscd_intersections found = find_kinds_of(&s, r.detector, CSCD_ANSWER_LIST, 0);
    assert_int_equal(found.duplicate, 1);
    assert_true(found.items[0].a == 0 && found.items[0].shared == 1); /* corner 0, with two of the other */
    const cscd_intersection *last = &found.items[found.count - 1];
    assert_true(last->a == 1 && last->b == 2 && last->kind == CSCD_INTERSECTION_DUPLICATE &&
                last->shared == 3);
    cscd_intersections plain;
    expect_ok(check_packed(r.detector, s.x0, &plain));
    assert_int_equal(plain.count, found.count - 1);
    rig_destroy(&r);
}

/* ---- options --------------------------------------------------------------------------------------------- */

static void expect_refused(cscd_detector *detector, cscd_intersection_options options, const char *sentence) {
    cscd_intersections found = {.count = 4711};
    assert_int_equal(find_intersections_packed(detector, s.x0, &options, &found), CSCD_INVALID_ARGUMENT);
    assert_non_null(strstr(cscd_context_detail(cscd_mesh_context(cscd_detector_mesh(detector))), sentence));
    assert_int_equal(found.count, 4711);
}

TEST(wrong_options_are_refused) {
    cscd_intersections found;
    make_trio(0.0);
    rig r = rig_create(&s, 1, NULL);
    expect_refused(r.detector, intersection_options((cscd_intersection_answer)3, UINT64_MAX, 0),
                   "unknown answer 3");
    expect_refused(r.detector, intersection_options(CSCD_ANSWER_LIST, 0, 0), "no kind");
    expect_refused(r.detector, intersection_options(CSCD_ANSWER_LIST, ~UINT64_C(31), 0), "no kind");
    expect_refused(r.detector, (cscd_intersection_options){.struct_size = 0}, "cscd_intersection_defaults");
    assert_int_equal(find_intersections_packed(r.detector, s.x0, NULL, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(find_intersections_packed(r.detector, NULL, NULL, &found), CSCD_INVALID_ARGUMENT);
    assert_int_equal(find_intersections_packed(NULL, NULL, NULL, NULL), CSCD_NULL_OBJECT);
    assert_string_equal(cscd_intersection_kind_name(CSCD_INTERSECTION_FOLDED), "folded");
    assert_string_equal(cscd_intersection_kind_name((cscd_intersection_kind)5), "unknown");
    assert_int_equal(cscd_intersection_set(CSCD_INTERSECTION_TOUCHING), 16);
    rig_destroy(&r);
}
