/* Trees as method SINGLE has them, at one moment. */
#include "tests/support/bvh/mesh_trees.h"

#include "tests/support/test.h"

#include <stdlib.h>

void mesh_trees_build(const cscd_mesh *mesh, const double *positions, int axis_count, bvh *out) {
    double *weights = malloc(mesh->triangle_count * sizeof *weights);
    assert_non_null(weights);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        weights[t] = 1.0 / mesh->components[mesh->triangle_components[t]].triangle_count;
    bvh_regions regions = {mesh->triangle_components, weights, mesh->component_count};
    assert_int_equal(bvh_build(mesh, regions, positions, axis_count, out), CSCD_OK);
    bvh_refit(out, positions, positions, uniform_growth(0.0));
    free(weights);
}
