/* Runs the program `shape` as a user does. */
#include "models/shapes/catalogue.h"
#include "src/io/mesh_file.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static temp_folder folder;

/* Points CSCD_TOOL, which run_tool runs, at the program `shape`. */
static int find_program(void **state) {
    (void)state;
    const char *models = getenv("CSCD_MODELS");
    char path[4096];
    if (models == NULL) {
        print_error("CSCD_MODELS must name the folder of the built models; run through tests/run.sh\n");
        return -1;
    }
    snprintf(path, sizeof path, "%s/shape", models);
    setenv("CSCD_TOOL", path, 1);
    folder = temp_folder_make();
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static void check_file(const char *path, body_kind kind, uint32_t triangle_count) {
    mesh_file file;
    body b;
    io_error error;
    if (!mesh_file_read(path, &file, &error)) fail_msg("%s", error.text);
    if (!body_make(kind, triangle_count, &b, &error)) fail_msg("%s", error.text);
    assert_int_equal(file.vertex_count, b.vertex_count);
    assert_int_equal(file.triangle_count, b.triangle_count);
    assert_memory_equal(file.positions, b.positions, (size_t)b.vertex_count * 3 * sizeof(double));
    assert_memory_equal(file.triangles, b.triangles, (size_t)b.triangle_count * 3 * sizeof(uint32_t));
    mesh_file_free(&file);
    body_free(&b);
}

/* The file contains, to the last bit, what body_make makes. */
static void writes_what_was_asked_for(void **state) {
    (void)state;
    temp_path path = temp_file_path(&folder, "body.obj");
    for (int i = 0; i < BODY_KIND_COUNT; i++) {
        const char *name = body_kind_name((body_kind)i);
        tool_run run = RUN_TOOL(name, path.text);
        if (run.code != 0) fail_msg("%s", run.error);
        assert_string_equal(run.error, "");
        assert_non_null(strstr(run.out, name));
        tool_run_free(&run);
        check_file(path.text, (body_kind)i, 0);
    }
    EXPECT_TOOL(0, "--triangles", "2500", "pawn", path.text);
    check_file(path.text, BODY_PAWN, 2500);
    EXPECT_TOOL(0, "figure", path.text, "--triangles", "1500");
    check_file(path.text, BODY_FIGURE, 1500);
}

static void help_lists_names_and_counts(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("--help");
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "");
    for (int i = 0; i < BODY_KIND_COUNT; i++) {
        char count[32];
        snprintf(count, sizeof count, " %u ", body_default_count((body_kind)i));
        const char *line = strstr(run.out, body_kind_name((body_kind)i));
        assert_non_null(line);
        assert_non_null(strstr(line, count));
    }
    tool_run_free(&run);
}

static void expect_refusal(int code, const char *text, const char *const *arguments) {
    tool_run run = run_tool(arguments);
    if (run.code != code || strstr(run.error, text) == NULL)
        fail_msg("%d, not %d with \"%s\": %s", run.code, code, text, run.error);
    assert_string_equal(run.out, "");
    assert_int_equal(strncmp(run.error, "shape: ", 7), 0);
    assert_ptr_equal(strchr(run.error, '\n'), run.error + strlen(run.error) - 1);
    tool_run_free(&run);
}

#define REFUSED(code, text, ...) expect_refusal((code), (text), (const char *const[]){__VA_ARGS__, NULL})

static void errors_say_what_to_do(void **state) {
    (void)state;
    temp_path path = temp_file_path(&folder, "refused.obj"), lost = temp_file_path(&folder, "none/lost.obj");
    EXPECT_TOOL(2, NULL);
    REFUSED(2, "where to", "pawn");
    REFUSED(2, "knight", "knight", path.text);
    REFUSED(2, "--triangle", "pawn", path.text, "--triangle", "100");
    REFUSED(2, "too many", "pawn", path.text, "more.obj");
    REFUSED(2, "takes a number", "pawn", path.text, "--triangles");
    const char *const numbers[] = {"",   "x",   "12x",         "0",
                                   "-4", "1.5", "99999999999", "99999999999999999999999"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        REFUSED(2, "whole number", "pawn", path.text, "--triangles", numbers[i]);
    REFUSED(1, "5130 or 5132", "pawn", path.text, "--triangles", "5131");
    REFUSED(1, "from 300 to", "pawn", path.text, "--triangles", "2");
    REFUSED(1, "1200 or 1452", "cube", path.text, "--triangles", "1300");
    REFUSED(1, "lost.obj", "sphere", lost.text);
    assert_int_equal(access(path.text, F_OK), -1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(writes_what_was_asked_for),
        cmocka_unit_test(help_lists_names_and_counts),
        cmocka_unit_test(errors_say_what_to_do),
    };
    return cmocka_run_group_tests_name("shape program", tests, find_program, remove_folder);
}
