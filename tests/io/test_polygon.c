/* Polygons are cut into triangles that fill them: random ones by area, orientation and winding against an oracle in whole
 * numbers, and those on which fans fail. */
#include "src/io/polygon.h"
#include "tests/support/random_stream.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS_MAX = 96 };

/* A polygon with whole coordinates, counter-clockwise; a vertex may be named twice where it goes to a hole and back. */
typedef struct flat_polygon {
    int64_t points[CORNERS_MAX][2]; /* of vertices */
    uint32_t vertex_count;
    uint32_t corners[CORNERS_MAX];
    uint32_t corner_count;
} flat_polygon;

static int64_t cross_of(const int64_t a[2], const int64_t b[2], const int64_t c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static void add_vertex(flat_polygon *p, int64_t x, int64_t y) {
    assert_true(p->vertex_count < CORNERS_MAX && p->corner_count < CORNERS_MAX);
    p->points[p->vertex_count][0] = x;
    p->points[p->vertex_count][1] = y;
    p->corners[p->corner_count++] = p->vertex_count++;
}

/* ---- the oracle -------------------------------------------------------------------------------------- */

static int64_t doubled_area(const flat_polygon *p) {
    int64_t sum = 0;
    for (uint32_t i = 0; i < p->corner_count; i++) {
        const int64_t *a = p->points[p->corners[i]], *b = p->points[p->corners[(i + 1) % p->corner_count]];
        sum += a[0] * b[1] - a[1] * b[0];
    }
    return sum;
}

/* How often the polygon winds around a point that lies on none of its edges. */
static int winding_of(const flat_polygon *p, const int64_t z[2]) {
    int winding = 0;
    for (uint32_t i = 0; i < p->corner_count; i++) {
        const int64_t *a = p->points[p->corners[i]], *b = p->points[p->corners[(i + 1) % p->corner_count]];
        if (a[1] <= z[1] && b[1] > z[1]) winding += cross_of(a, b, z) > 0;
        if (b[1] <= z[1] && a[1] > z[1]) winding -= cross_of(a, b, z) < 0;
    }
    return winding;
}

/* Whether each edge of the triangles is one of the polygon, or has its reverse. */
static void check_edges(const flat_polygon *p, const uint32_t (*triangles)[3]) {
    static int16_t count[CORNERS_MAX][CORNERS_MAX];
    memset(count, 0, sizeof count);
    for (uint32_t i = 0; i < p->corner_count; i++)
        count[p->corners[i]][p->corners[(i + 1) % p->corner_count]]--;
    for (uint32_t t = 0; t + 2 < p->corner_count; t++)
        for (int k = 0; k < 3; k++) count[triangles[t][k]][triangles[t][(k + 1) % 3]]++;
    for (uint32_t a = 0; a < p->vertex_count; a++)
        for (uint32_t b = 0; b < a; b++) assert_int_equal(count[a][b], count[b][a]);
}

static void check_filling(const flat_polygon *p, const uint32_t (*triangles)[3]) {
    int64_t sum = 0;
    for (uint32_t t = 0; t + 2 < p->corner_count; t++) {
        const uint32_t *v = triangles[t];
        const int64_t area = cross_of(p->points[v[0]], p->points[v[1]], p->points[v[2]]);
        assert_true(area > 0);
        sum += area;
    }
    assert_true(sum == doubled_area(p));
    check_edges(p, triangles);
}

/* Points between the grid's lines are in as many triangles as the polygon winds around them. */
static void check_winding(const flat_polygon *p, const uint32_t (*triangles)[3], random_stream *random) {
    flat_polygon doubled = *p;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        for (int k = 0; k < 2; k++) doubled.points[v][k] *= 1024;
    for (int sample = 0; sample < 8; sample++) {
        const uint32_t near = stream_below(random, p->vertex_count);
        int64_t z[2];
        for (int k = 0; k < 2; k++)
            z[k] = doubled.points[near][k] + (int64_t)stream_below(random, 8192) - 4096;
        int inside = 0;
        bool on_edge = false;
        for (uint32_t t = 0; t + 2 < p->corner_count; t++) {
            int64_t least = INT64_MAX;
            for (int k = 0; k < 3; k++) {
                const int64_t turn =
                    cross_of(doubled.points[triangles[t][k]], doubled.points[triangles[t][(k + 1) % 3]], z);
                least = turn < least ? turn : least;
                on_edge |= turn == 0;
            }
            inside += least > 0;
        }
        if (!on_edge) assert_int_equal(inside, winding_of(&doubled, z));
    }
}

/* Puts the polygon into space, in each of the planes of two coordinates, begun at each of its corners and both ways
 * around, and checks how it is filled. */
static void check_polygon(const flat_polygon *p, random_stream *random) {
    const int axis = (int)stream_below(random, 3), swapped = (int)stream_below(random, 2);
    const uint32_t start = stream_below(random, p->corner_count);
    const double slope[2] = {stream_below(random, 7) / 8.0 - 0.375, stream_below(random, 7) / 8.0 - 0.375};
    double positions[CORNERS_MAX * 3];
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        const double x = (double)p->points[v][0], y = (double)p->points[v][1];
        positions[v * 3 + (uint32_t)((axis + 1) % 3)] = swapped ? y : x;
        positions[v * 3 + (uint32_t)((axis + 2) % 3)] = swapped ? x : y;
        positions[v * 3 + (uint32_t)axis] = slope[0] * x + slope[1] * y;
    }
    uint32_t corners[CORNERS_MAX], triangles[CORNERS_MAX][3];
    const bool backwards = stream_below(random, 2) == 0;
    for (uint32_t i = 0; i < p->corner_count; i++) {
        const uint32_t at = (start + i) % p->corner_count;
        corners[i] = p->corners[backwards ? p->corner_count - 1 - at : at];
    }
    assert_int_equal(polygon_fill(positions, corners, p->corner_count, triangles), POLYGON_FILLED);
    for (uint32_t t = 0; t + 2 < p->corner_count && backwards; t++) {
        const uint32_t kept = triangles[t][1];
        triangles[t][1] = triangles[t][2];
        triangles[t][2] = kept;
    }
    check_filling(p, (const uint32_t(*)[3])triangles);
    check_winding(p, (const uint32_t(*)[3])triangles, random);
}

