/* The oracle counts in whole numbers: areas, edges, and how often points lie in triangles. */
#include "tests/support/io/flat_polygon.h"

#include "tests/support/test.h"
#include "tool/io/polygon.h"

#include <string.h>

int64_t flat_cross(const int64_t a[2], const int64_t b[2], const int64_t c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

void flat_polygon_add(flat_polygon *p, int64_t x, int64_t y) {
    assert_true(p->vertex_count < FLAT_CORNERS_MAX && p->corner_count < FLAT_CORNERS_MAX);
    p->points[p->vertex_count][0] = x;
    p->points[p->vertex_count][1] = y;
    p->corners[p->corner_count++] = p->vertex_count++;
}

/* ---- the oracle -------------------------------------------------------------------------------------- */

int64_t flat_polygon_area(const flat_polygon *p) {
    int64_t sum = 0;
    for (uint32_t i = 0; i < p->corner_count; i++) {
        const int64_t *a = p->points[p->corners[i]], *b = p->points[p->corners[(i + 1) % p->corner_count]];
        sum += a[0] * b[1] - a[1] * b[0];
    }
    return sum;
}

int flat_polygon_winding(const flat_polygon *p, const int64_t z[2]) {
    int winding = 0;
    for (uint32_t i = 0; i < p->corner_count; i++) {
        const int64_t *a = p->points[p->corners[i]], *b = p->points[p->corners[(i + 1) % p->corner_count]];
        if (a[1] <= z[1] && b[1] > z[1]) winding += flat_cross(a, b, z) > 0;
        if (b[1] <= z[1] && a[1] > z[1]) winding -= flat_cross(a, b, z) < 0;
    }
    return winding;
}

/* Whether each edge of the triangles is one of the polygon, or has its reverse. */
static void check_edges(const flat_polygon *p, const uint32_t (*triangles)[3]) {
    static int16_t count[FLAT_CORNERS_MAX][FLAT_CORNERS_MAX];
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
        const int64_t area = flat_cross(p->points[v[0]], p->points[v[1]], p->points[v[2]]);
        assert_true(area > 0);
        sum += area;
    }
    assert_true(sum == flat_polygon_area(p));
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
                    flat_cross(doubled.points[triangles[t][k]], doubled.points[triangles[t][(k + 1) % 3]], z);
                least = turn < least ? turn : least;
                on_edge |= turn == 0;
            }
            inside += least > 0;
        }
        if (!on_edge) assert_int_equal(inside, flat_polygon_winding(&doubled, z));
    }
}

void flat_polygon_check(const flat_polygon *p, random_stream *random) {
    const int axis = (int)stream_below(random, 3), swapped = (int)stream_below(random, 2);
    const uint32_t start = stream_below(random, p->corner_count);
    const double slope[2] = {stream_below(random, 7) / 8.0 - 0.375, stream_below(random, 7) / 8.0 - 0.375};
    double positions[FLAT_CORNERS_MAX * 3];
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        const double x = (double)p->points[v][0], y = (double)p->points[v][1];
        positions[v * 3 + (uint32_t)((axis + 1) % 3)] = swapped ? y : x;
        positions[v * 3 + (uint32_t)((axis + 2) % 3)] = swapped ? x : y;
        positions[v * 3 + (uint32_t)axis] = slope[0] * x + slope[1] * y;
    }
    uint32_t corners[FLAT_CORNERS_MAX], triangles[FLAT_CORNERS_MAX][3];
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

static bool on_segment(const int64_t a[2], const int64_t b[2], const int64_t z[2]) {
    return flat_cross(a, b, z) == 0 && (z[0] - a[0]) * (z[0] - b[0]) + (z[1] - a[1]) * (z[1] - b[1]) <= 0;
}

bool flat_segments_meet(const int64_t a[2], const int64_t b[2], const int64_t c[2], const int64_t d[2]) {
    const int64_t abc = flat_cross(a, b, c), abd = flat_cross(a, b, d), cda = flat_cross(c, d, a),
                  cdb = flat_cross(c, d, b);
    if (((abc > 0) != (abd > 0)) && ((cda > 0) != (cdb > 0)) && abc != 0 && abd != 0 && cda != 0 && cdb != 0)
        return true;
    return on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b);
}

bool flat_points_equal(const int64_t a[2], const int64_t b[2]) {
    return a[0] == b[0] && a[1] == b[1];
}

bool flat_polygon_is_simple(const flat_polygon *p) {
    const uint32_t n = p->corner_count;
    for (uint32_t i = 0; i < n; i++) {
        const int64_t *a = p->points[p->corners[i]], *b = p->points[p->corners[(i + 1) % n]];
        if (flat_points_equal(a, b)) return false;
        for (uint32_t j = i + 1; j < n; j++) {
            const int64_t *c = p->points[p->corners[j]], *d = p->points[p->corners[(j + 1) % n]];
            if (j == i + 1             ? on_segment(a, b, d) || on_segment(c, d, a)
                : i == 0 && j == n - 1 ? on_segment(a, b, c) || on_segment(c, d, b)
                                       : flat_segments_meet(a, b, c, d))
                return false;
        }
    }
    return true;
}
