/* The tool's parts by object, group and material: names change with them, and what is found does not. */
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_path json;

static int make_folder(void **state) {
    own_folder_make(state);
    json = temp_file_path(&folder, "out.json");
    return 0;
}

/* ---- scenes ---------------------------------------------------------------------------------------------- */

/* A box by its bounds along x, y and z, whose side above is of another material than the five others. */
typedef struct side_box {
    const char *name; /* NULL: one object with the box before */
    double bounds[6];
    bool inverted;
    int walls, lid; /* materials; -1: none */
} side_box;

enum { BOXES = 2, SIDES = 6, LID = 1 };
static const char *const materials[] = {"Brushed Steel #2", "Rubber", "Glass"};
static const int quads[SIDES][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

static double corner_coordinate(const side_box *box, int corner, int axis) {
    return box->bounds[2 * axis + (corner >> axis & 1)];
}

static void print_material(FILE *file, int material) {
    fprintf(file, "usemtl %s\n", material >= 0 ? materials[material] : "(null)");
}

/* Each box shares its vertices between its sides. Only changes of material are written, also across objects. */
static temp_path write_obj(const char *name, const side_box *boxes, int count) {
    const temp_path path = temp_file_path(&folder, name);
    FILE *file = fopen(path.text, "w");
    int now = -1;
    for (int b = 0; b < count; b++) {
        if (boxes[b].name != NULL) fprintf(file, "o %s\n", boxes[b].name);
        for (int v = 0; v < 8; v++)
            fprintf(file, "v %g %g %g\n", corner_coordinate(&boxes[b], v, 0),
                    corner_coordinate(&boxes[b], v, 1), corner_coordinate(&boxes[b], v, 2));
        for (int s = 0; s < SIDES; s++) {
            const int material = s == LID ? boxes[b].lid : boxes[b].walls;
            if (material != now) print_material(file, material);
            now = material;
            fprintf(file, "f");
            for (int k = 0; k < 4; k++)
                fprintf(file, " %d", 8 * b + 1 + quads[s][boxes[b].inverted ? 3 - k : k]);
            fprintf(file, "\n");
        }
    }
    assert_int_equal(fclose(file), 0);
    return path;
}

/* A primitive of the sides from `first` up to `end`, each with vertices of its own, as exporters write them. */
static void write_primitive(gltf_fixture *fixture, const side_box *box, int first, int end, int material,
                            char *out, size_t size) {
    double positions[SIDES * 12], indices[SIDES * 6];
    size_t vertices = 0, corners = 0;
    for (int s = first; s < end; s++) {
        static const int cut[6] = {0, 1, 2, 0, 2, 3};
        for (int k = 0; k < 6; k++) indices[corners++] = (double)vertices + cut[k];
        for (int k = 0; k < 4; k++, vertices++)
            for (int axis = 0; axis < 3; axis++)
                positions[3 * vertices + (size_t)axis] =
                    corner_coordinate(box, quads[s][box->inverted ? 3 - k : k], axis);
    }
    const int at = gltf_fixture_array(fixture, 5126, "VEC3", 3 * vertices, positions);
    const int by = gltf_fixture_array(fixture, 5121, "SCALAR", corners, indices);
    char of[32] = "";
    if (material >= 0) snprintf(of, sizeof of, ",\"material\":%d", material);
    snprintf(out, size, "{\"attributes\":{\"POSITION\":%d},\"indices\":%d%s}", at, by, of);
}

/* A node for each box with a name, and three primitives for each box. */
static temp_path write_gltf(const char *name, const side_box *boxes) {
    static gltf_fixture fixture;
    char rest[3000], meshes[2000] = "", nodes[300] = "";
    fixture = (gltf_fixture){0};
    for (int b = 0, node = 0; b < BOXES; b++) {
        char text[3][120];
        write_primitive(&fixture, &boxes[b], 0, LID, boxes[b].walls, text[0], sizeof text[0]);
        write_primitive(&fixture, &boxes[b], LID, LID + 1, boxes[b].lid, text[1], sizeof text[1]);
        write_primitive(&fixture, &boxes[b], LID + 1, SIDES, boxes[b].walls, text[2], sizeof text[2]);
        const bool own = boxes[b].name != NULL, last = b + 1 == BOXES || boxes[b + 1].name != NULL;
        size_t used = strlen(meshes);
        snprintf(meshes + used, sizeof meshes - used, "%s%s%s,%s,%s%s", b > 0 ? "," : "",
                 own ? "{\"primitives\":[" : "", text[0], text[1], text[2], last ? "]}" : "");
        if (!own) continue;
        used = strlen(nodes);
        snprintf(nodes + used, sizeof nodes - used, "%s{\"name\":\"%s\",\"mesh\":%d}", node > 0 ? "," : "",
                 boxes[b].name, node);
        node++;
    }
    snprintf(
        rest, sizeof rest,
        "\"nodes\":[%s],\"meshes\":[%s],\"materials\":[{\"name\":\"%s\"},{\"name\":\"%s\"},{\"name\":\"%s\"}]",
        nodes, meshes, materials[0], materials[1], materials[2]);
    const file_bytes file = gltf_fixture_glb(&fixture, rest);
    return temp_file_write(&folder, name, file.bytes, file.size);
}

/* ---- what stays, and what changes ------------------------------------------------------------------------ */

typedef struct found_numbers {
    double crossing, touching, depth;
    size_t pairs, inside_out;
} found_numbers;

static found_numbers check_numbers(const char *model, const char *weld, const char *by) {
    EXPECT_TOOL(0, "check", model, "--quiet", "--json", json.text, "--weld", weld,
                by != NULL ? "--parts-by" : NULL, by);
    json_node *root = json_node_read_file(json.text);
    const json_node *frame = json_node_item(json_node_member(root, "frames"), 0);
    const found_numbers found = {json_node_number(frame, "crossing_pairs"),
                                 json_node_number(frame, "touching_pairs"), json_node_number(frame, "depth"),
                                 json_node_member(frame, "pairs")->count,
                                 json_node_member(root, "inside_out")->count};
    json_node_free(root);
    return found;
}

/* The row of the only event, as far as the two words that say which parts and how. */
static void expect_event(const char *model, const char *option, const char *value, const char *row) {
    char line[120];
    tool_run run = RUN_TOOL("check", model, option, value);
    snprintf(line, sizeof line, "\n%s ", row);
    if (strstr(run.out, line) == NULL) fail_msg("no '%s' in: %s", row, run.out);
    tool_run_free(&run);
}

static void expect_clean(const char *model, const char *option, const char *value) {
    tool_run run = RUN_TOOL("check", model, option, value);
    if (strcmp(run.out, "Clean: no two triangles cross or touch.\n") != 0) fail_msg("not clean: %s", run.out);
    tool_run_free(&run);
}

typedef struct part_scene {
    side_box boxes[BOXES];
    double depth;                        /* by hand */
    int inside_out;                      /* so many boxes are taken as turned around */
    const char *by_object, *by_material; /* rows of the event; NULL: clean */
} part_scene;

static const part_scene scenes[] = {
    /* A crate has sunk into a slab; of the five materials of the two boxes four are the same. */
    {{{"slab", {0, 2, 0, 2, 0, 1}, false, 0, 0}, {"crate", {0.5, 1.5, 0.5, 1.5, 0.75, 2}, false, 0, 1}},
     0.25,
     0,
     "slab x crate  cross",
     "Brushed Steel #2 x itself  cross"},
    {{{"slab", {0, 2, 0, 2, 0, 1}, false, 1, 0}, {"crate", {0.5, 1.5, 0.5, 1.5, 0.75, 2}, false, 2, 2}},
     0.25,
     0,
     "slab x crate  cross",
     "Brushed Steel #2 x Glass  cross"},
    /* A crate within another one, and one that is inside out besides. */
    {{{"slab", {0, 4, 0, 4, 0, 4}, false, 0, 1}, {"crate", {1, 2, 1, 2, 1, 2}, false, 0, 0}},
     2,
     0,
     "slab x crate  inside",
     "Brushed Steel #2 x itself  inside"},
    {{{"slab", {0, 4, 0, 4, 0, 4}, false, 0, 0}, {"crate", {1, 2, 1, 2, 1, 2}, true, 0, 0}},
     2,
     1,
     "slab x crate  inside",
     "Brushed Steel #2 x itself  inside"},
    /* The wall of a bottle, whose cavity is of another material than its outside. */
    {{{"bottle", {0, 4, 0, 4, 0, 4}, false, 0, 0}, {NULL, {1, 2, 1, 2, 1, 2}, true, 2, 2}}, 0, 0, NULL, NULL},
};

static void expect_scene(const part_scene *scene, const char *model) {
    static const char *const kinds[] = {"object", "material"};
    const found_numbers plain = check_numbers(model, "exact", NULL);
    assert_true(fabs(plain.depth - scene->depth) < 1e-12);
    assert_int_equal(plain.inside_out, scene->inside_out);
    for (int i = 0; i < 2; i++) {
        const found_numbers by = check_numbers(model, "exact", kinds[i]);
        assert_memory_equal(&by, &plain, sizeof by);
        const char *row = i == 0 ? scene->by_object : scene->by_material;
        if (row == NULL)
            expect_clean(model, "--parts-by", kinds[i]);
        else
            expect_event(model, "--parts-by", kinds[i], row);
    }
}

static void parts_change_names_alone(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        expect_scene(&scenes[i], write_obj("scene.obj", scenes[i].boxes, BOXES).text);
        const temp_path gltf = write_gltf("scene.glb", scenes[i].boxes);
        expect_scene(&scenes[i], gltf.text);
        /* Without welding the sides are apart, and nothing has an inside. */
        const found_numbers open = check_numbers(gltf.text, "none", NULL),
                            by = check_numbers(gltf.text, "none", "material");
        assert_memory_equal(&by, &open, sizeof by);
    }
}

