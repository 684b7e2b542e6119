/* Polygons at the limits of what their plane shows: nearly collinear corners, windings, faces that are not flat. */
#include "tests/support/io/flat_polygon.h"
#include "tests/support/random.h"
#include "tests/support/test.h"
#include "tool/io/mesh_builder.h"
#include "tool/io/polygon.h"

#include <math.h>
#include <stdbool.h>

/* ---- nearly collinear points --------------------------------------------------------------------------- */

/* The sign of the turn at points whose coordinates are whole numbers below 2^53. */
static int whole_turn(const double a[2], const double b[2], const double c[2]) {
    const __int128 left = (__int128)(a[0] - c[0]) * (__int128)(b[1] - c[1]),
                   right = (__int128)(a[1] - c[1]) * (__int128)(b[0] - c[0]);
    return (left > right) - (left < right);
}

/* A whole number whose sums and differences of two are doubles. */
static double whole_number(random_stream *random) {
    return (double)(int64_t)(stream_bits(random) >> 13) - 0x1p50;
}

TEST(turns_of_nearly_collinear_points_are_exact) {
    random_stream random = stream_start(7);
    uint32_t counts[3] = {0, 0, 0};
    for (uint32_t round = 0; round < 20000; round++) {
        double points[3][2];
        const double share = stream_between(&random, -1.0, 2.0);
        for (int k = 0; k < 2; k++) {
            points[0][k] = whole_number(&random);
            points[1][k] = whole_number(&random);
            points[2][k] = rint(points[0][k] + share * (points[1][k] - points[0][k]));
        }
        if (round % 4 == 0) /* exactly on the line */
            for (int k = 0; k < 2; k++) points[2][k] = 2.0 * points[1][k] - points[0][k];
        const int expected = whole_turn(points[0], points[1], points[2]);
        const double scale = ldexp(1.0, (int)stream_below(&random, 100) - 80);
        for (int i = 0; i < 6; i++) points[i / 2][i % 2] *= scale;
        counts[expected + 1]++;
        for (int i = 0; i < 3; i++) {
            const double *a = points[i], *b = points[(i + 1) % 3], *c = points[(i + 2) % 3];
            assert_int_equal(orientation_of(a, b, c), expected);
            assert_int_equal(orientation_of(b, a, c), -expected);
        }
    }
    for (int i = 0; i < 3; i++) assert_true(counts[i] > 4000);
}

/* A quad that is a dart by the last bit of a coordinate has the diagonal from its notch, from whichever corner it begins. */
TEST(notches_of_one_bit_are_seen) {
    static const double positions[][3] = {{0, 0, 0}, {0.3, 0.1, 0}, {0.9, 0.3, 0}, {0.25, 0.75, 0}};
    const double *a = positions[0], *b = positions[1], *c = positions[2];
    const int turn = orientation_of(a, b, c);
    assert_int_not_equal(turn, 0);
    double moved[4][3];
    for (int i = 0; i < 12; i++) moved[i / 3][i % 3] = positions[i / 3][i % 3];
    if (turn > 0) moved[1][1] = nextafter(moved[1][1], 1.0);
    assert_int_equal(orientation_of(moved[0], moved[1], moved[2]), -1);
    for (uint32_t start = 0; start < 4; start++) {
        uint32_t corners[4], triangles[2][3];
        for (uint32_t i = 0; i < 4; i++) corners[i] = (start + i) % 4;
        assert_int_equal(polygon_fill(&moved[0][0], corners, 4, triangles), POLYGON_FILLED);
        for (int t = 0; t < 2; t++) {
            const uint32_t *v = triangles[t];
            assert_int_equal(orientation_of(moved[v[0]], moved[v[1]], moved[v[2]]), 1);
        }
    }
}

/* ---- corners in triangles ------------------------------------------------------------------------------ */

