/* Floors: how near two features may come that are nearer already than they should be. */
#pragma once

#include "runtime/ccd/min_separation.h"

/* The rungs of a pair are distance, ratio * distance, ratio^2 * distance and so on; ratio lies in (0, 1). tolerance is
 * a share of a rung. */
typedef struct floor_ladder {
    double distance, ratio, tolerance;
} floor_ladder;

/* Rungs below this share of the pair's extent at a moment count as 0: touching is decided exactly. The same share of
 * the extent is what a distance must exceed a rung by, beside the tolerance, to exceed it surely. The extent is the
 * largest difference of a coordinate from that of the first point. */
#define FLOOR_FINEST 0x1p-40

/* Returns the greatest rung below a distance, 0 if that is 0. */
double separation_floor_rung(const floor_ladder *ladder, double distance);

/* The floor of features at rest in these positions: the greatest rung that their distance surely exceeds, or 0. It
 * depends on nothing else, and a common translation changes the differences only, that is, nothing but rounding. */
double separation_floor_at(const double x[4][3], cscd_contact_kind kind, const floor_ladder *ladder);

typedef enum floor_verdict {
    FLOOR_KEPT,   /* the features stay above their floor at the start, and it is no lower at the end */
    FLOOR_BROKEN, /* that is not certain; *contact and *bounded say when, as separation_vf does */
    FLOOR_NONE    /* the floor is 0 */
} floor_verdict;

floor_verdict separation_floor_test(const elementary_query *query, cscd_contact_kind kind,
                                    const floor_ladder *ladder, elementary_contact *contact, bool *bounded);
