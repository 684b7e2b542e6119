/* What was not looked at is said first, and nothing calls it clean: sentence, JSON, JUnit and exit code of check and replay. */
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_path json, xml;

static int make_folder(void **state) {
    own_folder_make(state);
    json = temp_file_path(&folder, "out.json");
    xml = temp_file_path(&folder, "out.xml");
    return 0;
}

static void write_box(FILE *file, uint32_t first, double x, double y, double z) {
    static const uint8_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 8; i++) fprintf(file, "v %g %g %g\n", x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
    for (int i = 0; i < 6; i++) {
        fputc('f', file);
        for (int k = 0; k < 4; k++) fprintf(file, " %u", first + quads[i][k] + 1);
        fputc('\n', file);
    }
}

/* Two boxes of side 1, so far apart along x; spoilt: what is wrong with the file. */
static temp_path write_boxes(const char *name, double gap, const char *spoilt) {
    temp_path path = temp_file_path(&folder, name);
    FILE *file = fopen(path.text, "w");
    assert_non_null(file);
    fputs("o A\n", file);
    write_box(file, 0, 0.0, 0.0, 0.0);
    fputs("o B\n", file);
    write_box(file, 8, 1.0 + gap, 0.25, 0.25);
    fputs(spoilt, file);
    assert_int_equal(fclose(file), 0);
    return path;
}

/* ---- a frame that cannot be read ------------------------------------------------------------------------- */

typedef struct bad_frame {
    const char *spoilt, *reason;
} bad_frame;

static const bad_frame bad_frames[] = {
    {"v 5 5 5\n", "holds 17 vertices, the model has 16 vertices"},
    {"f 1 2 3\n", "has other faces than"},
    {"v nan 0 0\n", "nan"},
    {"f 1 2 99\n", "99"},
};

static void expect_unfinished_json(const char *member, const char *reason, bool of_summary) {
    json_node *root = json_node_read_file(json.text);
    const json_node *place = of_summary ? json_node_member(root, member) : root;
    assert_false(json_node_boolean(place, "complete"));
    expect_in(json_node_string(place, "stopped_by"), reason);
    json_node_free(root);
}

static void expect_unfinished_junit(size_t tests, size_t failures, const char *reason) {
    char *text = read_whole_file(xml.text, NULL), counts[64];
    snprintf(counts, sizeof counts, "tests=\"%zu\" failures=\"%zu\" errors=\"1\"", tests, failures);
    expect_in(text, counts);
    expect_in(text, "name=\"all was looked at\" time=\"0\">\n      <error message=\"Not finished: frame ");
    expect_in(text, reason);
    free(text);
}

/* bad: which of four frames, from 1 on, cannot be read; crossing: which one crosses, 0: none. */
static void expect_unfinished(const char *command, const bad_frame *fault, uint32_t bad, uint32_t crossing) {
    temp_path paths[4];
    for (uint32_t i = 1; i <= 4; i++) {
        char name[32];
        snprintf(name, sizeof name, "f_%u.obj", i);
        paths[i - 1] = write_boxes(name, i == crossing ? -0.5 : 1.0 + i, i == bad ? fault->spoilt : "");
    }
    temp_path model = write_boxes("model.obj", 1.0, "");
    tool_run run = RUN_TOOL(command, model.text, paths[0].text, paths[1].text, paths[2].text, paths[3].text,
                            "--json", json.text, "--junit", xml.text);
    assert_int_equal(run.code, 1);
    const bool crosses = crossing > 0 && crossing < bad;
    char first[64], counted[64];
    snprintf(first, sizeof first, "Not finished: frame %u could not be read: ", bad);
    snprintf(counted, sizeof counted, ". %u of 4 frames checked%s", bad - 1,
             bad == 1 || crosses ? "." : ", clean so far.\n");
    expect_start(run.out, first);
    char *end = strchr(run.out, '\n');
    assert_non_null(end);
    end[bad == 1 || crosses ? 0 : 1] = '\0';
    expect_in(run.out, fault->reason);
    expect_in(run.out, counted);
    if (crosses) expect_in(run.out, ". Frame ");
    assert_null(strstr(run.out, "Clean"));
    expect_in(run.error, fault->reason);
    expect_unfinished_json("summary", fault->reason, strcmp(command, "replay") == 0);
    expect_unfinished_junit(bad, crosses, fault->reason);
    tool_run_free(&run);
    run = RUN_TOOL(command, model.text, paths[0].text, paths[1].text, paths[2].text, paths[3].text,
                   "--fail-on", "crossing"); /* what fails, fails, whatever could not be read */
    assert_int_equal(run.code, crosses ? 3 : 1);
    expect_in(run.error, fault->reason);
    if (crosses) expect_in(run.error, "failed: ");
    tool_run_free(&run);
}

