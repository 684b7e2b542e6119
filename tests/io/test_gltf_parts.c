/* The parts of glTF files, which face of the file a triangle is, and which vertices primitives share. */
#include "src/io/growable.h"
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Meshes: 0 has a triangle, a point and a triangle that names a vertex twice before a third one; 1, "Arm", has one triangle;
 * 2 has points alone. */
static file_bytes parts_file(gltf_fixture *fixture, const char *nodes) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                        indices[] = {0, 1, 2, 3, 3, 0, 1, 2, 3};
    char rest[1500];
    *fixture = (gltf_fixture){0};
    gltf_fixture_array(fixture, 5126, "VEC3", 12, positions);
    gltf_fixture_array(fixture, 5121, "SCALAR", 9, indices);
    gltf_fixture_accessor(fixture,
                          "{\"bufferView\":1,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"}");
    snprintf(
        rest, sizeof rest,
        "\"nodes\":[%s],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0},{\"attributes\":{"
        "\"POSITION\":0},\"indices\":1}]},{\"name\":\"Arm\",\"primitives\":[{\"attributes\":{\"POSITION\":0},"
        "\"indices\":2}]},{\"name\":\"Dust\",\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0}]}]",
        nodes);
    return gltf_fixture_glb(fixture, rest);
}

static void check_names(const char *nodes, uint32_t count, const char *const *names) {
    gltf_fixture fixture;
    mesh_file mesh;
    io_error error;
    if (!mesh_check_read(parts_file(&fixture, nodes), &mesh, &error)) fail_msg("%s", error.text);
    assert_int_equal(mesh.parts.count, count);
    for (uint32_t i = 0; i < count; i++) assert_string_equal(mesh.parts.names[i], names[i]);
    mesh_file_free(&mesh);
    assert_int_equal(mesh.parts.count, 0);
}

TEST(calls_parts_by_their_nodes) {
    static const char *const plain[] = {"Body", "Arm", "node 2", "Hand/L"};
    check_names(
        "{\"name\":\"Body\",\"mesh\":0},{\"mesh\":1},{\"mesh\":0,\"name\":\"\"},{\"name\":\"Hand/L\",\"mesh\":1},{\"name\":"
        "\"Dust\",\"mesh\":2},{\"name\":\"Empty\"}",
        4, plain);
}

TEST(tells_equal_names_apart) {
    static const char *const names[] = {"Body",     "Body.001", "Body.001.001",
                                        "Body.003", "Body.002", "Body.004"};
    check_names(
        "{\"name\":\"Body\",\"mesh\":1},{\"name\":\"Body\",\"mesh\":1},{\"name\":\"Body.001\",\"mesh\":1},{\"name\":"
        "\"Body.003\",\"mesh\":1},{\"name\":\"Body\",\"mesh\":1},{\"name\":\"Body\",\"mesh\":1}",
        6, names);
}

/* Two nodes with mesh 0, and one with mesh 1 between them. */
TEST(numbers_the_faces_of_the_file) {
    static const uint32_t polygons[] = {0, 2, 3, 4, 6}, parts[] = {0, 0, 1, 2, 2};
    static const uint32_t triangles[] = {0, 1, 2, 1, 2, 3, 4, 5, 6, 8, 9, 10, 9, 10, 11};
    gltf_fixture fixture;
    mesh_file mesh;
    io_error error;
    const file_bytes file = parts_file(&fixture, "{\"mesh\":0},{\"mesh\":1},{\"mesh\":0},{\"mesh\":2}");
    if (!mesh_check_read(file, &mesh, &error)) fail_msg("%s", error.text);
    assert_int_equal(mesh.triangle_count, 5);
    assert_int_equal(mesh.polygon_count, 7);
    assert_memory_equal(mesh.triangles, triangles, sizeof triangles);
    for (uint32_t i = 0; i < 5; i++) assert_int_equal(mesh_file_polygon(&mesh, i), polygons[i]);
    assert_memory_equal(mesh.parts.of_triangle, parts, sizeof parts);
    assert_int_equal(mesh.repairs.dropped, 2);
    assert_int_equal(mesh.repairs.first_dropped, 1);
    assert_int_equal(mesh.repairs.skipped_primitives, 3);
    mesh_file_free(&mesh);
}

/* Two with the same positions but not the same targets, and one with others, which has indices. */
TEST(primitives_share_what_is_the_same_in_all) {
    static const double first[] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, other[] = {5, 0, 0, 6, 0, 0, 5, 1, 0},
                        moved[] = {0, 0, 1, 0, 0, 2, 0, 0, 3}, corners[] = {2, 0, 1};
    static const double expected[] = {0, 0, 1, 1, 0, 2, 0, 1, 3, 0, 0, 0, 1, 0,
                                      0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0};
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5, 8, 6, 7};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, first);
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, other);
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, moved);
    gltf_fixture_array(&fixture, 5121, "SCALAR", 3, corners);
    mesh_check_equal(gltf_fixture_glb(&fixture,
                                      "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"weights\":[1],\"primitives\":["
                                      "{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":2}]},"
                                      "{\"attributes\":{\"POSITION\":0},\"targets\":[{}]},"
                                      "{\"attributes\":{\"POSITION\":1},\"targets\":[{}],\"indices\":3}]}]"),
                     9, expected, 3, triangles);
}

