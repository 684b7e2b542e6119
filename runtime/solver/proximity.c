/* Pairs of features that are near each other at one moment. */
#include "runtime/solver/proximity.h"

#include "runtime/detector/contact_list.h"
#include "src/core/check.h"
#include "src/core/sort.h"
#include "src/core/struct_size.h"
#include "src/core/vec3.h"
#include "src/mesh/positions.h"
#include "src/mesh/views.h"

#include <string.h>

/* One thread describes so many pairs at a time. */
enum { PAIRS_PER_SHARE = 4096 };

static const double relative_tolerance = 0x1p-21; /* half of what is promised: the distance is rounded, too */

cscd_status proximity_check_distance(cscd_context *context, double distance) {
    if (is_positive_length(distance)) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "distance is %g, expected a length from 2^-300 to 2^300", distance);
}

/* Returns the distance between the two points that u and v name, summed from differences of coordinates, so that it
 * is as exact as these are. */
static double distance_between(const cscd_mesh *mesh, const cscd_contact *at, const double *x) {
    cscd_stencil s = mesh_stencil(mesh, at->kind, at->a, at->b, at->u, at->v);
    int base = at->kind == CSCD_CONTACT_VF ? 1 : 2;
    const double *from = x + (size_t)s.vertices[base] * 3, *first = x + (size_t)s.vertices[0] * 3;
    double apart[3];
    vec3_subtract(first, from, apart);
    for (int i = 1; i < 4; i++) {
        const double *corner = x + (size_t)s.vertices[i] * 3, *origin = i < base ? first : from;
        if (i == base) continue;
        for (int k = 0; k < 3; k++) apart[k] += s.weights[i] * (corner[k] - origin[k]);
    }
    double largest = vec3_largest(apart), scaled[3];
    if (!(largest > 0.0)) return 0.0;
    for (int k = 0; k < 3; k++) scaled[k] = apart[k] / largest;
    return largest * sqrt(vec3_dot(scaled, scaled));
}

/* Written in place, because a copy need not keep the padding. */
static void describe_pair(const cscd_mesh *mesh, const cscd_contact *at, const double *x, cscd_proximity *p) {
    memset(p, 0, sizeof *p); /* padding too: lists are compared bit for bit */
    p->kind = at->kind;
    p->a = at->a;
    p->b = at->b;
    p->distance = distance_between(mesh, at, x);
    p->u = at->u;
    p->v = at->v;
    memcpy(p->point, at->point, sizeof p->point);
    memcpy(p->normal, at->normal, sizeof p->normal);
}

/* Sorts by (kind, a, b): first by b, then by kind and a, which keeps the order by b where these are equal. */
static void sort_pairs(contact_key *keys, contact_key *spare, size_t count) {
    for (size_t i = 0; i < count; i++) keys[i].key = keys[i].contact->b;
    sort_by_number(keys, spare, count, sizeof *keys);
    for (size_t i = 0; i < count; i++)
        keys[i].key = (uint64_t)keys[i].contact->kind << 32 | keys[i].contact->a;
    sort_by_number(keys, spare, count, sizeof *keys);
}

typedef struct description {
    const cscd_mesh *mesh;
    const double *positions;
    const contact_key *keys;
    cscd_proximity *items;
    size_t count;
} description;

static void describe_share(void *data, uint32_t index) {
    const description *d = data;
    size_t begin = (size_t)index * PAIRS_PER_SHARE, end = begin + PAIRS_PER_SHARE;
    for (size_t i = begin; i < end && i < d->count; i++)
        describe_pair(d->mesh, d->keys[i].contact, d->positions, &d->items[i]);
}

cscd_status proximity_collect(cscd_detector *d, const double *positions, cscd_proximities *out) {
    size_t count;
    cscd_status status =
        contact_list_gather(&d->space, &d->exclusions, sizeof(cscd_proximity), &d->proximities, &count);
    if (status != CSCD_OK) return status;
    sort_pairs(d->proximities.keys, d->proximities.spare_keys, count);
    description all = {d->mesh, positions, d->proximities.keys, d->proximities.items, count};
    uint32_t shares = (uint32_t)((count + PAIRS_PER_SHARE - 1) / PAIRS_PER_SHARE);
    parallel_run(d->context->threads, shares, describe_share, &all);
    *out = (cscd_proximities){all.items, count};
    return CSCD_OK;
}

separation proximity_limit(double distance) {
    return (separation){distance, relative_tolerance * distance};
}

interval_search proximity_search(cscd_detector *d, const double *positions, double distance) {
    return interval_search_begin(&d->space, positions, positions, proximity_limit(distance));
}

cscd_status proximity_find(cscd_detector *d, const double *positions, double distance,
                           cscd_proximities *out) {
    interval_search search = proximity_search(d, positions, distance);
    cscd_status status = CSCD_OK;
    if (d->stages->brute_force) {
        status = interval_search_by_brute_force(&search);
    } else {
        status = bvh_rebuild_move_to(&d->rebuild, &d->space.bvh, positions, uniform_growth(distance),
                                     detector_growth(d));
        if (status == CSCD_OK) status = interval_search_everything(&search);
    }
    return status == CSCD_OK ? proximity_collect(d, positions, out) : status;
}

static cscd_status find_near_at(cscd_detector *d, const double *positions, double distance,
                                cscd_proximities *out) {
    cscd_status status = positions_check(d->context, positions, d->mesh->vertex_count, "positions");
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    status = proximity_find(d, positions, distance, out);
    if (status == CSCD_OK) status = context_loop_status(d->context);
    return status == CSCD_OK ? CSCD_OK : detector_fail_call(d, status);
}

static cscd_status find_near_views(cscd_detector *detector, const cscd_view *positions, double distance,
                                   cscd_proximities *out, size_t size) {
    cscd_context *context = detector->context;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_find_near: out is NULL");
    const double *x = NULL;
    cscd_proximities found;
    cscd_status status = proximity_check_distance(context, distance);
    if (status == CSCD_OK)
        status = views_read(context, detector->mesh, positions, "positions", &detector->unpacked[0], &x);
    if (status == CSCD_OK) status = find_near_at(detector, x, distance, &found);
    if (status == CSCD_OK) struct_give(out, size, &found, sizeof found);
    return status;
}

cscd_status cscd_detector_find_near_sized(cscd_detector *detector, const cscd_view *positions,
                                          double distance, cscd_proximities *out, size_t size) {
    if (detector == NULL) return CSCD_INVALID_ARGUMENT;
    context_entry entry;
    if (!context_enter(detector->context, &entry)) return entry.status;
    return context_leave(&entry, find_near_views(detector, positions, distance, out, size));
}
