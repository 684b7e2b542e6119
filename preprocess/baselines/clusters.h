/* Clusters: triangles of low charge that are joined by edges (Yeh 2012, section 3.3). */
#pragma once

#include "src/mesh/mesh.h"

/* Cluster i is triangles[offsets[i] .. offsets[i + 1]); clusters are in the order of their first triangles. */
typedef struct clusters {
    uint32_t count;
    uint32_t *offsets, *triangles;
} clusters;

/* Finds the clusters of the triangles whose equalized density is below the threshold, in the components that are closed and no
 * obstacles. */
cscd_status clusters_find(const cscd_mesh *mesh, const double *equalized, double threshold, clusters *out);
void clusters_free(const cscd_mesh *mesh, clusters *found);
