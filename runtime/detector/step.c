/* One interval through the stages of the pipeline. */
#include "runtime/detector/detector.h"

#include "src/core/timer.h"
#include "src/mesh/positions.h"

#include <math.h>
#include <string.h>

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
    return work->mode == CSCD_MODE_ALL || exclusions_any(&work->detector->config.exclusions);
}

/* Are only the earliest contacts of each component with itself listed? The published methods promise nothing. */
static bool lists_earliest(const step_work *work) {
    return !finds_all_contacts(work) && !work->detector->config.traits->loses_contacts;
}

static void begin_interval(step_work *work) {
    cscd_detector *d = work->detector;
    d->rebuild.rebuilt = false;
    culling_clear(&d->interval.culling);
    for (uint32_t c = 0; c < d->mesh->component_count; c++)
        d->interval.culled[c] = d->interval.closes[c] = false;
    d->interval.lists_earliest = lists_earliest(work);
    earliest_begin(&d->interval);
    for (uint32_t i = 0; i < d->space.traversal.worker_count; i++) d->interval.contacts_seen[i] = 0;
    if (config_culls(&d->config) && d->config.options.start == CSCD_START_VOUCHED)
        start_states_vouch(&d->known.starts);
    start_states_count(&d->known.starts);
    interval_begin_counting(&d->interval, &d->config.rules, &d->known.starts,
                            d->config.options.start == CSCD_START_PROVE);
    if (work->rehearsal) start_states_save(&d->known.starts);
}

/* ---- start states, refit --------------------------------------------------------------------------- */

/* If more than one triangle in this many is unproven, the trees are refitted to the start alone; fewer triangles are
 * compared with the volumes of the interval, which are needed anyway. */
enum { UNPROVEN_SHARE = 16 };

/* Finds out which unproven triangles are clean, with the volumes that the trees have now. */
static cscd_status check_start(step_work *work) {
    cscd_detector *d = work->detector;
    progress_stage(&d->context->progress, "start", 0.0, 0.3);
    const list_cap *cap = &d->interval.cap;
    if (cap->longest > 0) list_cap_begin_pairs(cap, &d->known.check, cap->longest, NULL, NULL);
    cscd_status status =
        static_check_unproven(&d->known.check, &d->space.traversal, &d->space.bvh, work->search.interval.x0);
    list_cap_end_pairs(&d->known.check);
    work->unproven = 0;
    if (status != CSCD_OK) return status;
    start_states_checked(&d->known.starts, d->known.check.unproven, d->known.check.crossing);
    if (work->rehearsal) start_states_save(&d->known.starts);
    return CSCD_OK;
}

static cscd_status prove_starts(step_work *work) {
    cscd_detector *d = work->detector;
    if (!config_culls(&d->config) || d->config.rules.assumes_clean ||
        d->config.options.start != CSCD_START_PROVE)
        return CSCD_OK;
    double since = timer_now_ms();
    cscd_status status = CSCD_OK;
    work->unproven = start_states_mark_unproven(&d->known.starts, collapsed_marks(&d->known.collapsed),
                                                d->known.check.unproven);
    work->search.counters.static_checks = work->unproven > 0;
    if (work->unproven > d->mesh->triangle_count / UNPROVEN_SHARE) {
        status = bvh_rebuild_move_to(&d->rebuild, &d->space.bvh, work->search.interval.x0,
                                     uniform_growth(0.0), config_growth(&d->config));
        if (status == CSCD_OK) status = check_start(work);
    }
    timer_lap(&since, &work->search.timings.proof_ms);
    return status;
}

static cscd_status refit_trees(step_work *work) {
    cscd_detector *d = work->detector;
    const swept_interval *interval = &work->search.interval;
    double since = timer_now_ms();
    volume_growth growth = config_growth(&d->config);
    growth.distance = interval->limit.distance;
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
    if (!config_hides_pairs(&d->config) || d->space.bvh.mesh == NULL) return CSCD_OK;
    const swept_interval *interval = &work->search.interval;
    double since = timer_now_ms();
    cscd_status status = d->config.stages->hider->hide(d->config.baseline_state, &d->space.bvh, interval->x0,
                                                       interval->x1, &work->search.counters);
    timer_lap(&since, &work->search.timings.contour_ms);
    return status;
}

