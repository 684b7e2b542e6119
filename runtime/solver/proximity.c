/* Pairs of features that are near each other at one moment: how they are found, described, and listed. */
#include "runtime/solver/unique_pairs.h"

#include "runtime/ccd/ccd.h"
#include "src/core/floating.h"
#include "src/mesh/positions.h"

#include <string.h>

/* ---- items --------------------------------------------------------------------------------------------- */

/* Lists are compared bit for bit: the struct has no padding. */
_Static_assert(sizeof(cscd_proximity) == 128, "an item fills two lines of a cache");

/* Names a pair, its nearest points, and what it has to keep; the numbers of pairs, distance and weight are 0. */
static void name_item(const proximity_scene *scene, const near_eight *found, uint32_t i,
                      cscd_proximity *out) {
    out->kind = found->kind;
    out->a = found->a[i];
    out->b = found->b[i];
    out->count = out->vf_count = out->ee_count = 0;
    mesh_vertices_of_pair(scene->place.mesh, found->kind, out->a, out->b, out->vertices);
    out->distance = 0.0;
    cscd_stencil_weights(found->kind, found->at.u[i], found->at.v[i], out->weights);
    for (int k = 0; k < 3; k++) out->normal[k] = found->at.normal[k][i];
    out->threshold = out->weight = 0.0;
    out->separation = near_separation(&scene->rules, found->kind, out->a, out->b);
}

void proximity_write(const proximity_scene *scene, const near_eight *found, uint32_t i, cscd_proximity *out) {
    const bool ee = found->kind == CSCD_CONTACT_EE;
    name_item(scene, found, i, out);
    out->count = 1;
    out->vf_count = found->kind == CSCD_CONTACT_VF;
    out->ee_count = ee;
    out->distance = found->at.distance[i];
    out->threshold = ee ? rest_shape_threshold(scene->rest, out->a, out->b) : 0.0;
    out->weight = rest_shape_weight(scene->rest, found->kind, out->a, out->b);
}

/* ---- lists --------------------------------------------------------------------------------------------- */

cscd_status proximity_check_distance(const cscd_detector *d, double distance, cscd_near_form form) {
    const bool beyond = (form & CSCD_NEAR_BEYOND) != 0;
    const double farthest = beyond ? distance + config_greatest_separation(&d->config) : distance;
    if (is_positive_length(distance) && is_positive_length(farthest)) return CSCD_OK;
    return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                        "distance is %g, expected a length from 2^-300 to 2^300%s", distance,
                        beyond ? ", also with what pairs have to keep added to it" : "");
}

/* The number of pairs that one thread describes at a time. */
enum { PAIRS_PER_SHARE = 4096 };

/* The items that tasks describe, and the context that they ask whether the call goes on. */
typedef struct description {
    bool bare; /* items get what division needs, and nothing else */
    progress *progress;
    proximity_scene scene;
    cscd_proximity *items;
    size_t count;
} description;

static void describe_share(void *data, uint32_t index) {
    const description *d = data;
    if (!progress_go_on(d->progress, 1.0)) return; /* the call ends, and nobody must read the list */
    size_t begin = (size_t)index * PAIRS_PER_SHARE, end = begin + PAIRS_PER_SHARE;
    near_eight found;
    if (end > d->count) end = d->count;
    for (; begin < end; begin += found.count) {
        near_list_describe_from(&d->scene.place, begin, end, &found);
        for (uint32_t i = 0; i < found.count; i++)
            (d->bare ? name_item : proximity_write)(&d->scene, &found, i, &d->items[begin + i]);
    }
}

static proximity_scene scene_of(const cscd_detector *d, const double *positions) {
    return (proximity_scene){{d->mesh, positions, &d->results.near}, &d->config.rest, {d->mesh, &d->config}};
}

/* A call that has been cancelled fails here: callers look at what the items name. The memory of the items sorts their names
 * first. */
static cscd_status describe_pairs(cscd_detector *d, const proximity_scene *scene, bool bare) {
    near_list *near = &d->results.near;
    result_buffer *buffer = &d->results.proximities;
    cscd_status status = result_buffer_reserve_items(d->context, buffer, near->count, sizeof(cscd_proximity));
    if (status != CSCD_OK) return status;
    near_list_sort(near, buffer->items);
    description all = {bare, &d->context->progress, *scene, buffer->items, near->count};
    uint32_t shares = (uint32_t)((near->count + PAIRS_PER_SHARE - 1) / PAIRS_PER_SHARE);
    parallel_run(d->context->threads, shares, describe_share, &all);
    return context_progress_status(d->context);
}

static cscd_status collect_items(cscd_detector *d, const double *positions, cscd_near_form form, bool bare,
                                 cscd_proximities *out) {
    const proximity_scene scene = scene_of(d, positions);
    near_list *near = &d->results.near;
    cscd_status status = near_list_gather(&d->space, &d->config.exclusions, near);
    size_t count = near->count;
    if (status == CSCD_LIST_TOO_LONG) {
        *out = (cscd_proximities){.count = count};
        return list_cap_fail(d->context, &d->interval.cap, count);
    }
    if (status != CSCD_OK) return status;
    if ((form & CSCD_NEAR_UNIQUE) != 0)
        status = unique_pairs_list(d->context, &scene, near, &d->results.repetitions, &d->results.proximities,
                                   &count);
    else
        status = describe_pairs(d, &scene, bare);
    if (status == CSCD_OK) *out = (cscd_proximities){d->results.proximities.items, count};
    return status;
}

