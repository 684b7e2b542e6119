/* glTF files at rest: containers, accessors of all types, primitives, and the tree of nodes, with numbers by hand. */
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MESH(primitive) "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{" primitive "}]}]"

static const double square_positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
static const double square_indices[] = {0, 1, 2, 0, 2, 3};

/* Accessor 0 is positions, accessor 1 indices. */
static gltf_fixture square_fixture(int index_component) {
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 12, square_positions);
    gltf_fixture_array(&fixture, index_component, "SCALAR", 6, square_indices);
    return fixture;
}

#define SQUARE_MESH MESH("\"attributes\":{\"POSITION\":0},\"indices\":1")

TEST(reads_all_containers) {
    gltf_fixture fixture = square_fixture(5123);
    mesh_check_square(gltf_fixture_glb(&fixture, SQUARE_MESH));
    mesh_check_square(gltf_fixture_embedded(&fixture, SQUARE_MESH));
    for (size_t i = 0; i < 4; i++) { /* every length of padding */
        fixture.bytes[fixture.size++] = 7;
        mesh_check_square(gltf_fixture_embedded(&fixture, SQUARE_MESH));
    }
}

static bool read_beside(const char *uri, const char *name, mesh_file *mesh, io_error *error) {
    gltf_fixture fixture = square_fixture(5123);
    temp_folder folder = temp_folder_make();
    temp_file_write(&folder, name, fixture.bytes, fixture.size);
    file_bytes file = gltf_fixture_separate(&fixture, SQUARE_MESH, uri);
    temp_path path = temp_file_write(&folder, file.name, file.bytes, file.size);
    bool done = mesh_file_read(path.text, mesh, error);
    temp_folder_remove(&folder);
    return done;
}

TEST(reads_buffers_beside_the_file) {
    static const char *const names[][2] = {
        {"mesh.bin", "mesh.bin"}, {"my%20mesh%2b.bin", "my mesh+.bin"}, {"%C3%A4.bin", "\xc3\xa4.bin"}};
    for (size_t i = 0; i < 3; i++) {
        mesh_file mesh;
        io_error error = {""};
        if (!read_beside(names[i][0], names[i][1], &mesh, &error)) fail_msg("%s", error.text);
        assert_int_equal(mesh.vertex_count, 4);
        assert_int_equal(mesh.triangle_count, 2);
        mesh_file_free(&mesh);
    }
}

