/* Answers intervals in which nothing touches, and little moves, from a list of the pairs that may touch in them. */
#include "runtime/detector/verlet_list.h"

#include "runtime/detector/contact_list.h"
#include "runtime/detector/guarantee.h"
#include "runtime/detector/step.h"
#include "src/core/timer.h"

#include <math.h>
#include <string.h>

/* In mean lengths of edges: a skin is so thin at least, and so thick at most, for beyond that more pairs are listed than it
 * saves. It is made for so many intervals like the first one; where a motion is too fast for the least number of them,
 * there is no list. Measured: docs/theory/coherence.md. */
static const double thinnest = 0.1, thickest = 0.15, intervals_wanted = 16.0, intervals_least = 8.0;

/* A list that served fewer intervals was of no use. Then, or where a motion is too fast, the next one waits, for twice as
 * long each time. A list of more pairs for each triangle costs more than it saves. */
enum { SERVED_LEAST = 8, BACKOFF_FIRST = 4, BACKOFF_MOST = 64, EDGE_SAMPLES = 4096 };
static const double most_pairs = 0.5;

/* ---- whether -------------------------------------------------------------------------------------------------- */

/* Is every component that is looked at with itself culled as a whole in this interval? */
static bool culls_everything(const cscd_detector *d) {
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        const cscd_component *component = &d->mesh->components[c];
        if (component_is_obstacle(d->mesh, c)) continue;
        if (!component->closed_manifold || d->starts.of[c].clean != component->triangle_count) return false;
    }
    return true;
}

/* Pairs of other kinds, distances and parts at rest go the usual way. */
static bool is_usable(cscd_detector *d) {
    if (d->options.coherence == CSCD_COHERENCE_OFF || !detector_culls(d) || d->traits->loses_contacts)
        return false;
    if (detector_thick(d) || d->pair_rules.sets != NULL || d->space.active.vertices != NULL) return false;
    if (d->leaves_collapsed) return false;
    if (mesh_has_loose_objects(d->mesh) || d->waiting.pairs.count > 0 || d->space.bvh.mesh == NULL)
        return false;
    start_states_count(&d->starts);
    return culls_everything(d);
}

static double mean_edge(const cscd_mesh *mesh, const double *x) {
    uint32_t step = mesh->edge_count / EDGE_SAMPLES + 1, count = 0;
    double sum = 0.0;
    for (uint32_t i = 0; i < mesh->edge_count; i += step, count++) {
        const double *a = x + (size_t)mesh->edges[i][0] * 3, *b = x + (size_t)mesh->edges[i][1] * 3;
        double squares = 0.0;
        for (int k = 0; k < 3; k++) squares += (b[k] - a[k]) * (b[k] - a[k]);
        sum += sqrt(squares);
    }
    return count > 0 ? sum / count : 0.0;
}

/* Chooses how far vertices may go for a motion like this, and what signs have to last for at least: the stretch of one
 * interval, since those that last no longer are hardly worth to be computed again in each. False: the motion is too fast. */
static bool choose_skin(const cscd_detector *d, const double *x0, const double *x1, skin_motion *out) {
    double edge = d->verlet.now.edge, most = thickest * edge;
    *out = bvh_skin_estimate(&d->space.bvh, x0, x1);
    if (!(out->distance * intervals_least <= most && most > 0.0 && isfinite(most))) return false;
    out->distance = fmin(most, fmax(intervals_wanted * out->distance, thinnest * edge));
    return true;
}

/* ---- the list --------------------------------------------------------------------------------------------------- */

static void cull_everything(cscd_detector *d) {
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        d->culled[c] = d->closes[c] = !component_is_obstacle(d->mesh, c);
        d->touched[c] = 0;
    }
}