static bool is_culled(const cscd_detector *d, uint32_t component, uint32_t clean, uint32_t triangle_count) {
    if (!config_culls(&d->config) || d->config.never_culled[component]) return false;
    if (d->config.rules.assumes_clean) return d->mesh->components[component].closed_manifold;
    if (d->config.rules.where_it_pays && !d->known.starts.of[component].chosen) return false;
    return start_states_pay(&d->known.starts, clean, triangle_count);
}

/* Culls closed components in which nearly all triangles are clean. */
static cscd_status choose_culled(step_work *work) {
    cscd_detector *d = work->detector;
    if (config_hides_pairs(&d->config)) return CSCD_OK; /* instead of culling */
    start_states_count(&d->known.starts);
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        const cscd_component *component = &d->mesh->components[c];
        if (component_is_obstacle(d->mesh, c) || config_masks(&d->config, d->mesh, c)) continue;
        if (d->interval.leaves_collapsed && d->known.collapsed.marks[c]) {
            work->any_not_culled = true;
            continue;
        }
        uint32_t clean = component->closed_manifold ? d->known.starts.of[c].clean : 0;
        bool embedded = clean == component->triangle_count;
        d->interval.culled[c] = is_culled(d, c, clean, component->triangle_count);
        d->interval.closes[c] = d->interval.culled[c] && d->config.stages->search == NULL;
        work->any_culled |= d->interval.culled[c];
        work->any_not_culled |= !d->interval.culled[c];
        work->all_clean &= !d->interval.culled[c] || embedded;
        work->search.counters.clean += clean;
    }
    return CSCD_OK;
}

static orientation_query orientation_query_of(const step_work *work) {
    const cscd_detector *d = work->detector;
    return (orientation_query){.culled = d->interval.culled,
                               .clean = work->all_clean ? NULL : start_states_clean(&d->known.starts),
                               .detector_offsets = (const double(*)[3])d->interval.culling.detector_offsets};
}

static cscd_status orient_triangles(step_work *work) {
    cscd_detector *d = work->detector;
    orientation_query query = orientation_query_of(work);
    if (detector_region_count(d) > 0)
        bvh_detector_points(&d->space.bvh, &query, d->interval.culling.detector_points);
    if (!work->any_culled) return CSCD_OK;
    double since = timer_now_ms();
    bvh_orient(&d->space.bvh, &query, d->interval.culling.facing);
    culling_begin(&d->interval.culling);
    timer_lap(&since, &work->search.timings.orientation_ms);
    work->search.counters.plus = d->interval.culling.plus;
    work->search.counters.minus = d->interval.culling.minus;
    work->search.interval.culling = &d->interval.culling;
    work->search.interval.culled = d->interval.culled;
    return CSCD_OK;
}

/* ---- traversal, closing pass ----------------------------------------------------------------------- */

static cscd_status traverse_pairs(step_work *work) {
    cscd_detector *d = work->detector;
    cscd_status status =
        detector_leave_collapsed(d, d->interval.leaves_collapsed ? COLLAPSED_PAIRS_LEFT : COLLAPSED_FOUND);
    if (status != CSCD_OK) return status;
    bool all_culled = work->any_culled && !work->any_not_culled;
    if (!all_culled) return interval_search_everything(&work->search);
    interval_search_skip_adjacent(&work->search, false);
    return interval_search_traverse(&work->search, TRAVERSAL_KEPT);
}

/* Taints triangles by the contacts that the workers have gained since the last call, or by the earliest of them: what the
 * workers have found together is the same for any number of threads, so all are noted before any taints. Returns how many
 * tainted triangles had culled pairs. */
