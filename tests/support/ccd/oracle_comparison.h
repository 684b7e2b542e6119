/* An elementary test's answer beside the oracle's. */
#pragma once

#include "tests/support/ccd/algebraic_oracle.h"

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