/* The materials of one node are joined, as its triangles are without the option, and boxes that stand on each other are not. */
static void materials_are_welded_by_node(void **state) {
    (void)state;
    const side_box boxes[] = {{"a", {0, 1, 0, 1, 0, 1}, false, 0, 1}, {"b", {1, 2, 0, 1, 0, 1}, false, 0, 0}};
    const temp_path model = write_gltf("stand.glb", boxes);
    static const char *const kinds[][2] = {
        {NULL, NULL}, {"--parts-by", "object"}, {"--parts-by", "material"}};
    for (int i = 0; i < 3; i++) {
        tool_run run = RUN_TOOL("info", model.text, kinds[i][0], kinds[i][1]);
        if (strstr(run.out, "vertices    16\n") == NULL || strstr(run.out, "components  2\n") == NULL ||
            strstr(run.out, "not a closed surface") != NULL)
            fail_msg("welded otherwise: %s", run.out);
        tool_run_free(&run);
    }
}

/* A crate lies in a slab of the same material, which a post of another one crosses at another place. */
static void what_lies_in_its_own_material_is_told(void **state) {
    (void)state;
    const side_box boxes[] = {{"slab", {0, 8, 0, 4, 0, 4}, false, 0, 0},
                              {"crate", {1, 2, 1, 2, 1, 2}, false, 0, 0},
                              {"post", {5.25, 6, 1.25, 2, 3.75, 9}, false, 2, 2}};
    const temp_path model = write_obj("post.obj", boxes, 3);
    static const char *const kinds[][2] = {{NULL, NULL}, {"--parts-by", "material"}};
    static const char *const worst[] = {"2 places, worst: slab x crate, 2 deep.",
                                        "2 places, worst: Brushed Steel #2 x itself, 2 deep."};
    for (int i = 0; i < 2; i++) {
        tool_run run = RUN_TOOL("check", model.text, "--json", json.text, kinds[i][0], kinds[i][1]);
        if (strstr(run.out, "; 1 part lies inside another. ") == NULL || strstr(run.out, worst[i]) == NULL)
            fail_msg("no '%s' in: %s", worst[i], run.out);
        tool_run_free(&run);
        json_node *root = json_node_read_file(json.text);
        assert_int_equal(json_node_member(root, "events")->count, 2);
        json_node_free(root);
        EXPECT_TOOL(3, "check", model.text, "--quiet", "--fail-depth", "1", kinds[i][0], kinds[i][1]);
    }
    expect_event(model.text, "--parts-by", "material", "Brushed Steel #2 x itself  inside");
    expect_event(model.text, "--parts-by", "material", "Brushed Steel #2 x Glass   cross");
}

