/* Contacts under rules for objects, against brute force over features that knows neither trees nor rules. Pairs that
 * new rules uncover while they touch wait. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/object_scene.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <string.h>

enum { SCENES = NIGHTLY(4, 10), MANY = 60, STEPS = 5 };

static void check_guarantees(const rig *s, const random_rules *set, rules_tally *sum) {
    for (uint32_t t = 0; t < objects_joined.triangle_count; t++) {
        uint32_t i = objects_of_vertices[objects_joined.triangles[(size_t)t * 3]];
        uint32_t component = cscd_mesh_triangle_component(s->mesh, t);
        cscd_guarantee g = cscd_detector_guarantee(s->detector, component);
        bool own_thickness = set->distances[i * SCENE_OBJECTS + i] > 0.0, obstacle = set->obstacles[i];
        bool masked = !set->objects[i].self && !obstacle, thick = false;
        assert_true((g.reason == CSCD_REASON_MASK) == masked);
        if (masked) assert_true(!g.complete && !g.start_embedded);
        if (masked || own_thickness || obstacle)
            assert_int_equal(cscd_detector_orientation(s->detector, t), 0);
        for (int k = 0; k < SCENE_OBJECTS; k++) thick |= set->distances[i * SCENE_OBJECTS + (size_t)k] > 0.0;
        bool culled = cscd_detector_orientation(s->detector, t) != 0;
        sum->masked += masked;
        sum->culled += culled;
        sum->thick_and_culled += culled && thick;
        sum->embedded += g.start_embedded;
    }
}

/* The rules of one sequence, one after the other: the oracle reads those of before, too. */
static random_rules rules_given[3 * STEPS + 1];
static int rules_count;

static left_out left_out_by(const random_rules *set) {
    assert_true(rules_count < 3 * STEPS + 1);
    random_rules *given = &rules_given[rules_count++];
    *given = *set;
    return (left_out){.rules = {objects_of_vertices, SCENE_OBJECTS, given->distances}};
}

static void give_rules(const rig *s, const random_rules *set, waiting_oracle *oracle) {
    const left_out now = left_out_by(set);
    rules_set(s->detector, set);
    waiting_oracle_change(oracle, &now);
}

static void compare_step(const rig *s, const random_rules *set, waiting_oracle *oracle, oracle_list *truth,
                         rules_tally *sum) {
    cscd_contacts found;
    waiting_oracle_see(oracle, objects_motion.x0, true);
    oracle_find_by_rules(&objects_motion, &oracle->now.what.rules, truth);
    waiting_oracle_filter(oracle, truth);
    expect_ok(step_packed(s->detector, objects_motion.x0, objects_motion.x1, &found));
    rules_rig_compare(s, truth, &found, sum);
    assert_int_equal(cscd_detector_waiting(s->detector).features, waiting_oracle_features(oracle));
    check_guarantees(s, set, sum);
}

/* Small steps, mostly without contact, and large ones; most go on from the end of the one before. */
static void next_motion(random_stream *random, double *at) {
    uint32_t kind = stream_below(random, 4);
    double end = *at + (kind < 2 ? 0.02 : stream_between(random, 0.1, 0.6));
    if (kind == 3) *at = 0.0;
    if (kind == 3 || end > 1.0) end = *at == 0.0 ? 1.0 : 0.3;
    object_scene_go(*at, end);
    *at = stream_below(random, 6) == 0 ? 0.0 : end;
}

/* What a check has proven holds under other rules. */
static void check_with_other_rules(const rig *s, random_stream *random, const random_rules *now,
                                   waiting_oracle *oracle) {
    random_rules other = *now;
    cscd_intersections found;
    if (stream_below(random, 2) == 0) random_rules_make(random, stream_below(random, 3), &other);
    give_rules(s, &other, oracle);
    waiting_oracle_see(oracle, objects_motion.x0, true);
    expect_ok(check_packed(s->detector, objects_motion.x0, &found));
    assert_int_equal(cscd_detector_waiting(s->detector).triangles, waiting_oracle_triangles(oracle));
}

