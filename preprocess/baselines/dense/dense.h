/* The dense solution, which is in libcscd-baselines because it needs LAPACK. libcscd asks for it by this name and number
 * (src/core/baseline_library.h), and knows nothing of it but what stands here, and charge_system: DENSE_INTERFACE counts the changes of
 * both files. */
#pragma once

#include "preprocess/charge/charge.h"

#define DENSE_ENTRY     "cscd_baseline_dense"
#define DENSE_INTERFACE 4u

/* The functions of the caller that the library uses, each with `context`. run, stage and go_on are
 * parallel_run and the functions of progress.h, and progress is context_progress_status. */
typedef struct dense_host {
    void *context;
    void *(*allocate)(void *context, size_t size); /* aligned to a cache line; NULL: there is none */
    void (*release)(void *context, void *block);
    void (*run)(void *context, uint32_t task_count, void (*task)(void *data, uint32_t task), void *data);
    void (*stage)(void *context, const char *name, double begin, double end);
    bool (*go_on)(void *context, double share); /* from any thread, as run's tasks */
    cscd_status (*progress)(void *context);
    void (*explain)(void *context, cscd_status status, const char *sentence); /* of a failure */
    uint32_t threads; /* the largest number of tasks that run at a time */
} dense_host;

typedef struct dense_functions {
    /* The bytes that a solution takes; SIZE_MAX: too many. */
    size_t (*memory)(uint32_t count);
    /* Writes system->charges, and adds to timings. CANCELLED: nothing is solved. INVALID_ARGUMENT: charges cannot be told apart. */
    cscd_status (*solve)(const dense_host *host, const charge_system *system, charge_timings *timings);
    charge_kernels (*kernels)(void);
} dense_functions;

/* Returns the functions of an interface, or NULL for one that this library does not know. */
const dense_functions *dense_functions_of(uint32_t interface);

/* ---- within libcscd-baselines -------------------------------------------------------------------------- */

/* Dense linear systems in double precision: LU with partial pivoting, by LAPACK and BLAS on the host's
 * threads. */

/* matrix: count x count, column after column, replaced by its factors, whose diagonal is 0 where a column depends on those before it;
 * pivots: count. CANCELLED, OUT_OF_MEMORY: they mean nothing. OUT_OF_MEMORY: the address space has no room for the buffers of the BLAS.
 * The bits of the factors depend on neither the number of threads nor who runs them. */
cscd_status dense_factor(const dense_host *host, double *matrix, uint32_t count, int32_t *pivots);

/* vector is replaced by the solution. No number on the diagonal of the factors is 0. */
void dense_substitute(const double *factors, uint32_t count, const int32_t *pivots, double *vector);
