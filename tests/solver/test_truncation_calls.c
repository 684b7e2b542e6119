/* Calls of cscd_detector_truncate: what they refuse, what the detector knows afterwards, and the same for everyone. */
#include "tests/support/calls.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static scene interval; /* large; one test at a time */
static double end[SCENE_VERTICES_MAX * 3];

static void move_triangle(uint32_t which, double by) {
    for (uint32_t i = 3 * which; i < 3 * which + 3; i++) interval.x1[3 * i + 2] = interval.x0[3 * i + 2] + by;
}

/* ---- arguments ------------------------------------------------------------------------------------------- */

TEST(wrong_arguments_are_refused) {
    float floats[18] = {0.0f};
    double short_array[17];
    cscd_truncation out = {.near_count = 4711};
    cscd_displacement_bounds found = {.near_count = 4711};
    scene_two_triangles(&interval, 0.25);
    rig r = rig_apart(&interval, 0.0, CSCD_METHOD_NONE, 1);
    cscd_detector *d = r.detector;
    const cscd_view *x0 = CSCD_DOUBLES(interval.x0, 6), *x1 = CSCD_DOUBLES(interval.x1, 6);
    assert_int_equal(cscd_detector_truncate(NULL, x0, x1, 1.0, NULL, &out), CSCD_NULL_OBJECT);
    expect_invalid(r.context, cscd_detector_truncate(d, x0, x1, 1.0, NULL, NULL), "out is NULL");
    expect_invalid(r.context, cscd_detector_truncate(d, NULL, x1, 1.0, NULL, &out), "x0 is NULL");
    expect_invalid(r.context, cscd_detector_truncate(d, x0, x1, 0.0, NULL, &out), "search_radius is 0");
    expect_invalid(r.context, cscd_detector_truncate(d, x0, x1, NAN, NULL, &out), "search_radius is");
    expect_invalid(r.context, cscd_detector_truncate(d, x0, x1, 0x1p300, NULL, &out), "search_radius is");
    expect_invalid(r.context, cscd_detector_truncate(d, x0, x1, 1.0, CSCD_MUTABLE_FLOATS(floats, 6), &out),
                   "floats in reached");
    expect_invalid(r.context,
                   cscd_detector_truncate(d, x0, x1, 1.0, CSCD_MUTABLE_DOUBLES(short_array, 5), &out),
                   "reached");
    expect_ok(cscd_detector_truncate(d, x0, x1, 1.0, NULL, &out));
    expect_ok(
        cscd_detector_truncate(d, CSCD_FLOATS(floats, 6), x1, 1.0, CSCD_MUTABLE_FLOATS(floats, 6), &out));
    size_t size = 6 * sizeof *short_array;
    const cscd_scalar doubles = CSCD_SCALAR_DOUBLE;
    assert_int_equal(cscd_detector_displacement_bounds(NULL, x0, 1.0, doubles, short_array, size, &found),
                     CSCD_NULL_OBJECT);
    expect_invalid(r.context, cscd_detector_displacement_bounds(d, x0, 1.0, doubles, NULL, size, &found),
                   "bounds is NULL");
    expect_invalid(r.context,
                   cscd_detector_displacement_bounds(d, x0, 1.0, doubles, short_array, size - 1, &found),
                   "bounds has 47 bytes");
    expect_invalid(r.context,
                   cscd_detector_displacement_bounds(d, x0, 1.0, (cscd_scalar)2, short_array, size, &found),
                   "scalar is 2");
    expect_invalid(
        r.context,
        cscd_detector_displacement_bounds(d, x0, 0x1p-200, CSCD_SCALAR_FLOAT, floats, size, &found),
        "0 as a float");
    expect_invalid(r.context,
                   cscd_detector_displacement_bounds(d, x0, -1.0, doubles, short_array, size, &found),
                   "search_radius is -1");
    assert_int_equal(found.near_count, 4711);
    interval.x1[7] = NAN;
    expect_invalid(r.context, cscd_detector_truncate(d, x0, x1, 1.0, NULL, &out), "x1");
    rig_destroy(&r);
}

/* Objects of one scene may be stored differently: each end is a number of its own object's scalar. */
TEST(objects_have_their_own_scalars) {
    static const uint32_t triangle[] = {0, 1, 2};
    float from[9], to[9];
    double reached[9];
    scene_two_triangles(&interval, 0.1);
    cscd_object_desc objects[2] = {cscd_object_of_triangles(3, 1, triangle),
                                   cscd_object_of_triangles(3, 1, triangle)};
    rig r = rig_of_objects(context_of(0, NULL), objects, 2, NULL, NULL);
    for (int i = 0; i < 9; i++) from[i] = (float)interval.x0[i];
    cscd_view x0[2] = {cscd_view_floats(from, 3), cscd_view_doubles(interval.x0 + 9, 3)};
    cscd_mutable_view ends[2] = {cscd_mutable_view_floats(to, 3), cscd_mutable_view_doubles(reached, 3)};
    x0[0].object_count = ends[0].object_count = 1;
    move_triangle(0, 0.31);
    move_triangle(1, -0.17);
    cscd_truncation out;
    expect_ok(cscd_detector_truncate(r.detector, x0, CSCD_DOUBLES(interval.x1, 6), 1.0, ends, &out));
    assert_true(out.shortened == 6 && out.moved);
    for (int i = 2; i < 9; i += 3) {
        double gap = reached[i] - (double)to[i];
        assert_true(gap > 0.0 && gap < 0.1 * 0x1p-10);
        assert_true((double)(float)reached[i] != reached[i]);
    }
    rig_destroy(&r);
}

