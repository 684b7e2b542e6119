/* The charges of a mesh, component by component: by a treecode, or by a solver to compare with. */
#include "preprocess/preprocess.h"

#include "preprocess/treecode/treecode.h"
#include "src/core/system.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"

#include <string.h>

/* baselines: begin */
#include "preprocess/baselines/baselines.h"
/* baselines: end */

/* The charge's share of cscd_plan_create, by estimate, for each solver; the regions take the rest. */
static const double parts_of_call[] = {
    [CSCD_CHARGE_TREE] = 0.5, [CSCD_CHARGE_DENSE] = 0.95, [CSCD_CHARGE_COARSE] = 0.4};

typedef struct charge_work {
    const cscd_mesh *mesh;
    cscd_context *context;
    const double *positions;
    charge_solution other; /* without solve: the tree solves */
    cscd_charge_solver solver;
    size_t memory_limit;
    uint32_t *triangles; /* sorted by component */
    uint32_t *offsets;   /* component c has triangles[offsets[c] .. offsets[c + 1]) */
    double *density, *capacitance;
    charge_system system;
    void *system_memory;
    charge_report report;
} charge_work;

static cscd_status find_dense(cscd_context *context, charge_solution *out) {
    *out = (charge_solution){.solve = NULL};
    /* baselines: begin */
    if (context != NULL) return dense_charges_find(context, out);
    /* baselines: end */
    return context_fail(
        context, CSCD_INVALID_ARGUMENT,
        "the dense solver is a baseline, and this library was built without preprocess/baselines");
}

static array_list list_arrays(charge_work *w) {
    const size_t components = w->mesh->component_count;
    return (array_list){{ARRAY(w->triangles, w->mesh->triangle_count), ARRAY(w->offsets, components + 1),
                         ARRAY(w->density, w->mesh->triangle_count), ARRAY(w->capacitance, components)}};
}

/* ---- components ------------------------------------------------------------------------------------------ */

/* Obstacles are not charged, since they are not cut. */
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

/* ---- memory ------------------------------------------------------------------------------------------------ */

static size_t memory_of_other(const charge_work *w) {
    charge_system system;
    const uint32_t largest = largest_component(w->mesh);
    const size_t common = charge_system_lay_out(&system, largest, NULL),
                 matrix = w->other.memory(w->other.functions, largest);
    return matrix < SIZE_MAX - common ? common + matrix : SIZE_MAX;
}

static cscd_status check_memory(const charge_work *w) {
    const double gibibyte = 0x1p30;
    const size_t needed = w->other.solve != NULL ? memory_of_other(w) : 0;
    if (needed <= w->memory_limit) return CSCD_OK;
    return context_fail(w->context, CSCD_OUT_OF_MEMORY,
                        "charge: a component of %u triangles takes %.4g GiB of memory, and %.4g GiB are "
                        "available; simplify the mesh or use a machine with more memory",
                        largest_component(w->mesh), (double)needed / gibibyte,
                        (double)w->memory_limit / gibibyte);
}

static double tolerance_of(cscd_charge_solver solver) {
    return solver == CSCD_CHARGE_COARSE ? 3e-3 : 1e-6;
}

/* ---- all components -------------------------------------------------------------------------------------- */

static cscd_status solve_component(charge_work *w, uint32_t component) {
    const charge_surface surface = {w->context, (const uint32_t(*)[3])w->mesh->triangles, w->positions};
    uint32_t begin = w->offsets[component], count = w->offsets[component + 1] - begin;
    cscd_status status = charge_system_collect(&w->system, &surface, component, w->triangles + begin, count);
    if (status == CSCD_OK)
        status = w->other.solve != NULL
                     ? w->other.solve(w->other.functions, w->context, &w->system, &w->report.timings)
                     : tree_solve(w->context, &w->system, w->memory_limit, tolerance_of(w->solver),
                                  &w->report.timings);
    if (status == CSCD_OK) charge_system_store(&w->system, w->density, &w->capacitance[component]);
    return status;
}

/* In ns on one thread, by estimate: of a tree a triangle takes some 100,000. */
static double work_of(const charge_work *w, double count) {
    return w->other.solve != NULL ? w->other.work(count) : 1e5 * count;
}

static cscd_status solve_components(charge_work *w) {
    const cscd_mesh *mesh = w->mesh;
    progress *told = &w->context->progress;
    cscd_status status = CSCD_OK;
    const double part_of_call = parts_of_call[w->solver];
    double whole = 0.0, done = 0.0;
    for (uint32_t c = 0; c < mesh->component_count; c++) whole += work_of(w, charged_triangles(mesh, c));
    for (uint32_t c = 0; c < mesh->component_count && status == CSCD_OK; c++) {
        if (charged_triangles(mesh, c) == 0) continue;
        const double begin = part_of_call * done / whole;
        done += work_of(w, charged_triangles(mesh, c));
        progress_part(told, begin, part_of_call * done / whole);
        status = solve_component(w, c);
    }
    progress_part(told, part_of_call, 1.0);
    return status;
}

static cscd_status solve_mesh(charge_work *w) {
    const uint32_t largest = largest_component(w->mesh);
    cscd_status status = check_memory(w);
    if (status != CSCD_OK) return status;
    w->system_memory = context_reserve(w->context, charge_system_lay_out(&w->system, largest, NULL), 1);
    if (w->system_memory == NULL || !context_allocate_all(w->context, list_arrays(w)))
        return context_out_of_memory(w->context);
    charge_system_lay_out(&w->system, largest, w->system_memory);
    mesh_list_by_component(w->mesh, w->triangles, w->offsets);
    return solve_components(w);
}

cscd_status charge_solve(const cscd_mesh *mesh, const double *positions, const charge_options *options,
                         double *density, double *capacitance, charge_report *report) {
    if (mesh == NULL) return CSCD_INVALID_ARGUMENT;
    cscd_context *context = mesh->context;
    charge_work w = {.mesh = mesh,
                     .context = context,
                     .positions = positions,
                     .solver = options->solver,
                     .memory_limit =
                         options->memory_limit > 0 ? options->memory_limit : system_memory_left()};
    const double start = timer_now_ms();
    if (density == NULL || capacitance == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "charge: density or capacitance is NULL");
    cscd_status status = positions_check(context, positions, mesh->vertex_count, "charge");
    if (status == CSCD_OK && w.solver == CSCD_CHARGE_DENSE) status = find_dense(context, &w.other);
    if (status == CSCD_OK && w.other.solve != NULL) w.report.kernels = w.other.kernels(w.other.functions);
    if (status == CSCD_OK) status = solve_mesh(&w);
    if (status == CSCD_OK) {
        memcpy(density, w.density, mesh->triangle_count * sizeof *density);
        memcpy(capacitance, w.capacitance, mesh->component_count * sizeof *capacitance);
        w.report.timings.total_ms = timer_now_ms() - start;
        if (report != NULL) *report = w.report;
    }
    context_free_all(context, list_arrays(&w));
    context_free(context, w.system_memory);
    return status;
}

size_t charge_memory(const cscd_mesh *mesh) {
    charge_work w = {.mesh = mesh};
    return find_dense(mesh->context, &w.other) == CSCD_OK ? memory_of_other(&w) : SIZE_MAX;
}
