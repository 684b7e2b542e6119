/* Pairs of features that are near each other at one moment. */
#include "runtime/solver/proximity.h"

#include "runtime/detector/contact_list.h"
#include "runtime/detector/list_cap.h"
#include "runtime/detector/waiting.h"
#include "runtime/solver/unique_pairs.h"
#include "src/core/floating.h"
#include "src/core/sort.h"
#include "src/mesh/positions.h"
#include "src/mesh/views.h"

/* One thread describes so many pairs at a time. */
enum { PAIRS_PER_SHARE = 4096 };

cscd_status proximity_check_distance(cscd_context *context, double distance) {
    if (is_positive_length(distance)) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "distance is %g, expected a length from 2^-300 to 2^300", distance);
}

/* Sorts by (kind, a, b): first by b, then by kind and a, which keeps the order by b where these are equal. */
static void sort_pairs(contact_key *keys, contact_key *spare, size_t count) {
    for (size_t i = 0; i < count; i++) keys[i].key = keys[i].contact->b;
    sort_by_number(keys, spare, count, sizeof *keys);
    for (size_t i = 0; i < count; i++)
        keys[i].key = (uint64_t)keys[i].contact->kind << 32 | keys[i].contact->a;
    sort_by_number(keys, spare, count, sizeof *keys);
}

/* What tasks describe, and whom they ask whether the call goes on. */
typedef struct description {
    progress *progress;
    proximity_scene scene;
    const contact_key *keys;
    cscd_proximity *items;
    size_t count;
} description;

static void describe_share(void *data, uint32_t index) {
    const description *d = data;
    if (!progress_go_on(d->progress, 1.0)) return; /* the call ends, and nobody must read the list */
    size_t begin = (size_t)index * PAIRS_PER_SHARE, end = begin + PAIRS_PER_SHARE;
    for (size_t i = begin; i < end && i < d->count; i++)
        proximity_describe(&d->scene, d->keys[i].contact, &d->items[i]);
}

/* A call that has been cancelled fails here: callers look at what the items name. */
static cscd_status describe_pairs(cscd_detector *d, const proximity_scene *scene, size_t count) {
    result_buffer *buffer = &d->proximities;
    sort_pairs(buffer->keys, buffer->spare_keys, count);
    description all = {&d->context->progress, *scene, buffer->keys, buffer->items, count};
    uint32_t shares = (uint32_t)((count + PAIRS_PER_SHARE - 1) / PAIRS_PER_SHARE);
    parallel_run(d->context->threads, shares, describe_share, &all);
    return context_progress_status(d->context);
}

cscd_status proximity_collect(cscd_detector *d, const double *positions, cscd_near_form form,
                              cscd_proximities *out) {
    result_buffer *buffer = &d->proximities;
    proximity_scene scene = {d->mesh, positions, &d->rest};
    size_t found, count;
    cscd_status status =
        contact_list_gather(&d->space, &d->exclusions, sizeof(cscd_proximity), buffer, &found);
    if (status == CSCD_LIST_TOO_LONG) {
        *out = (cscd_proximities){.count = found};
        return list_cap_fail(d, found);
    }
    if (status != CSCD_OK) return status;
    count = found;
    if (form == CSCD_NEAR_UNIQUE)
        status = unique_pairs_list(d->context, &scene, buffer->keys, found, &d->names, buffer->items, &count);
    else
        status = describe_pairs(d, &scene, count);
    if (status == CSCD_OK) *out = (cscd_proximities){buffer->items, count};
    return status;
}

cscd_status proximity_check_form(cscd_context *context, cscd_near_form form) {
    if ((unsigned)form <= CSCD_NEAR_UNIQUE) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "unknown form %d, expected CSCD_NEAR_PAIRS or CSCD_NEAR_UNIQUE", (int)form);
}

interval_search proximity_search(cscd_detector *d, const double *positions, double distance) {
    interval_search search =
        interval_search_begin(&d->space, positions, positions, proximity_limit(distance));
    list_cap_begin(d, &search, CAP_TAINTS_LEFT_OUT);
    return search;
}

cscd_status proximity_find(cscd_detector *d, const double *positions, double distance, cscd_near_form form,
                           cscd_proximities *out) {
    interval_search search = proximity_search(d, positions, distance);
    cscd_status status = CSCD_OK;
    if (d->stages->brute_force) {
        status = interval_search_by_brute_force(&search);
    } else {
        status = bvh_rebuild_move_to(&d->rebuild, &d->space.bvh, positions, uniform_growth(distance),
                                     detector_growth(d));
        if (status == CSCD_OK) status = interval_search_everything(&search);
        if (status == CSCD_OK) status = interval_search_loose(&search);
    }
    return status == CSCD_OK ? proximity_collect(d, positions, form, out) : status;
}

static cscd_status find_near_at(cscd_detector *d, const double *positions, double distance,
                                cscd_near_form form, cscd_proximities *out) {
    cscd_status status = positions_check(d->context, positions, d->mesh->vertex_count, "positions");
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->exclusions.seams, positions);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    status = waiting_look(d, positions);
    if (status == CSCD_OK) status = proximity_find(d, positions, distance, form, out);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    return status == CSCD_OK ? CSCD_OK : detector_fail_call(d, status);
}

static cscd_status find_near_views(cscd_detector *detector, const cscd_view *positions, double distance,
                                   cscd_near_form form, cscd_proximities *out) {
    cscd_context *context = detector->context;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_find_near: out is NULL");
    const double *x = NULL;
    cscd_proximities found;
    cscd_status status = proximity_check_distance(context, distance);
    if (status == CSCD_OK) status = proximity_check_form(context, form);
    if (status == CSCD_OK)
        status = views_read(context, detector->mesh, positions, "positions", &detector->unpacked[0], &x);
    if (status == CSCD_OK) status = find_near_at(detector, x, distance, form, &found);
    if (status == CSCD_OK || status == CSCD_LIST_TOO_LONG) *out = found;
    return status;
}

cscd_status cscd_detector_find_near(cscd_detector *detector, const cscd_view *positions, double distance,
                                    cscd_near_form form, cscd_proximities *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, find_near_views(detector, positions, distance, form, out));
}

static cscd_status take_rest(cscd_detector *d, const cscd_view *rest) {
    const double *x = NULL;
    cscd_status status = views_read(d->context, d->mesh, rest, "rest", &d->unpacked[0], &x);
    if (status == CSCD_OK) status = positions_check(d->context, x, d->mesh->vertex_count, "rest");
    return status == CSCD_OK ? edge_rest_set(d->context, d->mesh, x, &d->rest) : status;
}

cscd_status cscd_detector_set_rest(cscd_detector *detector, const cscd_view *rest) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    cscd_status status = CSCD_OK;
    if (rest == NULL)
        edge_rest_free(detector->context, &detector->rest);
    else
        status = take_rest(detector, rest);
    return context_leave(&entry, status);
}
