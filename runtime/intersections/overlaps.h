/* The areas and volumes that objects bury of each other, by the patches and by the triangles that curves cut. */
#pragma once

#include "runtime/intersections/triangle_cuts.h"

/* A share of the overlap of two objects; key: a in the upper half, b in the lower one. */
typedef struct overlap_share {
    uint64_t key;
    double area_a, area_b;
    double flux; /* three times the volume that is behind the surface as seen from the origin */
} overlap_share;

/* What is measured of one object in a triangle. */
typedef struct cut_share {
    double buried;         /* its number is 1 or more */
    double buried_outside; /* that, and the number of the triangle's own object is 0 */
    double once;           /* its number is 1 */
    double inverted;       /* its number is below 0 */
} cut_share;

/* The memory of all calls; begins with the context, also of cuts, and nothing else set. */
typedef struct overlap_finder {
    cscd_context *context;
    overlap_share *shares, *spare_shares;
    size_t share_count, share_capacity;
    double *patch_areas, *patch_fluxes;
    size_t patch_capacity;
    cut_share *slot_shares;
    size_t slot_capacity;
    triangle_cuts cuts;
    cscd_overlap *overlaps;
    size_t overlap_capacity;
} overlap_finder;

void overlap_finder_free(overlap_finder *o);

/* *out lives until the next call. OUT_OF_MEMORY has no sentence. */
cscd_status overlap_finder_run(overlap_finder *o, const surface_cuts *found, cscd_overlaps *out);
