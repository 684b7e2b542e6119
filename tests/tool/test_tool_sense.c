/* `cscd sense`: its warnings, the comparison with the detector, its outputs, and what it refuses. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 8 };

static temp_folder folder;
static recorded flight, growing;
static temp_path flight_model, flight_cache, growing_model, growing_cache, csv, summary, picture;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    flight = recorded_tetrahedra(FRAMES);
    growing = recorded_tetrahedra(FRAMES);
    size_t frame = (size_t)growing.vertex_count * 3;
    for (size_t i = 0; i < FRAMES * frame; i++)
        growing.frames[i] = growing.frames[i % frame] * (1.0 + (double)(i / frame) / 4.0);
    flight_model = recorded_write_mesh(&folder, "flight.obj", &flight, 0);
    flight_cache = recorded_write_cache(&folder, "flight.pc2", &flight);
    growing_model = recorded_write_mesh(&folder, "growing.obj", &growing, 0);
    growing_cache = recorded_write_cache(&folder, "growing.pc2", &growing);
    csv = temp_file_path(&folder, "out.csv");
    summary = temp_file_path(&folder, "out.json");
    picture = temp_file_path(&folder, "out.png");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    recorded_free(&flight);
    recorded_free(&growing);
    temp_folder_remove(&folder);
    return 0;
}

#define SENSE flight_model.text, flight_cache.text

static size_t count_of(const char *text, const char *part) {
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, part)) != NULL; at++) count++;
    return count;
}

/* The scene was built to have warnings in intervals 3 and 5. */
static void confirms_the_contacts_and_no_others(void **state) {
    (void)state;
    EXPECT_TOOL(0, "sense", SENSE, "--csv", csv.text);
    char *text = read_whole_file(csv.text, NULL);
    static const char head[] =
        "frame,part_a,part_b,object_a,object_b,vertex_a,vertex_b,distance,time,contact,toi\n";
    assert_int_equal(strncmp(text, head, strlen(head)), 0);
    uint32_t confirmed = 0;
    for (char *row = text + strlen(head), *end; (end = strchr(row, '\n')) != NULL; row = end + 1) {
        *end = '\0';
        uint32_t frame, parts[2], objects[2], vertices[2];
        int contact;
        double distance, time, toi = -1.0;
        int fields =
            sscanf(row, "%u,%u,%u,%u,%u,%u,%u,%lf,%lf,%d,%lf", &frame, &parts[0], &parts[1], &objects[0],
                   &objects[1], &vertices[0], &vertices[1], &distance, &time, &contact, &toi);
        assert_true(parts[0] == 0 && parts[1] == 1 && objects[0] == 0 && objects[1] == 1);
        assert_true(vertices[0] < 4 && vertices[1] >= 4 && vertices[1] < 8);
        assert_true(time == 0.0 || time == 1.0);
        uint32_t at = frame + (time > 0.5);
        const double *p = recorded_position(&flight, at, vertices[0]);
        const double *q = recorded_position(&flight, at, vertices[1]);
        assert_true(fabs(hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]) - distance) < 1e-12);
        assert_int_equal(fields, contact ? 11 : 10);
        assert_int_equal(contact, frame == 3 || frame == 5);
        if (contact) assert_true(fabs(toi - 0.5) < 1e-12);
        confirmed += contact != 0;
    }
    assert_int_equal(confirmed, 2);
    free(text);
}

