/* What libcscd and libcscd-charge know of each other: one function, which is looked up by its name, and what it
 * returns. They may come from different builds, so nothing else is shared, and CHARGE_INTERFACE counts the changes of
 * this file. */
#pragma once

#include "cscd/cscd.h"

#define CHARGE_INTERFACE 3u

/* What the charge library asks of its caller, each with `context`. run, part, stage and go_on are parallel_run and the
 * functions of progress.h, and progress is context_progress_status. */
typedef struct charge_host {
    void *context;
    void *(*allocate)(void *context, size_t size); /* aligned to a cache line; NULL: there is none */
    void (*release)(void *context, void *block);
    void (*run)(void *context, uint32_t task_count, void (*task)(void *data, uint32_t task), void *data);
    void (*part)(void *context, double begin, double end);
    void (*stage)(void *context, const char *name, double begin, double end);
    bool (*go_on)(void *context, double share); /* from any thread, as run's tasks */
    cscd_status (*progress)(void *context);
    void (*explain)(void *context, cscd_status status, const char *sentence); /* of a failure */
    uint32_t threads; /* so many tasks run at a time, at most */
} charge_host;

/* Triangles of all components, of which those are charged that `charged_triangles` gives a count for: all triangles of
 * a component, or none. */
typedef struct charge_problem {
    charge_host host;
    const uint32_t (*triangles)[3];
    const uint32_t *triangle_components;
    const double *positions; /* three per vertex, checked */
    uint32_t triangle_count, component_count;
    const void *mesh;
    uint32_t (*charged_triangles)(const void *mesh, uint32_t component);
    size_t memory_limit; /* in bytes */
} charge_problem;

typedef struct charge_timings { /* sums over the components */
    double assembly_ms, factor_ms, refine_ms;
    double total_ms; /* with all checks and the sorting */
} charge_timings;

/* Names of kernels of OpenBLAS, in static storage; see src/blas/blas_choice.h. */
typedef struct charge_kernels {
    const char *used, *better; /* NULL: unknown; used will do */
} charge_kernels;

/* The functions behind those of preprocess/charge_call.h, which says what they do. */
typedef struct charge_functions {
    size_t (*memory)(const charge_problem *problem);
    size_t (*available_memory)(void);
    cscd_status (*solve)(const charge_problem *problem, double *density, double *capacitance,
                         charge_timings *timings);
    charge_kernels (*kernels)(void);
} charge_functions;

/* Returns the functions of an interface, or NULL for one that this library does not know. */
typedef const charge_functions *charge_entry(uint32_t interface);

/* The name under which libcscd-charge exports it. */
#define CHARGE_ENTRY_NAME "cscd_charge_functions"

/* The same function inside; a program that links the library statically calls it at once. */
charge_entry charge_functions_of;