/* ---- materials ----------------------------------------------------------------------------------------- */

/* Mesh 0 has primitives of material 2, of none, of points of material 4, and of material 0; mesh 1 of material 2, of a triangle that
 * names a vertex twice of material 4, and of material `last`. */
static file_bytes materials_file(gltf_fixture *fixture, const char *materials, int last) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                        indices[] = {0, 1, 2, 1, 2, 3, 3, 3, 1};
    char rest[2400];
    *fixture = (gltf_fixture){0};
    gltf_fixture_array(fixture, 5126, "VEC3", 12, positions);
    gltf_fixture_array(fixture, 5121, "SCALAR", 9, indices);
    gltf_fixture_accessor(fixture,
                          "{\"bufferView\":1,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"}");
    gltf_fixture_accessor(
        fixture,
        "{\"bufferView\":1,\"byteOffset\":6,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"}");
#define PRIMITIVE(more) "{\"attributes\":{\"POSITION\":0}," more "}"
    snprintf(
        rest, sizeof rest,
        "\"nodes\":[{\"name\":\"A\",\"mesh\":0},{\"name\":\"B\",\"mesh\":1}],%s\"meshes\":[{\"primitives\":[" PRIMITIVE("\"indices\":2,\"material\":2") "," PRIMITIVE("\"indices\":2") "," PRIMITIVE("\"mode\":0,\"material\":4") "," PRIMITIVE(
            "\"indices\":1,\"material\":0") "]},{\"primitives\":[" PRIMITIVE("\"indices\":2,\"material\":2") "," PRIMITIVE("\"indices\":3,\"material\":4") "," PRIMITIVE("\"indices\":2,\"material\":%d") "]}]",
        materials, last);
#undef PRIMITIVE
    return gltf_fixture_glb(fixture, rest);
}

#define MATERIALS                                                                                               \
    "\"materials\":[{\"name\":\"Steel\"},{\"name\":\"Unused\"},{\"name\":\"Red Skin #1\"},{},{\"name\":\"Seen " \
    "nowhere\"},{\"name\":\"Steel\"}],"

TEST(calls_parts_by_their_materials) {
    enum { N = NO_MESH_PART };
    gltf_fixture fixture;
    /* Mesh 0: one triangle each, but two of material 0, whose third names a vertex twice; then two of mesh 1. */
    const uint32_t own[] = {0, 0, 0, 0, 1, 1}, labels[] = {0, N, 1, 1, 0, 2};
    mesh_check_parts_by(materials_file(&fixture, MATERIALS, 3), MESH_PARTS_BY_MATERIAL,
                        (const char *const[]){"Red Skin #1", "Steel", "material 3", NULL}, labels, own);
    mesh_check_parts_by(materials_file(&fixture, MATERIALS, 5), MESH_PARTS_BY_MATERIAL,
                        (const char *const[]){"Red Skin #1", "Steel", "Steel.001", NULL}, labels, own);
    mesh_check_parts_by(materials_file(&fixture, MATERIALS, 3), MESH_PARTS_BY_OBJECT,
                        (const char *const[]){"A", "B", NULL}, own, own);
    mesh_check_parts_by(materials_file(&fixture, MATERIALS, 3), MESH_PARTS_BY_GROUP,
                        (const char *const[]){NULL}, NULL, own);
    const file_bytes plain = parts_file(&fixture, "{\"mesh\":0},{\"mesh\":1}");
    mesh_check_parts_by(plain, MESH_PARTS_BY_MATERIAL, (const char *const[]){NULL}, NULL,
                        (const uint32_t[]){0, 0, 1});
}

/* Where nobody asks for materials, nobody misses one. */
TEST(refuses_materials_that_are_not_there) {
    gltf_fixture fixture;
    mesh_file mesh;
    io_error error = {""};
    const file_bytes file = materials_file(&fixture, MATERIALS, 6);
    assert_true(mesh_check_read(file, &mesh, &error));
    mesh_file_free(&mesh);
    assert_false(mesh_check_read_parts(file, MESH_PARTS_BY_MATERIAL, &mesh, &error));
    if (strstr(error.text, "mesh 1, primitive 2: material is 6") == NULL) fail_msg("%s", error.text);
}

TEST(survives_failed_allocations) {
    gltf_fixture fixture;
    mesh_check_memory(parts_file(&fixture, "{\"mesh\":0},{\"mesh\":1},{\"mesh\":1}"), MESH_PARTS_BY_FILE);
    mesh_check_memory(materials_file(&fixture, MATERIALS, 3), MESH_PARTS_BY_MATERIAL);
}
