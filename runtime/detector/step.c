/* One interval through the stages of the pipeline. */
#include "runtime/detector/step.h"

#include "runtime/bvh/bvh_rebuild.h"
#include "runtime/culling/tainting.h"
#include "runtime/detector/contact_list.h"
#include "runtime/detector/interval_search.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"

/* ---- one interval ---------------------------------------------------------------------------------- */

typedef struct step_work {
    interval_search search;
    cscd_mode mode;
    bool rehearsal;                  /* the vertices may not go to its end */
    bool any_culled, any_not_culled; /* components */
    bool all_clean;                  /* are those that are culled */
} step_work;

/* ---- culling --------------------------------------------------------------------------------------- */

static bool follows(const cscd_detector *d, int rule) {
    return d->options.method == CSCD_METHOD_PUBLISHED && (d->published_rules & rule) != 0;
}

static bool culls_unproven(const cscd_detector *d) {
    return follows(d, PUBLISHED_UNPROVEN) && detector_culls(d);
}

/* Suspects beyond this share are worth volumes of their moment; fewer are found by those of the interval. */
enum { SUSPECTS_SHARE = 16 };

/* Finds out which triangles are clean at the start, and updates the tree for the interval. */
static cscd_status prove_starts(step_work *work) {
    cscd_detector *d = work->search.detector;
    const double *start = work->search.interval.x0;
    bool proves = detector_culls(d) && d->options.start == CSCD_START_PROVE && !culls_unproven(d);
    double since = timer_now_ms();
    uint32_t suspects = proves ? start_states_suspect(&d->starts, d->suspects) : 0;
    bool at_once = suspects > d->mesh->triangle_count / SUSPECTS_SHARE;
    cscd_status status = CSCD_OK;
    if (at_once) {
        status = upkeep_move_to(d, start, 0.0);
        if (status == CSCD_OK) status = static_check_suspects(d, start);
    }
    if (proves) timer_lap(&since, &work->search.timings.proof_ms);
    if (status == CSCD_OK) status = upkeep_move(d, start, work->search.interval.x1, d->limit.distance);
    timer_lap(&since, &work->search.timings.update_ms);
    if (status == CSCD_OK && suspects > 0 && !at_once) status = static_check_suspects(d, start);
    if (proves) timer_lap(&since, &work->search.timings.proof_ms);
    work->search.counters.static_checks = suspects > 0;
    if (work->rehearsal) start_states_save(&d->starts);
    return status;
}

/* A first contact that is to be left out may hide the one to report: then mode EARLIEST finishes, too. */
static bool finishes(const step_work *work) {
    return work->mode == CSCD_MODE_ALL || exclusions_any(&work->search.detector->exclusions);
}

/* Which components are culled: closed ones of which nearly all triangles are clean. Those that are not all
 * clean are finished in either mode. As published: embedded ones, or all, and none is finished. */
static void choose_culled(step_work *work) {
    cscd_detector *d = work->search.detector;
    bool published = d->options.method == CSCD_METHOD_PUBLISHED;
    start_states_count(&d->starts);
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        const cscd_component *component = &d->mesh->components[c];
        d->culled[c] = d->finished[c] = false;
        if (component_is_obstacle(d->mesh, c)) continue;
        uint32_t clean = component->closed_manifold ? d->starts.of[c].clean : 0;
        bool embedded = clean == component->triangle_count;
        bool pays = start_states_pay(&d->starts, clean, component->triangle_count);
        d->culled[c] = detector_culls(d) && (published ? embedded || follows(d, PUBLISHED_UNPROVEN) : pays);
        d->finished[c] = d->culled[c] && !published && (finishes(work) || !embedded);
        work->any_culled |= d->culled[c];
        work->any_not_culled |= !d->culled[c];
        work->all_clean &= !d->culled[c] || embedded;
        work->search.counters.clean += clean;
    }
}

static orientation_query view_of(const step_work *work) {
    const cscd_detector *d = work->search.detector;
    bool all = work->all_clean || follows(d, PUBLISHED_UNPROVEN);
    return (orientation_query){d->culled, all ? NULL : d->starts.triangles,
                               (const double(*)[3])d->culling.detector_offsets, follows(d, PUBLISHED_STILL)};
}

