/* The stages of a step that hide the pairs within patches that cannot touch themselves: ICCD (Tang et al. 2009), and normal cones
 * with star-shaped contours. */
#include "runtime/baselines/iccd/patch_hiders.h"

#include "runtime/baselines/iccd/patch.h"
#include "runtime/baselines/iccd/star.h"

static void *create_patches(cscd_context *context) {
    return context_allocate(context, 1, sizeof(patches));
}

static void destroy_patches(cscd_context *context, void *state) {
    patches_free(context, state);
    context_free(context, state);
}

/* Patches belong to one BVH. When decayed trees have been replaced by another BVH, that one has no room for hidden
 * pairs yet. */
static cscd_status follow_bvh(patches *p, bvh *hierarchy, const contour_test *test) {
    patch_tree tree;
    if (p->tree.node_count > 0 && bvh_can_hide(hierarchy)) return CSCD_OK;
    patches_free(hierarchy->mesh->context, p);
    if (!bvh_allow_hiding(hierarchy)) return CSCD_OUT_OF_MEMORY;
    const cscd_status status = patch_tree_build(hierarchy, test->leaf_height, &tree);
    return status == CSCD_OK ? patches_create(hierarchy->mesh, &tree, test, p) : status;
}

static cscd_status hide_patches(patches *p, const contour_test *test, bvh *hierarchy, const double *x0,
                                const double *x1, cscd_counters *counters) {
    cscd_status status = follow_bvh(p, hierarchy, test);
    if (status != CSCD_OK) return status;
    patches_seal(p, hierarchy->mesh, x0, x1, false);
    patch_tree_hide(&p->tree, p->passed, hierarchy);
    counters->contours = p->contours;
    counters->sealed = p->sealed;
    return CSCD_OK;
}

static cscd_status hide_by_sweeps(void *state, bvh *hierarchy, const double *x0, const double *x1,
                                  cscd_counters *counters) {
    return hide_patches(state, &sweep_test, hierarchy, x0, x1, counters);
}

static cscd_status hide_by_stars(void *state, bvh *hierarchy, const double *x0, const double *x1,
                                 cscd_counters *counters) {
    return hide_patches(state, &star_test, hierarchy, x0, x1, counters);
}

const pair_hider iccd_hider = {create_patches, destroy_patches, hide_by_sweeps};
const pair_hider cones_hider = {create_patches, destroy_patches, hide_by_stars};
