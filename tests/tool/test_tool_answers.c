/* The answers of check and replay: the sentence, the events in every form, and the rules that fail a run. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include "cscd/cscd.h"
#include "src/tool/answers/consequences.h"
#include "src/tool/common/event_order.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 8 };

static temp_folder folder;
static temp_path model, cache, json, csv, xml;
static recorded flight;

/* The two tetrahedra, of which the first is called <Wall> & "Co". */
static int make_files(void **state) {
    (void)state;
    flight = recorded_tetrahedra(FRAMES);
    const char *records[8];
    for (int t = 0; t < 8; t++) records[t] = t < 4 ? "o <Wall>&\"Co\"" : "o Dart";
    folder = temp_folder_make();
    model = recorded_write_parts(&folder, "named.obj", &flight, records);
    cache = recorded_write_cache(&folder, "flight.pc2", &flight);
    json = temp_file_path(&folder, "out.json");
    csv = temp_file_path(&folder, "out.csv");
    xml = temp_file_path(&folder, "out.xml");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    recorded_free(&flight);
    temp_folder_remove(&folder);
    return 0;
}

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

static void expect_first_line(const tool_run *run, const char *line) {
    const size_t length = strlen(line);
    if (strncmp(run->out, line, length) != 0 || run->out[length] != '\n')
        fail_msg("expected '%s' first in: %s%s", line, run->out, run->error);
}

/* ---- the sentence --------------------------------------------------------------------------------------- */

static void the_answer_comes_first(void **state) {
    (void)state;
    const char *found = "Frames 4 to 7 cross (4 of 8). 1 event, <Wall>&\"Co\" x Dart, frames 4 to 7, "
                        "0.834 deep at frame 6.";
    tool_run run = RUN_TOOL("replay", model.text, cache.text);
    expect_first_line(&run, found);
    tool_run_free(&run);
    run = RUN_TOOL("check", model.text, cache.text);
    expect_first_line(&run, found);
    assert_non_null(strstr(run.out, "\n<Wall>&\"Co\" x Dart  cross    4 to 7               6      0.834  "));
    tool_run_free(&run);
    run = RUN_TOOL("replay", model.text, cache.text, "--unit", "cm");
    expect_first_line(&run, "Frames 4 to 7 cross (4 of 8). 1 event, <Wall>&\"Co\" x Dart, frames 4 to 7, "
                            "8.34 mm deep at frame 6.");
    tool_run_free(&run);
    run = RUN_TOOL("replay", model.text, cache.text, "--first-frame", "1001", "--frames", "1001:1003");
    expect_first_line(&run, "No frame crosses or touches (3 checked). Only frames 1001 to 1003 of 1001 to "
                            "1008 were looked at.");
    tool_run_free(&run);
    run = RUN_TOOL("replay", model.text, cache.text, "--frames", "4:6");
    assert_non_null(strstr(run.out, "All 3 frames cross. 1 event, "));
    tool_run_free(&run);
}

/* A single mesh: how many triangles cross, and which only touch. */
static void one_mesh_has_a_sentence_of_its_own(void **state) {
    (void)state;
    static const struct {
        const char *text, *sentence;
    } cases[] = {
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "Clean: no two triangles cross or touch."},
        {"o A\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\no B\nv 1 1 -1\nv 2 1 -1\nv 1 1 1\nf 4 5 6\n",
         "1 pair of triangles crosses, with 2 of 2 triangles (100 %). 1 place, A x B, crossing along 0.5."},
        {"o A\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\no B\nv 1 1 0\nv 2 1 1\nv 1 2 1\nf 4 5 6\n",
         "1 pair of triangles touches, none cross. 1 place, A x B."},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        temp_path path = write_text("one.obj", cases[i].text);
        tool_run run = RUN_TOOL("check", path.text);
        assert_int_equal(run.code, 0);
        expect_first_line(&run, cases[i].sentence);
        tool_run_free(&run);
    }
}

/* ---- events --------------------------------------------------------------------------------------------- */

