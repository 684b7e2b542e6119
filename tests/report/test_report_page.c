/* The content of reports is read back: scene, plan and frames of every kind, and names that are markup. */
#include "src/tool/report/template.h"
#include "tests/support/own_folder.h"
#include "tests/support/report/page_reader.h"
#include "tests/support/report/report_rig.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 7, TRIANGLES_MAX = 1000 };

static temp_path page_path(void) {
    return temp_file_path(&folder, "report.html");
}

/* Writes a report and reads it back. */
static page write_page(report *r, const report_summary *summaries, size_t count, const char *preprocess) {
    io_error error = {""};
    temp_path path = page_path();
    if (!report_write(r, path.text, summaries, count, preprocess, &error)) fail_msg("%s", error.text);
    report_destroy(r);
    return page_read(path.text);
}

static page page_of(const report_rig *rig, const report_options *options) {
    io_error error = {""};
    report *r = NULL;
    const report_summary summary = {"a.obj", "{\"intervals\":[]}"};
    if (!report_create(options, &r, &error) || !report_rig_replay(rig, r, &error)) fail_msg("%s", error.text);
    return write_page(r, &summary, 1, NULL);
}

static void expect_bytes(const page *p, const char *name, const void *expected, size_t size) {
    page_bytes bytes = page_array(p, name);
    assert_int_equal(bytes.size, size);
    assert_memory_equal(bytes.data, expected, size);
    free(bytes.data);
}

/* ---- scene and plan ---------------------------------------------------------------------------------- */

static void expect_frames(const page *p, const report_rig *rig, double unit) {
    uint32_t vertices = rig->shape.vertex_count, count = rig->shape.frame_count;
    page_bytes bytes = page_array(p, "frames");
    double *shown = page_frames(bytes, vertices, count, NULL), error = 0.0;
    for (size_t i = 0; i < (size_t)vertices * count * 3; i++)
        error = fmax(error, fabs(shown[i] * unit - rig->shape.frames[i]));
    assert_true(error == json_node_number(p->scene, "max_error"));
    assert_true(json_node_number(p->scene, "relative_error") < 1e-4);
    free(shown);
    free(bytes.data);
}

static void expect_plan(const page *p, const report_rig *rig) {
    uint32_t regions[TRIANGLES_MAX], components[TRIANGLES_MAX], count = rig->shape.triangle_count;
    float charges[TRIANGLES_MAX];
    for (uint32_t t = 0; t < count; t++) {
        regions[t] = cscd_plan_triangle_region(rig->plan, t);
        components[t] = cscd_mesh_triangle_component(rig->mesh, t);
        charges[t] = (float)cscd_plan_triangle_charge(rig->plan, t);
    }
    expect_bytes(p, "region", regions, count * sizeof *regions);
    expect_bytes(p, "component", components, count * sizeof *components);
    expect_bytes(p, "charge", charges, count * sizeof *charges);
    const json_node *plan = json_node_member(p->scene, "plan"), *list = json_node_member(plan, "regions");
    assert_string_equal(json_node_string(plan, "method"), "charge");
    assert_int_equal(list->count, cscd_plan_region_count(rig->plan));
    for (uint32_t i = 0; i < list->count; i++) {
        cscd_region region = cscd_plan_region(rig->plan, i);
        const json_node *item = json_node_item(list, i), *point = json_node_member(item, "detector_point");
        assert_true(json_node_number(item, "component") == region.component);
        assert_true(json_node_number(item, "triangles") == region.triangle_count);
        assert_true(json_node_number(item, "area") == region.area);
        assert_true(json_node_number(item, "visible_share") == region.visible_share);
        for (uint32_t k = 0; k < 3; k++)
            assert_true(json_node_item(point, k)->number == region.detector_point[k]);
    }
    const json_node *capacitances = json_node_member(plan, "capacitances");
    assert_int_equal(capacitances->count, cscd_mesh_component_count(rig->mesh));
    assert_true(json_node_item(capacitances, 0)->number == cscd_plan_capacitance(rig->plan, 0));
}

/* Computes the rank of each charge by counting how many of its component are smaller. */
static void expect_ranks(const page *p, const report_rig *rig) {
    page_bytes bytes = page_array(p, "equalized");
    for (uint32_t t = 0; t < rig->shape.triangle_count; t++) {
        uint32_t component = cscd_mesh_triangle_component(rig->mesh, t), less = 0, others = 0;
        for (uint32_t o = 0; o < rig->shape.triangle_count; o++) {
            if (o == t || cscd_mesh_triangle_component(rig->mesh, o) != component) continue;
            others++;
            less += cscd_plan_triangle_charge(rig->plan, o) < cscd_plan_triangle_charge(rig->plan, t);
        }
        float rank, expected = (float)((double)less / others);
        memcpy(&rank, bytes.data + t * sizeof rank, sizeof rank);
        assert_true(rank == expected);
    }
    free(bytes.data);
}

