/* Do two triangles of one mesh intersect, features that share a vertex aside? The test is exact. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* True when an edge or a vertex of one triangle has a point in common with the face of the other, or an edge
 * with an edge. Two features that share a vertex (by index) never count. Features are closed, so touching
 * counts. a and b are the vertex indices of two different triangles, positions the packed xyz of the whole
 * mesh. */
bool triangles_intersect(const uint32_t a[3], const uint32_t b[3], const double *positions);

/* The same, but vertices with the same name count as one vertex, wherever they are. */
bool triangles_intersect_by_names(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                                  const double *positions);
