/* Intersections summed up by pair of parts: against sums that look at every list anew for every pair of parts. */
#include "tests/support/calls.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <math.h>

static body_rig rig; /* large; one test at a time */
static labelling labels;

/* ---- sums ------------------------------------------------------------------------------------------------ */

TEST(objects_are_parts_by_default) {
    labelled_scene_open(&rig, NULL, 2);
    labelled_scene_find(&rig);
    labelling_of_objects(&labels, &rig);
    assert_int_equal(labelling_compare(&labels, &rig), 5);
    labelling_draw(&labels, &rig, 3, 1);
    labelling_set(&labels, &rig);
    labelled_scene_find(&rig);
    labelling_compare(&labels, &rig);
    expect_ok(cscd_detector_set_parts(rig.detector, NULL, 0));
    labelled_scene_find(&rig);
    labelling_of_objects(&labels, &rig);
    assert_int_equal(labelling_compare(&labels, &rig), 5);
}

TEST(parts_of_the_caller) {
    static const uint32_t counts[4] = {1, 2, 7, 40};
    size_t pairs = 0;
    for (uint32_t i = 0; i < 4; i++) {
        labelled_scene_open(&rig, NULL, 1 + i);
        labelling_draw(&labels, &rig, counts[i], i);
        labelling_set(&labels, &rig);
        labelled_scene_find(&rig);
        pairs += labelling_compare(&labels, &rig);
    }
    print_message("  %zu pairs of parts\n", pairs);
    assert_true(pairs > 300);
}

/* A curve that runs through several pairs of parts is one of each, and its length is shared. */
TEST(components_and_regions) {
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    options.method = CSCD_METHOD_KMEANS;
    options.k = 12;
    labelled_scene_open(&rig, NULL, 2);
    labels.count = cscd_mesh_component_count(rig.mesh);
    assert_int_equal(labels.count, 4);
    for (uint32_t t = 0; t < rig.all.triangle_count; t++) {
        labels.items[t] = cscd_mesh_array(rig.mesh, CSCD_TRIANGLE_COMPONENTS)[t];
        assert_int_equal(labels.items[t], cscd_mesh_triangle_component(rig.mesh, t));
    }
    labelling_set(&labels, &rig);
    labelled_scene_find(&rig);
    size_t of_components = labelling_compare(&labels, &rig);
    expect_ok(plan_create_packed(rig.mesh, rig.all.x0, &options, &plan));
    labels.count = cscd_plan_region_count(plan);
    for (uint32_t t = 0; t < rig.all.triangle_count; t++)
        labels.items[t] = cscd_plan_triangle_region(plan, t);
    cscd_plan_destroy(plan);
    labelling_set(&labels, &rig);
    labelled_scene_find(&rig);
    assert_true(labelling_compare(&labels, &rig) > of_components);
    double length = 0.0, sum = 0.0;
    size_t curves = 0;
    for (size_t i = 0; i < rig.found.curves->count; i++) length += rig.found.curves->items[i].length;
    for (size_t i = 0; i < rig.found.parts->count; i++) {
        sum += rig.found.parts->items[i].length;
        curves += rig.found.parts->items[i].curves;
    }
    assert_true(fabs(sum - length) < 1e-12 * length && curves > rig.found.curves->count);
}

/* The numbers of the guide: the corner of a small box in a large one. */
TEST(two_boxes_by_hand) {
    static const double low[2][3] = {{0, 0, 0}, {1.5, 0.5, 1.75}}, sizes[2][3] = {{2, 2, 2}, {1, 1, 1}};
    body_rig_begin(&rig);
    for (int i = 0; i < 2; i++) {
        body_rig_box(&rig, low[i], sizes[i]);
    }
    body_rig_create(&rig, NULL, 1);
    labelled_scene_find(&rig);
    assert_int_equal(rig.found.parts->count, 1);
    const cscd_part_pair *pair = rig.found.parts->items;
    assert_true(pair->a == 0 && pair->b == 1 && pair->crossing == rig.found.crossing);
    assert_int_equal(pair->curves, 1);
    assert_int_equal(pair->touching_curves, 0);
    assert_true(fabs(pair->length - 3.5) < 1e-12 && fabs(pair->depth - 0.25) < 1e-12);
    assert_true(rig.found.depths->items[pair->deepest].depth == pair->depth);
    assert_int_equal(pair->faces[0] + pair->faces[1], rig.found.parts->faces);
    assert_true(pair->faces[0] == 3 && pair->faces[1] == 8);
    assert_true(pair->shares[0] == (double)pair->faces[0] / 12.0);
}

