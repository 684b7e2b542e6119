/* Polygons are cut into triangles that fill them: random ones by area, orientation and winding against an oracle in whole
 * numbers, and those on which fans fail. */
#include "tests/support/io/flat_polygon.h"
#include "tests/support/test.h"
#include "tool/io/mesh_builder.h"
#include "tool/io/polygon.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- shapes ------------------------------------------------------------------------------------------ */

/* Corners in the order of their angles around 0; whole numbers make many of them lie on lines. */
static void make_star(flat_polygon *p, random_stream *random, uint32_t count, double least, double most) {
    for (uint32_t i = 0; i < count; i++) {
        const double angle = 2.0 * 3.14159265358979323846 * i / count;
        const double radius = least + (most - least) * stream_below(random, 1024) / 1024.0;
        flat_polygon_add(p, llround(radius * cos(angle)), llround(radius * sin(angle)));
    }
}

/* Steps along a grid, to the right above and back below, so that most corners lie on lines with others. */
static void make_skyline(flat_polygon *p, random_stream *random, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) flat_polygon_add(p, i, -(int64_t)stream_below(random, 3));
    for (uint32_t i = count; i-- > 0;) flat_polygon_add(p, i, 1 + (int64_t)stream_below(random, 3));
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
    for (uint32_t i = 0; i < count; i++) flat_polygon_add(p, outer[i][0], outer[i][1]);
    for (uint32_t i = count; i-- > 0;) {
        static const int64_t corner[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
        flat_polygon_add(p, outer[i][0] + corner[i % 4][0], outer[i][1] + corner[i % 4][1]);
    }
}

/* Pulls a point out of an edge, or pushes one in; false: the polygon would not be simple. */
static bool bend_edge(flat_polygon *p, uint32_t edge, const int64_t z[2]) {
    const uint32_t n = p->corner_count;
    const int64_t *a = p->points[p->corners[edge]], *b = p->points[p->corners[(edge + 1) % n]];
    if (flat_cross(a, b, z) == 0) return false;
    for (uint32_t i = 0; i < n; i++) {
        const int64_t *c = p->points[p->corners[i]], *d = p->points[p->corners[(i + 1) % n]];
        if (i == edge) continue;
        /* Neighbours share a corner with the edge: their other corner must be off it, and z off them. */
        const int64_t *to = d == a ? c : d, *from = c == b ? d : c;
        if (flat_segments_meet(c, d, z, z) || flat_segments_meet(a, z, c, to) ||
            flat_segments_meet(z, b, from, d))
            return false;
    }
    memcpy(p->points[p->vertex_count], z, sizeof p->points[0]);
    memmove(p->corners + edge + 2, p->corners + edge + 1, (n - edge - 1) * sizeof *p->corners);
    p->corners[edge + 1] = p->vertex_count++;
    p->corner_count++;
    return true;
}

/* A triangle whose edges are bent again and again, so that it winds through itself. */
static void make_labyrinth(flat_polygon *p, random_stream *random, uint32_t count, uint32_t size) {
    flat_polygon_add(p, 0, 0);
    flat_polygon_add(p, size, 0);
    flat_polygon_add(p, 0, size);
    for (uint32_t tried = 0; tried < 4 * count && p->corner_count < count; tried++) {
        const int64_t z[2] = {stream_below(random, size + 1), stream_below(random, size + 1)};
        bend_edge(p, stream_below(random, p->corner_count), z);
    }
}

/* Does the way from corner `from` to z leave into the polygon? Corners at one place have angles of their own. */
static bool leads_inside(const flat_polygon *p, uint32_t from, const int64_t z[2]) {
    const uint32_t n = p->corner_count;
    const int64_t *before = p->points[p->corners[(from + n - 1) % n]], *at = p->points[p->corners[from]],
                  *after = p->points[p->corners[(from + 1) % n]];
    if (flat_cross(before, at, after) > 0)
        return flat_cross(at, after, z) > 0 && flat_cross(at, z, before) > 0;
    return !(flat_cross(at, z, after) >= 0 && flat_cross(at, before, z) >= 0);
}

