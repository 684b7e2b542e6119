/* Clusters: edge-connected triangles of low charge. */
#pragma once

#include "preprocess/regions/dual_graph.h"

/* Cluster i is triangles[offsets[i] .. offsets[i + 1]); clusters are in the order of their first
 * triangles. */
typedef struct clusters {
    uint32_t count;
    uint32_t *offsets, *triangles;
} clusters;

/* Marks the triangles whose equalized density is at most threshold. */
cscd_status clusters_find(const cscd_mesh *mesh, const dual_graph *graph, const double *equalized,
                          double threshold, clusters *out);
void clusters_free(const cscd_mesh *mesh, clusters *found);
