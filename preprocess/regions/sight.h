/* How well a point sees tiles, and where the best point is. */
#pragma once

#include "preprocess/regions/tiles.h"

#include <math.h>

/* The sine of the angle between a triangle and the line of sight from which on it counts as seen well (17 degrees): what is seen at
 * a lower angle turns away at the first deformation. */
#define SEEN_WELL_SINE 0.25

/* The blindness for what is seen edge-on; for what is turned away it is 1. */
#define GRAZING_BLINDNESS 0.7

/* A point of a region at rest, and where it is in further frames: it moves with the centroid of the region's surface. */
typedef struct sight_point {
    double rest[3], moved[FRAMES_MOST][3];
} sight_point;

static inline double frame_blindness(const tile *t, const double point[3]) {
    const double away[3] = {t->centroid[0] - point[0], t->centroid[1] - point[1], t->centroid[2] - point[2]};
    const double value =
        t->height - (t->normal[0] * point[0] + t->normal[1] * point[1] + t->normal[2] * point[2]);
    if (!(value > 0.0)) return 1.0;
    const double distance = sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
    const double well = SEEN_WELL_SINE * t->area * distance;
    return value < well ? GRAZING_BLINDNESS * (1.0 - value / well) : 0.0;
}

/* From 0, the point sees the tile well, to 1, it does not see it: the mean of the rest and all frames. */
static inline double tile_blindness(const tile_graph *g, uint32_t t, const sight_point *point) {
    double sum = frame_blindness(&g->items[t], point->rest);
    for (uint32_t f = 0; f < g->frame_count; f++)
        sum += frame_blindness(&g->moved[(size_t)f * g->count + t], point->moved[f]);
    return sum / (1.0 + g->frame_count);
}

typedef struct tile_set {
    const tile_graph *g;
    const uint32_t *members;
    uint32_t count;
} tile_set;

/* The sum of blindness times area. */
double tiles_unseen(const tile_set *set, const sight_point *point);

/* The tile of a set, not empty, whose centroid is nearest to a point at rest. */
uint32_t tiles_nearest(const tile_set *set, const double point[3]);

void tiles_centroid(const tile_set *set, sight_point *out);

/* Moves the point, given at rest, to where it costs the least: what it does not see, and a little for each step away from the centroid, because the
 * centroid stays in the middle of the set however that turns and bends. It goes along the axes, by steps that become smaller. Returns
 * the cost. */
double tiles_best_point(const tile_set *set, sight_point *point);