static uint32_t taint_by_contacts(const step_work *work) {
    cscd_detector *d = work->detector;
    const tainting t = {d->mesh,
                        &d->known.starts,
                        &d->interval.culling,
                        d->interval.closes,
                        d->interval.touched,
                        d->interval.earliest,
                        d->interval.lists_earliest ? earliest_tainting : INFINITY};
    uint32_t newly_kept = 0;
    if (d->interval.lists_earliest) earliest_note(&d->interval);
    for (uint32_t i = 0; config_culls(&d->config) && i < d->space.traversal.worker_count; i++) {
        const contact_worker *worker = &d->space.workers[i];
        for (size_t j = d->interval.contacts_seen[i]; j < worker->count; j++)
            newly_kept += tainting_look(&t, contact_worker_at(worker, j));
        d->interval.contacts_seen[i] = worker->count;
    }
    if (config_culls(&d->config)) newly_kept += list_cap_taint(&d->interval, &t);
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
        culling_pass_done(&d->interval.culling);
        if (taint_by_contacts(work) == 0) return CSCD_OK;
        bvh_mark_newly_kept(&d->space.bvh, d->interval.culling.earlier, d->interval.culling.orientations);
        timer_lap(&since, &work->search.timings.orientation_ms);
        cscd_status status = interval_search_traverse(&work->search, TRAVERSAL_NEWLY_KEPT);
        if (status != CSCD_OK) return status;
        work->search.counters.passes++;
        d->interval.passes++;
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
    if (d->interval.lists_earliest) earliest_drop_later(&d->interval, earliest_share);
    double since = timer_now_ms();
    cscd_status status = contact_list_collect(&d->space, &d->config.exclusions, &d->results.contacts,
                                              &work->search.counters, &work->contacts);
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

/* A method that searches by itself, with trees and tests of its own; contacts are left in the workers. */
typedef struct alone_work {
    cscd_detector *detector;
    own_interval interval;
} alone_work;

static void test_pairs_alone(void *data, uint32_t worker) {
    alone_work *work = data;
    cscd_detector *d = work->detector;
    d->config.stages->search->test_pairs(d->config.baseline_state, &work->interval,
                                         &d->space.workers[worker]);
}

static cscd_status search_alone(step_work *stage) {
    cscd_detector *d = stage->detector;
    interval_search *search = &stage->search;
    const bool all = stage->all_clean || d->config.rules.assumes_clean;
    alone_work work = {d,
                       {.swept = &search->interval,
                        .culling = &d->interval.culling,
                        .culled = d->interval.culled,
                        .clean = all ? NULL : start_states_clean(&d->known.starts),
                        .ours = d->config.options.ours}};
    progress_stage(&d->context->progress, "traversal", 0.3, 0.5);
    cscd_status status = d->config.stages->search->find_pairs(d->config.baseline_state, &work.interval,
                                                              &search->timings, &search->counters);
    if (status != CSCD_OK) return status;
    double since = timer_now_ms();
    progress_stage(&d->context->progress, "elementary tests", 0.5, 0.9);
    interval_search_run(search, 1, test_pairs_alone, &work);
    timer_lap(&since, &search->timings.contact_ms);
    status = search_space_status(&d->space);
    return status == CSCD_OK ? context_progress_status(d->context) : status;
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

/* ---- what is promised ---------------------------------------------------------------------------------- */

/* Returns the reason in a component's guarantee, for a method that culls. */
static cscd_reason culling_reason(const cscd_detector *d, uint32_t component, bool embedded) {
    if (d->config.never_culled[component]) return CSCD_REASON_METHOD;
    if (!d->mesh->components[component].closed_manifold) return CSCD_REASON_SURFACE;
    if (!embedded)
        return d->known.starts.of[component].crossing > 0 ? CSCD_REASON_CROSSING : CSCD_REASON_UNPROVEN;
    return d->interval.touched[component] ? CSCD_REASON_FINISHED : CSCD_REASON_CLEAN;
}

/* The promise of the current interval, all of whose stages are done, for the contacts of a component with itself. */
static cscd_guarantee guarantee_of(const cscd_detector *d, uint32_t component) {
    bool embedded = d->known.starts.of[component].clean == d->mesh->components[component].triangle_count;
    if (component_is_obstacle(d->mesh, component))
        return (cscd_guarantee){false, false, CSCD_REASON_OBSTACLE};
    if (config_masks(&d->config, d->mesh, component)) return (cscd_guarantee){false, false, CSCD_REASON_MASK};
    if (d->interval.leaves_collapsed && d->known.collapsed.marks[component])
        return (cscd_guarantee){false, embedded, CSCD_REASON_COLLAPSED};
    const bool by_method = config_culls(&d->config) || config_hides_pairs(&d->config);
    if (config_searches_alone(&d->config)) return (cscd_guarantee){false, embedded, CSCD_REASON_PUBLISHED};
    if (d->interval.lists_earliest && d->interval.earliest[component] < INFINITY)
        return (cscd_guarantee){false, embedded, CSCD_REASON_EARLIEST};
    if (!by_method) return (cscd_guarantee){true, embedded, CSCD_REASON_METHOD};
    if (!config_culls(&d->config)) return (cscd_guarantee){true, embedded, CSCD_REASON_CONTOUR};
    return (cscd_guarantee){true, embedded, culling_reason(d, component, embedded)};
}

/* ---- intervals in which nothing touches ---------------------------------------------------------------- */

/* Is every component that is looked at with itself culled as a whole in this interval? */
static bool culls_all_components(const cscd_detector *d) {
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        const cscd_component *component = &d->mesh->components[c];
        if (component_is_obstacle(d->mesh, c)) continue;
        if (!component->closed_manifold || d->known.starts.of[c].clean != component->triangle_count)
            return false;
    }
    return true;
}

/* Pairs of other kinds, distances and parts at rest go the usual way. */
static bool list_is_usable(cscd_detector *d) {
    if (d->config.options.coherence == CSCD_COHERENCE_OFF || !config_culls(&d->config) ||
        d->config.traits->loses_contacts)
        return false;
    if (config_is_thick(&d->config) || d->config.pair_rules.sets != NULL || d->space.active.vertices != NULL)
        return false;
    if (d->interval.leaves_collapsed) return false;
    if (mesh_has_loose_objects(d->mesh) || d->config.waiting.pairs.count > 0 || d->space.bvh.mesh == NULL)
        return false;
    start_states_count(&d->known.starts);
    return culls_all_components(d);
}

/* Leaves the detector as a step does that culls everything and finds nothing. */
static void end_quiet_interval(cscd_detector *d, const interval_search *search, step_outcome *out) {
    const verlet_list *v = &d->known.verlet;
    memcpy(d->interval.culling.facing, v->facing, d->mesh->triangle_count);
    bvh_skin_points(&v->skin, d->interval.culling.detector_points);
    d->rebuild.rebuilt = false;
    d->interval.lists_earliest = false;
    d->interval.passes = 0;
    out->timings = search->timings;
    out->counters.plus = v->plus;
    out->counters.minus = v->minus;
    out->counters.coherent = 1;
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        d->results.guarantees[c] = guarantee_of(d, c);
        out->counters.clean += d->interval.culled[c] ? d->known.starts.of[c].clean : 0;
    }
}

