/* One interval through the stages of the pipeline. */
#include "runtime/detector.h"

#include "runtime/brute_force.h"
#include "runtime/contact_list.h"
#include "runtime/tainting.h"
#include "runtime/upkeep.h"
#include "src/positions.h"
#include "src/timer.h"

/* ---- one interval ---------------------------------------------------------------------------------- */

typedef struct step_work {
    cscd_detector *detector;
    swept_interval interval;
    cscd_timings timings;
    cscd_counters counters;
    bool any_culled, any_not_culled; /* components */
    bool all_clean;                  /* are those that are culled */
} step_work;

/* Lanes search and test in turn: each takes of both what it finds, and nobody waits for anybody else's. */
static void search_and_test(void *data, uint32_t index) {
    step_work *work = data;
    traversal *t = &work->detector->traversal;
    traversal_lane *batch = &t->lanes[index];
    contact_lane *lane = &work->detector->contact_lanes[index];
    double begin = timer_now_ms(), spent = 0.0;
    while (!lane->out_of_memory && traversal_fill(t, index)) {
        batch->pairs_found += batch->pair_count;
        narrow_phase_test(&work->interval, batch->pairs, batch->pair_count, lane);
    }
    narrow_phase_finish(&work->interval, lane);
    timer_lap(&begin, &spent);
    batch->consume_ms = spent - batch->search_ms;
}

static void test_share(void *data, uint32_t index) {
    step_work *work = data;
    brute_force_test(&work->interval, index, work->detector->traversal.lane_count,
                     &work->detector->contact_lanes[index]);
}

static cscd_status lanes_status(const cscd_detector *d) {
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        if (d->contact_lanes[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    return CSCD_OK;
}

/* What the lanes took together goes to the stages as the lanes' own times are to each other. */
static void share_out(step_work *work, double together_ms) {
    const traversal *t = &work->detector->traversal;
    double search = 0.0, test = 0.0;
    for (uint32_t i = 0; i < t->busy_lanes; i++) {
        search += t->lanes[i].search_ms;
        test += t->lanes[i].consume_ms;
        work->counters.pcp += t->lanes[i].pairs_found + t->lanes[i].adjacent;
        work->counters.adjacent += t->lanes[i].adjacent;
    }
    double share = search + test > 0.0 ? search / (search + test) : 0.0;
    work->timings.traversal_ms += share * together_ms;
    work->timings.contact_ms += (1.0 - share) * together_ms;
}

static cscd_status traverse(step_work *work, traversal_pass pass) {
    cscd_detector *d = work->detector;
    double since = timer_now_ms(), together = 0.0;
    traversal_begin(&d->traversal, &d->forest, pass);
    timer_lap(&since, &work->timings.traversal_ms);
    parallel_run(d->context->threads, d->traversal.busy_lanes, search_and_test, work);
    timer_lap(&since, &together);
    share_out(work, together);
    work->counters.boxes_tested += traversal_boxes_tested(&d->traversal);
    cscd_status status = traversal_status(&d->traversal);
    return status == CSCD_OK ? lanes_status(d) : status;
}

static void test_orphans(void *data, uint32_t index) {
    step_work *work = data;
    cscd_detector *d = work->detector;
    contact_lane *lane = &d->contact_lanes[index];
    narrow_phase_test_orphans(&work->interval, &d->orphans, index, d->traversal.busy_lanes, lane);
    narrow_phase_finish(&work->interval, lane);
}

static void skip_adjacent(cscd_detector *d, bool everywhere, const bool *culled) {
    for (uint32_t c = 0; c < d->mesh->component_count; c++)
        d->skipped[c] = everywhere && (culled == NULL || !culled[c]);
    forest_skip_adjacent(&d->forest, d->skipped);
}

/* Where nothing is culled every pair of triangles is reached, so those that share a vertex, most of all
 * pairs, need not be: other pairs answer for their features, and there are orphans. */
static cscd_status leave_out_adjacent(step_work *work) {
    cscd_detector *d = work->detector;
    if (!d->orphans_known) {
        bool too_many;
        cscd_status status = orphan_sets_create(d->mesh, &d->orphans, &too_many);
        if (status != CSCD_OK) return status;
        d->orphans_known = true;
        d->orphans_usable = !too_many;
    }
    work->interval.strangers = d->orphans_usable;
    skip_adjacent(d, d->orphans_usable, work->interval.culling != NULL ? d->culled : NULL);
    return CSCD_OK;
}

static cscd_status find_without_adjacent(step_work *work) {
    cscd_detector *d = work->detector;
    cscd_status status = leave_out_adjacent(work);
    if (status == CSCD_OK) status = traverse(work, TRAVERSAL_KEPT);
    if (status != CSCD_OK || !work->interval.strangers) return status;
    double since = timer_now_ms();
    parallel_run(d->context->threads, d->traversal.busy_lanes, test_orphans, work);
    timer_lap(&since, &work->timings.contact_ms);
    return lanes_status(d);
}

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
    cscd_detector *d = work->detector;
    const double *start = work->interval.x0;
    bool proves = detector_culls(d) && d->options.start == CSCD_START_PROVE && !culls_unproven(d);
    double since = timer_now_ms();
    uint32_t suspects = proves ? start_states_suspect(&d->starts, d->suspects) : 0;
    bool at_once = suspects > d->mesh->triangle_count / SUSPECTS_SHARE;
    cscd_status status = CSCD_OK;
    if (at_once) {
        status = upkeep_move_to(d, start);
        if (status == CSCD_OK) status = static_check_suspects(d, start);
    }
    if (proves) timer_lap(&since, &work->timings.proof_ms);
    if (status == CSCD_OK) status = upkeep_move(d, start, work->interval.x1, d->limit.distance);
    timer_lap(&since, &work->timings.update_ms);
    if (status == CSCD_OK && suspects > 0 && !at_once) status = static_check_suspects(d, start);
    if (proves) timer_lap(&since, &work->timings.proof_ms);
    work->counters.static_checks = suspects > 0;
    return status;
}

/* A first contact that is to be left out may hide the one to report: then mode EARLIEST finishes, too. */
static bool finishes(const cscd_detector *d) {
    return d->options.mode == CSCD_MODE_ALL || d->options.ignore != NULL;
}

/* Which components are culled: closed ones of which nearly all triangles are clean. Those that are not all
 * clean are finished in either mode. As published: embedded ones, or all, and none is finished. */
static void choose_culled(step_work *work) {
    cscd_detector *d = work->detector;
    bool published = d->options.method == CSCD_METHOD_PUBLISHED;
    start_states_count(&d->starts);
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        const cscd_component *component = &d->mesh->components[c];
        d->culled[c] = d->finished[c] = false;
        if (component_is_obstacle(d->mesh, c)) continue;
        uint32_t clean = component->closed_manifold ? d->starts.of[c].clean : 0;
        bool embedded = clean == component->triangle_count;
        bool pays = start_states_pay(&d->starts, clean, component->triangle_count);
        d->culled[c] = published ? embedded || follows(d, PUBLISHED_UNPROVEN) : detector_culls(d) && pays;
        d->finished[c] = d->culled[c] && !published && (finishes(d) || !embedded);
        work->any_culled |= d->culled[c];
        work->any_not_culled |= !d->culled[c];
        work->all_clean &= !d->culled[c] || embedded;
        work->counters.clean += clean;
    }
}

