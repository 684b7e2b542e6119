/* Copies of meshes by EXT_mesh_gpu_instancing, and notes about extensions that are not read. */
#include "src/io/gltf.h"
#include "src/io/growable.h"
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXTENSION(attributes) "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{" attributes "}}}"
#define ALL                   "\"TRANSLATION\":1,\"ROTATION\":2,\"SCALE\":3"
#define MESH                  "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]"
/* Node 0 is 10 along x and above node 1, which has the triangle. */
#define NODES(of_node)                                                                                       \
    "\"nodes\":[{\"translation\":[10,0,0],\"children\":[1]},{\"name\":\"tree\",\"mesh\":0," of_node "}],"    \
    "\"scenes\":[{\"nodes\":[0]}],"

/* Accessor 0: a triangle; 1 to 3: translations, rotations, scales of three copies; 4: two translations; 5 and 6: times and
 * places of an animation; 7: three translations without data; 8: the rotations as integers; 9: joint and weight are not there. */
static gltf_fixture make_fixture(void) {
    static const double triangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const double translations[] = {0, 0, 0, 0, 0, 5, 1, 1, 1};
    static const double rotations[] = {0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 0, 0};
    static const double scales[] = {1, 1, 1, 2, 3, 1, -1, 1, 1};
    static const double times[] = {0, 1}, places[] = {10, 0, 0, 18, 4, 0};
    static const double integers[] = {0, 0, 0, 127, 0, 0, 127, 127, 127, 0, 0, 0};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, triangle);
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, translations);
    gltf_fixture_array(&fixture, 5126, "VEC4", 12, rotations);
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, scales);
    gltf_fixture_array(&fixture, 5126, "VEC3", 6, translations);
    gltf_fixture_array(&fixture, 5126, "SCALAR", 2, times);
    gltf_fixture_array(&fixture, 5126, "VEC3", 6, places);
    gltf_fixture_accessor(&fixture, "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}");
    const int view = gltf_fixture_view(&fixture, 5120, 12, integers);
    gltf_fixture_accessor(
        &fixture,
        "{\"bufferView\":%d,\"componentType\":5120,\"count\":3,\"type\":\"VEC4\",\"normalized\":true}", view);
    return fixture;
}

/* By hand: scale, then turn, then move, then move with node 0. Copy 1 turns by 90 degrees around z, copy 2 by 180 degrees
 * around x. */
static const double placed[] = {10, 0, 0, 11, 0,  0, 10, 1,  0, 10, 0,  5, 10, 2,
                                5,  7, 0, 5,  11, 1, 1,  10, 1, 1,  11, 0, 1};
static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5, 6, 8, 7}; /* copy 2 is mirrored */

TEST(copies_stand_where_they_should) {
    static const char *const used[] = {"\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"],",
                                       "\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"],", ""};
    for (size_t i = 0; i < 3; i++)
        for (int integers = 0; integers < 2; integers++) {
            gltf_fixture fixture = make_fixture();
            char rest[1024];
            snprintf(rest, sizeof rest, "%s%s" MESH, used[i],
                     integers ? NODES(EXTENSION("\"TRANSLATION\":1,\"ROTATION\":8,\"SCALE\":3"))
                              : NODES(EXTENSION(ALL)));
            mesh_check_equal(gltf_fixture_glb(&fixture, rest), 9, placed, 3, triangles);
        }
}

