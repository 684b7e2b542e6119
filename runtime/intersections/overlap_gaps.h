/* Which overlaps have no volume, because a curve that bounds them is left out, wholly or in part. */
#pragma once

#include "runtime/intersections/triangle_cuts.h"

/* Pairs of triangles that were found and then left out. */
typedef struct left_out_pairs {
    cscd_context *context;
    uint64_t *pairs; /* a in the upper half, b in the lower one, a < b; in any order */
    size_t count, capacity;
    bool out_of_memory; /* and some may be missing */
} left_out_pairs;

void left_out_pairs_free(left_out_pairs *p);
void left_out_pairs_add(left_out_pairs *p, uint32_t a, uint32_t b);

/* The memory of all calls; begins with nothing but the context set. */
typedef struct overlap_gaps {
    cscd_context *context;
    uint64_t *bodies, *spare; /* pairs, the smaller one in the upper half, ascending */
    size_t count, capacity;
} overlap_gaps;

void overlap_gaps_free(overlap_gaps *g);

/* Finds the pairs of bodies of which a piece of a curve between closed components is left out. False: no memory. */
bool overlap_gaps_find(overlap_gaps *g, const surface_cuts *found, const left_out_pairs *left_out);

/* Is a curve left out of the two bodies a <= b, or of one of them with itself? */
bool overlap_gaps_have(const overlap_gaps *g, uint32_t a, uint32_t b);
