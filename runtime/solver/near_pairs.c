/* The pairs that displacement bounds and truncation look at: those near each other where a motion starts. */
#include "runtime/solver/near_pairs.h"

#include "runtime/ccd/ccd.h"
#include "src/core/floating.h"

#include <string.h>

/* Pairs are looked for so much farther away than they need to, which covers the rounding of the sum, too. */
static const double farther = 1.0 + 0x1p-17;

static double greatest_separation(const cscd_detector *d) {
    return max_of(d->limit.distance, d->pair_rules.greatest);
}

double near_pair_separation(const cscd_detector *d, const cscd_proximity *pair) {
    const swept_interval rules = {.mesh = d->mesh,
                                  .filter = {d->mesh, &d->pair_rules, NULL, NULL},
                                  .limit = d->limit,
                                  .thick = detector_thick(d)};
    return pair_separation(&rules, pair->kind, pair->a, pair->b).distance;
}

double near_pair_gap(const cscd_detector *d, const cscd_proximity *pair, const double points[4][3]) {
    double apart = near_pair_separation(d, pair);
    if (pair->kind == CSCD_CONTACT_VH) return half_space_gap(points, d->mesh->loose.normals[pair->b], apart);
    return pair_gap(stencil_points(pair->kind), points, apart);
}

static double search_distance(const cscd_detector *d, double search_radius) {
    return (search_radius + greatest_separation(d)) * farther;
}

cscd_status near_pairs_check_radius(const cscd_detector *d, double search_radius) {
    if (is_positive_length(search_radius) && is_positive_length(search_distance(d, search_radius)))
        return CSCD_OK;
    return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                        "search_radius is %g, expected a length from 2^-300 to 2^300, also with "
                        "min_separation added to it",
                        search_radius);
}

/* Points that have no distance to keep from a wire, or from each other, may go where they want. */
static size_t keep_counting(const cscd_detector *d, cscd_proximity *items, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        bool of_points = items[i].kind == CSCD_CONTACT_VV || items[i].kind == CSCD_CONTACT_EV;
        if (!of_points || near_pair_separation(d, &items[i]) > 0.0) items[kept++] = items[i];
    }
    return kept;
}

cscd_status near_pairs_find(cscd_detector *d, const double *x, double search_radius, cscd_proximities *out) {
    cscd_status status = proximity_find(d, x, search_distance(d, search_radius), CSCD_NEAR_PAIRS, out);
    if (status == CSCD_OK && d->mesh->loose.point_count > 0)
        out->count = keep_counting(d, d->proximities.items, out->count);
    return status;
}

void *near_pairs_scratch(cscd_detector *d, size_t count, size_t size) {
    if (d->pair_scratch != NULL && count <= d->pair_scratch_size / size) return d->pair_scratch;
    void *grown = context_allocate(d->context, count + count / 2 + 1, size);
    if (grown == NULL) return NULL;
    context_free(d->context, d->pair_scratch);
    d->pair_scratch = grown;
    d->pair_scratch_size = (count + count / 2 + 1) * size;
    return grown;
}

void near_pair_load(const double *x, const cscd_stencil *stencil, double points[4][3]) {
    for (int i = 0; i < 4; i++) memcpy(points[i], x + (size_t)stencil->vertices[i] * 3, sizeof points[i]);
}