/* ---- shapes ------------------------------------------------------------------------------------------ */

static bool on_segment(const int64_t a[2], const int64_t b[2], const int64_t z[2]) {
    return cross_of(a, b, z) == 0 && (z[0] - a[0]) * (z[0] - b[0]) + (z[1] - a[1]) * (z[1] - b[1]) <= 0;
}

static bool segments_meet(const int64_t a[2], const int64_t b[2], const int64_t c[2], const int64_t d[2]) {
    const int64_t abc = cross_of(a, b, c), abd = cross_of(a, b, d), cda = cross_of(c, d, a),
                  cdb = cross_of(c, d, b);
    if (((abc > 0) != (abd > 0)) && ((cda > 0) != (cdb > 0)) && abc != 0 && abd != 0 && cda != 0 && cdb != 0)
        return true;
    return on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b);
}

static bool same_point(const int64_t a[2], const int64_t b[2]) {
    return a[0] == b[0] && a[1] == b[1];
}

/* Simple: edges meet at corners that they share only, and neighbours do not fold back. */
static bool is_simple(const flat_polygon *p) {
    const uint32_t n = p->corner_count;
    for (uint32_t i = 0; i < n; i++) {
        const int64_t *a = p->points[p->corners[i]], *b = p->points[p->corners[(i + 1) % n]];
        if (same_point(a, b)) return false;
        for (uint32_t j = i + 1; j < n; j++) {
            const int64_t *c = p->points[p->corners[j]], *d = p->points[p->corners[(j + 1) % n]];
            if (j == i + 1             ? on_segment(a, b, d) || on_segment(c, d, a)
                : i == 0 && j == n - 1 ? on_segment(a, b, c) || on_segment(c, d, b)
                                       : segments_meet(a, b, c, d))
                return false;
        }
    }
    return true;
}

