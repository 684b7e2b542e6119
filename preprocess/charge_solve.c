/* The system of equations for the charges of one component: matrix, factors, refinement. */
#include "preprocess/charge_system.h"
#include "preprocess/dense_solve.h"
#include "src/timer.h"

#include <float.h>
#include <math.h>

enum { COLUMNS_PER_TASK = 8, POINTS_PER_BLOCK = 256, CORRECTIONS_MAX = 20 };

/* Of the largest density: what may be missing in the end. */
static const double TOLERANCE = 1e-10;

static uint32_t tasks_of(uint32_t count, uint32_t per_task) {
    return count / per_task + (count % per_task != 0);
}

static uint32_t block_size(const charge_system *system, uint32_t begin) {
    return system->count - begin < POINTS_PER_BLOCK ? system->count - begin : POINTS_PER_BLOCK;
}

/* Potentials at points begin.. of a charge of 1 on source k, eq. 3.6 over the area. */
static void potentials_of_source(const charge_system *system, uint32_t k, uint32_t begin, uint32_t size,
                                 double *potentials) {
    const potential_source *source = &system->sources[k];
    potential_at(source, system->x + begin, system->y + begin, system->z + begin, size, potentials);
    double inverse_area = 1.0 / source->area;
    for (uint32_t i = 0; i < size; i++) potentials[i] *= inverse_area;
}

static void assemble_columns(void *data, uint32_t task) {
    charge_system *system = data;
    uint32_t n = system->count, first = task * COLUMNS_PER_TASK;
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

/* residual = 1 - (potential of charges) at one block of points, with entries in double precision, computed
 * anew. */
static void evaluate_residual(void *data, uint32_t task) {
    charge_system *system = data;
    uint32_t begin = task * POINTS_PER_BLOCK, size = block_size(system, begin);
    double sums[POINTS_PER_BLOCK] = {0.0}, potentials[POINTS_PER_BLOCK];
    for (uint32_t k = 0; k < system->count; k++) {
        potentials_of_source(system, k, begin, size, potentials);
        for (uint32_t i = 0; i < size; i++) sums[i] += potentials[i] * system->charges[k];
    }
    for (uint32_t i = 0; i < size; i++) system->residual[begin + i] = 1.0 - sums[i];
}

/* Solves for the residual and adds the solution to the charges. Returns the largest correction of a density
 * over the largest density. */
static double apply_correction(charge_system *system, uint32_t thread_count) {
    uint32_t n = system->count;
    for (uint32_t k = 0; k < n; k++) system->correction[k] = (float)system->residual[k];
    dense_substitute(system->matrix, n, system->pivots, system->correction, thread_count);
    double change = 0.0, largest = DBL_MIN;
    for (uint32_t k = 0; k < n; k++) {
        double correction = (double)system->correction[k], area = system->sources[k].area;
        system->charges[k] += correction;
        change = fmax(change, fabs(correction) / area);
        largest = fmax(largest, fabs(system->charges[k]) / area);
        if (!isfinite(correction)) return INFINITY;
    }
    return change / largest;
}

/* The triangle whose pivot is the smallest against what was its diagonal, the potential of a disc of its
 * area. */
static uint32_t most_dependent_triangle(const charge_system *system) {
    uint32_t worst = 0;
    double smallest = INFINITY;
    for (uint32_t k = 0; k < system->count; k++) {
        double pivot = fabs((double)system->matrix[(size_t)k * system->count + k]);
        double ratio = pivot * sqrt(system->sources[k].area);
        if (ratio >= smallest) continue;
        smallest = ratio;
        worst = k;
    }
    uint32_t i = 0;
    while (system->points[i].unknown != worst) i++;
    return system->points[i].triangle;
}

static cscd_status fail_singular(const charge_system *system, cscd_context *context) {
    return context_fail(
        context, CSCD_INVALID_ARGUMENT,
        "charge: the charges of component %u cannot be told apart in its %u equations, least of "
        "all that of triangle %u: some triangles there lie (almost) on each other or on one "
        "line; move or remove them",
        system->component, system->count, most_dependent_triangle(system));
}

/* Iterative refinement. Each step shrinks the error by about condition number * 2^-24, so from two steps the
 * next one is known: change * (change / change before). */
static cscd_status refine(charge_system *system, cscd_context *context) {
    uint32_t thread_count = parallel_thread_count(context->threads);
    double before = 1.0;
    for (uint32_t k = 0; k < system->count; k++) {
        system->charges[k] = 0.0;
        system->residual[k] = 1.0;
    }
    apply_correction(system, thread_count);
    for (int i = 0; i < CORRECTIONS_MAX; i++) {
        parallel_run(context->threads, tasks_of(system->count, POINTS_PER_BLOCK), evaluate_residual, system);
        double change = apply_correction(system, thread_count);
        double rate = change / before;
        if (!(rate < 0.5)) break;
        if (change * rate < TOLERANCE) return CSCD_OK;
        before = change;
    }
    return fail_singular(system, context);
}

cscd_status charge_system_solve(charge_system *system, cscd_context *context, charge_timings *timings) {
    if (system->count == 0) return CSCD_OK;
    double clock = timer_now_ms();
    parallel_run(context->threads, tasks_of(system->count, COLUMNS_PER_TASK), assemble_columns, system);
    timer_lap(&clock, &timings->assembly_ms);
    uint32_t zero_pivot =
        dense_factor(system->matrix, system->count, system->pivots, parallel_thread_count(context->threads));
    timer_lap(&clock, &timings->factor_ms);
    if (zero_pivot != 0) return fail_singular(system, context);
    cscd_status status = refine(system, context);
    timer_lap(&clock, &timings->refine_ms);
    return status;
}
