/* The shortest cut through a band of triangles: a minimum cut of the dual graph. */
#pragma once

#include "preprocess/regions/dual_graph.h"
#include "preprocess/regions/min_cut.h"

/* Room for many cuts. Capacities belong to the graph's links and are the same at both ends. */
typedef struct cutter {
    const dual_graph *graph;
    const int64_t *capacities;
    min_cut cut;
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