/* Orients all triangles by signs that last within the skin. */
static void orient_lastingly(cscd_detector *d, const skin_motion *skin) {
    const orientation_lasting lasting =
        bvh_skin_lasting(&d->verlet.skin, &d->space.bvh, skin->distance, skin->stretch);
    const orientation_query query = {.culled = d->culled,
                                     .detector_offsets = (const double(*)[3])d->culling.detector_offsets,
                                     .lasting = &lasting};
    culling_clear(&d->culling);
    bvh_orient(&d->space.bvh, &query, d->culling.facing);
    culling_begin(&d->culling);
}

/* Two features, each of which moves by no more than the skin, were within two of them at the start if they touch. */
static cscd_status collect_pairs(cscd_detector *d, const double *x, const skin_motion *skin) {
    double apart = 2.0 * skin->distance * (1.0 + 0x1p-20);
    cscd_status status =
        bvh_rebuild_move_to(&d->rebuild, &d->space.bvh, x, uniform_growth(apart), detector_growth(d));
    if (status != CSCD_OK) return status;
    orient_lastingly(d, skin);
    interval_search search = interval_search_begin(&d->space, x, x, (separation){0.0, 0.0});
    search.interval.collecting = true;
    search.interval.beyond = apart;
    search.interval.culling = &d->culling;
    search.interval.culled = d->culled;
    for (uint32_t i = 0; i < d->space.traversal.lane_count; i++) d->space.lanes[i].kept = NULL;
    interval_search_skip_adjacent(&search, false);
    status = interval_search_traverse(&search, TRAVERSAL_KEPT);
    return status == CSCD_OK ? candidates_take(&d->space, &d->verlet.pairs) : status;
}

static void back_off(verlet_list *v) {
    v->now.edge = 0.0; /* which may have changed by then */
    v->now.backoff = v->now.backoff == 0             ? BACKOFF_FIRST
                     : v->now.backoff < BACKOFF_MOST ? v->now.backoff * 2
                                                     : BACKOFF_MOST;
    v->now.waiting = v->now.backoff;
}

static bool is_short(const cscd_detector *d) {
    const candidate_list *lists = d->verlet.pairs.lists;
    return (double)(lists[0].count + lists[1].count) <= most_pairs * (double)d->mesh->triangle_count;
}

/* Notes for how long the pairs, and the signs by which others were left out, are good. False: no memory. */
static bool keep_list(cscd_detector *d, double distance) {
    verlet_list *v = &d->verlet;
    size_t triangles = d->mesh->triangle_count;
    if (v->facing == NULL) v->facing = context_allocate(d->context, triangles, sizeof *v->facing);
    if (v->facing == NULL) return false;
    memcpy(v->facing, d->culling.facing, triangles);
    v->plus = d->culling.plus;
    v->minus = d->culling.minus;
    bvh_skin_set(&v->skin, &d->space.bvh, distance);
    return true;
}

/* Makes a list at the start of an interval, if it promises to be of use. */
static cscd_status make_list(cscd_detector *d, const double *x0, const double *x1) {
    verlet_list *v = &d->verlet;
    if (!v->now.was_quiet || (v->now.waiting > 0 && v->now.waiting-- > 0)) return CSCD_OK;
    if (v->now.edge == 0.0) v->now.edge = mean_edge(d->mesh, x0);
    skin_motion skin;
    v->remade = true;
    if (!choose_skin(d, x0, x1, &skin) || !bvh_skin_reserve(&v->skin, &d->space.bvh)) {
        back_off(v);
        return CSCD_OK;
    }
    cull_everything(d);
    cscd_status status = collect_pairs(d, x0, &skin);
    if (status != CSCD_OK && status != CSCD_OUT_OF_MEMORY) return status;
    v->now.served = 0;
    v->now.revision = d->starts.revision;
    v->now.exists = status == CSCD_OK && is_short(d) && keep_list(d, skin.distance);
    if (!v->now.exists) back_off(v);
    return CSCD_OK;
}

