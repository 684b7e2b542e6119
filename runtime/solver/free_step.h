/* Finds how far vertices may go on straight lines without contact: tries shorter and shorter steps until one is proven. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"
#include "src/core/floating.h"

#include <math.h>

/* ---- numbers as the caller stores them ----------------------------------------------------------------- */

/* The nearest float. `volatile` is needed because gcc 12 drops neighbouring (double)(float) conversions when it joins them into vectors. */
static inline double stored_as_float(double x) {
    volatile float rounded = (float)x;
    return (double)rounded;
}

/* The number of the scalar that is nearest to x. Positions below the least length become 0, as no position may be nearer
 * to it. */
static inline double stored_coordinate(double x, cscd_scalar scalar) {
    if (scalar == CSCD_SCALAR_FLOAT) return stored_as_float(x);
    return fabs(x) < LENGTH_MIN ? 0.0 : x;
}

/* The largest number of the scalar that is not above x >= 0. */
static inline double stored_below(double x, cscd_scalar scalar) {
    if (scalar != CSCD_SCALAR_FLOAT) return x;
    const double rounded = stored_as_float(x);
    return rounded > x ? (double)nextafterf((float)rounded, 0.0f) : rounded;
}

/* ---- a motion ------------------------------------------------------------------------------------------ */

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

/* Writes x0 + fraction (x1 - x0), rounded, to floats if the caller wants that; at 0 and 1 x0 and x1 themselves.
 * A coordinate that is nearer to 0 than positions may be becomes 0. */
void motion_at(const straight_motion *m, double fraction, double *out);

/* Bounds how far rounding changes the distance of two points on the motion. */
double motion_rounding(const straight_motion *m);

/* ---- steps --------------------------------------------------------------------------------------------- */

/* Finds contacts between two moments of the motion, the first contact among them. */
typedef cscd_status motion_test(void *of, const double *from, const double *to, cscd_contacts *out);

/* The steps that are tried: at most `longest`, then a share step_factor of the time of the first contact, and less. */
typedef struct step_quest {
    cscd_context *context;
    double step_factor, longest;
    motion_test *test;
    void *of; /* for the test */
} step_quest;

/* Finds the longest of the steps tried, whose end is reached without contact, and writes that end to
 * `reached`. IN_CONTACT: no step is free of contact; then *out has the pair that touches, and nothing else is written. */
cscd_status free_step_find(const step_quest *quest, const straight_motion *m, double *reached,
                           cscd_free_step *out);
