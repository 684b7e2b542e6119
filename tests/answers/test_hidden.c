/* Parts that are hidden by a scale of 0 are named once, with their frames: sentence and JSON of check and replay. */
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_path json;

static int make_folder(void **state) {
    own_folder_make(state);
    json = temp_file_path(&folder, "out.json");
    return 0;
}

/* A box of this size; along y it may be squashed. */
static void write_box(FILE *file, uint32_t first, double x, double size, double flatness) {
    static const uint8_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 8; i++)
        fprintf(file, "v %g %g %g\n", x + size * (i & 1), first * 0.03125 + size * flatness * (i >> 1 & 1),
                first * 0.03125 + size * flatness * (i >> 2));
    for (int i = 0; i < 6; i++) {
        fputc('f', file);
        for (int k = 0; k < 4; k++) fprintf(file, " %u", first + quads[i][k] + 1u);
        fputc('\n', file);
    }
}

/* "Puff", of this size, or of a line if it is below 0, at 0; and "Rock", so far away, or without a size. */
static temp_path write_scene(const char *name, double size, double rock) {
    temp_path path = temp_file_path(&folder, name);
    FILE *file = fopen(path.text, "w");
    assert_non_null(file);
    fputs("o Puff\n", file);
    write_box(file, 0, 0.0, size < 0.0 ? 1.0 : size, size < 0.0 ? 0.0 : 1.0);
    fputs("o Rock\n", file);
    write_box(file, 8, rock, rock == 0.0 ? 0.0 : 1.0, 1.0);
    assert_int_equal(fclose(file), 0);
    return path;
}

static void expect_spans(const json_node *item, const char *name, const int *numbers, uint32_t count) {
    const json_node *spans = json_node_member(item, name);
    assert_int_equal(spans->count, count);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 2; k++)
            assert_int_equal((int)json_node_item(json_node_item(spans, i), k)->number, numbers[2 * i + k]);
}

/* Hidden in frames 2, 3 and 5, where it becomes a line; the last frame crosses. */
static void hidden_parts_are_named(void **state) {
    (void)state;
    static const double sizes[] = {1.0, 0.0, 0.0, 1.0, -1.0, 1.0};
    static const char *const commands[] = {"check", "replay"};
    temp_path model = write_scene("model.obj", 1.0, 5.0), paths[6];
    for (int i = 0; i < 6; i++) {
        char name[32];
        snprintf(name, sizeof name, "f_%d.obj", i + 1);
        paths[i] = write_scene(name, sizes[i], i == 5 ? 0.5 : 5.0);
    }
    for (int k = 0; k < 2; k++) {
        tool_run run = RUN_TOOL(commands[k], model.text, paths[0].text, paths[1].text, paths[2].text,
                                paths[3].text, paths[4].text, paths[5].text, "--json", json.text);
        assert_int_equal(run.code, 0);
        expect_in(run.out, "Frame 6 crosses (1 of 6)");
        expect_in(run.out,
                  " Puff has no surface in frames 2 to 3, 5 (all its triangles have no area), and was not "
                  "looked at there.\n");
        assert_null(strstr(run.out, "may be missing"));
        json_node *root = json_node_read_file(json.text);
        const json_node *collapsed = json_node_member(root, "collapsed");
        assert_int_equal(collapsed->count, 1);
        assert_string_equal(json_node_string(json_node_item(collapsed, 0), "part"), "Puff");
        expect_spans(json_node_item(collapsed, 0), "whole", (int[]){2, 3, 5, 5}, 2);
        expect_spans(json_node_item(collapsed, 0), "partly", NULL, 0);
        json_node_free(root);
        tool_run_free(&run);
    }
}

/* In a single mesh there are no frames to name. */
static void a_single_mesh_names_no_frames(void **state) {
    (void)state;
    temp_path model = write_scene("single.obj", 0.0, 5.0);
    tool_run run = RUN_TOOL("check", model.text);
    expect_in(run.out,
              "Clean: no two triangles cross or touch. Puff has no surface (all its triangles have no area), "
              "and was not looked at.\n");
    tool_run_free(&run);
}

/* A part of which one piece alone has no surface. */
static void pieces_without_a_surface_are_named(void **state) {
    (void)state;
    temp_path model = temp_file_path(&folder, "pieces.obj");
    FILE *file = fopen(model.text, "w");
    assert_non_null(file);
    fputs("o Puff\n", file);
    write_box(file, 0, 0.0, 1.0, 1.0);
    write_box(file, 8, 3.0, 0.0, 1.0);
    fputs("o Rock\n", file);
    write_box(file, 16, 6.0, 1.0, 1.0);
    assert_int_equal(fclose(file), 0);
    tool_run run = RUN_TOOL("check", model.text, "--json", json.text);
    expect_in(run.out,
              "cross or touch. Some pieces of Puff have no surface (all their triangles have no area), "
              "and were not looked at.\n");
    tool_run_free(&run);
    json_node *root = json_node_read_file(json.text);
    const json_node *collapsed = json_node_member(root, "collapsed");
    assert_int_equal(collapsed->count, 1);
    expect_spans(json_node_item(collapsed, 0), "whole", NULL, 0);
    expect_spans(json_node_item(collapsed, 0), "partly", (int[]){0, 0}, 1);
    json_node_free(root);
}