/* The events of the flight by the library itself, without contacts. */
static cscd_event expected_event(bool depths) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_event_tracker *tracker = NULL;
    cscd_events events;
    const uint32_t labels[] = {0, 0, 0, 0, 1, 1, 1, 1};
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    const cscd_object_desc object = cscd_object_of_triangles(8, 8, flight.triangles);
    assert_int_equal(cscd_mesh_create(context, &object, 1, &mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(context, mesh, NULL, NULL, &detector), CSCD_OK);
    assert_int_equal(cscd_detector_set_parts(detector, labels, 2), CSCD_OK);
    cscd_event_options options = cscd_event_defaults();
    options.part_count = 2;
    options.labels = labels;
    assert_int_equal(cscd_event_tracker_create(context, mesh, &options, &tracker), CSCD_OK);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        cscd_intersection_options asked = cscd_intersection_defaults();
        asked.curves = asked.patches = asked.depths = asked.part_bodies = depths;
        cscd_intersection_pairs found;
        const cscd_view *view = CSCD_DOUBLES(recorded_position(&flight, frame, 0), 8);
        assert_int_equal(cscd_detector_find_intersections(detector, view, &asked, &found), CSCD_OK);
        assert_int_equal(cscd_event_tracker_add_frame(tracker, frame, &found), CSCD_OK);
    }
    assert_int_equal(cscd_event_tracker_finish(tracker, &events), CSCD_OK);
    assert_int_equal(events.count, 1);
    cscd_event event = events.items[0];
    cscd_event_tracker_destroy(tracker);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return event;
}

static void expect_event(const json_node *root, const cscd_event *expected, uint64_t contacts) {
    const json_node *events = json_node_member(root, "events");
    assert_int_equal(events->count, 1);
    const json_node *event = json_node_item(events, 0), *point = json_node_member(event, "point");
    assert_string_equal(json_node_string(event, "a"), "<Wall>&\"Co\"");
    assert_string_equal(json_node_string(event, "b"), "Dart");
    assert_true(json_node_number(event, "first") == (double)expected->first_frame);
    assert_true(json_node_number(event, "last") == (double)expected->last_frame);
    assert_true(json_node_number(event, "worst") == (double)expected->worst_frame);
    assert_true(json_node_number(event, "pairs") == (double)expected->pairs);
    assert_true(json_node_number(event, "contacts") == (double)contacts);
    assert_true((expected->depth > 0.0 ? json_node_number(event, "depth") : 0.0) == expected->depth);
    assert_true(json_node_number(event, "length") == expected->length);
    assert_true(json_node_number(event, "triangle") == expected->triangle);
    assert_int_equal(json_node_member(event, "kinds")->count, 1);
    assert_string_equal(json_node_item(json_node_member(event, "kinds"), 0)->text, "crossing");
    for (size_t k = 0; k < 3 && expected->depth > 0.0; k++)
        assert_true(json_node_item(point, k)->number == expected->x[k]);
}

static void events_are_those_of_the_library(void **state) {
    (void)state;
    const cscd_event expected = expected_event(true), shallow = expected_event(false);
    EXPECT_TOOL(0, "check", model.text, cache.text, "--json", json.text, "--events", csv.text);
    json_node *root = json_node_read_file(json.text);
    expect_event(root, &expected, 0);
    assert_int_equal(json_node_member(root, "unit")->kind, JSON_NULL);
    json_node_free(root);
    char row[400], *text = read_whole_file(csv.text, NULL);
    snprintf(
        row, sizeof row,
        "a,b,first,last,worst,kinds,pairs,contacts,depth,length,x,y,z,triangle,face,object\n"
        "\"<Wall>&\"\"Co\"\"\",\"Dart\",4,7,6,crossing,%d,0,%.17g,%.17g,%.17g,%.17g,%.17g,%u,%u,\"named\"\n",
        (int)expected.pairs, expected.depth, expected.length, expected.x[0], expected.x[1], expected.x[2],
        expected.triangle, expected.triangle);
    assert_string_equal(text, row);
    free(text);
    EXPECT_TOOL(0, "check", model.text, cache.text, "--json", json.text, "--no-depths");
    root = json_node_read_file(json.text);
    expect_event(root, &shallow, 0);
    json_node_free(root);
}

