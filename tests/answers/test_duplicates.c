/* A triangle that is there twice is said first, and nothing with one is called clean. */
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdlib.h>
#include <string.h>

#define TWICE "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 2 3 1\n"

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

static void expect_first_line(tool_run *run, const char *line) {
    const size_t length = strlen(line);
    assert_int_equal(run->code, 0);
    if (strncmp(run->out, line, length) != 0 || run->out[length] != '\n')
        fail_msg("expected '%s' first in: %s", line, run->out);
}

static void the_sentence_begins_with_them(void **state) {
    static const struct {
        const char *text, *sentence;
    } cases[] = {
        {TWICE, "One triangle is there twice; no two others cross or touch."},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\nf 3 1 2\n",
         "3 pairs of triangles are the same triangle twice; no two others cross or touch."},
        {"o A\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nf 1 2 3\no B\nv 1 1 -1\nv 2 1 -1\nv 1 1 1\nf 4 5 6\n",
         "One triangle is there twice. 2 pairs of triangles cross, with 3 of 3 triangles (100 %). 1 place, A x "
         "B, crossing along 1."},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const temp_path path = write_text("one.obj", cases[i].text);
        tool_run run = RUN_TOOL("check", path.text);
        expect_first_line(&run, cases[i].sentence);
        tool_run_free(&run);
    }
}

/* They are no pairs that cross or touch: lists have two others, each with its kind. */
static void lists_of_pairs_leave_them_out(void **state) {
    (void)state;
    const temp_path path = write_text("one.obj",
                                      "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nf 1 2 3\nv 1 1 -1\nv 2 1 -1\n"
                                      "v 1 1 1\nf 4 5 6\n"),
                    json = temp_file_path(&folder, "out.json"), csv = temp_file_path(&folder, "out.csv");
    EXPECT_TOOL(0, "check", path.text, "--json", json.text, "--csv", csv.text, "--quiet");
    json_node *root = json_node_read_file(json.text);
    const json_node *frame = json_node_item(json_node_member(root, "frames"), 0),
                    *pairs = json_node_member(frame, "pairs"), *kinds = json_node_member(frame, "kinds");
    assert_int_equal(pairs->count, 2);
    assert_int_equal(kinds->count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        assert_int_equal(json_node_item(json_node_item(pairs, i), 1)->number, 2);
        assert_string_equal(json_node_item(kinds, i)->text, "crossing");
    }
    json_node_free(root);
    char *rows = read_whole_file(csv.text, NULL);
    uint32_t lines = 0;
    for (const char *c = rows; *c != '\0'; c++) lines += *c == '\n';
    assert_int_equal(lines, 3);
    assert_null(strstr(rows, "duplicate"));
    free(rows);
}

static void frames_with_them_are_not_clean(void **state) {
    (void)state;
    const temp_path first = write_text("d_1.obj", TWICE), second = write_text("d_2.obj", TWICE);
    tool_run run = RUN_TOOL("check", first.text, second.text, "--timings");
    expect_first_line(&run, "One triangle is there twice. No frame crosses or touches (2 checked).");
    assert_non_null(strstr(run.out, "0 of 2 frames are clean"));
    tool_run_free(&run);
    run = RUN_TOOL("replay", first.text, second.text);
    expect_first_line(&run, "One triangle is there twice. No frame crosses or touches (2 checked).");
    tool_run_free(&run);
}

static void among_many_they_are_an_outcome(void **state) {
    (void)state;
    const temp_path path = write_text("one.obj", TWICE);
    tool_run run = RUN_TOOL("check", "--each", path.text);
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "one.obj: One triangle is there twice; no two others cross or touch."));
    assert_non_null(strstr(run.out, "1 mesh: 0 clean, 1 only with duplicates"));
    tool_run_free(&run);
    EXPECT_TOOL(0, "check", path.text, "--fail-on", "crossing");
    run = RUN_TOOL("check", path.text, "--fail-on", "touching");
    assert_int_equal(run.code, 3);
    assert_non_null(strstr(run.error, "failed: 1 triangle is there twice"));
    tool_run_free(&run);
    EXPECT_TOOL(3, "check", "--each", path.text, "--fail-on", "touching");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sentence_begins_with_them),
        cmocka_unit_test(lists_of_pairs_leave_them_out),
        cmocka_unit_test(frames_with_them_are_not_clean),
        cmocka_unit_test(among_many_they_are_an_outcome),
    };
    return cmocka_run_group_tests(tests, own_folder_make, own_folder_remove);
}
