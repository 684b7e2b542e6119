/* The detector's trees: built when they are first needed, moved, and built anew when they have decayed. */
#include "runtime/bvh/bvh_rebuild.h"

#include <math.h>

enum { LOOK_EVERY = 16, USELESS_MAX = 4 };

static const double decayed = 1.25, of_use = 1.1;

static cscd_status build(const cscd_detector *d, const double *positions, bvh *out) {
    int axis_count = d->options.volume == CSCD_VOLUME_KDOP14 ? KDOP_AXES : BOX_AXES;
    bvh_regions regions = {d->culling.triangle_regions, d->culling.triangle_weights, d->culling.region_count};
    return bvh_build(d->mesh, regions, positions, axis_count, out);
}

/* How far blocks of parts extend, as a multiple of their parts; 0: there is one block. */
static double spread_of_parts(const bvh *f) {
    const bvh_level *level = &f->levels[f->part_level];
    const size_t stride = (size_t)f->axis_count * 2 * LANES;
    double whole = 0.0, of_parts = 0.0;
    for (uint32_t block = 0; level->block_count > 1 && block < level->block_count; block++) {
        for (int k = 0; k < BOX_AXES; k++) {
            const float *low = level->bounds + block * stride + 2 * k * LANES, *high = low + LANES;
            float least = INFINITY, greatest = -INFINITY;
            for (int i = 0; i < LANES && (level->flags[block].used >> i & 1) != 0; i++) {
                least = fminf(least, low[i]);
                greatest = fmaxf(greatest, high[i]);
                of_parts += (double)(high[i] - low[i]);
            }
            whole += (double)(greatest - least);
        }
    }
    return of_parts > 0.0 ? whole / of_parts : 0.0;
}

static tree_spread spread_of(const bvh *f) {
    extents sum = f->kernels->extents_at_start(f);
    return (tree_spread){sum.triangles > 0.0 ? sum.leaves / sum.triangles : 0.0, spread_of_parts(f)};
}

static bool beyond(tree_spread now, tree_spread before, double factor) {
    return now.leaves > factor * before.leaves || now.parts > factor * before.parts;
}

/* Without memory for new trees the old ones stay. */
static bool rebuild(cscd_detector *d, const double *positions) {
    bvh fresh;
    if (build(d, positions, &fresh) != CSCD_OK) return false;
    bvh_free(&d->bvh);
    d->bvh = fresh;
    d->rebuilt = true;
    return true;
}

static cscd_status move(cscd_detector *d, const double *x0, const double *x1, double distance) {
    bool fresh = d->bvh.mesh == NULL;
    if (fresh) {
        cscd_status status = build(d, x0, &d->bvh);
        if (status != CSCD_OK) return status;
    }
    if (fresh) { /* judged by volumes as wide as those of steps */
        bvh_refit(&d->bvh, x0, x1, d->limit.distance);
        d->spread_when_built = spread_of(&d->bvh);
        if (distance == d->limit.distance) return CSCD_OK;
    }
    bvh_refit(&d->bvh, x0, x1, distance);
    return CSCD_OK;
}

cscd_status upkeep_move_to(cscd_detector *d, const double *positions, double distance) {
    return move(d, positions, positions, distance);
}

/* Compares the trees, moved as for a step, with what they were when they were built, and builds them anew if
 * need be. */
static void look(cscd_detector *d, const double *x0, const double *x1) {
    tree_spread spread = spread_of(&d->bvh);
    d->intervals_unlooked = 0;
    if (!beyond(spread, d->spread_when_built, decayed) || !rebuild(d, x0)) return;
    bvh_refit(&d->bvh, x0, x1, d->limit.distance);
    d->spread_when_built = spread_of(&d->bvh);
    if (beyond(spread, d->spread_when_built, of_use))
        d->useless_rebuilds = 0;
    else if (d->useless_rebuilds < USELESS_MAX)
        d->useless_rebuilds++;
}

cscd_status upkeep_move(cscd_detector *d, const double *x0, const double *x1, double distance) {
    bool due = ++d->intervals_unlooked >= (uint32_t)LOOK_EVERY << d->useless_rebuilds;
    cscd_status status = move(d, x0, x1, due ? d->limit.distance : distance);
    if (status != CSCD_OK || !due) return status;
    look(d, x0, x1);
    if (distance != d->limit.distance) bvh_refit(&d->bvh, x0, x1, distance);
    return CSCD_OK;
}
