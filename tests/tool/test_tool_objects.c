/* The tool takes several meshes, each with its own frames, as one recording. */
#include "tests/support/test.h"
#include "tests/support/tool/contact_rows.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/soft_bar.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 8, VERTICES = 4, TRIANGLES = 4 };

static temp_folder folder;
static temp_path model, cache;           /* both tetrahedra as one mesh */
static temp_path wall_model, wall_cache; /* 0 1 2 3 of it */
static temp_path dart_model, dart_cache; /* 4 5 6 7 */
static temp_path wall_object, dart_object, dart_frames, wall_frames, out;

/* One of the two tetrahedra of a recording: `which` is 0 or 1. */
static recorded take_tetrahedron(const recorded *both, uint32_t which) {
    recorded r = {VERTICES, TRIANGLES, both->frame_count, NULL, NULL};
    r.triangles = malloc(TRIANGLES * 3 * sizeof *r.triangles);
    r.frames = malloc((size_t)r.frame_count * VERTICES * 3 * sizeof *r.frames);
    assert_true(r.triangles != NULL && r.frames != NULL);
    for (uint32_t i = 0; i < TRIANGLES * 3; i++)
        r.triangles[i] = both->triangles[which * TRIANGLES * 3 + i] - which * VERTICES;
    for (uint32_t k = 0; k < r.frame_count; k++)
        memcpy(r.frames + (size_t)k * VERTICES * 3, recorded_position(both, k, which * VERTICES),
               VERTICES * 3 * sizeof *r.frames);
    return r;
}

static temp_path named_path_of(const char *name, const temp_path *path) {
    temp_path text;
    int length = snprintf(text.text, sizeof text.text, "%s=%.480s", name, path->text);
    assert_true((size_t)length == strlen(name) + 1 + strlen(path->text));
    return text;
}

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded both = recorded_tetrahedra(FRAMES), wall = take_tetrahedron(&both, 0),
             dart = take_tetrahedron(&both, 1);
    model = recorded_write_mesh(&folder, "both.obj", &both, 0);
    cache = recorded_write_cache(&folder, "both.pc2", &both);
    wall_model = recorded_write_mesh(&folder, "wall.obj", &wall, 0);
    wall_cache = recorded_write_cache(&folder, "wall.pc2", &wall);
    dart_model = recorded_write_mesh(&folder, "dart.obj", &dart, 0);
    dart_cache = recorded_write_cache(&folder, "dart.pc2", &dart);
    wall_object = named_path_of("wall", &wall_model);
    wall_frames = named_path_of("wall", &wall_cache);
    dart_object = named_path_of("dart", &dart_model);
    dart_frames = named_path_of("dart", &dart_cache);
    out = temp_file_path(&folder, "out.jsonl");
    recorded_free(&both);
    recorded_free(&wall);
    recorded_free(&dart);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* The objects that the lines of a contact file name, moved into vertex numbers of the common mesh. */
static void number_vertices(contact_rows *rows) {
    char *text = read_whole_file(out.text, NULL), *rest = text;
    for (size_t i = 0; i < rows->count; i++) {
        char *line = strsep(&rest, "\n");
        json_node *node = json_node_parse(line, strlen(line), NULL);
        const json_node *objects = json_node_member(node, "objects");
        uint32_t first[2];
        for (size_t k = 0; k < 2; k++)
            first[k] = strcmp(json_node_item(objects, k)->text, "dart") == 0 ? VERTICES : 0;
        contact_record *row = &rows->items[i];
        bool vf = row->kind == CSCD_CONTACT_VF;
        for (int k = 0; k < (vf ? 1 : 2); k++) row->a[k] += first[0];
        for (int k = 0; k < (vf ? 3 : 2); k++) row->b[k] += first[1];
        json_node_free(node);
    }
    free(text);
}

static contact_rows contacts_of_both(void) {
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--quiet", "--method", "none", "--contacts", out.text);
    return contact_rows_read_jsonl(out.text);
}

/* ---- contacts ---------------------------------------------------------------------------------------- */

static void objects_meet_as_in_one_mesh(void **state) {
    (void)state;
    contact_rows expected = contacts_of_both();
    assert_true(expected.count > 0);
    EXPECT_TOOL(0, "replay", wall_model.text, wall_cache.text, "--object", dart_object.text, "--frames-of",
                dart_frames.text, "--quiet", "--method", "none", "--contacts", out.text);
    contact_rows found = contact_rows_read_jsonl(out.text);
    number_vertices(&found);
    contact_rows_assert_equal(&found, &expected);
    contact_rows_free(&found);
    contact_rows_free(&expected);
}

