/* Bodies: components that parts join within an object, in the order of their objects; an object without triangles is one. */
#include "src/mesh/parts.h"
#include "tests/support/test.h"

static const uint32_t two_triangles[] = {0, 1, 2, 3, 4, 5}, wire[] = {0, 1};

/* Two triangles apart, two points, two triangles apart, a wire. */
static cscd_mesh *make_mesh(cscd_context **context) {
    const cscd_object_desc triangles = cscd_object_of_triangles(6, 2, two_triangles);
    const cscd_object_desc objects[] = {triangles, cscd_object_of_points(2), triangles,
                                        cscd_object_of_wires(2, 1, wire)};
    cscd_mesh *mesh = NULL;
    assert_int_equal(cscd_context_create(NULL, context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(*context, objects, 4, &mesh), CSCD_OK);
    assert_int_equal(mesh->component_count, 4);
    return mesh;
}

static void expect_bodies(const cscd_mesh *mesh, const uint32_t labels[4], const uint32_t components[4],
                          uint32_t count, const uint32_t *objects) {
    surface_bodies found;
    assert_true(bodies_find(mesh, labels, 2, &found));
    assert_int_equal(found.count, count);
    assert_memory_equal(found.components, components, 4 * sizeof *components);
    assert_memory_equal(found.objects, objects, count * sizeof *objects);
    bodies_free(mesh->context, &found);
}

TEST(parts_join_components_of_one_object) {
    cscd_context *context;
    cscd_mesh *mesh = make_mesh(&context);
    const uint32_t none = UINT32_MAX;
    expect_bodies(mesh, (uint32_t[]){0, 0, 0, 1}, (uint32_t[]){0, 0, 2, 3}, 5, (uint32_t[]){0, 1, 2, 2, 3});
    expect_bodies(mesh, (uint32_t[]){0, 1, 0, 1}, (uint32_t[]){0, 1, 3, 4}, 6,
                  (uint32_t[]){0, 0, 1, 2, 2, 3});
    expect_bodies(mesh, (uint32_t[]){none, none, 1, 1}, (uint32_t[]){0, 1, 3, 3}, 5,
                  (uint32_t[]){0, 0, 1, 2, 3});
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}
