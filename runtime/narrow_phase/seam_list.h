/* The seams that a detector was given, until it has seen that their vertices belong together. */
#pragma once

#include "src/mesh/mesh.h"

typedef struct seam_list {
    uint32_t *vertices; /* two of each pair, in the caller's order; NULL: there is nothing left to check */
    size_t count;
    double reach; /* how far apart the vertices of a pair may be; 0: as far as the edges there are long */
} seam_list;

/* Copies pairs whose vertices exist. INVALID_ARGUMENT names a pair of equal vertices. */
cscd_status seam_list_create(const cscd_mesh *mesh, const uint32_t *pairs, size_t count, double reach,
                             seam_list *out);
void seam_list_free(cscd_context *context, seam_list *s);

/* Checks the first positions that the detector is given: INVALID_ARGUMENT names the first pair whose vertices are
 * farther apart there than the reach. Once all are near, this does nothing: later they may part. */
cscd_status seam_list_check(const cscd_mesh *mesh, seam_list *s, const double *positions);
