/* Which triangle pair answers for a pair of features, so that each is tested once. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

/* Of the pairs of features of pairs of triangles, bits as in kernels.h, keeps those that these answer for. */
void answering_select(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                      uint16_t *features);