/* Contacts of intervals belong to the frames at their ends, so the event is that of check and theirs. */
static void events_of_a_replay_have_contacts(void **state) {
    (void)state;
    const cscd_event expected = expected_event(true);
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", json.text, "--unit", "mm");
    json_node *root = json_node_read_file(json.text);
    const json_node *total = json_node_member(root, "summary");
    expect_event(root, &expected, (uint64_t)(json_node_number(total, "vf") + json_node_number(total, "ee")));
    assert_string_equal(json_node_string(root, "unit"), "mm");
    const json_node *frame = json_node_item(json_node_member(root, "frames"), 6);
    assert_true(json_node_number(frame, "depth") == expected.depth);
    assert_true(json_node_number(frame, "crossing_share") == json_node_number(frame, "crossing_faces") / 8.0);
    json_node_free(root);
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", json.text, "--no-check");
    root = json_node_read_file(json.text);
    const json_node *event = json_node_item(json_node_member(root, "events"), 0);
    assert_true(json_node_number(event, "pairs") == 0 && json_node_number(event, "contacts") > 0);
    frame = json_node_item(json_node_member(root, "frames"), 6);
    assert_int_equal(json_node_member(frame, "crossing")->kind, JSON_NULL);
    json_node_free(root);
}

/* What one part buries in a second one may be nearest to its own surface: that is told last, however deep. */
static void what_lies_in_itself_comes_last(void **state) {
    (void)state;
    const cscd_event events[] = {{.a = 2, .b = 2, .depth = 0.104},
                                 {.a = 1, .b = 2, .depth = 0.103, .pairs = 46},
                                 {.a = 1, .b = 1, .depth = 0.2, .contacts = 1},
                                 {.a = 0, .b = 1, .depth = 0.05},
                                 {.a = 1, .b = 1, .depth = 0.3}};
    const cscd_event *order[] = {events, events + 1, events + 2, events + 3, events + 4};
    const ptrdiff_t expected[] = {2, 1, 3, 4, 0};
    event_order_sort(order, 5);
    for (size_t i = 0; i < 5; i++) assert_int_equal(order[i] - events, expected[i]);
}

/* What lies in itself while another part cuts it is no event of its own; at any other time it is. */
static void what_follows_is_left_out(void **state) {
    (void)state;
    cscd_event events[] = {
        {.a = 1, .b = 2, .first_frame = 4, .last_frame = 5, .pairs = 1},
        {.a = 1, .b = 2, .first_frame = 1, .last_frame = 9, .pairs = 3},
        {.a = 1, .b = 1, .first_frame = 9, .last_frame = 12, .depth = 0.1},  /* follows */
        {.a = 2, .b = 2, .first_frame = 0, .last_frame = 1, .depth = 0.2},   /* follows */
        {.a = 2, .b = 2, .first_frame = 10, .last_frame = 11, .depth = 0.3}, /* at another time */
        {.a = 3, .b = 3, .first_frame = 4, .last_frame = 5, .depth = 0.4},   /* of another part */
        {.a = 1, .b = 1, .first_frame = 4, .last_frame = 5, .contacts = 1},  /* with a contact */
        {.a = 0, .b = 1, .first_frame = 4, .last_frame = 5, .depth = 0.5},   /* of two parts */
        {.a = 1, .b = 1, .first_frame = 4, .last_frame = 5, .depth = 0.6, .kinds = CSCD_EVENT_IN_OTHER_BODY},
    };
    const size_t expected[] = {0, 1, 4, 5, 6, 7, 8};
    cscd_event all[9];
    memcpy(all, events, sizeof all);
    size_t count = 9;
    assert_true(consequences_leave_out(events, &count));
    assert_int_equal(count, 7);
    for (size_t i = 0; i < count; i++) assert_memory_equal(&events[i], &all[expected[i]], sizeof *events);
}

/* Two quads and a triangle that passes through the second one: triangles 2 and 3 are the polygon 1. */
static void polygons_have_the_numbers_of_the_file(void **state) {
    (void)state;
    temp_path path = write_text("quads.obj", "v 9 0 0\nv 10 0 0\nv 10 1 0\nv 9 1 0\n"
                                             "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n"
                                             "v 0.9 0.8 -1\nv 1.1 0.8 -1\nv 1 1.1 1\n"
                                             "f 1 2 3 4\nf 5 6 7 8\nf 9 10 11\n");
    EXPECT_TOOL(0, "check", path.text, "--json", json.text, "--csv", csv.text);
    json_node *root = json_node_read_file(json.text);
    const json_node *frame = json_node_item(json_node_member(root, "frames"), 0);
    const json_node *pairs = json_node_member(frame, "pairs"), *faces = json_node_member(frame, "faces");
    assert_true(pairs->count > 0 && faces->count == pairs->count);
    for (size_t i = 0; i < pairs->count; i++) {
        assert_true(json_node_item(json_node_item(pairs, i), 0)->number >= 2);
        assert_true(json_node_item(json_node_item(pairs, i), 1)->number == 4);
        assert_true(json_node_item(json_node_item(faces, i), 0)->number == 1);
        assert_true(json_node_item(json_node_item(faces, i), 1)->number == 2);
    }
    json_node_free(root);
    char *text = read_whole_file(csv.text, NULL);
    assert_non_null(strstr(text, "0,crossing,2,4,1,2,\"component 1\",\"component 2\",\"quads\",\"quads\"\n"));
    free(text);
}

