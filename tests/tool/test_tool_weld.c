/* The tool welds split seams and ignores given pairs. */
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/test.h"
#include "tests/support/tool/contact_rows.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/soft_bar.h"
#include "tests/support/tool/tool_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static recorded clean, split;
static temp_path clean_model, clean_cache, split_model, split_cache, csv;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    clean = recorded_cube(false);
    split = recorded_cube(true);
    clean_model = recorded_write_mesh(&folder, "clean.obj", &clean, 0);
    clean_cache = recorded_write_cache(&folder, "clean.pc2", &clean);
    split_model = recorded_write_mesh(&folder, "split.obj", &split, 0);
    split_cache = recorded_write_cache(&folder, "split.pc2", &split);
    csv = temp_file_path(&folder, "out.csv");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    recorded_free(&clean);
    recorded_free(&split);
    temp_folder_remove(&folder);
    return 0;
}

/* Returns the contacts of a replay with one more option and its value. */
static contact_rows contacts_of(const temp_path *model, const char *frames, const char *option,
                                const char *value) {
    EXPECT_TOOL(0, "replay", model->text, frames, "--contacts", csv.text, "--quiet", option, value);
    return contact_rows_read_csv(csv.text);
}

static int compare_places(const void *left, const void *right) {
    const contact_record *l = left, *r = right;
    if (l->frame != r->frame) return l->frame < r->frame ? -1 : 1;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        if (fabs(l->point[k] - r->point[k]) > 1e-9) return l->point[k] < r->point[k] ? -1 : 1;
    }
    return fabs(l->toi - r->toi) <= 1e-9 ? 0 : l->toi < r->toi ? -1 : 1;
}

/* Expects the same kinds at the same times and places; vertices and the order of equal contacts may
 * differ. */
static void assert_same_places(contact_rows *a, contact_rows *b) {
    assert_int_equal(a->count, b->count);
    qsort(a->items, a->count, sizeof *a->items, compare_places);
    qsort(b->items, b->count, sizeof *b->items, compare_places);
    for (size_t i = 0; i < a->count; i++) assert_int_equal(compare_places(&a->items[i], &b->items[i]), 0);
}

/* Returns whether some triangle of the file has these vertices. */
static bool in_a_triangle(const recorded *r, const uint32_t *vertices, int count) {
    for (uint32_t t = 0; t < r->triangle_count; t++) {
        const uint32_t *v = r->triangles + (size_t)t * 3;
        int held = 0;
        for (int i = 0; i < count; i++)
            held += v[0] == vertices[i] || v[1] == vertices[i] || v[2] == vertices[i];
        if (held == count) return true;
    }
    return false;
}

static void assert_file_indices(const recorded *r, const contact_rows *rows) {
    for (size_t i = 0; i < rows->count; i++) {
        const contact_record *c = &rows->items[i];
        bool vf = c->kind == CSCD_CONTACT_VF;
        assert_true(in_a_triangle(r, c->a, vf ? 1 : 2));
        assert_true(in_a_triangle(r, c->b, vf ? 3 : 2));
    }
}

static void welding_finds_what_the_clean_export_has(void **state) {
    (void)state;
    contact_rows expected = contacts_of(&clean_model, clean_cache.text, "--threads", "1");
    contact_rows welded = contacts_of(&split_model, split_cache.text, "--weld", "exact");
    assert_true(expected.count >= 10);
    size_t vf =
        contact_rows_of(&expected, 0, CSCD_CONTACT_VF) + contact_rows_of(&expected, 1, CSCD_CONTACT_VF);
    assert_true(vf > 1 && expected.count - vf > 1);
    assert_file_indices(&split, &welded);
    assert_same_places(&expected, &welded);
    contact_rows_free(&expected);
    contact_rows_free(&welded);
}

/* The recording with three vertices for each triangle, as STL stores them. */
static recorded split_all(const recorded *r) {
    recorded soup = {.vertex_count = 3 * r->triangle_count,
                     .triangle_count = r->triangle_count,
                     .frame_count = r->frame_count};
    soup.triangles = malloc(soup.vertex_count * sizeof *soup.triangles);
    soup.frames = malloc((size_t)soup.frame_count * soup.vertex_count * 3 * sizeof *soup.frames);
    assert_true(soup.triangles != NULL && soup.frames != NULL);
    for (uint32_t v = 0; v < soup.vertex_count; v++) {
        soup.triangles[v] = v;
        for (uint32_t frame = 0; frame < soup.frame_count; frame++)
            memcpy(soup.frames + 3 * ((size_t)frame * soup.vertex_count + v),
                   recorded_position(r, frame, r->triangles[v]), 3 * sizeof *soup.frames);
    }
    return soup;
}

