/* `check --each`: many different meshes, a line for each, in their order, whatever happens to one of them. */
#include "cscd/cscd.h"
#include "src/io/mesh_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <glob.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FLIGHT = 8, LARGE = 2, MESHES = LARGE + FLIGHT + 6, ARGUMENTS = 1200 };

static temp_folder folder;
/* Two large meshes, the frames of a flight, and small ones of single kinds. The large ones come first, so that whoever
 * checks the others has to wait. */
static temp_path meshes[MESHES], clean, touching, damaged, named, lines;

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

#define SQUARE "v 0 0 0\nv 4 0 0\nv 0 4 0\n"

static void make_small_meshes(temp_path *out) {
    out[0] = clean = write_text("clean.obj", SQUARE "v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\nf 4 5 6\n");
    out[1] = touching = write_text("touching.obj", SQUARE "v 1 1 0\nv 2 1 5\nv 1 2 5\nf 1 2 3\nf 4 5 6\n");
    out[2] = write_text("plane.obj", SQUARE "v 1 1 0\nv 3 1 0\nv 1 3 0\nf 1 2 3\nf 4 5 6\n");
    out[3] = write_text("twice.obj", SQUARE "f 1 2 3\nf 2 3 1\n");
    out[5] = write_text("mixed.obj", SQUARE "v 1 1 -1\nv 1 1 1\nv 2 1 1\nv 1 2 0\nv 2 2 9\nv 1 3 9\n"
                                            "f 1 2 3\nf 4 5 6\nf 7 8 9\n");
    out[4] = write_text("folded.obj", SQUARE "v 3 3 0\nv 1 1 0\nf 1 2 3\nf 1 2 5\n");
}

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded fold = recorded_fold(60, 40, 6), flight = recorded_tetrahedra(FLIGHT);
    meshes[0] = recorded_write_mesh(&folder, "fold.obj", &fold, 5);
    meshes[1] = recorded_write_mesh(&folder, "open.ply", &fold, 0);
    for (uint32_t i = 0; i < FLIGHT; i++) {
        char name[32];
        snprintf(name, sizeof name, "flight_%u.obj", i);
        meshes[LARGE + i] = recorded_write_mesh(&folder, name, &flight, i);
    }
    recorded_free(&fold);
    recorded_free(&flight);
    make_small_meshes(meshes + LARGE + FLIGHT);
    damaged = write_text("damaged.obj", SQUARE "f 1 2 9\n");
    named =
        write_text("named.obj", SQUARE "v 1 1 -1\nv 1 1 1\nv 2 1 1\no Sheet\nf 1 2 3\no Blade\nf 4 5 6\n");
    lines = temp_file_path(&folder, "out.jsonl");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* Checks all meshes, with further arguments up to NULL. */
static tool_run check_all(const char *const *further) {
    const char *arguments[MESHES + 20] = {"check", "--each"};
    size_t count = 2;
    for (int i = 0; i < MESHES; i++) arguments[count++] = meshes[i].text;
    for (size_t i = 0; further[i] != NULL; i++) arguments[count++] = further[i];
    arguments[count] = NULL;
    return run_tool(arguments);
}

#define CHECK_ALL(...) check_all((const char *const[]){__VA_ARGS__, NULL})

/* The objects of a file of JSON Lines; returns how many there are. */
static size_t read_lines(const char *text, json_node **out, size_t capacity) {
    size_t count = 0, at;
    for (const char *end; (end = strchr(text, '\n')) != NULL; text = end + 1) {
        assert_true(count < capacity);
        out[count] = json_node_parse(text, (size_t)(end - text), &at);
        if (out[count++] == NULL) fail_msg("no JSON from byte %zu on: %.300s", at, text);
    }
    assert_int_equal(text[0], '\0');
    return count;
}

static size_t read_line_file(json_node **out, size_t capacity) {
    char *text = read_whole_file(lines.text, NULL);
    const size_t count = read_lines(text, out, capacity);
    free(text);
    return count;
}

/* ---- answers ----------------------------------------------------------------------------------------- */