/* Tests the pairs of the list. */
static cscd_status test_list(cscd_detector *d, interval_search *search, step_outcome *out, bool *answered) {
    step_outcome found = {.counters = {0}};
    interval_cull_everything(&d->interval);
    cscd_status status = candidates_test(&d->known.verlet.pairs, search);
    if (status != CSCD_OK || search_space_found_any(&d->space)) return status;
    status = contact_list_collect(&d->space, &d->config.exclusions, &d->results.contacts, &found.counters,
                                  &found.contacts);
    if (status != CSCD_OK) return status;
    end_quiet_interval(d, search, &found);
    *out = found;
    d->known.verlet.serving = *answered = true;
    return CSCD_OK;
}

/* Answers the interval, whose start states are known, from a list if it can: then nothing touches in it, and contacts,
 * timings, counters and guarantees are written. If it cannot, *answered is false, and the trees are to be refitted. */
static cscd_status answer_from_list(cscd_detector *d, const double *x0, const double *x1, step_outcome *out,
                                    bool *answered) {
    double since = timer_now_ms(), update_ms = 0.0;
    bool holds;
    d->known.verlet.serving = *answered = false;
    d->known.verlet.spent_ms = 0.0;
    if (!list_is_usable(d)) return CSCD_OK;
    const verlet_place at = {&d->space, &d->rebuild, config_growth(&d->config), &d->interval,
                             d->known.starts.revision};
    cscd_status status = verlet_list_find(&d->known.verlet, &at, x0, x1, &holds);
    timer_lap(&since, &update_ms);
    d->known.verlet.spent_ms = update_ms;
    if (status != CSCD_OK || !holds) return status;
    interval_search search = config_search_begin(&d->config, &d->space, x0, x1);
    search.timings.update_ms = update_ms;
    status = test_list(d, &search, out, answered);
    timer_lap(&since, *answered ? &out->timings.contact_ms : &d->known.verlet.spent_ms);
    return status;
}

/* ---- one interval, either way -------------------------------------------------------------------------- */

/* What a quick search of floors looks at beyond the distance, as a share of it. A pair that it does not list is farther apart
 * than its distance by so much that the next motion, too, is sure of this. */
static const double quick_share = 0x1p-9;

/* Where only the rules of objects say distances, or the distance is small beside what its floors need, the quick search is
 * that of floors. */
