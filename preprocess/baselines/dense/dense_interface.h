/* The dense solution, which is in libcscd-baselines because it needs LAPACK. libcscd asks for it by this name and number
 * (src/core/baseline_library.h), and knows nothing of it but what stands here, and charge_system: DENSE_INTERFACE counts the changes of
 * both files. */
#pragma once

#include "preprocess/charge/charge_system.h"

#define DENSE_ENTRY     "cscd_baseline_dense"
#define DENSE_INTERFACE 4u

/* What the library asks of its caller, each with `context`. run, stage and go_on are parallel_run and the functions of progress.h, and
 * progress is context_progress_status. */
typedef struct dense_host {
    void *context;
    void *(*allocate)(void *context, size_t size); /* aligned to a cache line; NULL: there is none */
    void (*release)(void *context, void *block);
    void (*run)(void *context, uint32_t task_count, void (*task)(void *data, uint32_t task), void *data);
    void (*stage)(void *context, const char *name, double begin, double end);
    bool (*go_on)(void *context, double share); /* from any thread, as run's tasks */
    cscd_status (*progress)(void *context);
    void (*explain)(void *context, cscd_status status, const char *sentence); /* of a failure */
    uint32_t threads; /* so many tasks run at a time, at most */
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
