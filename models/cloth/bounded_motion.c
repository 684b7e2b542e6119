/* Changes the motion that a solver wants into one that displacement bounds or planes allow, without a test on the way. */
#include "models/cloth/cloth.h"
#include "models/shapes/body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A frame ends where it is when the last round brought less than this share of what was left. */
static const double least_gain = 0.02;

/* Obstacles move as a whole, a little less than the least share of any of their vertices. */
static const double share_of_least = 1.0 - 1e-9;

const char *motion_driver_name(motion_driver driver) {
    static const char *const names[DRIVER_COUNT] = {"steps", "bounds", "planes"};
    return names[driver];
}

void bounded_motion_open(cscd_detector *detector, const cscd_mesh *mesh, motion_driver driver,
                         double shortest_reach, uint32_t free_count, bounded_motion *out) {
    uint32_t count = cscd_mesh_vertex_count(mesh);
    *out = (bounded_motion){.detector = detector,
                            .mesh = mesh,
                            .driver = driver,
                            .shortest_reach = shortest_reach,
                            .free_count = free_count,
                            .vertex_count = count,
                            .most_rounds = 8};
    out->now = body_allocate((size_t)count * 3, sizeof *out->now);
    out->wanted = body_allocate((size_t)count * 3, sizeof *out->wanted);
    out->reached = body_allocate((size_t)count * 3, sizeof *out->reached);
    out->bounds = body_allocate(count, sizeof *out->bounds);
}

void bounded_motion_close(bounded_motion *b) {
    free(b->now);
    free(b->wanted);
    free(b->reached);
    free(b->bounds);
    *b = (bounded_motion){0};
}

static double distance_of(const double *a, const double *b, uint32_t vertex) {
    double sum = 0.0;
    for (size_t i = (size_t)vertex * 3; i < (size_t)vertex * 3 + 3; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum);
}

static double total_distance(const double *a, const double *b, uint32_t count) {
    double sum = 0.0;
    for (uint32_t v = 0; v < count; v++) sum += distance_of(a, b, v);
    return sum;
}

/* Twice the longest motion that is left, so that no vertex is stopped by what is not near. */
static double reach_for(const bounded_motion *b, const double *x) {
    double longest = 0.0;
    for (uint32_t v = 0; v < b->vertex_count; v++) longest = fmax(longest, distance_of(b->wanted, x, v));
    return fmin(fmax(2.01 * longest, b->shortest_reach), 2.0 * b->shortest_reach);
}

static void move_towards(const bounded_motion *b, uint32_t vertex, double share, const double *x,
                         double *out) {
    for (size_t i = (size_t)vertex * 3; i < (size_t)vertex * 3 + 3; i++)
        out[i] = share == 1.0 ? b->wanted[i] : x[i] + share * (b->wanted[i] - x[i]);
}

/* The share of its motion that a ball allows. Rounding the result needs less than 1e-6 of a ball. */
static double share_in_ball(const bounded_motion *b, const double *x, uint32_t vertex) {
    double length = distance_of(b->wanted, x, vertex), bound = b->bounds[vertex] * (1.0 - 1e-6);
    return length > bound ? bound / length : 1.0;
}

/* One round by balls: every vertex goes on as far as its own ball allows, obstacles as far as all of theirs do. */
static cscd_status go_by_bounds(bounded_motion *b, const double *x, double reach, double *obstacle_share) {
    cscd_displacement_bounds found;
    b->rounds++;
    cscd_status status = cscd_detector_displacement_bounds(b->detector, CSCD_DOUBLES(x, b->vertex_count),
                                                           reach, CSCD_SCALAR_DOUBLE, b->bounds,
                                                           b->vertex_count * sizeof *b->bounds, &found);
    if (status != CSCD_OK) return status;
    *obstacle_share = 1.0;
    for (uint32_t v = b->free_count; v < b->vertex_count; v++)
        *obstacle_share = fmin(*obstacle_share, share_in_ball(b, x, v));
    for (uint32_t v = 0; v < b->vertex_count; v++)
        move_towards(b, v, v < b->free_count ? share_in_ball(b, x, v) : *obstacle_share, x, b->reached);
    return CSCD_OK;
}

static cscd_status truncate_wanted(bounded_motion *b, const double *x, double reach, cscd_truncation *out) {
    uint32_t count = b->vertex_count;
    b->rounds++;
    return cscd_detector_truncate(b->detector, CSCD_DOUBLES(x, count), CSCD_DOUBLES(b->wanted, count), reach,
                                  CSCD_MUTABLE_DOUBLES(b->reached, count), out);
}

/* One round by planes. If some vertex of an obstacle may not go all of its way, all of them want less, and
 * then go that far. */
static cscd_status go_by_planes(bounded_motion *b, const double *x, double reach, double *obstacle_share) {
    cscd_truncation found;
    cscd_status status = truncate_wanted(b, x, reach, &found);
    *obstacle_share = 1.0;
    if (status != CSCD_OK || found.obstacle_fraction == 1.0) return status;
    *obstacle_share = found.obstacle_fraction * share_of_least;
    for (uint32_t v = b->free_count; v < b->vertex_count; v++)
        move_towards(b, v, *obstacle_share, x, b->wanted);
    return truncate_wanted(b, x, reach, &found);
}

cscd_status bounded_motion_find(bounded_motion *b, const double *x0, double *x1, double *length) {
    size_t size = (size_t)b->vertex_count * 3 * sizeof *x1;
    double *x = b->now, way = 1.0;
    memcpy(x, x0, size);
    for (uint32_t round = 0; round < b->most_rounds; round++) {
        double share, left = total_distance(x1, x, b->vertex_count);
        memcpy(b->wanted, x1, size);
        cscd_status status =
            (b->driver == DRIVER_BOUNDS ? go_by_bounds : go_by_planes)(b, x, reach_for(b, x), &share);
        if (status != CSCD_OK) return status;
        memcpy(x, b->reached, size);
        way *= 1.0 - share;
        if (round == 0) b->left_over += total_distance(x1, x, b->free_count);
        double lost = total_distance(x1, x, b->vertex_count);
        if (lost == 0.0 || left - lost < least_gain * left) break;
    }
    memcpy(x1, x, size);
    *length = 1.0 - way;
    return CSCD_OK;
}
