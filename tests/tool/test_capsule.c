/* The tool on a capsule whose ends touch in a known interval: a formula, brute force and all outputs
 * agree. */
#include "tests/support/models/model_program.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/contact_rows.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static temp_path model, frames, csv, summary;
static unsigned expected;   /* the interval of the first contact, as capsule_bend announces */
static contact_rows rows;   /* contacts of a replay of the whole recording */
static json_node *json;     /* the summary of that replay */
static unsigned printed[4]; /* the table that it printed: VF, EE, intervals with contact, intervals */

static void generate_capsule(void) {
    model_program_use("capsule_bend");
    tool_run run = RUN_TOOL(model.text, frames.text);
    assert_int_equal(run.code, 0);
    const char *line = strstr(run.out, "first contact expected in interval ");
    assert_non_null(line);
    assert_int_equal(sscanf(line, "first contact expected in interval %u", &expected), 1);
    tool_run_free(&run);
    model_program_use(NULL);
}

static int replay_capsule(void **state) {
    (void)state;
    folder = temp_folder_make();
    model = temp_file_path(&folder, "capsule.obj");
    frames = temp_file_path(&folder, "capsule.pc2");
    csv = temp_file_path(&folder, "contacts.csv");
    summary = temp_file_path(&folder, "summary.json");
    generate_capsule();
    tool_run run = RUN_TOOL("replay", model.text, frames.text, "--method", "single", "--contacts", csv.text,
                            "--json", summary.text);
    if (run.code != 0) fail_msg("%s", run.error);
    const char *line = strstr(run.out, "\ncontacts: ");
    assert_non_null(line);
    assert_int_equal(sscanf(line, "\ncontacts: %u VF and %u EE in %u of %u intervals", &printed[0],
                            &printed[1], &printed[2], &printed[3]),
                     4);
    tool_run_free(&run);
    rows = contact_rows_read_csv(csv.text);
    json = json_node_read_file(summary.text);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    contact_rows_free(&rows);
    json_node_free(json);
    temp_folder_remove(&folder);
    return 0;
}

/* The ends touch in the interval and at the place that the generator's formula gives. */
static void first_contact_is_where_the_formula_says(void **state) {
    (void)state;
    assert_true(rows.count > 0);
    assert_int_equal(rows.items[0].frame, expected);
    assert_in_range(expected, 1, 58);
    for (size_t i = 0; i < rows.count; i++) assert_true(rows.items[i].frame >= (int32_t)expected);
}

/* Brute force over all feature pairs of the first interval with contacts gives the same list, number for
 * number. */
static void brute_force_finds_the_same(void **state) {
    (void)state;
    temp_path brute_csv = temp_file_path(&folder, "brute.csv");
    char range[32];
    snprintf(range, sizeof range, "%u:%u", expected, expected + 1);
    EXPECT_TOOL(0, "replay", model.text, frames.text, "--frames", range, "--method", "brute", "--no-check",
                "--quiet", "--contacts", brute_csv.text);
    contact_rows brute = contact_rows_read_csv(brute_csv.text), first = rows;
    for (first.count = 0; first.count < rows.count && rows.items[first.count].frame == (int32_t)expected;)
        first.count++;
    contact_rows_assert_equal(&first, &brute);
    contact_rows_free(&brute);
}

static void csv_json_and_table_agree(void **state) {
    (void)state;
    const json_node *intervals = json_node_member(json, "intervals");
    size_t totals[2] = {0, 0}, with_contact = 0;
    assert_int_equal(intervals->count, 59);
    assert_int_equal(json_node_member(json, "frames")->count, 60);
    for (int32_t i = 0; i < 59; i++) {
        const json_node *interval = json_node_item(intervals, (size_t)i);
        size_t vf = contact_rows_of(&rows, i, CSCD_CONTACT_VF),
               ee = contact_rows_of(&rows, i, CSCD_CONTACT_EE);
        assert_true(json_node_number(interval, "frame") == i);
        assert_true(json_node_number(interval, "vf") == (double)vf &&
                    json_node_number(interval, "ee") == (double)ee);
        assert_int_equal(json_node_member(interval, "earliest_toi")->kind == JSON_NULL, vf + ee == 0);
        totals[0] += vf;
        totals[1] += ee;
        with_contact += vf + ee > 0;
    }
    assert_int_equal(totals[0] + totals[1], rows.count);
    assert_int_equal(printed[0], totals[0]);
    assert_int_equal(printed[1], totals[1]);
    assert_int_equal(printed[2], with_contact);
    assert_int_equal(printed[3], 59);
}

/* Frames up to the first contact have no intersections; in those after it the ends intersect. */
static void frames_cross_after_the_first_contact(void **state) {
    (void)state;
    const json_node *states = json_node_member(json, "frames");
    for (uint32_t i = 0; i < 60; i++)
        assert_int_equal(json_node_boolean(json_node_item(states, i), "crossing"), i > expected);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_contact_is_where_the_formula_says),
        cmocka_unit_test(brute_force_finds_the_same),
        cmocka_unit_test(csv_json_and_table_agree),
        cmocka_unit_test(frames_cross_after_the_first_contact),
    };
    return cmocka_run_group_tests_name("capsule", tests, replay_capsule, remove_files);
}
