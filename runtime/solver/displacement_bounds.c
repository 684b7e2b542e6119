/* How far each vertex may go, on any path, before two features can come together. */
#include "runtime/solver/displacement_bounds.h"

#include "runtime/detector/waiting.h"
#include "runtime/solver/stored_scalar.h"
#include "src/core/floating.h"
#include "src/mesh/positions.h"
#include "src/mesh/views.h"

#include <string.h>

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
        double gap = near_pair_gap(d, pair, (const double(*)[3])points);
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

/* Keeps the pairs that do not let their vertices move, in order, and returns how many there are. */
static size_t keep_blocked(cscd_proximity *items, size_t count, const double *limits) {
    size_t blocked = 0;
    for (size_t i = 0; i < count; i++) {
        if (limits[i] == 0.0) items[blocked++] = items[i];
    }
    return blocked;
}

static void sum_up_bounds(const double *bounds, uint32_t vertex_count, double farthest,
                          cscd_displacement_bounds *out) {
    out->least = farthest;
    for (uint32_t v = 0; v < vertex_count; v++) {
        out->limited += bounds[v] < farthest;
        if (bounds[v] >= out->least) continue;
        out->least = bounds[v];
        out->vertex = v;
    }
}

cscd_status displacement_bounds_find(cscd_detector *d, const double *x0, double search_radius,
                                     cscd_scalar scalar, double *bounds, cscd_displacement_bounds *out) {
    cscd_proximities near;
    cscd_status status = near_pairs_find(d, x0, search_radius, &near);
    if (status == CSCD_LIST_TOO_LONG)
        *out = (cscd_displacement_bounds){.near_count = near.count};
    if (status != CSCD_OK) return status;
    gap_work work = {d, x0, &near, scalar, near_pairs_scratch(d, near.count, sizeof *work.limits)};
    if (work.limits == NULL) return CSCD_OUT_OF_MEMORY;
    uint32_t shares = (uint32_t)((near.count + NEAR_PAIRS_PER_SHARE - 1) / NEAR_PAIRS_PER_SHARE);
    parallel_run(d->context->threads, shares, measure_share, &work);
    double farthest = stored_below(0.5 * search_radius, scalar);
    for (uint32_t v = 0; v < d->mesh->vertex_count; v++) bounds[v] = farthest;
    lower_bounds(d->mesh, &near, work.limits, bounds);
    join_seams(d, bounds);
    *out = (cscd_displacement_bounds){
        .blocked = d->proximities.items, .near_count = near.count};
    out->blocked_count = keep_blocked(d->proximities.items, near.count, work.limits);
    sum_up_bounds(bounds, d->mesh->vertex_count, farthest, out);
    return CSCD_OK;
}

/* ---- of the API ---------------------------------------------------------------------------------------- */

static cscd_status check_array(const cscd_detector *d, double search_radius, cscd_scalar scalar,
                               const void *bounds, size_t size) {
    cscd_context *context = d->context;
    size_t wanted = d->mesh->vertex_count * (scalar == CSCD_SCALAR_FLOAT ? sizeof(float) : sizeof(double));
    if ((unsigned)scalar > CSCD_SCALAR_FLOAT)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "scalar is %d, expected CSCD_SCALAR_DOUBLE or CSCD_SCALAR_FLOAT", (int)scalar);
    if (bounds == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "bounds is NULL");
    if (size < wanted)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "bounds has %zu bytes, which is less than the %zu of %u vertices", size, wanted,
                            d->mesh->vertex_count);
    if (!(stored_below(0.5 * search_radius, scalar) > 0.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "search_radius is %g, and half of it is 0 as a float", search_radius);
    return CSCD_OK;
}

static void write_bounds(const double *bounds, uint32_t count, cscd_scalar scalar, void *out) {
    float *floats = out;
    for (uint32_t v = 0; scalar == CSCD_SCALAR_FLOAT && v < count; v++) floats[v] = (float)bounds[v];
    if (scalar == CSCD_SCALAR_DOUBLE) memcpy(out, bounds, count * sizeof *bounds);
}

static cscd_status find_bounds_at(cscd_detector *d, const double *x0, double search_radius,
                                  cscd_scalar scalar, void *bounds, cscd_displacement_bounds *out) {
    uint32_t count = d->mesh->vertex_count;
    cscd_status status = positions_check(d->context, x0, count, "x0");
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->exclusions.seams, x0);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    if (d->reached == NULL) d->reached = context_allocate(d->context, count, sizeof(double[3]));
    status = d->reached != NULL ? waiting_settle(d, x0) : CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK) status = displacement_bounds_find(d, x0, search_radius, scalar, d->reached, out);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status != CSCD_OK) return detector_fail_call(d, status);
    write_bounds(d->reached, count, scalar, bounds);
    return CSCD_OK;
}

static cscd_status find_bounds_of_views(cscd_detector *detector, const cscd_view *x0, double search_radius,
                                        cscd_scalar scalar, void *bounds, size_t size,
                                        cscd_displacement_bounds *out) {
    cscd_context *context = detector->context;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_displacement_bounds: out is NULL");
    const double *x = NULL;
    cscd_displacement_bounds found;
    cscd_status status = near_pairs_check_radius(detector, search_radius);
    if (status == CSCD_OK) status = check_array(detector, search_radius, scalar, bounds, size);
    if (status == CSCD_OK) status = views_read(context, detector->mesh, x0, "x0", &detector->unpacked[0], &x);
    if (status == CSCD_OK) status = find_bounds_at(detector, x, search_radius, scalar, bounds, &found);
    if (status == CSCD_OK || status == CSCD_LIST_TOO_LONG) *out = found;
    return status;
}

cscd_status cscd_detector_displacement_bounds(cscd_detector *detector, const cscd_view *x0,
                                              double search_radius, cscd_scalar scalar, void *bounds,
                                              size_t size, cscd_displacement_bounds *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry,
                         find_bounds_of_views(detector, x0, search_radius, scalar, bounds, size, out));
}