/* A mesh without any area is not clean: nothing was looked at. */
static void nothing_to_look_at_is_not_clean(void **state) {
    (void)state;
    temp_path model = write_scene("zeros.obj", 0.0, 0.0);
    tool_run run = RUN_TOOL("check", model.text, "--json", json.text);
    assert_int_equal(strncmp(run.out, "No triangle has an area.", 24), 0);
    assert_null(strstr(run.out, "Clean"));
    json_node *root = json_node_read_file(json.text);
    assert_false(json_node_boolean(json_node_item(json_node_member(root, "frames"), 0), "clean"));
    json_node_free(root);
    tool_run_free(&run);
}

/* ---- frames in which nothing has a surface ------------------------------------------------------------- */

/* Frames "g_1.obj" to "g_4.obj": all is there, then nothing, then only the rock, then all, which crosses if that is asked for. */
static void write_frames(temp_path paths[4], bool crossing) {
    static const double sizes[] = {1.0, 0.0, 0.0, 1.0}, rocks[] = {5.0, 0.0, 5.0, 5.0};
    for (int i = 0; i < 4; i++) {
        char name[32];
        snprintf(name, sizeof name, "g_%d.obj", i + 1);
        paths[i] = write_scene(name, sizes[i], i == 3 && crossing ? 0.5 : rocks[i]);
    }
}

static char *read_junit(void) {
    return read_whole_file(temp_file_path(&folder, "junit.xml").text, NULL);
}

/* A gate cannot pass such a frame: the exit code is 1, unless another frame fails. JUnit has an error there. */
static void a_gate_passes_nothing_unseen(void **state) {
    (void)state;
    static const char *const commands[] = {"check", "replay"}, *const gates[][2] = {
                                                                   {"--fail-on", "crossing"},
                                                                   {"--fail-on", "touching"},
                                                                   {"--fail-depth", "1000"},
                                                                   {"--max-faces", "99"},
                                                                   {"--quiet", "--no-depths"}};
    temp_path paths[4], junit = temp_file_path(&folder, "junit.xml");
    for (int k = 0; k < 20; k++) {
        const bool crossing = k >= 10, replays = k % 2 == 1;
        const int gate = k / 2 % 5;
        write_frames(paths, crossing);
        tool_run run = RUN_TOOL(commands[replays], paths[0].text, paths[0].text, paths[1].text, paths[2].text,
                                paths[3].text, gates[gate][0], gates[gate][1], "--junit", junit.text,
                                "--json", json.text);
        const bool fails = crossing && gate < 2;
        assert_int_equal(run.code, gate == 4 ? 0 : fails ? 3 : 1);
        if (run.code == 1)
            expect_in(
                run.error,
                "not decided: in 1 of 4 frames, the first is frame 2, no triangle has an area, so there was "
                "nothing to look at; --frames leaves frames out");
        if (run.code == 0) assert_null(strstr(run.error, "not decided"));
        char *xml = read_junit();
        expect_in(xml, crossing && (fails || gate == 4) ? "tests=\"4\" failures=\"1\" errors=\"1\""
                                                        : "tests=\"4\" failures=\"0\" errors=\"1\"");
        expect_in(strstr(xml, "name=\"frame 2\""), "<error message=\"no triangle has an area");
        free(xml);
        tool_run_free(&run);
    }
}

/* The sentence says it, the frame is no clean one and was not checked, and nothing hidden beside it is passed over. */
static void an_empty_frame_is_not_checked(void **state) {
    (void)state;
    temp_path paths[4];
    write_frames(paths, false);
    for (int replays = 0; replays < 2; replays++) {
        tool_run run = RUN_TOOL(replays ? "replay" : "check", paths[0].text, paths[0].text, paths[1].text,
                                paths[2].text, paths[3].text, "--timings", "--json", json.text);
        assert_int_equal(run.code, 0);
        expect_in(
            run.out,
            "No frame crosses or touches (3 checked). No triangle has an area in frame 2, which was not looked "
            "at. Puff has no surface in frames 2 to 3 (all its triangles have no area), and was not looked at "
            "there.\n");
        expect_in(run.out, "3 of 3 frames are clean");
        json_node *root = json_node_read_file(json.text);
        const json_node *frames = json_node_member(root, "frames"),
                        *collapsed = json_node_member(root, "collapsed");
        for (uint32_t i = 0; i < 4; i++)
            assert_int_equal(json_node_boolean(json_node_item(frames, i), "clean"), i != 1);
        assert_int_equal(collapsed->count, 2);
        expect_spans(json_node_item(collapsed, 1), "whole", (int[]){2, 2}, 1);
        if (replays) {
            const json_node *sums = json_node_member(root, "summary");
            assert_int_equal((int)json_node_number(sums, "frames_checked"), 3);
            assert_int_equal((int)json_node_number(sums, "clean"), 2);
            assert_int_equal((int)json_node_number(sums, "unknown"), 1);
        }
        json_node_free(root);
        tool_run_free(&run);
    }
}

