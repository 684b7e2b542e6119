/* A small scene with its intersection curves. */
#include "tests/support/intersections/traced_scene.h"

#include "tests/support/test.h"

void traced_scene_make(grid_family family, uint64_t seed, traced_scene *out) {
    grid_scene_make(family, seed, &out->scene);
    out->joiner = (curve_joiner){.context = out->scene.context};
    size_t count = grid_scene_pairs(&out->scene, out->pairs);
    expect_ok(curve_joiner_run(&out->joiner, &out->scene.surface, out->pairs, count, &out->curves));
}

void traced_scene_free(traced_scene *t) {
    curve_joiner_free(&t->joiner);
    grid_scene_free(&t->scene);
}
