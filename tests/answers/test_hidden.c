/* Parts that are hidden by a scale of 0 are named once, with their frames: sentence and JSON of check and replay. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static temp_path json;

static int make_folder(void **state) {
    (void)state;
    folder = temp_folder_make();
    json = temp_file_path(&folder, "out.json");
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    temp_folder_remove(&folder);
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

static void expect_in(const char *text, const char *part) {
    if (strstr(text, part) == NULL) fail_msg("expected '%s' in: %s", part, text);
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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(hidden_parts_are_named),
                                       cmocka_unit_test(a_single_mesh_names_no_frames),
                                       cmocka_unit_test(nothing_to_look_at_is_not_clean)};
    return cmocka_run_group_tests_name("hidden", tests, make_folder, remove_folder);
}
