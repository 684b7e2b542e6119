/* The output of a replay: contacts, summary and table, on scenes whose contacts are known. */
#include "tests/support/test.h"
#include "tests/support/tool/contact_rows.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FLIGHT_FRAMES = 8, FOLD_FRAMES = 16 };

static temp_folder folder;
static recorded flight, fold;
static temp_path flight_model, flight_cache, fold_model, fold_cache, csv, summary;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    flight = recorded_tetrahedra(FLIGHT_FRAMES);
    fold = recorded_fold(24, 5, FOLD_FRAMES);
    flight_model = recorded_write_mesh(&folder, "flight.obj", &flight, 0);
    flight_cache = recorded_write_cache(&folder, "flight.pc2", &flight);
    fold_model = recorded_write_mesh(&folder, "fold.obj", &fold, 0);
    fold_cache = recorded_write_cache(&folder, "fold.pc2", &fold);
    csv = temp_file_path(&folder, "out.csv");
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

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

static void finds_the_contacts_that_the_scene_was_built_for(void **state) {
    (void)state;
    EXPECT_TOOL(0, "replay", flight_model.text, flight_cache.text, "--contacts", csv.text);
    contact_rows rows = contact_rows_read_csv(csv.text);
    assert_int_equal(rows.count, 2);
    const contact_record *in = &rows.items[0], *out = &rows.items[1];
    assert_true(in->frame == 3 && in->kind == CSCD_CONTACT_VF && in->a[0] == 4);
    assert_memory_equal(in->b, ((uint32_t[3]){0, 1, 2}), sizeof in->b);
    assert_true(out->frame == 5 && out->kind == CSCD_CONTACT_VF && out->a[0] == 4);
    assert_memory_equal(out->b, flight.triangles + 6, sizeof out->b); /* the face opposite vertex 0 */
    static const double places[2][3] = {{0, 1, 1}, {-2, 1, 1}};
    for (size_t i = 0; i < 2; i++) {
        assert_near(rows.items[i].toi, 0.5, 1e-12);
        for (int k = 0; k < 3; k++) assert_near(rows.items[i].point[k], places[i][k], 1e-12);
    }
    assert_near(in->u, 0.25, 1e-12);
    assert_near(in->v, 0.25, 1e-12);
    assert_near(in->normal[0], 1.0, 1e-12); /* against the motion of the tip */
    contact_rows_free(&rows);
}

static void place_at(const recorded *r, uint32_t frame, uint32_t vertex, double t, double out[3]) {
    const double *x0 = recorded_position(r, frame, vertex), *x1 = recorded_position(r, frame + 1, vertex);
    for (int k = 0; k < 3; k++) out[k] = (1.0 - t) * x0[k] + t * x1[k];
}

/* Computes the points of the two features that u and v name at the TOI. */
static void named_points(const recorded *r, const contact_record *c, double a[3], double b[3]) {
    double p[4][3];
    bool vf = c->kind == CSCD_CONTACT_VF;
    for (int i = 0; i < 4; i++) {
        uint32_t vertex = vf ? (i == 0 ? c->a[0] : c->b[i - 1]) : (i < 2 ? c->a[i] : c->b[i - 2]);
        place_at(r, (uint32_t)c->frame, vertex, c->toi, p[i]);
    }
    for (int k = 0; k < 3; k++) {
        a[k] = vf ? p[0][k] : (1.0 - c->u) * p[0][k] + c->u * p[1][k];
        b[k] = vf ? (1.0 - c->u - c->v) * p[1][k] + c->u * p[2][k] + c->v * p[3][k]
                  : (1.0 - c->v) * p[2][k] + c->v * p[3][k];
    }
}

static void rows_reproduce_their_points(void **state) {
    (void)state;
    EXPECT_TOOL(0, "replay", fold_model.text, fold_cache.text, "--contacts", csv.text);
    contact_rows rows = contact_rows_read_csv(csv.text);
    size_t kinds[2] = {0, 0};
    for (size_t i = 0; i < rows.count; i++) {
        const contact_record *c = &rows.items[i];
        double a[3], b[3];
        named_points(&fold, c, a, b);
        assert_true(c->toi >= 0.0 && c->toi <= 1.0 && c->frame < FOLD_FRAMES - 1);
        assert_true(c->u >= -1e-9 && c->v >= -1e-9 && c->u <= 1.0 + 1e-9 && c->v <= 1.0 + 1e-9);
        for (int k = 0; k < 3; k++) {
            assert_near(a[k], b[k], 1e-6);
            assert_near(c->point[k], 0.5 * (a[k] + b[k]), 1e-12);
        }
        assert_near(hypot(hypot(c->normal[0], c->normal[1]), c->normal[2]), 1.0, 1e-9);
        assert_true(i == 0 || c[-1].frame < c->frame || (c[-1].frame == c->frame && c[-1].toi <= c->toi));
        kinds[c->kind]++;
    }
    assert_true(kinds[CSCD_CONTACT_VF] >= 5 && kinds[CSCD_CONTACT_EE] >= 5);
    contact_rows_free(&rows);
}

