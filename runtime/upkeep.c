/* The detector's trees: built when they are first needed, moved, and built anew when they have decayed. */
#include "runtime/upkeep.h"

enum { LOOK_EVERY = 16 };

static const double decayed = 1.25;

/* As published, a patch of ICCD is any set of triangles: then all components are one part. */
static cscd_status build(const cscd_detector *d, const double *positions, forest *out) {
    int axis_count = d->options.volume == CSCD_VOLUME_KDOP14 ? KDOP_AXES : BOX_AXES;
    uint32_t *one_part = NULL;
    forest_regions regions = {d->culling.triangle_regions, d->culling.triangle_weights,
                              d->culling.region_count};
    if (d->options.method == CSCD_METHOD_ICCD_PUBLISHED) {
        one_part = context_allocate(d->context, d->mesh->triangle_count, sizeof *one_part);
        if (one_part == NULL) return CSCD_OUT_OF_MEMORY;
        regions = (forest_regions){one_part, d->culling.triangle_weights, 1};
    }
    cscd_status status = forest_build(d->mesh, regions, positions, axis_count, out);
    context_free(d->context, one_part);
    return status;
}

double upkeep_spread(const forest *f) {
    extents sum = f->kernels->extents_at_start(f);
    return sum.triangles > 0.0 ? sum.leaves / sum.triangles : 0.0;
}

/* What hangs on the order of the triangles goes with the old trees; without memory for new ones they stay. */
static bool rebuild(cscd_detector *d, const double *positions) {
    forest fresh;
    if (build(d, positions, &fresh) != CSCD_OK) return false;
    patches_free(d->context, &d->patches);
    forest_free(&d->forest);
    d->forest = fresh;
    d->rebuilt = true;
    return true;
}

cscd_status upkeep_move(cscd_detector *d, const double *x0, const double *x1, double distance) {
    if (d->forest.mesh == NULL) {
        cscd_status status = build(d, x0, &d->forest);
        if (status != CSCD_OK) return status;
    }
    forest_move(&d->forest, x0, x1, distance);
    if (x0 == x1 || d->intervals_moved++ % LOOK_EVERY != 0) return CSCD_OK;
    double spread = upkeep_spread(&d->forest);
    if (d->intervals_moved == 1) d->spread_when_built = spread;
    if (spread > decayed * d->spread_when_built && rebuild(d, x0)) {
        forest_move(&d->forest, x0, x1, distance);
        d->spread_when_built = upkeep_spread(&d->forest);
    }
    return CSCD_OK;
}
