/* A small scene with its intersection curves. */
#pragma once

#include "runtime/intersections/intersections.h"
#include "tests/support/intersections/grid_scene.h"

enum { TRACED_PAIRS_MAX = 32 * 32 };

typedef struct traced_scene {
    grid_scene scene;
    curve_joiner joiner;
    cscd_intersection pairs[TRACED_PAIRS_MAX];
    cscd_curves curves;
} traced_scene;

void traced_scene_make(grid_family family, uint64_t seed, traced_scene *out);
void traced_scene_free(traced_scene *t);