static void json_lines_hold_what_the_csv_holds(void **state) {
    (void)state;
    temp_path lines = temp_file_path(&folder, "out.jsonl");
    EXPECT_TOOL(0, "replay", fold_model.text, fold_cache.text, "--contacts", csv.text);
    EXPECT_TOOL(0, "replay", fold_model.text, fold_cache.text, "--contacts", lines.text);
    contact_rows from_csv = contact_rows_read_csv(csv.text), from_lines = contact_rows_read_jsonl(lines.text);
    assert_true(from_csv.count > 0);
    contact_rows_assert_equal(&from_csv, &from_lines);
    contact_rows_free(&from_csv);
    contact_rows_free(&from_lines);
}

static void check_milliseconds(const json_node *interval) {
    static const char *const stages[] = {"update", "orientation", "traversal", "contact",
                                         "proof",  "check",       "total"};
    const json_node *ms = json_node_member(interval, "ms");
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++)
        assert_true(json_node_number(ms, stages[i]) >= 0);
}

static void check_guarantees(const json_node *interval, size_t component_count) {
    const json_node *list = json_node_member(interval, "guarantee");
    double count = 0.0;
    for (size_t i = 0; i < list->count; i++) {
        const json_node *guarantee = json_node_item(list, i);
        count += json_node_number(guarantee, "count");
        assert_string_equal(json_node_string(guarantee, "mode"), "all");
        assert_true(strlen(json_node_string(guarantee, "reason")) > 0);
    }
    assert_true(count == (double)component_count);
}

static void check_interval(const json_node *interval, int32_t frame, const contact_rows *rows) {
    size_t vf = contact_rows_of(rows, frame, CSCD_CONTACT_VF),
           ee = contact_rows_of(rows, frame, CSCD_CONTACT_EE);
    assert_true(json_node_number(interval, "frame") == frame);
    assert_true(json_node_number(interval, "vf") == (double)vf);
    assert_true(json_node_number(interval, "ee") == (double)ee);
    assert_true(json_node_number(interval, "tests") >= (double)(vf + ee));
    assert_true(json_node_number(interval, "pcp") >= 0);
    const json_node *earliest = json_node_member(interval, "earliest_toi");
    assert_int_equal(earliest->kind, vf + ee > 0 ? JSON_NUMBER : JSON_NULL);
    for (size_t i = 0; i < rows->count && vf + ee > 0; i++) {
        if (rows->items[i].frame == frame) assert_true(earliest->number <= rows->items[i].toi);
    }
    check_milliseconds(interval);
}

static double sum_of(const json_node *list, const char *key) {
    double sum = 0.0;
    for (const json_node *item = list->first; item != NULL; item = item->next)
        sum += json_node_number(item, key);
    return sum;
}

/* Checks all of "summary" and "provenance" that the documentation names. */
static void check_summary(const json_node *root, const contact_rows *rows) {
    const json_node *total = json_node_member(root, "summary"),
                    *intervals = json_node_member(root, "intervals");
    assert_true(json_node_boolean(total, "complete"));
    assert_string_equal(json_node_string(total, "method"), "none");
    assert_string_equal(json_node_string(total, "mode"), "all");
    assert_true(json_node_number(total, "intervals") == (double)intervals->count);
    assert_true(json_node_number(total, "vf") == sum_of(intervals, "vf"));
    assert_true(json_node_number(total, "ee") == sum_of(intervals, "ee"));
    assert_true(json_node_number(total, "vf") + json_node_number(total, "ee") == (double)rows->count);
    assert_true(json_node_number(total, "first_contact_frame") == rows->items[0].frame);
    assert_near(json_node_number(json_node_member(total, "pcp"), "mean"),
                sum_of(intervals, "pcp") / (double)intervals->count, 1e-9);
    const json_node *provenance = json_node_member(root, "provenance");
    assert_string_equal(json_node_string(provenance, "version"), "2.0.0");
    assert_true(strlen(json_node_string(provenance, "commit")) > 0);
    assert_true(strlen(json_node_string(provenance, "date")) == 20);
    assert_int_equal(json_node_member(provenance, "machine")->kind, JSON_OBJECT);
    assert_int_equal(json_node_member(provenance, "arguments")->count, 8);
    assert_int_equal(json_node_member(provenance, "inputs")->count, 2);
}