static void objects_without_frames_rest(void **state) {
    (void)state;
    contact_rows expected = contacts_of_both(); /* where the first tetrahedron rests, too */
    EXPECT_TOOL(0, "replay", "--object", wall_object.text, "--frames-of", dart_frames.text, "--object",
                dart_object.text, "--quiet", "--method", "none", "--contacts", out.text);
    contact_rows found = contact_rows_read_jsonl(out.text);
    number_vertices(&found);
    contact_rows_assert_equal(&found, &expected);
    contact_rows_free(&found);
    contact_rows_free(&expected);
}

static void obstacles_do_not_meet_each_other(void **state) {
    (void)state;
    const temp_path csv = temp_file_path(&folder, "out.csv");
    char *text;
    EXPECT_TOOL(0, "replay", "--obstacle", wall_object.text, "--obstacle", dart_object.text, "--frames-of",
                dart_frames.text, "--quiet", "--no-check", "--contacts", csv.text);
    text = read_whole_file(csv.text, NULL);
    assert_string_equal(text, "frame,kind,toi,a0,a1,b0,b1,b2,u,v,x,y,z,nx,ny,nz,object_a,object_b\n");
    free(text);
}

static void tables_name_objects_in_quotes(void **state) {
    (void)state;
    const temp_path csv = temp_file_path(&folder, "quoted.csv"), odd = named_path_of("a \"b\"", &wall_model);
    EXPECT_TOOL(0, "replay", "--object", odd.text, "--object", dart_object.text, "--frames-of",
                dart_frames.text, "--quiet", "--contacts", csv.text);
    char *text = read_whole_file(csv.text, NULL);
    assert_non_null(strstr(text, ",\"dart\",\"a \"\"b\"\"\"\n"));
    free(text);
}

/* ---- checks ------------------------------------------------------------------------------------------ */

static size_t pairs_of_frame(const char *option, const char *value, size_t frame) {
    const temp_path json = temp_file_path(&folder, "check.json");
    EXPECT_TOOL(0, "check", wall_model.text, "--object", dart_object.text, "--frames-of", dart_frames.text,
                "--quiet", "--json", json.text, option, value);
    json_node *root = json_node_read_file(json.text);
    const json_node *frames = json_node_member(root, "frames");
    assert_int_equal(frames->count, FRAMES);
    size_t count = json_node_member(json_node_item(frames, frame), "pairs")->count;
    json_node_free(root);
    return count;
}

static void lists_of_pairs_name_objects(void **state) {
    (void)state;
    char text[512];
    int used = 0;
    for (int a = 0; a < TRIANGLES; a++)
        for (int b = 0; b < TRIANGLES; b++)
            used += snprintf(text + used, sizeof text - (size_t)used, "wall:%d dart:%d\n", a, b);
    const temp_path list = temp_file_write(&folder, "pairs.txt", text, (size_t)used);
    assert_true(pairs_of_frame("--threads", "1", 5) > 0);
    assert_int_equal(pairs_of_frame("--ignore", list.text, 5), 0);
    const temp_path bad = temp_file_write(&folder, "bad.txt", "wall:1 hat:2\n", 13);
    EXPECT_ERROR(1, TEXTS("bad.txt:1", "NAME:A NAME:B"), "check", wall_model.text, "--object",
                 dart_object.text, "--ignore", bad.text);
}

/* ---- errors ------------------------------------------------------------------------------------------ */

static void unfit_objects_are_refused(void **state) {
    (void)state;
    recorded both = recorded_tetrahedra(FRAMES + 2), dart = take_tetrahedron(&both, 1);
    const temp_path longer = recorded_write_cache(&folder, "longer.pc2", &dart),
                    longer_frames = named_path_of("dart", &longer);
    EXPECT_ERROR(1, TEXTS("wall has 8 frames", "dart has 10", "longer.pc2"), "replay", wall_model.text,
                 wall_cache.text, "--object", dart_object.text, "--frames-of", longer_frames.text);
    EXPECT_ERROR(1, TEXTS("two objects are called wall"), "replay", wall_model.text, wall_cache.text,
                 "--object", wall_object.text);
    EXPECT_ERROR(1, TEXTS("--frames-of dart", "no object of that name"), "replay", wall_model.text,
                 wall_cache.text, "--frames-of", dart_frames.text);
    EXPECT_ERROR(1, TEXTS("--frames-of wall", "has frames already"), "replay", wall_model.text,
                 wall_cache.text, "--frames-of", wall_frames.text);
    EXPECT_ERROR(2, TEXTS("--object cannot be 'dart'"), "check", wall_model.text, "--object", "dart");
    EXPECT_ERROR(2, TEXTS("--object cannot be '=x.obj'"), "check", wall_model.text, "--object", "=x.obj");
    EXPECT_ERROR(2, TEXTS("--object cannot be 'a:b=x.obj'"), "check", wall_model.text, "--object",
                 "a:b=x.obj");
    EXPECT_ERROR(2, TEXTS("no MODEL given"), "check");
    EXPECT_ERROR(2, TEXTS("no FRAMES given"), "replay", "--object", dart_object.text);
    recorded_free(&both);
    recorded_free(&dart);
}

