/* `info`: the parts that a file names, and everything as JSON. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static temp_path named, json;

/* A tetrahedron of two parts and a square in none, with a vertex that nothing uses and faces to repair. */
static const char text[] = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\n"
                           "v 9 0 0\nv 10 0 0\nv 10 1 0\nv 9 1 0\nv -1 -2 -3\n"
                           "f 5 6 7 8\n"
                           "o Body\ng Base\nf 1 3 2\ng Top\nf 1 2 4\nf 2 3 3 4\nf 3 3 1\nf 3 1 4\nf 1 2\n";

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    named = temp_file_write(&folder, "named.obj", text, strlen(text));
    json = temp_file_path(&folder, "info.json");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static void expect_line(const char *out, const char *line) {
    if (strstr(out, line) == NULL) fail_msg("expected '%s' in: %s", line, out);
}

static void parts_are_listed(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("info", named.text);
    assert_int_equal(run.code, 0);
    expect_line(run.out, "parts       2: Body/Base (1 triangle), Body/Top (3 triangles); 2 in none\n");
    expect_line(run.out, "vertices    9 (1 of them in no triangle)\n");
    expect_line(run.out, "bounds      (-1, -2, -3) to (10, 4, 4)\n");
    tool_run_free(&run);
}

static void many_parts_are_cut_short(void **state) {
    (void)state;
    temp_path many = temp_file_path(&folder, "many.obj");
    FILE *file = fopen(many.text, "w");
    fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\n", file);
    for (int i = 0; i < 23; i++)
        fprintf(file, "o P%d\nv %d 0 1\nv %d 1 1\nv %d 0 2\nf -3 -2 -1\n", i, 3 * i, 3 * i, 3 * i);
    fclose(file);
    tool_run run = RUN_TOOL("info", many.text);
    expect_line(run.out, "parts       23: P0 (1 triangle), P1 (1 triangle), ");
    expect_line(run.out, "P19 (1 triangle), and 3 more\n");
    tool_run_free(&run);
    recorded torus = recorded_torus(12, 8);
    temp_path plain = recorded_write_mesh(&folder, "plain.obj", &torus, 0);
    run = RUN_TOOL("info", plain.text);
    expect_line(run.out, "parts       the file names none\n");
    tool_run_free(&run);
    recorded_free(&torus);
}

static void expect_repair(const json_node *repairs, const char *what, double faces, double first) {
    const json_node *repair = json_node_member(repairs, what);
    assert_int_equal(json_node_number(repair, "faces"), faces);
    if (faces > 0)
        assert_int_equal(json_node_number(repair, "first"), first);
    else
        assert_int_equal(json_node_member(repair, "first")->kind, JSON_NULL);
}

static void expect_component(const json_node *c, double vertices, double edges, double triangles,
                             bool closed) {
    assert_int_equal(json_node_number(c, "vertices"), vertices);
    assert_int_equal(json_node_number(c, "edges"), edges);
    assert_int_equal(json_node_number(c, "triangles"), triangles);
    assert_int_equal(json_node_number(c, "euler_characteristic"), vertices - edges + triangles);
    assert_int_equal(json_node_boolean(c, "closed"), closed);
    if (closed)
        assert_int_equal(json_node_number(c, "genus"), 0);
    else
        assert_int_equal(json_node_member(c, "genus")->kind, JSON_NULL);
    assert_int_equal(json_node_number(c, "open_edges"), closed ? 0 : 4);
    assert_int_equal(json_node_number(c, "non_manifold_edges"), 0);
    assert_int_equal(json_node_number(c, "non_manifold_vertices"), 0);
    assert_int_equal(json_node_number(c, "inconsistent_edges"), 0);
}

