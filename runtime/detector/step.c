/* One interval through the stages of the pipeline. */
#include "runtime/detector/step.h"

#include "runtime/culling/culling.h"
#include "runtime/detector/adaptive.h"
#include "runtime/detector/alone_search.h"
#include "runtime/detector/contact_list.h"
#include "runtime/detector/earliest_contacts.h"
#include "runtime/detector/guarantee.h"
#include "runtime/detector/interval_search.h"
#include "runtime/detector/list_cap.h"
#include "runtime/detector/waiting.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"
#include "src/mesh/views.h"

#include <math.h>

/* ---- one interval ---------------------------------------------------------------------------------- */

typedef struct step_work {
    cscd_detector *detector;
    interval_search search;
    cscd_mode mode;
    bool rehearsal;                  /* the vertices may not go to the interval's end */
    uint32_t unproven;               /* triangles whose start is still to be checked */
    bool any_culled, any_not_culled; /* components */
    bool all_clean;                  /* every triangle of the components that are culled is clean */
    cscd_contacts contacts;
} step_work;

/* A first contact that is to be left out may hide the one to report: then mode EARLIEST finds all contacts, too. */
static bool finds_all_contacts(const step_work *work) {
    return work->mode == CSCD_MODE_ALL || exclusions_any(&work->detector->exclusions);
}

/* Are only the earliest contacts of each component with itself listed? The published methods promise nothing. */
static bool lists_earliest(const step_work *work) {
    return !finds_all_contacts(work) && !work->detector->traits->loses_contacts;
}

static void begin_interval(step_work *work) {
    cscd_detector *d = work->detector;
    d->rebuild.rebuilt = false;
    culling_clear(&d->culling);
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->culled[c] = d->closes[c] = false;
    d->lists_earliest = lists_earliest(work);
    earliest_begin(d);
    for (uint32_t i = 0; i < d->space.traversal.lane_count; i++) d->contacts_seen[i] = 0;
    if (detector_culls(d) && d->options.start == CSCD_START_VOUCHED) start_states_vouch(&d->starts);
    start_states_count(&d->starts);
    adaptive_begin(d);
    if (work->rehearsal) start_states_save(&d->starts);
}

/* ---- start states, refit --------------------------------------------------------------------------- */

/* If more than one triangle in this many is unproven, the trees are refitted to the start alone; fewer triangles are
 * compared with the volumes of the interval, which are needed anyway. */
enum { UNPROVEN_SHARE = 16 };

/* Finds out which unproven triangles are clean, with the volumes that the trees have now. */
static cscd_status check_start(step_work *work) {
    cscd_detector *d = work->detector;
    progress_stage(&d->context->progress, "start", 0.0, 0.3);
    const size_t longest = d->options.longest_list;
    if (longest > 0) list_cap_begin_pairs(d, longest, NULL, NULL);
    cscd_status status =
        static_check_unproven(&d->check, &d->space.traversal, &d->space.bvh, work->search.interval.x0);
    list_cap_end_check(d);
    work->unproven = 0;
    if (status != CSCD_OK) return status;
    start_states_checked(&d->starts, d->check.unproven, d->check.crossing);
    if (work->rehearsal) start_states_save(&d->starts);
    return CSCD_OK;
}

static cscd_status prove_starts(step_work *work) {
    cscd_detector *d = work->detector;
    if (!detector_culls(d) || d->rules.assumes_clean || d->options.start != CSCD_START_PROVE) return CSCD_OK;
    double since = timer_now_ms();
    cscd_status status = CSCD_OK;
    work->unproven =
        start_states_mark_unproven(&d->starts, collapsed_marks(&d->collapsed), d->check.unproven);
    work->search.counters.static_checks = work->unproven > 0;
    if (work->unproven > d->mesh->triangle_count / UNPROVEN_SHARE) {
        status = bvh_rebuild_move_to(&d->rebuild, &d->space.bvh, work->search.interval.x0,
                                     uniform_growth(0.0), detector_growth(d));
        if (status == CSCD_OK) status = check_start(work);
    }
    timer_lap(&since, &work->search.timings.proof_ms);
    return status;
}

