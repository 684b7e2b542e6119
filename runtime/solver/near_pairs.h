/* The pairs that displacement bounds and truncation look at: those near each other where a motion starts. */
#pragma once

#include "runtime/solver/proximity.h"

/* Pairs are worked on in shares of so many, and vertices as well. */
enum { NEAR_PAIRS_PER_SHARE = 1024, VERTICES_PER_SHARE = 4096 };

/* Returns INVALID_ARGUMENT, with a sentence, unless pairs can be looked for within this radius. */
cscd_status near_pairs_check_radius(const cscd_detector *d, double search_radius);

/* Lists, in the detector's memory, every pair whose distance is at most its separation plus the radius, and some that
 * are farther apart. All others are farther apart than that by 2^-18 of the radius (docs/theory/displacement-bounds.md, lemma 1). */
cscd_status near_pairs_find(cscd_detector *d, const double *x, double search_radius, cscd_proximities *out);

/* Memory for count elements of size bytes, which the next call may use otherwise; NULL: there is none. */
void *near_pairs_scratch(cscd_detector *d, size_t count, size_t size);

/* The distance that the pair must keep: 0, the detector's separation, or that of the rules for its objects. */
double near_pair_separation(const cscd_detector *d, const cscd_proximity *pair);

/* Returns a number that is at most the pair's distance less what it must keep, and at least 0.985 times that; see
 * pair_gap. */
double near_pair_gap(const cscd_detector *d, const cscd_proximity *pair, const double points[4][3]);

/* Copies the points of a pair, in the order of cscd_stencil. */
void near_pair_load(const double *x, const cscd_stencil *stencil, double points[4][3]);

static inline cscd_stencil near_pair_stencil(const cscd_mesh *mesh, const cscd_proximity *pair) {
    return cscd_mesh_stencil(mesh, pair->kind, pair->a, pair->b, pair->u, pair->v);
}
