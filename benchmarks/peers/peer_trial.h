/* Us and the other programs on one scene, by turns. */
#pragma once

#include "benchmarks/lib/stages.h"
#include "benchmarks/peers/peer_scenes.h"

/* The candidates that take turns, in the order of a round. */
typedef enum peer_turn {
    TURN_NONE,           /* cscd_detector_step, method none */
    TURN_BROAD,          /* of that: update and traversal */
    TURN_SINGLE,         /* method single, after an interval without motion, so that the start is known */
    TURN_SINGLE_NEW,     /* method single, where the start must be proven first */
    TURN_EMBREE_REFIT,   /* update and find */
    TURN_EMBREE_REBUILD, /* the same with a new tree */
    TURN_CHECK,          /* cscd_detector_check, trees known */
    TURN_ONE_SHOT,       /* context, mesh, detector, trees, check, and all freed */
    TURN_CGAL_SETUP,     /* making the Surface_mesh */
    TURN_CGAL,           /* that, and self_intersections */
    TURN_COUNT
} peer_turn;

/* "none", "none_broad", ...: names in JSON. */
extern const char *const peer_turn_names[TURN_COUNT];

typedef struct peer_trial {
    double ms[TURN_COUNT][SAMPLES_MAX];
    uint32_t rounds;
    uint64_t our_boxes, embree_boxes, embree_reported; /* pairs of the broad phases */
    uint64_t contacts;                                 /* of method none */
    uint64_t our_pairs, cgal_pairs;                    /* pairs that meet at the start */
    uint64_t ours_alone, cgal_alone;                   /* of these, what only one side lists */
    uint32_t cgal_left_out;                            /* triangles for which CGAL has no place */
} peer_trial;

double peer_trial_least(const peer_trial *t, peer_turn turn);
double peer_trial_median(const peer_trial *t, peer_turn turn);

/* Runs the rounds, and one before them that does not count. Fails when a call does, and when Embree finds other pairs after a
 * refit than after a rebuild. */
bool peer_trial_run(const peer_scene *s, uint32_t rounds, peer_trial *out, io_error *error);
