/* How far each vertex may go, on any path, before two features can come together. */
#include "runtime/solver/displacement_bounds.h"

#include "runtime/ccd/pair_plane.h"
#include "runtime/solver/stored_scalar.h"
#include "src/core/floating.h"

/* Half of a gap, less the share that lets callers compare rounded lengths (lemma 3). */
static const double share_of_gap = 0.5 * (1.0 - 0x1p-20);

typedef struct gap_work {
    const cscd_detector *detector;
    const double *x0;
    const cscd_proximities *near;
    cscd_scalar scalar;
    double *limits; /* per pair: how far each of its vertices may go */
} gap_work;

static void measure_share(void *data, uint32_t index) {
    const gap_work *w = data;
    const cscd_detector *d = w->detector;
    size_t begin = (size_t)index * NEAR_PAIRS_PER_SHARE, end = begin + NEAR_PAIRS_PER_SHARE;
    for (size_t i = begin; i < end && i < w->near->count; i++) {
        const cscd_proximity *pair = &w->near->items[i];
        cscd_stencil stencil = near_pair_stencil(d->mesh, pair);
        double points[4][3];
        near_pair_load(w->x0, &stencil, points);
        double gap = pair_gap(pair->kind, (const double(*)[3])points, near_pair_separation(d, pair));
        w->limits[i] = stored_below(share_of_gap * gap, w->scalar);
    }
}

static void lower_bounds(const cscd_mesh *mesh, const cscd_proximities *near, const double *limits,
                         double *bounds) {
    for (size_t i = 0; i < near->count; i++) {
        cscd_stencil stencil = near_pair_stencil(mesh, &near->items[i]);
        for (int j = 0; j < 4; j++) {
            double *bound = &bounds[stencil.vertices[j]];
            *bound = min_of(*bound, limits[i]);
        }
    }
}

/* The vertices of a seam count as one. A name is the smallest vertex of its seam. */
static void join_seams(const cscd_detector *d, double *bounds) {
    const uint32_t *names = d->exclusions.names;
    uint32_t count = names != NULL ? d->mesh->vertex_count : 0;
    for (uint32_t v = 0; v < count; v++) bounds[names[v]] = min_of(bounds[names[v]], bounds[v]);
    for (uint32_t v = 0; v < count; v++) bounds[v] = bounds[names[v]];
}

/* Keeps the pairs that do not let their vertices move, in order. */
static cscd_proximities list_blocked(cscd_proximity *items, size_t count, const double *limits) {
    size_t blocked = 0;
    for (size_t i = 0; i < count; i++) {
        if (limits[i] == 0.0) items[blocked++] = items[i];
    }
    return (cscd_proximities){items, blocked};
}

cscd_status displacement_bounds_find(cscd_detector *d, const double *x0, double search_radius,
                                     cscd_scalar scalar, double *bounds, cscd_proximities *blocked) {
    cscd_proximities near;
    cscd_status status = near_pairs_find(d, x0, search_radius, &near);
    if (status != CSCD_OK) return status;
    gap_work work = {d, x0, &near, scalar, near_pairs_scratch(d, near.count, sizeof *work.limits)};
    if (work.limits == NULL) return CSCD_OUT_OF_MEMORY;
    uint32_t shares = (uint32_t)((near.count + NEAR_PAIRS_PER_SHARE - 1) / NEAR_PAIRS_PER_SHARE);
    parallel_run(d->context->threads, shares, measure_share, &work);
    double farthest = stored_below(0.5 * search_radius, scalar);
    for (uint32_t v = 0; v < d->mesh->vertex_count; v++) bounds[v] = farthest;
    lower_bounds(d->mesh, &near, work.limits, bounds);
    join_seams(d, bounds);
    *blocked = list_blocked(d->proximities.items, near.count, work.limits);
    return CSCD_OK;
}