/* Asks the library itself: a detector for all kinds, and one for the published share. */
static void expect_answer(const json_node *line, const char *path) {
    mesh_file file;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_intersection_pairs all, crossing;
    cscd_intersection_options count = cscd_intersection_defaults(), share = cscd_intersection_defaults();
    count.answer = CSCD_ANSWER_COUNT;
    share.kinds = cscd_intersection_set(CSCD_INTERSECTION_CROSSING);
    share.parts = true;
    assert_true(mesh_file_read(path, &file, NULL));
    cscd_object_desc object =
        cscd_object_of_triangles(file.vertex_count, file.triangle_count, file.triangles);
    const cscd_view *view = CSCD_DOUBLES(file.positions, file.vertex_count);
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &object, 1, &mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(context, mesh, NULL, NULL, &detector), CSCD_OK);
    assert_int_equal(cscd_detector_find_intersections(detector, view, &count, &all), CSCD_OK);
    assert_int_equal(cscd_detector_find_intersections(detector, view, &share, &crossing), CSCD_OK);
    assert_string_equal(json_node_string(line, "file"), path);
    assert_int_equal(json_node_member(line, "error")->kind, JSON_NULL);
    assert_int_equal(json_node_number(line, "triangles"), file.triangle_count);
    assert_int_equal(json_node_number(line, "vertices"), file.vertex_count);
    assert_int_equal(json_node_number(line, "crossing"), all.crossing);
    assert_int_equal(json_node_number(line, "coplanar"), all.coplanar);
    assert_int_equal(json_node_number(line, "folded"), all.folded);
    assert_int_equal(json_node_number(line, "duplicate"), all.duplicate);
    assert_int_equal(json_node_number(line, "touching"), all.touching);
    assert_int_equal(json_node_number(line, "crossing_faces"), crossing.parts->faces);
    assert_true(json_node_number(line, "crossing_share") == crossing.parts->share);
    assert_true(json_node_number(line, "read_ms") > 0.0 && json_node_number(line, "check_ms") > 0.0);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    mesh_file_free(&file);
}

static void every_mesh_has_its_answer(void **state) {
    (void)state;
    tool_run run = CHECK_ALL("--json", lines.text);
    json_node *nodes[MESHES];
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "");
    assert_int_equal(read_line_file(nodes, MESHES), MESHES);
    static const char *const kinds[5] = {"crossing", "coplanar", "folded", "duplicate", "touching"};
    bool seen[5] = {false};
    for (int i = 0; i < MESHES; i++) {
        expect_answer(nodes[i], meshes[i].text);
        for (int k = 0; k < 5; k++) seen[k] |= json_node_number(nodes[i], kinds[k]) > 0;
        json_node_free(nodes[i]);
    }
    for (int k = 0; k < 5; k++) assert_true(seen[k]);
    tool_run_free(&run);
    remove(lines.text);
}

static void lines_say_it_for_people(void **state) {
    (void)state;
    char expected[8192];
    tool_run run = RUN_TOOL("check", "--each", meshes[LARGE + 4].text, meshes[LARGE].text, touching.text,
                            meshes[MESHES - 4].text, meshes[MESHES - 3].text, meshes[MESHES - 2].text,
                            meshes[MESHES - 1].text, "--no-depths");
    snprintf(
        expected, sizeof expected,
        "%s: 3 pairs of triangles cross, with 4 of 8 triangles (50 %%). 1 place, component 0 x component 1.\n"
        "%s: Clean: no two triangles cross or touch. What lies inside was not looked at.\n"
        "%s: 1 pair of triangles touches, none cross. 1 place, component 0 x component 1. What lies inside was not "
        "looked at.\n"
        "%s: 1 pair of triangles touches, none cross. 1 place, component 0 x component 1. What lies inside was not "
        "looked at.\n"
        "%s: One triangle is there twice; no two others cross or touch. What lies inside was not looked at.\n"
        "%s: 1 pair of triangles touches, none cross. 1 place, folded x itself. What lies inside was not looked at.\n"
        "%s: 1 pair of triangles crosses, with 2 of 3 triangles (66.7 %%); 1 touches. 2 places, worst: component 0 x "
        "component 1.\n"
        "7 meshes: 1 clean, 2 with intersections, 3 only touching, 1 only with duplicates\n",
        meshes[LARGE + 4].text, meshes[LARGE].text, touching.text, meshes[MESHES - 4].text,
        meshes[MESHES - 3].text, meshes[MESHES - 2].text, meshes[MESHES - 1].text);
    assert_string_equal(run.out, expected);
    tool_run_free(&run);
}

/* The lines of JSON but for the times, which no two runs share. */
static char *read_without_times(void) {
    char *text = read_whole_file(lines.text, NULL), *to = text;
    for (const char *from = text; *from != '\0';) {
        if (strncmp(from, ",\"read_ms\"", 10) == 0) from = strchr(from, '}');
        *to++ = *from++;
    }
    *to = '\0';
    return text;
}

