/* glTF files that are wrong: each error says what and where, and no damage ends the program. */
#include "tests/support/io/file_damage.h"
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
static const double indices[] = {0, 1, 2, 0, 2, 3};
static const double joints[16] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
static const double weights[16] = {1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0, 0};
static const double identity[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/* Accessors: 0 positions, 1 indices, 2 joints, 3 weights, 4 matrices, 5 sparse, 6 the numbers 0 to 2, 7 without data. */
static gltf_fixture rich_fixture(void) {
    static const double places[] = {0, 2, 3}, times[] = {0, 1, 2};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 12, positions);
    gltf_fixture_array(&fixture, 5123, "SCALAR", 6, indices);
    gltf_fixture_array(&fixture, 5121, "VEC4", 16, joints);
    gltf_fixture_array(&fixture, 5126, "VEC4", 16, weights);
    gltf_fixture_array(&fixture, 5126, "MAT4", 32, identity);
    const int view = gltf_fixture_view(&fixture, 5121, 3, places);
    gltf_fixture_accessor(
        &fixture,
        "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":3,\"indices\":{"
        "\"bufferView\":%d,\"componentType\":5121},\"values\":{\"bufferView\":0}}}",
        view);
    gltf_fixture_array(&fixture, 5126, "SCALAR", 3, times);
    gltf_fixture_accessor(&fixture, "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}");
    return fixture;
}

#define RICH                                                                                                            \
    "\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0,\"skin\":0},{\"children\":[2],"                  \
    "\"rotation\":[0,0,0,1],\"mesh\":1},{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}],\"skins\":[{"                   \
    "\"joints\":[1,2],\"inverseBindMatrices\":4}],\"meshes\":[{\"weights\":[0.5],\"primitives\":[{\"attributes\":{"     \
    "\"POSITION\":0,\"JOINTS_0\":2,\"WEIGHTS_0\":3},\"indices\":1,\"targets\":[{\"POSITION\":5}]}]},{\"primitives\":[{" \
    "\"attributes\":{\"POSITION\":0},\"mode\":6}]}]"

/* The rich file with one text replaced is refused with these words. */
static void check_replaced(const char *text, const char *by, const char *found, const char *expected) {
    char rest[2048];
    const char *place = strstr(RICH, text);
    assert_non_null(place);
    snprintf(rest, sizeof rest, "%.*s%s%s", (int)(place - RICH), RICH, by, place + strlen(text));
    gltf_fixture fixture = rich_fixture();
    mesh_check_error(gltf_fixture_glb(&fixture, rest), ": ", found, expected);
}

TEST(refuses_wrong_nodes) {
    check_replaced("\"mesh\":1", "\"mesh\":2", "node 1: mesh is 2", "2 meshes, from 0");
    check_replaced("\"mesh\":1", "\"mesh\":-1", "node 1: mesh is -1", "expected 0 to");
    check_replaced("\"mesh\":1", "\"mesh\":0.5", "node 1: mesh is 0.5", "a whole number");
    check_replaced("\"mesh\":1", "\"mesh\":\"1\"", "node 1: mesh is 1", "a whole number");
    check_replaced("\"skin\":0", "\"skin\":1", "node 0: skin is 1", "1 skins");
    check_replaced("\"children\":[2]", "\"children\":[3]", "node 1: children[0] is 3", "3 nodes");
    check_replaced("\"children\":[2]", "\"children\":[2,2]", "node 1: children[1] is node 2",
                   "child of node 1");
    check_replaced("\"children\":[2]", "\"children\":[1]", "node 1 is its own ancestor", "circle");
    check_replaced("{\"matrix\"", "{\"children\":[1],\"matrix\"", "is its own ancestor", "circle");
    check_replaced("[0,0,0,1]", "[0,0,1]", "node 1: rotation has 3 numbers", "expected 4");
    check_replaced("[0,0,0,1]", "[0,0,0,null]", "node 1: rotation[3] is null", "finite");
    check_replaced("[0,0,0,1]", "[0,0,1e999,1]", "node 1: rotation[2] is", "finite");
    check_replaced("[0,0,0,1]", "1", "node 1: rotation is no array", "");
    check_replaced("\"nodes\":[0,1]", "\"nodes\":[0,7]", "scene 0: nodes[1] is 7", "3 nodes");
    check_replaced("\"scene\":0", "\"scene\":1", "scene is 1", "1 scenes");
    check_replaced("\"nodes\":[0,1]", "\"nodes\":[2]", "no triangles found", "default scene");
}