static void expect_parts(const char *model, const char *by, const char *line) {
    tool_run run = RUN_TOOL("info", model, "--parts-by", by);
    char whole[200];
    snprintf(whole, sizeof whole, "\nparts       %s\n", line);
    if (run.code != 0 || strstr(run.out, whole) == NULL)
        fail_msg("%d, no '%s' in: %s%s", run.code, line, run.out, run.error);
    tool_run_free(&run);
}

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void info_lists_them(void **state) {
    (void)state;
    const side_box boxes[] = {{"a", {0, 1, 0, 1, 0, 1}, false, 0, 1},
                              {"b", {5, 6, 0, 1, 0, 1}, false, -1, 0}};
    const char *list = "2: Brushed Steel #2 (12 triangles), Rubber (2 triangles); 10 in none";
    const temp_path obj = write_obj("two.obj", boxes, BOXES), gltf = write_gltf("two.glb", boxes);
    expect_parts(obj.text, "material", list);
    expect_parts(gltf.text, "material", list);
    expect_parts(obj.text, "object", "2: a (12 triangles), b (12 triangles)");
    expect_parts(gltf.text, "object", "2: a (12 triangles), b (12 triangles)");
    const temp_path group = write_text("group.obj", SQUARE "o a\ng Left Arm\nf 1 2 3\no b\nf 1 3 4\n");
    expect_parts(group.text, "group", "1: Left Arm (1 triangle); 1 in none");
    expect_parts(group.text, "object", "2: a (1 triangle), b (1 triangle)");
    EXPECT_TOOL(0, "info", obj.text, "--parts-by", "material", "--json", json.text);
    json_node *root = json_node_read_file(json.text);
    const json_node *parts = json_node_member(root, "parts");
    assert_int_equal(parts->count, 2);
    assert_string_equal(json_node_string(json_node_item(parts, 1), "name"), materials[1]);
    assert_true(json_node_number(json_node_item(parts, 0), "triangles") == 12.0);
    json_node_free(root);
}