static cscd_status refit_trees(step_work *work) {
    cscd_detector *d = work->detector;
    const swept_interval *interval = &work->search.interval;
    double since = timer_now_ms();
    volume_growth growth = detector_growth(d);
    growth.beyond = interval->beyond;
    cscd_status status =
        bvh_rebuild_move(&d->rebuild, &d->space.bvh, interval->x0, interval->x1, growth, growth);
    timer_lap(&since, &work->search.timings.update_ms);
    return status;
}

static cscd_status prove_remaining_starts(step_work *work) {
    if (work->unproven == 0) return CSCD_OK;
    double since = timer_now_ms();
    cscd_status status = check_start(work);
    timer_lap(&since, &work->search.timings.proof_ms);
    return status;
}

/* ---- orientation ----------------------------------------------------------------------------------- */

static cscd_status hide_pairs(step_work *work) {
    cscd_detector *d = work->detector;
    if (!detector_hides_pairs(d)) return CSCD_OK;
    const swept_interval *interval = &work->search.interval;
    double since = timer_now_ms();
    cscd_status status = d->stages->hider->hide(d->baseline_state, &d->space.bvh, interval->x0, interval->x1,
                                                &work->search.counters);
    timer_lap(&since, &work->search.timings.contour_ms);
    return status;
}

static bool is_culled(const cscd_detector *d, uint32_t component, uint32_t clean, uint32_t triangle_count) {
    if (!detector_culls(d) || d->never_culled[component]) return false;
    if (d->rules.assumes_clean) return d->mesh->components[component].closed_manifold;
    if (d->rules.where_it_pays && !d->starts.of[component].chosen) return false;
    return start_states_pay(&d->starts, clean, triangle_count);
}

/* Culls closed components in which nearly all triangles are clean. */
static cscd_status choose_culled(step_work *work) {
    cscd_detector *d = work->detector;
    if (detector_hides_pairs(d)) return CSCD_OK; /* instead of culling */
    start_states_count(&d->starts);
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        const cscd_component *component = &d->mesh->components[c];
        if (component_is_obstacle(d->mesh, c) || detector_masks(d, c)) continue;
        if (d->leaves_collapsed && d->collapsed.marks[c]) {
            work->any_not_culled = true;
            continue;
        }
        uint32_t clean = component->closed_manifold ? d->starts.of[c].clean : 0;
        bool embedded = clean == component->triangle_count;
        d->culled[c] = is_culled(d, c, clean, component->triangle_count);
        d->closes[c] = d->culled[c] && d->stages->search == NULL;
        work->any_culled |= d->culled[c];
        work->any_not_culled |= !d->culled[c];
        work->all_clean &= !d->culled[c] || embedded;
        work->search.counters.clean += clean;
    }
    return CSCD_OK;
}

static orientation_query orientation_query_of(const step_work *work) {
    const cscd_detector *d = work->detector;
    return (orientation_query){.culled = d->culled,
                               .clean = work->all_clean ? NULL : start_states_clean(&d->starts),
                               .detector_offsets = (const double(*)[3])d->culling.detector_offsets};
}

static cscd_status orient_triangles(step_work *work) {
    cscd_detector *d = work->detector;
    orientation_query query = orientation_query_of(work);
    if (detector_region_count(d) > 0) bvh_detector_points(&d->space.bvh, &query, d->culling.detector_points);
    if (!work->any_culled) return CSCD_OK;
    double since = timer_now_ms();
    bvh_orient(&d->space.bvh, &query, d->culling.facing);
    culling_begin(&d->culling);
    timer_lap(&since, &work->search.timings.orientation_ms);
    work->search.counters.plus = d->culling.plus;
    work->search.counters.minus = d->culling.minus;
    work->search.interval.culling = &d->culling;
    work->search.interval.culled = d->culled;
    return CSCD_OK;
}

/* ---- traversal, closing pass ----------------------------------------------------------------------- */

static cscd_status traverse_pairs(step_work *work) {
    cscd_detector *d = work->detector;
    cscd_status status =
        detector_leave_collapsed(d, d->leaves_collapsed ? COLLAPSED_PAIRS_LEFT : COLLAPSED_FOUND);
    if (status != CSCD_OK) return status;
    bool all_culled = work->any_culled && !work->any_not_culled;
    if (!all_culled) return interval_search_everything(&work->search);
    interval_search_skip_adjacent(&work->search, false);
    return interval_search_traverse(&work->search, TRAVERSAL_KEPT);
}

