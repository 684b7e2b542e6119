/* Methods, and the stages and counters of their steps, as the commands know them from what the library
 * says. */
#include "tool/common/methods.h"

#include <cscd/research.h>

#include <string.h>

method_facts method_facts_of(cscd_method method) {
    cscd_method_info info;
    if (!cscd_method_describe(method, &info)) return (method_facts){.by_regions = false};
    return (method_facts){
        .by_regions = info.by_orientation,
        .by_contours = info.by_contours,
        .makes_plan = info.makes_plan,
        .by_charge = info.by_charge,
        /* A published method to compare with is compared with regions. */
        .insists_on_plan = info.by_orientation && info.loses_contacts,
        .loses_contacts = info.loses_contacts,
    };
}

/* ---- steps of the published method --------------------------------------------------------------------- */

typedef struct step_word {
    const char *word;
    uint64_t bit;
} step_word;

/* Those of plans come first. */
static const step_word steps[] = {{"charge", CSCD_OURS_CHARGE},
                                  {"ranks", CSCD_OURS_RANKS},
                                  {"cuts", CSCD_OURS_CUTS},
                                  {"points", CSCD_OURS_POINTS},
                                  {"motion", CSCD_OURS_MOTION},
                                  {"starts", CSCD_OURS_STARTS},
                                  {"representatives", CSCD_OURS_REPRESENTATIVES},
                                  {"neighbours", CSCD_OURS_NEIGHBOURS},
                                  {"tests", CSCD_OURS_TESTS},
                                  {"boxes", CSCD_OURS_BOXES}};

enum { ALL_STEPS = sizeof steps / sizeof *steps, PLAN_STEPS = 4 };

uint64_t ours_of_plans(uint64_t ours) {
    uint64_t all = 0;
    for (int i = 0; i < PLAN_STEPS; i++) all |= steps[i].bit;
    return ours & all;
}

static bool find_step(const char *text, size_t length, int count, uint64_t *set) {
    for (int i = 0; i < count; i++) {
        if (strlen(steps[i].word) != length || memcmp(steps[i].word, text, length) != 0) continue;
        *set |= steps[i].bit;
        return true;
    }
    return false;
}

static bool read_steps(const char *text, int count, uint64_t *out) {
    uint64_t set = 0;
    for (;;) {
        const size_t length = strcspn(text, ",");
        if (!find_step(text, length, count, &set)) return false;
        if (text[length] == '\0') break;
        text += length + 1;
    }
    *out = set;
    return true;
}

/* The first of these steps that is not among the allowed ones; NULL: there is none. */
static const char *word_beyond(uint64_t ours, uint64_t allowed) {
    for (int i = 0; i < ALL_STEPS; i++)
        if ((ours & ~allowed & steps[i].bit) != 0) return steps[i].word;
    return NULL;
}

bool ours_agrees(cscd_method method, uint64_t ours, io_error *error) {
    const uint64_t of_iccd = CSCD_OURS_NEIGHBOURS | CSCD_OURS_TESTS | CSCD_OURS_BOXES;
    if (ours == 0) return true;
    if (!method_facts_of(method).loses_contacts)
        return io_fail(error, "--ours counts with --method published or iccd-published; leave it out");
    const char *beyond = word_beyond(ours, method == CSCD_METHOD_PUBLISHED ? UINT64_MAX : of_iccd);
    if (beyond != NULL)
        return io_fail(error, "--ours %s counts with --method published; with %s: neighbours, tests, boxes",
                       beyond, cscd_method_name(method));
    if ((ours & CSCD_OURS_CUTS) != 0 && (ours & CSCD_OURS_RANKS) == 0)
        return io_fail(error, "--ours cuts needs ranks; give --ours ranks,cuts");
    if ((ours & CSCD_OURS_POINTS) != 0 && (ours & CSCD_OURS_CUTS) == 0)
        return io_fail(error, "--ours points needs cuts; give --ours ranks,cuts,points");
    return true;
}

bool read_ours_of_plans(const char *text, void *place) {
    return read_steps(text, PLAN_STEPS, place);
}

bool read_ours(const char *text, void *place) {
    return read_steps(text, ALL_STEPS, place);
}

/* ---- stages and counters of a step --------------------------------------------------------------------- */

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