static void check_table(const char *out, const json_node *root) {
    const json_node *total = json_node_member(root, "summary");
    char line[200];
    snprintf(line, sizeof line, "contacts: %.0f VF and %.0f EE in %.0f of %.0f intervals",
             json_node_number(total, "vf"), json_node_number(total, "ee"),
             json_node_number(total, "intervals_with_contact"), json_node_number(total, "intervals"));
    if (strstr(out, line) == NULL) fail_msg("expected '%s' in: %s", line, out);
    snprintf(line, sizeof line, "intervals: %.0f clean, %.0f with contact, %.0f intersecting, %.0f unknown",
             json_node_number(total, "clean"), json_node_number(total, "contact"),
             json_node_number(total, "penetrating"), json_node_number(total, "unknown"));
    if (strstr(out, line) == NULL) fail_msg("expected '%s' in: %s", line, out);
    static const char *const columns[] = {"BVH update", "orientation", "traversal",
                                          "contact",    "#PCPs",       "total"};
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) assert_non_null(strstr(out, columns[i]));
}

static void json_csv_and_table_agree(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("replay", fold_model.text, fold_cache.text, "--timings", "--contacts", csv.text,
                            "--json", summary.text);
    assert_int_equal(run.code, 0);
    contact_rows rows = contact_rows_read_csv(csv.text);
    json_node *root = json_node_read_file(summary.text);
    const json_node *intervals = json_node_member(root, "intervals"),
                    *frames = json_node_member(root, "frames");
    assert_int_equal(intervals->count, FOLD_FRAMES - 1);
    for (uint32_t k = 0; k < FOLD_FRAMES - 1; k++) {
        check_interval(json_node_item(intervals, k), (int32_t)k, &rows);
        check_guarantees(json_node_item(intervals, k), 1);
    }
    assert_int_equal(frames->count, FOLD_FRAMES);
    for (uint32_t k = 0; k < FOLD_FRAMES; k++) {
        assert_true(json_node_number(json_node_item(frames, k), "frame") == k);
        json_node_boolean(json_node_item(frames, k), "crossing");
    }
    check_summary(root, &rows);
    check_table(run.out, root);
    json_node_free(root);
    contact_rows_free(&rows);
    tool_run_free(&run);
}

/* Checks the states of the intervals and, when crossing is given, of the frames ('0', '1', or 'n' for
 * null). */
static void expect_states(const char *const *states, const char *crossing, const char *const *arguments) {
    run_tool_expect(0, arguments);
    json_node *root = json_node_read_file(summary.text);
    const json_node *intervals = json_node_member(root, "intervals"),
                    *frames = json_node_member(root, "frames");
    size_t count = 0;
    for (; states[count] != NULL; count++)
        assert_string_equal(json_node_string(json_node_item(intervals, count), "state"), states[count]);
    assert_int_equal(intervals->count, count);
    assert_int_equal(frames->count, strlen(crossing));
    for (size_t k = 0; crossing[k] != '\0'; k++) {
        const json_node *value = json_node_member(json_node_item(frames, k), "crossing");
        assert_int_equal(value->kind, crossing[k] == 'n' ? JSON_NULL : JSON_BOOLEAN);
        assert_true(value->boolean == (crossing[k] == '1'));
    }
    json_node_free(root);
}

#define EXPECT_STATES(states, crossing, ...)                                                                 \
    expect_states((states), (crossing),                                                                      \
                  (const char *const[]){"replay", flight_model.text, flight_cache.text, "--json",            \
                                        summary.text, __VA_ARGS__, NULL})

static void says_in_what_state_each_interval_is(void **state) {
    (void)state;
    EXPECT_STATES(TEXTS("clean", "clean", "clean", "contact", "penetrating", "penetrating", "penetrating"),
                  "00001111", "--quiet");
    EXPECT_STATES(TEXTS("unknown", "unknown", "unknown", "contact", "unknown", "contact", "unknown"),
                  "nnnnnnnn", "--no-check");
}

