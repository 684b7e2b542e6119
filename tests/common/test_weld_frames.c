/* Welding joins what lies together in all frames, and the tool says where open edges all but lie on each other. */
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void expect_text(const char *text, const char *part, bool there) {
    if ((strstr(text, part) != NULL) != there)
        fail_msg("%s '%s' in: %s", there ? "expected" : "found", part, text);
}

/* ---- vertices that part ------------------------------------------------------------------------------------ */

/* A cube whose sides have vertices of their own, one of which leaves its corner in frame 2. */
static void vertices_that_part_stay_apart(void **state) {
    recorded parting = recorded_cube(true);
    (void)state;
    parting.frames[(2 * 28 + 5) * 3 + 1] += 0.25;
    const temp_path model = recorded_write_mesh(&folder, "split.obj", &parting, 0);
    for (int mdd = 0; mdd < 2; mdd++) {
        const temp_path cache = recorded_write_cache(&folder, mdd ? "parting.mdd" : "parting.pc2", &parting);
        tool_run run = RUN_TOOL("replay", model.text, cache.text, "--weld", "exact");
        assert_int_equal(run.code, 0);
        expect_text(run.error,
                    "1 vertex lies on others in the first frame alone, as where something is hidden", true);
        expect_text(run.error, "stays apart in all, as they should (the first is vertex ", true);
        expect_text(run.error, "in frame 2)", true);
        tool_run_free(&run);
        /* Within a quarter they are joined in all frames. */
        run = RUN_TOOL("replay", model.text, cache.text, "--weld", "0.25");
        assert_int_equal(run.code, 0);
        expect_text(run.error, "come apart", false);
        tool_run_free(&run);
    }
    recorded_free(&parting);
}

/* Frames in files of their own are read once. */
static void in_a_series_they_are_an_error(void **state) {
    recorded parting = recorded_cube(true);
    (void)state;
    parting.frames[(2 * 28 + 5) * 3 + 1] += 0.25;
    const temp_path pattern = recorded_write_sequence(&folder, "f_%d.obj", &parting);
    const temp_path model = temp_file_path(&folder, "f_0.obj"), summary = temp_file_path(&folder, "out.json");
    EXPECT_ERROR(1, TEXTS("frame 2", "0.25", "welded"), "replay", model.text, pattern.text, "--weld", "exact",
                 "--json", summary.text);
    json_node *root = json_node_read_file(summary.text);
    assert_int_equal(json_node_member(root, "intervals")->count, 1);
    assert_non_null(strstr(json_node_string(json_node_member(root, "summary"), "stopped_by"), "frame 2"));
    json_node_free(root);
    EXPECT_TOOL(0, "replay", model.text, pattern.text, "--weld", "0.5");
    recorded_free(&parting);
}

/* Which of 12 vertices lie together, in each of four frames: vertex v is at place[frame][v % 4], so that only those of the
 * same v % 4 lie together in all of them. */
static void only_what_lies_together_in_all_frames_is_joined(void **state) {
    enum { FRAMES = 4, VERTICES = 12 };
    static const double place[FRAMES][4] = {{0, 0, 0, 0}, {1, 1, 2, 2}, {1, 2, 1, 2}, {3, 3, 3, 3}};
    double frames[FRAMES * VERTICES * 3];
    uint32_t triangles[12];
    (void)state;
    for (int f = 0; f < FRAMES; f++)
        for (int v = 0; v < VERTICES; v++)
            for (int axis = 0; axis < 3; axis++)
                frames[(f * VERTICES + v) * 3 + axis] = axis == v % 3 ? place[f][v % 4] * (1 + v % 4) : 0.25;
    for (uint32_t i = 0; i < 12; i++) triangles[i] = i;
    /* v and v + 4 have another axis, so it is taken from v % 4 alone. */
    for (int f = 0; f < FRAMES; f++)
        for (int v = 4; v < VERTICES; v++)
            memcpy(frames + (f * VERTICES + v) * 3, frames + (f * VERTICES + v % 4) * 3, 3 * sizeof *frames);
    const recorded scene = {VERTICES, 4, FRAMES, triangles, frames};
    const temp_path model = recorded_write_mesh(&folder, "twelve.obj", &scene, 0),
                    cache = recorded_write_cache(&folder, "twelve.pc2", &scene),
                    json = temp_file_path(&folder, "twelve.json");
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--quiet", "--weld", "exact", "--json", json.text);
    json_node *root = json_node_read_file(json.text);
    assert_int_equal(json_node_number(json_node_member(root, "summary"), "vertices"), 4);
    json_node_free(root);
}

/* Within 1, vertex 0 stands for 3 and 6 in frame 0, which lie 1.8 apart. In frame 1 it leaves them, so that 3 stands for 6, and that
 * must hold in frame 0, too. */