/* Cuts a hole into a polygon: a triangle in it, reached by a bridge from one of its corners, which may have bridges. */
static void add_hole(flat_polygon *p, random_stream *random, int64_t x, int64_t y) {
    flat_polygon with = *p;
    const uint32_t first = with.vertex_count, n = p->corner_count, from = stream_below(random, n);
    if (n + 5 > FLAT_CORNERS_MAX) return;
    const int64_t size = 1 + (int64_t)stream_below(random, 3);
    const int64_t hole[3][2] = {{x, y}, {x + size, y + 2}, {x + 2, y - size}}; /* clockwise */
    if (flat_cross(hole[0], hole[1], hole[2]) >= 0) return;
    for (int k = 0; k < 3; k++) memcpy(with.points[first + (uint32_t)k], hole[k], sizeof hole[k]);
    with.vertex_count += 3;
    const uint32_t entry = stream_below(random, 3);
    const int64_t *a = p->points[p->corners[from]], *b = hole[entry];
    for (uint32_t i = 0; i < n; i++) {
        const int64_t *c = p->points[p->corners[i]], *d = p->points[p->corners[(i + 1) % n]];
        for (int k = 0; k < 3; k++)
            if (flat_segments_meet(hole[k], hole[(k + 1) % 3], c, d)) return;
        if (flat_points_equal(c, a) || flat_points_equal(d, a)) {
            /* The bridge leaves from a corner of this edge, so it must not run along it. */
            if (flat_cross(a, flat_points_equal(c, a) ? d : c, b) == 0) return;
        } else if (flat_segments_meet(a, b, c, d)) {
            return;
        }
    }
    if (flat_segments_meet(a, b, hole[(entry + 1) % 3], hole[(entry + 2) % 3])) return;
    if (flat_cross(a, b, hole[(entry + 1) % 3]) == 0 || flat_cross(a, b, hole[(entry + 2) % 3]) == 0) return;
    if (flat_polygon_winding(p, b) != 1 || !leads_inside(p, from, b)) return;
    for (uint32_t v = 0; v < p->vertex_count; v++) { /* no other hole inside of this one */
        const int64_t *z = p->points[v];
        if (flat_cross(hole[0], hole[1], z) <= 0 && flat_cross(hole[1], hole[2], z) <= 0 &&
            flat_cross(hole[2], hole[0], z) <= 0)
            return;
    }
    memmove(with.corners + from + 6, with.corners + from + 1, (n - from - 1) * sizeof *with.corners);
    for (uint32_t k = 0; k < 4; k++) with.corners[from + 1 + k] = first + (entry + k) % 3;
    with.corners[from + 5] = p->corners[from];
    with.corner_count += 5;
    *p = with;
}

/* One of six kinds; false: it came out as none that is simple. */
static bool make_random(flat_polygon *p, random_stream *random) {
    const uint32_t kind = stream_below(random, 6);
    *p = (flat_polygon){.vertex_count = 0};
    if (kind == 0) make_star(p, random, 4 + stream_below(random, 30), 4.0, 30.0);
    if (kind == 1) make_star(p, random, 4 + stream_below(random, 9), 1.0, 6.0);
    if (kind == 2) make_skyline(p, random, 3 + stream_below(random, 20));
    if (kind == 3) make_spiral(p, random, 3 + stream_below(random, 8));
    if (kind == 4) make_labyrinth(p, random, 8 + stream_below(random, 60), 8 + stream_below(random, 56));
    if (kind == 5) make_star(p, random, 8 + stream_below(random, 12), 25.0, 60.0);
    if (flat_polygon_area(p) <= 0 || !flat_polygon_is_simple(p)) return false;
    for (int hole = 0; kind == 5 && hole < 4; hole++) {
        const int64_t x = (int64_t)stream_below(random, 31) - 15, y = (int64_t)stream_below(random, 31) - 15;
        add_hole(p, random, x, y);
    }
    return true;
}

static uint32_t count_checked(uint32_t rounds, uint64_t seed) {
    uint32_t checked = 0;
    random_stream random = stream_start(seed);
    for (uint32_t round = 0; round < rounds; round++) {
        flat_polygon p;
        if (!make_random(&p, &random)) continue;
        flat_polygon_check(&p, &random);
        checked++;
    }
    return checked;
}

TEST(random_polygons_are_filled) {
    assert_true(count_checked(6000, 1) > 3000);
}

/* ---- the order of the ears --------------------------------------------------------------------------- */

/* What is left of a polygon: each corner is a place in its list. */
typedef struct polygon_rest {
    const flat_polygon *p;
    uint32_t corners[FLAT_CORNERS_MAX], count;
} polygon_rest;

static const int64_t *rest_point(const polygon_rest *rest, uint32_t place) {
    return rest->p->points[rest->p->corners[rest->corners[place % rest->count]]];
}

