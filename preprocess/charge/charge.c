/* The charge density of a conductor in the shape of the mesh: collocation at triangle centroids. */
#include "preprocess/charge/charge.h"

#include "preprocess/charge/available_memory.h"
#include "preprocess/charge/charge_system.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"

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

/* The number of triangles of a component that are charged. Obstacles are not charged, since they are not
 * cut. */
static uint32_t charged_triangles(const cscd_mesh *mesh, uint32_t component) {
    return component_is_obstacle(mesh, component) ? 0 : mesh->components[component].triangle_count;
}

static uint32_t largest_component(const cscd_mesh *mesh) {
    uint32_t largest = 0;
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        uint32_t count = charged_triangles(mesh, c);
        largest = count > largest ? count : largest;
    }
    return largest;
}

/* Points the arrays into memory and returns their size; with memory NULL it only counts. SIZE_MAX: too
 * many. */
static size_t lay_out(workspace *work, const cscd_mesh *mesh, char *memory) {
    size_t t = mesh->triangle_count, c = mesh->component_count;
    size_t lists_size = t * (sizeof *work->density + sizeof *work->triangles) +
                        c * sizeof *work->capacitance + (c + 1) * sizeof *work->offsets;
    lists_size = (lists_size + CACHE_LINE_SIZE - 1) / CACHE_LINE_SIZE * CACHE_LINE_SIZE;
    char *after = memory != NULL ? memory + lists_size : NULL;
    size_t system_size = charge_system_lay_out(&work->system, largest_component(mesh), after);
    if (memory != NULL) {
        work->density = (double *)(void *)memory;
        work->capacitance = work->density + t;
        work->triangles = (uint32_t *)(work->capacitance + c);
        work->offsets = work->triangles + t;
    }
    return system_size < SIZE_MAX - lists_size ? lists_size + system_size : SIZE_MAX;
}

size_t charge_memory(const cscd_mesh *mesh) {
    workspace work;
    return lay_out(&work, mesh, NULL);
}

static void sort_by_component(workspace *work, const cscd_mesh *mesh) {
    for (uint32_t c = 0; c < mesh->component_count; c++)
        work->offsets[c + 1] = work->offsets[c] + mesh->components[c].triangle_count;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        work->triangles[work->offsets[mesh->triangle_components[t]]++] = t;
    for (uint32_t c = mesh->component_count; c > 0; c--) work->offsets[c] = work->offsets[c - 1];
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

static cscd_status solve_component(workspace *work, const cscd_mesh *mesh, const double *positions,
                                   uint32_t component, charge_timings *timings) {
    uint32_t begin = work->offsets[component], count = work->offsets[component + 1] - begin;
    cscd_status status =
        charge_system_collect(&work->system, mesh, positions, component, work->triangles + begin, count);
    if (status == CSCD_OK) status = charge_system_solve(&work->system, timings);
    if (status == CSCD_OK) store_component(work);
    return status;
}

static cscd_status solve_components(workspace *work, const cscd_mesh *mesh, const double *positions,
                                    charge_timings *timings) {
    cscd_status status = CSCD_OK;
    double whole = 0.0, done = 0.0;
    for (uint32_t c = 0; c < mesh->component_count; c++)
        whole += charge_system_work(charged_triangles(mesh, c));
    for (uint32_t c = 0; c < mesh->component_count && status == CSCD_OK; c++) {
        if (charged_triangles(mesh, c) == 0) continue;
        double begin = part_of_call * done / whole;
        done += charge_system_work(mesh->components[c].triangle_count);
        progress_part(&mesh->context->progress, begin, part_of_call * done / whole);
        status = solve_component(work, mesh, positions, c, timings);
    }
    progress_part(&mesh->context->progress, part_of_call, 1.0);
    return status;
}

static cscd_status check_memory(const cscd_mesh *mesh, size_t needed, size_t limit) {
    const double gibibyte = 0x1p30;
    if (needed <= limit) return CSCD_OK;
    return context_fail(mesh->context, CSCD_OUT_OF_MEMORY,
                        "charge: a component of %u triangles takes %.4g GiB of memory, and %.4g GiB are "
                        "available; simplify the mesh or use a machine with more memory",
                        largest_component(mesh), (double)needed / gibibyte, (double)limit / gibibyte);
}

cscd_status charge_solve_within(const cscd_mesh *mesh, const double *positions, size_t memory_limit,
                                double *density, double *capacitance, charge_timings *timings) {
    if (mesh == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = mesh->context;
    double start = timer_now_ms();
    if (density == NULL || capacitance == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "charge: density or capacitance is NULL");
    cscd_status status = positions_check(context, positions, mesh->vertex_count, "charge");
    size_t needed = charge_memory(mesh);
    if (status == CSCD_OK) status = check_memory(mesh, needed, memory_limit);
    if (status != CSCD_OK) return status;

    workspace work;
    charge_timings spent = {0.0, 0.0, 0.0, 0.0};
    char *memory = context_allocate(context, needed, 1);
    if (memory == NULL) return context_out_of_memory(context);
    lay_out(&work, mesh, memory);
    sort_by_component(&work, mesh);
    status = solve_components(&work, mesh, positions, &spent);
    if (status == CSCD_OK) {
        memcpy(density, work.density, mesh->triangle_count * sizeof *density);
        memcpy(capacitance, work.capacitance, mesh->component_count * sizeof *capacitance);
        spent.total_ms = timer_now_ms() - start;
        if (timings != NULL) *timings = spent;
    }
    context_free(context, memory);
    return status;
}

cscd_status charge_solve(const cscd_mesh *mesh, const double *positions, double *density, double *capacitance,
                         charge_timings *timings) {
    return charge_solve_within(mesh, positions, available_memory(), density, capacitance, timings);
}
