/* Pairs of features that are near each other at one moment. */
#include "runtime/solver/proximity.h"

#include "runtime/bvh/bvh_rebuild.h"
#include "runtime/detector/contact_list.h"
#include "src/core/check.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"
#include "src/mesh/positions.h"

#include <string.h>

/* What one thread describes at a time. */
enum { PAIRS_PER_SHARE = 4096 };

/* A contact, and a part of its name as a number. */
typedef struct name_key {
    uint64_t key;
    const cscd_contact *of;
} name_key;

_Static_assert(sizeof(cscd_proximity) <= sizeof(cscd_contact) && 2 * sizeof(name_key) <= sizeof(cscd_contact),
               "proximities and keys are where contacts are otherwise");

static const double relative_tolerance = 0x1p-21; /* half of what is promised: the distance is rounded, too */

cscd_status proximity_check_distance(cscd_context *context, double distance) {
    if (is_positive_length(distance)) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "distance is %g, expected a length from 2^-300 to 2^300", distance);
}

/* From the point that v names on b, or u and v on the face, to the one on a: by differences, so that it is as
 * exact as they are. */
static double distance_between(const cscd_mesh *mesh, const cscd_contact *at, const double *x) {
    cscd_stencil s = cscd_mesh_stencil(mesh, at->kind, at->a, at->b, at->u, at->v);
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

/* In place, for a copy need not keep the padding. */
static void describe(const cscd_mesh *mesh, const cscd_contact *at, const double *x, cscd_proximity *p) {
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

/* The lanes' contacts by (kind, a, b): first by b, then, which keeps that order, by the rest. */
static void sort_names(name_key *keys, name_key *scratch, size_t count) {
    for (size_t i = 0; i < count; i++) keys[i].key = keys[i].of->b;
    sort_by_number(keys, scratch, count, sizeof *keys);
    for (size_t i = 0; i < count; i++) keys[i].key = (uint64_t)keys[i].of->kind << 32 | keys[i].of->a;
    sort_by_number(keys, scratch, count, sizeof *keys);
}

typedef struct description {
    const cscd_mesh *mesh;
    const double *positions;
    const name_key *keys;
    cscd_proximity *items;
    size_t count;
} description;

static void describe_share(void *data, uint32_t index) {
    const description *d = data;
    size_t begin = (size_t)index * PAIRS_PER_SHARE, end = begin + PAIRS_PER_SHARE;
    for (size_t i = begin; i < end && i < d->count; i++)
        describe(d->mesh, d->keys[i].of, d->positions, &d->items[i]);
}

cscd_status proximity_collect(cscd_detector *d, const double *positions, cscd_proximities *out) {
    size_t found = 0, kept = 0;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) found += d->contact_lanes[i].count;
    cscd_status status = result_buffer_reserve(d->context, &d->contacts, found, sizeof(cscd_contact));
    if (status == CSCD_OK) status = contact_list_reserve_lanes(d, found);
    if (status != CSCD_OK) return status;
    name_key *keys = d->contacts.scratch;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        const contact_lane *lane = &d->contact_lanes[i];
        for (size_t j = 0; j < lane->count; j++) {
            keys[kept].of = &lane->contacts[j];
            kept += !contact_list_leaves_out(d, &lane->contacts[j]);
        }
    }
    sort_names(keys, keys + found, kept);
    description all = {d->mesh, positions, keys, d->contacts.items, kept};
    uint32_t shares = (uint32_t)((kept + PAIRS_PER_SHARE - 1) / PAIRS_PER_SHARE);
    parallel_run(d->context->threads, shares, describe_share, &all);
    *out = (cscd_proximities){all.items, kept};
    return CSCD_OK;
}

separation proximity_limit(double distance) {
    return (separation){distance, relative_tolerance * distance};
}

interval_search proximity_search(cscd_detector *d, const double *positions, double distance) {
    return interval_search_begin(d, positions, positions, proximity_limit(distance));
}

static cscd_status find_near(cscd_detector *d, const double *positions, double distance,
                             cscd_proximities *out) {
    interval_search search = proximity_search(d, positions, distance);
    cscd_status status = CSCD_OK;
    if (d->stages->brute_force) {
        status = interval_search_by_brute_force(&search);
    } else {
        status = bvh_rebuild_move_to(&d->rebuild, &d->bvh, positions, distance, d->limit.distance);
        if (status == CSCD_OK) status = interval_search_everything(&search);
    }
    return status == CSCD_OK ? proximity_collect(d, positions, out) : status;
}

cscd_status cscd_detector_near(cscd_detector *detector, const double *positions, double distance,
                               cscd_proximities *out) {
    if (detector == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = detector->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_near: out is NULL");
    cscd_status status = proximity_check_distance(context, distance);
    if (status == CSCD_OK)
        status = positions_check(context, positions, detector->mesh->vertex_count, "positions");
    if (status != CSCD_OK) return status;
    cscd_proximities found;
    call_begin(detector);
    status = find_near(detector, positions, distance, &found);
    if (status != CSCD_OK) return call_fail(detector, status);
    *out = found;
    return CSCD_OK;
}
