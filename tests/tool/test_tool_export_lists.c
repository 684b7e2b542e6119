/* Lists of what to select, and what exports refuse. */
#include "tests/support/test.h"
#include "tests/support/tool/export_scene.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static temp_folder folder;
static temp_path list_path;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    list_path = temp_file_path(&folder, "list.json");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* ---- lists ----------------------------------------------------------------------------------------------- */

static void expect_list(const json_node *part, const char *key, const int *numbers, size_t count) {
    const json_node *list = json_node_member(part, key);
    assert_int_equal(list->count, count);
    for (size_t i = 0; i < count; i++) assert_int_equal(json_node_item(list, i)->number, numbers[i]);
}

/* The wall's side with the largest x, and all of the bar but its ends. */
static void expect_crossing_parts(const json_node *parts) {
    assert_int_equal(parts->count, 2);
    const json_node *box = json_node_item(parts, 0), *rod = json_node_item(parts, 1);
    assert_string_equal(json_node_string(box, "name"), "wall/Box");
    assert_string_equal(json_node_string(box, "object"), "wall");
    expect_list(box, "vertices", (const int[]){1, 3, 5, 7}, 4);
    expect_list(box, "polygons", (const int[]){3}, 1);
    expect_list(box, "touching_vertices", NULL, 0);
    expect_list(box, "touching_polygons", NULL, 0);
    assert_string_equal(json_node_string(rod, "name"), "bar/Rod");
    expect_list(rod, "vertices", (const int[]){0, 1, 2, 3, 4, 5, 6, 7}, 8);
    expect_list(rod, "polygons", (const int[]){0, 1, 4, 5}, 4);
}

static void expect_range(const json_node *part, const char *name, const char *object, int first) {
    assert_string_equal(json_node_string(part, "name"), name);
    assert_string_equal(json_node_string(part, "object"), object);
    assert_int_equal(json_node_number(part, "first_vertex"), first);
    assert_int_equal(json_node_number(part, "last_vertex"), first + 7);
    assert_int_equal(json_node_number(part, "first_polygon"), first / 8 * 6);
    assert_int_equal(json_node_number(part, "last_polygon"), first / 8 * 6 + 5);
}

static void lists_name_what_to_select(void **state) {
    (void)state;
    export_scene s;
    export_scene_open(&s, &folder, false);
    export_scene_start(&s, &(export_request){.select_path = list_path.text});
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        export_scene_add_frame(&s, frame);
    }
    export_scene_close(&s);
    json_node *root = json_node_read_file(list_path.text);
    assert_int_equal(json_node_number(root, "version"), 1);
    const json_node *object = json_node_item(json_node_member(root, "objects"), 0);
    assert_string_equal(json_node_string(object, "model"), s.wall_path.text);
    assert_int_equal(json_node_number(object, "vertices"), 16);
    assert_int_equal(json_node_number(object, "polygons"), 12);
    const json_node *parts = json_node_member(root, "parts");
    assert_int_equal(parts->count, 3);
    expect_range(json_node_item(parts, 0), "wall/Box", "wall", 0);
    expect_range(json_node_item(parts, 1), "wall/Seed", "wall", 8);
    expect_range(json_node_item(parts, 2), "bar/Rod", "bar", 0);
    const json_node *frames = json_node_member(root, "frames");
    assert_int_equal(frames->count, FRAMES - 1);
    for (uint32_t i = 0; i < FRAMES - 1; i++) {
        const json_node *frame = json_node_item(frames, i);
        assert_int_equal(json_node_number(frame, "frame"), i == 0 ? FIRST_FRAME : FIRST_FRAME + 2);
        expect_crossing_parts(json_node_member(frame, "parts"));
    }
    expect_crossing_parts(json_node_member(root, "union"));
    json_node_free(root);
}

/* A corner that touches in one frame and crosses in the next is in both lists of the union. */
static void the_union_has_what_any_frame_has(void **state) {
    (void)state;
    static const char still[] = "v 0 0 0\nv 4 0 0\nv 0 4 0\n",
                      faces[] = "v 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n";
    char text[200];
    temp_path frames[2];
    for (int i = 0; i < 2; i++) {
        const int length = snprintf(text, sizeof text, "%sv 1 1 %d\n%s", still, -i, faces);
        frames[i] = temp_file_write(&folder, i == 0 ? "u_1.obj" : "u_2.obj", text, (size_t)length);
    }
    EXPECT_TOOL(0, "check", frames[0].text, frames[1].text, "--select", list_path.text, "--quiet");
    json_node *root = json_node_read_file(list_path.text);
    const json_node *all = json_node_member(root, "union");
    assert_int_equal(all->count, 2);
    for (int i = 0; i < 2; i++) {
        expect_list(json_node_item(all, (size_t)i), "polygons", &i, 1);
        expect_list(json_node_item(all, (size_t)i), "touching_polygons", &i, 1);
    }
    json_node_free(root);
}

