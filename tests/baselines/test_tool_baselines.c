/* How `cscd replay` reports on baselines: their columns, their guarantees, and the plan that they use. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { FRAMES = 16 };

static temp_folder folder;
static temp_path model, cache, csv, summary;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded spindle = recorded_spindle(24, 10, FRAMES);
    model = recorded_write_mesh(&folder, "spindle.obj", &spindle, 0);
    cache = recorded_write_cache(&folder, "spindle.pc2", &spindle);
    csv = temp_file_path(&folder, "out.csv");
    summary = temp_file_path(&folder, "out.json");
    recorded_free(&spindle);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* Returns the summary of a replay by a method. */
static json_node *replay_by(const char *method) {
    const char *arguments[] = {"replay", model.text, cache.text,   "--quiet", "--method",
                               method,   "--json",   summary.text, NULL};
    run_tool_expect(0, arguments);
    return json_node_read_file(summary.text);
}

static const json_node *interval_at(const json_node *root, size_t k) {
    return json_node_item(json_node_member(root, "intervals"), k);
}

/* Checks the guarantee of the only component in interval k. */
static void expect_guarantee(const json_node *root, size_t k, const char *mode, const char *reason) {
    const json_node *list = json_node_member(interval_at(root, k), "guarantee");
    assert_int_equal(list->count, 1);
    assert_string_equal(json_node_string(json_node_item(list, 0), "mode"), mode);
    if (strstr(json_node_string(json_node_item(list, 0), "reason"), reason) == NULL)
        fail_msg("interval %zu: expected '%s' in '%s'", k, reason,
                 json_node_string(json_node_item(list, 0), "reason"));
}

static int count_of(const char *text, const char *word) {
    int count = 0;
    for (const char *at = text; (at = strstr(at, word)) != NULL; at++) count++;
    return count;
}

/* The method promises nothing, so the contacts that it loses are no reason for a warning. */
static void published_is_marked_as_such(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("replay", model.text, cache.text, "--timings", "--method", "published", "--json",
                            summary.text);
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "");
    assert_non_null(strstr(run.out, "method published: in "));
    assert_non_null(strstr(run.out, "\npublished "));
    json_node *root = json_node_read_file(summary.text);
    assert_string_equal(json_node_string(json_node_member(root, "summary"), "method"), "published");
    json_node_free(root);
    tool_run_free(&run);
}

/* The method has contours instead of orientations, promises all contacts, and needs neither a proven start
 * nor a plan. */
static void iccd_has_a_column_for_contours(void **state) {
    (void)state;
    tool_run run =
        RUN_TOOL("replay", model.text, cache.text, "--timings", "--method", "iccd", "--json", summary.text);
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "\niccd "));
    assert_non_null(strstr(run.out, " contour "));
    assert_non_null(strstr(run.out, "plan: none"));
    assert_null(strstr(run.out, "may be missing"));
    assert_int_equal(count_of(run.out, " X "), 4); /* for orientation and proof, in both rows */
    tool_run_free(&run);
    json_node *root = json_node_read_file(summary.text), *none = replay_by("none");
    const json_node *total = json_node_member(root, "summary");
    assert_string_equal(json_node_string(total, "method"), "iccd");
    assert_true(json_node_number(total, "static_checks") == 0);
    assert_true(json_node_number(total, "intervals_complete") == FRAMES - 1);
    assert_true(json_node_number(json_node_member(total, "contour_ms"), "mean") > 0);
    for (size_t k = 0; k < FRAMES - 1; k++) {
        expect_guarantee(root, k, "all", "patches");
        assert_true(json_node_number(json_node_member(interval_at(root, k), "ms"), "contour") > 0);
        assert_true(json_node_number(json_node_member(interval_at(none, k), "ms"), "contour") == 0);
        assert_true(json_node_number(interval_at(root, k), "pcp") <
                    json_node_number(interval_at(none, k), "pcp"));
    }
    json_node_free(root);
    json_node_free(none);
}

static void iccd_as_published_is_marked_as_such(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("replay", model.text, cache.text, "--timings", "--method", "iccd-published",
                            "--json", summary.text);
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "");
    assert_non_null(strstr(run.out, "method iccd-published: in 15 of 15 intervals contacts"));
    assert_non_null(strstr(run.out, "\niccd-published "));
    tool_run_free(&run);
    json_node *root = json_node_read_file(summary.text);
    for (size_t k = 0; k < FRAMES - 1; k++) expect_guarantee(root, k, "earliest", "published");
    json_node_free(root);
}

/* Returns the contacts of a replay with two more arguments, as CSV. */
static char *contacts_by(const char *method, const char *option, const char *value) {
    const char *arguments[] = {"replay",   model.text, cache.text, "--quiet", "--contacts", csv.text,
                               "--method", method,     option,     value,     NULL};
    run_tool_expect(0, arguments);
    return read_whole_file(csv.text, NULL);
}

static void iccd_finds_every_contact(void **state) {
    (void)state;
    char *expected = contacts_by("none", "--threads", "1");
    char *threaded = contacts_by("iccd", "--threads", "2"),
         *first = contacts_by("none", "--mode", "earliest"),
         *earliest = contacts_by("iccd", "--mode", "earliest");
    assert_true(count_of(expected, "\n") > 10);
    assert_string_equal(threaded, expected);
    assert_string_equal(earliest, first);
    free(expected);
    free(threaded);
    free(first);
    free(earliest);
}

static void published_takes_any_plan(void **state) {
    (void)state;
    EXPECT_TOOL(0, "preprocess", model.text, "--quiet", "--method", "kmeans:4");
    tool_run run =
        RUN_TOOL("replay", model.text, cache.text, "--timings", "--method", "published", "--frames", "0:2");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "plan: kmeans, 4 regions, "));
    assert_non_null(strstr(run.out, "\npublished "));
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_is_marked_as_such), cmocka_unit_test(iccd_has_a_column_for_contours),
        cmocka_unit_test(iccd_as_published_is_marked_as_such), cmocka_unit_test(iccd_finds_every_contact),
        cmocka_unit_test(published_takes_any_plan)};
    return cmocka_run_group_tests_name("tool_baselines", tests, make_files, remove_files);
}
