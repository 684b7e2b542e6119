/* Rules that fail a run hold exactly at their bounds, and answers have the numbers of the files. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 8 };

static temp_folder folder;
static temp_path model, cache, json, xml, quads, post;

/* Two quads, of which the second, triangles 2 and 3, has a post through it. */
static const char quads_text[] = "v 9 0 0\nv 10 0 0\nv 10 1 0\nv 9 1 0\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n"
                                 "f 1 2 3 4\nf 5 6 7 8\n";
static const char post_text[] = "v 0.9 0.8 -1\nv 1.1 0.8 -1\nv 1 1.1 1\nf 1 2 3\n";

static int make_files(void **state) {
    (void)state;
    recorded flight = recorded_tetrahedra(FRAMES);
    folder = temp_folder_make();
    model = recorded_write_mesh(&folder, "flight.obj", &flight, 0);
    cache = recorded_write_cache(&folder, "flight.pc2", &flight);
    quads = temp_file_write(&folder, "quads.obj", quads_text, sizeof quads_text - 1);
    post = temp_file_write(&folder, "post.obj", post_text, sizeof post_text - 1);
    json = temp_file_path(&folder, "out.json");
    xml = temp_file_path(&folder, "out.xml");
    recorded_free(&flight);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* The greatest value of a member over all frames of the flight. */
static double greatest_value(const char *member) {
    EXPECT_TOOL(0, "check", model.text, cache.text, "--json", json.text, "--quiet");
    json_node *root = json_node_read_file(json.text);
    const json_node *frames = json_node_member(root, "frames");
    double most = 0.0;
    for (size_t i = 0; i < frames->count; i++) {
        const double value = json_node_number(json_node_item(frames, i), member);
        if (value > most) most = value;
    }
    json_node_free(root);
    return most;
}

/* Triangles 0 and 1 are one face, through the second of which goes a pin: the face is one part. The pin and that triangle are
 * one pair, whichever of them a list names first. */
static void tables_and_lists_have_the_numbers_of_the_file(void **state) {
    (void)state;
    static const char text[] = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 3 -1\nv 1.1 3 -1\nv 1 3 1\n"
                               "f 1 2 3 4\nf 5 6 7\n",
                      parts[] = "face,name\n0,Sheet\n1,Pin\n", pairs[] = "1 2\n2 1\n";
    const temp_path pinned = temp_file_write(&folder, "pinned.obj", text, sizeof text - 1),
                    table = temp_file_write(&folder, "parts.csv", parts, sizeof parts - 1),
                    list = temp_file_write(&folder, "pairs.txt", pairs, sizeof pairs - 1);
    EXPECT_TOOL(3, "check", pinned.text, "--quiet", "--fail-on", "crossing", "--parts", table.text);
    EXPECT_TOOL(0, "check", pinned.text, "--quiet", "--fail-on", "crossing", "--parts", table.text,
                "--ignore-parts", "Sheet,Pin");
    tool_run run = RUN_TOOL("check", pinned.text, "--fail-on", "crossing", "--ignore", list.text);
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, " As asked, 1 pair of triangles was not looked at."));
    tool_run_free(&run);
}

/* As many as are allowed do not fail, and as deep as is allowed does not. */
static void bounds_are_allowed(void **state) {
    (void)state;
    const double faces = greatest_value("crossing_faces"), depth = greatest_value("depth");
    const struct {
        int code;
        const char *option;
        double value;
    } cases[] = {{0, "--max-faces", faces},
                 {3, "--max-faces", faces - 1.0},
                 {0, "--fail-depth", depth * 1.01},
                 {3, "--fail-depth", depth * (1.0 - 1e-12)}};
    assert_true(faces > 1.0 && depth > 0.0);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char value[40];
        snprintf(value, sizeof value, "%.17g", cases[i].value);
        EXPECT_TOOL(cases[i].code, "check", model.text, cache.text, "--quiet", cases[i].option, value);
        EXPECT_TOOL(cases[i].code, "replay", model.text, cache.text, "--quiet", cases[i].option, value);
    }
}

/* The contacts of intervals 3 and 5 count for the frames at their ends, and for no other. */
static void contacts_count_for_the_end_of_their_interval(void **state) {
    (void)state;
    EXPECT_TOOL(3, "replay", model.text, cache.text, "--quiet", "--no-check", "--fail-on", "contact",
                "--junit", xml.text);
    char *text = read_whole_file(xml.text, NULL);
    for (int frame = 0; frame < FRAMES; frame++) {
        char name[40];
        snprintf(name, sizeof name, "name=\"frame %d\"", frame);
        const char *line = strstr(text, name);
        assert_non_null(line);
        const bool failed = strncmp(strchr(line, '\n') - 2, "/>", 2) != 0;
        assert_int_equal(failed, frame == 4 || frame == 6);
    }
    free(text);
}

