/* Rules for objects beside contacts: moments, line searches, and what is refused. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/object_scene.h"
#include "tests/support/panels.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

/* ---- moments ------------------------------------------------------------------------------------------- */

static bool vertices_look(const random_rules *set, uint32_t a, uint32_t b) {
    return set->distances[objects_of_vertices[a] * SCENE_OBJECTS + objects_of_vertices[b]] >= 0.0;
}

/* The lists are those without rules, without the pairs that are not looked at. Thickness has no part in them. */
static void compare_moment(const rig *all, const rig *s, const random_rules *set, size_t *sum) {
    cscd_proximities truth, found;
    cscd_intersections crossing, listed;
    size_t next = 0;
    expect_ok(find_near_packed(all->detector, objects_motion.x1, 0.08, &truth));
    expect_ok(find_near_packed(s->detector, objects_motion.x1, 0.08, &found));
    for (size_t i = 0; i < truth.count; i++) {
        const cscd_proximity *t = &truth.items[i];
        if (!vertices_look(set, t->vertices[0], t->vertices[3])) continue;
        assert_true(next < found.count);
        expect_alike_but_separation(&found.items[next++], t);
    }
    assert_int_equal(next, found.count);
    sum[0] += found.count;
    sum[1] += truth.count - found.count;
    next = 0;
    expect_ok(check_packed(all->detector, objects_motion.x1, &crossing));
    expect_ok(check_packed(s->detector, objects_motion.x1, &listed));
    assert_int_equal(crossing.zero_area_triangles, listed.zero_area_triangles);
    for (size_t i = 0; i < crossing.count; i++) {
        const uint32_t *a = objects_joined.triangles + (size_t)crossing.items[i].a * 3;
        const uint32_t *b = objects_joined.triangles + (size_t)crossing.items[i].b * 3;
        if (!vertices_look(set, a[0], b[0])) continue;
        assert_true(next < listed.count);
        assert_memory_equal(&listed.items[next++], &crossing.items[i], sizeof *listed.items);
    }
    assert_int_equal(next, listed.count);
    sum[2] += listed.count;
    sum[3] += crossing.count - listed.count;
}

TEST(moments_leave_out_what_is_masked) {
    size_t sum[4] = {0};
    const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_BRUTE, CSCD_METHOD_SINGLE,
                                   method_or_none(CSCD_METHOD_ICCD_PUBLISHED)};
    for (uint64_t seed = 0; seed < 12; seed++) {
        random_stream random = stream_start(500 + seed);
        random_rules set, neutral;
        cscd_detector_options options = cscd_detector_defaults();
        object_scene_make(&random);
        for (int i = 0; i < SCENE_OBJECTS; i++) set.obstacles[i] = stream_below(&random, 4) == 0;
        memset(neutral.obstacles, 0, sizeof neutral.obstacles);
        random_rules_neutral(&neutral);
        rig all = rules_rig(&neutral, &options, 1);
        options.method = methods[seed % 4];
        options.ours = ours_of_method(options.method);
        options.rules = set.objects;
        options.rule_count = SCENE_OBJECTS;
        for (uint32_t kind = 0; kind < 3; kind++) {
            random_rules_make(&random, kind, &set);
            options.thickness_matrix = set.uses_matrix ? set.matrix : NULL;
            options.thickness_class_count = set.uses_matrix ? RULE_CLASSES : 0;
            rig s = rules_rig(&set, &options, 2);
            object_scene_go(0.0, 0.5 * kind);
            compare_moment(&all, &s, &set, sum);
            rig_destroy(&s);
        }
        rig_destroy(&all);
    }
    print_message("  %zu near and %zu not, %zu crossing and %zu not\n", sum[0], sum[1], sum[2], sum[3]);
    for (int i = 0; i < 4; i++) assert_true(sum[i] > 500);
}

/* ---- what is refused ----------------------------------------------------------------------------------- */

_Static_assert(sizeof(cscd_object_rule) == 32, "a rule never grows, and does not end in padding");

static void refuse_rules(cscd_detector *d, const cscd_object_rule *rules, uint32_t count,
                         const double *matrix, uint32_t classes, const char *says) {
    expect_invalid(cscd_mesh_context(cscd_detector_mesh(d)),
                   cscd_detector_set_rules(d, rules, count, matrix, classes), says);
}

