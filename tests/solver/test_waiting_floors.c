/* Pairs that wait because they are nearer than their distance, but do not touch, keep floors: no certified motion takes
 * them through each other. */
#include "tests/support/calls.h"
#include "tests/support/panels.h"
#include "tests/support/test.h"

#include <string.h>

enum { SIDE = 6, HALF = SIDE * SIDE };

static const double distance = 0.1;

/* Two flat panels at a distance below the one that they have to keep, hidden from each other, and then not. */
static panel_scene uncover_panels(double gap) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
    cscd_free_step step;
    rules[0].mask = 0;
    options.min_separation = distance;
    options.rules = rules;
    options.rule_count = 2;
    panel_scene p = panels_create(SIDE, NULL, &options);
    for (uint32_t v = 0; v < 2 * HALF; v++) p.x0[3 * v + 2] = v < HALF ? 0.0 : gap;
    memcpy(p.x1, p.x0, 2 * HALF * sizeof(double[3]));
    expect_ok(max_step_packed(p.detector, p.x0, p.x1, NULL, &step));
    expect_ok(cscd_detector_set_rules(p.detector, NULL, 0, NULL, 0));
    for (uint32_t v = HALF; v < 2 * HALF; v++) p.x1[3 * v + 2] -= 0.04;
    return p;
}

static void expect_apart(const panel_scene *p, double gap) {
    for (uint32_t v = HALF; v < 2 * HALF; v++) assert_true(p->x0[3 * v + 2] > 0.8 * gap);
}

TEST(steps_pass_through_nothing) {
    const double gap = 0.9 * distance;
    panel_scene p = uncover_panels(gap);
    for (int i = 0; i < 10; i++) {
        cscd_free_step step;
        expect_ok(max_step_packed(p.detector, p.x0, p.x1, p.x0, &step));
        assert_true(cscd_detector_waiting(p.detector).features > 0 && step.limited);
        for (uint32_t v = HALF; v < 2 * HALF; v++) p.x1[3 * v + 2] = p.x0[3 * v + 2] - 0.04;
        expect_apart(&p, gap);
    }
    panels_destroy(&p);
}

TEST(line_searches_pass_through_nothing) {
    const double gap = 0.9 * distance;
    panel_scene p = uncover_panels(gap);
    cscd_line_search *line;
    expect_ok(cscd_line_search_create(p.detector, &line));
    for (int i = 0; i < 5; i++) {
        cscd_free_step step;
        expect_ok(line_begin_packed(line, p.x0, p.x1, 0.0));
        expect_ok(line_max_step_packed(line, 1.0, p.x0, &step));
        assert_true(cscd_detector_waiting(p.detector).features > 0 && step.limited);
        for (uint32_t v = HALF; v < 2 * HALF; v++) p.x1[3 * v + 2] = p.x0[3 * v + 2] - 0.04;
        expect_apart(&p, gap);
    }
    cscd_line_search_destroy(line);
    panels_destroy(&p);
}

TEST(truncation_passes_through_nothing) {
    const double gap = 0.9 * distance;
    panel_scene p = uncover_panels(gap);
    for (int i = 0; i < 5; i++) {
        cscd_truncation found;
        expect_ok(truncate_packed(p.detector, p.x0, p.x1, 1.0, p.x0, &found));
        assert_true(cscd_detector_waiting(p.detector).features > 0);
        for (uint32_t v = HALF; v < 2 * HALF; v++) p.x1[3 * v + 2] = p.x0[3 * v + 2] - 0.04;
        expect_apart(&p, gap);
    }
    panels_destroy(&p);
}

/* A wire, a point over it, and one over that, hidden from each other, and then not: whichever point goes down stays above. */
TEST(points_pass_through_nothing) {
    const double gap = 0.9 * distance;
    const uint32_t wire[2] = {0, 1};
    for (int moving = 2; moving < 4; moving++) {
        const cscd_object_desc objects[] = {cscd_object_of_wires(2, 1, wire), cscd_object_of_points(1),
                                            cscd_object_of_points(1)};
        cscd_object_rule rules[] = {cscd_object_rule_default(), cscd_object_rule_default(),
                                    cscd_object_rule_default()};
        cscd_detector_options options = cscd_detector_defaults();
        panel_scene p = {.vertex_count = 4};
        double x0[12] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 0.0, gap, 0.5, 0.0, 2.0 * gap}, x1[12];
        cscd_free_step step;
        rules[1].mask = 0;
        options.min_separation = distance;
        options.rules = rules;
        options.rule_count = 3;
        assert_int_equal(cscd_context_create(NULL, &p.context), CSCD_OK);
        assert_int_equal(cscd_mesh_create(p.context, objects, 3, &p.mesh), CSCD_OK);
        assert_int_equal(panels_create_detector(&p, &options, &p.detector), CSCD_OK);
        assert_int_equal(max_step_packed(p.detector, x0, x0, NULL, &step), CSCD_OK);
        assert_int_equal(cscd_detector_set_rules(p.detector, NULL, 0, NULL, 0), CSCD_OK);
        for (int i = 0; i < 10; i++) {
            memcpy(x1, x0, sizeof x1);
            x1[3 * moving + 2] -= 0.04;
            assert_int_equal(max_step_packed(p.detector, x0, x1, x0, &step), CSCD_OK);
            assert_true(cscd_detector_waiting(p.detector).features == 2 && step.limited);
            assert_true(x0[3 * moving + 2] - x0[3 * moving - 1] > 0.8 * gap);
        }
        panels_destroy(&p);
    }
}

/* Panels that touch have no side, and part as they want. */
TEST(touching_pairs_are_left_out) {
    panel_scene p = uncover_panels(0.0);
    cscd_free_step step;
    expect_ok(max_step_packed(p.detector, p.x0, p.x1, p.x0, &step));
    assert_true(step.fraction == 1.0 && cscd_detector_waiting(p.detector).features > 0);
    panels_destroy(&p);
}