static void whoever_stands_for_others_is_near_them_in_all_frames(void **state) {
    static const double corners[2][3] = {{0, 0.9, -0.9}, {10, 0, 0}};
    uint32_t triangles[9];
    double frames[2 * 27];
    (void)state;
    for (uint32_t v = 0; v < 9; v++) triangles[v] = v;
    for (int f = 0; f < 2; f++)
        for (int v = 0; v < 9; v++) {
            const double place[3] = {v % 3 == 0 ? corners[f][v / 3] : 20.0 * (v / 3), v % 3 == 1 ? 20 : 0,
                                     v % 3 == 2 ? 20 : 0};
            memcpy(frames + (f * 9 + v) * 3, place, sizeof place);
        }
    const recorded scene = {9, 3, 2, triangles, frames};
    const temp_path model = recorded_write_mesh(&folder, "three.obj", &scene, 0),
                    cache = recorded_write_cache(&folder, "three.pc2", &scene),
                    json = temp_file_path(&folder, "three.json");
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--quiet", "--weld", "1", "--json", json.text);
    json_node *root = json_node_read_file(json.text);
    assert_int_equal(json_node_number(json_node_member(root, "summary"), "vertices"), 9);
    json_node_free(root);
}

/* Box 1 is hidden by a scale of 0 in the first and the last of four frames; between them it stands half in box 0. */
static temp_path write_hidden(double first_scale) {
    static const double cube[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
    static const double sides[] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                   1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    static const double times[] = {0, 0.125, 0.25, 0.375};
    double scales[12] = {0};
    gltf_fixture fixture = {0};
    for (int i = 0; i < 12; i++) scales[i] = i / 3 == 0 || i / 3 == 3 ? first_scale : 1;
    gltf_fixture_array(&fixture, 5126, "VEC3", 24, cube);
    gltf_fixture_array(&fixture, 5123, "SCALAR", 36, sides);
    gltf_fixture_array(&fixture, 5126, "SCALAR", 4, times);
    gltf_fixture_array(&fixture, 5126, "VEC3", 12, scales);
    const file_bytes file = gltf_fixture_glb(
        &fixture,
        "\"nodes\":[{\"name\":\"Prop\",\"mesh\":0},{\"name\":\"Appears\",\"mesh\":0,\"translation\":[0.5,0.25,0.25]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"animations\":[{\"samplers\":[{\"input\":2,\"output\":3,\"interpolation\":\"STEP\"}],\"channels\":[{"
        "\"sampler\":0,\"target\":{\"node\":1,\"path\":\"scale\"}}]}]");
    return temp_file_write(&folder, "hidden.glb", file.bytes, file.size);
}

static void hidden_things_keep_their_vertices(void **state) {
    static const char *const welds[] = {"exact", "none", "1e-4"};
    const temp_path path = write_hidden(0);
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        tool_run run = i < 3 ? RUN_TOOL("check", path.text, path.text, "--fps", "8", "--weld", welds[i])
                             : RUN_TOOL("check", path.text, path.text, "--fps", "8");
        assert_int_equal(run.code, 0);
        expect_text(run.out, "Frames 1 to 2 cross (2 of 4)", true);
        expect_text(run.out, "1 event, Prop x Appears, ", true);
        expect_text(run.error,
                    "7 vertices lie on others in the first frame alone, as where something is hidden",
                    i != 1);
        tool_run_free(&run);
    }
}

/* ---- open edges that all but lie on others ----------------------------------------------------------------- */

enum { RINGS = 8, SEGMENTS = 12 };

/* How the corners of a ball's triangles are written. */
typedef struct ball_form {
    const char *name; /* of the file, whose ending says the format */
    double radius, centre[3];
    float off; /* every other corner is moved by so many units in the last place, 0 to off, in turn */
} ball_form;

static void ball_corner(const ball_form *form, int ring, int segment, int use, float out[3]) {
    const double turn = 2 * 3.14159265358979323846 * (segment % SEGMENTS) / SEGMENTS,
                 height = 3.14159265358979323846 * ring / RINGS, pole = ring % RINGS == 0 ? 0 : sin(height);
    const double unit[3] = {pole * cos(turn), pole * sin(turn), cos(height)};
    for (int axis = 0; axis < 3; axis++) {
        float x = (float)(form->centre[axis] + form->radius * unit[axis]);
        for (int k = 0; k < (use * 7 + axis) % ((int)form->off + 1); k++) x = nextafterf(x, 1e30f);
        out[axis] = x;
    }
}

static void print_triangle(FILE *file, bool stl, float corners[3][3], int number) {
    if (stl) fprintf(file, "facet normal 0 0 0\nouter loop\n");
    for (int i = 0; i < 3; i++)
        fprintf(file, "%s %.9g %.9g %.9g\n", stl ? "vertex" : "v", (double)corners[i][0],
                (double)corners[i][1], (double)corners[i][2]);
    if (stl)
        fprintf(file, "endloop\nendfacet\n");
    else
        fprintf(file, "f %d %d %d\n", 3 * number + 1, 3 * number + 2, 3 * number + 3);
}

