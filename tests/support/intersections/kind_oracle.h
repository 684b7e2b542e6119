/* How do two triangles intersect? Decided by their intersection as a set of points, in rational numbers; it shares no
 * code with the library. */
#pragma once

#include "tests/support/intersections/feature_oracle.h"

#include "cscd/surface.h"

/* The kind of a pair that intersects, or is a duplicate; -1 for all others. names: of vertices, NULL: their indices. What
 * seams leave out is -1, too, unless by_index is set: then names only say which vertices are shared. Coordinates up to
 * 100. */
int oracle_kind(const uint32_t a[3], const uint32_t b[3], const uint32_t *names, bool by_index,
                const integer_vector *points);

/* How many vertices they share, if the names of a triangle's corners are different. */
uint32_t oracle_shared(const uint32_t a[3], const uint32_t b[3], const uint32_t *names);
