/* The stages and counters of a step, a row each, as summaries, tables and benchmarks name them. */
#include "tool/common/stages.h"

#include "tool/common/methods.h"

#include <string.h>

#define TIME_OF(member)  offsetof(cscd_timings, member)
#define COUNT_OF(member) offsetof(cscd_counters, member)

const timing_row timing_rows[] = {
    {"update", "BVH update", "update", "bvh", TIMING_OF_ALL, TIME_OF(update_ms)},
    {"orientation", "orientation", "orient", "orient", TIMING_OF_REGIONS, TIME_OF(orientation_ms)},
    {"contour", "contour", "contour", "cnc", TIMING_OF_CONTOURS, TIME_OF(contour_ms)},
    {"traversal", "traversal", "travers", "traverse", TIMING_OF_ALL, TIME_OF(traversal_ms)},
    {"contact", "contact", "contact", "contact", TIMING_OF_ALL, TIME_OF(contact_ms)},
    {"proof", "proof", "proof", "proof", TIMING_OF_REGIONS, TIME_OF(proof_ms)},
    {"check", "check", "check", "check", TIMING_CHECK, TIME_OF(check_ms)},
    {"total", "total", "total", "ttcd", TIMING_TOTAL, TIME_OF(total_ms)},
};

_Static_assert(sizeof timing_rows / sizeof *timing_rows == TIMING_COUNT,
               "a member of cscd_timings has no row");

const counter_row counter_rows[] = {
    {"vf", COUNTER_OF_CONTACTS, COUNT_OF(vf)},
    {"ee", COUNTER_OF_CONTACTS, COUNT_OF(ee)},
    {"bounded", COUNTER_OF_CONTACTS, COUNT_OF(bounded)},
    {"pcp", COUNTER_AVERAGED, COUNT_OF(pcp)},
    {"adjacent", COUNTER_PLAIN, COUNT_OF(adjacent)},
    {"tests", COUNTER_AVERAGED, COUNT_OF(tests)},
    {"plus", COUNTER_AVERAGED, COUNT_OF(plus)},
    {"minus", COUNTER_AVERAGED, COUNT_OF(minus)},
    {"static_checks", COUNTER_SUMMED, COUNT_OF(static_checks)},
    {"clean_triangles", COUNTER_AVERAGED, COUNT_OF(clean)},
    {"passes", COUNTER_AVERAGED, COUNT_OF(passes)},
};

_Static_assert(sizeof counter_rows / sizeof *counter_rows == COUNTER_COUNT, "COUNTER_COUNT is not the count");

double timing_ms(const cscd_timings *timings, const timing_row *row) {
    double value;
    memcpy(&value, (const char *)timings + row->place, sizeof value);
    return value;
}

static void set_timing(cscd_timings *timings, const timing_row *row, double value) {
    memcpy((char *)timings + row->place, &value, sizeof value);
}

bool timing_applies(const timing_row *row, cscd_method method) {
    method_facts facts = method_facts_of(method);
    return (row->kind != TIMING_OF_CONTOURS || facts.by_contours) &&
           (row->kind != TIMING_OF_REGIONS || facts.by_regions);
}

void timings_add(cscd_timings *sum, cscd_timings *max, const cscd_timings *timings) {
    for (int i = 0; i < TIMING_COUNT; i++) {
        const timing_row *row = &timing_rows[i];
        double value = timing_ms(timings, row);
        set_timing(sum, row, timing_ms(sum, row) + value);
        if (value > timing_ms(max, row)) set_timing(max, row, value);
    }
}

void timings_divide(cscd_timings *timings, double divisor) {
    for (int i = 0; i < TIMING_COUNT; i++)
        set_timing(timings, &timing_rows[i], timing_ms(timings, &timing_rows[i]) / divisor);
}

uint64_t counter_value(const cscd_counters *counters, const counter_row *row) {
    uint64_t value;
    memcpy(&value, (const char *)counters + row->place, sizeof value);
    return value;
}

static void set_counter(cscd_counters *counters, const counter_row *row, uint64_t value) {
    memcpy((char *)counters + row->place, &value, sizeof value);
}

void counters_add(cscd_counters *sum, cscd_counters *max, const cscd_counters *counters) {
    for (int i = 0; i < COUNTER_COUNT; i++) {
        const counter_row *row = &counter_rows[i];
        uint64_t value = counter_value(counters, row);
        set_counter(sum, row, counter_value(sum, row) + value);
        if (value > counter_value(max, row)) set_counter(max, row, value);
    }
}

const char *interval_state_name(interval_state state) {
    static const char *const names[INTERVAL_STATES] = {"clean", "contact", "penetrating", "unknown"};
    return names[state];
}
