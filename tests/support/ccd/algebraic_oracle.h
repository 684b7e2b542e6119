/* An exact answer to the elementary tests, by algebraic numbers: slow, and shares nothing with the product.
 */
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
