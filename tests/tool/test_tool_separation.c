/* `replay --min-separation`: which pairs are reported, where they are written, and what is refused. */
#include "tests/support/test.h"
#include "tests/support/tool/contact_rows.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static recorded flight, fold;
static temp_path flight_model, flight_cache, fold_model, fold_cache, csv, lines, summary;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    flight = recorded_tetrahedra(8);
    fold = recorded_fold(24, 5, 16);
    flight_model = recorded_write_mesh(&folder, "flight.obj", &flight, 0);
    flight_cache = recorded_write_cache(&folder, "flight.pc2", &flight);
    fold_model = recorded_write_mesh(&folder, "fold.obj", &fold, 0);
    fold_cache = recorded_write_cache(&folder, "fold.pc2", &fold);
    csv = temp_file_path(&folder, "out.csv");
    lines = temp_file_path(&folder, "out.jsonl");
    summary = temp_file_path(&folder, "out.json");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    recorded_free(&flight);
    recorded_free(&fold);
    temp_folder_remove(&folder);
    return 0;
}

/* Returns the bytes of the CSV of the fold with more arguments; the caller frees them. */
static char *csv_of(const char *distance, const char *option, const char *value) {
    EXPECT_TOOL(0, "replay", fold_model.text, fold_cache.text, "--contacts", csv.text, "--min-separation",
                distance, option, value);
    return read_whole_file(csv.text, NULL);
}

static size_t count_of(const char *text, const char *part) {
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, part)) != NULL; at++) count++;
    return count;
}

/* The tip flies towards x = 0 by one unit per frame. It is 3.5 away in frame 0, and 0.5 in frame 3. */
static void reports_what_comes_within(void **state) {
    (void)state;
    EXPECT_TOOL(0, "replay", flight_model.text, flight_cache.text, "--contacts", csv.text, "--min-separation",
                "0.25");
    char *text = read_whole_file(csv.text, NULL), *row = strchr(text, '\n') + 1;
    assert_memory_equal(text, "frame,kind,toi,a0,a1,b0,b1,b2,u,v,x,y,z,nx,ny,nz,bounded\n",
                        (size_t)(row - text));
    uint32_t frame, corners[3];
    double toi, u, v, point[3], normal[3];
    int bounded;
    int fields = sscanf(row, "%u,vf,%lf,4,,%u,%u,%u,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%d\n", &frame, &toi,
                        &corners[0], &corners[1], &corners[2], &u, &v, &point[0], &point[1], &point[2],
                        &normal[0], &normal[1], &normal[2], &bounded);
    assert_int_equal(fields, 14);
    assert_int_equal(frame, 3);
    assert_memory_equal(corners, ((uint32_t[3]){0, 1, 2}), sizeof corners);
    assert_true(toi <= 0.25 && toi >= 0.25 - 1e-6);
    assert_true(fabs(u - 0.25) < 1e-9 && fabs(v - 0.25) < 1e-9);
    assert_true(fabs(point[0] - 0.125) < 1e-6 && point[1] == 1.0 && point[2] == 1.0);
    assert_true(normal[0] == 1.0 && normal[1] == 0.0 && normal[2] == 0.0);
    assert_int_equal(bounded, 0);
    free(text);
}

static void json_lines_say_bounded_too(void **state) {
    (void)state;
    char *rows = csv_of("0.05", "--contacts", lines.text);
    free(rows);
    rows = csv_of("0.05", "--threads", "1");
    char *text = read_whole_file(lines.text, NULL);
    assert_true(count_of(text, "\n") > 10);
    assert_int_equal(count_of(text, "\n"), count_of(rows, "\n") - 1);
    assert_int_equal(count_of(text, "\"bounded\":"), count_of(text, "\n"));
    char *rest = text;
    for (char *end; (end = strchr(rest, '\n')) != NULL; rest = end + 1) {
        json_node *line = json_node_parse(rest, (size_t)(end - rest), NULL);
        assert_non_null(line);
        assert_false(json_node_boolean(line, "bounded"));
        json_node_free(line);
    }
    free(rows);
    free(text);
}

static void summary_and_table_name_the_distance(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("replay", fold_model.text, fold_cache.text, "--json", summary.text,
                            "--min-separation", "0.0625");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "minimum separation: 0.0625; contacts whose time is a bound only: 0\n"));
    json_node *root = json_node_read_file(summary.text);
    const json_node *total = json_node_member(root, "summary"),
                    *intervals = json_node_member(root, "intervals");
    assert_true(json_node_number(total, "min_separation") == 0.0625);
    assert_true(json_node_number(total, "bounded") == 0.0);
    assert_true(json_node_number(total, "vf") > 0.0);
    for (size_t i = 0; i < intervals->count; i++)
        assert_true(json_node_number(json_node_item(intervals, i), "bounded") == 0.0);
    json_node_free(root);
    tool_run_free(&run);
}

/* Nothing changes, and the summary says 0. */
static void zero_is_as_without(void **state) {
    (void)state;
    char *zero = csv_of("0", "--json", summary.text);
    EXPECT_TOOL(0, "replay", fold_model.text, fold_cache.text, "--contacts", csv.text);
    char *without = read_whole_file(csv.text, NULL);
    assert_string_equal(zero, without);
    assert_null(strstr(without, "bounded"));
    json_node *root = json_node_read_file(summary.text);
    assert_true(json_node_number(json_node_member(root, "summary"), "min_separation") == 0.0);
    json_node_free(root);
    tool_run run = RUN_TOOL("replay", fold_model.text, fold_cache.text, "--min-separation", "0.0");
    assert_null(strstr(run.out, "minimum separation"));
    tool_run_free(&run);
    free(zero);
    free(without);
}

static void same_bytes_whatever_the_way(void **state) {
    (void)state;
    static const char *const ways[][2] = {{"--threads", "4"}, {"--method", "brute"}, {"--method", "none"}};
    char *expected = csv_of("0.03125", "--threads", "1"), *touching = csv_of("0", "--threads", "1");
    assert_true(count_of(expected, "\n") > count_of(touching, "\n"));
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        char *bytes = csv_of("0.03125", ways[i][0], ways[i][1]);
        assert_string_equal(bytes, expected);
        free(bytes);
    }
    free(expected);
    free(touching);
}

static void unfit_distances_are_refused(void **state) {
    (void)state;
    static const char *const bad[] = {"-1", "-1e-300", "nan", "inf", "1mm", "", "1e-300", "1e300", "1,5"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char words[80];
        snprintf(words, sizeof words, "--min-separation cannot be '%s'", bad[i]);
        EXPECT_ERROR(2, TEXTS(words), "replay", flight_model.text, flight_cache.text, "--min-separation",
                     bad[i]);
    }
    EXPECT_ERROR(2, TEXTS("--min-separation needs a value"), "replay", flight_model.text, flight_cache.text,
                 "--min-separation");
    tool_run run = RUN_TOOL("replay", "--help");
    assert_non_null(strstr(run.out, "--min-separation D"));
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reports_what_comes_within),           cmocka_unit_test(json_lines_say_bounded_too),
        cmocka_unit_test(summary_and_table_name_the_distance), cmocka_unit_test(zero_is_as_without),
        cmocka_unit_test(same_bytes_whatever_the_way),         cmocka_unit_test(unfit_distances_are_refused),
    };
    return cmocka_run_group_tests_name("tool_separation", tests, make_files, remove_files);
}
