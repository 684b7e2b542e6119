/* Runs the program `cloth` as a user does. */
#include "models/cloth/cloth_scene.h"
#include "src/io/animation.h"
#include "src/io/mesh_file.h"
#include "tests/support/models/model_program.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static temp_folder folder;

/* Records the scene once for all tests. */
static int record_scene(void **state) {
    (void)state;
    folder = temp_folder_make();
    model_program_use("cloth");
    tool_run run = RUN_TOOL("--resolution", "12", "cloth-drape", folder.path);
    if (run.code != 0) fail_msg("%s", run.error);
    assert_string_equal(run.error, "");
    assert_non_null(strstr(run.out, "320 frames of 242 triangles"));
    tool_run_free(&run);
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* Checks a model and its frames. There are as many as the scene has, and the first is the model. */
static void check_files(const char *obj, const char *pc2, uint32_t frame_count) {
    mesh_file mesh;
    animation *frames;
    io_error error;
    if (!mesh_file_read(obj, &mesh, &error)) fail_msg("%s", error.text);
    if (!animation_open(&(const char *){pc2}, 1, mesh.vertex_count, NULL, &frames, &error))
        fail_msg("%s", error.text);
    assert_int_equal(animation_frame_count(frames), frame_count);
    double *positions = malloc(mesh.vertex_count * 3 * sizeof *positions);
    assert_non_null(positions);
    if (!animation_read(frames, 0, positions, &error)) fail_msg("%s", error.text);
    for (uint32_t i = 0; i < mesh.vertex_count * 3; i++)
        assert_true((float)positions[i] == (float)mesh.positions[i]);
    free(positions);
    animation_close(frames);
    mesh_file_free(&mesh);
}

static void files_hold_garment_and_scenery(void **state) {
    (void)state;
    check_files(temp_file_path(&folder, "cloth-drape.obj").text,
                temp_file_path(&folder, "cloth-drape.pc2").text, 320);
    check_files(temp_file_path(&folder, "cloth-drape-scenery.obj").text,
                temp_file_path(&folder, "cloth-drape-scenery.pc2").text, 320);
}

static void the_tool_finds_no_contact(void **state) {
    (void)state;
    temp_path summary = temp_file_path(&folder, "summary.json");
    model_program_use(NULL);
    EXPECT_TOOL(0, "replay", temp_file_path(&folder, "cloth-drape.obj").text,
                temp_file_path(&folder, "cloth-drape.pc2").text, "--method", "none", "--json", summary.text,
                "--quiet");
    model_program_use("cloth");
    json_node *json = json_node_read_file(summary.text);
    const json_node *totals = json_node_member(json, "summary");
    assert_true(json_node_number(totals, "intervals") == 319.0);
    assert_true(json_node_number(totals, "intervals_with_contact") == 0.0);
    assert_true(json_node_number(totals, "frames_crossing") == 0.0);
    json_node_free(json);
}

static void help_lists_the_scenes(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("--help"), usage = run_tool((const char *const[]){NULL});
    assert_int_equal(run.code, 0);
    for (uint32_t i = 0; i < cloth_scene_count; i++) assert_non_null(strstr(run.out, cloth_scenes[i].name));
    assert_int_equal(usage.code, 2);
    assert_string_equal(usage.error, run.out);
    tool_run_free(&run);
    tool_run_free(&usage);
    EXPECT_TOOL(2, "sleeve");
    EXPECT_TOOL(2, "--resolution", "20");
    EXPECT_TOOL(2, "--driver", "planes", "--resolution", "20");
    tool_run driver = RUN_TOOL("--resolution", "20", "--driver", "balls", "sleeve", folder.path);
    assert_int_equal(driver.code, 2);
    assert_non_null(strstr(driver.error, "steps, bounds or planes is wanted"));
    tool_run_free(&driver);
}

#define REFUSED(code, text, ...)                                                                             \
    model_program_refuses("cloth", (code), (text), (const char *const[]){__VA_ARGS__, NULL})

/* Arguments are checked before anything is recorded. */
static void what_makes_no_sense_is_refused(void **state) {
    (void)state;
    temp_folder empty = temp_folder_make();
    temp_path none = temp_file_path(&empty, "none");
    REFUSED(2, "'sleeves'", "sleeve", "sleeves", empty.path);
    REFUSED(2, "'11'", "--resolution", "11", "sleeve", empty.path);
    REFUSED(2, "'12x'", "--resolution", "12x", "sleeve", empty.path);
    REFUSED(2, "'-20'", "--resolution", "-20", "sleeve", empty.path);
    REFUSED(1, none.text, "--resolution", "12", "sleeve", none.text);
    assert_int_equal(access(temp_file_path(&empty, "sleeve.obj").text, F_OK), -1);
    temp_folder_remove(&empty);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_hold_garment_and_scenery),
        cmocka_unit_test(the_tool_finds_no_contact),
        cmocka_unit_test(help_lists_the_scenes),
        cmocka_unit_test(what_makes_no_sense_is_refused),
    };
    return cmocka_run_group_tests_name("cloth program", tests, record_scene, remove_folder);
}
