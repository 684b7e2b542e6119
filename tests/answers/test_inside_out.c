/* Parts that are inside out: their depths are those of the parts turned around, and what was turned is named. */
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static temp_path json;

static int make_folder(void **state) {
    own_folder_make(state);
    json = temp_file_path(&folder, "out.json");
    return 0;
}

/* A cube from a corner; its first index is one more than `before`. name: of the part; NULL: none. */
typedef struct cube {
    const char *name;
    double corner, size;
    bool inverted;
} cube;

static void write_cube(FILE *file, const cube *c, double scale, int before) {
    static const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    if (c->name != NULL) fprintf(file, "o %s\n", c->name);
    for (int v = 0; v < 8; v++)
        fprintf(file, "v %.17g %.17g %.17g\n", scale * (c->corner + (v & 1) * c->size),
                c->corner + (v >> 1 & 1) * c->size, c->corner + (v >> 2 & 1) * c->size);
    for (int i = 0; i < 6; i++) {
        fprintf(file, "f");
        for (int k = 0; k < 4; k++) fprintf(file, " %d", before + 1 + quads[i][c->inverted ? 3 - k : k]);
        fprintf(file, "\n");
    }
}

/* The first one is scaled along x. */
static temp_path write_cubes(const char *name, const cube *cubes, int count, double scale) {
    temp_path path = temp_file_path(&folder, name);
    FILE *file = fopen(path.text, "w");
    for (int i = 0; i < count; i++) write_cube(file, &cubes[i], i == 0 ? scale : 1.0, 8 * i);
    fclose(file);
    return path;
}

/* The depth of the first frame in the JSON file, and what it says is inside out: a bit for each component. */
static double read_depth(int *turned) {
    json_node *root = json_node_read_file(json.text);
    double depth = json_node_number(json_node_item(json_node_member(root, "frames"), 0), "depth");
    const json_node *list = json_node_member(root, "inside_out");
    *turned = 0;
    for (size_t i = 0; i < list->count; i++)
        *turned |= 1 << (int)json_node_number(json_node_item(list, i), "component");
    json_node_free(root);
    return depth;
}

static void expect_depth(const char *model, const char *option, const char *value, double depth, int turned) {
    int found;
    EXPECT_TOOL(0, "check", model, "--quiet", "--json", json.text, option, value);
    assert_true(fabs(read_depth(&found) - depth) < 1e-12);
    assert_int_equal(found, turned);
}

static void cubes_have_one_depth(void **state) {
    (void)state;
    static const struct { double corner, size, depth; } seconds[] = {{0.5, 1, 0.5}, {0.25, 0.5, 0.25}};
    for (int i = 0; i < 2; i++) {
        for (int inverted = 0; inverted < 4; inverted++) {
            const cube both[2] = {{"box", 0, 1, (inverted & 1) != 0},
                                  {"crate", seconds[i].corner, seconds[i].size, (inverted & 2) != 0}};
            temp_path one_file = write_cubes("both.obj", both, 2, 1.0);
            temp_path first = write_cubes("box.obj", &both[0], 1, 1.0);
            temp_path second = write_cubes("crate.obj", &both[1], 1, 1.0);
            char object[600];
            snprintf(object, sizeof object, "second=%s", second.text);
            expect_depth(one_file.text, NULL, NULL, seconds[i].depth, inverted);
            expect_depth(first.text, "--object", object, seconds[i].depth, inverted);
            EXPECT_TOOL(3, "check", one_file.text, "--quiet", "--fail-depth", "0.1");
        }
    }
}

static void the_orientation_may_be_kept(void **state) {
    (void)state;
    const cube both[2] = {{"box", 0, 1, true}, {"crate", 0.5, 1, true}};
    temp_path model = write_cubes("kept.obj", both, 2, 1.0);
    expect_depth(model.text, "--orientation", "as-given", 0.0, 0);
    expect_depth(model.text, "--orientation", "found", 0.5, 3);
    EXPECT_TOOL(3, "check", "--each", model.text, "--quiet", "--fail-depth", "0.4");
    EXPECT_TOOL(0, "check", "--each", model.text, "--quiet", "--fail-depth", "0.4", "--orientation",
                "as-given");
    EXPECT_ERROR(2, TEXTS("--orientation cannot be 'outwards'"), "check", model.text, "--orientation",
                 "outwards");
}

/* Without names, shells belong together: a hollow cube is one whichever way round. With names, they are bodies. */
static void a_cavity_stays_one(void **state) {
    (void)state;
    for (int inverted = 0; inverted < 4; inverted++) {
        const bool hollow = inverted == 1 || inverted == 2, turned = (inverted & 1) != 0;
        cube shells[2] = {{NULL, 0, 1, turned}, {NULL, 0.25, 0.5, (inverted & 2) != 0}};
        temp_path plain = write_cubes("hollow.obj", shells, 2, 1.0);
        expect_depth(plain.text, NULL, NULL, hollow ? 0.0 : 0.25, turned ? 3 : 0);
        shells[0].name = shells[1].name = "one";
        temp_path one = write_cubes("one.obj", shells, 2, 1.0);
        expect_depth(one.text, NULL, NULL, hollow ? 0.0 : 0.25, turned ? 3 : 0);
        shells[1].name = "two";
        temp_path two = write_cubes("two.obj", shells, 2, 1.0);
        expect_depth(two.text, NULL, NULL, 0.25, inverted);
    }
}