/* Triangles that only touch do not count for the share of those that cross. */
static void the_share_is_of_crossings(void **state) {
    (void)state;
    static const char text[] =
        "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 -1\nv 2 1 -1\nv 1 1 1\nf 4 5 6\n"
        "v 9 0 0\nv 13 0 0\nv 9 4 0\nf 7 8 9\nv 10 1 0\nv 11 1 1\nv 10 2 1\nf 10 11 12\n"
        "v 20 0 0\nv 21 0 0\nv 20 1 0\nf 13 14 15\n";
    temp_path path = temp_file_write(&folder, "share.obj", text, sizeof text - 1);
    EXPECT_TOOL(0, "check", path.text, "--json", json.text, "--quiet");
    json_node *root = json_node_read_file(json.text);
    const json_node *frame = json_node_item(json_node_member(root, "frames"), 0);
    assert_true(json_node_number(frame, "crossing_pairs") == 1.0);
    assert_true(json_node_number(frame, "touching_pairs") == 1.0);
    assert_true(json_node_number(frame, "crossing_faces") == 2.0);
    assert_true(json_node_number(frame, "crossing_share") == 2.0 / 5.0);
    json_node_free(root);
}

/* The place of an event is a triangle and a face as the object's own file numbers them, whatever comes before. */
static void places_are_of_the_files(void **state) {
    (void)state;
    char far[600], through[600], pierced[600];
    snprintf(far, sizeof far, "Far=%s", model.text);
    snprintf(through, sizeof through, "Post=%s", post.text);
    snprintf(pierced, sizeof pierced, "Quads=%s", quads.text);
    EXPECT_TOOL(0, "check", "--object", far, "--object", pierced, "--object", through, "--only", "Quads,Post",
                "--json", json.text, "--quiet");
    json_node *root = json_node_read_file(json.text);
    const json_node *events = json_node_member(root, "events"), *event = json_node_item(events, 0);
    assert_int_equal(events->count, 1);
    assert_string_equal(json_node_string(event, "object"), "Quads");
    assert_true(json_node_number(event, "triangle") == 2.0 || json_node_number(event, "triangle") == 3.0);
    assert_true(json_node_number(event, "face") == 1.0);
    json_node_free(root);
}

/* ---- depths of what is left out --------------------------------------------------------------------------- */

#define HEAD                                                                                                       \
    "v -10 -10 -10\nv 10 -10 -10\nv 10 10 -10\nv -10 10 -10\nv -10 -10 10\nv 10 -10 10\nv 10 10 10\nv -10 10 10\n" \
    "o Head\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"

/* Checks a model without the pairs of two parts: how deep its frame is, and which parts are the worst. */
static void check_depth(const char *text, const char *left_out, double depth, const char *worst) {
    const temp_path path = temp_file_write(&folder, "head.obj", text, strlen(text));
    EXPECT_TOOL(3, "check", path.text, "--quiet", "--ignore-parts", left_out, "--fail-depth", "0.01",
                "--json", json.text, "--junit", xml.text);
    json_node *root = json_node_read_file(json.text);
    const json_node *frame = json_node_item(json_node_member(root, "frames"), 0);
    assert_true(json_node_number(frame, "depth") == depth);
    json_node_free(root);
    char *lines = read_whole_file(xml.text, NULL);
    if (strstr(lines, worst) == NULL) fail_msg("'%s' is not in: %s", worst, lines);
    free(lines);
}

/* Two stones in a head, as deep as each other: the one that is left out is not the worst. */
static void equal_depths_are_told_apart(void **state) {
    (void)state;
    static const char stones[] =
        HEAD "v 4 0 0\nv 5 -1 -1\nv 5 1 -1\nv 5 0 1\no Left\nf 9 11 10\nf 9 12 11\nf 9 10 12\nf 10 11 12\n"
             "v -4 0 0\nv -5 -1 -1\nv -5 1 -1\nv -5 0 1\no Right\nf 13 14 15\nf 13 15 16\nf 13 16 14\n"
             "f 14 16 15\n";
    check_depth(stones, "Left,Head", 6.0, "worst: Head x Right");
    check_depth(stones, "Right,Head", 6.0, "worst: Head x Left");
}

/* A stone of two parts, which share the deepest vertices: these are left out with the one, and the surface of the other one
 * reaches them all the same. */
static void shared_depths_are_still_there(void **state) {
    (void)state;
    static const char stone[] =
        HEAD "v 5 0 0\nv 4 -1 -1\nv 4 1 -1\nv 4 0 1\no Side\nf 9 10 11\nf 9 11 12\nf 9 12 10\no Base\n"
             "f 10 12 11\n";
    check_depth(stone, "Base,Head", 6.0, "worst: Head x Side");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_are_allowed),
        cmocka_unit_test(tables_and_lists_have_the_numbers_of_the_file),
        cmocka_unit_test(contacts_count_for_the_end_of_their_interval),
        cmocka_unit_test(the_share_is_of_crossings),
        cmocka_unit_test(places_are_of_the_files),
        cmocka_unit_test(equal_depths_are_told_apart),
        cmocka_unit_test(shared_depths_are_still_there),
    };
    return cmocka_run_group_tests_name("tool_rules", tests, make_files, remove_files);
}
