/* Plans: of what preprocessing has found, or of parts that a program has kept. */
#include "src/mesh/plan.h"

#include "cscd/research.h"
#include "preprocess/preprocess.h"
#include "preprocess/regions/regions.h"
#include "src/core/least_sizes.h"
#include "src/core/names.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"
#include "src/mesh/surface.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const cscd_plan_options default_options = {
    .method = CSCD_METHOD_CHARGE, .k = 4, .seed = 1, .threshold = 0.1, .growing = 1.0 / 400.0};

void cscd_plan_defaults_sized(cscd_plan_options *out, size_t size) {
    struct_give_options(out, size, &default_options, sizeof default_options);
}

static bool makes_plans(cscd_method method) {
    const method_traits *traits = method_traits_of(method);
    return traits != NULL && traits->makes_plan;
}

/* Are all of these bits there, if one is that needs them? */
static bool has_needed(uint64_t ours, uint64_t bit, uint64_t needed) {
    return (ours & bit) == 0 || (ours & needed) == needed;
}

static cscd_status check_ours(cscd_context *context, const cscd_plan_options *options) {
    const uint64_t all = CSCD_OURS_CHARGE | CSCD_OURS_RANKS | CSCD_OURS_CUTS | CSCD_OURS_POINTS;
    const uint64_t ours = options->ours;
    if ((ours & ~all) != 0 || (ours != 0 && options->method != CSCD_METHOD_PUBLISHED))
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "ours is %llu with method %s, expected 0, or a sum of CSCD_OURS_ constants of plans "
            "with method published",
            (unsigned long long)ours, cscd_method_name(options->method));
    if (has_needed(ours, CSCD_OURS_CUTS, CSCD_OURS_RANKS) &&
        has_needed(ours, CSCD_OURS_POINTS, CSCD_OURS_CUTS))
        return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "ours is %llu: CSCD_OURS_CUTS needs CSCD_OURS_RANKS, and CSCD_OURS_POINTS needs "
                        "CSCD_OURS_CUTS",
                        (unsigned long long)ours);
}

static cscd_status check_options(cscd_context *context, const cscd_plan_options *options) {
    if (options->method != CSCD_METHOD_AUTO && !makes_plans(options->method))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "method %s makes no plan: use charge, kmeans, single, auto or published",
                            cscd_method_name(options->method));
    if (!(options->threshold > 0.0 && options->threshold < 1.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "threshold is %g, expected a share of the triangles between 0 and 1",
                            options->threshold);
    if (options->charge_solver > CSCD_CHARGE_COARSE)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown solver %u of the charge",
                            options->charge_solver);
    if (!(options->growing >= 0.0 && options->growing <= 1.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "growing is %g, expected a share of the triangles from 0 to 1", options->growing);
    return check_ours(context, options);
}

static cscd_status check_stiffness(const cscd_mesh *mesh, const double *stiffness) {
    for (uint32_t t = 0; stiffness != NULL && t < mesh->triangle_count; t++)
        if (!(stiffness[t] > 0.0 && stiffness[t] <= DBL_MAX))
            return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                                "the stiffness of triangle %u is %g, expected a positive finite number", t,
                                stiffness[t]);
    return CSCD_OK;
}

/* ---- regions of the plan --------------------------------------------------------------------------- */

static void count_regions(cscd_plan *plan, const cscd_mesh *mesh, const double *positions) {
    for (uint32_t t = 0; t < plan->triangle_count; t++) {
        cscd_region *region = &plan->regions[plan->triangle_regions[t]];
        region->component = mesh->triangle_components[t];
        region->triangle_count++;
        region->area += surface_area(mesh, positions, t);
    }
}

