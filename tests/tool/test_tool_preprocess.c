/* `cscd preprocess` from end to end: what it writes, what it refuses, and which plan a replay then uses. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/soft_bar.h"
#include "tests/support/tool/tool_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FRAMES = 12 };

static temp_folder folder;
static recorded spindle;
static temp_path model, cache, plan, other, csv, summary;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    spindle = recorded_spindle(30, 10, FRAMES);
    model = recorded_write_mesh(&folder, "spindle.obj", &spindle, 0);
    cache = recorded_write_cache(&folder, "spindle.pc2", &spindle);
    plan = temp_file_path(&folder, "spindle.plan.ply");
    other = temp_file_path(&folder, "other.ply");
    csv = temp_file_path(&folder, "out.csv");
    summary = temp_file_path(&folder, "out.json");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    recorded_free(&spindle);
    temp_folder_remove(&folder);
    return 0;
}

/* Removes all plans before each test. */
static int remove_plans(void **state) {
    (void)state;
    unlink(plan.text);
    unlink(other.text);
    return 0;
}

/* Runs the tool, and expects the texts on the standard output. */
static void expect_output(const char *const *texts, const char *const *arguments) {
    tool_run run = run_tool(arguments);
    if (run.code != 0 || run.error[0] != '\0') fail_msg("exit code %d, stderr: %s", run.code, run.error);
    for (; *texts != NULL; texts++) expect_in(run.out, *texts);
    tool_run_free(&run);
}

#define EXPECT_OUTPUT(texts, ...) expect_output((texts), (const char *const[]){__VA_ARGS__, NULL})

/* ---- preprocess ------------------------------------------------------------------------------------ */

static void tells_what_it_found(void **state) {
    (void)state;
    char answer[600], written[600];
    snprintf(answer, sizeof answer, "%s: 1 region by method charge; its point sees ", model.text);
    snprintf(written, sizeof written, "written: %s\n", plan.text);
    EXPECT_OUTPUT(TEXTS("302 vertices, 600 triangles, 1 component\n",
                        "component 0: 600 triangles, capacitance ",
                        "     0         0       600       100.0 %", "seconds: assembly ", written),
                  "preprocess", model.text);
    EXPECT_OUTPUT(TEXTS(": 4 regions by method kmeans; their points see "), "preprocess", model.text,
                  "--method", "kmeans:4");
    EXPECT_OUTPUT(TEXTS(": 1 region by method single; its point sees "), "preprocess", model.text, "--method",
                  "single", "-o", other.text);
    tool_run first = RUN_TOOL("preprocess", model.text);
    assert_memory_equal(first.out, answer, strlen(answer));
    tool_run_free(&first);
    tool_run run =
        RUN_TOOL("preprocess", model.text, "--quiet", "--threads", "2", "--published", "--threshold", "0.2");
    assert_int_equal(run.code, 0);
    assert_string_equal(run.out, "");
    assert_string_equal(run.error, "");
    tool_run_free(&run);
    EXPECT_OUTPUT(TEXTS("vertices    302\n"), "info", plan.text); /* a plan is a mesh */
}

static void makes_plans_for_a_motion(void **state) {
    (void)state;
    EXPECT_OUTPUT(TEXTS("method      regions ", "charge            1 ", "single            1 ",
                        "kmeans:4          4 ", "%   kept\n"),
                  "preprocess", model.text, "--method", "auto");
    EXPECT_OUTPUT(TEXTS("charge            1 "), "preprocess", model.text, cache.text, "--frames", "0",
                  "--method", "auto", "--seed", "2", "--threshold", "0.2", "--charge", "coarse");
    EXPECT_OUTPUT(TEXTS("charge            3 "), "preprocess", model.text, cache.text, "--method", "auto");
}

static void seeds_choose_the_regions(void **state) {
    (void)state;
    static const char *const seeds[] = {"1", "1", "2"};
    char *bytes[3];
    for (int i = 0; i < 3; i++) {
        EXPECT_TOOL(0, "preprocess", model.text, "--method", "kmeans:5", "--seed", seeds[i], "--quiet");
        bytes[i] = read_whole_file(plan.text, NULL);
    }
    size_t size;
    free(read_whole_file(plan.text, &size));
    assert_memory_equal(bytes[0], bytes[1], size);
    assert_memory_not_equal(bytes[0], bytes[2], size);
    for (int i = 0; i < 3; i++) free(bytes[i]);
}