TEST(refuses_wrong_meshes) {
    check_replaced("\"POSITION\":0,", "", "mesh 0, primitive 0: POSITION is missing", "");
    check_replaced("\"POSITION\":0,", "\"POSITION\":1,", "accessor 1: type is SCALAR", "VEC3 for POSITION");
    check_replaced("\"POSITION\":0,", "\"POSITION\":9,", "primitive 0: POSITION is 9", "8 accessors");
    check_replaced("\"indices\":1", "\"indices\":6", "indices are no unsigned integers",
                   "mesh 0, primitive 0");
    check_replaced("\"mode\":6", "\"mode\":7", "primitive 0: mode is 7", "0 to 6");
    check_replaced("\"mode\":6", "\"mode\":4", "has 4 corners", "a multiple of 3");
    check_replaced("[{\"POSITION\":5}]", "[{\"POSITION\":4}]", "type is MAT4", "target 0");
    check_replaced("\"weights\":[0.5]", "\"weights\":[]", "mesh 0: weights has 0 numbers", "expected 1");
    check_replaced("\"WEIGHTS_0\":3", "\"WEIGHTS_0\":4", "accessor 4: type is MAT4", "VEC4 for WEIGHTS_0");
    check_replaced("\"JOINTS_0\":2", "\"JOINTS_0\":3", "JOINTS_0 are no unsigned integers", "mesh 0");
    check_replaced("\"joints\":[1,2]", "\"joints\":[1]", "names joint 1, but skin 0 has 1", "");
    check_replaced("\"joints\":[1,2]", "\"joints\":[1,2,1]", "skin 0: has 3 joints, but 2 inverse", "");
    check_replaced("\"joints\":[1,2]", "\"joints\":[]", "skin 0: has 0 joints", "");
    check_replaced("\"mode\":6", "\"mode\":6,\"targets\":[{}]},{\"attributes\":{\"POSITION\":0}",
                   "mesh 1, primitive 1: has 0 targets", "the first primitive has 1");
    check_replaced(
        "\"POSITION\":0},\"mode\":6",
        "\"POSITION\":7},\"mode\":6,\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0}}",
        "KHR_draco_mesh_compression, which is not read", "without compression");
}

TEST(refuses_wrong_numbers) {
    static const double far[] = {0, 1, 2, 0, 2, 4};
    static const double large[] = {0, 0, 0, 1e30, 0, 0, 1, 1, 0};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 12, positions);
    gltf_fixture_array(&fixture, 5125, "SCALAR", 6, far);
    mesh_check_error(
        gltf_fixture_glb(&fixture, "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                                   "\"POSITION\":0},\"indices\":1}]}]"),
        ": ", "mesh 0, primitive 0: index 5 is vertex 4", "4, from 0");
    gltf_fixture other = {0};
    gltf_fixture_array(&other, 5126, "VEC3", 9, large);
    mesh_check_error(
        gltf_fixture_glb(&other, "\"nodes\":[{\"mesh\":0,\"scale\":[1e300,1,1]}],\"meshes\":[{\"primitives\":"
                                 "[{\"attributes\":{\"POSITION\":0}}]}]"),
        ": ", "node 0, mesh 0: coordinate x of vertex 1 is inf", "a finite number");
}

/* The accessor and view of positions, as they are given. */
static void check_accessor(const char *accessor, const char *view, const char *found, const char *expected) {
    gltf_fixture fixture = {0};
    gltf_fixture_view(&fixture, 5126, 12, positions);
    snprintf(fixture.views, sizeof fixture.views, "%s", view);
    gltf_fixture_accessor(&fixture, "%s", accessor);
    mesh_check_error(
        gltf_fixture_glb(&fixture, "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                                   "\"POSITION\":0},\"mode\":6}]}]"),
        ": ", found, expected);
}

#define VIEW          "{\"buffer\":0,\"byteLength\":48}"
#define ACCESSOR(all) "{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\"," all "}"

