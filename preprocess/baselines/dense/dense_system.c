/* The dense solution for the charges of one component, in double precision: matrix and factors. */
#include "preprocess/baselines/dense/dense.h"

#include "preprocess/baselines/dense/blas_choice.h"
#include "src/core/timer.h"

#include <math.h>
#include <stdio.h>

enum { COLUMNS_PER_TASK = 8 };

/* A pivot is the part of a triangle's potential that the triangles before it do not make up. If that is a
 * smaller share of the potential, rounding leaves fewer than ten digits of the charge. */
static const double LEAST_PIVOT = 1e-6;

typedef struct dense_system {
    const dense_host *host;
    const charge_system *equations;
    uint32_t count;
    int32_t *pivots;
    double *matrix; /* count x count by columns: potential at point j of charge 1 on source k */
} dense_system;

/* Points the arrays into memory and returns their size, as charge_system_lay_out. */
static size_t lay_out(dense_system *system, uint32_t count, char *memory) {
    size_t n = count, used = 0;
    system->pivots = charge_take_array(memory, &used, n, sizeof *system->pivots);
    system->matrix = charge_take_array(memory, &used, n * n, sizeof *system->matrix);
    return used;
}

static size_t dense_memory(uint32_t count) {
    dense_system system;
    return lay_out(&system, count, NULL);
}

/* Column k has the potentials of a charge of 1 on source k at all points, eq. 3.6 over the area. */
static void assemble_columns(void *data, uint32_t task) {
    dense_system *system = data;
    const charge_system *equations = system->equations;
    uint32_t n = system->count, first = task * COLUMNS_PER_TASK;
    if (!system->host->go_on(system->host->context, (double)first / n)) return;
    for (uint32_t k = first; k < n && k < first + COLUMNS_PER_TASK; k++) {
        double *column = system->matrix + (size_t)k * n, inverse_area = 1.0 / equations->sources[k].area;
        potential_at(&equations->sources[k], equations->x, equations->y, equations->z, n, column);
        for (uint32_t i = 0; i < n; i++) column[i] *= inverse_area;
    }
}

/* Finds the unknown whose pivot is the smallest share of its diagonal entry, which was about the potential of a disc of its area.
 * Returns the share. */
static double least_pivot(const dense_system *system, uint32_t *out) {
    double smallest = INFINITY;
    for (uint32_t k = 0; k < system->count; k++) {
        double pivot = fabs(system->matrix[(size_t)k * system->count + k]);
        double ratio = pivot * sqrt(system->equations->sources[k].area);
        if (ratio >= smallest) continue;
        smallest = ratio;
        *out = k;
    }
    return smallest;
}

static cscd_status fail_singular(const dense_system *system, uint32_t worst) {
    char sentence[512];
    uint32_t i = 0;
    while (system->equations->points[i].unknown != worst) i++;
    snprintf(
        sentence, sizeof sentence,
        "charge: the charges of component %u cannot be told apart in its %u equations, least of all that of triangle %u: some "
        "triangles there lie (almost) on each other or on one line; move or remove them",
        system->equations->component, system->count, system->equations->points[i].triangle);
    system->host->explain(system->host->context, CSCD_INVALID_ARGUMENT, sentence);
    return CSCD_INVALID_ARGUMENT;
}

/* Work is estimated in ns on one thread: an entry takes some 10, and a multiplication of the factors a fiftieth of a ns. */
static void enter_stage(const dense_system *system, const char *name, bool factors) {
    const dense_host *host = system->host;
    double n = system->count, matrix = 10.0 * n * n, share = matrix / (matrix + n * n * n / 150.0);
    host->stage(host->context, name, factors ? share : 0.0, factors ? 1.0 : share);
}

static cscd_status assemble_matrix(dense_system *system) {
    const dense_host *host = system->host;
    uint32_t tasks = system->count / COLUMNS_PER_TASK + (system->count % COLUMNS_PER_TASK != 0);
    enter_stage(system, "charge: matrix", false);
    host->run(host->context, tasks, assemble_columns, system);
    return host->progress(host->context);
}

static cscd_status solve_equations(dense_system *system) {
    uint32_t n = system->count, worst = 0;
    enter_stage(system, "charge: factors", true);
    cscd_status status = dense_factor(system->host, system->matrix, n, system->pivots);
    if (status != CSCD_OK) return status;
    if (!(least_pivot(system, &worst) >= LEAST_PIVOT)) return fail_singular(system, worst);
    for (uint32_t k = 0; k < n; k++) system->equations->charges[k] = 1.0;
    dense_substitute(system->matrix, n, system->pivots, system->equations->charges);
    return CSCD_OK;
}

static cscd_status solve_system(dense_system *system, charge_timings *timings) {
    double clock = timer_now_ms();
    cscd_status status = assemble_matrix(system);
    timer_lap(&clock, &timings->assembly_ms);
    if (status == CSCD_OK) status = solve_equations(system);
    timer_lap(&clock, &timings->factor_ms);
    return status;
}

static cscd_status dense_solve(const dense_host *host, const charge_system *equations,
                               charge_timings *timings) {
    dense_system system = {.host = host, .equations = equations, .count = equations->count};
    if (system.count == 0) return CSCD_OK;
    char *memory = host->allocate(host->context, dense_memory(system.count));
    if (memory == NULL) return CSCD_OUT_OF_MEMORY;
    lay_out(&system, system.count, memory);
    const cscd_status status = solve_system(&system, timings);
    host->release(host->context, memory);
    return status;
}

static charge_kernels kernels_here(void) {
    return (charge_kernels){blas_choice_name(), blas_choice_better()};
}

const dense_functions *dense_functions_of(uint32_t interface) {
    static const dense_functions functions = {dense_memory, dense_solve, kernels_here};
    return interface == DENSE_INTERFACE ? &functions : NULL;
}
