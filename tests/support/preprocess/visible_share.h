/* The share of a mesh's area that its detector points see, for tests of regions. */
#pragma once

#include "preprocess/regions/tiles.h"
#include "src/mesh/surface.h"

/* `points` has one detector point per region. */
static inline double visible_share(const cscd_mesh *mesh, const double *positions, const uint32_t *regions,
                                   const double *points) {
    double visible = 0.0, whole = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        double area = surface_area(mesh, positions, t);
        whole += area;
        if (orientation_value(mesh, positions, t, points + (size_t)regions[t] * 3) > 0.0) visible += area;
    }
    return whole > 0.0 ? visible / whole : 0.0;
}
