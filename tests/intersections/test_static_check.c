/* The static check equals a test of all triangle pairs, each decided exactly, and reports the right
 * states. */
#include "cscd/cscd.h"
#include "runtime/detector/detector.h"
#include "src/mesh/predicates.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/oracle.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <string.h>

static scene s; /* large; one test at a time */
static bool collapsed[SCENE_VERTICES_MAX];

static uint32_t count_zero_area(const scene *shape) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < shape->triangle_count; t++) {
        const uint32_t *v = shape->triangles + (size_t)t * 3;
        count += collinear(shape->x0 + (size_t)v[0] * 3, shape->x0 + (size_t)v[1] * 3,
                           shape->x0 + (size_t)v[2] * 3);
    }
    return count;
}

/* Compares with all pairs; returns how many intersect. */
static size_t compare_with_all_pairs(uint32_t thread_count) {
    rig r = rig_create(&s, thread_count, NULL);
    cscd_intersections found;
    expect_ok(check_packed(r.detector, s.x0, &found));
    size_t next = 0;
    collapsed_oracle(&s, s.x0, NULL, collapsed);
    for (uint32_t a = 0; a < s.triangle_count; a++) {
        for (uint32_t b = a + 1; b < s.triangle_count; b++) {
            if (collapsed[s.triangles[a * 3]] || collapsed[s.triangles[b * 3]]) continue;
            if (!triangles_intersect(s.triangles + (size_t)a * 3, s.triangles + (size_t)b * 3, s.x0))
                continue;
            assert_true(next < found.count);
            assert_int_equal(found.items[next].a, a);
            assert_int_equal(found.items[next].b, b);
            next++;
        }
    }
    assert_int_equal(next, found.count);
    assert_int_equal(found.zero_area_triangles, count_zero_area(&s));
    assert_int_equal(found.first_zero_area == UINT32_MAX, found.zero_area_triangles == 0);
    rig_destroy(&r);
    return next;
}

TEST(equals_all_pairs) {
    uint32_t embedded = 0, crossing = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        uint64_t seeds = family == SCENE_GRID ? 500 : family == SCENE_SOUP ? 60 : 12;
        for (uint64_t seed = 0; seed < seeds; seed++) {
            scene_make((scene_family)family, 1000 + seed, &s);
            size_t pairs = compare_with_all_pairs(1 + (uint32_t)(seed % 3));
            embedded += pairs == 0;
            crossing += pairs > 0;
        }
    }
    print_message("  %u embedded, %u crossing\n", embedded, crossing);
    assert_true(embedded >= 50 && crossing >= 50);
}

static size_t pairs_at(double x, double y, double z) {
    scene_clear(&s);
    scene_add_sphere(&s, (double[3]){0, 0, 0}, 1.0, 5, 8);
    scene_add_sphere(&s, (double[3]){x, y, z}, 1.0, 5, 8);
    return compare_with_all_pairs(1);
}

/* The spheres' poles are exactly at z = centre - 1 and z = centre + 1. */
TEST(touching_counts) {
    assert_true(pairs_at(0, 0, 2.0) > 0);
    assert_int_equal(pairs_at(0, 0, 2.0 + 0x1p-50), 0);
    assert_true(pairs_at(0, 0, 2.0 - 0x1p-50) > 0);
    assert_int_equal(pairs_at(0, 0, 8.0), 0);
}

/* A sheet is folded flat onto itself about its middle, so neighbours across the fold overlap in the plane. */
TEST(flat_folds_count) {
    scene_clear(&s);
    scene_add_sheet(&s, 2.0, 1.0, 2, 1);
    assert_int_equal(compare_with_all_pairs(1), 0);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        if (s.x0[v * 3] > 0) s.x0[v * 3] = -s.x0[v * 3];
    }
    assert_true(compare_with_all_pairs(1) > 0);
}

/* Nothing is proven of a triangle without area, also where it crosses nothing: here it has one corner in common with another. */
TEST(triangles_without_area_are_not_clean) {
    static const uint32_t triangles[] = {0, 1, 2, 0, 3, 4};
    static const double x[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, -2, 0, 0};
    scene_clear(&s);
    s.vertex_count = 5;
    s.triangle_count = 2;
    memcpy(s.triangles, triangles, sizeof triangles);
    memcpy(s.x0, x, sizeof x);
    rig r = rig_create(&s, 1, NULL);
    cscd_intersections found;
    assert_int_equal(check_packed(r.detector, s.x0, &found), CSCD_OK);
    assert_true(found.count == 0 && found.zero_area_triangles == 1 && found.first_zero_area == 1);
    assert_int_equal(start_state_of(r.detector, 1), TRIANGLE_CROSSING);
    assert_true(start_state_of(r.detector, 0) > TRIANGLE_CROSSING);
    rig_destroy(&r);
}

/* Whoever asks is told, whatever has been found by then. */
TEST(cancelled_checks_say_so) {
    scene_clear(&s);
    scene_add_sphere(&s, (double[3]){0, 0, 0}, 1.0, 9, 14);
    rig r = rig_create(&s, 2, NULL);
    cscd_detector *d = r.detector;
    cscd_intersections found;
    assert_int_equal(check_packed(d, s.x0, &found), CSCD_OK);
    assert_int_equal(static_check_all(&d->known.check, &d->space.traversal, &d->space.bvh, s.x0), CSCD_OK);
    cscd_context_cancel(r.context);
    assert_int_equal(static_check_all(&d->known.check, &d->space.traversal, &d->space.bvh, s.x0),
                     CSCD_CANCELLED);
    rig_destroy(&r);
}
