/* Results of a replay summed over its intervals, and the table at its end: the thesis' columns, mean and maximum per
 * frame. */
#pragma once

#include "tool/common/plan_source.h"
#include "tool/common/stages.h"

/* One interval's results, as the summary and the table need them. */
typedef struct interval_result {
    int32_t frame; /* its number */
    interval_state state;
    size_t contact_count;
    double earliest_toi; /* of the contacts, where there are any; NAN: they are not listed */
    const cscd_guarantee
        *guarantees;      /* per component; NULL: contacts are not listed, and counters are unknown */
    cscd_timings timings; /* check_ms: of the frame at the interval's end */
    cscd_counters counters;
} interval_result;

/* Sums over the intervals so far, and the largest value in an interval. */
typedef struct replay_totals {
    uint32_t intervals, intervals_with_contact, states[INTERVAL_STATES];
    uint32_t frames_checked, frames_crossing, frames_touching; /* touching: and not crossing */
    int32_t first_contact_frame;
    uint32_t contradictions;     /* clean intervals that end in an intersection: contacts that were lost */
    uint32_t intervals_complete; /* every component's contacts are complete, or it is collapsed */
    uint32_t intervals_unlisted; /* contacts are counted only, */
    uint64_t contacts_unlisted;  /* so many */
    cscd_timings time_sum, time_max;
    cscd_counters counter_sum, counter_max; /* of the counters that have a row in stages.h */
} replay_totals;

void totals_add(replay_totals *t, const interval_result *result, const cscd_mesh *mesh);
void totals_print_table(const replay_totals *t, cscd_method method);
