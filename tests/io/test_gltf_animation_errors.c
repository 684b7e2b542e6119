/* Animations of glTF files that are refused, and what memory they take. */
#include "src/io/animation.h"
#include "src/io/growable.h"
#include "tests/support/io/file_damage.h"
#include "tests/support/io/gltf_animations.h"
#include "tests/support/io_allocations.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { VERTICES = 3 };

/* ---- what is refused --------------------------------------------------------------------------------- */

static void check_refused(file_bytes file, uint32_t vertex_count, double fps, const char *name,
                          const char *found, const char *expected) {
    const temp_folder folder = temp_folder_make();
    const temp_path path = temp_file_write(&folder, file.name, file.bytes, file.size);
    const char *paths[] = {path.text};
    const animation_options options = {.fps = fps, .animation_name = name};
    animation *frames = NULL;
    io_error error;
    assert_false(animation_open(paths, 1, vertex_count, &options, &frames, &error));
    assert_null(frames);
    if (strstr(error.text, found) == NULL || strstr(error.text, expected) == NULL ||
        strstr(error.text, path.text) == NULL)
        fail_msg("no '%s' or '%s' in '%s'", found, expected, error.text);
    temp_folder_remove(&folder);
}

TEST(refuses_wrong_channels) {
    static const char *const cases[][3] = {
        {"{\"sampler\":0,\"target\":{\"node\":3,\"path\":\"scale\"}}", "animation 0, channel 0: node is 3",
         "3 nodes"},
        {"{\"sampler\":0,\"target\":{\"node\":2,\"path\":\"scale\"}}", "moves node 2, which has a matrix",
         "translation"},
        {"{\"sampler\":2,\"target\":{\"node\":1,\"path\":\"scale\"}}", "channel 0: sampler is 2",
         "2 samplers"},
        {"{\"target\":{\"node\":1,\"path\":\"scale\"}}", "channel 0: sampler is missing", ""},
        {"{\"sampler\":0,\"target\":{\"node\":1}}", "target.path is missing", ""},
        {"{\"sampler\":0}", "target is missing", ""},
        {"{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"rotation\"}}", "accessor 3: type is VEC3",
         "VEC4 for output"},
        {"{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}}", "animation 0: moves no node",
         "no frames"},
        {"", "animation 0: moves no node", ""},
        {"{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"scale\"}}],\"samplers\":[{\"input\":1,\"output\":3,"
         "\"interpolation\":\"SINE\"}",
         "sampler 0: interpolation is SINE", "LINEAR, STEP or CUBICSPLINE"},
        {"{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"scale\"}}],\"samplers\":[{\"input\":1,\"output\":3,"
         "\"interpolation\":\"CUBICSPLINE\"}",
         "has 2 times and 2 values", "expected 6 values"},
        {"{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"scale\"}}],\"samplers\":[{\"input\":1}",
         "output is missing", ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        gltf_fixture fixture;
        check_refused(gltf_animations_two(&fixture, cases[i][0]), VERTICES, 24, NULL, cases[i][1],
                      cases[i][2]);
    }
}

TEST(refuses_what_has_no_frames) {
    static const double falling[] = {1, 0.5}, endless[] = {0, 1e30}, values[] = {0, 0, 0, 1, 0, 0};
    gltf_fixture fixture;
    const file_bytes file = gltf_animations_two(&fixture, GLTF_MOVE_NODE_1);
    check_refused(file, VERTICES, 24, "Run", "no animation Run", "A, B");
    check_refused(file, VERTICES + 1, 24, NULL, "holds 3 vertices, the model has 4", "another mesh");
    check_refused(file, VERTICES, -1, NULL, "-1 frames a second", "more than 0");
    check_refused(file, VERTICES, NAN, NULL, "frames a second", "more than 0");
    check_refused(gltf_animations_channel(
                      &fixture, (gltf_channel_keys){"scale", "LINEAR", "VEC3", 2, 6, falling, values}),
                  VERTICES, 24, NULL, "sampler 0: the time of key 1 is 0.5, after 1", "rising");
    check_refused(gltf_animations_channel(
                      &fixture, (gltf_channel_keys){"scale", "LINEAR", "VEC3", 2, 6, endless, values}),
                  VERTICES, 24, NULL, "frames in 1e+30 seconds", "at most");
    fixture = (gltf_fixture){0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, gltf_animations_triangle);
    check_refused(gltf_fixture_glb(&fixture,
                                   "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                                   "\"POSITION\":0}}]}]"),
                  VERTICES, 24, NULL, "holds no animation", "export it with its animations");
}

/* ---- memory and damage ------------------------------------------------------------------------------- */

TEST(survives_failed_allocations) {
    gltf_fixture fixture;
    const file_bytes file = gltf_animations_two(&fixture, GLTF_MOVE_NODE_1 "," GLTF_SCALE_NODE_0);
    const temp_folder folder = temp_folder_make();
    const temp_path place = temp_file_write(&folder, file.name, file.bytes, file.size);
    const char *path = place.text;
    long successes = 0;
    for (bool done; io_allocations_go_on(successes); successes++) {
        animation *again = NULL;
        mesh_file mesh = {0};
        io_error error = {""};
        done =
            mesh_file_read(path, &mesh, &error) && animation_open(&path, 1, VERTICES, NULL, &again, &error);
        io_allocations_left = -1;
        if (!done && (strstr(error.text, "out of memory") == NULL || strstr(error.text, path) == NULL))
            fail_msg("%s", error.text);
        if (!done) assert_null(again);
        animation_close(again);
        mesh_file_free(&mesh);
    }
    assert_true(successes > 40);
    temp_folder_remove(&folder);
}

TEST(reads_frames_without_more_memory) {
    gltf_fixture fixture;
    const file_bytes file = gltf_animations_two(&fixture, GLTF_MOVE_NODE_1 "," GLTF_SCALE_NODE_0);
    const temp_folder folder = temp_folder_make();
    const temp_path place = temp_file_write(&folder, file.name, file.bytes, file.size);
    const char *path = place.text;
    const animation_options options = {.fps = 1e6};
    animation *frames;
    io_error error;
    double positions[3 * VERTICES];
    assert_true(animation_open(&path, 1, VERTICES, &options, &frames, &error));
    assert_int_equal(animation_frame_count(frames), 2000001);
    io_allocations_left = 0;
    assert_true(animation_read(frames, 1000000, positions, &error));
    assert_true(positions[0] == 4 && positions[3] == 7);
    io_allocations_left = -1;
    animation_close(frames);
    temp_folder_remove(&folder);
}

TEST(survives_damage) {
    gltf_fixture fixture;
    const file_bytes file = gltf_animations_two(&fixture, GLTF_MOVE_NODE_1 "," GLTF_SCALE_NODE_0);
    const file_damage_counts counts = file_damage_rounds(file, 4000, 2);
    assert_true(counts.animated > 400 && counts.unanimated > 100 && counts.refused > 400);
}