/* Weighs triangles, and finds the offset from the weighted centroid to the detector point. */
static void weigh_triangles(cscd_plan *plan, const cscd_mesh *mesh, const double *positions) {
    for (uint32_t r = 0; r < plan->region_count; r++)
        memcpy(plan->detector_offsets[r], plan->regions[r].detector_point, sizeof(double[3]));
    for (uint32_t t = 0; t < plan->triangle_count; t++) {
        const cscd_region *region = &plan->regions[plan->triangle_regions[t]];
        double weight = region->area > 0.0 ? surface_area(mesh, positions, t) / region->area
                                           : 1.0 / region->triangle_count;
        plan->triangle_weights[t] = weight;
        for (int i = 0; i < 3; i++) {
            const double *p = positions + (size_t)mesh->triangles[t][i] * 3;
            for (int k = 0; k < 3; k++)
                plan->detector_offsets[plan->triangle_regions[t]][k] -= weight / 3.0 * p[k];
        }
    }
}

static cscd_status fill_plan(cscd_plan *plan, const cscd_mesh *mesh, const double *positions,
                             const cscd_plan_parts *parts) {
    double *shares = context_allocate(plan->context, plan->region_count, sizeof *shares);
    if (shares == NULL) return context_out_of_memory(plan->context);
    cscd_status status = visible_shares(mesh, positions, parts->triangle_regions, plan->region_count,
                                        parts->detector_points, shares);
    if (status == CSCD_OK) {
        memcpy(plan->triangle_regions, parts->triangle_regions,
               plan->triangle_count * sizeof *plan->triangle_regions);
        count_regions(plan, mesh, positions);
        for (uint32_t r = 0; r < plan->region_count; r++) {
            plan->regions[r].visible_share = shares[r];
            memcpy(plan->regions[r].detector_point, parts->detector_points + (size_t)r * 3,
                   sizeof(double[3]));
        }
        weigh_triangles(plan, mesh, positions);
        if (plan->charges != NULL) {
            memcpy(plan->charges, parts->charges, plan->triangle_count * sizeof *plan->charges);
            memcpy(plan->capacitances, parts->capacitances,
                   plan->component_count * sizeof *plan->capacitances);
        }
    }
    context_free(plan->context, shares);
    return status;
}

static const char *validate_listed(const reference_count *object) {
    return plan_validate((const cscd_plan *)object);
}

static cscd_status make_plan(const cscd_mesh *mesh, const double *positions, const cscd_plan_parts *parts,
                             cscd_plan **out) {
    cscd_plan *plan = plan_allocate(mesh, parts->method, parts->region_count);
    if (plan == NULL) return context_out_of_memory(mesh->context);
    if (parts->origin != NULL) {
        snprintf(plan->origin, sizeof plan->origin, "%s", parts->origin);
        plan->info.origin = plan->origin;
    }
    cscd_status status = fill_plan(plan, mesh, positions, parts);
    if (status == CSCD_OK) status = context_progress_status(mesh->context);
    if (status != CSCD_OK) {
        cscd_plan_destroy(plan);
        return status;
    }
    context_list_object(plan->context, &plan->references, validate_listed);
    *out = plan;
    return CSCD_OK;
}

/* The origin of a draft, in words that docs/artist/formats.md explains. */
static void write_origin(const plan_draft *d, char out[PLAN_ORIGIN_SIZE]) {
    static const char *const solvers[] = {"tree", "dense", "coarse"};
    const cscd_plan_options *o = &d->options;
    const bool published = o->method == CSCD_METHOD_PUBLISHED;
    int length = snprintf(out, PLAN_ORIGIN_SIZE, "method=%s", cscd_method_name(o->method));
    char *rest = out + length;
    const size_t room = PLAN_ORIGIN_SIZE - (size_t)length;
    if (o->method == CSCD_METHOD_KMEANS)
        snprintf(rest, room, " k=%u seed=%u version=%s", o->k, o->seed, cscd_version_string());
    else if (!method_traits_of(o->method)->by_charge)
        snprintf(rest, room, " version=%s", cscd_version_string());
    else if (published)
        snprintf(rest, room, " solver=%s threshold=%g growing=%g ours=%llu version=%s",
                 solvers[plan_draft_solver(d)], o->threshold, o->growing, (unsigned long long)o->ours,
                 cscd_version_string());
    else
        snprintf(rest, room, " solver=%s threshold=%g frames=%u stiffness=%d version=%s",
                 solvers[plan_draft_solver(d)], o->threshold, d->frames->count, o->stiffness != NULL,
                 cscd_version_string());
}

