/* Growth of a cluster, ring by ring, until what is left of its component falls apart. */
#pragma once

#include "preprocess/regions/dual_graph.h"

/* Workspace for many growths, and the result of the last one. */
typedef struct growth {
    const cscd_mesh *mesh;
    const dual_graph *graph;
    const double *areas; /* of the triangles */

    /* The component's triangles by ring: the cluster is ring 0, ring i + 1 touches ring i. */
    uint32_t reached_count;
    uint32_t *reached;
    uint32_t *rings; /* of each triangle; UINT32_MAX outside the component */

    /* After a separation: the band is made of the rings 0 .. band_ring and of islands, which are parts below
     * the relevant area. parts[t] is 0 there, else 1 .. part_count, numbered in the order of `reached`. */
    uint32_t band_ring, part_count, largest_part;
    uint32_t *parts;

    uint32_t *sets, *relevant_counts, *vertex_stamps, stamp;
    double *set_areas;
} growth;

cscd_status growth_create(const cscd_mesh *mesh, const dual_graph *graph, const double *areas, growth *out);
void growth_destroy(growth *g);

/* Grows by as few rings as leave two parts of relevant_area or more, and half as many again if more parts
 * come off by then. may_grow false: the cluster alone must separate them. false: it never happens. */
bool growth_separates(growth *g, const uint32_t *cluster, uint32_t cluster_size, bool may_grow,
                      double relevant_area);
