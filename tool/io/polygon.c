/* Looks at a polygon in the plane of two coordinates, and fills it there: a fan where that is right, else by
 * clipping ears. */
#include "tool/io/mesh_builder.h"

#include "tool/io/io.h"
#include "tool/io/polygon.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* The two coordinates that span a plane, in the order in which the polygon runs counter-clockwise there. */
typedef struct polygon_plane {
    int x, y;
} polygon_plane;

static void fill_by_fan(const uint32_t *corners, uint32_t corner_count, uint32_t (*triangles)[3]) {
    for (uint32_t i = 0; i + 2 < corner_count; i++) {
        triangles[i][0] = corners[0];
        triangles[i][1] = corners[i + 1];
        triangles[i][2] = corners[i + 2];
    }
}

/* Twice the area vector: the sum of the cross products of a fan, relative to the first corner. */
static void measure_area(const double *positions, const uint32_t *corners, uint32_t corner_count,
                         double area[3]) {
    const double *origin = positions + 3 * (size_t)corners[0];
    double before[3] = {0.0, 0.0, 0.0};
    area[0] = area[1] = area[2] = 0.0;
    for (uint32_t i = 1; i < corner_count; i++) {
        const double *p = positions + 3 * (size_t)corners[i];
        const double side[3] = {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            area[k] += before[l] * side[m] - before[m] * side[l];
        }
        for (int k = 0; k < 3; k++) before[k] = side[k];
    }
}

/* Planes in which the polygon has an area, the one with the largest first; returns how many there are. */
static int list_planes(const double area[3], polygon_plane planes[3]) {
    int axes[3] = {0, 1, 2}, count = 0;
    for (int i = 0; i < 2; i++) {
        for (int j = i + 1; j < 3; j++) {
            if (fabs(area[axes[j]]) <= fabs(area[axes[i]])) continue;
            const int swap = axes[i];
            axes[i] = axes[j];
            axes[j] = swap;
        }
    }
    for (int i = 0; i < 3; i++) {
        const int l = (axes[i] + 1) % 3, m = (axes[i] + 2) % 3;
        if (area[axes[i]] > 0.0) planes[count++] = (polygon_plane){l, m};
        if (area[axes[i]] < 0.0) planes[count++] = (polygon_plane){m, l};
    }
    return count;
}

/* Chains of corners at one place, of which the filling uses the first one only. */
typedef struct polygon_places {
    double (*points)[2];
    uint32_t *corners; /* the first corner of each place, by its number in the polygon */
    uint32_t count;
} polygon_places;