/* Taints triangles by the contacts that the lanes have gained since the last call, or by the earliest of them: what the
 * lanes have found together is the same for any number of threads, so all are noted before any taints. Returns how many
 * tainted triangles had culled pairs. */
static uint32_t taint_by_contacts(const step_work *work) {
    cscd_detector *d = work->detector;
    const tainting t = {d->mesh,
                        &d->starts,
                        &d->culling,
                        d->closes,
                        d->touched,
                        d->earliest,
                        d->lists_earliest ? earliest_tainting : INFINITY};
    uint32_t newly_kept = 0;
    if (d->lists_earliest) earliest_note(d);
    for (uint32_t i = 0; detector_culls(d) && i < d->space.traversal.lane_count; i++) {
        const contact_lane *lane = &d->space.lanes[i];
        for (size_t j = d->contacts_seen[i]; j < lane->count; j++)
            newly_kept += tainting_look(&t, contact_lane_at(lane, j));
        d->contacts_seen[i] = lane->count;
    }
    if (detector_culls(d)) newly_kept += list_cap_taint(d, &t);
    return newly_kept;
}

/* Tests the pairs that contacts have uncovered until they bring no more contacts that taint. Then every component has all
 * the contacts that are to be listed (docs/theory/culling.md). */
static cscd_status close_contacts(step_work *work) {
    cscd_detector *d = work->detector;
    if (!work->any_culled) return CSCD_OK;
    work->search.interval.closing_pass = true;
    for (;;) {
        double since = timer_now_ms();
        culling_pass_done(&d->culling);
        if (taint_by_contacts(work) == 0) return CSCD_OK;
        bvh_mark_newly_kept(&d->space.bvh, d->culling.earlier, d->culling.orientations);
        timer_lap(&since, &work->search.timings.orientation_ms);
        cscd_status status = interval_search_traverse(&work->search, TRAVERSAL_NEWLY_KEPT);
        if (status != CSCD_OK) return status;
        work->search.counters.passes++;
        d->passes++;
    }
}

/* ---- the pipeline ---------------------------------------------------------------------------------- */

typedef cscd_status step_stage(step_work *work);

static cscd_status search_every_feature_pair(step_work *work) {
    return interval_search_by_brute_force(&work->search);
}

static cscd_status test_loose_features(step_work *work) {
    return interval_search_loose(&work->search);
}

static cscd_status collect_contacts(step_work *work) {
    cscd_detector *d = work->detector;
    work->search.counters.rebuilds = d->rebuild.rebuilt;
    taint_by_contacts(work);
    if (d->lists_earliest) earliest_drop_later(d, earliest_share);
    double since = timer_now_ms();
    cscd_status status = contact_list_collect(&d->space, &d->exclusions, &d->contacts, &work->search.counters,
                                              &work->contacts);
    timer_lap(&since, &work->search.timings.contact_ms);
    return status;
}

static step_stage *const stages_by_trees[] = {
    prove_starts,           /* which triangles are clean at the start? */
    refit_trees,            /* bounding volumes over the interval */
    prove_remaining_starts, /* with these volumes, if only few are to be checked */
    hide_pairs,             /* pairs that a baseline's own test proves to stay apart */
    choose_culled,          /* components whose pairs are culled by orientation */
    orient_triangles,       /* from which side does each detector point see its triangles? */
    traverse_pairs,         /* triangle pairs, feature pairs, contacts */
    close_contacts,         /* pairs that these contacts uncover */
    test_loose_features,    /* wires, points and half-spaces */
    collect_contacts,       /* one sorted list */
    NULL};

/* The trees of a step are moved for the proof of the start alone. */
static cscd_status refit_for_proof(step_work *work) {
    return work->unproven > 0 ? refit_trees(work) : CSCD_OK;
}

static cscd_status search_alone(step_work *work) {
    return search_interval_alone(work->detector, &work->search, work->all_clean);
}

static cscd_status test_loose_without_trees(step_work *work) {
    return interval_search_all_loose(&work->search);
}

/* search_alone: trees and tests of the method's own */
static step_stage *const stages_alone[] = {
    prove_starts, refit_for_proof,          prove_remaining_starts, choose_culled,
    search_alone, test_loose_without_trees, collect_contacts,       NULL};

static step_stage *const stages_by_brute_force[] = {search_every_feature_pair, collect_contacts, NULL};