TEST(refuses_buffers_that_are_not_there) {
    static const char *const cases[][2] = {{"other.bin", "cannot open"},
                                           {"my%2.bin", "percent sign"},
                                           {"my%00.bin", "percent sign"},
                                           {"https://example.org/mesh.bin", "expected a file in the folder"},
                                           {"/mesh.bin", "expected a file"},
                                           {"../mesh.bin", "in the folder of the glTF file or below"},
                                           {"a/%2e%2E/mesh.bin", "or below"},
                                           {"..%5cmesh.bin", "or below"},
                                           {"data:,AAAA", "expected base64"},
                                           {"data:;base64", "without a comma"},
                                           {"data:;base64,AA*A", "no base64 at character 2"},
                                           {"data:;base64,AAAA", "cut off"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mesh_file mesh;
        io_error error = {""};
        assert_false(read_beside(cases[i][0], "mesh.bin", &mesh, &error));
        if (strstr(error.text, cases[i][1]) == NULL || strstr(error.text, "buffer 0: ") == NULL)
            fail_msg("no '%s' in '%s'", cases[i][1], error.text);
    }
}

/* ---- accessors --------------------------------------------------------------------------------------- */

TEST(reads_all_types_of_indices) {
    static const int components[] = {5121, 5123, 5125};
    for (size_t i = 0; i < 3; i++) {
        gltf_fixture fixture = square_fixture(components[i]);
        mesh_check_square(gltf_fixture_glb(&fixture, SQUARE_MESH));
    }
}

/* Positions may be integers, which stand for themselves or, normalised, for -1 to 1 or 0 to 1. */
TEST(reads_all_types_of_positions) {
    static const struct {
        int component;
        double numbers[9], normalised[9];
    } cases[] = {
        {5120, {0, 127, -128, 1, 0, 0, -127, 2, 3}, {0, 1, -1, 1. / 127, 0, 0, -1, 2. / 127, 3. / 127}},
        {5121,
         {0, 255, 51, 1, 0, 0, 9, 2, 3},
         {0, 1, 51. / 255, 1. / 255, 0, 0, 9. / 255, 2. / 255, 3. / 255}},
        {5122,
         {0, 32767, -32768, 1, 0, 0, 9, -32767, 3},
         {0, 1, -1, 1. / 32767, 0, 0, 9. / 32767, -1, 3. / 32767}},
        {5123,
         {0, 65535, 13107, 1, 0, 0, 9, 2, 3},
         {0, 1, 13107. / 65535, 1. / 65535, 0, 0, 9. / 65535, 2. / 65535, 3. / 65535}},
    };
    static const uint32_t triangle[] = {0, 1, 2};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int normalised = 0; normalised < 2; normalised++) {
            gltf_fixture fixture = {0};
            const int view = gltf_fixture_view(&fixture, cases[i].component, 9, cases[i].numbers);
            gltf_fixture_accessor(
                &fixture,
                "{\"bufferView\":%d,\"componentType\":%d,\"count\":3,\"type\":\"VEC3\",\"normalized\":%s}",
                view, cases[i].component, normalised ? "true" : "false");
            mesh_check_equal(
                gltf_fixture_glb(&fixture, "\"extensionsRequired\":[\"KHR_mesh_quantization\"]," MESH(
                                               "\"attributes\":{\"POSITION\":0}")),
                3, normalised ? cases[i].normalised : cases[i].numbers, 1, triangle);
        }
}

/* Data that are compressed and, for readers without that extension, also not compressed. */
TEST(reads_what_compressed_files_have_besides) {
    gltf_fixture fixture = square_fixture(5123);
    mesh_check_square(gltf_fixture_glb(
        &fixture,
        "\"extensionsUsed\":[\"KHR_draco_mesh_compression\"]," MESH(
            "\"attributes\":{\"POSITION\":0},\"indices\":1,\"extensions\":{\"KHR_draco_mesh_compression\":{}}")));
}

/* Each vertex has a normal behind its position, and the view begins four bytes before. */
TEST(reads_interleaved_elements) {
    static const double numbers[] = {9, 0, 0, 0, 5, 5, 5, 1, 0, 0, 5, 5, 5, 0, 2, 0, 5, 5, 5};
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 2, 0};
    static const uint32_t triangle[] = {0, 1, 2};
    gltf_fixture fixture = {0};
    gltf_fixture_view(&fixture, 5126, 19, numbers);
    snprintf(fixture.views, sizeof fixture.views, "{\"buffer\":0,\"byteLength\":%zu,\"byteStride\":24}",
             fixture.size);
    gltf_fixture_accessor(
        &fixture, "{\"bufferView\":0,\"byteOffset\":4,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}");
    mesh_check_equal(gltf_fixture_glb(&fixture, MESH("\"attributes\":{\"POSITION\":0}")), 3, positions, 1,
                     triangle);
}

TEST(reads_sparse_accessors) {
    static const double values[] = {1, 0, 0, 0, 1, 0}, base[] = {9, 9, 9, 3, 3, 3, 8, 8, 8};
    static const double places[] = {0, 2};
    static const double on_zeros[] = {1, 0, 0, 0, 0, 0, 0, 1, 0}, on_base[] = {1, 0, 0, 3, 3, 3, 0, 1, 0};
    static const uint32_t triangle[] = {0, 1, 2};
    static const int components[] = {5121, 5123, 5125};
    for (size_t i = 0; i < 3; i++)
        for (int based = 0; based < 2; based++) {
            gltf_fixture fixture = {0};
            gltf_fixture_view(&fixture, components[i], 2, places);
            gltf_fixture_view(&fixture, 5126, 6, values);
            gltf_fixture_view(&fixture, 5126, 9, base);
            gltf_fixture_accessor(
                &fixture,
                "{%s\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":2,"
                "\"indices\":{\"bufferView\":0,\"componentType\":%d},\"values\":{\"bufferView\":1}}}",
                based ? "\"bufferView\":2," : "", components[i]);
            mesh_check_equal(gltf_fixture_glb(&fixture, MESH("\"attributes\":{\"POSITION\":0}")), 3,
                             based ? on_base : on_zeros, 1, triangle);
        }
}