/* ---- rules ---------------------------------------------------------------------------------------------- */

static void rules_fail_the_run(void **state) {
    (void)state;
    static const struct {
        int code;
        const char *command, *option, *value, *frames;
    } cases[] = {
        {0, "check", "--fail-on", "crossing", ":3"},    {3, "check", "--fail-on", "crossing", ":4"},
        {3, "check", "--fail-on", "touching", ":4"},    {0, "replay", "--fail-on", "contact", ":3"},
        {3, "replay", "--fail-on", "contact", ":4"},    {3, "replay", "--fail-on", "crossing", ":4"},
        {0, "check", "--fail-depth", "0.85", NULL},     {3, "check", "--fail-depth", "0.8", NULL},
        {0, "replay", "--fail-depth", "0.85", NULL},    {3, "replay", "--fail-depth", "0.8", NULL},
        {0, "check", "--max-faces", "8", NULL},         {3, "check", "--max-faces", "1", NULL},
        {2, "check", "--fail-on", "contact", NULL},     {2, "check", "--fail-depth", "-1", NULL},
        {2, "check", "--fail-depth", "1 parsec", NULL}, {2, "check", "--unit", "yard", NULL},
        {1, "check", "--fail-depth", "2mm", NULL},      {1, "replay", "--fail-depth", "2mm", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        EXPECT_TOOL(cases[i].code, cases[i].command, model.text, cache.text, cases[i].option, cases[i].value,
                    cases[i].frames != NULL ? "--frames" : NULL, cases[i].frames);
    EXPECT_TOOL(3, "check", model.text, cache.text, "--fail-depth", "8mm", "--unit", "cm");
    EXPECT_TOOL(0, "check", model.text, cache.text, "--fail-depth", "8.5mm", "--unit", "cm");
    EXPECT_TOOL(3, "replay", model.text, cache.text, "--fail-depth", "2ft", "--unit", "m");
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--fail-depth", "3ft", "--unit", "m");
}

/* The meshes of check --each fail by the same words. */
static void rules_hold_for_each_mesh(void **state) {
    (void)state;
    temp_path touch = write_text("touching.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n"
                                                 "v 1 1 0\nv 2 1 1\nv 1 2 1\nf 4 5 6\n");
    EXPECT_TOOL(0, "check", "--each", touch.text, model.text, "--fail-on", "crossing");
    EXPECT_TOOL(3, "check", "--each", touch.text, model.text, "--fail-on", "touching");
    EXPECT_TOOL(3, "check", "--each", touch.text, model.text, "--fail-on-contact");
    EXPECT_TOOL(0, "check", "--each", touch.text, "--fail-depth", "1");
}

/* A body that stands in another one for all frames moves without a new contact: it fails as well. */
static void standing_intersections_fail(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("replay", model.text, cache.text, "--frames", "4:5", "--fail-on", "contact",
                            "--ignore-parts", "Dart,Dart");
    assert_int_equal(run.code, 3);
    assert_non_null(strstr(run.error,
                           "cscd: failed: 2 of 2 frames, the first is frame 4: 3 pairs of triangles "
                           "cross, worst: <Wall>&\"Co\" x Dart\n"));
    tool_run_free(&run);
    temp_path path = write_text("touch.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n"
                                             "v 1 1 0\nv 2 1 1\nv 1 2 1\nf 4 5 6\n");
    EXPECT_TOOL(0, "check", path.text, "--fail-on", "crossing");
    EXPECT_TOOL(3, "check", path.text, "--fail-on", "touching");
    EXPECT_TOOL(3, "check", path.text, "--fail-on-contact");
    EXPECT_TOOL(3, "replay", path.text, path.text, path.text, "--fail-on", "contact");
    EXPECT_TOOL(0, "replay", path.text, path.text, path.text, "--fail-on", "crossing");
}

static size_t count_of(const char *text, const char *part) {
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, part)) != NULL; at++) count++;
    return count;
}