static cscd_status run_stages(step_stage *const *stages, step_work *work) {
    cscd_status status = CSCD_OK;
    for (int i = 0; status == CSCD_OK && stages[i] != NULL; i++) status = stages[i](work);
    return status;
}

cscd_status step_find(cscd_detector *d, const double *x0, const double *x1, cscd_mode mode, bool rehearsal,
                      step_outcome *out) {
    bool answered;
    if (rehearsal) start_states_save(&d->starts);
    detector_find_collapsed(d, x0, x1);
    d->leaves_collapsed = !rehearsal && d->collapsed.count > 0;
    cscd_status status = verlet_list_answer(d, x0, x1, out, &answered);
    if (status != CSCD_OK || answered) return status;
    step_work work = {.detector = d,
                      .search =
                          rehearsal ? detector_search_floors(d, x0, x1) : detector_search_begin(d, x0, x1),
                      .mode = mode,
                      .rehearsal = rehearsal,
                      .all_clean = true};
    if (d->leaves_collapsed) work.search.interval.filter.collapsed = d->collapsed.marks;
    work.search.timings.update_ms = d->verlet.spent_ms;
    begin_interval(&work);
    if (!rehearsal) list_cap_begin(d, &work.search, d->lists_earliest ? CAP_KEEPS_EARLIEST : CAP_TAINTS_ALL);
    status = run_stages(d->stages->brute_force       ? stages_by_brute_force
                        : detector_searches_alone(d) ? stages_alone
                                                     : stages_by_trees,
                        &work);
    d->space.traversal.collapsed = COLLAPSED_FOUND;
    if (status == CSCD_LIST_TOO_LONG) out->contacts = work.contacts;
    if (status != CSCD_OK) return status;
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->guarantees[c] = guarantee_of(d, c);
    d->verlet.now.was_quiet = work.contacts.count == 0;
    out->contacts = work.contacts;
    out->timings = work.search.timings;
    out->counters = work.search.counters;
    return CSCD_OK;
}

/* ---- from one interval to the next ----------------------------------------------------------------- */

/* The positions that were seen last were checked at that time. From here on the states are those of the start;
 * without culling they matter only if a static check has left some. */
cscd_status step_check_positions(cscd_detector *d, const double *start, const double *end) {
    uint32_t vertices = d->mesh->vertex_count;
    bool seen = start_states_hold(&d->starts, start);
    cscd_status status = seen ? CSCD_OK : positions_check(d->context, start, vertices, "x0");
    if (status == CSCD_OK) status = positions_check(d->context, end, vertices, "x1");
    if (status == CSCD_OK) status = detector_check_still(d, start, end);
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->exclusions.seams, start);
    if (status == CSCD_OK && !seen && (detector_culls(d) || d->starts.known))
        start_states_begin(&d->starts, start);
    return status;
}

static cscd_status step_between(cscd_detector *d, const double *x0, const double *x1, cscd_contacts *out) {
    double since = timer_now_ms();
    cscd_status status = step_check_positions(d, x0, x1);
    if (status != CSCD_OK) return status;

    step_outcome found;
    detector_begin_call(d);
    status = waiting_settle(d, x0);
    if (status == CSCD_OK) status = step_find(d, x0, x1, d->options.mode, false, &found);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status == CSCD_LIST_TOO_LONG) {
        *out = found.contacts;
        list_cap_fail(d, out->count);
    }
    if (status != CSCD_OK) return detector_fail_call(d, status);
    step_take(d, x1);
    timer_lap(&since, &found.timings.total_ms);
    found.timings.check_ms = d->timings.check_ms;
    d->timings = found.timings;
    d->counters = found.counters;
    *out = found.contacts;
    return CSCD_OK;
}

static cscd_status step_views(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                              cscd_contacts *out) {
    cscd_context *context = detector->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_step: out is NULL");
    const double *from = NULL, *to = NULL;
    cscd_contacts found;
    cscd_status status = views_read(context, detector->mesh, x0, "x0", &detector->unpacked[0], &from);
    if (status == CSCD_OK)
        status = views_read(context, detector->mesh, x1, "x1", &detector->unpacked[1], &to);
    if (status == CSCD_OK) status = step_between(detector, from, to, &found);
    if (status == CSCD_OK || status == CSCD_LIST_TOO_LONG) *out = found;
    return status;
}

cscd_status cscd_detector_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                               cscd_contacts *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, step_views(detector, x0, x1, out));
}