TEST(mistakes_have_a_sentence) {
    random_rules set;
    random_stream random = stream_start(9);
    cscd_detector_options options = cscd_detector_defaults();
    object_scene_make(&random);
    memset(set.obstacles, 0, sizeof set.obstacles);
    random_rules_neutral(&set);
    rig s = rules_rig(&set, &options, 1);
    cscd_object_rule *rule = &set.objects[1];
    static double matrix[257 * 257];
    refuse_rules(s.detector, set.objects, 3, NULL, 0,
                 "there are 3 rules, expected none or one for each of the 4 objects");
    refuse_rules(s.detector, NULL, SCENE_OBJECTS, NULL, 0, "rules is NULL");
    refuse_rules(s.detector, set.objects, 0, NULL, 0, "rules are given, but rule_count is 0");
    refuse_rules(s.detector, NULL, 0, matrix, 257, "1 to 256 classes");
    refuse_rules(s.detector, NULL, 0, NULL, 2, "thickness_matrix is NULL");
    matrix[1] = 0.5;
    refuse_rules(s.detector, NULL, 0, matrix, 2, "make it symmetric");
    matrix[1] = -1.0;
    refuse_rules(s.detector, NULL, 0, matrix, 2, "thickness_matrix has -1 for classes 0 and 1");
    matrix[1] = matrix[2] = 0.5;
    rule->thickness = 0.1;
    refuse_rules(s.detector, set.objects, SCENE_OBJECTS, matrix, 2, "object 1 has a thickness of 0.1, but");
    rule->thickness = NAN;
    refuse_rules(s.detector, set.objects, SCENE_OBJECTS, NULL, 0, "object 1 has a thickness of nan");
    rule->thickness = 0.0;
    rule->thickness_class = 2;
    refuse_rules(s.detector, set.objects, SCENE_OBJECTS, matrix, 2,
                 "object 1 has the thickness_class 2, but there are 2");
    rule->thickness_class = 0;
    rule->reserved = 1;
    refuse_rules(s.detector, set.objects, SCENE_OBJECTS, NULL, 0, "reserved is 1");
    rule->reserved = 0;
    expect_ok(cscd_detector_set_separation(s.detector, 0.1, 0.0));
    refuse_rules(s.detector, NULL, 0, matrix, 2, "min_separation is 0.1, but");
    expect_ok(cscd_detector_set_separation(s.detector, 0.0, 0.0));
    expect_ok(cscd_detector_set_rules(s.detector, NULL, 0, matrix, 2));
    assert_int_equal(cscd_detector_set_separation(s.detector, 0.1, 0.0), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_detector_set_rules(NULL, NULL, 0, NULL, 0), CSCD_NULL_OBJECT);
    rig_destroy(&s);
}

/* Candidates were collected under the rules of the begin. What is masked limits nothing. */
TEST(lines_begin_again_after_new_rules) {
    random_rules set;
    random_stream random = stream_start(10);
    cscd_detector_options options = cscd_detector_defaults();
    cscd_line_search *line;
    cscd_free_step step;
    cscd_proximities near;
    object_scene_make(&random);
    memset(set.obstacles, 0, sizeof set.obstacles);
    random_rules_neutral(&set);
    rig s = rules_rig(&set, &options, 1);
    expect_ok(cscd_line_search_create(s.detector, &line));
    expect_ok(line_begin_packed(line, objects_joined.x0, objects_joined.x1, 0.01));
    for (int i = 0; i < SCENE_OBJECTS; i++) {
        set.objects[i].mask = 0;
        set.objects[i].self = false;
        set.objects[i].thickness = 0.1;
    }
    rules_set(s.detector, &set);
    assert_int_equal(line_max_step_packed(line, 1.0, NULL, &step), CSCD_INVALID_ARGUMENT);
    expect_invalid(s.context, cscd_line_search_find_near(line, 0.5, 0.01, CSCD_NEAR_PAIRS, &near),
                   "call cscd_line_search_begin again");
    expect_ok(line_begin_packed(line, objects_joined.x0, objects_joined.x1, 0.01));
    assert_int_equal(cscd_line_search_candidate_count(line), 0);
    expect_ok(line_max_step_packed(line, 1.0, NULL, &step));
    assert_true(step.fraction == 1.0 && !step.limited);
    expect_ok(max_step_packed(s.detector, objects_joined.x0, objects_joined.x1, NULL, &step));
    assert_true(step.fraction == 1.0 && !step.limited);
    cscd_line_search_destroy(line);
    rig_destroy(&s);
}

/* ---- what is known of starts --------------------------------------------------------------------------- */

/* Nobody looks at a masked object with itself any more, so what was proven of it is not kept. */
TEST(nothing_is_known_of_what_is_masked) {
    static scene spheres; /* large */
    cscd_detector_options options = cscd_detector_defaults();
    cscd_object_rule rule = cscd_object_rule_default();
    cscd_intersections found;
    options.method = CSCD_METHOD_SINGLE;
    scene_make(SCENE_TWO_SPHERES, 1, &spheres);
    rig r = rig_create(&spheres, 1, &options);
    const uint32_t triangles = cscd_mesh_component(r.mesh, 0).triangle_count;
    expect_ok(check_packed(r.detector, spheres.x0, &found));
    assert_int_equal(start_states_in(r.detector, 0, TRIANGLE_CLEAN), triangles);
    rule.self = false;
    expect_ok(cscd_detector_set_rules(r.detector, &rule, 1, NULL, 0));
    assert_int_equal(start_states_in(r.detector, 0, TRIANGLE_UNKNOWN), triangles);
    rig_destroy(&r);
}
