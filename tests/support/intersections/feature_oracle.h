/* Do two triangles intersect? Decided by the definition, feature pair by feature pair, on small integers. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

typedef struct integer_vector {
    int64_t x, y, z;
} integer_vector;

integer_vector integer_cross(integer_vector a, integer_vector b);
int64_t integer_dot(integer_vector a, integer_vector b);

/* Has a vertex or an edge of one triangle a point in common with the face of the other, or an edge with an edge?
 * Features that share a vertex, by the names of their vertices or, where names is NULL, by their indices, do not count.
 * Coordinates up to 1000. */
bool oracle_intersects(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                       const integer_vector *points);