static interval_search search_by_rule(cscd_detector *d, const double *x0, const double *x1, step_rule rule) {
    if (rule == STEP_WITHIN) return config_search_begin(&d->config, &d->space, x0, x1);
    interval_search search = detector_search_floors(d, x0, x1);
    const double distance = search.interval.limit.distance;
    if (rule == STEP_BELOW_FLOOR || config_is_thick(&d->config) ||
        !(search.interval.beyond < 0.5 * quick_share * distance))
        return search;
    search.interval.floor_ratio = 0.0;
    search.interval.limit = (separation){(1.0 + quick_share) * distance, distance};
    return search;
}

cscd_status step_find(cscd_detector *d, const double *x0, const double *x1, cscd_mode mode, step_rule rule,
                      step_outcome *out) {
    bool answered, rehearsal = rule != STEP_WITHIN;
    if (rehearsal) start_states_save(&d->known.starts);
    detector_find_collapsed(d, x0, x1);
    d->interval.leaves_collapsed = !rehearsal && d->known.collapsed.count > 0;
    cscd_status status = answer_from_list(d, x0, x1, out, &answered);
    if (status != CSCD_OK || answered) return status;
    step_work work = {.detector = d,
                      .search = search_by_rule(d, x0, x1, rule),
                      .mode = mode,
                      .rehearsal = rehearsal,
                      .all_clean = true};
    if (d->interval.leaves_collapsed) work.search.interval.filter.collapsed = d->known.collapsed.marks;
    work.search.timings.update_ms = d->known.verlet.spent_ms;
    begin_interval(&work);
    if (!rehearsal)
        list_cap_begin(&d->interval, &work.search,
                       d->interval.lists_earliest ? CAP_KEEPS_EARLIEST : CAP_TAINTS_ALL);
    status = run_stages(d->config.stages->brute_force       ? stages_by_brute_force
                        : config_searches_alone(&d->config) ? stages_alone
                                                            : stages_by_trees,
                        &work);
    d->space.traversal.collapsed = COLLAPSED_FOUND;
    if (status == CSCD_LIST_TOO_LONG) out->contacts = work.contacts;
    if (status != CSCD_OK) return status;
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->results.guarantees[c] = guarantee_of(d, c);
    d->known.verlet.now.was_quiet = work.contacts.count == 0;
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
    bool seen = start_states_hold(&d->known.starts, start);
    cscd_status status = seen ? CSCD_OK : positions_check(d->context, start, vertices, "x0");
    if (status == CSCD_OK) status = positions_check(d->context, end, vertices, "x1");
    if (status == CSCD_OK) status = detector_check_still(d, start, end);
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->config.exclusions.seams, start);
    if (status == CSCD_OK && !seen && (config_culls(&d->config) || d->known.starts.known))
        start_states_begin(&d->known.starts, start);
    return status;
}

void step_take(cscd_detector *d, const double *end) {
    if (!config_culls(&d->config)) {
        start_states_forget(&d->known.starts); /* contacts have tainted nothing */
        return;
    }
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        const cscd_guarantee *g = &d->results.guarantees[c];
        d->interval.incomplete[c] = !g->complete && g->reason != CSCD_REASON_OBSTACLE;
    }
    if (!d->known.verlet.serving) interval_learn(&d->interval, &d->config.rules, &d->known.starts);
    start_states_end(&d->known.starts, end, d->interval.incomplete);
    verlet_list_take(&d->known.verlet, d->known.starts.revision);
}

void step_withdraw(cscd_detector *d) {
    if (config_culls(&d->config)) start_states_restore(&d->known.starts);
}

static cscd_status step_between(cscd_detector *d, const double *x0, const double *x1, cscd_contacts *out) {
    double since = timer_now_ms();
    cscd_status status = step_check_positions(d, x0, x1);
    if (status != CSCD_OK) return status;

    step_outcome found;
    detector_begin_call(d);
    const waiting_place waiting = detector_waiting_place(d);
    status = waiting_settle(&waiting, x0);
    if (status == CSCD_OK) status = step_find(d, x0, x1, d->config.options.mode, STEP_WITHIN, &found);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status == CSCD_LIST_TOO_LONG) {
        *out = found.contacts;
        list_cap_fail(d->context, &d->interval.cap, out->count);
    }
    if (status != CSCD_OK) return detector_fail_call(d, status);
    step_take(d, x1);
    timer_lap(&since, &found.timings.total_ms);
    found.timings.check_ms = d->results.timings.check_ms;
    d->results.timings = found.timings;
    d->results.counters = found.counters;
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