/* ---- what is known, and the same for everyone ---------------------------------------------------------- */

/* The step from where a truncated motion ended need not prove its start, and finds what a new detector finds. */
TEST(the_end_is_known) {
    for (uint64_t seed = 0; seed < 4; seed++) {
        scene_make(SCENE_BENT_CAPSULE, seed, &interval);
        rig r = rig_apart(&interval, 0.0, CSCD_METHOD_SINGLE, 1);
        cscd_contacts found;
        expect_ok(step_packed(r.detector, interval.x0, interval.x0, &found));
        assert_int_equal(found.count, 0);
        for (int i = 0; i < 3; i++) {
            truncate_scene(&r, &interval, 0.1, CSCD_SCALAR_DOUBLE, end);
            memcpy(interval.x0, end, sizeof end);
        }
        expect_ok(step_packed(r.detector, interval.x0, interval.x1, &found));
        assert_int_equal(cscd_detector_counters(r.detector).static_checks, 0);
        assert_int_equal(cscd_detector_counters(r.detector).clean, interval.triangle_count);
        rig fresh = rig_apart(&interval, 0.0, CSCD_METHOD_SINGLE, 1);
        cscd_contacts again = rig_step(&fresh, &interval);
        assert_int_equal(found.count, again.count);
        for (size_t i = 0; i < found.count; i++)
            assert_memory_equal(&found.items[i], &again.items[i], sizeof *found.items);
        rig_destroy(&r);
        rig_destroy(&fresh);
    }
}

static bool ignore_all(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return user == NULL && (kind == CSCD_CONTACT_VF || a < b);
}

/* Pairs that are left out may pass through each other, so what is near such a pair is checked anew. */
TEST(pairs_left_out_leave_nothing_known) {
    scene_make(SCENE_BENT_CAPSULE, 0, &interval);
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_SINGLE;
    options.ignore = ignore_all;
    rig r = rig_create(&interval, 1, &options);
    cscd_contacts found;
    expect_ok(step_packed(r.detector, interval.x0, interval.x0, &found));
    cscd_truncation out = truncate_scene(&r, &interval, 4.0, CSCD_SCALAR_DOUBLE, end);
    assert_int_equal(out.shortened, 0);
    assert_int_equal(out.near_count, 0);
    memcpy(interval.x0, end, sizeof end);
    expect_ok(step_packed(r.detector, interval.x0, interval.x0, &found));
    assert_true(cscd_detector_counters(r.detector).static_checks > 0);
    rig_destroy(&r);
}

static bool ignore_none(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return user != NULL && kind == CSCD_CONTACT_VF && a == b;
}

/* A detector that may leave pairs out makes a plane for each pair that is near; another one does not where a plane would stop
 * neither side. */
TEST(planes_that_stop_nobody_change_nothing) {
    static double ends[SCENE_VERTICES_MAX * 3];
    size_t shortened = 0, near = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (int n = 0; n < 4; n++) {
            const cscd_scalar scalar = n % 2 == 0 ? CSCD_SCALAR_DOUBLE : CSCD_SCALAR_FLOAT;
            cscd_detector_options options = cscd_detector_defaults();
            options.min_separation = n < 2 ? 0.0 : 0.02;
            scene_make((scene_family)family, (uint64_t)n, &interval);
            rig all = rig_create(&interval, 1, &options);
            cscd_truncation few = truncate_scene(&all, &interval, 0.2, scalar, end);
            memcpy(ends, end, sizeof end);
            rig_destroy(&all);
            options.ignore = ignore_none;
            all = rig_create(&interval, 1, &options);
            cscd_truncation many = truncate_scene(&all, &interval, 0.2, scalar, end);
            assert_memory_equal(ends, end, sizeof end);
            assert_int_equal(few.near_count, many.near_count);
            assert_int_equal(few.held_count, many.held_count);
            assert_int_equal(few.shortened, many.shortened);
            shortened += many.shortened;
            near += many.near_count;
            rig_destroy(&all);
        }
    }
    print_message("  %zu vertices shortened by %zu pairs\n", shortened, near);
    assert_true(shortened > 100 && near > 1000);
}

TEST(truncation_is_the_same_for_all_threads_and_methods) {
    static double first[SCENE_VERTICES_MAX * 3];
    for (uint64_t seed = 0; seed < 4; seed++) {
        scene_make(seed % 2 == 0 ? SCENE_BENT_CAPSULE : SCENE_SOUP, seed, &interval);
        size_t size = (size_t)interval.vertex_count * 3 * sizeof *end;
        for (int i = 0; i < 3; i++) {
            rig r = rig_apart(&interval, 0.01, i == 2 ? CSCD_METHOD_BRUTE : CSCD_METHOD_NONE, i == 1 ? 4 : 1);
            truncate_scene(&r, &interval, 0.2, CSCD_SCALAR_DOUBLE, end);
            if (i == 0)
                memcpy(first, end, size);
            else
                assert_memory_equal(first, end, size);
            rig_destroy(&r);
        }
    }
}
