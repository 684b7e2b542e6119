/* Pairs of features that are near each other at one moment. */
#include "runtime/near.h"

#include "runtime/contact_list.h"
#include "runtime/upkeep.h"
#include "runtime/vector.h"
#include "src/positions.h"

#include <string.h>

_Static_assert(sizeof(cscd_proximity) <= sizeof(cscd_contact), "proximities are written where keys were");

static const double relative_tolerance = 0x1p-21; /* half of what is promised: the distance is rounded, too */

cscd_status near_check_distance(cscd_context *context, double distance) {
    if (distance >= 0x1p-300 && distance <= 0x1p300) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "distance is %g, expected a length from 2^-300 to 2^300", distance);
}

separation near_limit(double distance) {
    return (separation){distance, relative_tolerance * distance};
}

/* From the point that v names on b, or u and v on the face, to the one on a: by differences, so that it is as
 * exact as they are. */
static double distance_between(const cscd_mesh *mesh, const cscd_contact *at, const double *x) {
    cscd_stencil s = cscd_mesh_stencil(mesh, at->kind, at->a, at->b, at->u, at->v);
    int base = at->kind == CSCD_CONTACT_VF ? 1 : 2;
    const double *from = x + (size_t)s.vertices[base] * 3, *first = x + (size_t)s.vertices[0] * 3;
    double apart[3];
    vector_subtract(first, from, apart);
    for (int i = 1; i < 4; i++) {
        const double *corner = x + (size_t)s.vertices[i] * 3, *origin = i < base ? first : from;
        if (i == base) continue;
        for (int k = 0; k < 3; k++) apart[k] += s.weights[i] * (corner[k] - origin[k]);
    }
    double largest = vector_largest(apart), scaled[3];
    if (!(largest > 0.0)) return 0.0;
    for (int k = 0; k < 3; k++) scaled[k] = apart[k] / largest;
    return largest * sqrt(vector_dot(scaled, scaled));
}

static cscd_proximity proximity_of(const cscd_mesh *mesh, const cscd_contact *at, const double *x) {
    cscd_proximity p;
    memset(&p, 0, sizeof p); /* padding too: lists are compared bit for bit */
    p.kind = at->kind;
    p.a = at->a;
    p.b = at->b;
    p.distance = distance_between(mesh, at, x);
    p.u = at->u;
    p.v = at->v;
    memcpy(p.point, at->point, sizeof p.point);
    memcpy(p.normal, at->normal, sizeof p.normal);
    return p;
}

cscd_status near_collect(cscd_detector *d, const double *positions, cscd_proximities *out) {
    cscd_counters counters = {.vf = 0};
    cscd_contacts found;
    cscd_status status = contact_list_collect(d, &counters, &found);
    if (status != CSCD_OK) return status;
    cscd_proximity *items = d->contacts.scratch; /* the sorted keys are of no more use */
    for (size_t i = 0; i < found.count; i++) items[i] = proximity_of(d->mesh, &found.items[i], positions);
    *out = (cscd_proximities){items, found.count};
    return CSCD_OK;
}

static cscd_status find_near(cscd_detector *d, const double *positions, double distance,
                             cscd_proximities *out) {
    interval_search search = interval_search_begin(d, positions, positions, near_limit(distance));
    cscd_status status = CSCD_OK;
    if (d->options.method == CSCD_METHOD_BRUTE) {
        status = interval_search_by_brute_force(&search);
    } else {
        status = upkeep_move_to(d, positions, distance);
        if (status == CSCD_OK) status = interval_search_everything(&search);
    }
    return status == CSCD_OK ? near_collect(d, positions, out) : status;
}

cscd_status cscd_detector_near(cscd_detector *detector, const double *positions, double distance,
                               cscd_proximities *out) {
    if (detector == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = detector->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_near: out is NULL");
    cscd_status status = near_check_distance(context, distance);
    if (status == CSCD_OK)
        status = positions_check(context, positions, detector->mesh->vertex_count, "positions");
    if (status != CSCD_OK) return status;
    cscd_proximities found;
    status = find_near(detector, positions, distance, &found);
    if (status != CSCD_OK) return context_out_of_memory(context);
    *out = found;
    return CSCD_OK;
}
