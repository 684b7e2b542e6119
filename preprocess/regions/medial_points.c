/* Shrinks balls that touch a body from inside until no tile lies in them. */
#include "preprocess/regions/medial_points.h"

#include "src/core/vec3.h"

#include <math.h>

enum { POINTS_MOST = 256 };

/* The centroid that is nearest to the point, but for that of one tile. */
static uint32_t nearest_tile(const tile_graph *g, const double point[3], uint32_t except) {
    uint32_t nearest = except;
    double least = INFINITY;
    for (uint32_t i = 0; i < g->count; i++) {
        const double square = vec3_squared_distance(g->items[i].centroid, point);
        if (i == except || square >= least) continue;
        least = square;
        nearest = i;
    }
    return nearest;
}

/* False: the tile has no clear normal. */
static bool shrink_ball(const tile_graph *g, uint32_t seed, double out[3]) {
    enum { SHRINKS_MOST = 20 };
    const tile *p = &g->items[seed];
    const double length =
        sqrt(p->normal[0] * p->normal[0] + p->normal[1] * p->normal[1] + p->normal[2] * p->normal[2]);
    double radius = 1.0;
    if (!(length > 0.5 * p->area)) return false;
    for (int shrink = 0; shrink < SHRINKS_MOST; shrink++) {
        for (int k = 0; k < 3; k++) out[k] = p->centroid[k] - radius * p->normal[k] / length;
        const tile *q = &g->items[nearest_tile(g, out, seed)];
        const double square = vec3_squared_distance(p->centroid, q->centroid);
        double depth = 0.0; /* of q under the plane of p */
        for (int k = 0; k < 3; k++) depth += (p->centroid[k] - q->centroid[k]) * p->normal[k] / length;
        if (!(depth > 0.0) || square >= 2.0 * radius * depth * (1.0 - 1e-3)) return true;
        radius = square / (2.0 * depth);
    }
    return true;
}

/* Lets the point move with the tiles that its ball nearly touches. */
static void follow_tiles(const tile_graph *g, uint32_t seed, sight_point *point) {
    const double reach = 1.5 * 1.5 * vec3_squared_distance(g->items[seed].centroid, point->rest);
    double area = 0.0, ways[FRAMES_MOST][3] = {{0.0}};
    for (uint32_t i = 0; i < g->count && g->frame_count > 0; i++) {
        const tile *t = &g->items[i];
        if (vec3_squared_distance(t->centroid, point->rest) > reach) continue;
        area += t->area;
        for (uint32_t f = 0; f < g->frame_count; f++)
            for (int k = 0; k < 3; k++)
                ways[f][k] += t->area * (g->moved[(size_t)f * g->count + i].centroid[k] - t->centroid[k]);
    }
    for (uint32_t f = 0; f < g->frame_count; f++)
        for (int k = 0; k < 3; k++)
            point->moved[f][k] = point->rest[k] + ways[f][k] / (area > 0.0 ? area : 1.0);
}

static void find_points(const tile_graph *g, const double from[3], double *distances, medial_points *out) {
    for (uint32_t i = 0; i < g->count; i++) distances[i] = vec3_squared_distance(g->items[i].centroid, from);
    for (int round = 0; round < POINTS_MOST; round++) {
        uint32_t farthest = 0;
        for (uint32_t i = 1; i < g->count; i++)
            if (distances[i] > distances[farthest]) farthest = i;
        if (distances[farthest] == 0.0 || !progress_go_on(&g->context->progress, 0.0)) return;
        for (uint32_t i = 0; i < g->count; i++) {
            const double square = vec3_squared_distance(g->items[i].centroid, g->items[farthest].centroid);
            distances[i] = round == 0 ? square : fmin(distances[i], square);
        }
        out->tiles[out->count] = farthest;
        if (!shrink_ball(g, farthest, out->points[out->count].rest)) continue;
        follow_tiles(g, farthest, &out->points[out->count++]);
    }
}

static array_list list_arrays(medial_points *m) {
    return (array_list){{ARRAY(m->points, POINTS_MOST), ARRAY(m->tiles, POINTS_MOST)}};
}

cscd_status medial_points_find(const tile_graph *g, const double from[3], medial_points *out) {
    double *distances = context_reserve(g->context, g->count, sizeof *distances);
    *out = (medial_points){0};
    if (distances == NULL || !context_reserve_all(g->context, list_arrays(out))) {
        context_free(g->context, distances);
        medial_points_free(g, out);
        return context_out_of_memory(g->context);
    }
    find_points(g, from, distances, out);
    context_free(g->context, distances);
    return context_progress_status(g->context);
}

void medial_points_free(const tile_graph *g, medial_points *m) {
    context_free_all(g->context, list_arrays(m));
}
