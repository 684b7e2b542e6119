/* The commands that look at single frames: check and info. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 8 };

static temp_folder folder;
static temp_path model, cache, json;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded flight = recorded_tetrahedra(FRAMES);
    model = recorded_write_mesh(&folder, "flight.obj", &flight, 0);
    cache = recorded_write_cache(&folder, "flight.pc2", &flight);
    json = temp_file_path(&folder, "check.json");
    recorded_free(&flight);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static void check_lists_crossing_frames(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("check", model.text, cache.text);
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "");
    expect_start(run.out, "Frames 4 to 7 cross (4 of 8). 1 event, component 0 x component 1, frames 4 to 7");
    tool_run_free(&run);
    EXPECT_TOOL(3, "check", model.text, cache.text, "--fail-on-contact");
    EXPECT_TOOL(0, "check", model.text, cache.text, "--fail-on-contact", "--frames", ":3");
    EXPECT_TOOL(3, "check", model.text, cache.text, "--fail-on-contact", "--frames", "4");
    EXPECT_TOOL(0, "check", model.text, "--fail-on-contact");
    run = RUN_TOOL("check", model.text, cache.text, "--frames", "1::3");
    expect_start(run.out, "Frames 4 to 7 cross (2 of 3). ");
    tool_run_free(&run);
    static const char *const wrong[] = {":", "1:2:", "1:2:0", "1:2:x", "1:2:3:4", "5:2", "::", ""};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        EXPECT_ERROR(2, TEXTS("--frames cannot be '"), "check", model.text, cache.text, "--frames", wrong[i]);
    EXPECT_ERROR(1, TEXTS("no frame 8", "frames 0 to 7"), "check", model.text, cache.text, "--frames",
                 "3:8:5");
    EXPECT_ERROR(2, TEXTS("a step of 2", "replay takes A:B only"), "replay", model.text, cache.text,
                 "--frames", "0:4:2");
    run = RUN_TOOL("check", model.text, cache.text, "--quiet");
    assert_string_equal(run.out, "");
    tool_run_free(&run);
}

/* Checks that each pair joins a triangle of one tetrahedron to one of the other. */
static void check_pairs(const json_node *pairs) {
    for (const json_node *pair = pairs->first; pair != NULL; pair = pair->next) {
        assert_int_equal(pair->count, 2);
        double a = json_node_item(pair, 0)->number, b = json_node_item(pair, 1)->number;
        assert_true(a >= 0 && a < 4 && b >= 4 && b < 8);
    }
}

static void check_writes_every_frame(void **state) {
    (void)state;
    EXPECT_TOOL(0, "check", model.text, cache.text, "--json", json.text);
    json_node *root = json_node_read_file(json.text);
    const json_node *frames = json_node_member(root, "frames");
    assert_true(json_node_boolean(root, "complete"));
    assert_int_equal(frames->count, FRAMES);
    for (size_t k = 0; k < FRAMES; k++) {
        const json_node *frame = json_node_item(frames, k), *pairs = json_node_member(frame, "pairs");
        assert_true(json_node_number(frame, "frame") == (double)k);
        assert_true(json_node_boolean(frame, "crossing") == (k >= 4));
        assert_true((pairs->count > 0) == (k >= 4));
        assert_true(json_node_number(frame, "zero_area_triangles") == 0);
        check_pairs(pairs);
    }
    json_node_free(root);
}

static void check_keeps_what_precedes_a_bad_frame(void **state) {
    (void)state;
    recorded flight = recorded_tetrahedra(FRAMES), other = recorded_cube(false);
    temp_path pattern = recorded_write_sequence(&folder, "f_%02d.ply", &flight);
    recorded_write_mesh(&folder, "f_05.ply", &other, 0);
    tool_run run = RUN_TOOL("check", model.text, pattern.text, "--json", json.text);
    assert_int_equal(run.code, 1);
    expect_in(run.error, "f_05.ply");
    expect_start(run.out, "Not finished: frame 5 could not be read: ");
    expect_in(run.out, "5 of 8 frames checked. Frame 4 crosses (1 of 5). ");
    tool_run_free(&run);
    json_node *root = json_node_read_file(json.text);
    assert_false(json_node_boolean(root, "complete"));
    expect_in(json_node_string(root, "stopped_by"), "f_05.ply");
    assert_int_equal(json_node_member(root, "frames")->count, 5);
    json_node_free(root);
    recorded_free(&flight);
    recorded_free(&other);
}

