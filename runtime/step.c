/* One interval through the stages of the pipeline. */
#include "runtime/detector.h"

#include "runtime/brute_force.h"
#include "runtime/contact_list.h"
#include "src/positions.h"
#include "src/timer.h"

/* As published, a patch of ICCD is any set of triangles: then all components are one part. */
static cscd_status build_of_one_part(cscd_detector *d, const double *positions) {
    uint32_t *none = context_allocate(d->context, d->mesh->triangle_count, sizeof *none);
    if (none == NULL) return CSCD_OUT_OF_MEMORY;
    forest_regions regions = {none, d->culling.triangle_weights, 1};
    cscd_status status = forest_build(d->mesh, regions, positions, BOX_AXES, &d->forest);
    context_free(d->context, none);
    return status;
}

cscd_status detector_build(cscd_detector *d, const double *positions) {
    if (d->forest.mesh != NULL) return CSCD_OK;
    if (d->options.method == CSCD_METHOD_ICCD_PUBLISHED) return build_of_one_part(d, positions);
    forest_regions regions = {d->culling.triangle_regions, d->culling.triangle_weights,
                              d->culling.region_count};
    return forest_build(d->mesh, regions, positions, BOX_AXES, &d->forest);
}

/* ---- one interval ---------------------------------------------------------------------------------- */

typedef struct step_work {
    cscd_detector *detector;
    swept_interval interval;
    cscd_timings timings;
    cscd_counters counters;
    bool any_culled;
} step_work;

static void test_batch(void *data, uint32_t index) {
    step_work *work = data;
    const traversal_lane *batch = &work->detector->traversal.lanes[index];
    contact_lane *lane = &work->detector->contact_lanes[index];
    for (uint32_t i = 0; i < batch->pair_count && !lane->out_of_memory; i++)
        narrow_phase_test(&work->interval, batch->pairs[i], lane);
    narrow_phase_finish(&work->interval, lane);
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

static cscd_status traverse(step_work *work, traversal_pass pass) {
    cscd_detector *d = work->detector;
    cscd_status status = CSCD_OK;
    double since = timer_now_ms();
    traversal_begin(&d->traversal, &d->forest, pass);
    for (bool more = true; more && status == CSCD_OK;) {
        status = traversal_round(&d->traversal, &more);
        timer_lap(&since, &work->timings.traversal_ms);
        if (status != CSCD_OK) return status;
        for (uint32_t i = 0; i < d->traversal.lane_count; i++)
            work->counters.pcp += d->traversal.lanes[i].pair_count;
        parallel_run(d->context->threads, d->traversal.lane_count, test_batch, work);
        status = lanes_status(d);
        timer_lap(&since, &work->timings.contact_ms);
    }
    work->counters.boxes_tested += traversal_boxes_tested(&d->traversal);
    return status;
}

/* ---- culling --------------------------------------------------------------------------------------- */

static bool follows(const cscd_detector *d, int rule) {
    return d->options.method == CSCD_METHOD_PUBLISHED && (d->published_rules & rule) != 0;
}

/* Which components are culled: those whose start is embedded, for certain. */
static cscd_status prove_starts(step_work *work) {
    cscd_detector *d = work->detector;
    double since = timer_now_ms();
    start_states_begin(&d->starts, work->interval.x0);
    if (!detector_culls(d)) return CSCD_OK;
    if (d->options.start == CSCD_START_VOUCHED) start_states_vouch(&d->starts);
    bool unproven = follows(d, PUBLISHED_UNPROVEN);
    if (d->options.start == CSCD_START_PROVE && !unproven && start_states_want_check(&d->starts)) {
        cscd_status status = static_check_components(d, work->interval.x0);
        if (status != CSCD_OK) return status;
        work->counters.static_checks++;
    }
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        bool embedded = d->mesh->components[c].closed_manifold && d->starts.of[c].state == START_EMBEDDED;
        d->culled[c] = embedded || unproven;
        work->any_culled |= d->culled[c];
    }
    timer_lap(&since, &work->timings.proof_ms);
    return CSCD_OK;
}