/* Does the way to z leave into the polygon, within the angle of the corner? */
static bool rest_opens(const polygon_rest *rest, uint32_t place, const int64_t z[2]) {
    const int64_t *before = rest_point(rest, place + rest->count - 1), *at = rest_point(rest, place),
                  *after = rest_point(rest, place + 1);
    const bool left_of_after = flat_cross(at, after, z) > 0, right_of_before = flat_cross(before, at, z) > 0;
    return flat_cross(before, at, after) > 0 ? left_of_after && right_of_before
                                             : left_of_after || right_of_before;
}

/* By the definition: every corner is looked at. */
static bool rest_has_ear(const polygon_rest *rest, uint32_t place) {
    const uint32_t n = rest->count;
    const int64_t *t[3] = {rest_point(rest, place + n - 1), rest_point(rest, place),
                           rest_point(rest, place + 1)};
    if (flat_cross(t[0], t[1], t[2]) <= 0) return false;
    if (n == 3) return true;
    if (!rest_opens(rest, place + n - 1, t[2]) || !rest_opens(rest, place + 1, t[0])) return false;
    for (uint32_t i = 0; i < n; i++) {
        const int64_t *z = rest_point(rest, i);
        bool inside = true;
        for (int k = 0; k < 3; k++)
            inside = inside && !flat_points_equal(t[k], z) && flat_cross(t[k], t[(k + 1) % 3], z) >= 0;
        if (inside) return false;
    }
    return true;
}

/* The place of the ear with the shortest diagonal; of equal ones the first corner of the polygon. */
static uint32_t find_shortest_ear(const polygon_rest *rest) {
    int64_t least = INT64_MAX;
    uint32_t found = UINT32_MAX;
    for (uint32_t i = 0; i < rest->count; i++) {
        const int64_t *u = rest_point(rest, i + rest->count - 1), *w = rest_point(rest, i + 1);
        const int64_t x = u[0] - w[0], y = u[1] - w[1], length = x * x + y * y;
        if (length >= least || !rest_has_ear(rest, i)) continue;
        least = length;
        found = i;
    }
    return found;
}

static void check_ear_order(const flat_polygon *p) {
    double points[FLAT_CORNERS_MAX][2];
    uint32_t triangles[FLAT_CORNERS_MAX][3];
    bool out_of_memory;
    polygon_rest rest = {.p = p, .count = p->corner_count};
    for (uint32_t i = 0; i < p->corner_count; i++) {
        rest.corners[i] = i;
        for (int k = 0; k < 2; k++) points[i][k] = (double)p->points[p->corners[i]][k];
    }
    assert_true(ear_clipping_fill((const double(*)[2])points, p->corner_count, triangles, &out_of_memory));
    for (uint32_t t = 0; rest.count > 2; t++) {
        const uint32_t ear = find_shortest_ear(&rest), n = rest.count;
        assert_int_not_equal(ear, UINT32_MAX);
        for (uint32_t k = 0; k < 3; k++)
            assert_int_equal(triangles[t][k], rest.corners[(ear + n - 1 + k) % n]);
        memmove(rest.corners + ear, rest.corners + ear + 1, (n - ear - 1) * sizeof *rest.corners);
        rest.count--;
    }
}

TEST(the_shortest_ear_comes_first) {
    random_stream random = stream_start(5);
    flat_polygon p;
    uint32_t checked = 0;
    for (uint32_t round = 0; round < 600; round++) {
        if (!make_random(&p, &random)) continue;
        check_ear_order(&p);
        checked++;
    }
    assert_true(checked > 300);
}

/* ---- by hand ----------------------------------------------------------------------------------------- */

/* In every plane, from every corner, both ways around. */
static void check_shape(const int64_t (*points)[2], uint32_t vertex_count, const uint32_t *corners,
                        uint32_t corner_count) {
    flat_polygon p = {.vertex_count = vertex_count, .corner_count = corner_count};
    memcpy(p.points, points, vertex_count * sizeof *points);
    for (uint32_t i = 0; i < corner_count; i++) p.corners[i] = corners != NULL ? corners[i] : i;
    random_stream random = stream_start(corner_count);
    for (uint32_t i = 0; i < 12 * corner_count; i++) flat_polygon_check(&p, &random);
}

#define CHECK_SHAPE(...)                                                                                     \
    check_shape((const int64_t[][2]){__VA_ARGS__},                                                           \
                sizeof((const int64_t[][2]){__VA_ARGS__}) / sizeof(int64_t[2]), NULL,                        \
                sizeof((const int64_t[][2]){__VA_ARGS__}) / sizeof(int64_t[2]))

