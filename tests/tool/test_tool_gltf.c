/* The tool replays glTF files, which hold a model and its frames. */
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/contact_rows.h"
#include "tests/support/tool/run_tool.h"

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
    tool_run run = RUN_TOOL("check", model.text, "--fail-on-contact");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.error, "holds an animation, and only its rest pose is looked at"));
    tool_run_free(&run);
    run = RUN_TOOL("check", model.text, model.text);
    assert_null(strstr(run.error, "rest pose"));
    tool_run_free(&run);
    EXPECT_TOOL(3, "check", model.text, model.text, "--quiet", "--fail-on-contact");
}

static void unknown_animations_are_refused(void **state) {
    (void)state;
    EXPECT_ERROR(1, TEXTS("holds no animation walk", "fast", "slow"), "replay", model.text, "--animation",
                 "walk");
    EXPECT_ERROR(2, TEXTS("--fps cannot be '0'"), "replay", model.text, "--fps", "0");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_model_and_frames),
        cmocka_unit_test(unknown_animations_are_refused),
    };
    return cmocka_run_group_tests_name("tool_gltf", tests, write_model, remove_model);
}