/* Faces 3, 4 and 6, counted from 0, are shortened, left without three corners, and too short. */
static void everything_is_in_the_json(void **state) {
    (void)state;
    EXPECT_TOOL(0, "info", named.text, "--json", json.text);
    json_node *root = json_node_read_file(json.text);
    assert_string_equal(json_node_string(root, "file"), named.text);
    assert_int_equal(json_node_number(root, "file_vertices"), 9);
    assert_int_equal(json_node_number(root, "file_faces"), 7);
    assert_int_equal(json_node_number(root, "vertices"), 9);
    assert_int_equal(json_node_number(root, "unused_vertices"), 1);
    assert_int_equal(json_node_number(root, "edges"), 6 + 5);
    assert_int_equal(json_node_number(root, "triangles"), 6);
    assert_int_equal(json_node_number(root, "zero_area_triangles"), 0);
    assert_int_equal(json_node_number(root, "pairs"), 0);
    static const double low[3] = {-1, -2, -3}, high[3] = {10, 4, 4};
    for (size_t k = 0; k < 3; k++) {
        assert_true(json_node_item(json_node_member(root, "low"), k)->number == low[k]);
        assert_true(json_node_item(json_node_member(root, "high"), k)->number == high[k]);
    }
    const json_node *repairs = json_node_member(root, "repairs"), *parts = json_node_member(root, "parts");
    expect_repair(repairs, "shortened", 1, 3);
    expect_repair(repairs, "dropped", 2, 4);
    expect_repair(repairs, "fanned", 0, 0);
    assert_int_equal(json_node_number(repairs, "skipped_primitives"), 0);
    assert_int_equal(parts->count, 2);
    assert_string_equal(json_node_string(json_node_item(parts, 1), "name"), "Body/Top");
    assert_int_equal(json_node_number(json_node_item(parts, 1), "triangles"), 3);
    const json_node *components = json_node_member(root, "components");
    assert_int_equal(components->count, 2);
    const bool square_first = !json_node_boolean(json_node_item(components, 0), "closed");
    expect_component(json_node_item(components, square_first ? 0 : 1), 4, 5, 2, false);
    expect_component(json_node_item(components, square_first ? 1 : 0), 4, 6, 4, true);
    json_node_free(root);
    remove(json.text);
}

static void intersections_and_flat_triangles_are_counted(void **state) {
    (void)state;
    static const char crossed[] = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nv 9 9 9\nv 8 8 8\n"
                                  "v 7 7 7\nf 1 2 3\nf 4 5 6\nf 7 8 9\n";
    temp_path path = temp_file_write(&folder, "crossed.obj", crossed, strlen(crossed));
    EXPECT_TOOL(0, "info", path.text, "--json", json.text);
    json_node *root = json_node_read_file(json.text);
    assert_int_equal(json_node_number(root, "pairs"), 1);
    assert_int_equal(json_node_number(root, "zero_area_triangles"), 1);
    assert_int_equal(json_node_member(root, "parts")->count, 0);
    json_node_free(root);
    remove(json.text);
}

/* Corners of STL files in one place are one vertex, whatever ending the file has. */
static void stl_files_are_welded_by_what_is_in_them(void **state) {
    (void)state;
    static const char corners[4][3][4] = {
        {"000", "040", "400"}, {"000", "400", "004"}, {"000", "004", "040"}, {"400", "040", "004"}};
    static const char *const names[] = {"scan.stl", "scan.dat", "scan.obj"};
    char stl[2048] = "solid scan\n";
    for (int f = 0; f < 4; f++) {
        strcat(stl, "facet normal 0 0 0\nouter loop\n");
        for (int k = 0; k < 3; k++) {
            char line[64];
            snprintf(line, sizeof line, "vertex %c %c %c\n", corners[f][k][0], corners[f][k][1],
                     corners[f][k][2]);
            strcat(stl, line);
        }
        strcat(stl, "endloop\nendfacet\n");
    }
    strcat(stl, "endsolid scan\n");
    for (int i = 0; i < 3; i++) {
        temp_path path = temp_file_write(&folder, names[i], stl, strlen(stl));
        tool_run run = RUN_TOOL("info", path.text, "--json", json.text);
        expect_line(run.error, "the 12 vertices of the STL file are joined to 4");
        tool_run_free(&run);
        json_node *root = json_node_read_file(json.text);
        assert_int_equal(json_node_number(root, "file_vertices"), 12);
        assert_int_equal(json_node_number(root, "vertices"), 4);
        json_node_free(root);
        remove(json.text);
    }
}

static void outputs_are_as_everywhere(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("info", named.text, "--json", "-");
    size_t at;
    json_node *root = json_node_parse(run.out, run.out_size, &at);
    assert_int_equal(run.code, 0);
    assert_non_null(root);
    expect_line(run.error, "parts       2: Body/Base");
    json_node_free(root);
    tool_run_free(&run);
    EXPECT_ERROR(2, TEXTS("--json", "would overwrite"), "info", named.text, "--json", named.text);
    EXPECT_ERROR(2, TEXTS("--json", "ends in .json"), "info", named.text, "--json", "x.csv");
    EXPECT_ERROR(1, TEXTS("/nowhere/x.json", "cannot write"), "info", named.text, "--json",
                 "/nowhere/x.json");
    tool_run full = RUN_TOOL("info", named.text, "--json", "/dev/full");
    assert_int_equal(full.code, 1);
    expect_line(full.error, "/dev/full: cannot write: No space left on device");
    tool_run_free(&full);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_are_listed),
        cmocka_unit_test(many_parts_are_cut_short),
        cmocka_unit_test(everything_is_in_the_json),
        cmocka_unit_test(intersections_and_flat_triangles_are_counted),
        cmocka_unit_test(stl_files_are_welded_by_what_is_in_them),
        cmocka_unit_test(outputs_are_as_everywhere),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
