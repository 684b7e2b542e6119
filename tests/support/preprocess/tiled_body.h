/* A body with its tiles, for tests of labellings. */
#pragma once

#include "preprocess/regions/labelling.h"
#include "tests/support/models/body_of.h"

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