/* ---- other questions --------------------------------------------------------------------------------------- */

TEST(sums_are_of_the_list) {
    size_t before = 0;
    labelled_scene_open(&rig, NULL, 2);
    labelling_draw(&labels, &rig, 4, 9);
    labelling_set(&labels, &rig);
    for (int i = 0; i < 4; i++) {
        cscd_intersection_options options = cscd_intersection_defaults();
        if (i == 0) options.kinds = cscd_intersection_set(CSCD_INTERSECTION_CROSSING);
        if (i == 1) options.stop_after = 20;
        if (i == 2) options.kinds = cscd_intersection_set(CSCD_INTERSECTION_DUPLICATE);
        options.curves = i == 3;
        expect_ok(labelled_scene_try(&rig, options));
        assert_true(rig.found.depths == NULL);
        size_t pairs = labelling_compare(&labels, &rig);
        assert_true(i == 2 ? pairs == 0 && rig.found.parts->share == 0.0 : pairs > 0);
        before += pairs;
    }
    cscd_intersection_options plain = cscd_intersection_defaults();
    expect_ok(find_intersections_packed(rig.detector, rig.all.x0, &plain, &rig.found));
    assert_true(rig.found.parts == NULL && before > 0);
    for (int i = CSCD_ANSWER_COUNT; i <= CSCD_ANSWER_ANY; i++) {
        plain.answer = (cscd_intersection_answer)i;
        assert_int_equal(labelled_scene_try(&rig, plain), CSCD_INVALID_ARGUMENT);
        assert_string_equal(cscd_context_detail(rig.context), "parts need a list of pairs: answer LIST");
    }
}

TEST(masked_objects_are_in_no_pair) {
    cscd_object_rule rules[3] = {cscd_object_rule_default(), cscd_object_rule_default(),
                                 cscd_object_rule_default()};
    cscd_detector_options options = cscd_detector_defaults();
    rules[2].mask = 0;
    rules[2].self = false;
    options.rules = rules;
    options.rule_count = 3;
    labelled_scene_open(&rig, &options, 2);
    labelled_scene_find(&rig);
    labelling_of_objects(&labels, &rig);
    assert_int_equal(labelling_compare(&labels, &rig), 3);
    for (size_t i = 0; i < 3; i++) assert_true(rig.found.parts->items[i].b < 2);
}

/* A body that is wholly inside another one intersects nothing, and has a depth. */
TEST(a_swallowed_body_is_listed) {
    static const double low[2][3] = {{0, 0, 0}, {1, 1, 1}}, sizes[2][3] = {{4, 4, 4}, {1, 1, 1.5}};
    body_rig_begin(&rig);
    for (int i = 0; i < 2; i++) {
        body_rig_box(&rig, low[i], sizes[i]);
    }
    body_rig_create(&rig, NULL, 1);
    labelled_scene_find(&rig);
    labelling_of_objects(&labels, &rig);
    assert_int_equal(rig.found.count, 0);
    assert_int_equal(labelling_compare(&labels, &rig), 1);
    const cscd_part_pair *pair = &rig.found.parts->items[0]; /* deepest on an edge, at (2, 2, 2) */
    assert_true(pair->depth <= 2.0 && pair->bound >= 2.0 && pair->bound <= 1.01 * pair->depth);
}

AROUND_EACH(NULL, body_rigs_free)
