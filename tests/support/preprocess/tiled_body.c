/* A body with its tiles, for tests of labellings; and the share of a mesh's area that its detector points see. */
#include "tests/support/preprocess/tiled_body.h"

#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>

tiled_body *tiled_body_make(body_kind kind, uint32_t triangle_count) {
    tiled_body *b = body_allocate(1, sizeof *b);
    b->shape = body_of(kind, triangle_count);
    b->mesh = body_mesh(&b->shape, 1);
    const uint32_t count = b->shape.triangle_count;
    expect_ok(dual_graph_build(b->mesh, &b->graph));
    b->weights = body_allocate(b->mesh->edge_count, sizeof *b->weights);
    for (uint32_t e = 0; e < b->mesh->edge_count; e++)
        b->weights[e] = surface_edge_length(b->mesh, b->shape.positions, e) * random_between(0.1, 1.0);
    b->list = body_allocate(count, sizeof *b->list);
    b->tile_of = body_allocate(count, sizeof *b->tile_of);
    b->scratch = body_allocate(count, sizeof *b->scratch);
    for (uint32_t t = 0; t < count; t++) b->list[t] = t;
    b->surface = (tile_surface){
        .mesh = b->mesh, .positions = b->shape.positions, .weights = b->weights, .graph = &b->graph};
    b->component = tiles_component(&b->surface, b->list, count);
    b->tile_count = tiles_number(&b->surface, &b->component, b->tile_of, b->scratch);
    expect_ok(tiles_create(&b->surface, &b->component, b->tile_of, b->tile_count, &b->g));
    return b;
}

void tiled_body_free(tiled_body *b) {
    tiles_destroy(&b->g);
    dual_graph_free(b->mesh, &b->graph);
    body_mesh_destroy(b->mesh);
    body_free(&b->shape);
    free(b->weights);
    free(b->list);
    free(b->tile_of);
    free(b->scratch);
    free(b);
}
