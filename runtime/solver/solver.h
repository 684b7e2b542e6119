/* The calls of a solver share this: pairs of features that are near each other at one moment, and certified steps. */
#pragma once

#include "runtime/detector/detector.h"
#include "runtime/solver/free_step.h"

/* ---- the calls of the API, within a call ----------------------------------------------------------------- */

cscd_status solver_find_near(cscd_detector *detector, const cscd_view *positions, double distance,
                             cscd_near_form form, cscd_proximities *out);
cscd_status solver_max_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                            const cscd_mutable_view *reached, cscd_free_step *out);
cscd_status solver_make_safe(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                             const cscd_response_options *options, const cscd_mutable_view *reached,
                             cscd_safe_motion *out);

/* ---- near pairs ---------------------------------------------------------------------------------------- */

/* Returns INVALID_ARGUMENT, with a sentence, unless this is a form of the list. */
cscd_status proximity_check_form(cscd_context *context, cscd_near_form form);

/* The same for a distance that can be asked for in this form. */
cscd_status proximity_check_distance(const cscd_detector *d, double distance, cscd_near_form form);

/* Begins a search of the moment with that limit. */
interval_search proximity_search(cscd_detector *d, const double *positions, double distance,
                                 cscd_near_form form);

/* Lists what the search has found, in the detector's memory, sorted by (kind, a, b). */
cscd_status proximity_collect(cscd_detector *d, const double *positions, cscd_near_form form,
                              cscd_proximities *out);

/* Finds all pairs within the distance and lists them so. The positions have been checked. */
cscd_status proximity_find(cscd_detector *d, const double *positions, double distance, cscd_near_form form,
                           cscd_proximities *out);

/* The motion that may bring pairs together, and per object how far any of its vertices goes. */
typedef struct near_ways {
    motion_bounds bounds;
    double *of_objects; /* becomes how far its volumes are widened */
    double farthest;    /* of all pairs */
} near_ways;

/* Finds all pairs that may come within what they keep while vertices keep to the bounds of their motion, and lists them so, with
 * kind, a, b, vertices, weights, normal and separation alone: proximity_complete writes all of one item. *parted says how many
 * more would be listed without the motions of the bounds, of which the caller needs to know no more. */
cscd_status proximity_find_on_ways(cscd_detector *d, const double *positions, near_ways *ways, size_t *parted,
                                   cscd_proximities *out);
void proximity_complete(cscd_detector *d, const double *positions, size_t item, cscd_proximity *out);

/* Makes room for the positions that a call reaches, d->reached. */
cscd_status solver_reserve_reached(cscd_detector *d);

/* ---- truncation ---------------------------------------------------------------------------------------- */

/* The motion that a caller wants, and the scalar in which each object's positions are stored. */
typedef struct wanted_motion {
    const double *x0, *x1;
    const cscd_scalar *scalars; /* per object; NULL: doubles */
} wanted_motion;

/* Chooses the scalars of the positions that are reached, which are compared with the planes as they are written.
 * INVALID_ARGUMENT: a vertex could not stay where it is; the sentence begins with the name of the function. */
cscd_status truncation_scalars(cscd_detector *d, const char *function, const cscd_view *x0,
                               const cscd_mutable_view *reached, const cscd_scalar **out);

/* Writes where the vertices go: docs/theory/displacement-bounds.md, lemmas 4 to 6, say what holds then. The vertices of a
 * seam go the same share. What the detector knows of x0, it then knows of the end. The positions have been checked. */
cscd_status truncation_find(cscd_detector *d, const wanted_motion *motion, double search_radius, double *end,
                            cscd_truncation *out);

/* The same, by planes between these pairs alone: of each, kind, a, b, vertices and separation. Other pairs may come into contact,
 * and what the detector knows of x0 remains. */
cscd_status truncation_divide(cscd_detector *d, const wanted_motion *motion, const cscd_proximities *pairs,
                              double *end);

/* ---- certified steps ----------------------------------------------------------------------------------- */

/* INVALID_ARGUMENT, with a sentence that begins with the function's name, if the method loses contacts. */
cscd_status certified_check_method(const cscd_detector *d, const char *function);

/* The searches of a call, of which at most the last one is taken, and the sums over them. */
typedef struct tries {
    cscd_detector *detector;
    cscd_timings timings;
    cscd_counters counters;
    bool any;
    double done; /* estimated share of the call: each try takes half of what is left */
} tries;

/* Finds the contacts between two moments. Withdraws the previous try first, because the vertices did not go to its end. */
cscd_status tries_find(tries *t, const double *from, const double *to, cscd_mode mode, step_rule rule,
                       cscd_contacts *out);

void tries_withdraw(tries *t);

/* Ends a call that has failed, and passes the status on. */
cscd_status tries_fail(tries *t, cscd_status status);

/* Ends a call that has begun at `since`: its timings and counters are the sums. */
void tries_end(const tries *t, double since);

/* Finds the longest step of a motion that is certified free of contact, by the stages of a step. The motion's
 * positions have been checked. The positions that are reached are d->reached; timings and
 * counters are those of the whole search. The status is as in cscd_detector_max_step; with IN_CONTACT, too, *out is
 * written. */
cscd_status max_step_find(cscd_detector *d, const straight_motion *m, cscd_free_step *out);
