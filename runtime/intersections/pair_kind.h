/* How two triangles intersect: crossing, in one plane, or touching only. The answer is exact. */
#pragma once

#include "cscd/intersections.h"

typedef struct pair_kind {
    cscd_intersection_kind kind;
    uint32_t shared; /* corners of the one whose names the other has */
} pair_kind;

/* a and b: the vertices of two different triangles; names: per vertex, vertices of one name count as one, NULL: each is
 * its own; positions: packed. False: they do not intersect in the sense of triangles_intersect, which knows no names,
 * and have not the same three vertices and an area. *out is written only if they do. */
bool pair_kind_find(const uint32_t a[3], const uint32_t b[3], const uint32_t *names, const double *positions,
                    pair_kind *out);

/* How many corners of the one have a name that the other has too: what pair_kind_find writes. */
uint32_t pair_kind_count_shared(const uint32_t a[3], const uint32_t b[3], const uint32_t *names);