TEST(scene_and_plan_come_back) {
    report_rig rig = report_rig_create(recorded_tetrahedra(FRAMES), CSCD_METHOD_CHARGE);
    report_options options = report_rig_options(&rig);
    page p = page_of(&rig, &options);
    assert_true(json_node_number(p.json, "format") == 1.0);
    assert_string_equal(json_node_string(p.json, "kind"), "replay");
    assert_string_equal(json_node_string(p.json, "title"), "a.obj");
    assert_int_equal(json_node_member(p.json, "preprocess")->kind, JSON_NULL);
    assert_true(json_node_number(p.scene, "vertices") == 8.0);
    assert_true(json_node_number(p.scene, "triangles") == 8.0);
    assert_true(json_node_number(p.scene, "components") == 2.0);
    assert_true(json_node_number(p.scene, "unit") == 1.0);
    assert_true(json_node_number(p.scene, "first") == 0.0);
    assert_true(json_node_number(p.scene, "last") == FRAMES - 1);
    assert_string_equal(json_node_string(p.scene, "up"), "z");
    assert_int_equal(json_node_member(p.scene, "frames")->count, FRAMES);
    assert_int_equal(json_node_member(p.scene, "scenery")->kind, JSON_NULL);
    assert_false(page_has(&p, "scenery_triangles") || page_has(&p, "contact_file_vertices"));
    expect_bytes(&p, "triangles", rig.shape.triangles, rig.shape.triangle_count * sizeof(uint32_t[3]));
    expect_frames(&p, &rig, 1.0);
    expect_plan(&p, &rig);
    expect_ranks(&p, &rig);
    page_free(&p);
    report_rig_destroy(&rig);
}

/* Coordinates beyond the range of float32 reach the page in another unit, and lose no more precision than
 * others. */
TEST(huge_scenes_have_a_unit) {
    static const double scales[] = {0x1p280, 0x1p-280};
    for (int i = 0; i < 2; i++) {
        recorded shape = recorded_tetrahedra(FRAMES);
        for (size_t k = 0; k < (size_t)shape.vertex_count * FRAMES * 3; k++) shape.frames[k] *= scales[i];
        report_rig rig = report_rig_create(shape, CSCD_METHOD_SINGLE);
        report_options options = report_rig_options(&rig);
        options.plan = NULL;
        options.up_axis = 1;
        page p = page_of(&rig, &options);
        double unit = json_node_number(p.scene, "unit");
        assert_true(unit >= scales[i] && unit <= 8.0 * scales[i]);
        assert_string_equal(json_node_string(p.scene, "up"), "y");
        assert_int_equal(json_node_member(p.scene, "plan")->kind, JSON_NULL);
        assert_false(page_has(&p, "region") || page_has(&p, "charge"));
        expect_frames(&p, &rig, unit);
        page_free(&p);
        report_rig_destroy(&rig);
    }
}

/* ---- names that are markup --------------------------------------------------------------------------- */

static size_t count_of(const char *text, char c) {
    size_t count = 0;
    for (; *text != '\0'; text++) count += *text == c;
    return count;
}

TEST(names_are_never_markup) {
#define NAME "</script><img src=x onerror=alert(1)>.obj"
    report_rig rig = report_rig_create(recorded_tetrahedra(2), CSCD_METHOD_CHARGE);
    report_options options = report_rig_options(&rig);
    options.title = options.generator = NAME;
    io_error error = {""};
    report *r = NULL;
    assert_true(report_create(&options, &r, &error) && report_rig_replay(&rig, r, &error));
    const report_summary summary = {NAME "<!--", "{\"a\":\"" NAME "<!--\"}\n"};
    page p = write_page(r, &summary, 1, "{\"b\":\"" NAME "<!--\"}");
    assert_string_equal(json_node_string(p.json, "title"), NAME);
    const json_node *read = json_node_item(json_node_member(p.json, "summaries"), 0);
    assert_string_equal(json_node_string(read, "name"), NAME "<!--");
    assert_string_equal(json_node_string(json_node_member(read, "summary"), "a"), NAME "<!--");
    assert_string_equal(json_node_string(json_node_member(p.json, "preprocess"), "b"), NAME "<!--");
    assert_null(strstr(p.text, "<img"));
    report_template built;
    assert_true(report_template_load(TEMPLATE_REPORT, &built, &error));
    size_t arrays = json_node_member(p.scene, "arrays")->count, tail = strlen(p.text) - built.tail_size;
    assert_memory_equal(p.text, built.head, built.head_size);
    assert_string_equal(p.text + tail, built.tail);
    p.text[tail] = '\0';
    assert_int_equal(count_of(p.text + built.head_size, '<'), 2 * (1 + arrays));
    page_free(&p);
    report_rig_destroy(&rig);
}

