/* Solves linear equations whose matrix is only a function: restarted GMRES with a preconditioner on the right (Saad, Schultz 1986). */
#pragma once

#include "src/core/context.h"

typedef struct linear_equations {
    cscd_context *context;
    uint32_t count;
    void *data;
    cscd_status (*multiply)(void *data, const double *in, double *out);
    void (*precondition)(void *data, const double *in, double *out); /* about the inverse of multiply */
    void (*tell)(void *data, double share); /* how far the solution has come, after each iteration */
} linear_equations;

typedef struct gmres_result {
    uint32_t iterations;
    double residual; /* over that of 0, in the Euclidean norm */
} gmres_result;

/* The bytes that so many equations take besides what the caller holds. */
double gmres_bytes(uint32_t count);

/* Begins at 0, and ends when the residual is at most the tolerance, or after iterations_most: the result says which. The same
 * bits for any number of threads. */
cscd_status gmres_solve(const linear_equations *equations, const double *right, double tolerance,
                        uint32_t iterations_most, double *solution, gmres_result *result);