TEST(refuses_accessors_out_of_bounds) {
    check_accessor(ACCESSOR("\"count\":5"), VIEW, "accessor 0: 5 elements end at byte 60", "48 bytes");
    check_accessor(ACCESSOR("\"count\":4,\"byteOffset\":1"), VIEW, "4 elements end at byte 49", "48 bytes");
    check_accessor(ACCESSOR("\"count\":4,\"byteOffset\":9007199254740992"), VIEW, "4 elements end at byte",
                   "48 bytes");
    check_accessor(ACCESSOR("\"count\":4,\"byteOffset\":9007199254740993"), VIEW, "accessor 0: byteOffset is",
                   "expected 0 to");
    check_accessor(ACCESSOR("\"count\":2147483647"), VIEW, "2147483647 elements end at byte", "48 bytes");
    check_accessor(ACCESSOR("\"count\":2147483648"), VIEW, "count is 2147483648", "1 to 2147483647");
    check_accessor(ACCESSOR("\"count\":0"), VIEW, "count is 0", "1 to 2147483647");
    check_accessor(ACCESSOR("\"count\":1e300"), VIEW, "count is 1e", "whole number");
    check_accessor(ACCESSOR("\"count\":4"), "{\"buffer\":0,\"byteLength\":49}",
                   "buffer view 0: byteOffset 0 and byteLength 49", "48 bytes of buffer 0");
    check_accessor(ACCESSOR("\"count\":4"),
                   "{\"buffer\":0,\"byteLength\":48,\"byteOffset\":9007199254740992}",
                   "buffer view 0: byteOffset 9007199254740992", "48 bytes of buffer 0");
    check_accessor(ACCESSOR("\"count\":4"), "{\"buffer\":1,\"byteLength\":48}", "buffer view 0: buffer is 1",
                   "1 buffers");
    check_accessor(ACCESSOR("\"count\":4"), "{\"byteLength\":48}", "buffer view 0: buffer is missing", "");
    check_accessor(ACCESSOR("\"count\":4"), "{\"buffer\":0}", "byteLength is missing", "");
    check_accessor(ACCESSOR("\"count\":2"), "{\"buffer\":0,\"byteLength\":48,\"byteStride\":4}",
                   "byteStride 4 is shorter", "12 bytes");
    check_accessor(ACCESSOR("\"count\":3"), "{\"buffer\":0,\"byteLength\":48,\"byteStride\":20}",
                   "3 elements end at byte 52", "48 bytes");
    check_accessor("{\"bufferView\":1,\"componentType\":5126,\"type\":\"VEC3\",\"count\":4}", VIEW,
                   "bufferView is 1", "1 buffer views");
    check_accessor("{\"bufferView\":0,\"componentType\":5124,\"type\":\"VEC3\",\"count\":4}", VIEW,
                   "componentType is 5124", "5120 to 5123, 5125 or 5126");
    check_accessor("{\"bufferView\":0,\"type\":\"VEC3\",\"count\":4}", VIEW, "componentType is missing", "");
    check_accessor("{\"bufferView\":0,\"componentType\":5126,\"count\":4}", VIEW, "type is missing", "VEC3");
}

/* There are 36 bytes, and the buffer is said to have 24. */
TEST(refuses_what_lies_behind_the_buffer) {
    mesh_check_error(
        FILE_OF("mesh.gltf",
                "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":24,\"uri\":"
                "\"data:;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA\"}],"
                "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
                "\"componentType\":5126,\"type\":\"VEC3\",\"count\":3}],\"nodes\":[{\"mesh\":0}],"
                "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}"),
        ": ", "byteLength 36 reach beyond the 24 bytes of buffer 0", "");
}

/* Elements without data are zeros: of vertices, of sparse ones, and of indices. */
TEST(refuses_more_zeros_than_bytes) {
    check_accessor("{\"componentType\":5126,\"type\":\"VEC3\",\"count\":2147483647}", VIEW,
                   "accessor 0: has 2147483647 elements without a bufferView", "the bytes of the file");
    check_accessor("{\"componentType\":5126,\"type\":\"VEC3\",\"count\":10000}", VIEW,
                   "accessor 0: has 10000 elements without a bufferView", "the bytes of the file");
    check_accessor("{\"componentType\":5126,\"type\":\"VEC3\",\"count\":2147483646,\"sparse\":{\"count\":1,"
                   "\"indices\":{\"bufferView\":0,\"componentType\":5125},\"values\":{\"bufferView\":0}}}",
                   VIEW, "accessor 0: has 2147483646 elements without a bufferView", "the bytes of the file");
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 12, positions);
    gltf_fixture_accessor(&fixture, "{\"componentType\":5125,\"type\":\"SCALAR\",\"count\":2100000000}");
    mesh_check_error(
        gltf_fixture_glb(&fixture, "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                                   "\"POSITION\":0},\"indices\":1}]}]"),
        ": ", "accessor 1: has 2100000000 elements without a bufferView", "the bytes of the file");
}

