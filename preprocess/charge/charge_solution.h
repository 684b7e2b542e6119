/* Another way to solve the equations of a component than by the tree: what a solver to compare with offers. */
#pragma once

#include "preprocess/charge/charge_system.h"

typedef struct charge_solution {
    const void *functions; /* of the solver, for all of these */
    size_t (*memory)(const void *functions,
                     uint32_t count); /* bytes for so many unknowns; SIZE_MAX: too many */
    /* Writes system->charges, and adds to the timings. A failure has its sentence. solve NULL: there is no other way. */
    cscd_status (*solve)(const void *functions, cscd_context *context, const charge_system *system,
                         charge_timings *timings);
    charge_kernels (*kernels)(const void *functions);
    double (*work)(double count); /* for so many unknowns, by estimate: ns on one thread */
} charge_solution;
