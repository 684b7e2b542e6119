/* Every text that the tool reads may begin with the mark of UTF-8; one in UTF-16 is told. */
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static temp_path model, cache;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded scene = recorded_tetrahedra(8);
    model = recorded_write_mesh(&folder, "model.obj", &scene, 0);
    cache = recorded_write_cache(&folder, "frames.pc2", &scene);
    recorded_free(&scene);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* How a text is written: as it is, with the mark of UTF-8, or in UTF-16 with the low byte first. */
typedef enum text_form { PLAIN, MARKED, WIDE } text_form;

static temp_path write_form(const char *name, const char *text, text_form form) {
    char bytes[8192];
    size_t size = 0;
    assert_true(2 * strlen(text) + 3 < sizeof bytes);
    memcpy(bytes, form == WIDE ? "\xff\xfe" : "\xef\xbb\xbf", 3);
    if (form != PLAIN) size = form == WIDE ? 2 : 3;
    for (const char *c = text; *c != '\0'; c++) {
        bytes[size++] = *c;
        if (form == WIDE) bytes[size++] = '\0';
    }
    return temp_file_write(&folder, name, bytes, size);
}

/* Reads a text that cscd has written, and writes it again. */
static temp_path rewrite_form(const char *path, const char *name, text_form form) {
    size_t size;
    char *text = read_whole_file(path, &size);
    char *bytes = malloc(size + 3);
    assert_non_null(bytes);
    memcpy(bytes, "\xef\xbb\xbf", 3);
    memcpy(bytes + (form == MARKED ? 3 : 0), text, size);
    const temp_path again = temp_file_write(&folder, name, bytes, size + (form == MARKED ? 3 : 0));
    free(text);
    free(bytes);
    return again;
}

static void expect_same_output(tool_run *run, char **first) {
    assert_int_equal(run->code, 0);
    if (*first == NULL) {
        *first = strdup(run->out);
        assert_non_null(*first);
    }
    assert_string_equal(run->out, *first);
    tool_run_free(run);
}

static void lists_of_jobs_may_have_a_mark(void **state) {
    char text[2048], *first = NULL;
    (void)state;
    snprintf(text, sizeof text, "{\"model\":\"%s\"}\r\n\r\n{\"model\":\"%s\",\"frames\":\"%s\"}\r\n",
             model.text, model.text, cache.text);
    for (text_form form = PLAIN; form <= MARKED; form++) {
        const temp_path list = write_form("jobs.jsonl", text, form);
        tool_run run = RUN_TOOL("check", "--list", list.text);
        expect_same_output(&run, &first);
    }
    const temp_path wide = write_form("jobs.jsonl", text, WIDE);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl: this is text in UTF-16"), "check", "--list", wide.text);
    free(first);
}

static void results_may_have_a_mark(void **state) {
    char text[2048], *first = NULL;
    (void)state;
    snprintf(text, sizeof text, "{\"model\":\"%s\"}\n{\"model\":\"%s\"}\n", model.text, model.text);
    const temp_path list = write_form("jobs.jsonl", text, PLAIN),
                    results = temp_file_path(&folder, "results.jsonl");
    EXPECT_TOOL(0, "check", "--list", list.text, "--results", results.text, "--quiet");
    for (text_form form = PLAIN; form <= MARKED; form++) {
        const temp_path again = rewrite_form(results.text, "again.jsonl", form);
        tool_run run = RUN_TOOL("merge", again.text, "-o", "-", "--quiet");
        expect_same_output(&run, &first);
        EXPECT_TOOL(0, "check", "--list", list.text, "--results", again.text, "--resume", "--quiet");
    }
    free(first);
}

static void tables_and_lists_of_pairs_may_have_a_mark(void **state) {
    static const char parts[] =
        "triangle,name\n0,Wall\n1,Wall\n2,Wall\n3,Wall\n4,Dart\n5,Dart\n6,Dart\n7,Dart\n";
    static const char pairs[] = "components 0 1\n";
    char *by_parts = NULL, *by_pairs = NULL;
    (void)state;
    for (text_form form = PLAIN; form <= MARKED; form++) {
        const temp_path table = write_form("parts.csv", parts, form),
                        list = write_form("pairs.txt", pairs, form);
        tool_run run = RUN_TOOL("check", model.text, cache.text, "--parts", table.text);
        expect_same_output(&run, &by_parts);
        run = RUN_TOOL("check", model.text, cache.text, "--ignore", list.text);
        expect_same_output(&run, &by_pairs);
    }
    assert_non_null(strstr(by_parts, "Wall x Dart"));
    assert_non_null(strstr(by_pairs, "No frame crosses"));
    const temp_path table = write_form("parts.csv", parts, WIDE), list = write_form("pairs.txt", pairs, WIDE);
    EXPECT_ERROR(1, TEXTS("parts.csv: this is text in UTF-16"), "check", model.text, "--parts", table.text);
    EXPECT_ERROR(1, TEXTS("pairs.txt: this is text in UTF-16"), "check", model.text, "--ignore", list.text);
    free(by_parts);
    free(by_pairs);
}

static void summaries_may_have_a_mark(void **state) {
    const temp_path json = temp_file_path(&folder, "out.json"), page = temp_file_path(&folder, "page.html");
    (void)state;
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", json.text, "--quiet");
    const temp_path marked = rewrite_form(json.text, "marked.json", MARKED),
                    wide = write_form("wide.json", "{\"intervals\": []}", WIDE);
    EXPECT_TOOL(0, "report", marked.text, json.text, "-o", page.text);
    EXPECT_ERROR(1, TEXTS("wide.json: this is text in UTF-16"), "report", wide.text, "-o", page.text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_of_jobs_may_have_a_mark),
        cmocka_unit_test(results_may_have_a_mark),
        cmocka_unit_test(tables_and_lists_of_pairs_may_have_a_mark),
        cmocka_unit_test(summaries_may_have_a_mark),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