static void a_frame_that_cannot_be_read_comes_first(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof bad_frames / sizeof *bad_frames; i++) {
        expect_unfinished("check", &bad_frames[i], (uint32_t)(2 + i % 3), 0);
        expect_unfinished("replay", &bad_frames[i], (uint32_t)(2 + (i + 1) % 3), 0);
    }
    expect_unfinished("check", &bad_frames[0], 1, 0);
    expect_unfinished("replay", &bad_frames[0], 1, 0);
    expect_unfinished("check", &bad_frames[0], 4, 2);
    expect_unfinished("replay", &bad_frames[0], 3, 1);
    expect_unfinished("check", &bad_frames[0], 2, 3);
}

/* Patterns that no shell has filled in, and what other programs call the number of a frame, come with what to do. */
static void a_pattern_of_nothing_has_a_hint(void **state) {
    (void)state;
    static const struct {
        const char *name, *hint;
    } names[] = {{"frame-*.obj", "no file matches it"},     {"frame-?.obj", "no file matches it"},
                 {"frame-[0-9].obj", "no file matches it"}, {"frame-####.obj", "is written %04d"},
                 {"frame-$F4.obj", "is written %04d"},      {"frame-<UDIM>.obj", "is written %04d"}};
    const temp_path model = write_boxes("m_1.obj", 1.0, "");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const temp_path path = temp_file_path(&folder, names[i].name);
        const char *const *texts = TEXTS(names[i].name, "cannot open", names[i].hint, "frame_%04d.obj");
        EXPECT_ERROR(1, texts, "check", model.text, path.text);
        EXPECT_ERROR(1, texts, "replay", model.text, path.text, model.text);
        EXPECT_ERROR(1, texts, "check", path.text);
    }
    tool_run run = RUN_TOOL("check", model.text, "none.obj");
    assert_null(strstr(run.error, "%04d"));
    tool_run_free(&run);
}

/* What the range leaves out may be as bad as it likes: the sentence says which frames it was. */
static void a_range_is_complete_and_named(void **state) {
    (void)state;
    temp_path model = write_boxes("f_1.obj", 1.0, ""), second = write_boxes("f_2.obj", 1.5, ""),
              third = write_boxes("f_3.obj", 2.0, ""), bad = write_boxes("f_4.obj", 2.0, "v 1 2 3\n");
    static const struct {
        const char *range, *sentence;
    } cases[] = {
        {"2:3", "No frame crosses or touches (2 checked). Only frames 2 to 3 of 1 to 4 were looked at.\n"},
        {":2", "No frame crosses or touches (2 checked). Only frames 1 to 2 of 1 to 4 were looked at.\n"},
        {"2", "Clean: no two triangles cross or touch. Only frame 2 of 1 to 4 was looked at.\n"},
        {"1:3:2",
         "No frame crosses or touches (2 checked). Only frames 1 to 3, in steps of 2, of 1 to 4 were looked at.\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tool_run run = RUN_TOOL("check", model.text, second.text, third.text, bad.text, "--frames",
                                cases[i].range, "--json", json.text);
        assert_int_equal(run.code, 0);
        assert_string_equal(run.out, cases[i].sentence);
        json_node *root = json_node_read_file(json.text);
        assert_true(json_node_boolean(root, "complete"));
        json_node_free(root);
        tool_run_free(&run);
    }
    tool_run run = RUN_TOOL("replay", model.text, second.text, third.text, bad.text, "--frames", "1:3");
    assert_int_equal(run.code, 0);
    expect_start(run.out,
                 "No frame crosses or touches (3 checked). Only frames 1 to 3 of 1 to 4 were looked at.\n");
    tool_run_free(&run);
    run = RUN_TOOL("check", model.text, second.text, third.text, bad.text, "--frames", "3:4");
    assert_int_equal(run.code, 1);
    expect_start(run.out, "Not finished: frame 4 could not be read: ");
    expect_in(run.out, " 1 of 2 frames checked, clean so far.\n");
    tool_run_free(&run);
}

/* ---- what members of JSON mean --------------------------------------------------------------------------- */

