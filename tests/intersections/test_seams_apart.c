/* Seams whose vertices are apart: for curves, patches, overlaps and depths such vertices are two, as the surfaces lie. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static body_rig rig, other; /* large; one test at a time */

static const double INNER[3] = {1.25, 1.5, 1.125}, SIZES[3] = {2, 2, 2};

/* Two cubes whose corners overlap. Corner 7 of the first one, at (2, 2, 2), is in the second one, whose corner 0 is in the
 * first one. */
static void add_cubes(body_rig *r) {
    static const double low[3] = {0, 0, 0};
    body_rig_begin(r);
    body_rig_box(r, low, SIZES);
    body_rig_box(r, INNER, SIZES);
}

static void create_with_seams(const uint32_t (*seams)[2], size_t count) {
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = seams[0];
    options.seam_count = count;
    options.seam_reach = (double)INFINITY;
    body_rig_create(&rig, &options, 1);
}

static void expect_cubes(const cscd_intersections *found) {
    double x = 0.75, y = 0.5, z = 0.875, faces = x * y + y * z + z * x;
    assert_int_equal(found->curves->count, 1);
    assert_true(found->curves->items[0].closed);
    assert_int_equal(found->curves->items[0].piece_count, other.found.curves->items[0].piece_count);
    assert_int_equal(found->overlaps->count, 1);
    assert_true(fabs(found->overlaps->items[0].area_a - faces) <= 1e-12);
    assert_true(fabs(found->overlaps->items[0].area_b - faces) <= 1e-12);
    assert_true(fabs(found->overlaps->items[0].volume - x * y * z) <= 1e-12);
}

/* What a seam leaves out is pairs whose features that meet have vertices of it, and here there are none. */
static void expect_as_without(const uint32_t (*seams)[2], size_t count) {
    add_cubes(&other);
    body_rig_create(&other, NULL, 1);
    body_rig_find(&other);
    add_cubes(&rig);
    create_with_seams(seams, count);
    body_rig_find(&rig);
    assert_int_equal(rig.found.count, other.found.count);
    expect_cubes(&rig.found);
    assert_int_equal(rig.found.depths->count, other.found.depths->count);
    assert_int_equal(rig.found.patches->count, other.found.patches->count);
}

TEST(a_seam_across_a_body) {
    static const uint32_t far[][2] = {{0, 7}}, many[][2] = {{0, 7}, {7, 1}, {1, 6}};
    expect_as_without(far, 1);
    expect_as_without(many, 3);
}

TEST(a_seam_between_bodies) {
    static const uint32_t far[][2] = {{0, 15}}, near[][2] = {{0, 8}};
    expect_as_without(far, 1);
    expect_as_without(near, 1);
}

/* A seam along an edge of a triangle does not make the triangle a line. */
TEST(a_seam_along_an_edge) {
    static const uint32_t seams[][2] = {{7, 6}, {8, 9}, {9, 10}};
    expect_as_without(seams, 3);
}

/* Of three vertices of one seam, the second and the third are at one place, and these are one: there the curve of two open
 * triangles ends, at a vertex that both have. The first one is in a triangle far away. */
TEST(those_at_one_place_are_one) {
    static const double places[9][3] = {{9, 9, 9},  {0, 0, 0}, {0, 0, 0}, {9, 8, 9}, {0, 1, 1},
                                        {0, 1, -1}, {9, 9, 8}, {1, 2, 0}, {-1, 2, 0}};
    static const uint32_t triangles[3][3] = {{0, 3, 6}, {1, 4, 5}, {2, 7, 8}}, seams[][2] = {{0, 1}, {0, 2}};
    body_rig_begin(&rig);
    memcpy(rig.all.x0, places, sizeof places);
    memcpy(rig.all.triangles, triangles, sizeof triangles);
    rig.all.vertex_count = 9;
    rig.all.triangle_count = 3;
    body_rig_end_body(&rig);
    create_with_seams(seams, 2);
    for (int round = 0; round < 2; round++) {
        body_rig_find(&rig);
        assert_int_equal(rig.found.curves->count, 1);
        const cscd_curve *curve = &rig.found.curves->items[0];
        bool at_vertex = curve->start == CSCD_CURVE_END_VERTEX || curve->end == CSCD_CURVE_END_VERTEX;
        assert_int_equal(at_vertex, round == 0);
        rig.all.x0[3 * 2 + 1] = -0.5; /* then they part, and the curve has two borders */
    }
}