static void run_sequence(uint64_t seed, cscd_detector_options options, uint32_t threads, rules_tally *sum) {
    random_stream random = stream_start(seed);
    random_rules set;
    oracle_list truth = {0};
    double at = 0.0;
    object_scene_make(&random);
    for (int i = 0; i < SCENE_OBJECTS; i++) set.obstacles[i] = stream_below(&random, 4) == 0;
    random_rules_neutral(&set);
    rig s = rules_rig(&set, &options, threads);
    rules_count = 0;
    const left_out first = left_out_by(&set);
    waiting_oracle oracle = waiting_oracle_start(s.mesh, &objects_joined, &first);
    for (int step = 0; step < STEPS; step++) {
        if (stream_below(&random, 4) == 0)
            random_rules_neutral(&set);
        else if (step == 0 || stream_below(&random, 3) > 0)
            random_rules_make(&random, stream_below(&random, 3), &set);
        next_motion(&random, &at);
        if (stream_below(&random, 3) == 0) check_with_other_rules(&s, &random, &set, &oracle);
        give_rules(&s, &set, &oracle);
        compare_step(&s, &set, &oracle, &truth, sum);
    }
    waiting_oracle_free(&oracle);
    oracle_free(&truth);
    rig_destroy(&s);
}

static rules_tally run_method(cscd_method method, cscd_mode mode, int sequences, uint64_t seed) {
    rules_tally sum = {0};
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.mode = mode;
    for (int i = 0; i < sequences; i++) {
        options.volume = i % 2 == 0 ? CSCD_VOLUME_BOX : CSCD_VOLUME_KDOP14;
        run_sequence(seed + (uint64_t)i, options, 1 + (uint32_t)i % 3, &sum);
    }
    print_message("  %s, %s: %zu contacts, %zu culled (%zu beside a distance), %zu masked, %zu left out\n",
                  cscd_method_name(method), cscd_name(CSCD_MODES, mode), sum.contacts, sum.culled,
                  sum.thick_and_culled, sum.masked, sum.later);
    assert_true(sum.contacts > 1000 && sum.masked > 100);
    return sum;
}

TEST(without_culling_as_brute_force) {
    run_method(CSCD_METHOD_NONE, CSCD_MODE_ALL, SCENES, 0);
    run_method(CSCD_METHOD_BRUTE, CSCD_MODE_ALL, 2, 100);
    run_method(method_or_none(CSCD_METHOD_ICCD), CSCD_MODE_ALL, SCENES / 2, 200);
}

TEST(with_culling_as_brute_force) {
    rules_tally single = run_method(CSCD_METHOD_SINGLE, CSCD_MODE_ALL, SCENES, 3000);
    rules_tally kmeans = run_method(CSCD_METHOD_KMEANS, CSCD_MODE_ALL, SCENES / 2, 400);
    rules_tally earliest = run_method(CSCD_METHOD_SINGLE, CSCD_MODE_EARLIEST, SCENES, 3000);
    assert_true(single.culled > 1000 && single.thick_and_culled > 500 && kmeans.culled > 500);
    assert_true(earliest.later > 0);
}

/* ---- many objects, and what is known of masked ones ---------------------------------------------------- */

static double many_distances[2][MANY * MANY]; /* of the rules of now and of before, by turns */
static cscd_object_rule many_rules[MANY];

/* Small spheres in one box, so that trees of many objects are joined in blocks. */
static void make_many(random_stream *random, cscd_object_desc *descs) {
    scene_clear(&objects_joined);
    for (uint32_t i = 0; i < MANY; i++) {
        double centre[3], velocity[3];
        uint32_t first = objects_joined.vertex_count, triangle = objects_joined.triangle_count;
        for (int k = 0; k < 3; k++) centre[k] = stream_between(random, -1.0, 1.0);
        for (int k = 0; k < 3; k++) velocity[k] = stream_between(random, -0.3, 0.3);
        scene_add_sphere(&objects_joined, centre, 0.25, 2, 4);
        for (uint32_t v = first; v < objects_joined.vertex_count; v++) {
            objects_of_vertices[v] = i;
            for (uint32_t k = 0; k < 3; k++) objects_joined.x1[v * 3 + k] += velocity[k];
        }
        for (uint32_t k = triangle * 3; k < objects_joined.triangle_count * 3; k++)
            objects_triangles[k] = objects_joined.triangles[k] - first;
        descs[i] = cscd_object_of_triangles(objects_joined.vertex_count - first,
                                            objects_joined.triangle_count - triangle,
                                            objects_triangles + triangle * 3);
    }
}