/* Boxes that cross, touch, are the same, lie in each other, or do nothing of all this. */
static void crossing_means_crossing(void **state) {
    (void)state;
    static const struct {
        const char *text;
        bool crossing, clean;
    } cases[] = {
        {"v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 -1\nv 2 1 1\nv 1 2 1\nf 4 5 6\n", true, false},
        {"v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 0\nv 2 1 1\nv 1 2 1\nf 4 5 6\n", false, false},
        {"v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 0.5\nv 2 1 1\nv 1 2 1\nf 4 5 6\n", false, true},
        {"v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nf 2 3 1\n", false, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        temp_path path = temp_file_path(&folder, "kind.obj");
        FILE *file = fopen(path.text, "w");
        assert_non_null(file);
        fputs(cases[i].text, file);
        assert_int_equal(fclose(file), 0);
        EXPECT_TOOL(0, "check", path.text, "--json", json.text);
        json_node *root = json_node_read_file(json.text);
        const json_node *frame = json_node_item(json_node_member(root, "frames"), 0);
        assert_int_equal(json_node_boolean(frame, "crossing"), cases[i].crossing);
        assert_int_equal(json_node_boolean(frame, "clean"), cases[i].clean);
        json_node_free(root);
        EXPECT_TOOL(0, "replay", path.text, path.text, path.text, "--json", json.text);
        root = json_node_read_file(json.text);
        const json_node *summary = json_node_member(root, "summary");
        assert_int_equal(json_node_number(summary, "frames_crossing"), cases[i].crossing ? 2 : 0);
        assert_int_equal(json_node_number(summary, "frames_touching"), i == 1 ? 2 : 0);
        json_node_free(root);
    }
}

static void what_lies_inside_is_not_clean(void **state) {
    (void)state;
    temp_path path = temp_file_path(&folder, "inside.obj");
    FILE *file = fopen(path.text, "w");
    assert_non_null(file);
    write_box(file, 0, 0.0, 0.0, 0.0);
    for (int i = 0; i < 8; i++)
        fprintf(file, "v %g %g %g\n", 0.25 + 0.5 * (i & 1), 0.25 + 0.5 * (i >> 1 & 1), 0.25 + 0.5 * (i >> 2));
    fputs("f 9 11 12 10\nf 13 14 16 15\nf 9 10 14 13\nf 11 15 16 12\nf 9 13 15 11\nf 10 12 16 14\n", file);
    assert_int_equal(fclose(file), 0);
    EXPECT_TOOL(0, "check", path.text, "--json", json.text);
    json_node *root = json_node_read_file(json.text);
    const json_node *frame = json_node_item(json_node_member(root, "frames"), 0);
    assert_false(json_node_boolean(frame, "crossing"));
    assert_false(json_node_boolean(frame, "clean"));
    assert_true(json_node_number(frame, "depth") == 0.25);
    json_node_free(root);
    /* Who does not look says so, and no rule passes it. */
    static const char *const unknown[] = {"clean", "depth", "overlapping_parts", "inside_parts",
                                          "same_solids"};
    tool_run run = RUN_TOOL("check", path.text, "--no-depths", "--json", json.text);
    assert_int_equal(run.code, 0);
    expect_start(run.out, "Clean: no two triangles cross or touch. What lies inside was not looked at.\n");
    tool_run_free(&run);
    root = json_node_read_file(json.text);
    frame = json_node_item(json_node_member(root, "frames"), 0);
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++)
        assert_int_equal(json_node_member(frame, unknown[i])->kind, JSON_NULL);
    json_node_free(root);
    for (int replays = 0; replays < 2; replays++) {
        const char *command = replays ? "replay" : "check",
                   *left_out = replays ? "--no-check" : "--no-depths";
        EXPECT_ERROR(2, TEXTS("--fail-on", "--no-depths"), command, path.text, path.text, "--no-depths",
                     "--fail-on", "crossing");
        EXPECT_ERROR(2, TEXTS("--fail-depth", "--no-depths"), command, path.text, path.text, "--no-depths",
                     "--fail-depth", "0.1");
        EXPECT_ERROR(2, TEXTS(left_out), command, path.text, path.text, left_out, "--fail-on", "touching");
    }
    EXPECT_ERROR(2, TEXTS("--no-depths"), "check", "--each", path.text, "--no-depths", "--fail-on",
                 "crossing");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_that_cannot_be_read_comes_first),
        cmocka_unit_test(a_pattern_of_nothing_has_a_hint),
        cmocka_unit_test(a_range_is_complete_and_named),
        cmocka_unit_test(crossing_means_crossing),
        cmocka_unit_test(what_lies_inside_is_not_clean),
    };
    return cmocka_run_group_tests_name("unfinished", tests, make_folder, own_folder_remove);
}
