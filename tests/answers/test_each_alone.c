/* `check --each` and `check` of the same file say the same: what was found, how deep, and whether the run fails. */
#include "src/tool/common/terminal.h"
#include "src/tool/jobs/mesh_job.h"
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BODIES_MAX = 3 };

/* A box from low, with sides of this length, in all coordinates scaled. */
typedef struct placed_box {
    double low[3], side;
} placed_box;

typedef struct body_case {
    placed_box boxes[BODIES_MAX]; /* side 0: no more */
    const char *result;
    double depth; /* by hand */
} body_case;

static const body_case cases[] = {
    {{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}}, "clean", 0.0},
    {{{{0, 0, 0}, 1}, {{0.25, 0.25, 0.25}, 0.5}}, "inside", 0.25},
    {{{{0.25, 0.25, 0.25}, 0.5}, {{0, 0, 0}, 1}}, "inside", 0.25},
    {{{{0, 0, 0}, 4}, {{0.5, 1, 1}, 1}, {{9, 9, 9}, 1}}, "inside", 1.5},
    {{{{0, 0, 0}, 1}, {{0.75, 0.25, 0.25}, 0.5}}, "crossing", 0.25},
};

static void write_box(FILE *file, const placed_box *b, int axis, double scale) {
    static const char quads[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                     {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
    for (int i = 0; i < 8; i++) {
        double x[3];
        for (int k = 0; k < 3; k++) x[(k + axis) % 3] = scale * (b->low[k] + b->side * (i >> k & 1));
        fprintf(file, "v %.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    for (int i = 0; i < 6; i++)
        fprintf(file, "f %d %d %d %d\n", quads[i][0] - 9, quads[i][1] - 9, quads[i][2] - 9, quads[i][3] - 9);
}

static temp_path write_case(const body_case *c, int axis, double scale) {
    temp_path path = temp_file_path(&folder, "bodies.obj");
    FILE *file = fopen(path.text, "w");
    assert_non_null(file);
    for (int i = 0; i < BODIES_MAX && c->boxes[i].side > 0.0; i++) {
        fprintf(file, "o body %d\n", i);
        write_box(file, &c->boxes[i], axis, scale);
    }
    assert_int_equal(fclose(file), 0);
    return path;
}

static json_node *read_line(const char *text) {
    size_t at;
    const char *end = strchr(text, '\n');
    assert_non_null(end);
    json_node *line = json_node_parse(text, (size_t)(end - text), &at);
    assert_non_null(line);
    return line;
}

/* The numbers of a line of --each, beside those of the only frame of check --json. */
static void expect_same(const temp_path *path, const char *result, double depth) {
    tool_run each = RUN_TOOL("check", "--each", path->text, "--json", "-"),
             alone = RUN_TOOL("check", path->text, "--json", "-");
    json_node *line = read_line(each.out);
    size_t at;
    json_node *root = json_node_parse(alone.out, strlen(alone.out), &at);
    assert_non_null(root);
    const json_node *frame = json_node_item(json_node_member(root, "frames"), 0);
    assert_string_equal(json_node_string(line, "result"), result);
    assert_true(json_node_number(line, "depth") == json_node_number(frame, "depth"));
    const double off = json_node_number(line, "depth") - depth;
    assert_true(off <= 1e-9 * depth && off >= -1e-9 * depth);
    assert_true(json_node_number(line, "crossing") == json_node_number(frame, "crossing_pairs"));
    assert_int_equal(strcmp(result, "clean") == 0, json_node_boolean(frame, "clean"));
    json_node_free(line);
    json_node_free(root);
    tool_run_free(&each);
    tool_run_free(&alone);
}

/* Above and below its depth, --fail-depth decides as it does alone. */
static void expect_same_rules(const temp_path *path, double depth) {
    for (int i = 0; i < 3; i++) {
        char limit[32];
        snprintf(limit, sizeof limit, "%.17g",
                 depth * (i == 0   ? 0.5
                          : i == 1 ? 0.99
                                   : 1.01) +
                     (i == 2 ? 1e-9 : 0.0));
        tool_run alone = RUN_TOOL("check", path->text, "--fail-depth", limit, "--quiet");
        tool_run each = RUN_TOOL("check", "--each", path->text, "--fail-depth", limit, "--quiet");
        assert_int_equal(alone.code, depth > 0.0 && i < 2 ? 3 : 0);
        assert_int_equal(each.code, alone.code);
        tool_run_free(&each);
        tool_run_free(&alone);
    }
}

static void bodies_are_the_same_alone_and_among_many(void **state) {
    (void)state;
    static const double scales[] = {1.0, 1.0 / 1024.0, 4096.0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double scale = scales[(i + (size_t)axis) % 3];
            const temp_path path = write_case(&cases[i], axis, scale);
            expect_same(&path, cases[i].result, cases[i].depth * scale);
            if (axis == 0) expect_same_rules(&path, cases[i].depth * scale);
        }
}

static void people_read_how_deep_it_is(void **state) {
    (void)state;
    const temp_path path = write_case(&cases[1], 0, 1.0);
    char expected[1024];
    tool_run run = RUN_TOOL("check", "--each", path.text);
    snprintf(
        expected, sizeof expected,
        "%s: 1 part lies inside another; no two triangles cross or touch. 1 place, body 0 x body 1, 0.25 deep.\n"
        "1 mesh: 0 clean, 1 with parts that share space\n",
        path.text);
    assert_string_equal(run.out, expected);
    tool_run_free(&run);
    run = RUN_TOOL("check", "--each", path.text, "--unit", "m", "--fail-depth", "200mm");
    assert_int_equal(run.code, 3);
    assert_non_null(strstr(run.out, "250 mm deep.\n"));
    tool_run_free(&run);
    run = RUN_TOOL("check", "--each", path.text, "--no-depths");
    assert_non_null(
        strstr(run.out, ": Clean: no two triangles cross or touch. What lies inside was not looked at.\n"));
    tool_run_free(&run);
    EXPECT_TOOL(1, "check", "--each", path.text, "--fail-depth", "200mm"); /* of what unit, nobody knows */
}

/* A triangle that flies through another one, at rest before it. */
static void animations_are_played(void **state) {
    (void)state;
    static const double wall[9] = {0, -4, -4, 0, 4, -4, 0, 0, 4}, dart[9] = {0, 0, 0, 1, 0.5, 0, 1, 0, 0.5};
    static const double times[2] = {0, 1}, away[6] = {1, 0, 0, -1, 0, 0};
    gltf_fixture fixture = {.size = 0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, wall);
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, dart);
    gltf_fixture_array(&fixture, 5126, "SCALAR", 2, times);
    gltf_fixture_array(&fixture, 5126, "VEC3", 6, away);
    file_bytes file = gltf_fixture_glb(
        &fixture, "\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
                  "\"nodes\":[{\"mesh\":0},{\"mesh\":1,\"name\":\"dart\",\"translation\":[1,0,0]}],"
                  "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]},"
                  "{\"primitives\":[{\"attributes\":{\"POSITION\":1}}]}],"
                  "\"animations\":[{\"samplers\":[{\"input\":2,\"output\":3}],"
                  "\"channels\":[{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}}]}]");
    const temp_path path = temp_file_write(&folder, "flight.glb", file.bytes, file.size);
    tool_run each = RUN_TOOL("check", "--each", path.text, "--fail-on", "crossing"),
             alone = RUN_TOOL("check", path.text, "--fail-on", "crossing");
    assert_int_equal(each.code, 3);
    assert_int_equal(alone.code, 3);
    char *line = strchr(each.out, '\n'), *first = strchr(alone.out, '\n');
    assert_true(line != NULL && first != NULL);
    *line = *first = '\0';
    assert_string_equal(each.out + strlen(path.text) + 2, alone.out);
    tool_run_free(&each);
    tool_run_free(&alone);
    EXPECT_TOOL(0, "check", "--each", path.text, "--fail-on", "crossing", "--rest");
    EXPECT_TOOL(3, "check", "--each", path.text, "--fail-on", "crossing", "--fps", "3");
    EXPECT_TOOL(0, "check", "--each", path.text, "--fail-on", "crossing", "--fps", "1");
}

/* As the tool does when it is interrupted. */
static bool give_up(void *user, const char *stage, double fraction) {
    (void)stage, (void)fraction;
    ++*(uint32_t *)user;
    assert_int_equal(raise(SIGTERM), 0);
    return !interrupted();
}

/* Thousands of triangles through one place take long enough to be asked whether they should go on. */
static void a_cancelled_search_has_no_answer(void **state) {
    (void)state;
    enum { FAN = 700 };
    temp_path path = temp_file_path(&folder, "fan.obj");
    FILE *file = fopen(path.text, "w");
    for (int i = 0; i < FAN; i++)
        fprintf(file, "v %d 1 1\nv %d -9 1\nv 0.5 %d -9\nf -3 -2 -1\n", i - FAN / 2, FAN / 2 - i, i);
    fclose(file);
    uint32_t asked = 0;
    const ignore_options nothing = {.path = NULL};
    const recording_options source = {.model_path = NULL};
    const answer_options asking = {.events_path = NULL};
    const mesh_job job = {.path = path.text, .source = &source, .ignored = &nothing, .answers = &asking};
    interrupt_catch();
    cscd_context *context;
    cscd_context_options options = cscd_context_defaults();
    options.progress = (cscd_progress){give_up, &asked};
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    mesh_answer answer = {.triangle_count = 7};
    assert_false(mesh_job_run(&job, context, &answer));
    assert_int_equal(asked, 1);
    assert_int_equal(answer.triangle_count, 7);
    cscd_context_destroy(context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_are_the_same_alone_and_among_many),
        cmocka_unit_test(people_read_how_deep_it_is),
        cmocka_unit_test(animations_are_played),
        cmocka_unit_test(a_cancelled_search_has_no_answer),
    };
    return cmocka_run_group_tests_name("each_alone", tests, own_folder_make, own_folder_remove);
}