static bool at_one_place(const double *positions, uint32_t a, uint32_t b) {
    const double *p = positions + 3 * (size_t)a, *q = positions + 3 * (size_t)b;
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

static void project_places(const double *positions, const uint32_t *corners, polygon_plane plane,
                           polygon_places *places) {
    for (uint32_t i = 0; i < places->count; i++) {
        const double *p = positions + 3 * (size_t)corners[places->corners[i]];
        places->points[i][0] = p[plane.x];
        places->points[i][1] = p[plane.y];
    }
}

static bool lies_before(const double a[2], const double b[2]) {
    return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
}

/* Convex, without corners on a line, and around once: from left to right and back. */
static bool is_convex(const polygon_places *places) {
    uint32_t changes = 0;
    const uint32_t n = places->count;
    for (uint32_t i = 0; i < n; i++) {
        const double *a = places->points[i], *b = places->points[(i + 1) % n],
                     *c = places->points[(i + 2) % n];
        if (orientation_of(a, b, c) <= 0) return false;
        changes += lies_before(a, b) != lies_before(b, c);
    }
    return changes == 2;
}

static bool sides_cross(const double *a, const double *b, const double *c, const double *d) {
    if (fmax(a[0], b[0]) < fmin(c[0], d[0]) || fmax(c[0], d[0]) < fmin(a[0], b[0]) ||
        fmax(a[1], b[1]) < fmin(c[1], d[1]) || fmax(c[1], d[1]) < fmin(a[1], b[1]))
        return false;
    return orientation_of(a, b, c) * orientation_of(a, b, d) < 0 &&
           orientation_of(c, d, a) * orientation_of(c, d, b) < 0;
}

/* Ears may fill a polygon that crosses itself as well, by triangles that lie twofold in places. All pairs of
 * sides are looked at, but not where that takes longer than the ears. */
static bool crosses_itself(const polygon_places *places) {
    enum { SIDES_MAX = 128 };
    const uint32_t n = places->count;
    if (n > SIDES_MAX) return false;
    for (uint32_t i = 2; i < n; i++)
        for (uint32_t j = 0; j + 1 < i; j++)
            if (sides_cross(places->points[i], places->points[(i + 1) % n], places->points[j],
                            places->points[j + 1]))
                return true;
    return false;
}

/* A fan gives its first corner a triangle for each side, and what looks at all pairs of triangles at a vertex
 * takes the square of their number. Clipped ears give a corner about the logarithm. */
enum { FAN_CORNERS_MOST = 128 };

/* Fills in one plane; false: its triangles would overlap there. */
static bool fill_in_plane(const double *positions, const uint32_t *corners, polygon_plane plane,
                          polygon_places *places, uint32_t (*triangles)[3], bool *out_of_memory) {
    project_places(positions, corners, plane, places);
    if (places->count > FAN_CORNERS_MOST || !is_convex(places))
        return ear_clipping_fill((const double(*)[2])places->points, places->count, triangles,
                                 out_of_memory) &&
               !crosses_itself(places);
    for (uint32_t i = 0; i + 2 < places->count; i++) {
        triangles[i][0] = 0;
        triangles[i][1] = i + 1;
        triangles[i][2] = i + 2;
    }
    return true;
}

/* Turns places into vertices, and adds a triangle without area for each further corner at a place, so that
 * its edges have their face. */
static void name_vertices(const uint32_t *corners, uint32_t corner_count, const polygon_places *places,
                          uint32_t (*triangles)[3]) {
    for (uint32_t i = 0; i + 2 < places->count; i++)
        for (int k = 0; k < 3; k++) triangles[i][k] = corners[places->corners[triangles[i][k]]];
    uint32_t filled = places->count - 2;
    for (uint32_t i = 0; i < places->count; i++) {
        const uint32_t first = places->corners[i];
        const uint32_t end =
            i + 1 < places->count ? places->corners[i + 1] : corner_count + places->corners[0];
        for (uint32_t extra = first + 1; extra < end; extra++) {
            triangles[filled][0] = corners[first];
            triangles[filled][1] = corners[extra % corner_count];
            triangles[filled][2] = corners[(extra + 1) % corner_count];
            filled++;
        }
    }
}

static polygon_result fill_places(const double *positions, const uint32_t *corners, uint32_t corner_count,
                                  polygon_places *places, uint32_t (*triangles)[3]) {
    double area[3];
    polygon_plane planes[3];
    measure_area(positions, corners, corner_count, area);
    const int plane_count = places->count >= 3 ? list_planes(area, planes) : 0;
    for (int i = 0; i < plane_count; i++) {
        bool out_of_memory = false;
        if (fill_in_plane(positions, corners, planes[i], places, triangles, &out_of_memory)) {
            name_vertices(corners, corner_count, places, triangles);
            return POLYGON_FILLED;
        }
        if (out_of_memory) return POLYGON_OUT_OF_MEMORY;
    }
    fill_by_fan(corners, corner_count, triangles);
    return POLYGON_FANNED;
}

static polygon_places find_places(const double *positions, const uint32_t *corners, uint32_t corner_count,
                                  double (*points)[2], uint32_t *firsts) {
    polygon_places places = {points, firsts, 0};
    for (uint32_t i = 0; i < corner_count; i++)
        if (!at_one_place(positions, corners[i], corners[i > 0 ? i - 1 : corner_count - 1]))
            firsts[places.count++] = i;
    return places;
}

polygon_result polygon_fill(const double *positions, const uint32_t *corners, uint32_t corner_count,
                            uint32_t (*triangles)[3]) {
    enum { FEW = 16 };
    if (corner_count == 3) {
        fill_by_fan(corners, corner_count, triangles);
        return POLYGON_FILLED;
    }
    double few_points[FEW][2];
    uint32_t few_firsts[FEW];
    const bool many = corner_count > FEW;
    double(*points)[2] = many ? io_realloc(NULL, (size_t)corner_count * sizeof *points) : few_points;
    uint32_t *firsts = many ? io_realloc(NULL, (size_t)corner_count * sizeof *firsts) : few_firsts;
    polygon_result result = POLYGON_OUT_OF_MEMORY;
    if (points != NULL && firsts != NULL) {
        polygon_places places = find_places(positions, corners, corner_count, points, firsts);
        result = fill_places(positions, corners, corner_count, &places, triangles);
    }
    if (many) {
        free(points);
        free(firsts);
    }
    return result;
}
