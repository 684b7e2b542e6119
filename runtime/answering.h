/* Which triangle pair answers for a pair of features, so that each is tested once. */
#ifndef CSCD_ANSWERING_H
#define CSCD_ANSWERING_H

#include "runtime/narrow_phase.h"

/* Of pairs of features of two triangles, bits as in kernels.h, those that the pair answers for. */
uint32_t answering_select(const swept_interval *interval, triangle_pair pair, uint32_t features);

#endif
