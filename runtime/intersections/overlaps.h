/* The areas and volumes that objects bury of each other, by the patches and by the triangles that curves cut. */
#pragma once

#include "runtime/intersections/curves.h"
#include "runtime/intersections/cut_triangle.h"
#include "runtime/intersections/patches.h"

/* A share of the overlap of two objects; key: a in the upper half, b in the lower one. */
typedef struct overlap_share {
    uint64_t key;
    double area_a, area_b;
    double flux; /* three times the volume that is behind the surface as seen from the origin */
} overlap_share;

/* The memory of all calls. */
typedef struct overlap_finder {
    cscd_context *context;
    overlap_share *shares, *spare_shares;
    size_t share_count, share_capacity;
    double *patch_areas, *patch_fluxes;
    size_t patch_capacity;
    curve_key *keys, *spare_keys; /* of the pieces' triangles */
    size_t key_capacity;
    cut_memory cuts;
    cut_line *lines;
    cut_border *borders;
    int32_t *corner_numbers;
    cut_share *slot_shares;
    uint32_t *slot_objects;
    size_t cut_capacity; /* of these five; of corner_numbers three times as much */
    cscd_overlap *overlaps;
    size_t overlap_capacity;
} overlap_finder;

void overlap_finder_free(overlap_finder *o);

/* What has been found at one moment. */
typedef struct overlap_input {
    const named_surface *surface;
    const curve_joiner *curves;
    const patch_finder *patches;
} overlap_input;

/* *out lives until the next call. OUT_OF_MEMORY has no sentence. */
cscd_status overlap_finder_run(overlap_finder *o, const overlap_input *input, cscd_overlaps *out);