/* A ball of triangles that each bring corners of their own. Returns how many triangles it has. */
static int write_ball(const ball_form *form, temp_path *path) {
    const bool stl = strstr(form->name, ".stl") != NULL;
    int count = 0;
    *path = temp_file_path(&folder, form->name);
    FILE *file = fopen(path->text, "w");
    assert_non_null(file);
    if (stl) fprintf(file, "solid ball\n");
    for (int ring = 0; ring < RINGS; ring++)
        for (int segment = 0; segment < SEGMENTS; segment++)
            for (int half = 0; half < 2; half++) {
                const int places[2][3][2] = {{{0, 0}, {1, 0}, {1, 1}}, {{0, 0}, {1, 1}, {0, 1}}};
                float corners[3][3];
                if ((ring == 0 && half == 1) || (ring == RINGS - 1 && half == 0)) continue; /* at a pole */
                for (int i = 0; i < 3; i++)
                    ball_corner(form, ring + places[half][i][0], segment + places[half][i][1], 3 * count + i,
                                corners[i]);
                print_triangle(file, stl, corners, count++);
            }
    if (stl) fprintf(file, "endsolid ball\n");
    fclose(file);
    return count;
}

/* What the hint says; false: there is none. */
static bool find_hint(const char *error, int *joined, int *open, char eps[32]) {
    const char *at = strstr(error, " open edges lie on others but for ");
    if (at == NULL) return false;
    const char *option = strstr(at, "; --weld "), *line = at;
    while (line > error && line[-1] != '\n') line--;
    return sscanf(line, "cscd: warning: %d of %d open", joined, open) == 2 && option != NULL &&
           sscanf(option, "; --weld %31s", eps) == 1;
}

static void the_hint_joins_rounded_corners(void **state) {
    static const ball_form forms[] = {
        {"unit.stl", 1, {0, 0, 0}, 1},        {"far.stl", 40, {100, 50, 0}, 1},
        {"small.stl", 1e-6, {0, 2e-6, 0}, 3}, {"large.stl", 3e8, {0, 0, 1e9f}, 2},
        {"unit.obj", 1, {0, 0, 0}, 1},        {"far.obj", 40, {-100, 50, 10}, 2},
    };
    (void)state;
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        temp_path path;
        int joined = 0, open = 0;
        char eps[32];
        write_ball(&forms[i], &path);
        tool_run run = RUN_TOOL("info", path.text);
        if (!find_hint(run.error, &joined, &open, eps)) fail_msg("%s: no hint: %s", forms[i].name, run.error);
        assert_true(open > 100 && joined == open);
        tool_run_free(&run);
        run = RUN_TOOL("info", path.text, "--weld", eps);
        if (strstr(run.out, "closed, genus 0") == NULL)
            fail_msg("%s: not closed by --weld %s: %s", forms[i].name, eps, run.out);
        expect_text(run.error, "lie on others", false);
        tool_run_free(&run);
        run = RUN_TOOL("check", path.text, "--weld", eps);
        expect_text(run.out, "Clean: ", true);
        tool_run_free(&run);
    }
}

/* Two sheets with a gap between their borders, which is written as it is, and a closed box. */
static void other_open_edges_have_no_hint(void **state) {
    static const struct {
        const char *gap;
        bool hint;
    } cases[] = {{"1", false}, {"0.001", false}, {"0.0001", false}, {"0.000015", true}, {"0.000001", true}};
    char text[512];
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(text, sizeof text,
                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
                 "v 1 0 %s\nv 2 0 %s\nv 2 1 %s\nv 1 1 %s\nf 5 6 7\nf 5 7 8\n",
                 cases[i].gap, cases[i].gap, cases[i].gap, cases[i].gap);
        const temp_path path = temp_file_write(&folder, "sheets.obj", text, strlen(text));
        tool_run run = RUN_TOOL("check", path.text);
        expect_text(run.error, "2 of 8 open edges lie on others but for", cases[i].hint);
        tool_run_free(&run);
    }
    snprintf(text, sizeof text, "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 4 5 6\n");
    const temp_path path = temp_file_write(&folder, "same.obj", text, strlen(text));
    tool_run run = RUN_TOOL("check", path.text);
    expect_text(run.error, "2 of 6 open edges lie on others; --weld exact joins them", true);
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices_that_part_stay_apart),
        cmocka_unit_test(in_a_series_they_are_an_error),
        cmocka_unit_test(only_what_lies_together_in_all_frames_is_joined),
        cmocka_unit_test(whoever_stands_for_others_is_near_them_in_all_frames),
        cmocka_unit_test(hidden_things_keep_their_vertices),
        cmocka_unit_test(the_hint_joins_rounded_corners),
        cmocka_unit_test(other_open_edges_have_no_hint),
    };
    return cmocka_run_group_tests(tests, own_folder_make, own_folder_remove);
}