/* A seam that makes a point of an edge leaves its two triangles without area, and their neighbours are neighbours of each
 * other: the curve goes on there. */
TEST(an_edge_that_is_a_point) {
    static const uint32_t seams[][2] = {{6, 7}};
    add_cubes(&rig);
    add_cubes(&other);
    memcpy(rig.all.x0 + 3 * 6, rig.all.x0 + 3 * 7, sizeof(double[3]));
    memcpy(other.all.x0 + 3 * 6, other.all.x0 + 3 * 7, sizeof(double[3]));
    create_with_seams(seams, 1);
    body_rig_create(&other, NULL, 1);
    body_rig_find(&rig);
    body_rig_find(&other);
    const cscd_curves *curves = rig.found.curves;
    for (size_t i = 0; i < curves->count; i++) assert_true(curves->items[i].closed);
    double volume = body_rig_overlap(&rig, 0, 1).volume;
    assert_true(volume > 0.1 && fabs(volume - body_rig_overlap(&other, 0, 1).volume) <= 1e-12);
}

/* Two triangles that are sewn together along x = 0, or three, and a blade through them. The pairs of the blade with all but
 * the first are ignored: its curve ends at the seam, where it would go on, or where three triangles meet. */
TEST(a_pair_is_left_out_at_a_seam) {
    static const double corners[4][3] = {{-2, 1, 0}, {2, 1, 0}, {0, 1, -2}, {0, 0, 0}};
    static const double blade[3][3] = {{-1, 1.25, -1}, {1, 1.25, -1}, {0, 1.25, 2}};
    static const uint32_t seams[4][2] = {{0, 3}, {1, 4}, {0, 6}, {1, 7}};
    for (uint32_t sewn = 1; sewn <= 3; sewn++) {
        uint32_t ignored[2][2] = {{1, sewn}, {2, sewn}};
        cscd_detector_options options = cscd_detector_defaults();
        body_rig_begin(&rig);
        for (uint32_t t = 0; t <= sewn; t++) {
            if (t == sewn) body_rig_end_body(&rig);
            for (uint32_t i = 0; i < 3; i++) {
                const double end[3] = {0, 2.0 * i, 0};
                memcpy(&rig.all.x0[(3 * t + i) * 3],
                       t == sewn ? blade[i]
                       : i < 2   ? end
                                 : corners[t],
                       sizeof end);
                rig.all.triangles[3 * t + i] = 3 * t + i;
            }
            rig.all.vertex_count += 3;
            rig.all.triangle_count++;
        }
        body_rig_end_body(&rig);
        options.seams = seams[0];
        options.seam_count = 2 * (sewn - 1);
        options.ignored = ignored[0];
        options.ignored_count = sewn - 1;
        body_rig_create(&rig, &options, 1);
        body_rig_find(&rig);
        assert_int_equal(rig.found.curves->count, 1);
        const cscd_curve *curve = &rig.found.curves->items[0];
        cscd_curve_end expected = sewn == 1   ? CSCD_CURVE_END_BORDER
                                  : sewn == 2 ? CSCD_CURVE_END_LEFT_OUT
                                              : CSCD_CURVE_END_JUNCTION;
        assert_int_equal(curve->piece_count, 1);
        assert_true(curve->start == expected || curve->end == expected);
        assert_true(curve->start == CSCD_CURVE_END_BORDER || curve->end == CSCD_CURVE_END_BORDER);
    }
}

AROUND_EACH(NULL, body_rigs_free)