TEST(some_attributes_are_enough) {
    static const double moved[] = {10, 0,  0, 11, 0,  0, 10, 1,  0, 10, 0,  5, 11, 0,
                                   5,  10, 1, 5,  11, 1, 1,  12, 1, 1,  11, 2, 1};
    static const double scaled[] = {10, 0,  0, 11, 0,  0, 10, 1, 0, 10, 0,  0, 12, 0,
                                    0,  10, 3, 0,  10, 0, 0,  9, 0, 0,  10, 1, 0};
    static const uint32_t plain[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    gltf_fixture fixture = make_fixture();
    mesh_check_equal(gltf_fixture_glb(&fixture, NODES(EXTENSION("\"TRANSLATION\":1,\"_AGE\":5")) MESH), 9,
                     moved, 3, plain);
    fixture = make_fixture();
    mesh_check_equal(gltf_fixture_glb(&fixture, NODES(EXTENSION("\"SCALE\":3")) MESH), 9, scaled, 3,
                     triangles);
    fixture = make_fixture();
    mesh_check_equal(gltf_fixture_glb(&fixture, NODES(EXTENSION("\"TRANSLATION\":7,\"SCALE\":3")) MESH), 9,
                     scaled, 3, triangles);
}

TEST(each_copy_is_a_part) {
    static const char *const names[] = {"tree", "tree.001", "tree.002", NULL};
    static const uint32_t labels[] = {0, 1, 2};
    gltf_fixture fixture = make_fixture();
    mesh_check_parts(gltf_fixture_glb(&fixture, NODES(EXTENSION(ALL)) MESH), names, labels);
}

/* Node 0 moves by (8, 4, 0) in a second. */
TEST(copies_go_with_nodes_that_move) {
    gltf_fixture fixture = make_fixture();
    temp_folder folder = temp_folder_make();
    gltf_frames *frames = NULL;
    io_error error;
    const file_bytes file = gltf_fixture_glb(
        &fixture, NODES(EXTENSION(ALL)) MESH
        ",\"animations\":[{\"samplers\":[{\"input\":5,\"output\":6}],\"channels\":[{\"sampler\":0,\"target\":"
        "{\"node\":0,\"path\":\"translation\"}}]}]");
    const temp_path path = temp_file_write(&folder, "grove.glb", file.bytes, file.size);
    if (!gltf_frames_open(path.text, 9, 4, NULL, &frames, &error)) fail_msg("%s", error.text);
    assert_int_equal(gltf_frames_count(frames), 5);
    for (uint32_t frame = 0; frame < 5; frame++) {
        double positions[27];
        if (!gltf_frames_read(frames, frame, positions, &error)) fail_msg("%s", error.text);
        for (int i = 0; i < 27; i++)
            assert_true(positions[i] == placed[i] + (i % 3 == 0   ? 2.0 * frame
                                                     : i % 3 == 1 ? 1.0 * frame
                                                                  : 0));
    }
    gltf_frames_close(frames);
    temp_folder_remove(&folder);
}

static void check_refused(const char *rest, const char *found, const char *expected) {
    gltf_fixture fixture = make_fixture();
    mesh_check_error(gltf_fixture_glb(&fixture, rest), ": ", found, expected);
}

TEST(wrong_copies_are_refused) {
    check_refused(NODES(EXTENSION("\"TRANSLATION\":1,\"SCALE\":4")) MESH, "node 1",
                  "SCALE is of 2 instances");
    check_refused(NODES(EXTENSION("\"TRANSLATION\":4,\"SCALE\":3")) MESH, "node 1",
                  "SCALE is of 3 instances, the attribute before it of 2");
    check_refused(NODES(EXTENSION("\"TRANSLATION\":2")) MESH, "accessor 2: type is VEC4",
                  "VEC3 for TRANSLATION");
    check_refused(NODES(EXTENSION("\"ROTATION\":99")) MESH, "node 1", "ROTATION is 99");
    check_refused(NODES(EXTENSION("\"TRANSLATION\":7")) MESH, "node 1",
                  "nothing says where its instances are");
    check_refused(NODES(EXTENSION("\"_AGE\":5")) MESH, "node 1", "nothing says where its instances are");
    check_refused(NODES("\"extensions\":{\"EXT_mesh_gpu_instancing\":{}}") MESH, "node 1", "no attributes");
    check_refused(NODES("\"extensions\":{\"EXT_mesh_gpu_instancing\":3}") MESH, "node 1", "is no object");
    check_refused(NODES("\"skin\":0," EXTENSION(ALL)) MESH ",\"skins\":[{\"joints\":[0]}]",
                  "node 1: has a skin", "does not say");
}

/* ---- what is not read ------------------------------------------------------------------------------------ */

/* text NULL: there is no note. */
static void check_note(const char *rest, const char *const *texts) {
    gltf_fixture fixture = make_fixture();
    mesh_file mesh;
    io_error error;
    if (!mesh_check_read(gltf_fixture_glb(&fixture, rest), &mesh, &error)) fail_msg("%s", error.text);
    if (texts == NULL)
        assert_null(mesh.unread);
    else
        assert_non_null(mesh.unread);
    for (; texts != NULL && *texts != NULL; texts++)
        if (strstr(mesh.unread, *texts) == NULL) fail_msg("expected '%s' in: %s", *texts, mesh.unread);
    mesh_file_free(&mesh);
}

#define TEXTS(...) ((const char *const[]){__VA_ARGS__, NULL})

TEST(what_is_not_read_is_named) {
    check_note(NODES(EXTENSION("\"TRANSLATION\":1")) MESH, NULL);
    check_note(NODES("\"extensions\":{\"KHR_lights_punctual\":{},\"EXT_instance_features\":{}}") MESH, NULL);
    check_note(NODES("\"extensions\":{\"ACME_fur\":{}}") MESH,
               TEXTS("the glTF extension ACME_fur (node 1) is not read: ", "not what other programs show"));
    check_note(
        NODES(
            "\"extensions\":{\"ACME_fur\":{},\"KHR_node_visibility\":{}}") "\"meshes\":[{\"extensions\":{\"ACME_fur\":{}},\"primitives\":[{\"attributes\":{\"POSITION\":0},"
                                                                           "\"extensions\":{\"ACME_hair\":{}}}]}]",
        TEXTS("extensions ACME_fur (node 1 and 1 more), KHR_node_visibility (node 1), ACME_hair (mesh 0, "
              "primitive 0) are not read"));
    check_note(
        NODES(
            "\"name\":\"a\"") "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"extensions\":{\"KHR_draco_mesh_"
                              "compression\":{}}}]}]",
        TEXTS("KHR_draco_mesh_compression (mesh 0, primitive 0) is not read: the uncompressed data"));
}

/* Node 2 and mesh 1 are in no scene. */
TEST(what_is_not_shown_is_not_named) {
    check_note(
        "\"nodes\":[{\"mesh\":0},{},{\"mesh\":1,\"extensions\":{\"ACME_fur\":{}}}],\"scenes\":[{\"nodes\":[0]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]},{\"extensions\":{\"ACME_fur\":{}},"
        "\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]",
        NULL);
}

TEST(many_names_are_cut) {
    char extensions[1024] = "", rest[2048];
    size_t used = 0;
    for (int i = 0; i < 12; i++)
        used += (size_t)snprintf(extensions + used, sizeof extensions - used,
                                 "%s\"ACME_%d_of_a_name_that_is_so_long_that_it_is_cut\":{}",
                                 i > 0 ? "," : "", i);
    snprintf(rest, sizeof rest, "\"nodes\":[{\"mesh\":0,\"extensions\":{%s}}]," MESH, extensions);
    check_note(rest, TEXTS("ACME_0_of", "ACME_7_of", " and others are not read"));
}

TEST(survives_failed_allocations) {
    gltf_fixture fixture = make_fixture();
    mesh_check_memory(gltf_fixture_glb(&fixture, NODES(EXTENSION(ALL)) MESH ",\"scene\":0"),
                      MESH_PARTS_BY_FILE);
}
