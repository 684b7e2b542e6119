/* Points in the middle of a body: the centres of balls that touch it from inside (Ma, Bae, Choi 2012). */
#pragma once

#include "preprocess/regions/sight.h"

typedef struct medial_points {
    uint32_t count;
    sight_point *points;
    uint32_t *tiles; /* that the balls touch */
} medial_points;

/* The balls touch tiles that are far from each other, beginning with the one farthest from a point; at most 256. */
cscd_status medial_points_find(const tile_graph *g, const double from[3], medial_points *out);
void medial_points_free(const tile_graph *g, medial_points *m);