static void orient(step_work *work) {
    cscd_detector *d = work->detector;
    bool still = follows(d, PUBLISHED_STILL);
    double since = timer_now_ms();
    bool all = work->all_clean || follows(d, PUBLISHED_UNPROVEN);
    forest_view view = {d->culled, all ? NULL : d->starts.triangles,
                        (const double(*)[3])d->culling.detector_offsets, still};
    forest_orient(&d->forest, &view, d->culling.facing);
    culling_begin(&d->culling);
    timer_lap(&since, &work->timings.orientation_ms);
    work->counters.plus = d->culling.plus;
    work->counters.minus = d->culling.minus;
    work->interval.culling = follows(d, PUBLISHED_REPRESENTATIVES) ? NULL : &d->culling;
    work->interval.culled = d->culled;
}

/* Tests the pairs that contacts have uncovered, until these bring no more: then all contacts of the
 * components to be finished are found (docs/culling.md). */
static cscd_status close_contacts(step_work *work) {
    cscd_detector *d = work->detector;
    work->interval.closing = true;
    for (;;) {
        double since = timer_now_ms();
        culling_pass_done(&d->culling);
        if (tainting_look(d) == 0) return CSCD_OK;
        forest_mark_fresh(&d->forest, d->culling.earlier, d->culling.orientations);
        timer_lap(&since, &work->timings.orientation_ms);
        cscd_status status = traverse(work, TRAVERSAL_FRESH);
        if (status != CSCD_OK) return status;
        work->counters.passes++;
    }
}

/* ICCD needs no embedded start: a pair in a sealed patch never touches. */
static cscd_status find_unsealed(step_work *work) {
    cscd_detector *d = work->detector;
    bool published = d->options.method == CSCD_METHOD_ICCD_PUBLISHED;
    double since = timer_now_ms();
    if (d->patches.tree.node_count == 0) {
        cscd_status status = patches_create(d->mesh, &d->forest, &d->patches);
        if (status != CSCD_OK) return status;
    }
    patches_seal(&d->patches, d->mesh, &d->forest, work->interval.x0, work->interval.x1, published);
    timer_lap(&since, &work->timings.contour_ms);
    work->counters.contours = d->patches.contours;
    work->counters.sealed = d->patches.sealed;
    if (!published) return find_without_adjacent(work);
    skip_adjacent(d, true, NULL);
    return traverse(work, TRAVERSAL_KEPT);
}

