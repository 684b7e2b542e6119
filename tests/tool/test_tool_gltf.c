/* The tool replays glTF files, which hold a model and its frames. */
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/contact_rows.h"
#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <string.h>

static temp_folder folder;
static temp_path model, out;

/* Two triangles, of nodes "wall" at x = 0 and "dart" that flies through it: at x = 1 after 0 s, at -1 after 1 s, and back
 * after 2 s by the second animation. */
static int write_model(void **state) {
    (void)state;
    static const double wall[9] = {0, -4, -4, 0, 4, -4, 0, 0, 4}, dart[9] = {0, 0, 0, 1, 0.5, 0, 1, 0, 0.5};
    static const double times[2] = {0, 1}, longer[2] = {0, 2}, away[6] = {1, 0, 0, -1, 0, 0};
    gltf_fixture fixture = {.size = 0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, wall);
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, dart);
    gltf_fixture_array(&fixture, 5126, "SCALAR", 2, times);
    gltf_fixture_array(&fixture, 5126, "SCALAR", 2, longer);
    gltf_fixture_array(&fixture, 5126, "VEC3", 6, away);
    file_bytes file = gltf_fixture_glb(
        &fixture,
        "\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
        "\"nodes\":[{\"mesh\":0,\"name\":\"wall\"},{\"mesh\":1,\"name\":\"dart\",\"translation\":[1,0,0]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]},"
        "{\"primitives\":[{\"attributes\":{\"POSITION\":1}}]}],"
        "\"animations\":["
        "{\"name\":\"fast\",\"samplers\":[{\"input\":2,\"output\":4}],"
        "\"channels\":[{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}}]},"
        "{\"name\":\"slow\",\"samplers\":[{\"input\":3,\"output\":4}],"
        "\"channels\":[{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}}]}]");
    folder = temp_folder_make();
    model = temp_file_write(&folder, "scene.glb", file.bytes, file.size);
    out = temp_file_path(&folder, "out.csv");
    return 0;
}

static int remove_model(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* The tip of the dart, vertex 3, is at the wall half way. */
static void check_first(int32_t frame, double toi) {
    contact_rows rows = contact_rows_read_csv(out.text);
    assert_true(rows.count > 0);
    assert_int_equal(rows.items[0].frame, frame);
    assert_true(rows.items[0].toi >= toi - 1e-6 && rows.items[0].toi <= toi + 1e-6);
    assert_true(rows.items[0].kind == CSCD_CONTACT_VF && rows.items[0].a[0] == 3);
    contact_rows_free(&rows);
}

static void a_file_is_model_and_frames(void **state) {
    (void)state;
    EXPECT_TOOL(0, "replay", model.text, "--quiet", "--contacts", out.text);
    check_first(11, 1.0); /* 24 frames a second: at frame 12 */
    EXPECT_TOOL(0, "replay", model.text, "--quiet", "--fps", "5", "--contacts", out.text);
    check_first(2, 0.5);
    EXPECT_TOOL(0, "replay", model.text, "--quiet", "--fps", "5", "--animation", "slow", "--contacts",
                out.text);
    check_first(4, 1.0);
}

/* check looks at the animation that a file holds, as replay does, and says so if not at all of it. */
static void check_plays_the_animation(void **state) {
    (void)state;
    tool_run given = RUN_TOOL("check", model.text, model.text, "--fail-on", "crossing"),
             own = RUN_TOOL("check", model.text, "--fail-on", "crossing");
    assert_int_equal(own.code, 3);
    assert_string_equal(own.out, given.out);
    assert_string_equal(own.error, given.error);
    assert_non_null(strstr(own.out, "Frames 13 to 23 cross (11 of 25), frames 12, 24 touch (2 of 25). "));
    assert_non_null(strstr(own.out, "Only one of the 2 animations of scene was played.\n"));
    tool_run_free(&given);
    tool_run_free(&own);
    tool_run rest = RUN_TOOL("check", model.text, "--rest", "--fail-on", "crossing");
    assert_int_equal(rest.code, 0);
    assert_string_equal(rest.out,
                        "Clean: no two triangles cross or touch. Only the rest pose of scene was looked "
                        "at; its file holds animations.\n");
    tool_run_free(&rest);
    EXPECT_ERROR(2, TEXTS("no FRAMES given"), "replay", model.text, "--rest");
}

/* So do the files of objects, which have as many frames, or are refused. */
static void animations_of_objects_are_played(void **state) {
    (void)state;
    char named[600];
    snprintf(named, sizeof named, "scene=%s", model.text);
    EXPECT_TOOL(3, "check", "--object", named, "--fail-on", "crossing", "--quiet");
    EXPECT_TOOL(3, "replay", "--object", named, "--fail-on", "crossing", "--quiet");
    EXPECT_TOOL(0, "check", "--object", named, "--fail-on", "crossing", "--quiet", "--rest");
    static const char far[] = "v 50 0 0\nv 51 0 0\nv 50 1 0\nf 1 2 3\n";
    temp_path beside = temp_file_write(&folder, "beside.obj", far, sizeof far - 1),
              second = temp_file_write(&folder, "beside_2.obj", far, sizeof far - 1);
    EXPECT_TOOL(3, "check", beside.text, "--object", named, "--fail-on", "crossing", "--quiet");
    EXPECT_ERROR(1, TEXTS("beside has 2 frames", "scene has 25", "--rest leaves files at rest"), "check",
                 beside.text, beside.text, second.text, "--object", named);
    tool_run run = RUN_TOOL("check", beside.text, beside.text, second.text, "--object", named, "--rest");
    assert_int_equal(run.code, 0);
    assert_non_null(
        strstr(run.out, " Only the rest pose of scene was looked at; its file holds animations.\n"));
    tool_run_free(&run);
}

static void render_draws_the_animation(void **state) {
    (void)state;
    temp_path picture = temp_file_path(&folder, "frame.png");
    EXPECT_TOOL(0, "render", model.text, "--frame", "24", "--size", "64x48", "-o", picture.text);
    EXPECT_TOOL(0, "render", model.text, "--frames", "0:24:8", "--size", "32x24", "-o", picture.text);
    EXPECT_ERROR(1, TEXTS("--frame 24"), "render", model.text, "--frame", "24", "--rest", "-o", picture.text);
}

static void unknown_animations_are_refused(void **state) {
    (void)state;
    EXPECT_ERROR(1, TEXTS("holds no animation walk", "fast", "slow"), "replay", model.text, "--animation",
                 "walk");
    EXPECT_ERROR(2, TEXTS("--fps cannot be '0'"), "replay", model.text, "--fps", "0");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_model_and_frames),       cmocka_unit_test(check_plays_the_animation),
        cmocka_unit_test(animations_of_objects_are_played), cmocka_unit_test(render_draws_the_animation),
        cmocka_unit_test(unknown_animations_are_refused),
    };
    return cmocka_run_group_tests_name("tool_gltf", tests, write_model, remove_model);
}
