/* Do two triangles of one mesh meet, features that share a vertex aside? Exact. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* True when an edge or vertex of one triangle has a point in common with the face of the other, or an edge
 * with an edge, two features that share a vertex (by index) never counting. Closed features: touching counts.
 * a, b: vertex indices of two different triangles; positions: packed xyz of the whole mesh. */
bool triangles_intersect(const uint32_t a[3], const uint32_t b[3], const double *positions);

/* The same where vertices with the same name count as one, wherever they are. */
bool triangles_intersect_by_names(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                                  const double *positions);