/* Every object has a rule of its own. */
static void make_many_rules(random_stream *random, double *distances) {
    for (uint32_t i = 0; i < MANY; i++) {
        many_rules[i] = cscd_object_rule_default();
        many_rules[i].category = (uint64_t)1 << i;
        many_rules[i].mask = stream_bits(random) & stream_bits(random) & stream_bits(random);
        many_rules[i].thickness = i % 2 == 0 ? 0.0 : stream_between(random, 0.0, 0.05);
    }
    for (uint32_t a = 0; a < MANY; a++) {
        for (uint32_t b = 0; b < MANY; b++) {
            const cscd_object_rule *p = &many_rules[a], *q = &many_rules[b];
            bool looks = a == b || ((p->category & q->mask) != 0 && (q->category & p->mask) != 0);
            distances[a * MANY + b] = looks ? 0.5 * p->thickness + 0.5 * q->thickness : -1.0;
        }
    }
}

TEST(many_objects_with_a_rule_each) {
    cscd_object_desc descs[MANY];
    random_stream random = stream_start(1);
    oracle_list truth = {0};
    rules_tally sum = {0};
    size_t waiting = 0;
    make_many(&random, descs);
    rig s = rig_of_objects(context_of(0, NULL), descs, MANY, NULL, NULL);
    left_out now = {.rules = {objects_of_vertices, MANY, many_distances[1]}};
    waiting_oracle oracle = waiting_oracle_start(s.mesh, &objects_joined, &now);
    for (int step = 0; step < 6; step++) {
        cscd_contacts found;
        now.rules.distances = many_distances[step % 2];
        make_many_rules(&random, many_distances[step % 2]);
        waiting_oracle_change(&oracle, &now);
        waiting_oracle_see(&oracle, objects_joined.x0, true);
        expect_ok(cscd_detector_set_rules(s.detector, many_rules, MANY, NULL, 0));
        oracle_find_by_rules(&objects_joined, &now.rules, &truth);
        waiting_oracle_filter(&oracle, &truth);
        expect_ok(step_packed(s.detector, objects_joined.x0, objects_joined.x1, &found));
        rules_rig_compare(&s, &truth, &found, &sum);
        assert_int_equal(cscd_detector_waiting(s.detector).features, waiting_oracle_features(&oracle));
        waiting += cscd_detector_waiting(s.detector).features;
    }
    assert_true(sum.contacts > 100 && waiting > 10);
    waiting_oracle_free(&oracle);
    oracle_free(&truth);
    rig_destroy(&s);
}

/* A check of an object with self = false proves nothing of it, so a later step must not believe that it is embedded. */
TEST(masked_objects_are_not_proven) {
    size_t crossing = 0;
    for (uint64_t seed = 0; seed < 12; seed++) {
        cscd_detector_options options = cscd_detector_defaults();
        oracle_list truth = {0};
        cscd_contacts found;
        cscd_intersections listed;
        rules_tally sum = {0};
        cscd_object_rule rule = cscd_object_rule_default();
        scene_make(SCENE_SPIKE, seed, &objects_joined);
        for (uint32_t k = 0; k < objects_joined.vertex_count * 3; k++) {
            double step = objects_joined.x1[k] - objects_joined.x0[k];
            objects_joined.x0[k] = objects_joined.x1[k];
            objects_joined.x1[k] += 0.3 * step;
        }
        options.method = CSCD_METHOD_SINGLE;
        rig s = rig_create(&objects_joined, 0, &options);
        rule.self = false;
        expect_ok(cscd_detector_set_rules(s.detector, &rule, 1, NULL, 0));
        expect_ok(check_packed(s.detector, objects_joined.x0, &listed));
        assert_int_equal(listed.count, 0);
        rule.self = true;
        expect_ok(cscd_detector_set_rules(s.detector, &rule, 1, NULL, 0));
        oracle_find(&objects_joined, &truth);
        expect_ok(step_packed(s.detector, objects_joined.x0, objects_joined.x1, &found));
        rules_rig_compare(&s, &truth, &found, &sum);
        crossing += !cscd_detector_guarantee(s.detector, 0).start_embedded;
        assert_int_equal(cscd_detector_counters(s.detector).static_checks, 1);
        oracle_free(&truth);
        rig_destroy(&s);
    }
    assert_true(crossing > 0);
}
