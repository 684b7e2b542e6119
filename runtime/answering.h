/* Which triangle pair answers for a pair of features, so that each is tested once. */
#ifndef CSCD_ANSWERING_H
#define CSCD_ANSWERING_H

#include "runtime/narrow_phase.h"

/* Does the pair (of, against) answer for corner i of the one and the face of the other? */
bool answers_for_vertex(const swept_interval *interval, uint32_t of, int i, uint32_t against);

/* Does the pair answer for edge i of its a and edge j of its b? */
bool answers_for_edges(const swept_interval *interval, triangle_pair pair, int i, int j);

#endif