static void orient(step_work *work, const orientation_query *view) {
    cscd_detector *d = work->search.detector;
    double since = timer_now_ms();
    bvh_orient(&d->bvh, view, d->culling.facing);
    culling_begin(&d->culling);
    timer_lap(&since, &work->search.timings.orientation_ms);
    work->search.counters.plus = d->culling.plus;
    work->search.counters.minus = d->culling.minus;
    work->search.interval.culling = follows(d, PUBLISHED_REPRESENTATIVES) ? NULL : &d->culling;
    work->search.interval.culled = d->culled;
}

/* Tests the pairs that contacts have uncovered, until these bring no more: then all contacts of the
 * components to be finished are found (docs/theory/culling.md). */
static cscd_status close_contacts(step_work *work) {
    cscd_detector *d = work->search.detector;
    work->search.interval.closing_pass = true;
    for (;;) {
        double since = timer_now_ms();
        culling_pass_done(&d->culling);
        if (tainting_look(d) == 0) return CSCD_OK;
        bvh_mark_fresh(&d->bvh, d->culling.earlier, d->culling.orientations);
        timer_lap(&since, &work->search.timings.orientation_ms);
        cscd_status status = interval_search_traverse(&work->search, TRAVERSAL_FRESH);
        if (status != CSCD_OK) return status;
        work->search.counters.passes++;
    }
}

/* ICCD needs no embedded start: a pair in a sealed patch never touches. */
static cscd_status find_unsealed(step_work *work) {
    cscd_detector *d = work->search.detector;
    bool published = d->options.method == CSCD_METHOD_ICCD_PUBLISHED;
    double since = timer_now_ms();
    if (d->patches.tree.node_count == 0) {
        cscd_status status = patches_create(d->mesh, &d->bvh, &d->patches);
        if (status != CSCD_OK) return status;
    }
    patches_seal(&d->patches, d->mesh, &d->bvh, work->search.interval.x0, work->search.interval.x1,
                 published);
    timer_lap(&since, &work->search.timings.contour_ms);
    work->search.counters.contours = d->patches.contours;
    work->search.counters.sealed = d->patches.sealed;
    if (!published) return interval_search_everything(&work->search);
    interval_search_skip_adjacent(&work->search, true);
    return interval_search_traverse(&work->search, TRAVERSAL_KEPT);
}

static cscd_status find_by_trees(step_work *work) {
    cscd_detector *d = work->search.detector;
    cscd_status status = prove_starts(work);
    if (status != CSCD_OK) return status;
    if (detector_seals(d)) return find_unsealed(work);
    choose_culled(work);
    orientation_query view = view_of(work);
    if (detector_region_count(d) > 0) bvh_detector_points(&d->bvh, &view, d->culling.detector_points);
    if (!work->any_culled) return interval_search_everything(&work->search);
    orient(work, &view);
    if (d->options.method == CSCD_METHOD_PUBLISHED) {
        interval_search_skip_adjacent(&work->search, follows(d, PUBLISHED_ADJACENT));
        return interval_search_traverse(&work->search, TRAVERSAL_KEPT);
    }
    if (work->any_not_culled) {
        status = interval_search_everything(&work->search);
    } else {
        interval_search_skip_adjacent(&work->search, false);
        status = interval_search_traverse(&work->search, TRAVERSAL_KEPT);
    }
    return status == CSCD_OK ? close_contacts(work) : status;
}

static cscd_guarantee guarantee_of(const step_work *work, uint32_t component) {
    const cscd_detector *d = work->search.detector;
    const component_start *start = &d->starts.of[component];
    bool embedded = start->clean == d->mesh->components[component].triangle_count;
    cscd_guarantee g = {true, embedded, CSCD_REASON_METHOD};
    if (component_is_obstacle(d->mesh, component))
        return (cscd_guarantee){false, false, CSCD_REASON_OBSTACLE};
    if (detector_seals(d)) {
        bool published = d->options.method == CSCD_METHOD_ICCD_PUBLISHED;
        g.reason = published ? CSCD_REASON_PUBLISHED : CSCD_REASON_CONTOUR;
        g.complete = !published;
        return g;
    }
    if (!detector_culls(d)) return g;
    if (d->options.method == CSCD_METHOD_PUBLISHED)
        g.reason = CSCD_REASON_PUBLISHED;
    else if (!d->mesh->components[component].closed_manifold)
        g.reason = CSCD_REASON_SURFACE;
    else if (!embedded)
        g.reason = start->crossing > 0 ? CSCD_REASON_CROSSING : CSCD_REASON_UNPROVEN;
    else if (!d->touched[component])
        g.reason = CSCD_REASON_CLEAN;
    else
        g.reason = finishes(work) ? CSCD_REASON_FINISHED : CSCD_REASON_EARLIEST;
    g.complete = g.reason != CSCD_REASON_EARLIEST && g.reason != CSCD_REASON_PUBLISHED;
    return g;
}

