/* Which triangle pair answers for a pair of features, so that each is tested once. */
#ifndef CSCD_ANSWERING_H
#define CSCD_ANSWERING_H

#include "runtime/narrow_phase.h"

/* Where there is culling, or pairs of adjacent triangles are left out: does the pair (of, against) answer for
 * corner i of the one and the face of the other? Without culling, of pairs of representatives it always does,
 * and is not asked. */
bool answers_for_vertex(const swept_interval *interval, uint32_t of, int i, uint32_t against);

/* The same for edge i of its a and edge j of its b. */
bool answers_for_edges(const swept_interval *interval, triangle_pair pair, int i, int j);

#endif