static void any_number_of_threads_says_the_same(void **state) {
    (void)state;
    static const char *const counts[] = {"1", "2", "3", "7", "64", "0"};
    char *text = NULL, *json = NULL;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        tool_run run = CHECK_ALL("--json", lines.text, "--threads", counts[i]);
        char *out = read_without_times();
        assert_int_equal(run.code, 0);
        if (i == 0) {
            text = strdup(run.out);
            json = strdup(out);
        }
        assert_string_equal(run.out, text);
        assert_string_equal(out, json);
        free(out);
        tool_run_free(&run);
    }
    free(text);
    free(json);
    remove(lines.text);
}

static double vertices_with(const char *path, const char *option, const char *value, double *crossing) {
    json_node *line;
    EXPECT_TOOL(0, "check", "--each", path, "--json", lines.text, "--quiet", option, value);
    assert_int_equal(read_line_file(&line, 1), 1);
    const double vertices = json_node_number(line, "vertices");
    *crossing = json_node_number(line, "crossing");
    json_node_free(line);
    return vertices;
}

static void vertices_are_welded_and_parts_left_out(void **state) {
    (void)state;
    recorded split = recorded_cube(true);
    temp_path cube = recorded_write_mesh(&folder, "cube.obj", &split, 0);
    double crossing;
    assert_int_equal(vertices_with(cube.text, "--threads", "1", &crossing), 28);
    assert_int_equal(vertices_with(cube.text, "--weld", "exact", &crossing), 12);
    assert_int_equal(vertices_with(named.text, "--threads", "1", &crossing), 6);
    assert_int_equal(crossing, 1);
    vertices_with(named.text, "--ignore-parts", "Blade,Sheet", &crossing);
    assert_int_equal(crossing, 0);
    vertices_with(named.text, "--only", "Blade,Blade", &crossing);
    assert_int_equal(crossing, 0);
    recorded_free(&split);
    remove(lines.text);
}

/* ---- what goes wrong --------------------------------------------------------------------------------- */

static void a_file_that_fails_is_a_line(void **state) {
    (void)state;
    json_node *nodes[4];
    char expected[8192];
    tool_run run = RUN_TOOL("check", "--each", clean.text, damaged.text, "/nowhere/at_all.obj", touching.text,
                            "--json", lines.text, "--fail-on-contact");
    assert_int_equal(run.code, 1);
    snprintf(
        expected, sizeof expected,
        "%s: Clean: no two triangles cross or touch.\n%s:4: face index 9 is out of range, the file has 3 vertices\n"
        "/nowhere/at_all.obj: cannot open: No such file or directory\n%s: 1 pair of triangles touches, none cross. 1 "
        "place, component 0 x component 1.\n"
        "4 meshes: 1 clean, 1 only touching, 2 failed\n",
        clean.text, damaged.text, touching.text);
    assert_string_equal(run.out, expected);
    assert_string_equal(run.error, "cscd: 2 of 4 meshes could not be checked\n");
    assert_int_equal(read_line_file(nodes, 4), 4);
    assert_string_equal(json_node_string(nodes[2], "error"),
                        "/nowhere/at_all.obj: cannot open: No such file or directory");
    static const char *const unknown[] = {"triangles", "crossing", "depth", "crossing_share", "read_ms"};
    for (int i = 0; i < 5; i++)
        for (int k = 1; k < 3; k++) assert_int_equal(json_node_member(nodes[k], unknown[i])->kind, JSON_NULL);
    for (int i = 0; i < 4; i++) json_node_free(nodes[i]);
    tool_run_free(&run);
    remove(lines.text);
}

/* A part that one mesh lacks is the fault of that one; its sentence has no name of a file, and is given one. */
static void reasons_name_their_files(void **state) {
    (void)state;
    char expected[1200];
    tool_run run = RUN_TOOL("check", "--each", clean.text, named.text, "--only", "Blade", "--quiet");
    assert_int_equal(run.code, 1);
    assert_string_equal(run.out, "");
    snprintf(expected, sizeof expected, "cscd: %s: --only: there is no part 'Blade'", clean.text);
    if (strncmp(run.error, expected, strlen(expected)) != 0) fail_msg("%s", run.error);
    assert_null(strstr(run.error, named.text));
    tool_run_free(&run);
}

