/* An interval that a method searches by itself, with trees and tests of its own, in place of those of a step. */
#include "runtime/detector/alone_search.h"

#include "src/core/timer.h"

typedef struct alone_work {
    cscd_detector *detector;
    own_interval interval;
} alone_work;

static void test_pairs(void *data, uint32_t lane) {
    alone_work *work = data;
    cscd_detector *d = work->detector;
    d->stages->search->test_pairs(d->baseline_state, &work->interval, &d->space.lanes[lane]);
}

cscd_status search_interval_alone(cscd_detector *d, interval_search *search, bool all_clean) {
    const bool all = all_clean || d->rules.assumes_clean;
    alone_work work = {d,
                       {.swept = &search->interval,
                        .culling = &d->culling,
                        .culled = d->culled,
                        .clean = all ? NULL : start_states_clean(&d->starts),
                        .ours = d->options.ours}};
    progress_stage(&d->context->progress, "traversal", 0.3, 0.5);
    cscd_status status =
        d->stages->search->find_pairs(d->baseline_state, &work.interval, &search->timings, &search->counters);
    if (status != CSCD_OK) return status;
    double since = timer_now_ms();
    progress_stage(&d->context->progress, "elementary tests", 0.5, 0.9);
    interval_search_run(search, 1, test_pairs, &work);
    timer_lap(&since, &search->timings.contact_ms);
    status = search_space_status(&d->space);
    return status == CSCD_OK ? context_progress_status(d->context) : status;
}