TEST(reads_accessors_without_data_as_zeros) {
    static const double zeros[9];
    static const uint32_t triangle[] = {0, 1, 2};
    gltf_fixture fixture = {0};
    gltf_fixture_view(&fixture, 5121, 1, zeros);
    gltf_fixture_accessor(&fixture, "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}");
    mesh_check_equal(gltf_fixture_glb(&fixture, MESH("\"attributes\":{\"POSITION\":0}")), 3, zeros, 1,
                     triangle);
}

/* ---- primitives -------------------------------------------------------------------------------------- */

static void check_triangles(const char *primitive, uint32_t triangle_count, const uint32_t *triangles) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0};
    static const double indices[] = {0, 1, 2, 2, 2, 3, 5};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 18, positions);
    gltf_fixture_array(&fixture, 5121, "SCALAR", 7, indices);
    mesh_check_equal(gltf_fixture_glb(&fixture, primitive), 6, positions, triangle_count, triangles);
}

TEST(reads_triangles_strips_and_fans) {
    static const uint32_t list[] = {0, 1, 2, 3, 4, 5};
    static const uint32_t strip[] = {0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4};
    static const uint32_t fan[] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5};
    /* 0 1 2, 1 2 2, 2 2 2, 2 3 2, 2 3 5: the first and the last have three corners; the last is number 4, so not turned. */
    static const uint32_t sewn_strip[] = {0, 1, 2, 2, 3, 5};
    check_triangles(MESH("\"attributes\":{\"POSITION\":0}"), 2, list);
    check_triangles(MESH("\"attributes\":{\"POSITION\":0},\"mode\":5"), 4, strip);
    check_triangles(MESH("\"attributes\":{\"POSITION\":0},\"mode\":6"), 4, fan);
    check_triangles(MESH("\"attributes\":{\"POSITION\":0},\"mode\":5,\"indices\":1"), 2, sewn_strip);
}

/* Primitives of one set of vertices share it; points and lines are passed over. */
TEST(reads_several_primitives) {
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5, 0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5};
    check_triangles(
        "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0},"
        "{\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":0},\"mode\":3},"
        "{\"attributes\":{\"POSITION\":0},\"mode\":6}]}]",
        6, triangles);
}

/* ---- nodes ------------------------------------------------------------------------------------------- */

#define ONE_TRIANGLE "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]"

static void check_nodes(const char *rest, uint32_t instance_count, const double *positions,
                        const uint32_t *triangles) {
    static const double own[] = {0, 0, 0, 1, 0, 0, 0, 2, 0};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, own);
    mesh_check_equal(gltf_fixture_glb(&fixture, rest), 3 * instance_count, positions, instance_count,
                     triangles);
}