static cscd_status plan_from_draft(const plan_draft *d, const plan_candidates *candidates, cscd_plan **out) {
    char origin[PLAN_ORIGIN_SIZE];
    write_origin(d, origin);
    const cscd_plan_parts parts = {.origin = origin,
                                   .method = d->options.method,
                                   .region_count = d->region_count,
                                   .triangle_regions = d->regions,
                                   .detector_points = d->detector_points,
                                   .charges = d->charges,
                                   .capacitances = d->capacitances};
    const cscd_status status = make_plan(d->mesh, d->positions, &parts, out);
    if (status != CSCD_OK) return status;
    (*out)->timings = d->timings;
    (*out)->info.charge_kernels = d->kernels.used;
    (*out)->info.better_kernels = d->kernels.better;
    (*out)->candidates = *candidates;
    return CSCD_OK;
}

static cscd_status make_draft(const cscd_mesh *mesh, const double *positions, const plan_frames *frames,
                              const cscd_plan_options *options, plan_candidates *candidates,
                              plan_draft *out) {
    *candidates = (plan_candidates){0};
    return options->method == CSCD_METHOD_AUTO
               ? best_draft_make(mesh, positions, frames, options, candidates, out)
               : plan_draft_make(mesh, positions, frames, options, out);
}

static cscd_status plan_from_positions(const cscd_mesh *mesh, const double *positions,
                                       const cscd_plan_options *options, cscd_plan **out) {
    cscd_context *context = mesh->context;
    if (mesh->triangle_count == 0)
        return context_fail(context, CSCD_INVALID_MESH,
                            "the mesh has no triangles, so there is nothing to plan");
    const double start = timer_now_ms();
    plan_frames frames = {0};
    plan_candidates candidates;
    plan_draft d = {0};
    cscd_status status = positions_check(context, positions, mesh->vertex_count, "positions");
    if (status == CSCD_OK) status = check_stiffness(mesh, options->stiffness);
    if (status == CSCD_OK) status = plan_frames_read(context, mesh, options, &frames);
    if (status == CSCD_OK) status = make_draft(mesh, positions, &frames, options, &candidates, &d);
    if (status == CSCD_OK) status = plan_from_draft(&d, &candidates, out);
    if (status == CSCD_OK) (*out)->timings.total_ms = timer_now_ms() - start;
    plan_draft_free(&d);
    plan_frames_free(context, &frames);
    return status;
}

static cscd_status create_plan(cscd_context *context, const cscd_mesh *mesh, const cscd_view *positions,
                               const cscd_plan_options *options, cscd_plan **out) {
    const cscd_mesh seen = mesh_seen_from(context, mesh);
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_plan_create: out is NULL");
    cscd_plan_options chosen = default_options;
    cscd_status status = CSCD_OK;
    if (options != NULL)
        status = struct_take_options(context, &chosen, sizeof chosen, LEAST_SIZE(cscd_plan_options), options,
                                     "cscd_plan_defaults");
    if (status == CSCD_OK) status = check_options(context, &chosen);
    if (status != CSCD_OK) return status;
    progress_begin(&context->progress);
    double *buffer = NULL;
    const double *x = NULL;
    status = views_read(context, mesh, positions, "positions", &buffer, &x);
    if (status == CSCD_OK) status = plan_from_positions(&seen, x, &chosen, out);
    context_free(context, buffer);
    return status;
}

cscd_status cscd_plan_create(cscd_context *context, const cscd_mesh *mesh, const cscd_view *positions,
                             const cscd_plan_options *options, cscd_plan **out) {
    if (context == NULL || mesh == NULL) return context_lacks(context, "cscd_plan_create", "mesh");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, create_plan(context, mesh, positions, options, out));
}

/* ---- from parts ------------------------------------------------------------------------------------ */

/* Can it stand in one line of a file? */
static bool is_line(const char *origin) {
    size_t length = 0;
    while (length < PLAN_ORIGIN_SIZE && origin[length] >= ' ' && origin[length] <= '~') length++;
    return length < PLAN_ORIGIN_SIZE && origin[length] == '\0';
}

