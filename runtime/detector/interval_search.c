/* The search of one interval: from the trees, moved there, to the lanes' contacts. */
#include "runtime/detector/interval_search.h"

#include "runtime/narrow_phase/brute_force.h"
#include "src/core/timer.h"

interval_search interval_search_begin(cscd_detector *d, const double *x0, const double *x1,
                                      separation limit) {
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) contact_lane_reset(&d->contact_lanes[i]);
    return (interval_search){.detector = d,
                             .interval = {.mesh = d->mesh,
                                          .x0 = x0,
                                          .x1 = x1,
                                          .bvh = &d->bvh,
                                          .representatives = &d->representatives,
                                          .limit = limit}};
}

cscd_status interval_search_lanes_status(const cscd_detector *d) {
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        if (d->contact_lanes[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    return CSCD_OK;
}

/* Lanes search and test in turn: each takes of both what it finds, and nobody waits for anybody else's. */
static void search_and_test(void *data, uint32_t index) {
    interval_search *search = data;
    cscd_context *context = search->detector->context;
    traversal *t = &search->detector->traversal;
    traversal_lane *batch = &t->lanes[index];
    contact_lane *lane = &search->detector->contact_lanes[index];
    double begin = timer_now_ms(), spent = 0.0;
    while (!lane->out_of_memory && progress_go_on(&context->progress, traversal_done(t)) &&
           traversal_fill(t, index)) {
        batch->pairs_found += batch->pair_count;
        narrow_phase_test(&search->interval, batch->pairs, batch->pair_count, lane);
    }
    narrow_phase_finish(&search->interval, lane);
    timer_lap(&begin, &spent);
    batch->consume_ms = spent - batch->search_ms;
}

/* What the lanes took together goes to the stages as the lanes' own times are to each other. */
static void share_out(interval_search *search, double together_ms) {
    const traversal *t = &search->detector->traversal;
    double searched = 0.0, tested = 0.0;
    for (uint32_t i = 0; i < t->busy_lanes; i++) {
        searched += t->lanes[i].search_ms;
        tested += t->lanes[i].consume_ms;
        search->counters.pcp += t->lanes[i].pairs_found + t->lanes[i].adjacent;
        search->counters.adjacent += t->lanes[i].adjacent;
    }
    double share = searched + tested > 0.0 ? searched / (searched + tested) : 0.0;
    search->timings.traversal_ms += share * together_ms;
    search->timings.contact_ms += (1.0 - share) * together_ms;
}

cscd_status interval_search_traverse(interval_search *search, traversal_pass pass) {
    cscd_detector *d = search->detector;
    double since = timer_now_ms(), together = 0.0;
    bool last = pass == TRAVERSAL_FRESH;
    progress_stage(&d->context->progress, last ? "further passes" : "traversal", last ? 0.9 : 0.3,
                   last ? 1.0 : 0.9);
    traversal_begin(&d->traversal, &d->bvh, pass);
    timer_lap(&since, &search->timings.traversal_ms);
    parallel_run(d->context->threads, d->traversal.busy_lanes, search_and_test, search);
    timer_lap(&since, &together);
    share_out(search, together);
    search->counters.boxes_tested += traversal_boxes_tested(&d->traversal);
    cscd_status status = traversal_status(&d->traversal);
    if (status == CSCD_OK) status = interval_search_lanes_status(d);
    return status == CSCD_OK ? context_progress_status(d->context) : status;
}

/* ---- without pairs of adjacent triangles --------------------------------------------------------------- */

static void test_orphan_pairs(void *data, uint32_t index) {
    interval_search *search = data;
    cscd_detector *d = search->detector;
    contact_lane *lane = &d->contact_lanes[index];
    narrow_phase_test_orphan_pairs(&search->interval, &d->orphans, index, d->traversal.busy_lanes, lane);
    narrow_phase_finish(&search->interval, lane);
}

static void skip_adjacent(cscd_detector *d, bool everywhere, const bool *culled) {
    for (uint32_t c = 0; c < d->mesh->component_count; c++)
        d->skipped[c] = everywhere && (culled == NULL || !culled[c]);
    bvh_skip_adjacent(&d->bvh, d->skipped);
}

void interval_search_skip_adjacent(interval_search *search, bool everywhere) {
    skip_adjacent(search->detector, everywhere, NULL);
}

static cscd_status leave_out_adjacent(interval_search *search) {
    cscd_detector *d = search->detector;
    if (!d->orphans_known) {
        bool too_many;
        cscd_status status = orphan_pairs_create(d->mesh, &d->orphans, &too_many);
        if (status != CSCD_OK) return status;
        d->orphans_known = true;
        d->orphans_usable = !too_many;
    }
    search->interval.skip_adjacent = d->orphans_usable;
    skip_adjacent(d, d->orphans_usable, search->interval.culling != NULL ? d->culled : NULL);
    return CSCD_OK;
}

cscd_status interval_search_everything(interval_search *search) {
    cscd_detector *d = search->detector;
    cscd_status status = leave_out_adjacent(search);
    if (status == CSCD_OK) status = interval_search_traverse(search, TRAVERSAL_KEPT);
    if (status != CSCD_OK || !search->interval.skip_adjacent) return status;
    double since = timer_now_ms();
    parallel_run(d->context->threads, d->traversal.busy_lanes, test_orphan_pairs, search);
    timer_lap(&since, &search->timings.contact_ms);
    return interval_search_lanes_status(d);
}

/* ---- without trees ------------------------------------------------------------------------------------- */

static void test_share(void *data, uint32_t index) {
    interval_search *search = data;
    brute_force_test(&search->interval, index, search->detector->traversal.lane_count,
                     &search->detector->contact_lanes[index]);
}

cscd_status interval_search_by_brute_force(interval_search *search) {
    cscd_detector *d = search->detector;
    double since = timer_now_ms();
    progress_stage(&d->context->progress, "brute force", 0.0, 1.0);
    parallel_run(d->context->threads, d->traversal.lane_count, test_share, search);
    timer_lap(&since, &search->timings.contact_ms);
    cscd_status status = interval_search_lanes_status(d);
    return status == CSCD_OK ? context_progress_status(d->context) : status;
}