static void errors_in_frames_name_their_object(void **state) {
    (void)state;
    recorded both = recorded_tetrahedra(3), dart = take_tetrahedron(&both, 1);
    dart.frames[(2 * VERTICES + 3) * 3] = 1e-320;
    const temp_path spoilt = recorded_write_mesh(&folder, "s_1002.obj", &dart, 2);
    recorded_write_mesh(&folder, "s_1000.obj", &dart, 0);
    recorded_write_mesh(&folder, "s_1001.obj", &dart, 1);
    temp_path pattern = temp_file_path(&folder, "s_%d.obj"), frames = named_path_of("dart", &pattern);
    (void)spoilt;
    EXPECT_ERROR(1, TEXTS("frame 1002 could not be read: dart: vertex 3 has x"), "check", wall_model.text,
                 "--object", dart_object.text, "--frames-of", frames.text);
    recorded_free(&both);
    recorded_free(&dart);
}

static void differing_numbers_are_told(void **state) {
    (void)state;
    recorded both = recorded_tetrahedra(3), wall = take_tetrahedron(&both, 0),
             dart = take_tetrahedron(&both, 1);
    const temp_path numbered = recorded_write_sequence(&folder, "n_%d.obj", &dart),
                    frames = named_path_of("dart", &numbered),
                    pc2 = recorded_write_cache(&folder, "n.pc2", &wall);
    for (int k = 0; k < 3; k++) {
        char from[32], to[32];
        snprintf(from, sizeof from, "n_%d.obj", k);
        snprintf(to, sizeof to, "n_%d.obj", k + 11);
        assert_int_equal(rename(temp_file_path(&folder, from).text, temp_file_path(&folder, to).text), 0);
    }
    tool_run run = RUN_TOOL("check", wall_model.text, pc2.text, "--object", dart_object.text, "--frames-of",
                            frames.text);
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.error, "dart calls its frames 11 to 13, and wall calls them 0 to 2"));
    tool_run_free(&run);
    recorded_free(&both);
    recorded_free(&wall);
    recorded_free(&dart);
}

/* ---- plans ------------------------------------------------------------------------------------------- */

/* The bar is the last object, so that its triangles have other numbers in the mesh than in its model. */
static void expect_regions(const char *bar_name, double soft, const char *expected) {
    const temp_path bar = soft_bar_write(&folder, bar_name, soft, false), object = named_path_of("bar", &bar);
    tool_run run = RUN_TOOL("replay", "--object", wall_object.text, "--object", dart_object.text,
                            "--frames-of", dart_frames.text, "--object", object.text, "--no-check");
    assert_int_equal(run.code, 0);
    if (strstr(run.out, expected) == NULL) fail_msg("expected '%s' in: %s", expected, run.out);
    tool_run_free(&run);
}

static void every_object_has_the_stiffness_of_its_model(void **state) {
    (void)state;
    expect_regions("even.ply", 3.0, "plan: charge, 3 regions, made in memory in ");
    expect_regions("soft.ply", 0.25, "plan: charge, 4 regions, made in memory in ");
    const temp_path bad = soft_bar_write_bad(&folder, "bad.ply", 90, -1.0),
                    object = named_path_of("bar", &bad);
    tool_run run = RUN_TOOL("replay", "--object", wall_object.text, "--object", dart_object.text,
                            "--frames-of", dart_frames.text, "--object", object.text, "--method", "charge");
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.error, "bad.ply: the stiffness of face 90 is -1, expected"));
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(objects_meet_as_in_one_mesh),
        cmocka_unit_test(objects_without_frames_rest),
        cmocka_unit_test(obstacles_do_not_meet_each_other),
        cmocka_unit_test(tables_name_objects_in_quotes),
        cmocka_unit_test(lists_of_pairs_name_objects),
        cmocka_unit_test(unfit_objects_are_refused),
        cmocka_unit_test(errors_in_frames_name_their_object),
        cmocka_unit_test(differing_numbers_are_told),
        cmocka_unit_test(every_object_has_the_stiffness_of_its_model),
    };
    return cmocka_run_group_tests_name("tool_objects", tests, make_files, remove_files);
}
