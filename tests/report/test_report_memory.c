/* What a report keeps of answers and events survives every failed allocation: it says so, and nothing leaks. */
#include "src/io/growable.h"
#include "tests/support/io_allocations.h"
#include "tests/support/packed.h"
#include "tests/support/report/page_reader.h"
#include "tests/support/report/report_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 2, POINTS = 20000, EVENTS = REPORT_EVENTS_MAX + 3 };

static const char *name_of_part(void *user, uint32_t part, char buffer[REPORT_PART_NAME_SIZE]) {
    (void)user;
    snprintf(buffer, REPORT_PART_NAME_SIZE, "part %u", part);
    return buffer;
}

/* Numbers that zlib cannot make much smaller, so that the arrays grow. */
static void scatter_points(cscd_curve_point *points) {
    uint32_t value = 1;
    for (size_t i = 0; i < POINTS; i++) {
        value = value * 1664525U + 1013904223U;
        points[i] =
            (cscd_curve_point){.edge = UINT32_MAX, .triangle = (value >> 16) % 4, .s = value * 0x1p-32};
    }
}

static void scatter_events(cscd_event *events) {
    for (uint32_t i = 0; i < EVENTS; i++)
        events[i] = (cscd_event){
            .b = i, .first_frame = 1, .last_frame = 1, .worst_frame = 1, .depth = i, .x = {NAN, NAN, NAN}};
}

/* Keeps made-up answers of the first frame, and events; the report if all of it has worked. */
static report *keep_answers(const report_options *options, const double *positions, io_error *error) {
    static cscd_curve_point points[POINTS];
    static cscd_event events[EVENTS];
    scatter_points(points);
    scatter_events(events);
    const cscd_intersection_pair pair = {.a = 0, .b = 5, .kind = CSCD_INTERSECTION_CROSSING};
    const cscd_curve curve = {.point_count = POINTS, .piece_count = POINTS, .closed = true};
    const cscd_depth depth = {.vertex = 3, .depth = 0.5};
    const cscd_curves curves = {.items = &curve, .count = 1, .points = points, .point_count = POINTS};
    const cscd_depths depths = {.items = &depth, .count = 1, .vertex_count = 1};
    const cscd_intersection_pairs found = {.items = &pair, .count = 1, .curves = &curves, .depths = &depths};
    report *r = NULL;
    if (!report_create(options, &r, error)) return NULL;
    if (report_begin(r, positions, error) && report_add_answers(r, 0, &found, error) &&
        report_set_events(r, events, EVENTS, name_of_part, NULL, error))
        return r;
    report_destroy(r);
    return NULL;
}

/* Nothing of the tries that failed is in the page of the one that did not. */
static void check_page(report *r) {
    io_error error = {""};
    temp_folder folder = temp_folder_make();
    temp_path path = temp_file_path(&folder, "report.html");
    if (!report_write(r, path.text, NULL, 0, NULL, &error)) fail_msg("%s", error.text);
    page p = page_read(path.text);
    const json_node *answers = json_node_member(p.scene, "answers");
    assert_true(json_node_number(answers, "points_kept") == POINTS + 1.0);
    assert_true(json_node_number(answers, "events_found") == EVENTS);
    assert_int_equal(json_node_member(answers, "events")->count, REPORT_EVENTS_MAX);
    page_free(&p);
    temp_folder_remove(&folder);
}

TEST(answers_and_events_survive_failed_allocations) {
    report_rig rig = report_rig_create(recorded_tetrahedra(FRAMES), CSCD_METHOD_SINGLE);
    report_options options = report_rig_options(&rig);
    options.oriented = false;
    long successes = 0;
    for (;; successes++) {
        io_error error = {""};
        io_allocations_left = successes;
        io_allocation_failed = false;
        report *r = keep_answers(&options, rig.shape.frames, &error);
        io_allocations_left = -1;
        assert_int_equal(r != NULL, !io_allocation_failed);
        if (r == NULL) {
            assert_non_null(strstr(error.text, "out of memory"));
            continue;
        }
        check_page(r);
        report_destroy(r);
        break;
    }
    assert_true(successes > 40); /* five of each of the nine arrays of answers alone */
    report_rig_destroy(&rig);
}