static bool lies_in_triangle(const double (*points)[2], const uint32_t t[3], uint32_t point) {
    for (int i = 0; i < 3; i++) {
        const double *a = points[t[i]], *p = points[point];
        if ((a[0] == p[0] && a[1] == p[1]) || orientation_of(a, points[t[(i + 1) % 3]], p) < 0) return false;
    }
    return true;
}

/* Stretches of an outline that run along lines, wander, or lie far from 0, where the last bits decide. */
static void place_outline(random_stream *random, uint32_t count, double (*points)[2]) {
    const double far_away = stream_below(random, 2) == 0 ? 0.0 : 0x1p30,
                 bit = far_away == 0.0 ? 0x1p-50 : 0x1p-22;
    const double steps[2] = {stream_between(random, -1.0, 1.0), stream_between(random, -1.0, 1.0)};
    const uint32_t kind = stream_below(random, 3);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) {
            const double noise = bit * stream_below(random, 4);
            points[i][k] = kind == 0   ? far_away + i % 40 * steps[k] + noise
                           : kind == 1 ? far_away + stream_below(random, 9) * bit
                                       : far_away + (i > 0 ? points[i - 1][k] - far_away : 0.0) +
                                             stream_between(random, -1.0, 1.0);
        }
}

TEST(corners_in_triangles_are_found) {
    enum { COUNT = 200 };
    random_stream random = stream_start(11);
    uint32_t found_count = 0, empty_count = 0;
    for (uint32_t round = 0; round < 60; round++) {
        double points[COUNT][2];
        bool active[COUNT];
        corner_tree tree;
        place_outline(&random, COUNT, points);
        assert_true(corner_tree_create((const double(*)[2])points, COUNT, &tree));
        for (uint32_t i = 0; i < COUNT; i++)
            corner_tree_set_active(&tree, i, active[i] = stream_below(&random, 1 + round % 8) == 0);
        for (uint32_t trial = 0; trial < 400; trial++) {
            uint32_t t[3];
            const uint32_t near = 4 + stream_below(&random, COUNT - 4), first = stream_below(&random, COUNT);
            for (int k = 0; k < 3; k++) t[k] = (first + stream_below(&random, near)) % COUNT;
            if (orientation_of(points[t[0]], points[t[1]], points[t[2]]) <= 0) continue;
            bool expected = false;
            for (uint32_t i = 0; i < COUNT; i++)
                expected |= active[i] && lies_in_triangle((const double(*)[2])points, t, i);
            const uint32_t found = corner_tree_find(&tree, t);
            assert_int_equal(found != UINT32_MAX, expected);
            if (expected)
                assert_true(active[found] && lies_in_triangle((const double(*)[2])points, t, found));
            found_count += expected;
            empty_count += !expected;
        }
        corner_tree_free(&tree);
    }
    assert_true(found_count > 1000 && empty_count > 1000);
}

/* ---- windings and planes ------------------------------------------------------------------------------- */

/* All corners turn left, and yet the sides cross: around twice, three times. */
TEST(stars_that_cross_themselves_become_fans) {
    static const uint32_t steps[][2] = {{5, 2}, {7, 2}, {7, 3}, {11, 4}, {17, 2}};
    for (size_t s = 0; s < sizeof steps / sizeof *steps; s++) {
        double positions[17][3];
        uint32_t corners[17], triangles[15][3];
        const uint32_t count = steps[s][0];
        for (uint32_t i = 0; i < count; i++) {
            const double angle = 2.0 * 3.14159265358979323846 * steps[s][1] * i / count;
            positions[i][0] = cos(angle);
            positions[i][1] = sin(angle);
            positions[i][2] = 0.25 * cos(angle);
            corners[i] = i;
        }
        assert_int_equal(polygon_fill(&positions[0][0], corners, count, triangles), POLYGON_FANNED);
        for (uint32_t t = 0; t + 2 < count; t++)
            assert_true(triangles[t][0] == 0 && triangles[t][1] == t + 1 && triangles[t][2] == t + 2);
    }
}

