/* The times at which two moving features can begin to touch. */
#ifndef CSCD_CANDIDATE_TIMES_H
#define CSCD_CANDIDATE_TIMES_H

#include "runtime/coplanarity.h"
#include "runtime/elementary.h"

/* Enough for the cubic's roots and all events of a configuration that stays in a plane: EE has the most, 4
 * ends on an edge and 4 pairs of ends, in 3 projections. */
enum { CANDIDATE_TIMES_MAX = 8 + 2 + 4 * 3 * 2 + 4 * 3 };

typedef struct candidate_times {
    double t[CANDIDATE_TIMES_MAX];
    int count;
} candidate_times;

/* Ascending. f is the query's coplanarity cubic; where it does not differ from 0 for all t the roots decide,
 * otherwise the times at which a corner passes a side, or corners meet, in the coordinate planes. */
void candidate_times_vf(const elementary_query *query, const coplanarity *f, candidate_times *out);
void candidate_times_ee(const elementary_query *query, const coplanarity *f, candidate_times *out);

#endif