/* Rules know materials by their names, and gates go by what is left. */
static void rules_take_materials(void **state) {
    (void)state;
    const part_scene *scene = &scenes[1];
    const temp_path obj = write_obj("rules.obj", scene->boxes, BOXES),
                    gltf = write_gltf("rules.glb", scene->boxes);
    const char *models[] = {obj.text, gltf.text};
    for (int i = 0; i < 2; i++) {
        EXPECT_TOOL(3, "check", models[i], "--quiet", "--parts-by", "material", "--fail-on", "crossing",
                    "--only", "Glass,Brushed Steel #2");
        EXPECT_TOOL(0, "check", models[i], "--quiet", "--parts-by", "material", "--fail-on", "crossing",
                    "--only", "Glass,Rubber");
        EXPECT_TOOL(0, "check", models[i], "--quiet", "--parts-by", "material", "--fail-on", "crossing",
                    "--ignore-parts", "Glass");
        EXPECT_ERROR(
            1, TEXTS("--only: there is no part 'slab'", "the parts are Rubber, Brushed Steel #2, Glass"),
            "check", models[i], "--parts-by", "material", "--only", "slab");
    }
}

/* ---- other commands, several files ----------------------------------------------------------------------- */

static void every_command_takes_it(void **state) {
    (void)state;
    const temp_path obj = write_obj("all.obj", scenes[1].boxes, BOXES),
                    picture = temp_file_path(&folder, "all.png");
    const char *steel = "Brushed Steel #2 x Glass";
    char list[1200];
    tool_run run = RUN_TOOL("check", "--each", obj.text, "--parts-by", "material");
    assert_non_null(strstr(run.out, steel));
    tool_run_free(&run);
    snprintf(list, sizeof list,
             "{\"model\":\"%s\",\"options\":{\"parts-by\":\"material\"}}\n{\"model\":\"%s\"}\n", obj.text,
             obj.text);
    const temp_path jobs = write_text("jobs.jsonl", list), results = temp_file_path(&folder, "results.jsonl");
    EXPECT_TOOL(3, "check", "--list", jobs.text, "--results", results.text, "--quiet", "--fail-on",
                "crossing");
    char *lines = read_whole_file(results.text, NULL);
    assert_non_null(strstr(lines, "Brushed Steel #2"));
    assert_non_null(strstr(lines, "slab"));
    free(lines);
    run = RUN_TOOL("replay", obj.text, obj.text, obj.text, "--parts-by", "material");
    assert_non_null(strstr(run.out, steel));
    tool_run_free(&run);
    EXPECT_TOOL(0, "render", obj.text, "--parts-by", "material", "--only", "Glass", "-o", picture.text);
    EXPECT_ERROR(2, TEXTS("--parts-by cannot be 'node'"), "check", obj.text, "--parts-by", "node");
}

/* A file that has none is a part as a whole beside one that has some. */
static void objects_without_materials_are_whole(void **state) {
    (void)state;
    const temp_path obj = write_obj("body.obj", scenes[0].boxes, BOXES);
    const temp_path floor = write_text("floor.off", "OFF\n3 1 0\n-9 -9 0.5\n9 -9 0.5\n0 9 0.5\n3 0 1 2\n");
    char object[600];
    snprintf(object, sizeof object, "floor=%s", floor.text);
    tool_run run = RUN_TOOL("check", obj.text, "--object", object, "--parts-by", "material");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.error, "floor: OFF files have no materials, so that it is one part"));
    assert_non_null(strstr(run.out, "\nbody/Brushed Steel #2 x floor "));
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_change_names_alone),
        cmocka_unit_test(materials_are_welded_by_node),
        cmocka_unit_test(what_lies_in_its_own_material_is_told),
        cmocka_unit_test(info_lists_them),
        cmocka_unit_test(rules_take_materials),
        cmocka_unit_test(every_command_takes_it),
        cmocka_unit_test(objects_without_materials_are_whole),
    };
    return cmocka_run_group_tests_name("parts_by", tests, make_folder, own_folder_remove);
}