static void names_the_plan_after_the_model(void **state) {
    (void)state;
    static const char *const names[][2] = {
        {"a.b.ply", "a.b.plan.ply"}, {"C.OBJ", "C.plan.ply"}, {"a.b.plan.ply", "a.b.plan.plan.ply"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        temp_path named = temp_file_path(&folder, names[i][0]), made = temp_file_path(&folder, names[i][1]);
        if (i < 2) recorded_write_mesh(&folder, names[i][0], &spindle, 0);
        EXPECT_TOOL(0, "preprocess", named.text, "--method", "single", "--quiet");
        assert_int_equal(access(made.text, F_OK), 0);
    }
}

static void refuses_unfit_options(void **state) {
    (void)state;
    static const char *const unfit[][2] = {{"--method", "none"},     {"--method", "published"},
                                           {"--method", "kmeans:0"}, {"--method", "kmeans:x"},
                                           {"--method", "kmeans:"},  {"--threshold", "0"},
                                           {"--threshold", "1"},     {"--threshold", "nan"},
                                           {"--seed", "-1"},         {"--threads", "300"},
                                           {"--weld", "0"}};
    for (size_t i = 0; i < sizeof unfit / sizeof *unfit; i++)
        EXPECT_ERROR(2, TEXTS(unfit[i][0], unfit[i][1]), "preprocess", model.text, unfit[i][0], unfit[i][1]);
    EXPECT_ERROR(2, TEXTS("expected MODEL"), "preprocess");
    EXPECT_ERROR(2, TEXTS("-o", cache.text), "preprocess", model.text, cache.text, "-o", cache.text);
    EXPECT_ERROR(2, TEXTS("--frames", "none are given"), "preprocess", model.text, "--frames", "0:3");
    EXPECT_ERROR(2, TEXTS("FRAMES count with"), "preprocess", model.text, cache.text, "--published");
    EXPECT_ERROR(2, TEXTS("FRAMES count with"), "preprocess", model.text, cache.text, "--method", "single");
    EXPECT_ERROR(2, TEXTS("--threshold counts with --method charge or auto; leave it out"), "preprocess",
                 model.text, "--method", "single", "--threshold", "0.2");
    EXPECT_ERROR(2, TEXTS("--charge counts with --method charge or auto; leave it out"), "preprocess",
                 model.text, "--method", "kmeans:4", "--charge", "coarse");
    EXPECT_ERROR(2, TEXTS("--seed counts with --method kmeans:K or auto; leave it out"), "preprocess",
                 model.text, "--seed", "2");
    EXPECT_ERROR(2, TEXTS("--published counts with"), "preprocess", model.text, "--method", "kmeans:4",
                 "--published");
    EXPECT_ERROR(1, TEXTS("frame 99"), "preprocess", model.text, cache.text, "--frames", "99");
    EXPECT_ERROR(2, TEXTS("ends in .ply"), "preprocess", model.text, "-o", "plan.obj");
    EXPECT_ERROR(1, TEXTS("cannot write", "no/such/"), "preprocess", model.text, "-o",
                 temp_file_path(&folder, "no/such/a.ply").text);
    static const char point[] = "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n";
    const temp_path one = temp_file_write(&folder, "one.obj", point, strlen(point));
    EXPECT_ERROR(1, TEXTS("--weld exact leaves none"), "preprocess", one.text, "--weld", "exact");
    assert_int_equal(access(plan.text, F_OK), -1);
}

/* A plan may replace only a plan. */
static void overwrites_no_mesh(void **state) {
    (void)state;
    temp_path mesh = recorded_write_mesh(&folder, "mesh.ply", &spindle, 3);
    char *before = read_whole_file(mesh.text, NULL);
    EXPECT_ERROR(2, TEXTS("would overwrite"), "preprocess", mesh.text, "-o", mesh.text);
    EXPECT_ERROR(2, TEXTS("exists and is no plan"), "preprocess", model.text, "-o", mesh.text);
    char *after = read_whole_file(mesh.text, NULL);
    assert_string_equal(before, after);
    free(before);
    free(after);
    EXPECT_TOOL(0, "preprocess", model.text, "-o", other.text, "--quiet");
    EXPECT_TOOL(0, "preprocess", model.text, "-o", other.text, "--quiet");
    temp_path renamed = temp_file_path(&folder, "plan.data");
    assert_int_equal(rename(other.text, renamed.text), 0);
    EXPECT_ERROR(2, TEXTS("would overwrite"), "render", model.text, "--colour", "region", "--plan",
                 renamed.text, "-o", renamed.text);
    EXPECT_ERROR(2, TEXTS("would overwrite"), "replay", model.text, cache.text, "--plan", renamed.text,
                 "--json", renamed.text);
}

static void says_how_much_memory_is_missing(void **state) {
    (void)state;
    recorded large = recorded_torus(500, 800);
    temp_path path = recorded_write_mesh(&folder, "large.obj", &large, 0);
    recorded_free(&large);
    EXPECT_ERROR(1, TEXTS("large.obj: ", "800000 triangles", "GiB", "--charge tree"), "preprocess", path.text,
                 "--charge", "dense");
    assert_int_equal(access(temp_file_path(&folder, "large.plan.ply").text, F_OK), -1);
}

/* ---- which plan a replay takes --------------------------------------------------------------------- */

/* Replays with more arguments, and checks the plan in the summary and what the table says about it. */
static void expect_plan(const char *source, const char *method, int regions, const char *remark,
                        const char *const *more) {
    const char *arguments[16] = {"replay", model.text, cache.text, "--json", summary.text, "--frames", "0:2"};
    for (int i = 0; more[i] != NULL; i++) arguments[7 + i] = more[i];
    tool_run run = run_tool(arguments);
    if (run.code != 0) fail_msg("%s", run.error);
    json_node *root = json_node_read_file(summary.text);
    const json_node *total = json_node_member(root, "summary"), *chosen = json_node_member(total, "plan");
    assert_string_equal(json_node_string(chosen, "source"), source);
    assert_string_equal(json_node_string(chosen, "method"), method);
    assert_true(json_node_number(chosen, "regions") == regions);
    assert_int_equal(json_node_member(chosen, "path")->kind,
                     strcmp(source, "file") == 0 ? JSON_STRING : JSON_NULL);
    char line[80];
    snprintf(line, sizeof line, regions > 0 ? "plan: %s, %d region%s, " : "plan: %s", method, regions,
             regions == 1 ? "" : "s");
    expect_in(run.out, line);
    expect_in(run.out, remark);
    json_node_free(root);
    tool_run_free(&run);
}

#define EXPECT_PLAN(source, method, regions, remark, ...)                                                    \
    expect_plan((source), (method), (regions), (remark), (const char *const[]){__VA_ARGS__, NULL})

static void takes_the_plan_of_the_model(void **state) {
    (void)state;
    EXPECT_PLAN("memory", "charge", 1, "made in memory in ", "--mode", "all");
    assert_int_equal(access(plan.text, F_OK), -1); /* replay writes none */
    EXPECT_TOOL(0, "preprocess", model.text, "--quiet", "--method", "kmeans:4");
    EXPECT_PLAN("file", "kmeans", 4, plan.text, "--mode", "all");
    EXPECT_PLAN("memory", "charge", 1, "left aside, it is of method kmeans", "--method", "charge");
    EXPECT_PLAN("memory", "kmeans", 3, "made in memory", "--method", "kmeans:3");
    EXPECT_PLAN("memory", "single", 1, "made in memory", "--method", "single");
    EXPECT_PLAN("none", "none", 0, "plan: none\n", "--method", "none");
    EXPECT_PLAN("none", "none", 0, "plan: none\n", "--method", "brute");
    EXPECT_PLAN("none", "none", 0, "with --min-separation nothing is culled", "--min-separation", "0.001");
    EXPECT_PLAN("none", "none", 0, "with --min-separation nothing is culled", "--min-separation", "0.001",
                "--method", "single");
}

static void takes_the_plan_that_it_is_given(void **state) {
    (void)state;
    EXPECT_TOOL(0, "preprocess", model.text, "--quiet", "--method", "kmeans:4");
    EXPECT_TOOL(0, "preprocess", model.text, "--quiet", "--method", "single", "-o", other.text);
    EXPECT_PLAN("file", "single", 1, other.text, "--plan", other.text);
    EXPECT_PLAN("file", "single", 1, other.text, "--plan", other.text, "--method", "single");
    EXPECT_PLAN("file", "kmeans", 4, plan.text, "--plan", plan.text, "--method", "kmeans");
    EXPECT_ERROR(1, TEXTS(other.text, "of method single, expected charge"), "replay", model.text, cache.text,
                 "--plan", other.text, "--method", "charge");
    EXPECT_ERROR(2, TEXTS("--plan is of no use with --method none"), "replay", model.text, cache.text,
                 "--plan", other.text, "--method", "none");
    EXPECT_ERROR(1, TEXTS("none.ply", "No such file"), "replay", model.text, cache.text, "--plan",
                 temp_file_path(&folder, "none.ply").text);
    EXPECT_ERROR(1, TEXTS("lacks 'comment cscd plan'"), "replay", model.text, cache.text, "--plan",
                 recorded_write_mesh(&folder, "mesh.ply", &spindle, 0).text);
}

/* A plan that does not fit is ignored, with a reason, when it lies beside the model; it is an error when
 * it is named. */
static void refuses_the_plan_of_another_mesh(void **state) {
    (void)state;
    recorded torus = recorded_torus(20, 10);
    temp_path torus_model = recorded_write_mesh(&folder, "torus.obj", &torus, 0);
    recorded_free(&torus);
    EXPECT_TOOL(0, "preprocess", torus_model.text, "-o", plan.text, "--quiet");
    EXPECT_PLAN("memory", "charge", 1, "another mesh: it has 200 vertices and 400 triangles", "--mode",
                "all");
    EXPECT_ERROR(1, TEXTS("another mesh", "expected 302 and 600"), "replay", model.text, cache.text, "--plan",
                 plan.text);
}

static void welds_before_it_compares(void **state) {
    (void)state;
    recorded split = recorded_cube(true);
    temp_path split_model = recorded_write_mesh(&folder, "split.obj", &split, 0);
    temp_path split_cache = recorded_write_cache(&folder, "split.pc2", &split);
    recorded_free(&split);
    EXPECT_TOOL(0, "preprocess", split_model.text, "--weld", "exact", "--quiet", "--method", "single");
    EXPECT_OUTPUT(TEXTS("plan: single, 2 regions, from "), "replay", split_model.text, split_cache.text,
                  "--weld", "exact");
    tool_run run = RUN_TOOL("replay", split_model.text, split_cache.text);
    assert_int_equal(run.code, 0);
    expect_in(run.out, "expected 28 and 16, of the same model with the same --weld: left aside");
    tool_run_free(&run);
}

static void culls_nothing_on_open_meshes(void **state) {
    (void)state;
    recorded sheet = recorded_fold(16, 4, 3);
    temp_path sheet_model = recorded_write_mesh(&folder, "sheet.obj", &sheet, 0);
    temp_path sheet_cache = recorded_write_cache(&folder, "sheet.pc2", &sheet);
    recorded_free(&sheet);
    tool_run run = RUN_TOOL("replay", sheet_model.text, sheet_cache.text);
    assert_int_equal(run.code, 0);
    expect_in(run.out, "plan: none (no component is a closed surface, so there is nothing to cull)\n");
    tool_run_free(&run);
}

static void large_meshes_get_one_region_in_short_recordings(void **state) {
    (void)state;
    recorded torus = recorded_torus(60, 51);
    temp_path torus_model = recorded_write_mesh(&folder, "large.obj", &torus, 0);
    temp_path torus_cache = recorded_write_cycle(&folder, "large.pc2", &torus, 2);
    recorded_free(&torus);
    unlink(temp_file_path(&folder, "large.plan.ply").text);
    EXPECT_OUTPUT(TEXTS("plan: single, 1 region, made in memory in ",
                        "(a plan by charge takes as long as 400 intervals, and here are 1; cscd preprocess"),
                  "replay", torus_model.text, torus_cache.text);
    EXPECT_OUTPUT(TEXTS("plan: charge, "), "replay", torus_model.text, torus_cache.text, "--method",
                  "charge");
    EXPECT_TOOL(0, "preprocess", torus_model.text, "--quiet", "--method", "kmeans:6");
    EXPECT_OUTPUT(TEXTS("plan: kmeans, 6 regions, from "), "replay", torus_model.text, torus_cache.text);
}

/* The frames behind the first two are a hole in the file, which nobody reads. */
static void append_frames(const temp_path *path, uint32_t vertex_count, uint32_t frame_count) {
    FILE *file = fopen(path->text, "r+b");
    const uint8_t count[4] = {(uint8_t)frame_count, (uint8_t)(frame_count >> 8), 0, 0};
    assert_true(file != NULL && fseek(file, 28, SEEK_SET) == 0 && fwrite(count, 4, 1, file) == 1);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(truncate(path->text, 32 + (off_t)frame_count * vertex_count * 12), 0);
}

/* The price of a plan is one of triangles times intervals of the whole recording, whatever is replayed of it. */
static void long_recordings_get_a_plan_by_charge(void **state) {
    (void)state;
    recorded torus = recorded_torus(60, 51);
    temp_path torus_model = recorded_write_mesh(&folder, "long.obj", &torus, 0);
    temp_path torus_cache = recorded_write_cycle(&folder, "long.pc2", &torus, 2);
    append_frames(&torus_cache, torus.vertex_count, 4000);
    EXPECT_OUTPUT(TEXTS("plan: single, ", "400 intervals, and here are 3999;"), "replay", torus_model.text,
                  torus_cache.text, "--frames", ":1");
    append_frames(&torus_cache, torus.vertex_count, 4001);
    EXPECT_OUTPUT(TEXTS("plan: charge, "), "replay", torus_model.text, torus_cache.text, "--frames", ":1");
    recorded_free(&torus);
}

/* Two triangles of one component with the same centroid make the charge's equations singular. */
static void without_an_answer_there_is_one_region(void **state) {
    (void)state;
    static const char text[] =
        "v 1 0 0\nv -.5 .75 0\nv -.5 -.75 0\nv -1 0 0\nv .5 -.75 0\nv .5 .75 0\nv 0 0 2\n"
        "v 9 0 0\nv 8 0 0\nv 9 1 0\nv 9 0 1\n"
        "f 1 3 2\nf 1 2 7\nf 2 3 7\nf 3 1 7\nf 4 6 5\nf 4 5 7\nf 5 6 7\nf 6 4 7\n"
        "f 8 9 10\nf 9 8 11\nf 10 9 11\nf 8 10 11\n";
    temp_path star = temp_file_write(&folder, "star.obj", text, strlen(text));
    EXPECT_ERROR(1, TEXTS("star.obj: ", "centroid"), "preprocess", star.text, "--quiet");
    tool_run run = RUN_TOOL("replay", star.text, star.text, star.text);
    assert_int_equal(run.code, 0);
    expect_in(run.out, "plan: single, 2 regions, made in memory in ");
    expect_in(run.out, "centroid");
    tool_run_free(&run);
}

static void a_model_may_say_where_it_is_soft(void **state) {
    (void)state;
    temp_path even = soft_bar_write(&folder, "even.ply", 3.0, false),
              bar = soft_bar_write(&folder, "bar.ply", 0.25, false);
    char line[600];
    snprintf(line, sizeof line, "stiffness: 0.25 to 3, from %s\n", bar.text);
    EXPECT_OUTPUT(TEXTS("stiffness: 3 to 3, from ", "even.ply\n", ": 1 region by"), "preprocess", even.text);
    EXPECT_OUTPUT(TEXTS(line, ": 2 regions by method charge;", "component 0: 956 triangles"), "preprocess",
                  bar.text, "-o", other.text);
    tool_run run = RUN_TOOL("preprocess", bar.text, "--published");
    assert_null(strstr(run.out, "stiffness"));
    tool_run_free(&run);
}

static void bad_stiffness_is_refused(void **state) {
    (void)state;
    temp_path bar = soft_bar_write_bad(&folder, "bad.ply", 7, 0.0);
    EXPECT_ERROR(1, TEXTS("bad.ply: the stiffness of face 7 is 0, expected a positive finite number"),
                 "preprocess", bar.text);
    bar = soft_bar_write_bad(&folder, "bad.ply", 90, (double)INFINITY);
    EXPECT_ERROR(1, TEXTS("bad.ply: the stiffness of face 90 is inf, expected"), "replay", bar.text, bar.text,
                 bar.text, "--method", "charge");
}

int main(void) {
#define TEST(name) cmocka_unit_test_setup(name, remove_plans)
    const struct CMUnitTest tests[] = {
        TEST(tells_what_it_found),
        TEST(makes_plans_for_a_motion),
        TEST(seeds_choose_the_regions),
        TEST(names_the_plan_after_the_model),
        TEST(refuses_unfit_options),
        TEST(overwrites_no_mesh),
        TEST(says_how_much_memory_is_missing),
        TEST(takes_the_plan_of_the_model),
        TEST(takes_the_plan_that_it_is_given),
        TEST(refuses_the_plan_of_another_mesh),
        TEST(welds_before_it_compares),
        TEST(culls_nothing_on_open_meshes),
        TEST(without_an_answer_there_is_one_region),
        TEST(large_meshes_get_one_region_in_short_recordings),
        TEST(long_recordings_get_a_plan_by_charge),
        TEST(a_model_may_say_where_it_is_soft),
        TEST(bad_stiffness_is_refused),
    };
    return cmocka_run_group_tests_name("tool_preprocess", tests, make_files, remove_files);
}
