/* Methods, and the stages and counters of their steps, as the commands know them from what the library
 * says. */
#pragma once

#include "cscd/cscd.h"
#include "tool/io/io.h"

typedef struct method_facts {
    bool by_regions;  /* culls by the orientation of triangles, for which it needs regions */
    bool by_contours; /* culls by the contours of patches */
    bool
        makes_plan; /* `cscd preprocess` makes plans by it, and a step by it takes no other plan unless it insists */
    bool by_charge;       /* these plans have the charge of each triangle */
    bool insists_on_plan; /* takes a plan of any method, but does not go without one */
    bool loses_contacts;  /* culls as published */
} method_facts;

/* All false: the library has no such method. */
method_facts method_facts_of(cscd_method method);

/* Read a list of steps of the published method that are done as charge does them, such as "charge,ranks",
 * into a uint64_t: a sum of the CSCD_OURS_ constants of plans, or of all. */
bool read_ours_of_plans(const char *text, void *place);
bool read_ours(const char *text, void *place);

/* Those of plans alone. */
uint64_t ours_of_plans(uint64_t ours);

/* True if these steps count with this method, and with each other. The error names the word that does not. */
bool ours_agrees(cscd_method method, uint64_t ours, io_error *error);

/* ---- stages and counters of a step --------------------------------------------------------------------- */

typedef enum timing_kind {
    TIMING_OF_ALL,      /* a stage that every method has */
    TIMING_OF_REGIONS,  /* a stage of methods that cull by orientation */
    TIMING_OF_CONTOURS, /* a stage of methods that cull by contours */
    TIMING_CHECK,       /* beside the step: not a part of the total */
    TIMING_TOTAL
} timing_kind;

typedef struct timing_row {
    const char *name;  /* of the member in JSON; "NAME_ms" in the summary */
    const char *title; /* in the tool's table */
    const char *label; /* in the benchmarks' tables and JSON: 7 characters at most */
    const char *key;   /* "KEY_ms" in the JSON of benchmarks/methods */
    timing_kind kind;
    size_t place; /* of the double in cscd_timings */
} timing_row;

/* All members of cscd_timings: the stages of a step, the check, the total. */
enum { TIMING_COUNT = offsetof(cscd_timings, reserved) / sizeof(double), TIMING_STAGES = TIMING_COUNT - 2 };
extern const timing_row timing_rows[]; /* TIMING_COUNT of them */

double timing_ms(const cscd_timings *timings, const timing_row *row);
bool timing_applies(const timing_row *row, cscd_method method);

/* Adds to the sums, and raises the maxima. */
void timings_add(cscd_timings *sum, cscd_timings *max, const cscd_timings *timings);

void timings_divide(cscd_timings *timings, double divisor);

typedef enum counter_kind {
    COUNTER_OF_CONTACTS, /* in every interval of a summary, before the earliest time, and summed up at its end */
    COUNTER_SUMMED,      /* the same, behind the earliest time */
    COUNTER_AVERAGED,    /* in every interval; mean and maximum at the end */
    COUNTER_PLAIN        /* in every interval only */
} counter_kind;

typedef struct counter_row {
    const char *name; /* of the member in JSON */
    counter_kind kind;
    size_t place; /* of the uint64_t in cscd_counters */
} counter_row;

/* The counters that a summary has. */
enum { COUNTER_COUNT = 11 };
extern const counter_row counter_rows[]; /* COUNTER_COUNT of them */

uint64_t counter_value(const cscd_counters *counters, const counter_row *row);

/* Adds to the sums, and raises the maxima, of the counters that have a row. */
void counters_add(cscd_counters *sum, cscd_counters *max, const cscd_counters *counters);

/* The state of an interval. CLEAN: no intersection at the start, and no contact. CONTACT: no intersection
 * at the start, or not checked, and contact. PENETRATING: an intersection at the start. UNKNOWN: not
 * checked at the start, and no contact. */
typedef enum interval_state {
    INTERVAL_CLEAN,
    INTERVAL_CONTACT,
    INTERVAL_PENETRATING,
    INTERVAL_UNKNOWN,
    INTERVAL_STATES
} interval_state;

const char *interval_state_name(interval_state state);
