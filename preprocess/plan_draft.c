/* The steps of preprocessing. */
#include "preprocess/plan_draft.h"

#include "cscd/research.h"
#include "preprocess/regions/kmeans.h"
#include "preprocess/regions/regions.h"
#include "preprocess/regions/visibility.h"
#include "src/core/methods.h"
#include "src/core/timer.h"

/* baselines: begin */
#include "preprocess/baselines/published_cuts.h"
#include "preprocess/regions/equalize.h"
/* baselines: end */

/* Of the method PUBLISHED: is this step, a CSCD_OURS_ bit, done as published? */
static bool as_published(const plan_draft *d, uint64_t step) {
    return d->options.method == CSCD_METHOD_PUBLISHED && (d->options.ours & step) == 0;
}

cscd_charge_solver plan_draft_solver(const plan_draft *d) {
    return as_published(d, CSCD_OURS_CHARGE) ? CSCD_CHARGE_DENSE : d->options.charge_solver;
}

static cscd_status solve_charge(plan_draft *d) {
    charge_report report = {{0}, {NULL, NULL}};
    d->charges = context_allocate(d->mesh->context, d->mesh->triangle_count, sizeof *d->charges);
    d->capacitances = context_allocate(d->mesh->context, d->mesh->component_count, sizeof *d->capacitances);
    if (d->charges == NULL || d->capacitances == NULL) return context_out_of_memory(d->mesh->context);
    uint64_t asked = d->options.memory_limit;
    const charge_options options = {plan_draft_solver(d), asked < SIZE_MAX ? (size_t)asked : SIZE_MAX};
    cscd_status status = charge_solve(d->mesh, d->positions, &options, d->charges, d->capacitances, &report);
    d->timings.assembly_ms = report.timings.assembly_ms;
    d->timings.solve_ms = report.timings.factor_ms + report.timings.refine_ms;
    d->kernels = report.kernels;
    return status;
}

static cscd_status find_charge_regions(plan_draft *d) {
    region_options options = region_options_defaults();
    options.threshold = d->options.threshold;
    options.frames = d->frames->items;
    options.frame_count = d->frames->count;
    options.stiffness = d->options.stiffness;
    return regions_from_charge(d->mesh, d->positions, d->charges, &options, d->regions, &d->region_count,
                               &d->detector_points);
}

/* baselines: begin */
static cscd_status cut_as_published(plan_draft *d) {
    const published_thresholds thresholds = {d->options.threshold, d->options.growing};
    double *equalized = context_allocate(d->mesh->context, d->mesh->triangle_count, sizeof *equalized);
    if (equalized == NULL) return context_out_of_memory(d->mesh->context);
    cscd_status status = as_published(d, CSCD_OURS_RANKS) ? published_equalize(d->mesh, d->charges, equalized)
                                                          : equalize(d->mesh, d->charges, equalized);
    if (status == CSCD_OK)
        status =
            published_cuts(d->mesh, d->positions, equalized, thresholds, NULL, d->regions, &d->region_count);
    context_free(d->mesh->context, equalized);
    return status;
}

/* The detector points are the centroids, unless they are to be ours. */
static cscd_status find_published_regions(plan_draft *d) {
    if (as_published(d, CSCD_OURS_CUTS)) return cut_as_published(d);
    const cscd_status status = find_charge_regions(d);
    if (!as_published(d, CSCD_OURS_POINTS)) return status;
    context_free(d->mesh->context, d->detector_points);
    d->detector_points = NULL;
    return status;
}
/* baselines: end */

static cscd_status find_kmeans_regions(plan_draft *d) {
    cscd_context *context = d->mesh->context;
    d->detector_points = context_allocate(context, kmeans_capacity(d->mesh, d->options.k), sizeof(double[3]));
    if (d->detector_points == NULL) return context_out_of_memory(context);
    return regions_kmeans(d->mesh, d->positions, d->options.k, d->options.seed, d->regions, &d->region_count,
                          d->detector_points);
}

static cscd_status find_regions(plan_draft *d) {
    switch ((int)d->options.method) {
    case CSCD_METHOD_CHARGE:
        return find_charge_regions(d);
    /* baselines: begin */
    case CSCD_METHOD_PUBLISHED:
        return find_published_regions(d);
    /* baselines: end */
    case CSCD_METHOD_KMEANS:
        return find_kmeans_regions(d);
    case CSCD_METHOD_SINGLE:
        return regions_single(d->mesh, d->regions, &d->region_count);
    default:
        return context_fail(
            d->mesh->context, CSCD_INVALID_ARGUMENT,
            "method %s is a baseline, and this library was built without preprocess/baselines",
            cscd_method_name(d->options.method));
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
    if (status == CSCD_OK && method_traits_of(options->method)->by_charge) status = solve_charge(&d);
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
