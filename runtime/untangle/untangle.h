/* One call of cscd_detector_untangle: what its stages share. */
#pragma once

#include "cscd/untangle.h"
#include "runtime/detector/detector.h"
#include "runtime/energy/energy.h"
#include "runtime/solver/solver.h"
#include "runtime/untangle/block_system.h"
#include "runtime/untangle/vertex_graph.h"

typedef struct untangle_work {
    cscd_detector *detector;
    cscd_context *context;
    const cscd_mesh *mesh;
    cscd_untangle_options options;
    const double *input; /* the given positions */
    const double *rest;  /* the rest shape; NULL: there is none */
    double *unpacked_rest;
    double *goal;       /* what the result is drawn to: the input, or towards the displacement of the start */
    vertex_graph graph; /* of the input */
    vertex_region region;
    block_system system;
    cscd_energy *energy;
    double *pulls; /* of the rest shape, per unknown 3 numbers; NULL: there is none */
    double pull_energy;
    double *right_side;            /* per row 3 numbers */
    double *inverse_masses;        /* per vertex 0 or 1 */
    double *reached;               /* positions */
    double until_ms;               /* of timer_now_ms */
    double stage_begin, stage_end; /* the share of the call that the present start takes */
    bool stopped;                  /* no time is left, or the host has cancelled */
    cscd_untangled found;
} untangle_work;

/* The views of packed positions, of all vertices. */
#define WORK_VIEW(w, x)    CSCD_DOUBLES(x, (w)->mesh->vertex_count)
#define WORK_MUTABLE(w, x) CSCD_MUTABLE_DOUBLES(x, (w)->mesh->vertex_count)

/* Says which share of the present start is done. */
void work_say(untangle_work *w, const char *stage, double share);

/* Asks whether the call goes on: there is time, and the host has not cancelled. */
bool work_goes_on(untangle_work *w);

/* A call that was cancelled ends the search for something better, and is no failure. */
cscd_status work_settle(untangle_work *w, cscd_status status);

/* Coordinates that the exact predicates do not take, because they are too near to 0, become 0, but for those of fixed
 * vertices. */
void work_flush(const untangle_work *w, double *x);

/* The least length that proximity takes. */
static const double least_length = 0x1p-300;

/* Are all coordinates numbers that the exact predicates take? Steps of systems that are nearly singular may lead anywhere. */
bool work_in_range(const untangle_work *w, const double *x);

/* Is it clean? *pairs: how many intersect; *near: how many others are nearer than they have to keep. */
typedef struct tangle_count {
    size_t pairs, near;
} tangle_count;
cscd_status work_count(untangle_work *w, const double *x, tangle_count *out);

/* ---- the elastic energy -------------------------------------------------------------------------------- */

/* 1/2 u' (M + spread^2 L + bending^4 L A^-1 L) u of displacements u, with the masses M, the areas A and the Laplacian L of the graph:
 * near the goal, and smooth; and with a rest shape spread^2 times (pulls' u + pull_energy). */

double elastic_value(const untangle_work *w, double spread, const double *u);

/* Writes the gradient at u; that of an unknown is at its first vertex. */
void elastic_gradient(const untangle_work *w, double spread, const double *u, double *gradient);

/* Adds the rows of the region to the system. */
bool elastic_add(untangle_work *w, double spread);

/* Over how many edges a length reaches. */
uint32_t elastic_rings(const untangle_work *w, double length);

/* Finds the pulls of a rest shape on vertices that are not farther than two spreads from the triangles of the pairs. OUT_OF_MEMORY. */
cscd_status rest_shape_pull(untangle_work *w, const double *rest, const cscd_intersections *found,
                            double spread);

/* ---- stages -------------------------------------------------------------------------------------------- */

/* Moves clean positions, in place, as near to the goal as motions free of contact lead by themselves. */
cscd_status approach_goal(untangle_work *w, double *x);

/* One such motion, towards positions that may be x itself: then only what is too near parts. *moved: has any coordinate changed? */
cscd_status approach_once(untangle_work *w, double *x, const double *to, bool *moved);

/* Moves clean positions, in place, by certified steps to where the elastic energy of their displacement from the goal and a
 * barrier between surfaces are least. */
cscd_status descent_run(untangle_work *w, double spread, double *x);

/* Pushes surfaces out of each other from the positions on, in place, without looking at what is between. *left: the fewest pairs
 * that were met, at what x is then. */
typedef struct push_rules {
    double stiffness; /* of what is pushed, in elastic stiffnesses */
    double beyond;    /* how much farther than touching, in edge lengths */
    double spread;    /* in thicknesses */
    bool smooth_ways; /* where rounds do not help: displacements, not surfaces */
} push_rules;
cscd_status push_out(untangle_work *w, const push_rules *rules, double *x, size_t *left);

/* Moves vertices so that intersection curves become shorter, none farther than that. */
cscd_status shorten_curves(untangle_work *w, double spread, double farthest, double *x);

/* Writes positions at which tangled bodies, components that seams join, are shrunk around their middles, if that makes them clean. Bodies
 * that cross themselves or cannot move are none that it helps. */
cscd_status shrink_apart(untangle_work *w, double *x, bool *clean);