static temp_path write_stl(const char *name, const recorded *soup, uint32_t frame) {
    static char text[20000];
    size_t used = (size_t)snprintf(text, sizeof text, "solid recorded\n");
    for (uint32_t v = 0; v < soup->vertex_count; v++) {
        const double *x = recorded_position(soup, frame, v);
        used += (size_t)snprintf(text + used, sizeof text - used, "%svertex %.17g %.17g %.17g\n%s",
                                 v % 3 == 0 ? "facet normal 0 0 0\nouter loop\n" : "", x[0], x[1], x[2],
                                 v % 3 == 2 ? "endloop\nendfacet\n" : "");
        assert_true(used < sizeof text - 20);
    }
    used += (size_t)snprintf(text + used, sizeof text - used, "endsolid recorded\n");
    return temp_file_write(&folder, name, text, used);
}

static void stl_files_are_welded_unless_one_says_no(void **state) {
    (void)state;
    recorded soup = split_all(&clean);
    temp_path frames[3];
    assert_int_equal(soup.frame_count, 3);
    for (uint32_t i = 0; i < 3; i++)
        frames[i] = write_stl((const char *[]){"f1.stl", "f2.stl", "f3.stl"}[i], &soup, i);
    contact_rows expected = contacts_of(&clean_model, clean_cache.text, "--threads", "1");
    EXPECT_TOOL(0, "replay", frames[0].text, frames[1].text, frames[2].text, "--contacts", csv.text,
                "--quiet");
    contact_rows welded = contact_rows_read_csv(csv.text);
    for (size_t i = 0; i < welded.count; i++) welded.items[i].frame--; /* f1.stl is frame 1 */
    assert_file_indices(&soup, &welded);
    assert_same_places(&expected, &welded);
    contact_rows_free(&expected);
    contact_rows_free(&welded);
    tool_run run = RUN_TOOL("info", frames[0].text);
    assert_non_null(
        strstr(run.error, "the 48 vertices of the STL file are joined to 12; --weld none keeps them apart"));
    assert_non_null(strstr(run.out, "components  2"));
    tool_run_free(&run);
    run = RUN_TOOL("info", frames[0].text, "--weld", "none");
    assert_non_null(strstr(run.out, "components  16"));
    assert_non_null(strstr(run.error, "--weld exact would close the mesh"));
    tool_run_free(&run);
    recorded_free(&soup);
}

static void expect_components(const char *path, const char *weld, const char *components) {
    tool_run run = weld != NULL ? RUN_TOOL("info", path, "--weld", weld) : RUN_TOOL("info", path);
    if (strstr(run.out, components) == NULL) fail_msg("no %s in: %s", components, run.out);
    if (weld == NULL)
        assert_non_null(
            strstr(run.error, "the 12 vertices of the glTF file are joined to 8; --weld none keeps"));
    tool_run_free(&run);
}

/* Two squares that share an edge, each a part of two triangles with vertices of their own. */
static void gltf_files_are_welded_within_their_parts(void **state) {
    (void)state;
    static const double square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 18, square);
    const file_bytes file = gltf_fixture_glb(
        &fixture, "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[1,0,0]}],\"meshes\":[{"
                  "\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]");
    const temp_path path = temp_file_write(&folder, "squares.glb", file.bytes, file.size);
    expect_components(path.text, NULL, "components  2");
    expect_components(path.text, "none", "components  4");
    expect_components(path.text, "exact", "components  1");
}

static void expect_info(const char *text, const char *weld) {
    tool_run run = weld != NULL ? RUN_TOOL("info", split_model.text, "--weld", weld)
                                : RUN_TOOL("info", split_model.text);
    assert_int_equal(run.code, 0);
    if (strstr(run.out, text) == NULL) fail_msg("expected '%s' in: %s", text, run.out);
    tool_run_free(&run);
}

static void welding_closes_the_mesh(void **state) {
    (void)state;
    expect_info("components  7", NULL);
    expect_info("4 open edges", NULL);
    expect_info("components  2", "exact");
    expect_info("8 vertices, 18 edges, 12 triangles, Euler characteristic 2, closed, genus 0", "exact");
    expect_info("8 vertices, 18 edges, 12 triangles, Euler characteristic 2, closed, genus 0", "1e-6");
    tool_run run = RUN_TOOL("replay", split_model.text, split_cache.text);
    assert_non_null(strstr(run.error, "cscd: warning: "));
    assert_non_null(strstr(run.error, "--weld exact would close the mesh"));
    tool_run_free(&run);
    run = RUN_TOOL("replay", split_model.text, split_cache.text, "--weld", "exact");
    assert_string_equal(run.error, "");
    tool_run_free(&run);
}

