/* Parts that are asked for by --parts-by and that a file does not have: said, with what to do. */
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <string.h>

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

/* A triangle of no material. */
static temp_path write_gltf(void) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static gltf_fixture fixture;
    fixture = (gltf_fixture){0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, positions);
    const file_bytes file = gltf_fixture_glb(
        &fixture,
        "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"materials\":[{}]");
    return temp_file_write(&folder, "plain.glb", file.bytes, file.size);
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void who_gets_no_parts_is_told(void **state) {
    (void)state;
    const temp_path gltf = write_gltf(), obj = write_text("plain.obj", SQUARE "f 1 2 3\n");
    const temp_path off = write_text("plain.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const temp_path stl =
        write_text("plain.stl", "solid A\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                "vertex 0 1 0\nendloop\nendfacet\nendsolid A\n");
    const temp_path ply = write_text(
        "plain.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nproperty int part\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 7\n");
    const struct {
        const char *path, *by, *reason;
    } cases[] = {
        {gltf.text, "group", "glTF files have no groups; leave it out, or export the model as OBJ with them"},
        {gltf.text, "material", "none of its triangles has a material"},
        {obj.text, "object", "no line 'o' names an object of its faces"},
        {obj.text, "group", "no line 'g' names a group of its faces"},
        {obj.text, "material", "no line 'usemtl' names a material of its faces"},
        {off.text, "object", "the file names no objects"},
        {off.text, "group", "OFF files have no groups"},
        {stl.text, "material",
         "STL files have no materials; leave it out, or export the model as OBJ or glTF with them"},
        {ply.text, "group", "PLY files have no groups"},
        {ply.text, "material", "PLY files have no materials"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char which[60];
        snprintf(which, sizeof which, "--parts-by %s finds no parts: ", cases[i].by);
        EXPECT_ERROR(1, TEXTS(cases[i].path, which, cases[i].reason), "info", cases[i].path, "--parts-by",
                     cases[i].by);
        EXPECT_ERROR(1, TEXTS(which, cases[i].reason), "check", cases[i].path, "--parts-by", cases[i].by);
    }
    tool_run run = RUN_TOOL("info", ply.text, "--parts-by", "object"); /* what it names anyway */
    assert_non_null(strstr(run.out, "\nparts       1: 7 (1 triangle)\n"));
    tool_run_free(&run);
    const temp_path table = write_text("parts.csv", "face,name\n0,A\n");
    const temp_path named = write_text("named.obj", SQUARE "usemtl A\nf 1 2 3\n");
    EXPECT_ERROR(1, TEXTS("--parts and --parts-by both say what the parts are; give one of them"), "check",
                 named.text, "--parts-by", "material", "--parts", table.text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(who_gets_no_parts_is_told)};
    return cmocka_run_group_tests_name("missing_parts", tests, own_folder_make, own_folder_remove);
}
