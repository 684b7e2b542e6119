/* An exact answer to the elementary tests, by algebraic numbers, which shares nothing with the product; and
 * comparisons with it. */
#pragma once

#include "tests/support/ccd/elementary_cases.h"

#include <stdbool.h>

/* The first touch lies in [toi_low, toi_high], which are adjacent doubles, or equal and exact. simple: toi >
 * 0, and there the four points pass through a common plane at a rate other than 0. */
typedef struct oracle_verdict {
    bool touching, simple;
    double toi_low, toi_high;
} oracle_verdict;

/* Any finite coordinates; features are closed point sets, and may have no length or area. */
oracle_verdict algebraic_oracle(cscd_contact_kind kind, const elementary_query *query);

/* Gives back what the arithmetic keeps between calls. */
void algebraic_oracle_finish(void);

/* ---- comparisons --------------------------------------------------------------------------------------- */

typedef enum comparison {
    COMPARISON_AGREES,
    COMPARISON_MISSED,    /* a contact */
    COMPARISON_FALSE,     /* none, but one was reported */
    COMPARISON_TOO_LATE,  /* the time of impact, by anything */
    COMPARISON_TOO_EARLY, /* by more than 1e-9 */
    COMPARISON_COUNT
} comparison;

typedef struct compared {
    comparison result;
    oracle_verdict oracle;
    bool touching;
    elementary_contact hit; /* toi 2 where the test reports none */
} compared;

compared compare_with_oracle(cscd_contact_kind kind, const elementary_query *query);

/* All queries go through the feature queue together, in batches. */
void compare_all_with_oracle(cscd_contact_kind kind, const elementary_query *queries, size_t count,
                             compared *out);

/* In hexadecimal, as an initialiser, with both answers in a comment. */
void print_compared(cscd_contact_kind kind, const elementary_query *query, const compared *result);
