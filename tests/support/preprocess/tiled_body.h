/* A body with its tiles, for tests of labellings; and the share of a mesh's area that its detector points see. */
#pragma once

#include "preprocess/regions/labelling.h"
#include "preprocess/regions/tiles.h"
#include "src/mesh/surface.h"
#include "tests/support/models/bodies.h"

/* A body of one component, its edges with random weights of up to their length, and its tiles. */
typedef struct tiled_body {
    body shape;
    cscd_mesh *mesh;
    dual_graph graph;
    double *weights;
    uint32_t *list, *tile_of, *scratch, tile_count;
    tile_surface surface;
    tile_component component;
    tile_graph g;
} tiled_body;

tiled_body *tiled_body_make(body_kind kind, uint32_t triangle_count);
void tiled_body_free(tiled_body *b);

/* ---- what detector points see -------------------------------------------------------------------------- */

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