TEST(refuses_sparse_indices_that_do_not_rise) {
    static const double cases[][2] = {{2, 2}, {2, 1}, {0, 4}};
    for (size_t i = 0; i < 3; i++) {
        gltf_fixture fixture = {0};
        gltf_fixture_view(&fixture, 5123, 2, cases[i]);
        gltf_fixture_view(&fixture, 5126, 6, positions);
        gltf_fixture_accessor(
            &fixture,
            "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":2,\"indices\":{"
            "\"bufferView\":0,\"componentType\":5123},\"values\":{\"bufferView\":1}}}");
        mesh_check_error(
            gltf_fixture_glb(&fixture,
                             "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                             "\"POSITION\":0},\"mode\":6}]}]"),
            ": ", "accessor 0: sparse index 1 is", i < 2 ? "rising" : "4 elements");
    }
}

/* ---- containers -------------------------------------------------------------------------------------- */

TEST(refuses_wrong_containers) {
    gltf_fixture fixture = rich_fixture();
    file_bytes file = gltf_fixture_glb(&fixture, RICH);
    char *bytes = fixture.file;
    mesh_check_error((file_bytes){"mesh.glb", bytes, 11}, ": ", "ends after 11 bytes", "header");
    mesh_check_error((file_bytes){"mesh.glb", bytes, file.size - 1}, ": ", "cut off", "");
    bytes[4] = 1;
    mesh_check_error(file, ": ", "version 1", "expected 2");
    bytes[4] = 2;
    bytes[12]++;
    mesh_check_error(file, ": ", "", "");
    bytes[12]--;
    bytes[14] = 127;
    mesh_check_error(file, ": byte 12: ", "a chunk of", "cut off");
    bytes[14] = 0;
    bytes[16] = 'X';
    mesh_check_error(file, ": byte 12: ", "first chunk is not the JSON", "");
    bytes[16] = 'J';
    bytes[20] = '}';
    mesh_check_error(file, ": byte ", "no valid JSON", "");
    mesh_check_error(FILE_OF("mesh.gltf", "{\n\"asset\":{\"version\":}}"), ":2: ", "no valid JSON", "");
    mesh_check_error(FILE_OF("mesh.gltf", "{\n\"asset\":"), ":2: ", "no valid JSON", "ends too early");
    mesh_check_error(FILE_OF("mesh.gltf", "[1]"), ": ", "no object", "");
}

/* Each object would take a thousand bytes of memory. */
TEST(refuses_nothing_but_objects) {
    char text[8000] = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}";
    for (int i = 0; i < 2000; i++) strcat(text, ",{}");
    strcat(text, "]}");
    mesh_check_error((file_bytes){"mesh.gltf", text, strlen(text)}, ": ",
                     "more objects than one in ten bytes", "a glTF file");
}

TEST(refuses_other_versions_and_extensions) {
#define ASSET(version) FILE_OF("mesh.gltf", "{\"asset\":{" version "}}")
    mesh_check_error(ASSET("\"version\":\"1.0\""), ": ", "version 1.0", "expected 2.0");
    mesh_check_error(ASSET("\"version\":\"2.1\",\"minVersion\":\"2.1\""), ": ", "needs a reader of glTF 2.1",
                     "2.0");
    mesh_check_error(ASSET(""), ": ", "asset.version is missing", "2.0");
    static const char *const refused[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                          "ACME_fur"};
    for (size_t i = 0; i < 3; i++) {
        char extension[128], rest[1200];
        snprintf(extension, sizeof extension, "requires the extension %s", refused[i]);
        snprintf(rest, sizeof rest, "\"extensionsRequired\":[\"KHR_materials_unlit\",\"%s\"]," RICH,
                 refused[i]);
        gltf_fixture fixture = rich_fixture();
        mesh_check_error(gltf_fixture_glb(&fixture, rest), ": ", extension, "not read");
    }
}

TEST(survives_damage) {
    gltf_fixture fixture = rich_fixture();
    const file_bytes file = gltf_fixture_glb(&fixture, RICH);
    const file_damage_counts counts = file_damage_rounds(file, 4000, 1);
    assert_true(counts.read > 400 && counts.refused > 400);
}