/* Corners in the order of their angles around 0; whole numbers make many of them lie on lines. */
static void make_star(flat_polygon *p, random_stream *random, uint32_t count, double least, double most) {
    for (uint32_t i = 0; i < count; i++) {
        const double angle = 2.0 * 3.14159265358979323846 * i / count;
        const double radius = least + (most - least) * stream_below(random, 1024) / 1024.0;
        add_vertex(p, llround(radius * cos(angle)), llround(radius * sin(angle)));
    }
}

/* Steps along a grid, to the right above and back below, so that most corners lie on lines with others. */
static void make_skyline(flat_polygon *p, random_stream *random, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) add_vertex(p, i, -(int64_t)stream_below(random, 3));
    for (uint32_t i = count; i-- > 0;) add_vertex(p, i, 1 + (int64_t)stream_below(random, 3));
}

static void make_spiral(flat_polygon *p, random_stream *random, uint32_t turns) {
    const int64_t width = 4 + (int64_t)stream_below(random, 4);
    int64_t x = 0, y = 0;
    static const int64_t steps[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    int64_t outer[64][2];
    uint32_t count = 0;
    for (uint32_t i = 0; i < turns; i++, count++) {
        outer[count][0] = x;
        outer[count][1] = y;
        x += steps[i % 4][0] * width * (int64_t)(i / 2 + 1) * 2;
        y += steps[i % 4][1] * width * (int64_t)(i / 2 + 1) * 2;
    }
    /* The way back, one unit to the left. */
    for (uint32_t i = 0; i < count; i++) add_vertex(p, outer[i][0], outer[i][1]);
    for (uint32_t i = count; i-- > 0;) {
        static const int64_t corner[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
        add_vertex(p, outer[i][0] + corner[i % 4][0], outer[i][1] + corner[i % 4][1]);
    }
}

/* Cuts a hole into a polygon: a triangle in it, reached by a bridge from one of its corners. */
static void add_hole(flat_polygon *p, random_stream *random, int64_t x, int64_t y) {
    flat_polygon with = *p;
    const uint32_t first = with.vertex_count, n = p->corner_count, from = stream_below(random, n);
    if (n + 5 > CORNERS_MAX) return;
    uint32_t copies =
        0; /* of the corner that the bridge leaves from: with one, it is clear between which edges */
    for (uint32_t i = 0; i < n; i++) copies += p->corners[i] == p->corners[from];
    if (copies > 1) return;
    const int64_t size = 1 + (int64_t)stream_below(random, 3);
    const int64_t hole[3][2] = {{x, y}, {x + size, y + 2}, {x + 2, y - size}}; /* clockwise */
    if (cross_of(hole[0], hole[1], hole[2]) >= 0) return;
    for (int k = 0; k < 3; k++) memcpy(with.points[first + (uint32_t)k], hole[k], sizeof hole[k]);
    with.vertex_count += 3;
    const uint32_t entry = stream_below(random, 3);
    const int64_t *a = p->points[p->corners[from]], *b = hole[entry];
    for (uint32_t i = 0; i < n; i++) {
        const int64_t *c = p->points[p->corners[i]], *d = p->points[p->corners[(i + 1) % n]];
        for (int k = 0; k < 3; k++)
            if (segments_meet(hole[k], hole[(k + 1) % 3], c, d)) return;
        if (same_point(c, a) || same_point(d, a)) {
            /* The bridge leaves from a corner of this edge, so it must not run along it. */
            if (cross_of(a, same_point(c, a) ? d : c, b) == 0) return;
        } else if (segments_meet(a, b, c, d)) {
            return;
        }
    }
    if (segments_meet(a, b, hole[(entry + 1) % 3], hole[(entry + 2) % 3])) return;
    if (cross_of(a, b, hole[(entry + 1) % 3]) == 0 || cross_of(a, b, hole[(entry + 2) % 3]) == 0) return;
    if (winding_of(p, b) != 1) return;
    for (uint32_t v = 0; v < p->vertex_count; v++) { /* no other hole inside of this one */
        const int64_t *z = p->points[v];
        if (cross_of(hole[0], hole[1], z) <= 0 && cross_of(hole[1], hole[2], z) <= 0 &&
            cross_of(hole[2], hole[0], z) <= 0)
            return;
    }
    memmove(with.corners + from + 6, with.corners + from + 1, (n - from - 1) * sizeof *with.corners);
    for (uint32_t k = 0; k < 4; k++) with.corners[from + 1 + k] = first + (entry + k) % 3;
    with.corners[from + 5] = p->corners[from];
    with.corner_count += 5;
    *p = with;
}

static uint32_t count_checked(uint32_t rounds, uint64_t seed) {
    uint32_t checked = 0;
    random_stream random = stream_start(seed);
    for (uint32_t round = 0; round < rounds; round++) {
        flat_polygon p = {.vertex_count = 0};
        switch (stream_below(&random, 5)) {
        case 0:
            make_star(&p, &random, 4 + stream_below(&random, 30), 4.0, 30.0);
            break;
        case 1:
            make_star(&p, &random, 4 + stream_below(&random, 9), 1.0, 6.0);
            break;
        case 2:
            make_skyline(&p, &random, 3 + stream_below(&random, 20));
            break;
        case 3:
            make_spiral(&p, &random, 3 + stream_below(&random, 8));
            break;
        default: {
            make_star(&p, &random, 8 + stream_below(&random, 12), 25.0, 60.0);
            if (!is_simple(&p)) continue;
            for (int hole = 0; hole < 4; hole++) {
                const int64_t x = (int64_t)stream_below(&random, 31) - 15,
                              y = (int64_t)stream_below(&random, 31) - 15;
                add_hole(&p, &random, x, y);
            }
            check_polygon(&p, &random);
            checked++;
            continue;
        }
        }
        if (doubled_area(&p) <= 0 || !is_simple(&p)) continue;
        check_polygon(&p, &random);
        checked++;
    }
    return checked;
}

static void random_polygons_are_filled(void **state) {
    (void)state;
    assert_true(count_checked(6000, 1) > 3000);
}

/* ---- by hand ----------------------------------------------------------------------------------------- */

/* In every plane, from every corner, both ways around. */
static void check_shape(const int64_t (*points)[2], uint32_t vertex_count, const uint32_t *corners,
                        uint32_t corner_count) {
    flat_polygon p = {.vertex_count = vertex_count, .corner_count = corner_count};
    memcpy(p.points, points, vertex_count * sizeof *points);
    for (uint32_t i = 0; i < corner_count; i++) p.corners[i] = corners != NULL ? corners[i] : i;
    random_stream random = stream_start(corner_count);
    for (uint32_t i = 0; i < 12 * corner_count; i++) check_polygon(&p, &random);
}

#define CHECK_SHAPE(...)                                                                                     \
    check_shape((const int64_t[][2]){__VA_ARGS__},                                                           \
                sizeof((const int64_t[][2]){__VA_ARGS__}) / sizeof(int64_t[2]), NULL,                        \
                sizeof((const int64_t[][2]){__VA_ARGS__}) / sizeof(int64_t[2]))

static void shapes_on_which_fans_fail_are_filled(void **state) {
    (void)state;
    CHECK_SHAPE({0, 0}, {4, -2}, {1, 0}, {4, 2});                                      /* dart */
    CHECK_SHAPE({0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4});                       /* L */
    CHECK_SHAPE({0, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 4}, {0, 4});                       /* corners on sides */
    CHECK_SHAPE({0, 0}, {2, 0}, {4, 0}, {2, 3});                                       /* a quad like this */
    CHECK_SHAPE({0, -8}, {2, -2}, {8, 0}, {2, 2}, {0, 8}, {-2, 2}, {-8, 0}, {-2, -2}); /* star */
    CHECK_SHAPE({0, 0}, {6, 0}, {6, 1}, {4, 1}, {4, 8}, {6, 8}, {6, 9}, {0, 9}, {0, 8}, {2, 8}, {2, 1},
                {0, 1}); /* I */
}

/* The letter A and the figure 8, as exporters bridge their holes. */
static void letters_with_bridged_holes_are_filled(void **state) {
    (void)state;
    static const int64_t a[][2] = {{0, 0},  {3, 0},  {4, 3}, {8, 3}, {9, 0}, {12, 0},
                                   {7, 14}, {5, 14}, {5, 5}, {6, 9}, {7, 5}};
    static const uint32_t a_corners[] = {0, 1, 2, 8, 9, 10, 8, 2, 3, 4, 5, 6, 7};
    check_shape(a, 11, a_corners, 13);
    static const int64_t eight[][2] = {{0, 0}, {6, 0}, {6, 12}, {0, 12}, {2, 2},  {2, 5},
                                       {4, 5}, {4, 2}, {2, 7},  {2, 10}, {4, 10}, {4, 7}};
    static const uint32_t eight_corners[] = {0, 4, 5, 8, 9, 10, 11, 8, 5, 6, 7, 4, 0, 1, 2, 3};
    check_shape(eight, 12, eight_corners, 16);
}

static void check_fanned(const double (*positions)[3], uint32_t count) {
    uint32_t corners[8], triangles[8][3];
    for (uint32_t i = 0; i < count; i++) corners[i] = i;
    assert_int_equal(polygon_fill(&positions[0][0], corners, count, triangles), POLYGON_FANNED);
    for (uint32_t t = 0; t + 2 < count; t++)
        assert_true(triangles[t][0] == 0 && triangles[t][1] == t + 1 && triangles[t][2] == t + 2);
}

static void polygons_without_a_shape_become_fans(void **state) {
    (void)state;
    check_fanned((const double[][3]){{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 3, 0}}, 4);            /* bow-tie */
    check_fanned((const double[][3]){{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, 4);            /* a line */
    check_fanned((const double[][3]){{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, 5); /* a place */
}

/* Corners with vertices of their own at one place get triangles without area, so that all edges have a face. */
static void corners_at_one_place_keep_their_edges(void **state) {
    (void)state;
    static const double positions[][3] = {{0, 0, 0}, {4, 0, 0}, {4, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
    static const uint32_t corners[] = {2, 3, 4, 5, 0, 1};
    uint32_t triangles[4][3], edges = 0;
    assert_int_equal(polygon_fill(&positions[0][0], corners, 6, triangles), POLYGON_FILLED);
    for (uint32_t i = 0; i < 6; i++)
        for (uint32_t t = 0; t < 4; t++)
            for (int k = 0; k < 3; k++)
                edges += triangles[t][k] == corners[i] && triangles[t][(k + 1) % 3] == corners[(i + 1) % 6];
    assert_int_equal(edges, 6);
}

int main(int argument_count, char **arguments) {
    if (argument_count > 1) { /* the long run: test_polygon ROUNDS */
        printf("%u polygons\n", count_checked((uint32_t)strtoul(arguments[1], NULL, 10), 2));
        return 0;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_polygons_are_filled),
        cmocka_unit_test(shapes_on_which_fans_fail_are_filled),
        cmocka_unit_test(letters_with_bridged_holes_are_filled),
        cmocka_unit_test(polygons_without_a_shape_become_fans),
        cmocka_unit_test(corners_at_one_place_keep_their_edges),
    };
    return cmocka_run_group_tests_name("polygon", tests, NULL, NULL);
}
