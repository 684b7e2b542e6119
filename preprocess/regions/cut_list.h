/* The cuts that a charge suggests: sets of triangles, each to be cut off from the rest of its component. */
#pragma once

#include "preprocess/regions/clusters.h"

/* Cut i cuts off triangles[offsets[i] .. offsets[i + 1]). */
typedef struct cut_list {
    uint32_t count, capacity;
    size_t *offsets;
    int64_t *costs; /* the sum of weights along each, in one unit */
    uint32_t *triangles;
    size_t triangle_capacity;
} cut_list;

/* Limits below which clusters and parts count as small; see region_options. */
typedef struct cut_limits {
    double growing_share, part_share;
} cut_limits;

/* Each cluster that separates its component, at once or grown, gives one cut for each of its parts but the
 * largest. areas are those of the triangles, weights those of the mesh's edges: a cut has the least sum. */
cscd_status cut_list_find(const cscd_mesh *mesh, const dual_graph *graph, const clusters *found,
                          const double *areas, const double *weights, cut_limits limits, cut_list *out);
void cut_list_free(const cscd_mesh *mesh, cut_list *cuts);
