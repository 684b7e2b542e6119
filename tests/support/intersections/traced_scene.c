/* A small scene with its intersection curves, and with trees. */
#include "tests/support/intersections/traced_scene.h"

#include "tests/support/test.h"

#include <stdlib.h>

void traced_scene_make(grid_family family, uint64_t seed, traced_scene *out) {
    grid_scene_make(family, seed, &out->scene);
    out->joiner = (curve_joiner){.context = out->scene.context};
    size_t count = grid_scene_pairs(&out->scene, out->pairs);
    assert_int_equal(curve_joiner_run(&out->joiner, &out->scene.surface, out->pairs, count, &out->curves),
                     CSCD_OK);
}

void traced_scene_free(traced_scene *t) {
    curve_joiner_free(&t->joiner);
    grid_scene_free(&t->scene);
}

void grid_scene_trees(const grid_scene *s, int axis_count, bvh *out) {
    const cscd_mesh *mesh = s->mesh;
    double *weights = malloc(mesh->triangle_count * sizeof *weights);
    assert_non_null(weights);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        weights[t] = 1.0 / mesh->components[mesh->triangle_components[t]].triangle_count;
    bvh_regions regions = {mesh->triangle_components, weights, mesh->component_count};
    assert_int_equal(bvh_build(mesh, regions, s->positions, axis_count, out), CSCD_OK);
    bvh_refit(out, s->positions, s->positions, uniform_growth(0.0));
    free(weights);
}