static cscd_status find(step_work *work, cscd_contacts *contacts) {
    cscd_detector *d = work->search.detector;
    d->rebuilt = false;
    culling_clear(&d->culling);
    tainting_begin(d);
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->finished[c] = false;
    if (detector_culls(d) && d->options.start == CSCD_START_VOUCHED) start_states_vouch(&d->starts);
    start_states_count(&d->starts);
    bool brute = d->options.method == CSCD_METHOD_BRUTE;
    cscd_status status = brute ? interval_search_by_brute_force(&work->search) : find_by_trees(work);
    if (status != CSCD_OK) return status;
    work->search.counters.rebuilds = d->rebuilt;
    tainting_look(d);
    double since = timer_now_ms();
    status = contact_list_collect(d, &work->search.counters, contacts);
    timer_lap(&since, &work->search.timings.contact_ms);
    return status;
}

cscd_status step_find(cscd_detector *d, const double *x0, const double *x1, cscd_mode mode, bool rehearsal,
                      step_outcome *out) {
    step_work work = {.search = interval_search_begin(d, x0, x1, d->limit),
                      .mode = mode,
                      .rehearsal = rehearsal,
                      .all_clean = true};
    if (rehearsal) start_states_save(&d->starts); /* should it fail before the proof */
    cscd_status status = find(&work, &out->contacts);
    if (status != CSCD_OK) return status;
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->guarantees[c] = guarantee_of(&work, c);
    out->timings = work.search.timings;
    out->counters = work.search.counters;
    return CSCD_OK;
}

/* But where contacts may be missing. */
void step_take(cscd_detector *d, const double *end) {
    if (!detector_culls(d)) {
        start_states_forget(&d->starts); /* contacts have not tainted it */
        return;
    }
    bool *lost = d->culled; /* which nobody asks for any more */
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        const cscd_guarantee *g = &d->guarantees[c];
        lost[c] = !g->complete && g->reason != CSCD_REASON_OBSTACLE;
    }
    start_states_end(&d->starts, end, lost);
}

void step_withdraw(cscd_detector *d) {
    if (detector_culls(d)) start_states_restore(&d->starts);
}

/* What was seen last has been checked then. States are of the start from here on; without culling they matter
 * only if a static check has left some. */
cscd_status step_check_positions(cscd_detector *d, const double *start, const double *end,
                                 const char *start_name, const char *end_name) {
    uint32_t vertices = d->mesh->vertex_count;
    cscd_status status = CSCD_OK;
    if (end == NULL || start == NULL || !start_states_hold(&d->starts, start)) {
        status = positions_check(d->context, start, vertices, start_name);
        if (status == CSCD_OK) status = positions_check(d->context, end, vertices, end_name);
        if (status == CSCD_OK && (detector_culls(d) || d->starts.known))
            start_states_begin(&d->starts, start);
        return status;
    }
    return positions_check(d->context, end, vertices, end_name);
}

cscd_status cscd_detector_step(cscd_detector *detector, const double *start, const double *end,
                               cscd_contacts *out) {
    if (detector == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = detector->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_step: out is NULL");
    double since = timer_now_ms();
    cscd_status status = step_check_positions(detector, start, end, "start", "end");
    if (status != CSCD_OK) return status;

    step_outcome found;
    call_begin(detector);
    status = step_find(detector, start, end, detector->options.mode, false, &found);
    if (status != CSCD_OK) return call_fail(detector, status);
    step_take(detector, end);
    timer_lap(&since, &found.timings.total_ms);
    found.timings.check_ms = detector->timings.check_ms;
    detector->timings = found.timings;
    detector->counters = found.counters;
    *out = found.contacts;
    return CSCD_OK;
}
