/* The shortest cut through a band of triangles: a minimum cut of the dual graph, by maximum flow. */
#pragma once

#include "preprocess/regions/dual_graph.h"

/* Workspace for many cuts. Capacities belong to the graph's links and are the same at both ends. */
typedef struct cutter {
    const cscd_mesh *mesh;
    const dual_graph *graph;
    const int64_t *capacities;
    int64_t *residuals;         /* of the links that leave a triangle of the band */
    int64_t *supplies, *drains; /* of a triangle, straight from the part and to the other parts */
    uint32_t *levels, *current; /* distance from the part's border; the next link to try */
    uint32_t *queue, *path;     /* triangles; links */
    int64_t cost;               /* of the last cut */
} cutter;

cscd_status cutter_create(const cscd_mesh *mesh, const dual_graph *graph, const int64_t *capacities,
                          cutter *out);
void cutter_destroy(cutter *c);

/* parts: 0 in the band, else the part's number; parts touch the band only. Separates `part` from all others
 * at the least sum of capacities and lists the triangles of the band that stay with it, of all such cuts the
 * one with the fewest. The lists for different parts of one band have no triangle in common. Returns their
 * number. */
uint32_t cutter_separate(cutter *c, const uint32_t *parts, const uint32_t *band, uint32_t band_size,
                         uint32_t part, uint32_t *out);