/* That listed files are not taken as they were given is good to know, and no warning. */
static void the_order_of_files_is_a_note(void **state) {
    (void)state;
    recorded flight = recorded_tetrahedra(3);
    temp_path paths[3];
    for (uint32_t i = 0; i < 3; i++) {
        char name[32];
        snprintf(name, sizeof name, "listed_%u.obj", i + 9);
        paths[i] = recorded_write_mesh(&folder, name, &flight, i);
    }
    tool_run run = RUN_TOOL("check", paths[1].text, paths[2].text, paths[0].text);
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "cscd: the frames are taken in the order of their numbers\n");
    tool_run_free(&run);
    recorded_free(&flight);
}

/* Expects everything that info prints about a mesh, on stdout and stderr. */
static void expect_info(const recorded *r, const char *out, const char *error) {
    temp_path path = recorded_write_mesh(&folder, "info.obj", r, 0);
    tool_run run = RUN_TOOL("info", path.text);
    assert_int_equal(run.code, 0);
    expect_in(run.out, out);
    if (error != NULL)
        expect_in(run.error, error);
    else
        assert_string_equal(run.error, "");
    tool_run_free(&run);
}

static void info_describes_closed_meshes(void **state) {
    (void)state;
    recorded flight = recorded_tetrahedra(1), torus = recorded_torus(12, 8);
    expect_info(&flight, "vertices    8\nedges       12\ntriangles   8\n", NULL);
    expect_info(&flight, "components  2\n", NULL);
    expect_info(&flight, "bounds      (-4, 0, 0) to (7.5, 4, 4)\n", NULL);
    expect_info(&flight, "4 vertices, 6 edges, 4 triangles, Euler characteristic 2, closed, genus 0\n", NULL);
    expect_info(&torus, "components  1\n", NULL);
    expect_info(&torus, "96 vertices, 288 edges, 192 triangles, Euler characteristic 0, closed, genus 1\n",
                NULL);
    expect_info(&torus, "zero area   0 triangles\npairs       0 of triangles", NULL);
    recorded_free(&flight);
    recorded_free(&torus);
}

static void info_describes_defects(void **state) {
    (void)state;
    recorded sheet = recorded_fold(8, 2, 1), bow_tie = recorded_bow_tie(), turned = recorded_torus(12, 8);
    expect_info(
        &sheet, "not a closed surface: 20 open edges, 0 non-manifold edges, 0 non-manifold vertices",
        "cscd: component 0 is an open surface, as cloth is (20 open edges, the first joins vertices 0 and 1): nothing is missed");
    expect_info(&bow_tie, "components  1\n", "1 non-manifold vertices (the first is 0)");
    expect_info(&bow_tie, "0 open edges, 0 non-manifold edges, 1 non-manifold vertices", "");
    turned.triangles[0] = 1;
    turned.triangles[1] = 0;
    expect_info(&turned, "3 inconsistently oriented edges", "3 inconsistently oriented edges");
    recorded_free(&sheet);
    recorded_free(&bow_tie);
    recorded_free(&turned);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_lists_crossing_frames),
        cmocka_unit_test(check_writes_every_frame),
        cmocka_unit_test(check_keeps_what_precedes_a_bad_frame),
        cmocka_unit_test(the_order_of_files_is_a_note),
        cmocka_unit_test(info_describes_closed_meshes),
        cmocka_unit_test(info_describes_defects),
    };
    return cmocka_run_group_tests_name("tool_views", tests, make_files, remove_files);
}
