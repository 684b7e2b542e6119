/* What a report keeps of what intersects: triangles, curves, depths and events, all of them bounded. */
#include "tests/support/own_folder.h"
#include "tests/support/packed.h"
#include "tests/support/report/page_reader.h"
#include "tests/support/report/report_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 7 };

static page write_page(report *r) {
    io_error error = {""};
    temp_path path = temp_file_path(&folder, "report.html");
    if (!report_write(r, path.text, NULL, 0, NULL, &error)) fail_msg("%s", error.text);
    report_destroy(r);
    return page_read(path.text);
}

static report *create_report(const report_options *options) {
    io_error error = {""};
    report *r = NULL;
    if (!report_create(options, &r, &error)) fail_msg("%s", error.text);
    return r;
}

/* Made-up answers: pairs of three triangles, a closed curve of too many points, and one vertex in two objects. */
enum { POINTS = 300000, ANSWERED = 2 };

static page answered_page(const report_rig *rig) {
    static cscd_curve_point points[POINTS];
    const cscd_intersection_pair pairs[] = {{.a = 0, .b = 5, .kind = CSCD_INTERSECTION_TOUCHING},
                                            {.a = 0, .b = 6, .kind = CSCD_INTERSECTION_CROSSING}};
    const cscd_curve curve = {.point_count = POINTS, .piece_count = POINTS, .closed = true};
    const cscd_depth depths[] = {{.vertex = 3, .depth = 0.5}, {.vertex = 3, .body = 1, .depth = 0.75}};
    cscd_curves curves = {.items = &curve, .count = 1, .points = points, .point_count = POINTS};
    cscd_depths all_depths = {.items = depths, .count = 2, .vertex_count = 2};
    cscd_intersection_pairs found = {.items = pairs, .count = 2, .curves = &curves, .depths = &all_depths};
    report_options options = report_rig_options(rig);
    options.last = ANSWERED - 1;
    options.oriented = false;
    for (int i = 0; i < POINTS; i++) points[i] = (cscd_curve_point){.edge = UINT32_MAX, .triangle = 2};
    report *r = create_report(&options);
    assert_true(report_begin(r, rig->shape.frames, NULL));
    assert_true(report_add_answers(r, 0, &found, NULL));
    assert_true(report_add_interval(r, NULL, &(cscd_contacts){.count = 0}, rig->shape.frames, NULL));
    assert_true(report_add_answers(r, 1, &found, NULL));
    return write_page(r);
}

static void expect_numbers(const page *p, const char *name, const void *numbers, size_t size) {
    page_bytes bytes = page_array(p, name);
    assert_int_equal(bytes.size, size);
    assert_memory_equal(bytes.data, numbers, size);
    free(bytes.data);
}

TEST(answers_are_bounded_and_each_frame_keeps_its_share) {
    enum { KEPT = REPORT_ANSWER_POINTS_MAX / ANSWERED };
    report_rig rig = report_rig_create(recorded_tetrahedra(FRAMES), CSCD_METHOD_SINGLE);
    page p = answered_page(&rig);
    const uint32_t counts[] = {1, 1, 3, KEPT, 1, 1, 1, 3, KEPT, 1}, triangles[] = {0, 5, 6, 0, 5, 6};
    const uint8_t kinds[] = {17, 16, 1, 17, 16, 1};
    expect_numbers(&p, "answer_frame", (const uint32_t[]){0, 1}, sizeof(uint32_t[2]));
    expect_numbers(&p, "answer_counts", counts, sizeof counts);
    expect_numbers(&p, "answer_triangle", triangles, sizeof triangles);
    expect_numbers(&p, "answer_kind", kinds, sizeof kinds);
    expect_numbers(&p, "depth", (const float[]){0.75F, 0.75F}, sizeof(float[2]));
    const json_node *answers = json_node_member(p.scene, "answers");
    assert_true(json_node_number(answers, "points_found") == ANSWERED * (POINTS + 1.0));
    assert_true(json_node_number(answers, "points_kept") == ANSWERED * KEPT);
    page_free(&p);
    report_rig_destroy(&rig);
}

static const char *name_of_part(void *user, uint32_t part, char buffer[REPORT_PART_NAME_SIZE]) {
    (void)user;
    snprintf(buffer, REPORT_PART_NAME_SIZE, "part %u", part);
    return buffer;
}

/* More events than a page has room for: the deep ones stay, in their order. */
TEST(of_many_events_the_worst_are_kept) {
    enum { EVENTS = REPORT_EVENTS_MAX + 500 };
    static cscd_event events[EVENTS];
    for (uint32_t i = 0; i < EVENTS; i++)
        events[i] =
            (cscd_event){.b = i, .first_frame = 1, .depth = i % 5 == 0 ? 0.0 : i, .x = {NAN, NAN, NAN}};
    report_rig rig = report_rig_create(recorded_tetrahedra(FRAMES), CSCD_METHOD_SINGLE);
    report_options options = report_rig_options(&rig);
    options.oriented = false;
    report *r = create_report(&options);
    assert_true(report_begin(r, rig.shape.frames, NULL));
    assert_true(report_add_answers(r, 0, &(cscd_intersection_pairs){.count = 0}, NULL));
    assert_true(report_set_events(r, events, EVENTS, name_of_part, NULL, NULL));
    page p = write_page(r);
    const json_node *answers = json_node_member(p.scene, "answers");
    assert_true(json_node_number(answers, "events_found") == EVENTS);
    uint32_t count = 0;
    for (const json_node *event = json_node_member(answers, "events")->first; event != NULL;
         event = event->next) {
        char name[REPORT_PART_NAME_SIZE];
        snprintf(name, sizeof name, "part %u", count / 4 * 5 + 1 + count % 4);
        assert_string_equal(json_node_string(event, "b"), name);
        count++;
    }
    assert_int_equal(count, REPORT_EVENTS_MAX);
    page_free(&p);
    report_rig_destroy(&rig);
}

AROUND_ALL(own_folder_make, own_folder_remove)
