/* The elementary tests as a step runs them: through the feature queue, on every instruction set of the processor. */
#pragma once

#include "benchmarks/lib/pair_batches.h"

/* A batch of one. *hit is written when they touch only. */
elementary_verdict pair_test(cscd_contact_kind kind, const elementary_query *query, elementary_contact *hit);

/* All queries, in random order and in batches of random sizes. */
void pair_test_all(cscd_contact_kind kind, const elementary_query *queries, size_t count,
                   query_answer *answers);

/* How many queries of the last call each level decided. */
const uint64_t *pair_test_decided(void);

/* For pairs that have a mesh: the contacts, sorted by a and b, in memory that lasts until the next call. */
const cscd_contact *pair_test_source(const feature_source *source, cscd_contact_kind kind,
                                     const uint32_t (*pairs)[2], size_t count, size_t *contact_count);

/* Where instruction sets, or the sizes of batches, make a difference, all of these say so and abort. */
