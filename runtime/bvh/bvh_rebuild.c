/* Trees that follow a motion: built when they are first needed, refitted, and rebuilt when they have decayed. */
#include "runtime/bvh/bvh_parts.h"

#include <math.h>

enum { MEASURE_EVERY = 16, USELESS_MAX = 4 };

/* A spread that has grown by more than the factor `decayed` calls for a rebuild. A rebuild was of use if it has
 * shrunk the spread by more than the factor `of_use`. */
static const double decayed = 1.25, of_use = 1.1;

static const char stage_of_trees[] = "trees";

static cscd_status build_trees(const bvh_rebuild *r, const double *positions, bvh *out) {
    bvh built;
    progress *asked = &r->mesh->context->progress;
    progress_outer outer = progress_enter(asked, stage_of_trees);
    cscd_status status = bvh_build(r->mesh, r->regions, positions, r->axis_count, &built);
    progress_leave(asked, outer);
    if (status != CSCD_OK) return status;
    if (!bvh_set_objects(&built, r->objects) || !bvh_set_active(&built, r->active)) {
        bvh_free(&built);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = built;
    return CSCD_OK;
}

/* Returns how far blocks of trees extend, as a multiple of the extent of their trees; 0 if there is only one block. */
static double spread_of_trees(const bvh *hierarchy) {
    const bvh_level *level = &hierarchy->levels[hierarchy->tree_level];
    const size_t stride = (size_t)hierarchy->axis_count * 2 * LANES;
    double whole = 0.0, of_trees = 0.0;
    for (uint32_t block = 0; level->block_count > 1 && block < level->block_count; block++) {
        for (int k = 0; k < BOX_AXES; k++) {
            const float *low = level->bounds + block * stride + 2 * k * LANES, *high = low + LANES;
            float least = INFINITY, greatest = -INFINITY;
            for (int i = 0; i < LANES && (level->flags[block].used >> i & 1) != 0; i++) {
                least = fminf(least, low[i]);
                greatest = fmaxf(greatest, high[i]);
                of_trees += (double)(high[i] - low[i]);
            }
            whole += (double)(greatest - least);
        }
    }
    return of_trees > 0.0 ? whole / of_trees : 0.0;
}

static bvh_spread spread_of(const bvh *hierarchy) {
    extents sum = hierarchy->kernels->extents_at_start(hierarchy);
    return (bvh_spread){sum.triangles > 0.0 ? sum.leaves / sum.triangles : 0.0, spread_of_trees(hierarchy)};
}

static bool is_beyond(bvh_spread now, bvh_spread before, double factor) {
    return now.leaves > factor * before.leaves || now.trees > factor * before.trees;
}

static bool replace_trees(bvh_rebuild *r, bvh *hierarchy, const double *positions) {
    bvh built;
    if (build_trees(r, positions, &built) != CSCD_OK) return false;
    bvh_free(hierarchy);
    *hierarchy = built;
    r->rebuilt = true;
    return true;
}

static bool same_growth(const volume_growth *a, const volume_growth *b) {
    return a->distance == b->distance && a->of_objects == b->of_objects && a->beyond == b->beyond;
}

static cscd_status finish_kept(bvh_rebuild *r, const double *positions, bvh *out) {
    progress *asked = &r->mesh->context->progress;
    progress_outer outer = progress_enter(asked, stage_of_trees);
    cscd_status status = bvh_finish(&r->kept, r->regions, r->objects, r->active, positions);
    progress_leave(asked, outer);
    if (status != CSCD_OK) return status;
    *out = r->kept;
    r->kept = (bvh){0};
    return CSCD_OK;
}

/* Where nearly all trees have moved over, their spread is what it was. */
enum { MEASURED_SHARE = 8 };

static bool spread_is_known(const bvh_rebuild *r) {
    uint64_t missing = bvh_count_missing(&r->kept);
    return r->spread_when_built.leaves > 0.0 && missing * MEASURED_SHARE < r->mesh->triangle_count;
}

/* Trees that were loose when they moved over are as loose now: what they were at first goes on to count, unless it was
 * looser than what they are. */
static bvh_spread least_spread(bvh_spread now, bvh_spread before) {
    if (before.leaves > 0.0) now.leaves = fmin(now.leaves, before.leaves);
    if (before.trees > 0.0) now.trees = fmin(now.trees, before.trees);
    return now;
}

/* The first volumes are widened as for a step, so that the first spread can be compared with later ones. */
static cscd_status refit_or_build(bvh_rebuild *r, bvh *hierarchy, const double *x0, const double *x1,
                                  volume_growth growth, volume_growth step_growth) {
    if (r->mesh->triangle_count == 0) return CSCD_OK;
    if (hierarchy->mesh == NULL) {
        bool moved = r->kept.mesh != NULL, known = moved && spread_is_known(r);
        cscd_status status = moved ? finish_kept(r, x0, hierarchy) : build_trees(r, x0, hierarchy);
        if (status != CSCD_OK) return status;
        if (!known) {
            bvh_refit(hierarchy, x0, x1, step_growth);
            bvh_spread spread = spread_of(hierarchy);
            r->spread_when_built = moved ? least_spread(spread, r->spread_when_built) : spread;
            if (same_growth(&growth, &step_growth)) return CSCD_OK;
        }
    }
    bvh_refit(hierarchy, x0, x1, growth);
    return CSCD_OK;
}

cscd_status bvh_rebuild_move_to(bvh_rebuild *r, bvh *hierarchy, const double *positions, volume_growth growth,
                                volume_growth step_growth) {
    return refit_or_build(r, hierarchy, positions, positions, growth, step_growth);
}

/* Compares the trees, refitted as for a step, with what they were when they were built, and rebuilds them if they have
 * decayed. */
static void measure_trees(bvh_rebuild *r, bvh *hierarchy, const double *x0, const double *x1,
                          volume_growth step_growth) {
    bvh_spread spread = spread_of(hierarchy);
    r->intervals_unmeasured = 0;
    if (!is_beyond(spread, r->spread_when_built, decayed) || !replace_trees(r, hierarchy, x0)) return;
    bvh_refit(hierarchy, x0, x1, step_growth);
    r->spread_when_built = spread_of(hierarchy);
    if (is_beyond(spread, r->spread_when_built, of_use))
        r->useless_rebuilds = 0;
    else if (r->useless_rebuilds < USELESS_MAX)
        r->useless_rebuilds++;
}

cscd_status bvh_rebuild_move(bvh_rebuild *r, bvh *hierarchy, const double *x0, const double *x1,
                             volume_growth growth, volume_growth step_growth) {
    r->rebuilt = false;
    if (r->mesh->triangle_count == 0) return CSCD_OK;
    bool due = ++r->intervals_unmeasured >= (uint32_t)MEASURE_EVERY << r->useless_rebuilds;
    cscd_status status = refit_or_build(r, hierarchy, x0, x1, due ? step_growth : growth, step_growth);
    if (status != CSCD_OK || !due) return status;
    measure_trees(r, hierarchy, x0, x1, step_growth);
    if (!same_growth(&growth, &step_growth)) bvh_refit(hierarchy, x0, x1, growth);
    return CSCD_OK;
}
