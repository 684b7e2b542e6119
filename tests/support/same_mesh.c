/* Meshes of changing scenes, and whether two meshes are the same, bit for bit. */
#include "tests/support/same_mesh.h"

#include "tests/support/test.h"

cscd_mesh *changing_scene_mesh(cscd_context *context, const changing_scene *s) {
    cscd_object_desc descs[CHANGING_OBJECTS_MAX];
    cscd_mesh *mesh = NULL;
    changing_scene_describe(s, descs);
    assert_int_equal(cscd_mesh_create(context, descs, s->object_count, &mesh), CSCD_OK);
    return mesh;
}

#define SAME_ARRAY(a, b, member, count)                                                                      \
    assert_memory_equal((a)->member, (b)->member, (count) * sizeof *(a)->member)

void check_same_mesh(const cscd_mesh *a, const cscd_mesh *b) {
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->edge_count, b->edge_count);
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_int_equal(a->component_count, b->component_count);
    assert_int_equal(a->object_count, b->object_count);
    size_t corners = (size_t)a->triangle_count * 3;
    SAME_ARRAY(a, b, triangles, a->triangle_count);
    SAME_ARRAY(a, b, edges, a->edge_count);
    SAME_ARRAY(a, b, triangle_edges, a->triangle_count);
    SAME_ARRAY(a, b, vertex_star_offsets, a->vertex_count + 1u);
    SAME_ARRAY(a, b, vertex_stars, corners);
    SAME_ARRAY(a, b, edge_star_offsets, a->edge_count + 1u);
    SAME_ARRAY(a, b, edge_stars, corners);
    SAME_ARRAY(a, b, triangle_components, a->triangle_count);
    SAME_ARRAY(a, b, components, a->component_count);
    SAME_ARRAY(a, b, objects, a->object_count);
    assert_true((a->obstacles == NULL) == (b->obstacles == NULL));
    if (a->obstacles != NULL) SAME_ARRAY(a, b, obstacles, a->component_count);
    assert_true(cscd_mesh_hash(a) == cscd_mesh_hash(b));
}
