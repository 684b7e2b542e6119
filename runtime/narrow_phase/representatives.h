/* Which triangle answers for a feature, so that each pair of features is tested once. */
#pragma once

#include "src/mesh/mesh.h"

/* A feature's representative is the first triangle of its star (Tang et al. 2009). The pair of the
 * representatives answers for a pair of features, unless it is one of adjacent triangles that are left out.
 */
typedef struct representatives {
    uint8_t *owned; /* per triangle: bit i says that it represents its vertex i, bit 3 + i its edge i */
    uint32_t (*others)[2]; /* per vertex: the other vertices of its representative */
    uint32_t *opposite;    /* per edge: the vertex of its representative that is not the edge's */
} representatives;

/* On failure *out holds nothing. */
cscd_status representatives_create(const cscd_mesh *mesh, representatives *out);
void representatives_free(cscd_context *context, representatives *r);
