/* Distances of moving features by dense sampling in long double, which shares nothing with the code under test; and
 * random queries for them. */
#pragma once

#include "runtime/ccd/ccd.h"
#include "tests/support/ccd/elementary_cases.h"

#include <stdbool.h>

bool separation_test(cscd_contact_kind kind, const elementary_query *query, const separation *limit,
                     elementary_contact *hit, bool *bounded);

/* At one moment. */
long double sampled_distance(cscd_contact_kind kind, const elementary_query *query, long double t);

typedef enum sampled_answer { SAMPLED_APART, SAMPLED_WITHIN, SAMPLED_UNDECIDED } sampled_answer;

/* Do the features come within distance of each other? They cannot approach faster than their points, so
 * between two samples the distance has a lower bound; where it does not decide, there are more samples, up to
 * a number. WITHIN: *time is an early sample that is. */
sampled_answer sampled_within(cscd_contact_kind kind, const elementary_query *query, long double distance,
                              double *time);

/* The least distance over some samples, and more of them about the least. */
long double sampled_least(cscd_contact_kind kind, const elementary_query *query);

/* The largest difference of a coordinate from that of the first point at t = 0. */
double query_extent_of(const elementary_query *query);

/* max(tolerance, SEPARATION_FINEST * extent) */
long double tolerance_of(const elementary_query *query, const separation *limit);

/* Asserts, printing the query where they fail, all that separation.h says: of the answer, the time, the
 * distance then, u, v, point and normal. Returns whether the pair was reported. */
bool check_separation(cscd_contact_kind kind, const elementary_query *query, const separation *limit,
                      bool *bounded);

/* ---- families of queries ------------------------------------------------------------------------------- */

enum { SEPARATION_FAMILY_COUNT = 8 };

typedef struct separation_family {
    const char *name;
    void (*make)(elementary_query *query);
} separation_family;

/* They draw from the stream of tests/support/random.h. */
extern const separation_family separation_families[SEPARATION_FAMILY_COUNT];
