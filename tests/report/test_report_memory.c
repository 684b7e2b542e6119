/* A report, and what it keeps of answers, events and long summaries, survives every failed allocation: it says so, nothing leaks, and
 * nothing of the tries that failed is in the page of the one that did not. */
#include "tests/support/calls.h"
#include "tests/support/files.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tool/report/page.h"
#include "tool/report/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { POINTS = 5000, EVENTS = REPORT_EVENTS_MAX + 3 };

static scene shape;
static rig r;
static cscd_plan *plan;
static cscd_contacts contacts;
static cscd_event events[EVENTS];
static cscd_curve_point points[POINTS];

/* Made-up answers have numbers that zlib cannot make much smaller, so that the arrays grow. */
static int set_up(void **state) {
    uint32_t value = 1;
    cscd_plan_options options = cscd_plan_defaults();
    scene_make(SCENE_BENT_CAPSULE, 1, &shape);
    r = rig_create(&shape, 1, NULL);
    assert_int_equal(plan_create_packed(r.mesh, shape.x0, &options, &plan), CSCD_OK);
    cscd_detector_destroy(r.detector);
    assert_int_equal(detector_create_here(r.mesh, plan, NULL, &r.detector), CSCD_OK);
    contacts = rig_step(&r, &shape);
    for (size_t i = 0; i < POINTS; i++) {
        value = value * 1664525U + 1013904223U;
        points[i] =
            (cscd_curve_point){.edge = UINT32_MAX, .triangle = (value >> 16) % 4, .s = value * 0x1p-32};
    }
    for (uint32_t i = 0; i < EVENTS; i++)
        events[i] = (cscd_event){
            .b = i, .first_frame = 1, .last_frame = 1, .worst_frame = 1, .depth = i, .x = {NAN, NAN, NAN}};
    return own_folder_make(state);
}

static int tear_down(void **state) {
    cscd_plan_destroy(plan);
    rig_destroy(&r);
    return own_folder_remove(state);
}

static const char *name_of_part(void *user, uint32_t part, char buffer[REPORT_PART_NAME_SIZE]) {
    (void)user;
    snprintf(buffer, REPORT_PART_NAME_SIZE, "part %u", part);
    return buffer;
}

/* The interval with its contacts and orientations, answers of the first frame, and events. */
static bool fill_report(report *page, io_error *error) {
    const cscd_intersection pair = {.a = 0, .b = 5, .kind = CSCD_INTERSECTION_CROSSING};
    const cscd_curve curve = {.point_count = POINTS, .piece_count = POINTS, .closed = true};
    const cscd_depth depth = {.vertex = 3, .depth = 0.5};
    const cscd_curves curves = {.items = &curve, .count = 1, .points = points, .point_count = POINTS};
    const cscd_depths depths = {.items = &depth, .count = 1, .vertex_count = 1};
    const cscd_intersections found = {.items = &pair, .count = 1, .curves = &curves, .depths = &depths};
    orientation_row row;
    if (!orientation_row_create(r.detector, r.mesh, &row)) return io_fail(error, "out of memory");
    orientation_row_take(&row, r.detector);
    const bool filled = report_begin(page, shape.x0, error) && report_add_answers(page, 0, &found, error) &&
                        report_add_interval(page, &row, &contacts, shape.x1, error) &&
                        report_add_scenery(page, (const double[9]){0, 0, 0, 1, 0, 0, 0, 1, 0}, error) &&
                        report_set_events(page, events, EVENTS, name_of_part, NULL, error);
    orientation_row_free(&row);
    return filled;
}

