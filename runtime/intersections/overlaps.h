/* The areas and volumes that bodies bury of each other, by the patches and by the triangles that curves cut. */
#pragma once

#include "runtime/intersections/overlap_gaps.h"

/* A share of the overlap of two bodies; key: a in the upper half, b in the lower one. */
typedef struct overlap_share {
    uint64_t key;
    double area_a, area_b;
    double bounding;  /* an area that bounds what both contain, as often as it does; of a patch how often */
    const double *at; /* a point of it, or of its plane and the overlap */
    uint32_t triangle, patch; /* patch: all its whole triangles, else UINT32_MAX */
} overlap_share;

/* Of the whole triangles of a patch. */
typedef struct patch_sum {
    double area;
    double normal[3]; /* as long as the area, and of closed components only, as the flux */
    double flux;      /* three times the volume that is behind them as seen from the patch's example */
} patch_sum;

/* What is measured of one body in a triangle. */
typedef struct cut_share {
    double buried;    /* its number is 1 or more */
    double inverted;  /* its number is below 0 */
    double bounding;  /* that of the triangle's own body is 0, times how often this one contains it */
    const double *at; /* a point of the triangle, near what is buried */
} cut_share;

/* The memory of all calls; begins with the context, also of cuts and gaps, and nothing else set. */
typedef struct overlap_finder {
    cscd_context *context;
    overlap_share *shares, *spare_shares;
    size_t share_count, share_capacity;
    patch_sum *patch_sums;
    size_t patch_capacity;
    cut_share *slot_shares;
    size_t slot_capacity;
    triangle_cuts cuts;
    overlap_gaps gaps;
    cscd_overlap *overlaps;
    size_t overlap_capacity;
} overlap_finder;

void overlap_finder_free(overlap_finder *o);

/* *out lives until the next call. OUT_OF_MEMORY has no sentence. */
cscd_status overlap_finder_run(overlap_finder *o, const surface_cuts *found, const left_out_pairs *left_out,
                               cscd_overlaps *out);
