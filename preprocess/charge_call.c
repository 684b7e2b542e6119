/* The call of the charge library for a mesh: what it asks of its host, the context answers. */
#include "preprocess/charge_call.h"

#include "src/mesh/positions.h"

static void *allocate_block(void *context, size_t size) {
    void *block = context_allocate(context, size, 1);
    if (block == NULL) context_out_of_memory(context);
    return block;
}

static void release_block(void *context, void *block) {
    context_free(context, block);
}

static void run_tasks(void *context, uint32_t task_count, parallel_task *task, void *data) {
    parallel_run(((cscd_context *)context)->threads, task_count, task, data);
}

static void enter_part(void *context, double begin, double end) {
    progress_part(&((cscd_context *)context)->progress, begin, end);
}

static void enter_stage(void *context, const char *name, double begin, double end) {
    progress_stage(&((cscd_context *)context)->progress, name, begin, end);
}

static bool go_on(void *context, double share) {
    return progress_go_on(&((cscd_context *)context)->progress, share);
}

static cscd_status progress_status(void *context) {
    return context_progress_status(context);
}

static void explain_failure(void *context, cscd_status status, const char *sentence) {
    context_fail(context, status, "%s", sentence);
}

/* Obstacles are not charged, since they are not cut. */
static uint32_t charged_triangles(const void *data, uint32_t component) {
    const cscd_mesh *mesh = data;
    return component_is_obstacle(mesh, component) ? 0 : mesh->components[component].triangle_count;
}

static charge_problem problem_of(const cscd_mesh *mesh, const double *positions, size_t memory_limit) {
    return (charge_problem){
        .host = {mesh->context, allocate_block, release_block, run_tasks, enter_part, enter_stage, go_on,
                 progress_status, explain_failure, parallel_thread_count(mesh->context->threads)},
        .triangles = (const uint32_t(*)[3])mesh->triangles,
        .triangle_components = mesh->triangle_components,
        .positions = positions,
        .triangle_count = mesh->triangle_count,
        .component_count = mesh->component_count,
        .mesh = mesh,
        .charged_triangles = charged_triangles,
        .memory_limit = memory_limit,
    };
}

size_t charge_memory(const cscd_mesh *mesh) {
    const charge_functions *library;
    charge_problem problem = problem_of(mesh, NULL, 0);
    return charge_library_find(mesh->context, &library) == CSCD_OK ? library->memory(&problem) : SIZE_MAX;
}

/* memory_limit NULL: what the system has available. */
static cscd_status solve_within(const cscd_mesh *mesh, const double *positions, const size_t *memory_limit,
                                double *density, double *capacitance, charge_timings *timings) {
    const charge_functions *library;
    charge_timings unused;
    if (mesh == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = mesh->context;
    if (density == NULL || capacitance == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "charge: density or capacitance is NULL");
    cscd_status status = positions_check(context, positions, mesh->vertex_count, "charge");
    if (status == CSCD_OK) status = charge_library_find(context, &library);
    if (status != CSCD_OK) return status;
    size_t limit = memory_limit != NULL ? *memory_limit : library->available_memory();
    charge_problem problem = problem_of(mesh, positions, limit);
    return library->solve(&problem, density, capacitance, timings != NULL ? timings : &unused);
}

cscd_status charge_solve_within(const cscd_mesh *mesh, const double *positions, size_t memory_limit,
                                double *density, double *capacitance, charge_timings *timings) {
    return solve_within(mesh, positions, &memory_limit, density, capacitance, timings);
}

cscd_status charge_solve(const cscd_mesh *mesh, const double *positions, double *density, double *capacitance,
                         charge_timings *timings) {
    return solve_within(mesh, positions, NULL, density, capacitance, timings);
}

charge_kernels charge_kernels_here(cscd_context *context) {
    const charge_functions *library;
    return charge_library_find(context, &library) == CSCD_OK ? library->kernels()
                                                             : (charge_kernels){NULL, NULL};
}