static void compares_with_the_detector(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("sense", SENSE, "--compare", "--json", summary.text);
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "pairs of objects in contact: 2 in 2 intervals; found 2, missed 0"));
    assert_non_null(strstr(run.out, "recall 1.0000"));
    assert_non_null(strstr(run.out, "confirmed: recall 1.0000\n"));
    json_node *root = json_node_read_file(summary.text);
    const json_node *total = json_node_member(root, "summary"),
                    *intervals = json_node_member(root, "intervals");
    assert_int_equal(intervals->count, FRAMES - 1);
    double warned = 0.0, intervals_warned = 0.0;
    for (size_t i = 0; i < intervals->count; i++) {
        intervals_warned += json_node_number(json_node_item(intervals, i), "warnings") > 0.0;
        const json_node *pairs = json_node_member(json_node_item(intervals, i), "object_pairs");
        double touching = json_node_number(pairs, "touching");
        assert_true(json_node_number(json_node_item(intervals, i), "frame") == (double)i);
        assert_true(touching == (i == 3 || i == 5 ? 1.0 : 0.0));
        assert_true(json_node_number(pairs, "found") == touching);
        assert_true(json_node_number(pairs, "missed") == 0.0);
        assert_true(json_node_number(pairs, "confirmed") == touching);
        assert_true(json_node_number(pairs, "false") == json_node_number(pairs, "warned") - touching);
        warned += json_node_number(pairs, "warned");
    }
    assert_true(json_node_boolean(total, "complete"));
    assert_true(json_node_number(total, "objects") == 2.0 && json_node_number(total, "recall") == 1.0);
    assert_true(json_node_number(total, "warned_pairs") == warned);
    assert_true(intervals_warned > 1.0 && json_node_number(total, "intervals_warned") == intervals_warned);
    assert_true(json_node_number(total, "precision") == 2.0 / warned);
    assert_int_equal(json_node_member(json_node_member(root, "provenance"), "inputs")->count, 2);
    json_node_free(root);
    tool_run_free(&run);
}

/* No two vertices come within the chosen distance. */
static void says_what_it_has_missed(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("sense", SENSE, "--compare", "--mu", "0.001", "--reff", "10");
    assert_int_equal(run.code, 0);
    const char *told = strstr(run.error, "warning: frame 1: part 0 has an edge longer than --mu");
    assert_non_null(told);
    assert_null(strstr(told + 1, "warning: ")); /* once, though each frame has it */
    assert_null(strstr(run.out, "has new cells"));
    assert_non_null(strstr(run.out, "found 0, missed 2, false 0\n"));
    assert_non_null(strstr(run.out, "recall 0.0000, precision 1.0000"));
    assert_non_null(strstr(run.out, "pairs were missed in the intervals from frame 3, 5\n"));
    tool_run_free(&run);
}

static void without_the_check_nothing_is_confirmed(void **state) {
    (void)state;
    EXPECT_TOOL(0, "sense", SENSE, "--no-exact", "--csv", csv.text);
    char *text = read_whole_file(csv.text, NULL);
    assert_true(count_of(text, "\n") > 2);
    assert_int_equal(count_of(text, ",,\n"), count_of(text, "\n") - 1);
    free(text);
}

static void same_bytes_for_any_number_of_threads(void **state) {
    (void)state;
    static const char *const methods[] = {"cells", "random"};
    for (size_t i = 0; i < 2; i++) {
        EXPECT_TOOL(0, "sense", SENSE, "--method", methods[i], "--csv", csv.text);
        char *one = read_whole_file(csv.text, NULL);
        EXPECT_TOOL(0, "sense", SENSE, "--method", methods[i], "--csv", csv.text, "--threads", "4");
        char *four = read_whole_file(csv.text, NULL);
        assert_string_equal(one, four);
        assert_true(count_of(one, "\n") > 1);
        free(one);
        free(four);
    }
}

/* Areas grow by a factor of 7.6. */
static void renews_what_has_grown_and_says_so(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("sense", growing_model.text, growing_cache.text, "--json", summary.text);
    assert_int_equal(run.code, 0);
    json_node *root = json_node_read_file(summary.text);
    double renewals = json_node_number(json_node_member(root, "summary"), "renewals");
    assert_true(renewals >= 2.0);
    assert_int_equal(count_of(run.out, "has new cells"), (size_t)renewals);
    assert_true(count_of(run.out, "(area)\n") >= 2);
    json_node_free(root);
    tool_run_free(&run);
}