/* ---- what is refused ------------------------------------------------------------------------------------- */

static void expect_misfit(const export_request *request, const char *const *texts) {
    io_error error = {""};
    const char *const others[] = {"wall.obj", "out.json"};
    assert_false(export_request_fits(request, others, 2, &error));
    for (; *texts != NULL; texts++)
        if (strstr(error.text, *texts) == NULL) fail_msg("no '%s' in: %s", *texts, error.text);
}

static void names_of_other_formats_are_refused(void **state) {
    (void)state;
    io_error error;
    expect_misfit(&(export_request){.vtk_path = "x.png"}, TEXTS("--vtk", "'x.png'", "ends in .pvd"));
    expect_misfit(&(export_request){.vtk_path = "x.vtp"}, TEXTS("--vtk", "'x.vtp'", "ends in .pvd"));
    expect_misfit(&(export_request){.vtk_path = "x.obj"}, TEXTS("--vtk", "'x.obj'", "ends in .pvd"));
    expect_misfit(&(export_request){.ply_path = "x.obj"}, TEXTS("--ply", "'x.obj'", "ends in .ply"));
    expect_misfit(&(export_request){.ply_path = "x.json"}, TEXTS("--ply", "'x.json'", "ends in .ply"));
    expect_misfit(&(export_request){.select_path = "x.csv"}, TEXTS("--select", "'x.csv'", "ends in .json"));
    expect_misfit(&(export_request){.vtk_path = "-"}, TEXTS("--vtk", "several files"));
    expect_misfit(&(export_request){.ply_path = "-"}, TEXTS("--ply", "several files"));
    expect_misfit(&(export_request){.select_path = "out.json"}, TEXTS("--select", "would overwrite"));
    expect_misfit(&(export_request){.select_path = "wall.obj"}, TEXTS("--select"));
    assert_true(export_request_fits(&(export_request){"x.pvd", "x.PLY", "-", false, false}, NULL, 0, &error));
    assert_true(export_request_fits(&(export_request){"x", "x", "x", false, false}, NULL, 0, &error));
}

static void expect_unopened(const export_request *request, const char *text) {
    export_scene s;
    io_error error = {""};
    export_scene_open(&s, &folder, false);
    assert_false(exports_open(request, &s.recording, &s.parts, NULL, &s.exports, &error));
    if (strstr(error.text, text) == NULL) fail_msg("no '%s' in: %s", text, error.text);
    export_scene_close(&s);
}

/* A mesh that somebody else wrote stays, byte for byte. */
static void meshes_of_others_are_not_written_over(void **state) {
    (void)state;
    static const char older[] =
        "ply\nformat binary_little_endian 1.0\ncomment cscd plan 1\nelement vertex 0\n";
    const temp_path mine = temp_file_write(&folder, "mine_0008.ply", older, strlen(older));
    const temp_path stem = temp_file_path(&folder, "mine");
    expect_unopened(&(export_request){.ply_path = stem.text}, "mine_0008.ply' exists");
    char *text = read_whole_file(mine.text, NULL);
    assert_string_equal(text, older);
    free(text);
    const temp_path missing = temp_file_path(&folder, "missing/out");
    expect_unopened(&(export_request){.ply_path = missing.text}, "missing/out_0007.ply: cannot write");
    expect_unopened(&(export_request){.vtk_path = missing.text}, "missing/out.pvd: cannot write");
    expect_unopened(&(export_request){.select_path = missing.text}, "missing/out: cannot write");
}

/* Frames that are read from a folder would have the exported ones among them the next time. */
static void a_folder_of_frames_gets_no_meshes(void **state) {
    (void)state;
    io_error error = {""};
    const temp_path stem = temp_file_path(&folder, "more");
    const char *frames = folder.path;
    recorded_object object = {.source = {.frame_paths = &frames, .frame_path_count = 1}};
    recording r = {.objects = &object, .object_count = 1};
    exports out;
    assert_false(exports_open(&(export_request){.ply_path = stem.text}, &r, NULL, NULL, &out, &error));
    assert_non_null(strstr(error.text, "among the frames"));
}

static void nothing_asked_for_is_nothing_done(void **state) {
    (void)state;
    export_scene s;
    export_scene_open(&s, &folder, false);
    export_scene_start(&s, &(export_request){.contacts = true});
    assert_null(s.exports.run);
    export_scene_add_frame(&s, 0);
    export_scene_close(&s);
}