static cscd_status check_parts(const cscd_mesh *mesh, const cscd_plan_parts *parts, uint32_t *component_of) {
    cscd_context *context = mesh->context;
    if (!makes_plans(parts->method))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "method %s makes no plan",
                            cscd_method_name(parts->method));
    if (parts->triangle_regions == NULL || parts->detector_points == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%s is NULL",
                            parts->triangle_regions == NULL ? "triangle_regions" : "detector_points");
    const bool charged = method_traits_of(parts->method)->by_charge;
    if ((parts->charges != NULL) != charged || (parts->capacitances != NULL) != charged)
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "charges and capacitances belong to the methods charge and published, and to no other");
    if (parts->origin != NULL && !is_line(parts->origin))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "origin is longer than %d characters, or has others than printable ASCII",
                            PLAN_ORIGIN_SIZE - 1);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t region = parts->triangle_regions[t], component = mesh->triangle_components[t];
        if (region >= parts->region_count)
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "triangle %u is in region %u, but there are %u", t, region,
                                parts->region_count);
        if (component_of[region] != 0 && component_of[region] != component + 1)
            return context_fail(context, CSCD_INVALID_ARGUMENT, "region %u spans the components %u and %u",
                                region, component_of[region] - 1, component);
        component_of[region] = component + 1;
    }
    for (uint32_t r = 0; r < parts->region_count; r++) {
        if (component_of[r] == 0)
            return context_fail(context, CSCD_INVALID_ARGUMENT, "region %u has no triangle", r);
        for (int k = 0; k < 3; k++) {
            if (!(fabs(parts->detector_points[(size_t)r * 3 + (size_t)k]) <= 0x1p301))
                return context_fail(context, CSCD_INVALID_ARGUMENT,
                                    "the detector point of region %u is not finite", r);
        }
    }
    return CSCD_OK;
}

static cscd_status plan_from_parts(const cscd_mesh *mesh, const double *positions,
                                   const cscd_plan_parts *parts, cscd_plan **out) {
    cscd_context *context = mesh->context;
    if (parts->region_count == 0 || parts->region_count > mesh->triangle_count)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%u regions for %u triangles",
                            parts->region_count, mesh->triangle_count);
    cscd_status status = positions_check(context, positions, mesh->vertex_count, "positions");
    if (status != CSCD_OK) return status;
    uint32_t *component_of = context_allocate(context, parts->region_count, sizeof *component_of);
    if (component_of == NULL) return context_out_of_memory(context);
    status = check_parts(mesh, parts, component_of);
    context_free(context, component_of);
    if (status != CSCD_OK) return status;
    return make_plan(mesh, positions, parts, out);
}

static cscd_status create_from_parts(cscd_context *context, const cscd_mesh *mesh, const cscd_view *positions,
                                     const cscd_plan_parts *parts, size_t parts_size, cscd_plan **out) {
    const cscd_mesh seen = mesh_seen_from(context, mesh);
    if (parts == NULL || out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_plan_create_from_parts: %s is NULL",
                            out == NULL ? "out" : "parts");
    cscd_plan_parts taken = {0};
    double *buffer = NULL;
    const double *x = NULL;
    cscd_status status = struct_take(context, &taken, sizeof taken, LEAST_SIZE(cscd_plan_parts), parts,
                                     parts_size, "cscd_plan_parts");
    if (status == CSCD_OK) status = views_read(context, mesh, positions, "positions", &buffer, &x);
    if (status == CSCD_OK) status = plan_from_parts(&seen, x, &taken, out);
    context_free(context, buffer);
    return status;
}

cscd_status cscd_plan_create_from_parts_sized(cscd_context *context, const cscd_mesh *mesh,
                                              const cscd_view *positions, const cscd_plan_parts *parts,
                                              size_t parts_size, cscd_plan **out) {
    if (context == NULL || mesh == NULL) return context_lacks(context, "cscd_plan_create_from_parts", "mesh");
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, create_from_parts(context, mesh, positions, parts, parts_size, out));
}