static void replays_the_frames_asked_for(void **state) {
    (void)state;
    EXPECT_STATES(TEXTS("clean", "contact"), "001", "--frames", "2:4");
    EXPECT_STATES(TEXTS("penetrating", "penetrating"), "111", "--frames", "5:");
    EXPECT_STATES(TEXTS("clean"), "00", "--frames", ":1");
    EXPECT_TOOL(0, "replay", flight_model.text, flight_cache.text, "--frames", "3:4", "--contacts", csv.text);
    contact_rows rows = contact_rows_read_csv(csv.text);
    assert_int_equal(rows.count, 1);
    assert_int_equal(rows.items[0].frame, 3);
    contact_rows_free(&rows);
}

static void fails_on_contact_when_asked(void **state) {
    (void)state;
    EXPECT_TOOL(3, "replay", flight_model.text, flight_cache.text, "--fail-on-contact");
    EXPECT_TOOL(0, "replay", flight_model.text, flight_cache.text, "--fail-on-contact", "--frames", "0:3");
}

/* Returns the bytes of the CSV of the fold with more arguments; the caller frees them. */
static char *csv_of(const char *frames, const char *option, const char *value) {
    EXPECT_TOOL(0, "replay", fold_model.text, frames, "--contacts", csv.text, option, value);
    return read_whole_file(csv.text, NULL);
}

static void same_bytes_whatever_the_way(void **state) {
    (void)state;
    static const char *const ways[][2] = {{"--threads", "1"},
                                          {"--threads", "4"},
                                          {"--method", "brute"},
                                          {"--method", "none"},
                                          {"--threads", "0"}};
    char *expected = csv_of(fold_cache.text, "--threads", "1");
    assert_non_null(strstr(expected, "vf"));
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        char *bytes = csv_of(fold_cache.text, ways[i][0], ways[i][1]);
        assert_string_equal(bytes, expected);
        free(bytes);
    }
    free(expected);
}

static void same_contacts_from_every_format(void **state) {
    (void)state;
    temp_folder obj_folder = temp_folder_make();
    char *expected = csv_of(fold_cache.text, "--threads", "1");
    temp_path mdd = recorded_write_cache(&folder, "fold.mdd", &fold);
    temp_path obj = recorded_write_sequence(&obj_folder, "f_%04d.obj", &fold);
    temp_path ply = recorded_write_sequence(&folder, "f_%04d.ply", &fold);
    const char *const sources[] = {mdd.text, obj.text, obj_folder.path, ply.text};
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) {
        char *bytes = csv_of(sources[i], "--threads", "1");
        assert_string_equal(bytes, expected);
        free(bytes);
    }
    free(expected);
    temp_folder_remove(&obj_folder);
}

static void a_list_of_meshes_is_a_recording(void **state) {
    (void)state;
    temp_path first = recorded_write_mesh(&folder, "third.obj", &flight, 3);
    temp_path second = recorded_write_mesh(&folder, "fourth.ply", &flight, 4);
    EXPECT_TOOL(3, "replay", flight_model.text, first.text, second.text, "--fail-on-contact");
    EXPECT_TOOL(0, "replay", flight_model.text, flight_model.text, first.text, "--fail-on-contact");
}

static void quiet_prints_nothing(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("replay", fold_model.text, fold_cache.text, "--quiet", "--contacts", csv.text);
    assert_int_equal(run.code, 0);
    assert_string_equal(run.out, "");
    assert_string_equal(run.error, "");
    tool_run_free(&run);
    run = RUN_TOOL("replay", fold_model.text, fold_cache.text);
    assert_null(strstr(run.error, "warning"));
    assert_non_null(strstr(run.error, "cscd: component 0 is an open surface, as cloth is"));
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_the_contacts_that_the_scene_was_built_for),
        cmocka_unit_test(rows_reproduce_their_points),
        cmocka_unit_test(json_lines_hold_what_the_csv_holds),
        cmocka_unit_test(json_csv_and_table_agree),
        cmocka_unit_test(says_in_what_state_each_interval_is),
        cmocka_unit_test(replays_the_frames_asked_for),
        cmocka_unit_test(fails_on_contact_when_asked),
        cmocka_unit_test(same_bytes_whatever_the_way),
        cmocka_unit_test(same_contacts_from_every_format),
        cmocka_unit_test(a_list_of_meshes_is_a_recording),
        cmocka_unit_test(quiet_prints_nothing),
    };
    return cmocka_run_group_tests_name("tool_replay", tests, make_files, remove_files);
}