/* A loop within a loop: all corners turn left, so none stands in the way of an ear, but not all diagonals lead inside. */
TEST(loops_in_loops_become_fans) {
    for (uint32_t count = 9; count < 400; count += 30) {
        double positions[400][3];
        uint32_t corners[400], triangles[400][3];
        for (uint32_t i = 0; i < count; i++) {
            const double angle = 2.0 * 3.14159265358979323846 * (i + 0.5) / count,
                         radius = 1.0 + 2.0 * cos(angle);
            positions[i][0] = radius * cos(angle);
            positions[i][1] = radius * sin(angle);
            positions[i][2] = 0.0;
            corners[i] = i;
        }
        assert_int_equal(polygon_fill(&positions[0][0], corners, count, triangles), POLYGON_FANNED);
    }
}

static bool sides_cross_whole(const flat_polygon *p, uint32_t i, uint32_t j) {
    const uint32_t n = p->corner_count;
    const int64_t *a = p->points[i], *b = p->points[(i + 1) % n], *c = p->points[j],
                  *d = p->points[(j + 1) % n];
    const int64_t turns[4] = {flat_cross(a, b, c), flat_cross(a, b, d), flat_cross(c, d, a),
                              flat_cross(c, d, b)};
    return ((turns[0] > 0 && turns[1] < 0) || (turns[0] < 0 && turns[1] > 0)) &&
           ((turns[2] > 0 && turns[3] < 0) || (turns[2] < 0 && turns[3] > 0));
}

/* Some of them have ears until nothing is left, whose triangles lie twofold where the polygon winds twice. */
TEST(random_polygons_that_cross_themselves_become_fans) {
    random_stream random = stream_start(3);
    uint32_t crossing_count = 0;
    for (uint32_t round = 0; round < 20000; round++) {
        flat_polygon p = {.vertex_count = 0};
        const uint32_t count = 4 + stream_below(&random, 10), size = 4 + stream_below(&random, 12);
        for (uint32_t i = 0; i < count; i++)
            flat_polygon_add(&p, stream_below(&random, size), stream_below(&random, size));
        bool crosses = false;
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t j = 0; j < i; j++) crosses |= sides_cross_whole(&p, i, j);
        if (!crosses) continue;
        double positions[13][3] = {{0}};
        uint32_t triangles[11][3];
        for (uint32_t i = 0; i < count; i++)
            for (int k = 0; k < 2; k++) positions[i][k] = (double)p.points[i][k];
        assert_int_equal(polygon_fill(&positions[0][0], p.corners, count, triangles), POLYGON_FANNED);
        crossing_count++;
    }
    assert_true(crossing_count > 10000);
}

/* A dart seen along its largest area, and convex seen from the side, along each axis and in every direction. */
TEST(faces_that_are_not_flat_are_cut_where_they_are_large) {
    static const double dart[4][3] = {{0, 0, -0.1}, {4, -2, 0}, {1, 0, 0.1}, {4, 2, 0}};
    for (uint32_t round = 0; round < 3 * 2 * 4; round++) {
        const uint32_t axis = round % 3, start = round / 6;
        const bool mirrored = round / 3 % 2 == 1;
        double positions[4][3];
        for (uint32_t i = 0; i < 4; i++)
            for (uint32_t k = 0; k < 3; k++)
                positions[i][(k + axis) % 3] = mirrored && k == 2 ? -dart[i][k] : dart[i][k];
        uint32_t corners[4], triangles[2][3];
        for (uint32_t i = 0; i < 4; i++) corners[i] = (start + i) % 4;
        assert_int_equal(polygon_fill(&positions[0][0], corners, 4, triangles), POLYGON_FILLED);
        for (int t = 0; t < 2; t++) {
            const double *p[3];
            for (int k = 0; k < 3; k++) p[k] = dart[triangles[t][k]];
            assert_int_equal(orientation_of(p[0], p[1], p[2]), 1);
        }
    }
}