static void expect_note(const char *model, const char *frames, const char *note) {
    tool_run run = RUN_TOOL("check", model, frames);
    if (strstr(run.error, note) == NULL) fail_msg("expected '%s' in: %s", note, run.error);
    tool_run_free(&run);
}

static void what_was_turned_is_named(void **state) {
    (void)state;
    cube all[4] = {{"wheel", 0, 1, true}, {"hub", 3, 1, false}, {"tyre", 6, 1, false}, {"nut", 9, 1, false}};
    expect_note(write_cubes("wheel.obj", all, 4, 1.0).text, NULL,
                "part wheel is inside out; it was taken as turned around\n");
    all[2].inverted = true;
    expect_note(write_cubes("two.obj", all, 4, 1.0).text, NULL,
                "part wheel and part tyre are inside out; they were taken as turned around\n");
    all[1].inverted = all[3].inverted = true;
    expect_note(
        write_cubes("four.obj", all, 4, 1.0).text, NULL,
        "part wheel, part hub, part tyre and 1 more are inside out; they were taken as turned around\n");
    all[2].name = all[3].name = "hub";
    all[2].inverted = all[3].inverted = all[0].inverted = false;
    expect_note(write_cubes("some.obj", all, 4, 1.0).text, NULL,
                "1 of 3 components of part hub is inside out; it was taken as turned around\n");
}

/* A scale from 1 to -0.8 in five frames. */
static void frames_are_turned_by_themselves(void **state) {
    (void)state;
    const cube both[2] = {{"card", -0.5, 1, false}, {"post", -0.25, 0.5, false}};
    temp_path frames = temp_file_path(&folder, "flip_%d.obj");
    char name[32];
    for (int k = 0; k < 5; k++) {
        snprintf(name, sizeof name, "flip_%d.obj", k);
        write_cubes(name, both, 2, 1.0 - 0.45 * k);
    }
    temp_path model = temp_file_path(&folder, "flip_0.obj");
    expect_note(model.text, frames.text,
                "part card is inside out in 2 frames, from 3 to 4; it was taken as turned");
    EXPECT_TOOL(0, "check", model.text, frames.text, "--quiet", "--json", json.text);
    json_node *root = json_node_read_file(json.text);
    for (size_t k = 0; k < 5; k++) {
        double depth = json_node_number(json_node_item(json_node_member(root, "frames"), k), "depth");
        assert_true(depth > 0.0);
    }
    json_node_free(root);
}

/* From shards it is told as from one run. */
static void shards_tell_it_too(void **state) {
    (void)state;
    temp_path model = temp_file_path(&folder, "flip_0.obj"), frames = temp_file_path(&folder, "flip_%d.obj");
    temp_path halves[2] = {temp_file_path(&folder, "1.shard"), temp_file_path(&folder, "2.shard")};
    EXPECT_TOOL(0, "replay", model.text, frames.text, "--quiet", "--shard", "1/2", "--results",
                halves[0].text);
    EXPECT_TOOL(0, "replay", model.text, frames.text, "--quiet", "--shard", "2/2", "--results",
                halves[1].text);
    EXPECT_TOOL(0, "merge", halves[0].text, halves[1].text, "--json", json.text);
    json_node *root = json_node_read_file(json.text);
    const json_node *list = json_node_member(root, "inside_out");
    assert_int_equal(list->count, 1);
    const json_node *card = json_node_item(list, 0);
    assert_true(json_node_number(card, "frames") == 2.0 && json_node_number(card, "first") == 3.0 &&
                json_node_number(card, "last") == 4.0);
    json_node_free(root);
}

static void info_says_it_of_each_component(void **state) {
    (void)state;
    const cube both[2] = {{"box", 0, 1, true}, {"crate", 0.25, 0.5, false}};
    temp_path model = write_cubes("info.obj", both, 2, 1.0);
    tool_run run = RUN_TOOL("info", model.text, "--json", json.text);
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "  0    8 vertices, 18 edges, 12 triangles, Euler characteristic 2, "
                                    "closed, genus 0, inside out\n"));
    assert_non_null(strstr(run.out, "  1    8 vertices, 18 edges, 12 triangles, Euler characteristic 2, "
                                    "closed, genus 0\n"));
    tool_run_free(&run);
    json_node *root = json_node_read_file(json.text);
    const json_node *components = json_node_member(root, "components");
    assert_true(json_node_member(json_node_item(components, 0), "inside_out")->boolean);
    assert_false(json_node_member(json_node_item(components, 1), "inside_out")->boolean);
    json_node_free(root);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_have_one_depth),
        cmocka_unit_test(the_orientation_may_be_kept),
        cmocka_unit_test(a_cavity_stays_one),
        cmocka_unit_test(what_was_turned_is_named),
        cmocka_unit_test(frames_are_turned_by_themselves),
        cmocka_unit_test(shards_tell_it_too),
        cmocka_unit_test(info_says_it_of_each_component),
    };
    return cmocka_run_group_tests(tests, make_folder, own_folder_remove);
}