static void draws_a_picture(void **state) {
    (void)state;
    static const char *const frames[] = {"0", "4"};
    for (size_t i = 0; i < 2; i++) {
        EXPECT_TOOL(0, "sense", SENSE, "--picture", picture.text, "--frame", frames[i], "--size", "160x120",
                    "--view", "30,20", "--up", "y");
        size_t size;
        char *bytes = read_whole_file(picture.text, &size);
        assert_true(size > 500);
        assert_memory_equal(bytes, "\x89PNG\r\n", 6);
        assert_memory_equal(bytes + 16, "\0\0\0\xa0\0\0\0\x78", 8);
        free(bytes);
    }
    EXPECT_ERROR(1, TEXTS("--frame 5: there are the frames 1 to 4"), "sense", SENSE, "--picture",
                 picture.text, "--frame", "5", "--frames", "1:4");
}

static void quiet_is_quiet(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("sense", SENSE, "--quiet", "--frames", "2:4", "--json", summary.text);
    assert_int_equal(run.code, 0);
    assert_string_equal(run.out, "");
    json_node *root = json_node_read_file(summary.text);
    assert_int_equal(json_node_member(root, "intervals")->count, 2);
    json_node_free(root);
    tool_run_free(&run);
}

static void unfit_options_are_refused(void **state) {
    (void)state;
    static const char *const bad[][2] = {{"--mu", "-1"},      {"--mu", "nan"},     {"--mu", "1mm"},
                                         {"--reff", "1e301"}, {"--cells", "x"},    {"--particles", "0"},
                                         {"--seed", "-1"},    {"--method", "lbg"}, {"--size", "1"},
                                         {"--view", "3"},     {"--up", "x"},       {"--threads", "257"},
                                         {"--frame", "-"},    {"--frames", "a:b"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char words[80];
        snprintf(words, sizeof words, "%s cannot be '%s'", bad[i][0], bad[i][1]);
        EXPECT_ERROR(2, TEXTS(words), "sense", SENSE, bad[i][0], bad[i][1]);
    }
    EXPECT_ERROR(2, TEXTS("--reff 1 is below --mu 2"), "sense", SENSE, "--mu", "2", "--reff", "1");
    EXPECT_ERROR(2, TEXTS("--particles is of --method random"), "sense", SENSE, "--particles", "3");
    EXPECT_ERROR(2, TEXTS("--seed is of --method random"), "sense", SENSE, "--seed", "3");
    EXPECT_ERROR(2, TEXTS("--cells is of --method cells"), "sense", SENSE, "--method", "random", "--cells",
                 "3");
    EXPECT_ERROR(2, TEXTS("--within is of --method cells"), "sense", SENSE, "--method", "random", "--within");
    EXPECT_ERROR(2, TEXTS("--view is of a picture"), "sense", SENSE, "--view", "3,3");
    EXPECT_ERROR(2, TEXTS("step of 2"), "sense", SENSE, "--frames", "0:6:2");
    EXPECT_ERROR(2, TEXTS("no FRAMES given"), "sense", flight_model.text);
    EXPECT_ERROR(2, TEXTS("--csv", "would overwrite"), "sense", SENSE, "--csv", flight_cache.text);
    EXPECT_ERROR(2, TEXTS("--json", "would overwrite"), "sense", SENSE, "--csv", csv.text, "--json",
                 csv.text);
    EXPECT_ERROR(1, TEXTS("an interval needs two frames"), "sense", SENSE, "--frames", "3:3");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(confirms_the_contacts_and_no_others),
        cmocka_unit_test(compares_with_the_detector),
        cmocka_unit_test(says_what_it_has_missed),
        cmocka_unit_test(without_the_check_nothing_is_confirmed),
        cmocka_unit_test(same_bytes_for_any_number_of_threads),
        cmocka_unit_test(renews_what_has_grown_and_says_so),
        cmocka_unit_test(draws_a_picture),
        cmocka_unit_test(quiet_is_quiet),
        cmocka_unit_test(unfit_options_are_refused),
    };
    return cmocka_run_group_tests_name("tool_sense", tests, make_files, remove_files);
}
