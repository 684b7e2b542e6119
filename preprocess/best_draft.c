/* Compares drafts by the work that they leave. */
#include "preprocess/best_draft.h"

#include "preprocess/tested_share.h"

#include <stdio.h>

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
