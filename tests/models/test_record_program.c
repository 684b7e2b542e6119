/* Runs the program `record` as a user does. */
#include "models/softbody/recorder.h"
#include "src/io/animation.h"
#include "src/io/mesh_file.h"
#include "tests/support/models/model_program.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <glob.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* The cheapest scene, without contacts and without balls. */
static const char scene_name[] = "dumbbell-stairs-free";

static temp_folder folder;
static temp_path model, frames, scenery;

/* Records the scene once for all tests. */
static int record_scene(void **state) {
    (void)state;
    folder = temp_folder_make();
    model = temp_file_path(&folder, "dumbbell-stairs-free.obj");
    frames = temp_file_path(&folder, "dumbbell-stairs-free.pc2");
    scenery = temp_file_path(&folder, "dumbbell-stairs-free-scenery.obj");
    model_program_use("record");
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static bool file_exists(const char *path) {
    return access(path, F_OK) == 0;
}

static mesh_file read_mesh(const char *path) {
    mesh_file mesh;
    io_error error;
    if (!mesh_file_read(path, &mesh, &error)) fail_msg("%s", error.text);
    return mesh;
}

static void records_a_scene(void **state) {
    (void)state;
    tool_run run = RUN_TOOL(scene_name, folder.path);
    if (run.code != 0) fail_msg("%s", run.error);
    assert_string_equal(run.error, "");
    assert_int_equal(strncmp(run.out, scene_name, sizeof scene_name - 1), 0);
    assert_non_null(strstr(run.out, "150 frames of 1710 triangles"));
    assert_non_null(strstr(run.out, "contacts in 0 of 149 intervals, intersections in 0 of 150 frames"));
    tool_run_free(&run);
    assert_true(file_exists(model.text) && file_exists(frames.text) && file_exists(scenery.text));
    assert_false(file_exists(temp_file_path(&folder, "dumbbell-stairs-free-scenery.pc2").text));
}

/* The model is the recorder's first frame and the first frame of the cache, which has as many frames as it
 * says; the second frame is the recorder's too. */
static void files_hold_the_recording(void **state) {
    (void)state;
    recorder r;
    io_error error;
    animation *cache;
    mesh_file mesh = read_mesh(model.text);
    if (!recorder_open(soft_scene_find(scene_name), NULL, &r, &error)) fail_msg("%s", error.text);
    assert_int_equal(mesh.vertex_count, r.shape.vertex_count);
    assert_int_equal(mesh.triangle_count, r.shape.triangle_count);
    size_t bytes = (size_t)mesh.vertex_count * 3 * sizeof *mesh.positions;
    double *positions = malloc(bytes);
    assert_non_null(positions);
    assert_memory_equal(mesh.positions, r.shape.positions, bytes);
    assert_memory_equal(mesh.triangles, r.shape.triangles, mesh.triangle_count * 3 * sizeof *mesh.triangles);
    if (!animation_open(&(const char *){frames.text}, 1, mesh.vertex_count, NULL, &cache, &error))
        fail_msg("%s", error.text);
    assert_int_equal(animation_frame_count(cache), 150);
    for (uint32_t k = 0; k < 2; k++) {
        if (k > 0 && !recorder_advance(&r, &error)) fail_msg("%s", error.text);
        if (!animation_read(cache, k, positions, &error)) fail_msg("%s", error.text);
        assert_memory_equal(positions, r.frame, bytes);
    }
    animation_close(cache);
    recorder_close(&r);
    mesh_file_free(&mesh);
    free(positions);
}

/* The scenery is ground and five steps, each a box. */
static void scenery_is_a_model(void **state) {
    (void)state;
    mesh_file mesh = read_mesh(scenery.text);
    assert_int_equal(mesh.vertex_count, 6 * 8);
    assert_int_equal(mesh.triangle_count, 6 * 12);
    mesh_file_free(&mesh);
}

static void the_tool_finds_no_contact(void **state) {
    (void)state;
    temp_path summary = temp_file_path(&folder, "summary.json");
    model_program_use(NULL);
    EXPECT_TOOL(0, "replay", model.text, frames.text, "--method", "none", "--json", summary.text, "--quiet");
    model_program_use("record");
    json_node *json = json_node_read_file(summary.text);
    const json_node *totals = json_node_member(json, "summary");
    assert_true(json_node_boolean(totals, "complete"));
    assert_true(json_node_number(totals, "intervals") == 149.0);
    assert_true(json_node_number(totals, "intervals_with_contact") == 0.0);
    assert_true(json_node_number(totals, "frames_crossing") == 0.0);
    json_node_free(json);
}

static void help_lists_the_scenes(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("--help"), usage = run_tool((const char *const[]){NULL});
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "");
    for (uint32_t i = 0; i < soft_scene_count; i++) {
        assert_non_null(strstr(run.out, soft_scenes[i].name));
        assert_non_null(strstr(run.out, soft_scenes[i].text));
    }
    assert_int_equal(usage.code, 2);
    assert_string_equal(usage.error, run.out);
    assert_string_equal(usage.out, "");
    tool_run_free(&run);
    tool_run_free(&usage);
    EXPECT_TOOL(2, "pawn-drop");
}

