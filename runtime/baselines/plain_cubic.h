/* Roots of cubics as GSL finds them, in plain floating point, for what is compared with the published elementary test. They are in
 * libcscd-baselines, which is asked for them by this name and number (src/core/baseline_library.h). */
#pragma once

#define PLAIN_CUBIC_ENTRY     "cscd_baseline_plain_cubic"
#define PLAIN_CUBIC_INTERFACE 1u

typedef struct plain_cubic_functions {
    /* Writes the real roots of x^3 + a x^2 + b x + c in ascending order, a multiple one as often as it is one, and returns how many:
     * 1 or 3. */
    int (*cubic)(double a, double b, double c, double *x0, double *x1, double *x2);
    /* The same for a x^2 + b x + c, where a may be 0: up to 2. */
    int (*quadratic)(double a, double b, double c, double *x0, double *x1);
} plain_cubic_functions;