/* ---- the tool -------------------------------------------------------------------------------------------- */

static bool is_there(const char *name) {
    const temp_path path = temp_file_path(&folder, name);
    return access(path.text, F_OK) == 0;
}

static void the_tool_writes_what_is_asked_for(void **state) {
    (void)state;
    export_scene s;
    export_scene_open(&s, &folder, false);
    char bar[700], frames[700];
    snprintf(bar, sizeof bar, "bar=%s", s.bar_path.text);
    snprintf(frames, sizeof frames, "bar=%s", s.bar_pattern.text);
    const temp_path check = temp_file_path(&folder, "checked"),
                    replay = temp_file_path(&folder, "replayed.pvd");
    const temp_path again = temp_file_path(&folder, "again.json"),
                    first = temp_file_path(&folder, "checked_0007.ply");
    EXPECT_TOOL(0, "check", s.wall_path.text, "--object", bar, "--frames-of", frames, "--quiet", "--ply",
                check.text, "--select", list_path.text, "--vtk", check.text, "--no-depths");
    EXPECT_TOOL(0, "replay", s.wall_path.text, "--object", bar, "--frames-of", frames, "--quiet", "--vtk",
                replay.text, "--select", again.text, "--frames", "8:");
    assert_true(is_there("checked_0009.ply") && is_there("checked.pvd") && is_there("checked_0009.vtp"));
    assert_false(is_there("checked_curves.pvd"));
    assert_true(is_there("replayed.pvd") && is_there("replayed_curves_0009.vtp"));
    assert_false(is_there("replayed_0007.vtp"));
    EXPECT_TOOL(3, "check", first.text, "--quiet", "--fail-on", "crossing");
    json_node *lists = json_node_read_file(again.text);
    assert_int_equal(json_node_member(lists, "frames")->count, 1);
    json_node_free(lists);
    EXPECT_ERROR(2, TEXTS("--no-check"), "replay", "a.obj", "a.pc2", "--no-check", "--vtk", "x");
    EXPECT_ERROR(2, TEXTS("--vtk", "ends in .pvd"), "check", "a.obj", "--vtk", "x.png");
    EXPECT_ERROR(2, TEXTS("--select", "overwrite"), "check", "a.obj", "--json", "x.json", "--select",
                 "x.json");
    EXPECT_ERROR(2, TEXTS("standard output twice"), "replay", "a.obj", "a.pc2", "--json", "-", "--select",
                 "-");
    export_scene_close(&s);
}

/* Fails unless the vertices of a part are the corners of its polygons, which are triangles of the scene. */
static void expect_own_corners(const json_node *part, const recorded *scene) {
    const json_node *vertices = json_node_member(part, "vertices"),
                    *polygons = json_node_member(part, "polygons");
    int used[28] = {0};
    size_t count = 0;
    for (size_t i = 0; i < polygons->count; i++)
        for (size_t k = 0; k < 3; k++)
            used[scene->triangles[3 * (size_t)json_node_item(polygons, i)->number + k]] = 1;
    for (int v = 0; v < 28; v++)
        if (used[v]) assert_int_equal(json_node_item(vertices, count++)->number, v);
    assert_int_equal(vertices->count, count);
    assert_true(count > 0);
}

/* Corners are those that a face has in the file, also where another vertex stands for them. */
static void welded_corners_are_those_of_the_file(void **state) {
    (void)state;
    recorded scene = recorded_cube(true);
    const temp_path model = recorded_write_mesh(&folder, "cube.obj", &scene, 0);
    const temp_path cache = recorded_write_cache(&folder, "cube.pc2", &scene);
    EXPECT_TOOL(0, "check", model.text, cache.text, "--quiet", "--weld", "exact", "--select", list_path.text);
    json_node *root = json_node_read_file(list_path.text);
    const json_node *parts = json_node_member(root, "union");
    assert_int_equal(parts->count, 2);
    for (size_t i = 0; i < 2; i++) expect_own_corners(json_node_item(parts, i), &scene);
    json_node_free(root);
    recorded_free(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_name_what_to_select),
        cmocka_unit_test(the_union_has_what_any_frame_has),
        cmocka_unit_test(names_of_other_formats_are_refused),
        cmocka_unit_test(meshes_of_others_are_not_written_over),
        cmocka_unit_test(a_folder_of_frames_gets_no_meshes),
        cmocka_unit_test(nothing_asked_for_is_nothing_done),
        cmocka_unit_test(the_tool_writes_what_is_asked_for),
        cmocka_unit_test(welded_corners_are_those_of_the_file),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
