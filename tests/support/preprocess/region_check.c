/* Asserts the invariants of every division into regions. */
#include "tests/support/preprocess/region_check.h"
#include "preprocess/regions/tiles.h"
#include "tests/support/test.h"

#include <stdlib.h>

void check_regions(const cscd_mesh *mesh, const uint32_t *regions, uint32_t region_count) {
    uint32_t n = mesh->triangle_count, seen = 0;
    uint32_t *list = malloc(n * sizeof *list), *pieces = malloc(n * sizeof *list);
    uint32_t *scratch = malloc(n * sizeof *list), *components = malloc(n * sizeof *list);
    dual_graph graph;
    expect_ok(dual_graph_build(mesh, &graph));
    for (uint32_t t = 0; t < n; t++) {
        list[t] = t;
        assert_true(regions[t] <= seen && regions[t] < region_count);
        if (regions[t] == seen) components[seen++] = mesh->triangle_components[t];
        assert_int_equal(mesh->triangle_components[t], components[regions[t]]);
    }
    assert_int_equal(seen, region_count);
    assert_int_equal(dual_graph_pieces(&graph, list, n, regions, pieces, scratch), region_count);
    dual_graph_free(mesh, &graph);
    free(list);
    free(pieces);
    free(scratch);
    free(components);
}

cscd_mesh *body_mesh(const body *b, uint32_t thread_count) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = thread_count;
    cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    expect_ok(cscd_context_create(&options, &context));
    expect_ok(cscd_mesh_create(context, &desc, 1, &mesh));
    return mesh;
}

void body_mesh_destroy(cscd_mesh *mesh) {
    cscd_context *context = mesh->context;
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}