/* Those of `check` alone, of which mesh and kind ever; duplicates are no fault. */
static void exit_codes_say_what_was_found(void **state) {
    (void)state;
    for (int i = 0; i < 12; i++) {
        const char *path = meshes[MESHES - 1 - i / 2].text, *kind = i % 2 == 0 ? "crossing" : "touching";
        tool_run alone = RUN_TOOL("check", path, "--fail-on", kind);
        EXPECT_TOOL(alone.code, "check", "--each", clean.text, path, "--fail-on", kind);
        tool_run_free(&alone);
    }
    EXPECT_TOOL(3, "check", "--each", clean.text, touching.text, "--fail-on-contact");
    EXPECT_TOOL(1, "check", "--each", clean.text, damaged.text);
}

static void options_of_one_recording_are_refused(void **state) {
    (void)state;
    static const char *const options[][2] = {
        {"--frames", "0:1"},    {"--object", "a=b.obj"}, {"--ignore", "x"},      {"--parts", "x.csv"},
        {"--allow-gaps", NULL}, {"--csv", "x.csv"},      {"--ignore-rest", NULL}};
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        EXPECT_ERROR(2, TEXTS("--each", options[i][0]), "check", "--each", clean.text, options[i][0],
                     options[i][1]);
    EXPECT_ERROR(2, TEXTS("--each", "no meshes"), "check", "--each");
    EXPECT_ERROR(2, TEXTS("--json", "would overwrite"), "check", "--each", touching.text, clean.text,
                 "--json", clean.text);
    EXPECT_ERROR(2, TEXTS("--json", "ends in .jsonl"), "check", "--each", clean.text, "--json", "x.csv");
    EXPECT_ERROR(4, TEXTS("/nowhere/x.jsonl", "cannot write"), "check", "--each", clean.text, "--json",
                 "/nowhere/x.jsonl");
    EXPECT_ERROR(4, TEXTS("/dev/full", "No space left"), "check", "--each", clean.text, "--json",
                 "/dev/full");
}

static void a_dash_is_the_standard_output(void **state) {
    (void)state;
    tool_run run = CHECK_ALL("--json", "-");
    json_node *nodes[MESHES];
    assert_int_equal(run.code, 0);
    assert_int_equal(read_lines(run.out, nodes, MESHES), MESHES);
    for (int i = 0; i < MESHES; i++) json_node_free(nodes[i]);
    assert_non_null(strstr(run.error, ": Clean: no two triangles cross or touch.\n"));
    tool_run_free(&run);
}

/* ---- an interrupt ------------------------------------------------------------------------------------ */

/* Waits until a line has been written; the test fails when that takes too long. */
static void wait_for_lines(void) {
    char pattern[300];
    snprintf(pattern, sizeof pattern, "%s/.cscd-output-*", folder.path);
    for (int i = 0; i < 60000; i++, usleep(1000)) {
        glob_t found;
        struct stat status = {.st_size = 0};
        if (glob(pattern, 0, NULL, &found) == 0) stat(found.gl_pathv[0], &status);
        globfree(&found);
        if (status.st_size > 0) return;
    }
    fail_msg("no line after a minute");
}

/* A thousand meshes of thousands of triangles take far longer than the signal. */
static void an_interrupt_keeps_what_is_done(void **state) {
    (void)state;
    const char *arguments[ARGUMENTS] = {"check", "--each", "--json", lines.text};
    for (size_t i = 4; i + 1 < ARGUMENTS; i++) arguments[i] = meshes[1].text;
    tool_process process = run_tool_start(arguments);
    wait_for_lines();
    kill(process.pid, SIGINT);
    tool_run run = run_tool_finish(&process);
    assert_int_equal(run.code, 130);
    json_node *nodes[ARGUMENTS];
    const size_t count = read_line_file(nodes, ARGUMENTS);
    assert_true(count > 0 && count < ARGUMENTS - 5);
    for (size_t i = 0; i < count; i++) json_node_free(nodes[i]);
    char sentence[800];
    snprintf(sentence, sizeof sentence,
             "cscd: interrupted after %zu of %d meshes; what was found is kept in %s\n", count, ARGUMENTS - 5,
             lines.text);
    assert_string_equal(run.error, sentence);
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_mesh_has_its_answer),
        cmocka_unit_test(lines_say_it_for_people),
        cmocka_unit_test(any_number_of_threads_says_the_same),
        cmocka_unit_test(vertices_are_welded_and_parts_left_out),
        cmocka_unit_test(a_file_that_fails_is_a_line),
        cmocka_unit_test(reasons_name_their_files),
        cmocka_unit_test(exit_codes_say_what_was_found),
        cmocka_unit_test(options_of_one_recording_are_refused),
        cmocka_unit_test(a_dash_is_the_standard_output),
        cmocka_unit_test(an_interrupt_keeps_what_is_done),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
