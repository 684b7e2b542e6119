/* The steps of preprocessing. */
#include "preprocess/plan_draft.h"

#include "cscd/research.h"
#include "preprocess/regions/kmeans.h"
#include "preprocess/regions/regions.h"
#include "preprocess/regions/visibility.h"
#include "src/core/timer.h"

static cscd_status solve_charge(plan_draft *d) {
    charge_report report = {{0}, {NULL, NULL}};
    d->charges = context_allocate(d->mesh->context, d->mesh->triangle_count, sizeof *d->charges);
    d->capacitances = context_allocate(d->mesh->context, d->mesh->component_count, sizeof *d->capacitances);
    if (d->charges == NULL || d->capacitances == NULL) return context_out_of_memory(d->mesh->context);
    uint64_t asked = d->options.memory_limit;
    const charge_options options = {d->options.charge_solver, asked < SIZE_MAX ? (size_t)asked : SIZE_MAX};
    cscd_status status = charge_solve(d->mesh, d->positions, &options, d->charges, d->capacitances, &report);
    d->timings.assembly_ms = report.timings.assembly_ms;
    d->timings.solve_ms = report.timings.factor_ms + report.timings.refine_ms;
    d->kernels = report.kernels;
    return status;
}

static cscd_status find_charge_regions(plan_draft *d) {
    region_options options = region_options_defaults();
    options.threshold = d->options.threshold;
    options.published = d->options.variant == CSCD_PLAN_VARIANT_PUBLISHED;
    options.frames = d->frames->items;
    options.frame_count = d->frames->count;
    options.stiffness = d->options.stiffness;
    return regions_from_charge(d->mesh, d->positions, d->charges, &options, d->regions, &d->region_count,
                               &d->detector_points);
}

static cscd_status find_kmeans_regions(plan_draft *d) {
    cscd_context *context = d->mesh->context;
    d->detector_points = context_allocate(context, kmeans_capacity(d->mesh, d->options.k), sizeof(double[3]));
    if (d->detector_points == NULL) return context_out_of_memory(context);
    return regions_kmeans(d->mesh, d->positions, d->options.k, d->options.seed, d->regions, &d->region_count,
                          d->detector_points);
}

static cscd_status find_regions(plan_draft *d) {
    switch (d->options.method) {
    case CSCD_METHOD_CHARGE:
        return find_charge_regions(d);
    case CSCD_METHOD_KMEANS:
        return find_kmeans_regions(d);
    default:
        return regions_single(d->mesh, d->regions, &d->region_count);
    }
}

/* Finds detector points for the methods that do not bring their own. */
static cscd_status place_detector_points(plan_draft *d) {
    if (d->detector_points != NULL) return CSCD_OK;
    d->detector_points = context_allocate(d->mesh->context, d->region_count, sizeof(double[3]));
    if (d->detector_points == NULL) return context_out_of_memory(d->mesh->context);
    return detector_points_from_regions(d->mesh, d->positions, d->regions, d->region_count,
                                        d->detector_points);
}

cscd_status plan_draft_make(const cscd_mesh *mesh, const double *positions, const plan_frames *frames,
                            const cscd_plan_options *options, plan_draft *out) {
    plan_draft d = {.mesh = mesh, .positions = positions, .frames = frames, .options = *options};
    double start = timer_now_ms(), since = start;
    d.regions = context_allocate(mesh->context, mesh->triangle_count, sizeof *d.regions);
    cscd_status status = d.regions != NULL ? CSCD_OK : context_out_of_memory(mesh->context);
    if (status == CSCD_OK && options->method == CSCD_METHOD_CHARGE) status = solve_charge(&d);
    since = timer_now_ms();
    if (status == CSCD_OK) status = find_regions(&d);
    if (status == CSCD_OK) status = place_detector_points(&d);
    timer_lap(&since, &d.timings.regions_ms);
    timer_lap(&start, &d.timings.total_ms);
    *out = d;
    return status;
}

void plan_draft_free(plan_draft *d) {
    if (d->mesh == NULL) return;
    cscd_context *context = d->mesh->context;
    context_free(context, d->regions);
    context_free(context, d->detector_points);
    context_free(context, d->charges);
    context_free(context, d->capacitances);
    *d = (plan_draft){0};
}