/* Of many files, one without a surface is no clean one, with a gate or without. */
static void meshes_without_a_surface_fail(void **state) {
    (void)state;
    temp_path nothing = write_scene("nothing.obj", 0.0, 0.0), hidden = write_scene("hidden.obj", 0.0, 5.0),
              crossing = write_scene("crossing.obj", 1.0, 0.5);
    tool_run run = RUN_TOOL("check", "--each", nothing.text, hidden.text, crossing.text);
    assert_int_equal(run.code, 1);
    expect_in(run.out, "nothing.obj: No triangle has an area.\n");
    expect_in(run.out, "hidden.obj: Clean: no two triangles cross or touch.");
    expect_in(run.out, "3 meshes: 1 clean, 1 with intersections, 1 failed\n");
    tool_run_free(&run);
}

/* A list of recordings: a frame without a surface, and another one that crosses or not. */
static void recordings_with_an_empty_frame(void **state) {
    (void)state;
    static const char *const results[] = {"failed", "failed", "crossing", "crossing"};
    temp_path paths[4], list = temp_file_path(&folder, "list.jsonl"),
                        lines = temp_file_path(&folder, "lines.jsonl");
    for (int k = 0; k < 4; k++) {
        write_frames(paths, k >= 2);
        FILE *file = fopen(list.text, "w");
        assert_non_null(file);
        fprintf(file, "{\"name\": \"g\", \"model\": \"%s\", \"frames\": \"%s/g_%%d.obj\"}\n", paths[0].text,
                folder.path);
        assert_int_equal(fclose(file), 0);
        remove(lines.text);
        tool_run run = k % 2 == 0 ? RUN_TOOL("check", "--list", list.text, "--results", lines.text)
                                  : RUN_TOOL("check", "--list", list.text, "--results", lines.text,
                                             "--fail-on", "crossing");
        assert_int_equal(run.code, k < 2 ? 1 : k == 3 ? 3 : 0);
        json_node *line = json_node_read_file(lines.text);
        assert_string_equal(json_node_string(line, "result"), results[k]);
        if (k < 2)
            expect_in(json_node_string(line, "error"),
                      "No triangle has an area in frame 2, which was not looked at.");
        json_node_free(line);
        tool_run_free(&run);
    }
}

/* What appears out of a point and crosses itself there is no contact that was lost. */
static void what_appears_has_lost_no_contact(void **state) {
    (void)state;
    temp_path paths[3];
    for (int i = 0; i < 3; i++) {
        char name[32];
        snprintf(name, sizeof name, "a_%d.obj", i + 1);
        paths[i] = temp_file_path(&folder, name);
        FILE *file = fopen(paths[i].text, "w");
        assert_non_null(file);
        fputs("o Rock\n", file);
        write_box(file, 0, 9.0, 1.0, 1.0);
        fputs("o Knot\n", file);
        static const int turns[4][2] = {{0, 0}, {2, 2}, {2, 0}, {0, 2}};
        for (int k = 0; k < 8; k++)
            fprintf(file, "v %d %d %d\n", turns[k / 2][0] * (i == 1), turns[k / 2][1] * (i == 1),
                    k % 2 * (i == 1));
        for (int k = 9; k < 15; k += 2)
            fprintf(file, "f %d %d %d\nf %d %d %d\n", k, k + 2, k + 3, k, k + 3, k + 1);
        assert_int_equal(fclose(file), 0);
    }
    tool_run run =
        RUN_TOOL("replay", paths[1].text, paths[0].text, paths[1].text, paths[2].text, "--json", json.text);
    expect_in(run.out, "Frame 2 crosses (1 of 3).");
    assert_null(strstr(run.error, "was lost"));
    json_node *root = json_node_read_file(json.text);
    assert_int_equal((int)json_node_number(json_node_member(root, "summary"), "contradictions"), 0);
    json_node_free(root);
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(hidden_parts_are_named),
                                       cmocka_unit_test(a_single_mesh_names_no_frames),
                                       cmocka_unit_test(pieces_without_a_surface_are_named),
                                       cmocka_unit_test(nothing_to_look_at_is_not_clean),
                                       cmocka_unit_test(a_gate_passes_nothing_unseen),
                                       cmocka_unit_test(an_empty_frame_is_not_checked),
                                       cmocka_unit_test(meshes_without_a_surface_fail),
                                       cmocka_unit_test(recordings_with_an_empty_frame),
                                       cmocka_unit_test(what_appears_has_lost_no_contact)};
    return cmocka_run_group_tests_name("hidden", tests, make_folder, own_folder_remove);
}
