/* The dense solution for the charges of one component: matrix, factors, refinement. */
#include "preprocess/baselines/dense/dense_interface.h"
#include "preprocess/baselines/dense/dense_solve.h"
#include "src/blas/blas_choice.h"
#include "src/core/timer.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

enum { COLUMNS_PER_TASK = 8, POINTS_PER_BLOCK = 256, CORRECTIONS_MAX = 20 };

/* The largest error of a density, as a share of the largest density. */
static const double TOLERANCE = 1e-10;

typedef struct dense_system {
    const dense_host *host;
    const charge_system *equations;
    uint32_t count;
    double *residual;
    float *correction;
    int32_t *pivots;
    float *matrix; /* count x count by columns: potential at point j of charge 1 on source k */
} dense_system;

/* Points the arrays into memory and returns their size, as charge_system_lay_out. */
static size_t lay_out(dense_system *system, uint32_t count, char *memory) {
    size_t n = count, used = 0;
    system->residual = charge_take_array(memory, &used, n, sizeof *system->residual);
    system->correction = charge_take_array(memory, &used, n, sizeof *system->correction);
    system->pivots = charge_take_array(memory, &used, n, sizeof *system->pivots);
    system->matrix = charge_take_array(memory, &used, n * n, sizeof *system->matrix);
    return used;
}

static size_t dense_memory(uint32_t count) {
    dense_system system;
    return lay_out(&system, count, NULL);
}

static uint32_t tasks_of(uint32_t count, uint32_t per_task) {
    return count / per_task + (count % per_task != 0);
}

static uint32_t block_size(const dense_system *system, uint32_t begin) {
    return system->count - begin < POINTS_PER_BLOCK ? system->count - begin : POINTS_PER_BLOCK;
}

/* Potentials at points begin.. of a charge of 1 on source k, eq. 3.6 over the area. */
static void potentials_of_source(const dense_system *system, uint32_t k, uint32_t begin, uint32_t size,
                                 double *potentials) {
    const potential_source *source = &system->equations->sources[k];
    potential_at(source, system->equations->x + begin, system->equations->y + begin,
                 system->equations->z + begin, size, potentials);
    double inverse_area = 1.0 / source->area;
    for (uint32_t i = 0; i < size; i++) potentials[i] *= inverse_area;
}

static void assemble_columns(void *data, uint32_t task) {
    dense_system *system = data;
    const dense_host *host = system->host;
    uint32_t n = system->count, first = task * COLUMNS_PER_TASK;
    if (!host->go_on(host->context, (double)first / n)) return;
    for (uint32_t k = first; k < n && k < first + COLUMNS_PER_TASK; k++) {
        float *column = system->matrix + (size_t)k * n;
        for (uint32_t begin = 0; begin < n; begin += POINTS_PER_BLOCK) {
            double potentials[POINTS_PER_BLOCK];
            uint32_t size = block_size(system, begin);
            potentials_of_source(system, k, begin, size, potentials);
            for (uint32_t i = 0; i < size; i++) column[begin + i] = (float)potentials[i];
        }
    }
}

/* residual = 1 - (potential of charges) at one block of points, with entries computed again in double
 * precision. */
static void evaluate_residual(void *data, uint32_t task) {
    dense_system *system = data;
    const dense_host *host = system->host;
    uint32_t begin = task * POINTS_PER_BLOCK, size = block_size(system, begin);
    if (!host->go_on(host->context, (double)begin / system->count)) return;
    double sums[POINTS_PER_BLOCK] = {0.0}, potentials[POINTS_PER_BLOCK];
    for (uint32_t k = 0; k < system->count; k++) {
        potentials_of_source(system, k, begin, size, potentials);
        for (uint32_t i = 0; i < size; i++) sums[i] += potentials[i] * system->equations->charges[k];
    }
    for (uint32_t i = 0; i < size; i++) system->residual[begin + i] = 1.0 - sums[i];
}

/* Solves for the residual and adds the solution to the charges. Returns the largest correction of a density
 * over the largest density. */
static double apply_correction(dense_system *system) {
    uint32_t n = system->count;
    for (uint32_t k = 0; k < n; k++) system->correction[k] = (float)system->residual[k];
    dense_substitute(system->matrix, n, system->pivots, system->correction);
    double change = 0.0, largest = DBL_MIN;
    for (uint32_t k = 0; k < n; k++) {
        double correction = (double)system->correction[k], area = system->equations->sources[k].area;
        system->equations->charges[k] += correction;
        change = fmax(change, fabs(correction) / area);
        largest = fmax(largest, fabs(system->equations->charges[k]) / area);
        if (!isfinite(correction)) return INFINITY;
    }
    return change / largest;
}

