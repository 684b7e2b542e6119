/* Queue of feature pairs. SIMD kernels decide them in batches of eight; the scalar test decides the rest. */
#pragma once

#include "runtime/narrow_phase/contact_worker.h"
#include "runtime/narrow_phase/swept_interval.h"

/* Decides all pairs of a kind that wait in the worker's queue, adds contacts and counts to the worker, and leaves
 * that queue empty. */
void feature_queue_decide(const swept_interval *interval, cscd_contact_kind kind, contact_worker *worker);

/* Returns whether no point of the pair moves. If so, decides it as elementary_after_signs does, with the
 * same contact, but sooner. */
bool still_pair_decide(const elementary_query *query, cscd_contact_kind kind, elementary_verdict *verdict,
                       elementary_contact *contact);
