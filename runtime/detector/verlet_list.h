/* Answers intervals in which nothing touches, and little moves, from a list of the pairs that may touch in them (Verlet
 * 1967; docs/theory/coherence.md).
 *
 *     start ----> . . . . skin . . . .     The list is made at the start of an interval, of all pairs of features that
 *     list made   served  served  ends     can come together while no vertex moves farther than the skin. Intervals
 *                                          within the skin test these pairs alone. */
#pragma once

#include "runtime/bvh/bvh_skin.h"
#include "runtime/detector/candidates.h"

struct step_outcome;

typedef struct verlet_list {
    candidates pairs;
    bvh_skin skin;
    uint8_t *facing;      /* per triangle: orientations that last within the skin */
    uint64_t plus, minus; /* how many of each */
    bool exists;          /* it holds at the positions of this revision */
    uint64_t revision;    /* of start_states */
    bool serving;         /* the last interval was answered from it, and so its end is within the skin */
    bool was_quiet;       /* the last interval that was not had no contacts */
    uint32_t served;      /* intervals that were answered since it was made */
    uint32_t waiting,
        backoff; /* in intervals: until the next list, and after the last one that was of no use */
    double edge; /* the mean length of some edges; 0: not measured yet */
} verlet_list;

/* Looks at an interval of which the states of the start are known, and answers it if it can: then nothing touches in it, and
 * contacts, timings, counters and guarantees are written. If it cannot, *answered is false, and the trees are to be refitted,
 * as ever. CANCELLED, OUT_OF_MEMORY: see verlet_list_drop. */
cscd_status verlet_list_answer(cscd_detector *d, const double *x0, const double *x1, struct step_outcome *out,
                               bool *answered);

/* The vertices have gone to the end of the interval. */
void verlet_list_take(cscd_detector *d);

/* A call has failed, so the list is not used again. */
static inline void verlet_list_drop(verlet_list *v) {
    v->exists = v->serving = false;
}

void verlet_list_free(cscd_context *context, verlet_list *v);