/* Returns the triangle whose pivot is the smallest share of its diagonal entry, which was about the potential
 * of a disc of its area. */
static uint32_t most_dependent_triangle(const dense_system *system) {
    uint32_t worst = 0;
    double smallest = INFINITY;
    for (uint32_t k = 0; k < system->count; k++) {
        double pivot = fabs((double)system->matrix[(size_t)k * system->count + k]);
        double ratio = pivot * sqrt(system->equations->sources[k].area);
        if (ratio >= smallest) continue;
        smallest = ratio;
        worst = k;
    }
    uint32_t i = 0;
    while (system->equations->points[i].unknown != worst) i++;
    return system->equations->points[i].triangle;
}

static cscd_status fail_singular(const dense_system *system) {
    char sentence[512];
    snprintf(
        sentence, sizeof sentence,
        "charge: the charges of component %u cannot be told apart in its %u equations, least of all that of triangle %u: some "
        "triangles there lie (almost) on each other or on one line; move or remove them",
        system->equations->component, system->count, most_dependent_triangle(system));
    system->host->explain(system->host->context, CSCD_INVALID_ARGUMENT, sentence);
    return CSCD_INVALID_ARGUMENT;
}

/* Work is estimated in ns on one thread: an entry takes some 10, in the matrix and in three residuals, and a
 * multiplication of the factors a hundredth of that. */
static double entries_work(double n) {
    return 10.0 * n * n;
}

static double factors_work(double n) {
    return n * n * n / 300.0;
}

static double work_of(uint32_t count) {
    return 4.0 * entries_work(count) + factors_work(count);
}

/* Begin and end are parts of the work. */
static void enter_stage(const dense_system *system, const char *name, double begin, double end) {
    const dense_host *host = system->host;
    double work = work_of(system->count);
    host->stage(host->context, name, begin / work, end / work);
}

static cscd_status assemble_matrix(dense_system *system) {
    const dense_host *host = system->host;
    enter_stage(system, "charge: matrix", 0.0, entries_work(system->count));
    host->run(host->context, tasks_of(system->count, COLUMNS_PER_TASK), assemble_columns, system);
    return host->progress(host->context);
}

static cscd_status factor_matrix(dense_system *system, uint32_t *zero_pivot) {
    double begin = entries_work(system->count);
    enter_stage(system, "charge: factors", begin, begin + factors_work(system->count));
    return dense_factor(system->host, system->matrix, system->count, system->pivots, zero_pivot);
}

/* Iterative refinement. Each step shrinks the error by about condition number * 2^-24, so from two steps the
 * next one is known: change * (change / change before). */
static cscd_status refine_charges(dense_system *system) {
    const dense_host *host = system->host;
    double before = 1.0, work = work_of(system->count);
    for (uint32_t k = 0; k < system->count; k++) {
        system->equations->charges[k] = 0.0;
        system->residual[k] = 1.0;
    }
    apply_correction(system);
    for (int i = 0; i < CORRECTIONS_MAX; i++) {
        double left = 3.0 - i > 1.0 ? 3.0 - i : 1.0; /* mostly it takes three */
        enter_stage(system, "charge: refinement", work - left * entries_work(system->count),
                    work - (left - 1.0) * entries_work(system->count));
        host->run(host->context, tasks_of(system->count, POINTS_PER_BLOCK), evaluate_residual, system);
        cscd_status status = host->progress(host->context);
        if (status != CSCD_OK) return status;
        double change = apply_correction(system);
        double rate = change / before;
        if (!(rate < 0.5)) break;
        if (change * rate < TOLERANCE) return CSCD_OK;
        before = change;
    }
    return fail_singular(system);
}

static cscd_status solve_system(dense_system *system, charge_timings *timings) {
    uint32_t zero_pivot = 0;
    double clock = timer_now_ms();
    cscd_status status = assemble_matrix(system);
    timer_lap(&clock, &timings->assembly_ms);
    if (status == CSCD_OK) status = factor_matrix(system, &zero_pivot);
    timer_lap(&clock, &timings->factor_ms);
    if (status == CSCD_OK) status = zero_pivot == 0 ? refine_charges(system) : fail_singular(system);
    timer_lap(&clock, &timings->refine_ms);
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
