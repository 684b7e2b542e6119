/* The steps of preprocessing: reads the frames of a motion, makes drafts by one method, and compares those of several. */
#include "preprocess/preprocess.h"

#include "src/core/names.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"

#include <cscd/research.h>

#include <stdio.h>

/* baselines: begin */
#include "preprocess/baselines/baselines.h"
/* baselines: end */

/* ---- frames -------------------------------------------------------------------------------------------- */

static cscd_status read_frame(cscd_context *context, const cscd_mesh *mesh, const cscd_plan_options *options,
                              uint32_t number, plan_frames *out) {
    char name[32];
    snprintf(name, sizeof name, "frames[%u]", number);
    if (options->frames[number] == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%s is NULL", name);
    const uint32_t i = out->count++;
    const cscd_status status =
        views_read(context, mesh, options->frames[number], name, &out->buffers[i], &out->items[i]);
    return status == CSCD_OK ? positions_check(context, out->items[i], mesh->vertex_count, name) : status;
}

cscd_status plan_frames_read(cscd_context *context, const cscd_mesh *mesh, const cscd_plan_options *options,
                             plan_frames *out) {
    const uint32_t given = options->frame_count, wanted = given < FRAMES_MOST ? given : FRAMES_MOST;
    cscd_status status = CSCD_OK;
    *out = (plan_frames){0};
    if (given > 0 && options->frames == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "frame_count is %u, but frames is NULL", given);
    for (uint32_t i = 0; i < wanted && status == CSCD_OK; i++) {
        const uint32_t number = wanted == given ? i : (uint32_t)((uint64_t)i * (given - 1) / (wanted - 1));
        status = read_frame(context, mesh, options, number, out);
    }
    return status;
}

void plan_frames_free(cscd_context *context, plan_frames *frames) {
    for (uint32_t i = 0; i < frames->count; i++) context_free(context, frames->buffers[i]);
    *frames = (plan_frames){0};
}

/* ---- one method ---------------------------------------------------------------------------------------- */

/* Returns whether the method is PUBLISHED and does this step, a CSCD_OURS_ bit, as published. */
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

/* ---- the best of several methods ----------------------------------------------------------------------- */

/* Another draft is better if it leaves less than this share of what the best so far leaves: charge is the first, and where two are as
 * good the plan has charges to show. */
static const double clearly_less = 0.98;

/* K-means regions for each component; where these are more in all than KMEANS_MOST they take longer than the charge. */
static const uint32_t kmeans_counts[] = {4, 8, 16};
enum { KMEANS_MOST = 1024 };

static uint32_t count_bodies(const cscd_mesh *mesh) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < mesh->component_count; c++) count += !component_is_obstacle(mesh, c);
    return count;
}

static void add_timings(const cscd_preprocess_timings *from, cscd_preprocess_timings *to) {
    to->assembly_ms += from->assembly_ms;
    to->solve_ms += from->solve_ms;
    to->regions_ms += from->regions_ms;
    to->total_ms += from->total_ms;
}

/* The kernels and times of what has been compared go with the draft that is kept; true: that is d. */
static bool keep_better(plan_draft *d, plan_draft *best, double share, double *least) {
    const bool better = best->mesh == NULL || share < clearly_less * *least;
    plan_draft *kept = better ? d : best, *other = better ? best : d;
    add_timings(&other->timings, &kept->timings);
    if (kept->kernels.used == NULL) kept->kernels = other->kernels;
    plan_draft_free(other);
    if (!better) return false;
    *best = *d;
    *least = share;
    return true;
}

static cscd_status find_tested_share(const plan_draft *d, double *out) {
    const judged_regions regions = {.mesh = d->mesh,
                                    .positions = d->positions,
                                    .frames = d->frames->items,
                                    .frame_count = d->frames->count,
                                    .stiffness = d->options.stiffness,
                                    .of_triangle = d->regions,
                                    .region_count = d->region_count,
                                    .points = (const double(*)[3])d->detector_points};
    return regions_tested_share(&regions, out);
}

/* Tries one method; of the failures only those of the charge leave something to compare. */
static cscd_status try_method(const plan_draft *given, plan_candidates *candidates, plan_draft *best,
                              double *least) {
    cscd_context *context = given->mesh->context;
    cscd_compared_plan candidate = {.method = given->options.method};
    plan_draft d;
    cscd_status status = plan_draft_make(given->mesh, given->positions, given->frames, &given->options, &d);
    if (candidate.method == CSCD_METHOD_KMEANS) candidate.k = given->options.k;
    if (status == CSCD_OK) status = find_tested_share(&d, &candidate.tested_share);
    if (status == CSCD_OK) {
        candidate.region_count = d.region_count;
        candidate.kept = keep_better(&d, best, candidate.tested_share, least);
        for (uint32_t i = 0; i < candidates->count && candidate.kept; i++) candidates->items[i].kept = false;
        candidates->items[candidates->count++] = candidate;
        return CSCD_OK;
    }
    plan_draft_free(&d);
    if (candidate.method != CSCD_METHOD_CHARGE || status == CSCD_CANCELLED) return status;
    snprintf(candidates->charge_failure, sizeof candidates->charge_failure, "%s", context->detail);
    context->detail[0] = '\0'; /* the call goes on, and may succeed */
    candidates->items[candidates->count++] = candidate;
    return CSCD_OK;
}

cscd_status best_draft_make(const cscd_mesh *mesh, const double *positions, const plan_frames *frames,
                            const cscd_plan_options *options, plan_candidates *candidates, plan_draft *out) {
    plan_draft given = {.mesh = mesh, .positions = positions, .frames = frames, .options = *options};
    const uint32_t bodies = count_bodies(mesh);
    double least = 0.0;
    *out = (plan_draft){0};
    *candidates = (plan_candidates){0};
    given.options.method = CSCD_METHOD_CHARGE;
    cscd_status status = try_method(&given, candidates, out, &least);
    given.options.method = CSCD_METHOD_SINGLE;
    if (status == CSCD_OK) status = try_method(&given, candidates, out, &least);
    given.options.method = CSCD_METHOD_KMEANS;
    for (size_t i = 0; i < sizeof kmeans_counts / sizeof *kmeans_counts && status == CSCD_OK; i++) {
        const uint64_t k = (uint64_t)kmeans_counts[i] * bodies;
        if (bodies == 0 || k > mesh->triangle_count || k > KMEANS_MOST) break;
        given.options.k = (uint32_t)k;
        status = try_method(&given, candidates, out, &least);
    }
    return status;
}
