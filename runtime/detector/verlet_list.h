/* Answers intervals in which nothing touches, and little moves, from a list of the pairs that may touch in them (Verlet
 * 1967; docs/theory/coherence.md).
 *
 *     start ----> . . . . skin . . . .     The list is made at the start of an interval, of all pairs of features that
 *     list made   served  served  ends     can come together while no vertex moves farther than the skin. Intervals
 *                                          within the skin test these pairs alone. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "runtime/detector/interval.h"

/* The state that a failing call puts back. */
typedef struct verlet_state {
    bool exists;       /* there is a list, which holds at the positions of this revision */
    uint64_t revision; /* of start_states */
    bool was_quiet;    /* the last interval that was not answered from a list had no contacts */
    uint32_t served;   /* intervals that were answered since the list was made */
    uint32_t pause;    /* intervals until the next list may be made */
    uint32_t backoff;  /* intervals that the last list of no use was followed by without one */
    double edge;       /* the mean length of some edges; 0: it is not known */
} verlet_state;

typedef struct verlet_list {
    candidates pairs;
    bvh_skin skin;
    uint8_t *facing;          /* per triangle: orientations that last within the skin */
    uint64_t plus, minus;     /* how many of each */
    verlet_state now, before; /* before: at the begin of the call */
    bool remade;              /* in this call the list has been replaced, or its memory given away */
    bool serving;    /* the last interval was answered from the list, so that its end is within the skin */
    double spent_ms; /* on a list in the last interval, where that was not answered */
} verlet_list;

/* Begins a call of the detector, and puts back what the call has changed. A list that is gone counts as one that has ended. */
void verlet_list_begin_call(verlet_list *v);
void verlet_list_undo(verlet_list *v);

/* The means to make a list: trees and how they are widened in a step, the interval, and the start of which it is made. */
typedef struct verlet_place {
    search_space *space;
    bvh_rebuild *rebuild;
    volume_growth growth;
    detector_interval *interval;
    uint64_t revision; /* of start_states */
} verlet_place;

/* Says whether there is a list that holds throughout the interval, in which everything is culled. Makes one if it promises to
 * be of use. */
cscd_status verlet_list_find(verlet_list *v, const verlet_place *at, const double *x0, const double *x1,
                             bool *holds);

/* The vertices have gone to the end of an interval that was answered from the list; the states there have this revision. */
void verlet_list_take(verlet_list *v, uint64_t revision);

void verlet_list_free(cscd_context *context, verlet_list *v);
