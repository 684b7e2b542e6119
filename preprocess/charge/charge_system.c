/* Sets up the system of equations for the charges of one component: its unknowns and its arrays. */
#include "preprocess/charge/charge.h"

#include "src/core/sort.h"

#include <math.h>

size_t charge_system_lay_out(charge_system *system, uint32_t capacity, char *memory) {
    size_t n = capacity, used = 0;
    system->points = charge_take_array(memory, &used, n, sizeof *system->points);
    system->scratch = charge_take_array(memory, &used, n, sizeof *system->scratch);
    system->sources = charge_take_array(memory, &used, n, sizeof *system->sources);
    system->x = charge_take_array(memory, &used, n, sizeof *system->x);
    system->y = charge_take_array(memory, &used, n, sizeof *system->y);
    system->z = charge_take_array(memory, &used, n, sizeof *system->z);
    system->charges = charge_take_array(memory, &used, n, sizeof *system->charges);
    return used;
}

/* Finds the middle of the component's box, and the scale. */
static void find_frame(charge_system *system, const charge_surface *surface, const uint32_t *triangles,
                       uint32_t triangle_count, double middle[3]) {
    double extent = 0.0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < (size_t)triangle_count * 3; i++) {
            double p =
                surface->positions[(size_t)surface->triangles[triangles[i / 3]][i % 3] * 3 + (size_t)k];
            low = p < low ? p : low;
            high = p > high ? p : high;
        }
        middle[k] = 0.5 * low + 0.5 * high;
        extent = high - low > extent ? high - low : extent;
    }
    int exponent = 0;
    frexp(extent, &exponent);
    system->scale = extent > 0.0 ? ldexp(1.0, -exponent) : 1.0;
}

static void scaled_corners(const charge_system *system, const charge_surface *surface, const double middle[3],
                           uint32_t triangle, double corners[3][3]) {
    for (int i = 0; i < 3; i++) {
        const double *p = surface->positions + (size_t)surface->triangles[triangle][i] * 3;
        for (int k = 0; k < 3; k++) corners[i][k] = (p[k] - middle[k]) * system->scale;
    }
}

/* Gives the same bits for any order of the corners, so that triangles that coincide have one collocation
 * point. */
static double mean_of_three(double a, double b, double c) {
    double low = a < b ? a : b, high = a < b ? b : a;
    double middle = c;
    if (c < low) {
        middle = low;
        low = c;
    } else if (c > high) {
        middle = high;
        high = c;
    }
    return (low + middle + high) / 3.0;
}

static int by_position(const void *left, const void *right) {
    const charge_point *a = left, *b = right;
    for (int k = 0; k < 3; k++) {
        if (a->position[k] != b->position[k]) return a->position[k] < b->position[k] ? -1 : 1;
    }
    return a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

static bool same_position(const double a[3], const double b[3]) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Does each corner of a lie at a corner of b? Both have an area. */
static bool triangles_coincide(const charge_surface *surface, uint32_t a, uint32_t b) {
    for (int i = 0; i < 3; i++) {
        const double *p = surface->positions + (size_t)surface->triangles[a][i] * 3;
        bool found = false;
        for (int j = 0; j < 3; j++) {
            const double *q = surface->positions + (size_t)surface->triangles[b][j] * 3;
            found = found || same_position(p, q);
        }
        if (!found) return false;
    }
    return true;
}

/* Collects the points of all triangles that have an area, sorted. */
static void collect_points(charge_system *system, const charge_surface *surface, const double middle[3],
                           const uint32_t *triangles, uint32_t triangle_count) {
    system->point_count = 0;
    for (uint32_t i = 0; i < triangle_count; i++) {
        double corners[3][3];
        potential_source source;
        scaled_corners(system, surface, middle, triangles[i], corners);
        if (!potential_source_set(&source, corners)) continue;
        charge_point *point = &system->points[system->point_count++];
        for (int k = 0; k < 3; k++)
            point->position[k] = mean_of_three(corners[0][k], corners[1][k], corners[2][k]);
        point->triangle = triangles[i];
    }
    sort_items(system->points, system->scratch, system->point_count, sizeof *system->points, by_position);
}

static void add_unknown(charge_system *system, const double corners[3][3], const double position[3]) {
    uint32_t k = system->count++;
    potential_source_set(&system->sources[k], corners);
    system->x[k] = position[0];
    system->y[k] = position[1];
    system->z[k] = position[2];
}

cscd_status charge_system_collect(charge_system *system, const charge_surface *surface, uint32_t component,
                                  const uint32_t *triangles, uint32_t triangle_count) {
    double middle[3];
    system->component = component;
    system->count = 0;
    find_frame(system, surface, triangles, triangle_count, middle);
    collect_points(system, surface, middle, triangles, triangle_count);
    for (uint32_t i = 0; i < system->point_count; i++) {
        charge_point *point = &system->points[i], *before = point - 1;
        bool same = i > 0 && same_position(point->position, before->position);
        if (same && !triangles_coincide(surface, point->triangle, before->triangle))
            return context_fail(
                surface->context, CSCD_INVALID_ARGUMENT,
                "charge: triangles %u and %u of component %u have the same centroid but not the "
                "same corners, so their charges cannot be told apart; move or remove one",
                before->triangle, point->triangle, component);
        if (!same) {
            double corners[3][3];
            scaled_corners(system, surface, middle, point->triangle, corners);
            add_unknown(system, corners, point->position);
        }
        point->unknown = system->count - 1;
    }
    return CSCD_OK;
}

void charge_system_store(const charge_system *system, double *density, double *capacitance) {
    double sum = 0.0;
    for (uint32_t begin = 0, end; begin < system->point_count; begin = end) {
        uint32_t k = system->points[begin].unknown;
        for (end = begin; end < system->point_count && system->points[end].unknown == k; end++) continue;
        double shared = system->charges[k] / (system->sources[k].area * (double)(end - begin));
        for (uint32_t i = begin; i < end; i++) density[system->points[i].triangle] = shared * system->scale;
        sum += system->charges[k];
    }
    *capacitance = sum / system->scale;
}