static void junit_has_a_case_for_each_frame(void **state) {
    (void)state;
    EXPECT_TOOL(0, "check", model.text, cache.text, "--junit", xml.text);
    char *text = read_whole_file(xml.text, NULL);
    assert_non_null(strstr(text, "tests=\"8\" failures=\"4\""));
    assert_int_equal(count_of(text, "<testcase "), 8);
    assert_int_equal(count_of(text, "<failure message=\"3 pairs of triangles cross, worst: &#60;Wall&#62;"
                                    "&#38;&#34;Co&#34; x Dart\"/>"),
                     count_of(text, "<failure message=\"3 pairs"));
    assert_int_equal(count_of(text, "<failure "), 4);
    free(text);
    EXPECT_TOOL(3, "replay", model.text, cache.text, "--junit", xml.text, "--fail-depth", "0.83", "--quiet");
    text = read_whole_file(xml.text, NULL);
    assert_non_null(strstr(text, "failures=\"1\""));
    assert_non_null(strstr(text, "name=\"frame 6\""));
    assert_non_null(strstr(text, "<failure message=\"0.834 deep, worst: "));
    free(text);
}

static void long_names_are_cut_between_characters(void **state) {
    (void)state;
    char name[2 * 80 + 2] = "x", text[400];
    for (size_t i = 0; i < 80; i++) memcpy(&name[1 + 2 * i], "\xc3\x84", 3);
    snprintf(text, sizeof text,
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv .2 .2 -1\nv .2 .2 1\nv .3 .3 1\no %s\nf 1 2 3\no B\nf 4 5 6\n",
             name);
    const temp_path long_name = write_text("long.obj", text);
    char whole[130];
    snprintf(whole, sizeof whole, "worst: %.99s x B", name);
    tool_run run = RUN_TOOL("check", long_name.text, "--fail-on", "crossing");
    assert_non_null(strstr(run.error, whole));
    tool_run_free(&run);
    EXPECT_ERROR(1, TEXTS("\xc3\x84, B"), "check", long_name.text, "--only", "C");
}

/* ---- outputs -------------------------------------------------------------------------------------------- */

static void outputs_are_not_inputs_nor_each_other(void **state) {
    (void)state;
    EXPECT_ERROR(2, TEXTS("--events", "would overwrite"), "check", model.text, "--events", model.text);
    EXPECT_ERROR(2, TEXTS("--events", "ends in .csv"), "check", model.text, "--events", "e.json");
    EXPECT_ERROR(2, TEXTS("--junit", "ends in .xml"), "replay", model.text, cache.text, "--junit", "j.csv");
    EXPECT_ERROR(2, TEXTS("--csv", "standard output twice"), "check", model.text, "--json", "-", "--csv",
                 "-");
    EXPECT_ERROR(2, TEXTS("--events", "would overwrite"), "replay", model.text, cache.text, "--contacts",
                 csv.text, "--events", csv.text);
    EXPECT_ERROR(2, TEXTS("--junit", "standard output twice"), "check", model.text, "--json", "-", "--junit",
                 "-");
    EXPECT_ERROR(2, TEXTS("--events", "standard output twice"), "check", model.text, "--events", "-",
                 "--junit", "-");
    EXPECT_ERROR(1, TEXTS("nowhere", "cannot write"), "check", model.text, "--events", "/nowhere/e.csv");
    tool_run run = RUN_TOOL("check", model.text, cache.text, "--events", "-");
    assert_int_equal(strncmp(run.out, "a,b,first", 9), 0);
    assert_int_equal(strncmp(run.error, "Frames 4 to 7 cross", 19), 0);
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_answer_comes_first),
        cmocka_unit_test(one_mesh_has_a_sentence_of_its_own),
        cmocka_unit_test(events_are_those_of_the_library),
        cmocka_unit_test(events_of_a_replay_have_contacts),
        cmocka_unit_test(what_lies_in_itself_comes_last),
        cmocka_unit_test(what_follows_is_left_out),
        cmocka_unit_test(polygons_have_the_numbers_of_the_file),
        cmocka_unit_test(rules_fail_the_run),
        cmocka_unit_test(rules_hold_for_each_mesh),
        cmocka_unit_test(standing_intersections_fail),
        cmocka_unit_test(junit_has_a_case_for_each_frame),
        cmocka_unit_test(long_names_are_cut_between_characters),
        cmocka_unit_test(outputs_are_not_inputs_nor_each_other),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
