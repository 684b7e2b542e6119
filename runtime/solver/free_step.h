/* How far vertices may go on straight lines without contact: tries shorter and shorter steps until one is proven. */
#pragma once

#include "runtime/detector/detector.h"

/* A straight motion from x0 towards x1. */
typedef struct straight_motion {
    const cscd_mesh *mesh;
    const double *x0, *x1;
    const cscd_scalar *scalars; /* per object: positions on the way are rounded to it; NULL: to doubles */
} straight_motion;

/* Returns INVALID_ARGUMENT, with a sentence, if x0 or x1 would be infinite as the floats that they are to become. To be
 * asked before a search begins. */
cscd_status motion_check(cscd_context *context, const straight_motion *m);

/* The same, if rounding x0 would move a vertex that is not active. */
cscd_status motion_check_still(cscd_context *context, const straight_motion *m, const active_set *active);

/* Writes x0 + fraction (x1 - x0), rounded, and where that is asked for rounded to floats; at 0 and 1 x0 and x1 themselves.
 * A coordinate that is nearer to 0 than positions may be becomes 0. */
void motion_at(const straight_motion *m, double fraction, double *out);

/* Bounds how far rounding changes the distance of two points on the motion. */
double motion_rounding(const straight_motion *m);

/* Finds contacts between two moments of the motion, the first contact among them. */
typedef cscd_status motion_test(void *of, const double *from, const double *to, cscd_contacts *out);

/* Finds the longest of the steps tried, at most `longest`, whose end is reached without contact, and writes that end to
 * `reached`. IN_CONTACT: no step is free of contact; then *out has the pair that touches, and nothing else is written. */
cscd_status free_step_find(cscd_detector *d, const straight_motion *m, double longest, motion_test *test,
                           void *of, double *reached, cscd_free_step *out);