static void orient(step_work *work) {
    cscd_detector *d = work->detector;
    bool still = follows(d, PUBLISHED_STILL);
    double since = timer_now_ms();
    forest_view view = {.culled = d->culled,
                        .detector_offsets = (const double(*)[3])d->culling.detector_offsets,
                        .still = still};
    forest_orient(&d->forest, &view, d->culling.orientations);
    culling_count(&d->culling);
    timer_lap(&since, &work->timings.orientation_ms);
    work->counters.plus = d->culling.plus;
    work->counters.minus = d->culling.minus;
    work->interval.culling = follows(d, PUBLISHED_REPRESENTATIVES) ? NULL : &d->culling;
}

/* The component that both features belong to; UINT32_MAX: two. */
static uint32_t common_component(const cscd_mesh *mesh, const cscd_contact *contact) {
    bool vf = contact->kind == CSCD_CONTACT_VF;
    uint32_t first = vf ? mesh->vertex_stars[mesh->vertex_star_offsets[contact->a]]
                        : mesh->edge_stars[mesh->edge_star_offsets[contact->a]];
    uint32_t second = vf ? contact->b : mesh->edge_stars[mesh->edge_star_offsets[contact->b]];
    uint32_t a = mesh->triangle_components[first], b = mesh->triangle_components[second];
    return a == b ? a : UINT32_MAX;
}

/* Components with a contact with themselves, ignored pairs among them. */
static void find_touched(const cscd_detector *d) {
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->touched[c] = false;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        for (size_t j = 0; j < d->contact_lanes[i].count; j++) {
            uint32_t component = common_component(d->mesh, &d->contact_lanes[i].contacts[j]);
            if (component != UINT32_MAX) d->touched[component] = true;
        }
    }
}

/* A first contact that is to be left out may hide the one to report: then mode EARLIEST finishes, too. */
static bool finishes(const cscd_detector *d) {
    return d->options.mode == CSCD_MODE_ALL || d->options.ignore != NULL;
}

/* The pairs that were culled in components that did touch themselves. */
static cscd_status finish_touched(step_work *work) {
    cscd_detector *d = work->detector;
    bool any = false;
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        d->unfinished[c] = d->culled[c] && d->touched[c];
        any |= d->unfinished[c];
    }
    if (!any) return CSCD_OK;
    double since = timer_now_ms();
    forest_mark(&d->forest, d->culling.orientations, d->unfinished);
    timer_lap(&since, &work->timings.orientation_ms);
    work->interval.culled_pairs = true;
    return traverse(work, TRAVERSAL_FRESH);
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
    work->interval.skip_adjacent = published;
    return traverse(work, TRAVERSAL_KEPT);
}

/* Tests for minimum separation are dear, so pairs whose own volumes stay apart are left out first. */
static void sweep_vertices(void *data, uint32_t index) {
    const step_work *work = data;
    const cscd_detector *d = work->detector;
    size_t count = d->mesh->vertex_count, lanes = d->traversal.lane_count;
    for (size_t v = count * index / lanes; v < count * (index + 1) / lanes; v++) {
        kdop_exact start, end;
        kdop_point(work->interval.x0 + v * 3, &start);
        kdop_point(work->interval.x1 + v * 3, &end);
        kdop_exact_add(&start, &end);
        kdop_exact_widen(&start, d->limit.distance);
        d->vertex_volumes[v] = kdop_round(&start);
    }
}

