/* How sight weakens on the way through soft material: what lies beyond a soft place turns away from a point on this side of it at the
 * first deformation, so it counts as seen badly. */
#pragma once

#include "preprocess/regions/sight.h"

/* Rows of the least blindness of all tiles, each for a seat: a tile that the way begins at. */
typedef struct soft_paths {
    const tile_graph *g;
    uint32_t row_count;
    double *steps;   /* of links */
    double *rows;    /* g->count each; NULL: nothing is soft, and the blindness is 0 */
    uint32_t *seats; /* of rows */
    uint32_t *queue; /* tiles: a ring */
    bool *waiting;   /* in the queue */
} soft_paths;

/* Rows have no seats yet. */
cscd_status soft_paths_create(const tile_graph *g, uint32_t row_count, soft_paths *out);
void soft_paths_destroy(soft_paths *p);

/* Makes the row one of that seat. */
void soft_paths_set(soft_paths *p, uint32_t row, uint32_t seat);

/* The blindness of a tile that has this blindness by sight alone. */
static inline double soft_paths_blindness(const soft_paths *p, uint32_t row, uint32_t t, double by_sight) {
    return p->rows != NULL ? fmax(by_sight, p->rows[(size_t)row * p->g->count + t]) : by_sight;
}

/* The sum of area times blindness, beyond what the point does not see by sight alone. */
double soft_paths_unseen(const soft_paths *p, uint32_t row, const tile_set *set, const sight_point *point);