/* The first frame decides, not the model file. */
static void suggests_welding_where_it_would_close_the_first_frame(void **state) {
    (void)state;
    recorded apart = recorded_cube(true);
    for (uint32_t k = 0; k < 3; k++) apart.frames[(size_t)k * 28 * 3] += 0.125;
    temp_path model = recorded_write_mesh(&folder, "apart.obj", &apart, 0);
    temp_path cache = recorded_write_cache(&folder, "apart.pc2", &apart);
    tool_run run = RUN_TOOL("replay", model.text, split_cache.text);
    assert_non_null(strstr(run.error, "--weld exact would close the mesh"));
    tool_run_free(&run);
    run = RUN_TOOL("replay", split_model.text, cache.text);
    assert_non_null(strstr(run.error, "open surface"));
    assert_null(strstr(run.error, "would close the mesh"));
    tool_run_free(&run);
    recorded_free(&apart);
}

/* Copies of one corner that lie a little apart are welded by a distance, not by equality. */
static void welds_within_a_distance(void **state) {
    (void)state;
    recorded loose = recorded_cube(true);
    for (uint32_t k = 0; k < loose.frame_count; k++) {
        for (size_t v = 0; v < 24; v++) loose.frames[(k * 28 + v) * 3] += 0x1p-16 * (double)(v % 3);
    }
    temp_path model = recorded_write_mesh(&folder, "loose.obj", &loose, 0);
    temp_path cache = recorded_write_cache(&folder, "loose.pc2", &loose);
    static const char closed[] =
        "8 vertices, 18 edges, 12 triangles, Euler characteristic 2, closed, genus 0";
    tool_run run = RUN_TOOL("info", model.text, "--weld", "0.001");
    assert_non_null(strstr(run.out, closed));
    tool_run_free(&run);
    run = RUN_TOOL("info", model.text, "--weld", "exact");
    assert_null(strstr(run.out, closed));
    tool_run_free(&run);
    contact_rows rows = contacts_of(&model, cache.text, "--weld", "0.001");
    assert_true(rows.count >= 10);
    assert_file_indices(&loose, &rows);
    contact_rows_free(&rows);
    EXPECT_ERROR(1, TEXTS("--weld 100", "collapses every triangle"), "info", model.text, "--weld", "100");
    recorded_free(&loose);
}

/* A sliver is inserted between the triangles of the file, so that later ones get other numbers. */
static void collapsed_triangles_are_dropped_and_counted(void **state) {
    (void)state;
    recorded sliver = recorded_cube(true);
    sliver.triangles[0] = 0;
    sliver.triangles[1] = 4; /* vertices 0 and 20 are copies of one corner: see below */
    for (uint32_t v = 1; v < 24; v++) {
        if (memcmp(recorded_position(&sliver, 0, v), recorded_position(&sliver, 0, 0), 3 * sizeof(double)) ==
            0)
            sliver.triangles[1] = v;
    }
    assert_true(sliver.triangles[1] > 4);
    temp_path model = recorded_write_mesh(&folder, "sliver.obj", &sliver, 0);
    tool_run run =
        RUN_TOOL("replay", model.text, split_cache.text, "--weld", "exact", "--contacts", csv.text);
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.error, "cscd: warning: welding collapsed 1 triangle"));
    tool_run_free(&run);
    contact_rows rows = contact_rows_read_csv(csv.text);
    assert_true(rows.count > 0);
    for (size_t i = 0; i < rows.count; i++)
        assert_true(rows.items[i].kind != CSCD_CONTACT_VF || in_a_triangle(&sliver, rows.items[i].b, 3));
    contact_rows_free(&rows);
    recorded_free(&sliver);
}

static temp_path write_list(const char *text) {
    return temp_file_write(&folder, "ignore.txt", text, strlen(text));
}

static size_t count_ignoring(const char *text) {
    temp_path path = write_list(text);
    contact_rows rows = contacts_of(&clean_model, clean_cache.text, "--ignore", path.text);
    size_t count = rows.count;
    contact_rows_free(&rows);
    return count;
}

