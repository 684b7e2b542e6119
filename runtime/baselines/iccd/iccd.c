/* ICCD (Tang et al. 2009) as a stage of a step: it hides the pairs within patches that cannot touch themselves. */
#include "runtime/baselines/iccd/iccd.h"

#include "runtime/baselines/iccd/patch.h"

const culling_rules iccd_published_culling = {.skips_adjacent = true, .joins_components = true};

static void *create_patches(cscd_context *context) {
    return context_allocate(context, 1, sizeof(patches));
}

static void destroy_patches(cscd_context *context, void *state) {
    patches_free(context, state);
    context_free(context, state);
}

/* Patches belong to one BVH. When decayed trees have been replaced by another BVH, that one has no room for hidden
 * pairs yet. */
static cscd_status follow_bvh(patches *p, bvh *f) {
    if (p->tree.node_count > 0 && bvh_can_hide(f)) return CSCD_OK;
    patches_free(f->mesh->context, p);
    return patches_create(f->mesh, f, p);
}

static cscd_status hide_pairs(patches *p, bvh *f, const double *x0, const double *x1, bool published,
                              cscd_counters *counters) {
    cscd_status status = follow_bvh(p, f);
    if (status != CSCD_OK) return status;
    patches_seal(p, f->mesh, f, x0, x1, published);
    counters->contours = p->contours;
    counters->sealed = p->sealed;
    return CSCD_OK;
}

static cscd_status hide_corrected(void *state, bvh *f, const double *x0, const double *x1,
                                  cscd_counters *counters) {
    return hide_pairs(state, f, x0, x1, false, counters);
}

static cscd_status hide_as_published(void *state, bvh *f, const double *x0, const double *x1,
                                     cscd_counters *counters) {
    return hide_pairs(state, f, x0, x1, true, counters);
}

const pair_hider iccd_hider = {create_patches, destroy_patches, hide_corrected};
const pair_hider iccd_published_hider = {create_patches, destroy_patches, hide_as_published};