static bool write_report(const char *path, const char *summary, io_error *error) {
    static const uint32_t triangle[] = {0, 1, 2};
    const report_options options = {.kind = REPORT_REPLAY,
                                    .title = "a.obj",
                                    .generator = "cscd",
                                    .mesh = r.mesh,
                                    .plan = plan,
                                    .last = 1,
                                    .oriented = true,
                                    .scenery = {3, 1, triangle, false}};
    report *page = NULL;
    const bool written = report_create(&options, &page, error) && fill_report(page, error) &&
                         report_write(page, path, &(const report_summary){"a.json", summary}, 1, NULL, error);
    report_destroy(page);
    return written;
}

/* A summary whose rows become columns of the page; to be freed. */
static char *make_summary(void) {
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    fputs("{\"first\": [1, {\"a\": \"},]\\\"\"}], \"intervals\": [", file);
    for (int i = 0; i < JSON_TABLE_ROWS_LEAST; i++)
        fprintf(file, "%s{\"frame\": %d, \"toi\": %s, \"ms\": {\"all\": %g}, \"state\": \"%s\"}",
                i > 0 ? ", " : "", i, i % 3 == 0 ? "null" : "0.5", 0.1 * i, i % 2 == 0 ? "a\\\\" : "b");
    fputs("], \"last\": {\"x\": 1}}", file);
    assert_int_equal(fclose(file), 0);
    return text;
}

static void expect_same_files(const char *a, const char *b) {
    FILE *files[] = {fopen(a, "rb"), fopen(b, "rb")};
    assert_true(files[0] != NULL && files[1] != NULL);
    for (int c = 0; c != EOF;) {
        c = getc(files[0]);
        assert_int_equal(c, getc(files[1]));
    }
    for (int i = 0; i < 2; i++) fclose(files[i]);
}

TEST(memory_that_runs_out_leaves_nothing) {
    const temp_path path = temp_file_path(&own_folder, "page.html"),
                    whole = temp_file_path(&own_folder, "whole.html");
    struct stat status;
    char *summary = make_summary();
    io_error error = {""};
    assert_true(write_report(whole.text, summary, &error));
    long place = 0;
    for (; io_allocations_go_on(place); place++) {
        const bool written = write_report(path.text, summary, &error);
        io_allocations_left = -1;
        assert_int_equal(written, !io_allocation_failed);
        if (written) continue;
        assert_non_null(strstr(error.text, "out of memory"));
        assert_int_not_equal(stat(path.text, &status), 0);
    }
    print_message("refused in %ld places\n", place - 1);
    assert_true(place > 120);
    expect_same_files(path.text, whole.text);
    free(summary);
}

/* What is cut anywhere is copied or left alone, and nothing is read beyond its end. */
TEST(a_summary_that_is_cut_is_survived) {
    char *text = make_summary();
    const size_t size = strlen(text);
    for (size_t length = 0; length < size; length += length < 80 || length + 80 > size ? 1 : 997) {
        page_arrays arrays = {.count = 0};
        char *cut = malloc(length + 1), *moved = NULL;
        assert_non_null(cut);
        memcpy(cut, text, length);
        cut[length] = '\0';
        assert_true(json_table_move(cut, "s", &arrays, &moved));
        page_arrays_free(&arrays);
        free(moved);
        free(cut);
    }
    free(text);
}

static void expect_divided(const char *text, const char *complaint) {
    report_template parts;
    io_error error = {""};
    bool divided = report_template_divide(text, strlen(text), &parts, &error);
    assert_int_equal(divided, complaint == NULL);
    if (!divided) assert_non_null(strstr(error.text, complaint));
}

TEST(a_template_has_one_place_for_data) {
    expect_divided("<html>\n<!--cscd:data-->\n</html>\n", NULL);
    expect_divided("", "lacks the line <!--cscd:data-->");
    expect_divided("<html>\n</html>\n", "lacks the line <!--cscd:data-->; run make template");
    expect_divided("<html>\n <!--cscd:data-->\n</html>\n", "lacks the line");
    expect_divided("<html>\n<!--cscd:data-->\n<!--cscd:data-->\n</html>\n", "twice");
}

AROUND_ALL(set_up, tear_down)