static void ignores_the_pairs_of_a_list(void **state) {
    (void)state;
    char all_pairs[16 * 16 * 8] = "";
    for (int a = 0; a < 12; a++) {
        for (int b = 12; b < 16; b++)
            sprintf(all_pairs + strlen(all_pairs), "%d %d\n", a % 2 ? a : b, a % 2 ? b : a);
    }
    size_t all = count_ignoring("# nothing\n\n   # still nothing\n");
    assert_true(all > 0);
    assert_int_equal(count_ignoring("components 0 1\n"), 0);
    assert_int_equal(count_ignoring("  components 1, 0 # whatever the order\r\n"), 0);
    assert_int_equal(count_ignoring("components 0 0\ncomponents 1 1\n"), all);
    assert_int_equal(count_ignoring(all_pairs), 0);
    size_t fewer = 0;
    for (int a = 0; a < 12; a++) {
        char line[32];
        snprintf(line, sizeof line, "%d 15\n%d 12", a, a);
        size_t left = count_ignoring(line);
        assert_true(left <= all);
        fewer += left < all;
    }
    assert_true(fewer > 0);
}

static void names_the_line_of_a_bad_list(void **state) {
    (void)state;
    static const char *const bad[] = {
        "0 1\n\n0\n",        "0 1\n#\n0 1 2\n",    "0 1\n#\n0 16\n", "\n\n-1 2\n",
        "\n\ntriangles 1 2", "\n\ncomponents 0 2", "\n\n0 1 more",   "\n\n1 99999999999999999999\n"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        temp_path path = write_list(bad[i]);
        EXPECT_ERROR(1, TEXTS("ignore.txt:3: ", "expected", "A B"), "replay", clean_model.text,
                     clean_cache.text, "--ignore", path.text);
    }
}

/* The list means triangles of the file, whatever welding does to them. */
static void a_list_means_the_triangles_of_the_file(void **state) {
    (void)state;
    contact_rows all = contacts_of(&split_model, split_cache.text, "--weld", "exact");
    temp_path path = write_list("components 1 0\n");
    EXPECT_TOOL(0, "replay", split_model.text, split_cache.text, "--weld", "exact", "--ignore", path.text,
                "--contacts", csv.text);
    contact_rows none = contact_rows_read_csv(csv.text);
    assert_true(all.count > 0 && none.count == 0);
    contact_rows_free(&all);
    contact_rows_free(&none);
}

/* Replays from a frame with intersections, and ignores the pairs that intersect there. */
static void ignores_what_meets_at_rest(void **state) {
    (void)state;
    recorded flight = recorded_tetrahedra(8);
    temp_path inside = recorded_write_mesh(&folder, "inside.obj", &flight, 4);
    temp_path apart = recorded_write_mesh(&folder, "apart.obj", &flight, 3);
    EXPECT_TOOL(3, "replay", inside.text, inside.text, apart.text, "--fail-on-contact");
    tool_run run = RUN_TOOL("replay", inside.text, inside.text, apart.text, "--timings", "--fail-on-contact",
                            "--ignore-rest");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "3 triangle pairs that intersect or touch in frame 0 are left out"));
    assert_non_null(strstr(run.out, "intervals: 1 clean, 0 with contact, 0 intersecting, 0 unknown"));
    tool_run_free(&run);
    EXPECT_TOOL(3, "check", inside.text, "--fail-on-contact");
    EXPECT_TOOL(0, "check", inside.text, "--fail-on-contact", "--ignore-rest");
    recorded_free(&flight);
}

static void faces_keep_their_stiffness(void **state) {
    (void)state;
    const temp_path bar = soft_bar_write(&folder, "bar.ply", 0.25, true);
    tool_run run = RUN_TOOL("preprocess", bar.text, "--weld", "exact");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, ": 2 regions by method charge; "));
    assert_non_null(strstr(run.out, "480 vertices, 956 triangles, 1 component\n"));
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(welding_finds_what_the_clean_export_has),
        cmocka_unit_test(stl_files_are_welded_unless_one_says_no),
        cmocka_unit_test(gltf_files_are_welded_within_their_parts),
        cmocka_unit_test(welding_closes_the_mesh),
        cmocka_unit_test(suggests_welding_where_it_would_close_the_first_frame),
        cmocka_unit_test(welds_within_a_distance),
        cmocka_unit_test(collapsed_triangles_are_dropped_and_counted),
        cmocka_unit_test(ignores_the_pairs_of_a_list),
        cmocka_unit_test(names_the_line_of_a_bad_list),
        cmocka_unit_test(a_list_means_the_triangles_of_the_file),
        cmocka_unit_test(ignores_what_meets_at_rest),
        cmocka_unit_test(faces_keep_their_stiffness),
    };
    return cmocka_run_group_tests_name("tool_weld", tests, make_files, remove_files);
}