TEST(places_nodes_in_their_tree) {
    static const uint32_t once[] = {0, 1, 2}, twice[] = {0, 1, 2, 3, 4, 5}, mirrored[] = {0, 2, 1};
    /* Scaled by 2, turned by 90 degrees around z (x becomes y, y becomes -x), and moved. */
    static const double placed[] = {10, 20, 30, 10, 22, 30, 6, 20, 30};
    check_nodes(
        "\"nodes\":[{\"mesh\":0,\"scale\":[2,2,2],\"rotation\":[0,0,3,3],\"translation\":[10,20,30]}]," ONE_TRIANGLE,
        1, placed, once);
    /* The same by a matrix, column by column, and by a parent. */
    check_nodes("\"nodes\":[{\"mesh\":0,\"matrix\":[0,2,0,0,-2,0,0,0,0,0,2,0,10,20,30,1]}]," ONE_TRIANGLE, 1,
                placed, once);
    check_nodes(
        "\"nodes\":[{\"mesh\":0,\"rotation\":[0,0,3,3]},{\"children\":[2]},{\"children\":[0],\"scale\":[2,2,2],"
        "\"translation\":[10,20,30]}]," ONE_TRIANGLE,
        1, placed, once);
    static const double flipped[] = {0, 0, 0, -1, 0, 0, 0, 2, 0}, plain[] = {0, 0, 0, 1, 0, 0, 0, 2, 0};
    check_nodes("\"nodes\":[{\"mesh\":0,\"scale\":[-1,1,1]}]," ONE_TRIANGLE, 1, flipped, mirrored);
    check_nodes("\"nodes\":[{\"mesh\":0,\"scale\":[1,1,-1]}]," ONE_TRIANGLE, 1, plain, mirrored);
    static const double both[] = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 5, 1, 0, 5, 0, 2, 5};
    check_nodes("\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,5]}]," ONE_TRIANGLE, 2, both,
                twice);
}

TEST(shows_the_default_scene) {
    static const uint32_t once[] = {0, 1, 2};
    static const double behind[] = {0, 0, 5, 1, 0, 5, 0, 2, 5};
#define TWO_NODES "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,5]}]," ONE_TRIANGLE
    check_nodes("\"scene\":1,\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}]," TWO_NODES, 1, behind, once);
    check_nodes("\"scenes\":[{\"nodes\":[1,1]},{\"nodes\":[0]}]," TWO_NODES, 1, behind, once);
    /* A child that the scene names before its parent, which has another one. */
    static const uint32_t twice[] = {0, 1, 2, 3, 4, 5};
    static const double both[] = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 5, 1, 0, 5, 0, 2, 5};
    check_nodes("\"scenes\":[{\"nodes\":[1,0,2]}],\"nodes\":[{\"children\":[1,2]},{\"mesh\":0},{\"mesh\":0,"
                "\"translation\":[0,0,5]}]," ONE_TRIANGLE,
                2, both, twice);
}

/* ---- targets and skins ------------------------------------------------------------------------------- */

/* Two targets: one moves vertex 1 by 4 along z, the other moves all by 1 along x. */
static void check_weights(const char *node, const char *mesh, double first, double second) {
    static const double base[] = {0, 0, 0, 1, 0, 0, 0, 2, 0}, z[] = {0, 0, 0, 0, 0, 4, 0, 0, 0};
    static const double x[] = {1, 0, 0, 1, 0, 0, 1, 0, 0};
    static const uint32_t triangle[] = {0, 1, 2};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, base);
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, z);
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, x);
    char rest[512];
    snprintf(
        rest, sizeof rest,
        "\"nodes\":[{\"mesh\":0%s}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":["
        "{\"POSITION\":1},{\"POSITION\":2},{\"NORMAL\":1}]}]%s}]",
        node, mesh);
    const double expected[] = {second, 0, 0, 1 + second, 0, 4 * first, second, 2, 0};
    mesh_check_equal(gltf_fixture_glb(&fixture, rest), 3, expected, 1, triangle);
}

TEST(adds_morph_targets) {
    check_weights("", "", 0, 0);
    check_weights("", ",\"weights\":[0.5,0.25,1]", 0.5, 0.25);
    check_weights(",\"weights\":[0.75,-1,7]", ",\"weights\":[0.5,0.25,1]", 0.75, -1);
}

/* Three vertices at x = 0, 1 and 2. Joint 0 rests at the origin and stands at z = 10, joint 1 rests at x = 1 and is scaled by 3
 * there. Vertex 0 follows joint 0, vertex 1 both by halves, vertex 2 a quarter and three quarters. */
