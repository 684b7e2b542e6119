/* glTF files when memory fails, and when they are damaged; the frames of an animation take no memory of their own. */
#include "tests/support/files.h"
#include "tests/support/io/file_damage.h"
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/test.h"
#include "tool/io/animation.h"
#include "tool/io/io.h"

#include <stdlib.h>
#include <string.h>

/* A skinned mesh with a target and a material, a mesh of three copies, and a node that moves and grows. */
#define RICH                                                                                                              \
    "\"scene\":0,\"scenes\":[{\"nodes\":[0,1,3]}],\"nodes\":[{\"name\":\"a\",\"mesh\":0,\"skin\":0},{\"children\":[2],"   \
    "\"rotation\":[0,0,0,1],\"mesh\":1,\"name\":\"a\"},{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},{\"mesh\":1,"       \
    "\"extensions\":{\"ACME_fur\":{},\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":7}}}}],\"skins\":[{"    \
    "\"joints\":[1,2],\"inverseBindMatrices\":4}],\"materials\":[{\"name\":\"Steel\"}],\"meshes\":[{\"weights\":[0.5],"   \
    "\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":2,\"WEIGHTS_0\":3},\"indices\":1,\"material\":0,"       \
    "\"targets\":[{\"POSITION\":5}]}]},{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":6}]}],"                 \
    "\"animations\":[{\"name\":\"A\",\"samplers\":[{\"input\":6,\"output\":7},{\"input\":6,\"output\":7}],\"channels\":[" \
    "{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}},{\"sampler\":1,\"target\":{\"node\":1,\"path\":"    \
    "\"scale\"}}]},{\"name\":\"B\",\"samplers\":[],\"channels\":[]}]"

enum { VERTICES = 20 };

/* Accessors: 0 positions, 1 indices, 2 joints, 3 weights, 4 matrices, 5 sparse, 6 the times 0, 1 and 2, 7 places in these. */
static file_bytes rich_file(gltf_fixture *fixture) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, indices[] = {0, 1, 2, 0, 2, 3};
    static const double joints[16] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, places[] = {0, 2, 3},
                        times[] = {0, 1, 2};
    static const double weights[16] = {1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0, 0};
    static const double identity[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const double moves[] = {1, 1, 1, 2, 2, 2, 4, 4, 4};
    *fixture = (gltf_fixture){0};
    gltf_fixture_array(fixture, 5126, "VEC3", 12, positions);
    gltf_fixture_array(fixture, 5123, "SCALAR", 6, indices);
    gltf_fixture_array(fixture, 5121, "VEC4", 16, joints);
    gltf_fixture_array(fixture, 5126, "VEC4", 16, weights);
    gltf_fixture_array(fixture, 5126, "MAT4", 32, identity);
    const int view = gltf_fixture_view(fixture, 5121, 3, places);
    gltf_fixture_accessor(
        fixture,
        "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":3,\"indices\":{"
        "\"bufferView\":%d,\"componentType\":5121},\"values\":{\"bufferView\":0}}}",
        view);
    gltf_fixture_array(fixture, 5126, "SCALAR", 3, times);
    gltf_fixture_array(fixture, 5126, "VEC3", 9, moves);
    return gltf_fixture_glb(fixture, RICH);
}

TEST(meshes_survive_failed_allocations) {
    gltf_fixture fixture;
    mesh_check_memory(rich_file(&fixture), MESH_PARTS_BY_FILE);
    mesh_check_memory(rich_file(&fixture), MESH_PARTS_BY_MATERIAL);
}

TEST(animations_survive_failed_allocations) {
    gltf_fixture fixture;
    const file_bytes file = rich_file(&fixture);
    const temp_folder folder = temp_folder_make();
    const temp_path place = temp_file_write(&folder, file.name, file.bytes, file.size);
    const char *path = place.text;
    long places = 0;
    for (; io_allocations_go_on(places); places++) {
        animation *frames = NULL;
        io_error error = {""};
        const bool done = animation_open(&path, 1, VERTICES, NULL, &frames, &error);
        io_allocations_left = -1;
        if (!done && (strstr(error.text, "out of memory") == NULL || strstr(error.text, path) == NULL))
            fail_msg("%s", error.text);
        assert_int_equal(frames != NULL, done);
        animation_close(frames);
    }
    print_message("refused in %ld places\n", places - 1);
    assert_true(places > 25);
    temp_folder_remove(&folder);
}

TEST(reads_frames_without_more_memory) {
    gltf_fixture fixture;
    const file_bytes file = rich_file(&fixture);
    const temp_folder folder = temp_folder_make();
    const temp_path place = temp_file_write(&folder, file.name, file.bytes, file.size);
    const char *path = place.text;
    const animation_options options = {.fps = 1e6};
    animation *frames;
    io_error error;
    double positions[3 * VERTICES];
    if (!animation_open(&path, 1, VERTICES, &options, &frames, &error)) fail_msg("%s", error.text);
    assert_int_equal(animation_frame_count(frames), 2000001);
    io_allocations_left = 0;
    assert_true(animation_read(frames, 1000000, positions, &error));
    assert_true(positions[12] == 2 && positions[15] == 4); /* mesh 1: 2 + 2 * 0, 2 + 2 * 1 */
    io_allocations_left = -1;
    animation_close(frames);
    temp_folder_remove(&folder);
}

TEST(survives_damage) {
    gltf_fixture fixture;
    const file_damage_counts counts = file_damage_rounds(rich_file(&fixture), 8000, 1);
    print_message("read %u, animated %u, unanimated %u, refused %u\n", (unsigned)counts.read,
                  (unsigned)counts.animated, (unsigned)counts.unanimated, (unsigned)counts.refused);
    assert_true(counts.read > 400 && counts.animated > 400 && counts.unanimated > 100 &&
                counts.refused > 400);
}
