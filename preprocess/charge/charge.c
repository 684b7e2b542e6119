/* The charge density of a conductor in the shape of the mesh: collocation at triangle centroids. */
#include "preprocess/charge/available_memory.h"
#include "preprocess/charge/charge_system.h"
#include "src/blas/blas_choice.h"
#include "src/core/timer.h"

#include <string.h>

/* Workspace of one call, in one block of memory. */
typedef struct workspace {
    uint32_t *triangles; /* sorted by component */
    uint32_t *offsets;   /* component c has triangles[offsets[c] .. offsets[c + 1]) */
    double *density, *capacitance;
    charge_system system;
} workspace;

/* The charge's share of cscd_plan_create, by estimate; the regions take the rest. */
static const double part_of_call = 0.95;

static uint32_t charged_triangles(const charge_problem *problem, uint32_t component) {
    return problem->charged_triangles(problem->mesh, component);
}

static uint32_t largest_component(const charge_problem *problem) {
    uint32_t largest = 0;
    for (uint32_t c = 0; c < problem->component_count; c++) {
        uint32_t count = charged_triangles(problem, c);
        largest = count > largest ? count : largest;
    }
    return largest;
}

/* Points the arrays into memory and returns their size; with memory NULL it only counts. SIZE_MAX: too
 * many. */
static size_t lay_out(workspace *work, const charge_problem *problem, char *memory) {
    size_t t = problem->triangle_count, c = problem->component_count;
    size_t lists_size = t * (sizeof *work->density + sizeof *work->triangles) +
                        c * sizeof *work->capacitance + (c + 1) * sizeof *work->offsets;
    lists_size = (lists_size + CHARGE_ALIGNMENT - 1) / CHARGE_ALIGNMENT * CHARGE_ALIGNMENT;
    char *after = memory != NULL ? memory + lists_size : NULL;
    size_t system_size = charge_system_lay_out(&work->system, largest_component(problem), after);
    if (memory != NULL) {
        work->density = (double *)(void *)memory;
        work->capacitance = work->density + t;
        work->triangles = (uint32_t *)(work->capacitance + c);
        work->offsets = work->triangles + t;
    }
    return system_size < SIZE_MAX - lists_size ? lists_size + system_size : SIZE_MAX;
}

static size_t memory_needed(const charge_problem *problem) {
    workspace work;
    return lay_out(&work, problem, NULL);
}

static void sort_by_component(workspace *work, const charge_problem *problem) {
    memset(work->offsets, 0, (problem->component_count + 1) * sizeof *work->offsets);
    for (uint32_t t = 0; t < problem->triangle_count; t++)
        work->offsets[problem->triangle_components[t] + 1]++;
    for (uint32_t c = 0; c < problem->component_count; c++) work->offsets[c + 1] += work->offsets[c];
    for (uint32_t t = 0; t < problem->triangle_count; t++)
        work->triangles[work->offsets[problem->triangle_components[t]]++] = t;
    for (uint32_t c = problem->component_count; c > 0; c--) work->offsets[c] = work->offsets[c - 1];
    work->offsets[0] = 0;
}

/* Turns the charges of unknowns into densities of triangles, in the caller's lengths. */
static void store_component(workspace *work) {
    const charge_system *system = &work->system;
    double capacitance = 0.0;
    for (uint32_t begin = 0, end; begin < system->point_count; begin = end) {
        uint32_t k = system->points[begin].unknown;
        for (end = begin; end < system->point_count && system->points[end].unknown == k; end++) continue;
        double density = system->charges[k] / (system->sources[k].area * (double)(end - begin));
        for (uint32_t i = begin; i < end; i++)
            work->density[system->points[i].triangle] = density * system->scale;
        capacitance += system->charges[k];
    }
    work->capacitance[system->component] = capacitance / system->scale;
}

static cscd_status solve_component(workspace *work, const charge_problem *problem, uint32_t component,
                                   charge_timings *timings) {
    uint32_t begin = work->offsets[component], count = work->offsets[component + 1] - begin;
    cscd_status status =
        charge_system_collect(&work->system, problem, component, work->triangles + begin, count);
    if (status == CSCD_OK) status = charge_system_solve(&work->system, timings);
    if (status == CSCD_OK) store_component(work);
    return status;
}

static cscd_status solve_components(workspace *work, const charge_problem *problem, charge_timings *timings) {
    const charge_host *host = &problem->host;
    cscd_status status = CSCD_OK;
    double whole = 0.0, done = 0.0;
    for (uint32_t c = 0; c < problem->component_count; c++)
        whole += charge_system_work(charged_triangles(problem, c));
    for (uint32_t c = 0; c < problem->component_count && status == CSCD_OK; c++) {
        if (charged_triangles(problem, c) == 0) continue;
        double begin = part_of_call * done / whole;
        done += charge_system_work(charged_triangles(problem, c));
        host->part(host->context, begin, part_of_call * done / whole);
        status = solve_component(work, problem, c, timings);
    }
    host->part(host->context, part_of_call, 1.0);
    return status;
}

static cscd_status check_memory(const charge_problem *problem, size_t needed) {
    const double gibibyte = 0x1p30;
    if (needed <= problem->memory_limit) return CSCD_OK;
    return charge_fail(problem, CSCD_OUT_OF_MEMORY,
                       "charge: a component of %u triangles takes %.4g GiB of memory, and %.4g GiB are "
                       "available; simplify the mesh or use a machine with more memory",
                       largest_component(problem), (double)needed / gibibyte,
                       (double)problem->memory_limit / gibibyte);
}

static cscd_status solve_problem(const charge_problem *problem, double *density, double *capacitance,
                                 charge_timings *timings) {
    const charge_host *host = &problem->host;
    double start = timer_now_ms();
    size_t needed = memory_needed(problem);
    cscd_status status = check_memory(problem, needed);
    if (status != CSCD_OK) return status;

    workspace work;
    charge_timings spent = {0.0, 0.0, 0.0, 0.0};
    char *memory = host->allocate(host->context, needed);
    if (memory == NULL) return CSCD_OUT_OF_MEMORY;
    lay_out(&work, problem, memory);
    sort_by_component(&work, problem);
    status = solve_components(&work, problem, &spent);
    if (status == CSCD_OK) {
        memcpy(density, work.density, problem->triangle_count * sizeof *density);
        memcpy(capacitance, work.capacitance, problem->component_count * sizeof *capacitance);
        spent.total_ms = timer_now_ms() - start;
        *timings = spent;
    }
    host->release(host->context, memory);
    return status;
}

static charge_kernels kernels_here(void) {
    return (charge_kernels){blas_choice_name(), blas_choice_better()};
}

const charge_functions *charge_functions_of(uint32_t interface) {
    static const charge_functions functions = {memory_needed, available_memory, solve_problem, kernels_here};
    return interface == CHARGE_INTERFACE ? &functions : NULL;
}