static void add_weights(gltf_fixture *fixture, int component, const double weights[12]) {
    const int view = gltf_fixture_view(fixture, component, 12, weights);
    gltf_fixture_accessor(
        fixture, "{\"bufferView\":%d,\"componentType\":%d,\"count\":3,\"type\":\"VEC4\",\"normalized\":%s}",
        view, component, component == 5126 ? "false" : "true");
}

/* two_sets: the second weight of each vertex is the first one of another set. */
static void check_skin(int weight_component, const double *weights, bool two_sets) {
    static const double positions[] = {0, 0, 0, 1, 1, 0, 2, 0, 0};
    static const double joints[] = {0, 9, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
    static const double inverse_bind[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                          1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
    double first[12], later[12] = {0}, later_joints[12] = {0};
    memcpy(first, weights, sizeof first);
    for (int i = 0; i < 12 && two_sets; i += 4) {
        later_joints[i] = joints[i + 1];
        later[i] = first[i + 1];
        first[i + 1] = 0;
    }
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, positions);
    gltf_fixture_array(&fixture, 5121, "VEC4", 12, joints);
    add_weights(&fixture, weight_component, first);
    gltf_fixture_array(&fixture, 5126, "MAT4", 32, inverse_bind);
    gltf_fixture_array(&fixture, 5123, "VEC4", 12, later_joints);
    add_weights(&fixture, weight_component, later);
    char rest[1024];
    snprintf(
        rest, sizeof rest,
        "\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[50,50,50]},{\"translation\":[0,0,10]},"
        "{\"translation\":[1,0,0],\"scale\":[3,3,3]}],\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":3}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2%s}}]}]",
        two_sets ? ",\"JOINTS_1\":4,\"WEIGHTS_1\":5" : "");
    /* Joint 0: (0 0 10), (1 1 10), (2 0 10). Joint 1: (-2 0 0), (1 3 0), (4 0 0). */
    static const double expected[] = {0, 0, 10, 1, 2, 5, 3.5, 0, 2.5};
    mesh_file mesh = {0};
    io_error error = {""};
    if (!mesh_check_read(gltf_fixture_glb(&fixture, rest), &mesh, &error)) fail_msg("%s", error.text);
    assert_memory_equal(mesh.triangles, ((const uint32_t[]){0, 1, 2}), 3 * sizeof(uint32_t));
    for (int i = 0; i < 9; i++)
        if (!(fabs(mesh.positions[i] - expected[i]) < 1e-14)) fail_msg("%d: %.17g", i, mesh.positions[i]);
    mesh_file_free(&mesh);
}

TEST(moves_skins_by_their_joints) {
    static const double floats[] = {1, 0, 0, 0, 0.5, 0.5, 0, 0, 0.75, 0.25, 0, 0};
    static const double doubled[] = {2, 0, 0, 0, 1, 1, 0, 0, 1.5, 0.5, 0, 0};
    static const double bytes[] = {255, 0, 0, 0, 100, 100, 0, 0, 150, 50, 0, 0};
    for (int two_sets = 0; two_sets < 2; two_sets++) {
        check_skin(5126, floats, two_sets);
        check_skin(5126, doubled, two_sets); /* sums of weights are divided out */
        check_skin(5121, bytes, two_sets);
        check_skin(5123, bytes, two_sets);
    }
}

/* Without weights a vertex goes with its node, as an unskinned one does. */
TEST(leaves_vertices_without_weights) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 2, 0}, zeros[12] = {0};
    static const double expected[] = {5, 0, 0, 6, 0, 0, 5, 2, 0};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, positions);
    gltf_fixture_array(&fixture, 5121, "VEC4", 12, zeros);
    gltf_fixture_array(&fixture, 5126, "VEC4", 12, zeros);
    mesh_check_equal(
        gltf_fixture_glb(&fixture, "\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[5,0,0]},{}],\"skins\":"
                                   "[{\"joints\":[1]}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                                   "\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}]"),
        3, expected, 1, (const uint32_t[]){0, 1, 2});
}