static cscd_status find_by_trees(step_work *work) {
    cscd_detector *d = work->detector;
    cscd_status status = prove_starts(work);
    if (status != CSCD_OK) return status;
    if (detector_seals(d)) return find_unsealed(work);
    choose_culled(work);
    if (!work->any_culled) return find_without_adjacent(work);
    orient(work);
    if (d->options.method == CSCD_METHOD_PUBLISHED) {
        skip_adjacent(d, follows(d, PUBLISHED_ADJACENT), NULL);
        return traverse(work, TRAVERSAL_KEPT);
    }
    if (work->any_not_culled) {
        status = find_without_adjacent(work);
    } else {
        skip_adjacent(d, false, NULL);
        status = traverse(work, TRAVERSAL_KEPT);
    }
    return status == CSCD_OK ? close_contacts(work) : status;
}

static cscd_status find_by_brute_force(step_work *work) {
    cscd_detector *d = work->detector;
    double since = timer_now_ms();
    parallel_run(d->context->threads, d->traversal.lane_count, test_share, work);
    timer_lap(&since, &work->timings.contact_ms);
    return lanes_status(d);
}

static cscd_guarantee guarantee_of(const cscd_detector *d, uint32_t component) {
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
        g.reason = finishes(d) ? CSCD_REASON_FINISHED : CSCD_REASON_EARLIEST;
    g.complete = g.reason != CSCD_REASON_EARLIEST && g.reason != CSCD_REASON_PUBLISHED;
    return g;
}

/* The states of the triangles go on to the end, but where contacts may be missing. */
static void hand_on_states(cscd_detector *d, const double *end) {
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

static cscd_status step(step_work *work, cscd_contacts *contacts) {
    cscd_detector *d = work->detector;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) contact_lane_reset(&d->contact_lanes[i]);
    d->rebuilt = false;
    culling_clear(&d->culling);
    tainting_begin(d);
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->finished[c] = false;
    if (detector_culls(d) && d->options.start == CSCD_START_VOUCHED) start_states_vouch(&d->starts);
    start_states_count(&d->starts);
    bool brute = d->options.method == CSCD_METHOD_BRUTE;
    cscd_status status = brute ? find_by_brute_force(work) : find_by_trees(work);
    if (status != CSCD_OK) return status;
    work->counters.rebuilds = d->rebuilt;
    tainting_look(d);
    double since = timer_now_ms();
    status = contact_list_collect(d, &work->counters, contacts);
    timer_lap(&since, &work->timings.contact_ms);
    return status;
}

/* What was seen last has been checked then. States are of the start from here on; without culling they matter
 * only if a static check has left some. */
static cscd_status check_positions(cscd_detector *d, const double *start, const double *end) {
    uint32_t vertices = d->mesh->vertex_count;
    cscd_status status = CSCD_OK;
    if (end == NULL || start == NULL || !start_states_hold(&d->starts, start)) {
        status = positions_check(d->context, start, vertices, "start");
        if (status == CSCD_OK) status = positions_check(d->context, end, vertices, "end");
        if (status == CSCD_OK && (detector_culls(d) || d->starts.known))
            start_states_begin(&d->starts, start);
        return status;
    }
    return positions_check(d->context, end, vertices, "end");
}

cscd_status cscd_detector_step(cscd_detector *detector, const double *start, const double *end,
                               cscd_contacts *out) {
    if (detector == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = detector->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_step: out is NULL");
    double since = timer_now_ms();
    cscd_status status = check_positions(detector, start, end);
    if (status != CSCD_OK) return status;

    cscd_contacts contacts;
    step_work work = {.detector = detector,
                      .interval = {.mesh = detector->mesh,
                                   .x0 = start,
                                   .x1 = end,
                                   .forest = &detector->forest,
                                   .representatives = &detector->representatives,
                                   .limit = detector->limit},
                      .all_clean = true,
                      .timings = {.check_ms = detector->timings.check_ms}};
    status = step(&work, &contacts);
    if (status != CSCD_OK) return context_out_of_memory(context);
    for (uint32_t c = 0; c < detector->mesh->component_count; c++)
        detector->guarantees[c] = guarantee_of(detector, c);
    hand_on_states(detector, end);
    timer_lap(&since, &work.timings.total_ms);
    detector->timings = work.timings;
    detector->counters = work.counters;
    *out = contacts;
    return CSCD_OK;
}