TEST(shapes_on_which_fans_fail_are_filled) {
    CHECK_SHAPE({0, 0}, {4, -2}, {1, 0}, {4, 2});                                      /* dart */
    CHECK_SHAPE({0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4});                       /* L */
    CHECK_SHAPE({0, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 4}, {0, 4});                       /* corners on sides */
    CHECK_SHAPE({0, 0}, {2, 0}, {4, 0}, {2, 3});                                       /* a quad like this */
    CHECK_SHAPE({0, -8}, {2, -2}, {8, 0}, {2, 2}, {0, 8}, {-2, 2}, {-8, 0}, {-2, -2}); /* star */
    CHECK_SHAPE({0, 0}, {6, 0}, {6, 1}, {4, 1}, {4, 8}, {6, 8}, {6, 9}, {0, 9}, {0, 8}, {2, 8}, {2, 1},
                {0, 1}); /* I */
}

/* The letter A and the figure 8, as exporters bridge their holes. */
TEST(letters_with_bridged_holes_are_filled) {
    static const int64_t a[][2] = {{0, 0},  {3, 0},  {4, 3}, {8, 3}, {9, 0}, {12, 0},
                                   {7, 14}, {5, 14}, {5, 5}, {6, 9}, {7, 5}};
    static const uint32_t a_corners[] = {0, 1, 2, 8, 9, 10, 8, 2, 3, 4, 5, 6, 7};
    check_shape(a, 11, a_corners, 13);
    static const int64_t eight[][2] = {{0, 0}, {6, 0}, {6, 12}, {0, 12}, {2, 2},  {2, 5},
                                       {4, 5}, {4, 2}, {2, 7},  {2, 10}, {4, 10}, {4, 7}};
    static const uint32_t eight_corners[] = {0, 4, 5, 8, 9, 10, 11, 8, 5, 6, 7, 4, 0, 1, 2, 3};
    check_shape(eight, 12, eight_corners, 16);
}

/* Returns the most triangles that a corner of a regular polygon has, on a circle of whole numbers. */
static uint32_t most_at_corner(uint32_t count) {
    double(*positions)[3] = malloc(count * sizeof *positions);
    uint32_t *corners = malloc(count * sizeof *corners), *sizes = calloc(count, sizeof *sizes), most = 0;
    uint32_t(*triangles)[3] = malloc(count * sizeof *triangles);
    assert_true(positions != NULL && corners != NULL && sizes != NULL && triangles != NULL);
    for (uint32_t i = 0; i < count; i++) {
        const double angle = 2.0 * 3.14159265358979323846 * i / count;
        positions[i][0] = round(0x1p40 * cos(angle));
        positions[i][1] = round(0x1p40 * sin(angle));
        positions[i][2] = 0.0;
        corners[i] = i;
    }
    assert_int_equal(polygon_fill(&positions[0][0], corners, count, triangles), POLYGON_FILLED);
    for (uint32_t i = 0; i < 3 * (count - 2); i++) sizes[triangles[i / 3][i % 3]]++;
    for (uint32_t i = 0; i < count; i++) most = sizes[i] > most ? sizes[i] : most;
    free(positions);
    free(corners);
    free(sizes);
    free(triangles);
    return most;
}

/* What looks at all pairs of triangles at a corner would take the square of their number. */
TEST(convex_polygons_of_many_corners_are_no_fans) {
    assert_int_equal(most_at_corner(128), 126);
    assert_true(most_at_corner(129) < 24);
    assert_true(most_at_corner(20000) < 48);
}

static void check_fanned(const double (*positions)[3], uint32_t count) {
    uint32_t corners[8] = {0}, triangles[8][3];
    for (uint32_t i = 0; i < count; i++) corners[i] = i;
    assert_int_equal(polygon_fill(&positions[0][0], corners, count, triangles), POLYGON_FANNED);
    for (uint32_t t = 0; t + 2 < count; t++)
        assert_true(triangles[t][0] == 0 && triangles[t][1] == t + 1 && triangles[t][2] == t + 2);
}

TEST(polygons_without_a_shape_become_fans) {
    check_fanned((const double[][3]){{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 3, 0}}, 4);            /* bow-tie */
    check_fanned((const double[][3]){{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, 4);            /* a line */
    check_fanned((const double[][3]){{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, 5); /* a place */
}

/* Corners with vertices of their own at one place get triangles without area, so that all edges have a face. */
TEST(corners_at_one_place_keep_their_edges) {
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