/* ---- the other kinds --------------------------------------------------------------------------------- */

TEST(a_comparison_has_no_scene) {
    const report_options options = {.kind = REPORT_COMPARE, .title = "two", .generator = "cscd"};
    const report_summary summaries[] = {{"a.json", "{\"a\":1}"}, {"b.json", "{\"b\":2}"}};
    report *r = NULL;
    assert_true(report_create(&options, &r, NULL));
    page p = write_page(r, summaries, 2, NULL);
    assert_string_equal(json_node_string(p.json, "kind"), "compare");
    assert_int_equal(p.scene->kind, JSON_NULL);
    const json_node *second = json_node_item(json_node_member(p.json, "summaries"), 1);
    assert_string_equal(json_node_string(second, "name"), "b.json");
    assert_true(json_node_number(json_node_member(second, "summary"), "b") == 2.0);
    page_free(&p);
}

TEST(a_preprocess_has_one_frame) {
    report_rig rig = report_rig_create(recorded_torus(8, 6), CSCD_METHOD_CHARGE);
    report_options options = report_rig_options(&rig);
    options.kind = REPORT_PREPROCESS;
    report *r = NULL;
    assert_true(report_create(&options, &r, NULL) && report_begin(r, rig.shape.frames, NULL));
    page p = write_page(r, NULL, 0, "{\"timings\":{\"total_ms\":3}}");
    const json_node *timings = json_node_member(json_node_member(p.json, "preprocess"), "timings");
    assert_true(json_node_number(timings, "total_ms") == 3.0);
    assert_int_equal(json_node_member(p.json, "summaries")->count, 0);
    assert_int_equal(json_node_member(p.scene, "contacts")->kind, JSON_NULL);
    assert_true(json_node_number(p.scene, "last") == 0.0);
    static const char *const absent[] = {"heat", "orientation", "detector_points", "contact_interval",
                                         "contact_toi"};
    for (size_t i = 0; i < sizeof absent / sizeof *absent; i++) assert_false(page_has(&p, absent[i]));
    expect_frames(&p, &rig, 1.0);
    expect_plan(&p, &rig);
    expect_ranks(&p, &rig);
    page_free(&p);
    report_rig_destroy(&rig);
}

/* ---- the policy ---------------------------------------------------------------------------------------- */

/* Is the directive one of the policy, word for word? */
static bool policy_has(const char *policy, size_t size, const char *directive) {
    const size_t length = strlen(directive);
    for (size_t i = 0; i + length <= size; i++) {
        const char before = i > 0 ? policy[i - 1] : ' ', after = i + length < size ? policy[i + length] : ';';
        if (before == ' ' && after == ';' && strncmp(policy + i, directive, length) == 0) return true;
    }
    return false;
}

/* default-src says nothing about the base of links and the targets of forms. */
TEST(pages_load_send_and_move_nothing) {
    static const char begin[] = "<meta http-equiv=\"Content-Security-Policy\" content=\"";
    static const char *const directives[] = {"default-src 'none'", "base-uri 'none'", "form-action 'none'"};
    for (template_kind kind = TEMPLATE_REPORT; kind <= TEMPLATE_JOBS; kind++) {
        report_template built;
        assert_true(report_template_load(kind, &built, NULL));
        const char *policy = memmem(built.head, built.head_size, begin, sizeof begin - 1);
        assert_non_null(policy);
        policy += sizeof begin - 1;
        const size_t left = built.head_size - (size_t)(policy - built.head);
        const char *end = memchr(policy, '"', left);
        assert_non_null(end);
        for (size_t i = 0; i < sizeof directives / sizeof *directives; i++)
            if (!policy_has(policy, (size_t)(end - policy), directives[i]))
                fail_msg("page %d has no %s", (int)kind, directives[i]);
        /* A policy holds for what stands behind it. */
        assert_null(memmem(built.head, (size_t)(policy - built.head), "<script", 7));
    }
}

AROUND_ALL(own_folder_make, own_folder_remove)