/* Ends a list that does not hold any longer, and notes whether it was of use. */
static void end_list(verlet_list *v) {
    v->now.exists = false;
    if (v->now.served >= SERVED_LEAST)
        v->now.backoff = 0;
    else
        back_off(v);
}

/* ---- intervals ----------------------------------------------------------------------------------------------------- */

/* Leaves the detector as a step does that culls everything and finds nothing. */
static void end_interval(cscd_detector *d, const interval_search *search, step_outcome *out) {
    const verlet_list *v = &d->verlet;
    memcpy(d->culling.facing, v->facing, d->mesh->triangle_count);
    bvh_skin_points(&v->skin, d->culling.detector_points);
    d->rebuild.rebuilt = false;
    d->lists_earliest = false;
    d->passes = 0;
    out->timings = search->timings;
    out->counters.plus = v->plus;
    out->counters.minus = v->minus;
    out->counters.coherent = 1;
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        d->guarantees[c] = guarantee_of(d, c);
        out->counters.clean += d->culled[c] ? d->starts.of[c].clean : 0;
    }
}

/* Tests the pairs of the list. */
static cscd_status test_list(cscd_detector *d, interval_search *search, step_outcome *out, bool *answered) {
    step_outcome found = {.counters = {0}};
    cull_everything(d);
    cscd_status status = candidates_test(&d->verlet.pairs, search);
    if (status != CSCD_OK || search_space_found_any(&d->space)) return status;
    status = contact_list_collect(&d->space, &d->exclusions, &d->contacts, &found.counters, &found.contacts);
    if (status != CSCD_OK) return status;
    end_interval(d, search, &found);
    *out = found;
    d->verlet.serving = *answered = true;
    return CSCD_OK;
}

/* Is there a list that holds throughout the interval? Makes one if it promises to be of use. */
static cscd_status find_list(cscd_detector *d, const double *x0, const double *x1, bool *holds) {
    verlet_list *v = &d->verlet;
    *holds = v->now.exists && v->now.revision == d->starts.revision && bvh_skin_holds(&v->skin, x0, x1);
    if (*holds) return CSCD_OK;
    if (v->now.exists) end_list(v); /* it has ended now, or in an interval that was not answered from it */
    cscd_status status = make_list(d, x0, x1);
    *holds = v->now.exists && bvh_skin_holds(&v->skin, x0, x1);
    return status;
}

cscd_status verlet_list_answer(cscd_detector *d, const double *x0, const double *x1, step_outcome *out,
                               bool *answered) {
    double since = timer_now_ms(), update_ms = 0.0;
    bool holds;
    d->verlet.serving = *answered = false;
    d->verlet.spent_ms = 0.0;
    if (!is_usable(d)) return CSCD_OK;
    cscd_status status = find_list(d, x0, x1, &holds);
    timer_lap(&since, &update_ms);
    d->verlet.spent_ms = update_ms;
    if (status != CSCD_OK || !holds) return status;
    interval_search search = detector_search_begin(d, x0, x1);
    search.timings.update_ms = update_ms;
    status = test_list(d, &search, out, answered);
    timer_lap(&since, *answered ? &out->timings.contact_ms : &d->verlet.spent_ms);
    return status;
}

void verlet_list_begin_call(verlet_list *v) {
    v->before = v->now;
    v->remade = false;
}

void verlet_list_undo(verlet_list *v) {
    v->now = v->before;
    if (v->remade) v->now.revision = UINT64_MAX; /* that of no positions */
    v->serving = false;
}

void verlet_list_take(cscd_detector *d) {
    verlet_list *v = &d->verlet;
    if (!v->serving) return;
    v->now.served++;
    v->now.revision = d->starts.revision;
    bvh_skin_take(&v->skin);
}

void verlet_list_free(cscd_context *context, verlet_list *v) {
    candidates_free(context, &v->pairs);
    bvh_skin_free(&v->skin);
    context_free(context, v->facing);
    *v = (verlet_list){.serving = false};
}
