/* How far vertices may go on straight lines without contact: tries shorter and shorter steps until one is proven. */
#pragma once

#include "runtime/detector/detector.h"

/* A straight motion from x0 towards x1. */
typedef struct straight_motion {
    uint32_t vertex_count;
    const double *x0, *x1;
} straight_motion;

/* Writes x0 + length (x1 - x0), rounded; at 0 and 1 exactly x0 and x1. A coordinate that is nearer to 0 than positions may
 * be becomes 0. */
void motion_at(const straight_motion *m, double length, double *out);

/* Finds contacts between two moments of the motion, the first contact among them. */
typedef cscd_status motion_test(void *of, const double *from, const double *to, cscd_contacts *out);

/* Finds the longest of the steps tried, at most `longest`, whose end is reached without contact, and writes that end to
 * `reached`. IN_CONTACT: no step is free of contact. */
cscd_status free_step_find(cscd_detector *d, const straight_motion *m, double longest, motion_test *test,
                           void *of, double *reached, cscd_free_step *out);