cscd_status proximity_collect(cscd_detector *d, const double *positions, cscd_near_form form,
                              cscd_proximities *out) {
    return collect_items(d, positions, form, false, out);
}

void proximity_complete(cscd_detector *d, const double *positions, size_t item, cscd_proximity *out) {
    const proximity_scene scene = scene_of(d, positions);
    near_eight found;
    near_list_describe_from(&scene.place, item, item + 1, &found);
    proximity_write(&scene, &found, 0, out);
}

cscd_status proximity_check_form(cscd_context *context, cscd_near_form form) {
    if ((unsigned)form <= (CSCD_NEAR_UNIQUE | CSCD_NEAR_BEYOND)) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "unknown form %d, expected CSCD_NEAR_PAIRS or CSCD_NEAR_UNIQUE, and CSCD_NEAR_BEYOND "
                        "or not",
                        (int)form);
}

/* The distance that volumes are widened by, and the objects' own ones besides. */
static volume_growth near_growth(const cscd_detector *d, double distance, cscd_near_form form) {
    if ((form & CSCD_NEAR_BEYOND) == 0) return uniform_growth(distance);
    volume_growth growth = config_growth(&d->config);
    growth.beyond = distance;
    return growth;
}

interval_search proximity_search(cscd_detector *d, const double *positions, double distance,
                                 cscd_near_form form) {
    const volume_growth growth = near_growth(d, distance, form);
    const double same = growth.distance + growth.beyond;
    interval_search search = interval_search_begin(&d->space, positions, positions, proximity_limit(same));
    if (growth.of_objects != NULL) {
        search.interval.limit = d->config.limit;
        search.interval.thick = true;
        search.interval.activation = distance;
    }
    list_cap_begin(&d->interval, &search, CAP_TAINTS_LEFT_OUT);
    /* a list that has a limit counts contacts, and so do points, which have no edge by which they could be named */
    search.interval.naming = d->space.longest == 0 && d->mesh->loose.point_count == 0;
    return search;
}

/* Searches the moment; the trees are widened by the growth. */
static cscd_status search_moment(cscd_detector *d, interval_search *search, volume_growth growth) {
    cscd_status status = CSCD_OK;
    if (d->config.stages->brute_force) {
        status = interval_search_by_brute_force(search);
    } else {
        status = bvh_rebuild_move_to(&d->rebuild, &d->space.bvh, search->interval.x0, growth,
                                     config_growth(&d->config));
        if (status == CSCD_OK) status = interval_search_everything(search);
        if (status == CSCD_OK) status = interval_search_loose(search);
    }
    return status;
}

cscd_status proximity_find(cscd_detector *d, const double *positions, double distance, cscd_near_form form,
                           cscd_proximities *out) {
    interval_search search = proximity_search(d, positions, distance, form);
    cscd_status status = search_moment(d, &search, near_growth(d, distance, form));
    return status == CSCD_OK ? collect_items(d, positions, form, false, out) : status;
}

/* Pairs that nearly touch are found also where nothing moves, for the caller is told of them. */
static const double nearly_touching = 0x1p-10;

/* Volumes of two objects are compared within the mean of their growths, which covers both ways. */
static volume_growth growth_on_ways(const cscd_detector *d, const near_ways *ways) {
    const motion_bounds *motion = &ways->bounds;
    for (uint32_t i = 0; i < d->mesh->object_count; i++)
        ways->of_objects[i] = distance_on_ways(motion, 2.0 * ways->of_objects[i]) * (1.0 + 0x1p-40);
    return (volume_growth){distance_on_ways(motion, 0.0), ways->of_objects, 0.0};
}

static size_t count_parted(const search_space *s) {
    size_t count = 0;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) count += (size_t)s->workers[i].parted;
    return count;
}

cscd_status proximity_find_on_ways(cscd_detector *d, const double *positions, near_ways *ways, size_t *parted,
                                   cscd_proximities *out) {
    interval_search search = proximity_search(d, positions, ways->farthest, CSCD_NEAR_PAIRS);
    ways->bounds.kept = config_greatest_separation(&d->config);
    ways->bounds.least = nearly_touching * (ways->farthest - ways->bounds.kept);
    /* callers who leave pairs out are asked about each pair that is near */
    if (exclusions_any(&d->config.exclusions)) ways->bounds.motions = NULL;
    search.interval.motion = &ways->bounds;
    cscd_status status = search_moment(d, &search, growth_on_ways(d, ways));
    *parted = count_parted(&d->space);
    return status == CSCD_OK ? collect_items(d, positions, CSCD_NEAR_PAIRS, true, out) : status;
}

static cscd_status find_near_at(cscd_detector *d, const double *positions, double distance,
                                cscd_near_form form, cscd_proximities *out) {
    cscd_status status = positions_check(d->context, positions, d->mesh->vertex_count, "positions");
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->config.exclusions.seams, positions);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    const waiting_place waiting = detector_waiting_place(d);
    status = waiting_look(&waiting, positions);
    if (status == CSCD_OK) status = proximity_find(d, positions, distance, form, out);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    return status == CSCD_OK ? CSCD_OK : detector_fail_call(d, status);
}

cscd_status solver_find_near(cscd_detector *detector, const cscd_view *positions, double distance,
                             cscd_near_form form, cscd_proximities *out) {
    cscd_context *context = detector->context;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_find_near: out is NULL");
    const double *x = NULL;
    cscd_proximities found;
    cscd_status status = proximity_check_form(context, form);
    if (status == CSCD_OK) status = proximity_check_distance(detector, distance, form);
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
    return context_leave(&entry, solver_find_near(detector, positions, distance, form, out));
}