static cscd_status find_by_trees(step_work *work) {
    cscd_detector *d = work->detector;
    double since = timer_now_ms();
    cscd_status status = detector_build(d, work->interval.x0);
    if (status != CSCD_OK) return status;
    forest_move(&d->forest, work->interval.x0, work->interval.x1, d->limit.distance);
    if (d->limit.distance > 0.0)
        parallel_run(d->context->threads, d->traversal.lane_count, sweep_vertices, work);
    timer_lap(&since, &work->timings.update_ms);
    if (detector_seals(d)) return find_unsealed(work);
    work->interval.skip_adjacent = follows(d, PUBLISHED_ADJACENT);
    if (!work->any_culled) return traverse(work, TRAVERSAL_KEPT);
    orient(work);
    status = traverse(work, TRAVERSAL_KEPT);
    if (status != CSCD_OK || !finishes(d) || d->options.method == CSCD_METHOD_PUBLISHED) return status;
    find_touched(d);
    return finish_touched(work);
}

static cscd_status find_by_brute_force(step_work *work) {
    cscd_detector *d = work->detector;
    double since = timer_now_ms();
    work->interval.vertex_volumes = NULL;
    parallel_run(d->context->threads, d->traversal.lane_count, test_share, work);
    timer_lap(&since, &work->timings.contact_ms);
    return lanes_status(d);
}

static cscd_guarantee guarantee_of(const cscd_detector *d, uint32_t component) {
    start_state start = d->starts.of[component].state;
    cscd_guarantee g = {true, start == START_EMBEDDED, CSCD_REASON_METHOD};
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
    else if (start != START_EMBEDDED)
        g.reason = start == START_CROSSING ? CSCD_REASON_CROSSING : CSCD_REASON_UNPROVEN;
    else if (!d->touched[component])
        g.reason = CSCD_REASON_CLEAN;
    else
        g.reason = finishes(d) ? CSCD_REASON_FINISHED : CSCD_REASON_EARLIEST;
    g.complete = g.reason != CSCD_REASON_EARLIEST && g.reason != CSCD_REASON_PUBLISHED;
    return g;
}

static cscd_status step(step_work *work, cscd_contacts *contacts) {
    cscd_detector *d = work->detector;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) contact_lane_reset(&d->contact_lanes[i]);
    culling_clear(&d->culling);
    cscd_status status = prove_starts(work);
    if (status == CSCD_OK)
        status = d->options.method == CSCD_METHOD_BRUTE ? find_by_brute_force(work) : find_by_trees(work);
    if (status != CSCD_OK) return status;
    find_touched(d);
    double since = timer_now_ms();
    status = contact_list_collect(d, &work->counters, contacts);
    timer_lap(&since, &work->timings.contact_ms);
    return status;
}

cscd_status cscd_detector_step(cscd_detector *detector, const double *start, const double *end,
                               cscd_contacts *out) {
    if (detector == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = detector->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_step: out is NULL");
    double since = timer_now_ms();
    cscd_status status = positions_check(context, start, detector->mesh->vertex_count, "start");
    if (status == CSCD_OK) status = positions_check(context, end, detector->mesh->vertex_count, "end");
    if (status != CSCD_OK) return status;

    cscd_contacts contacts;
    step_work work = {.detector = detector,
                      .interval = {.mesh = detector->mesh,
                                   .x0 = start,
                                   .x1 = end,
                                   .forest = &detector->forest,
                                   .vertex_volumes = detector->vertex_volumes,
                                   .representatives = detector->representatives,
                                   .limit = detector->limit},
                      .timings = {.check_ms = detector->timings.check_ms}};
    status = step(&work, &contacts);
    if (status != CSCD_OK) return context_out_of_memory(context);
    for (uint32_t c = 0; c < detector->mesh->component_count; c++)
        detector->guarantees[c] = guarantee_of(detector, c);
    bool lossy = detector->options.method == CSCD_METHOD_PUBLISHED ||
                 detector->options.method == CSCD_METHOD_ICCD_PUBLISHED;
    start_states_end(&detector->starts, end, lossy ? NULL : detector->touched);
    timer_lap(&since, &work.timings.total_ms);
    detector->timings = work.timings;
    detector->counters = work.counters;
    *out = contacts;
    return CSCD_OK;
}
