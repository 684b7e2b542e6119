/* How far vertices may go on straight lines without contact: shorter and shorter steps, until one is proven.
 */
#pragma once

#include "runtime/detector/detector.h"

/* From x0 towards x1. */
typedef struct motion {
    uint32_t vertex_count;
    const double *x0, *x1;
} motion;

/* x0 + length (x1 - x0), rounded; x0 and x1 themselves at 0 and 1. What is nearer to 0 than positions may be
 * becomes 0. */
void motion_at(const motion *m, double length, double *out);

/* Finds contacts of the vertices' motion between two moments on it, the first one among them. */
typedef cscd_status motion_test(void *of, const double *from, const double *to, cscd_contacts *out);

/* The longest step of those tried, at most `longest`, whose end, in `reached`, is found to be reached without
 * contact. IN_CONTACT: none is. */
cscd_status free_step_find(cscd_detector *d, const motion *m, double longest, motion_test *test, void *of,
                           double *reached, cscd_free_step *out);