#define REFUSED(code, text, ...)                                                                             \
    model_program_refuses("record", (code), (text), (const char *const[]){__VA_ARGS__, NULL})

/* Arguments are checked before anything is recorded. */
static void unknown_scenes_are_refused(void **state) {
    (void)state;
    temp_folder empty = temp_folder_make();
    REFUSED(2, "'pawn'", "pawn", empty.path);
    REFUSED(2, "'pawn-drop-fre'", scene_name, "pawn-drop-fre", empty.path);
    assert_false(file_exists(temp_file_path(&empty, "dumbbell-stairs-free.obj").text));
    temp_folder_remove(&empty);
}

/* The error names the path, and no frames are left that could be taken for a recording. */
static void what_cannot_be_written_is_an_error(void **state) {
    (void)state;
    temp_folder blocked = temp_folder_make();
    temp_path none = temp_file_path(&blocked, "none"),
              cache = temp_file_path(&blocked, "dumbbell-stairs-free.pc2");
    REFUSED(1, none.text, scene_name, none.text);
    assert_false(file_exists(none.text));
    assert_int_equal(mkdir(cache.text, 0700), 0);
    REFUSED(1, cache.text, scene_name, blocked.path);
    assert_int_equal(rmdir(cache.text), 0); /* still an empty folder */
    temp_folder_remove(&blocked);
}

/* Bytes of the files beside that are not whole yet. */
static long unfinished_bytes(const char *cut) {
    char pattern[300];
    glob_t found;
    long sum = 0;
    snprintf(pattern, sizeof pattern, "%s/.cscd-output-*", cut);
    const bool any = glob(pattern, 0, NULL, &found) == 0;
    for (size_t i = 0; any && i < found.gl_pathc; i++) {
        struct stat status;
        if (stat(found.gl_pathv[i], &status) == 0) sum += (long)status.st_size;
    }
    globfree(&found);
    return sum;
}

/* When it is killed in the middle of its frames, it leaves no cache, so that what was there before stays. */
static void what_is_cut_short_takes_no_place(void **state) {
    (void)state;
    temp_folder cut = temp_folder_make();
    temp_path obj = temp_file_path(&cut, "dumbbell-stairs-free.obj");
    temp_path cache = temp_file_path(&cut, "dumbbell-stairs-free.pc2");
    tool_process process = run_tool_start((const char *const[]){scene_name, cut.path, NULL});
    while ((!file_exists(obj.text) || unfinished_bytes(cut.path) < 30000) &&
           waitpid(process.pid, NULL, WNOHANG) == 0)
        usleep(2000);
    assert_int_equal(kill(process.pid, SIGKILL), 0);
    tool_run run = run_tool_finish(&process);
    assert_int_equal(run.code, 128 + SIGKILL);
    assert_string_equal(run.out, "");
    tool_run_free(&run);
    assert_true(file_exists(obj.text));
    assert_false(file_exists(cache.text));
    temp_folder_remove(&cut);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_a_scene),
        cmocka_unit_test(files_hold_the_recording),
        cmocka_unit_test(scenery_is_a_model),
        cmocka_unit_test(the_tool_finds_no_contact),
        cmocka_unit_test(help_lists_the_scenes),
        cmocka_unit_test(unknown_scenes_are_refused),
        cmocka_unit_test(what_cannot_be_written_is_an_error),
        cmocka_unit_test(what_is_cut_short_takes_no_place),
    };
    return cmocka_run_group_tests_name("record program", tests, record_scene, remove_folder);
}
