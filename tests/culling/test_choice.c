/* Method auto culls where it pays: whatever it chooses, and whenever, results are the same. */
#include "runtime/detector/detector.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

enum { SCENES = PACED(24 * SCENE_FAMILY_COUNT, 4 * SCENE_FAMILY_COUNT) };

enum { INTERVALS = 12 };

static scene s; /* large; one test at a time */
static double path[INTERVALS + 1][SCENE_VERTICES_MAX * 3];

static size_t coordinate_count(void) {
    return (size_t)s.vertex_count * 3;
}

/* To and fro between the ends of the scene's interval, in steps of random length, some of which begin elsewhere. */
static void make_path(random_stream *random) {
    double at = 0.0;
    for (int k = 0; k <= INTERVALS; k++) {
        for (size_t i = 0; i < coordinate_count(); i++) path[k][i] = s.x0[i] + at * (s.x1[i] - s.x0[i]);
        at += stream_between(random, 0.0, 0.5) - (at > 0.6 ? 0.5 : 0.0);
    }
}

static cscd_detector *make_detector(const rig *r, cscd_method method, cscd_mode mode, uint32_t k) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_plan_options plan_options = cscd_plan_defaults();
    cscd_detector *detector = NULL;
    cscd_plan *plan = NULL;
    options.method = method;
    options.mode = mode;
    plan_options.method = CSCD_METHOD_KMEANS;
    plan_options.k = k;
    if (k > 0) assert_int_equal(plan_create_packed(r->mesh, s.x0, &plan_options, &plan), CSCD_OK);
    assert_int_equal(detector_create_here(r->mesh, plan, &options, &detector), CSCD_OK);
    cscd_plan_destroy(plan);
    return detector;
}

/* Makes each component cull, or not, in the next interval. */
static void choose_at_random(cscd_detector *d, random_stream *random) {
    for (uint32_t c = 0; d->known.starts.adapts && c < d->mesh->component_count; c++) {
        component_start *start = &d->known.starts.of[c];
        start->culls = stream_below(random, 2) == 0;
        start->regret = 0.0;
    }
}

static void expect_equal(const cscd_contacts *found, const cscd_contacts *truth) {
    assert_int_equal(found->count, truth->count);
    if (truth->count > 0)
        assert_memory_equal(found->items, truth->items, truth->count * sizeof *truth->items);
}

/* ---- any choice ------------------------------------------------------------------------------------------ */

typedef struct choice_tally {
    size_t contacts, culled, plain, limited;
} choice_tally;

static void compare_steps(const rig *r, cscd_mode mode, uint32_t k, random_stream *random,
                          choice_tally *sum) {
    cscd_detector *truth = make_detector(r, CSCD_METHOD_NONE, mode, 0),
                  *chosen = make_detector(r, CSCD_METHOD_AUTO, mode, k);
    for (int i = 0; i < INTERVALS; i++) {
        cscd_contacts expected, found;
        const double *from = stream_below(random, 4) == 0 ? path[stream_below(random, INTERVALS)] : path[i];
        choose_at_random(chosen, random);
        assert_int_equal(step_packed(truth, from, path[i + 1], &expected), CSCD_OK);
        assert_int_equal(step_packed(chosen, from, path[i + 1], &found), CSCD_OK);
        expect_one_number(chosen, "a path");
        expect_equal(&found, &expected);
        sum->contacts += expected.count;
        bool culled = cscd_detector_counters(chosen).plus + cscd_detector_counters(chosen).minus > 0;
        sum->culled += culled;
        sum->plain += !culled;
    }
    cscd_detector_destroy(truth);
    cscd_detector_destroy(chosen);
}

static bool same_step(const cscd_free_step *a, const cscd_free_step *b) {
    return a->fraction == b->fraction && a->limited == b->limited && a->moved == b->moved &&
           (!a->limited || memcmp(&a->limit, &b->limit, sizeof a->limit) == 0);
}

static void compare_free_steps(const rig *r, uint32_t k, random_stream *random, choice_tally *sum) {
    static double reached[2][SCENE_VERTICES_MAX * 3], from[SCENE_VERTICES_MAX * 3];
    cscd_detector *truth = make_detector(r, CSCD_METHOD_NONE, CSCD_MODE_ALL, 0),
                  *chosen = make_detector(r, CSCD_METHOD_AUTO, CSCD_MODE_ALL, k);
    memcpy(from, path[0], coordinate_count() * sizeof(double));
    for (int i = 0; i < INTERVALS; i++) {
        cscd_free_step expected, found;
        choose_at_random(chosen, random);
        cscd_status status = max_step_packed(truth, from, path[i + 1], reached[0], &expected);
        assert_int_equal(max_step_packed(chosen, from, path[i + 1], reached[1], &found), status);
        assert_true(same_step(&found, &expected));
        if (status != CSCD_OK) break;
        assert_memory_equal(reached[1], reached[0], coordinate_count() * sizeof(double));
        sum->limited += expected.limited;
        memcpy(from, reached[0], coordinate_count() * sizeof(double));
    }
    cscd_detector_destroy(truth);
    cscd_detector_destroy(chosen);
}

TEST(any_choice_gives_the_same) {
    choice_tally sum = {0};
    for (uint32_t seed = 0; seed < SCENES; seed++) {
        random_stream random = stream_start(seed);
        scene_make((scene_family)(seed % SCENE_FAMILY_COUNT), seed + 80000, &s);
        make_path(&random);
        rig r = rig_create(&s, 1 + seed % 3, NULL);
        uint32_t k = seed % 5 < 3 ? 0 : seed % 5;
        compare_steps(&r, CSCD_MODE_ALL, k, &random, &sum);
        compare_steps(&r, CSCD_MODE_EARLIEST, k, &random, &sum);
        compare_free_steps(&r, k, &random, &sum);
        rig_destroy(&r);
    }
    print_message("  %zu contacts; %zu intervals culled, %zu not; %zu steps limited\n", sum.contacts,
                  sum.culled, sum.plain, sum.limited);
    assert_true(sum.contacts > 0 && 10 * sum.culled > sum.plain && 10 * sum.plain > sum.culled &&
                sum.limited > 0);
}

/* ---- its own choice -------------------------------------------------------------------------------------- */

static bool step_culls(cscd_detector *d, const double *from, const double *to) {
    cscd_contacts found;
    assert_int_equal(step_packed(d, from, to, &found), CSCD_OK);
    return cscd_detector_counters(d).plus > 0;
}

/* A sphere that begins each interval elsewhere is not worth its proof; one that goes on is, again and again. */
TEST(culling_follows_the_motion) {
    static const double origin[3] = {0, 0, 0};
    scene_clear(&s);
    scene_add_sphere(&s, origin, 1.0, 24, 30);
    for (int k = 0; k <= INTERVALS; k++)
        for (size_t i = 0; i < coordinate_count(); i++) path[k][i] = s.x0[i] * (1.0 + 0.01 * k);
    rig r = rig_create(&s, 1, NULL);
    cscd_detector *d = make_detector(&r, CSCD_METHOD_AUTO, CSCD_MODE_ALL, 0);
    for (int round = 0; round < 2; round++) {
        uint32_t until = 0;
        while (step_culls(d, path[0], path[1])) assert_true(++until < 10);
        for (int i = 0; i < 20; i++) assert_false(step_culls(d, path[0], path[1]));
        const double *at = d->known.starts.positions;
        uint32_t tries = 0;
        for (;; tries++) { /* on the spot */
            memcpy(s.x1, at, coordinate_count() * sizeof(double));
            if (step_culls(d, s.x1, s.x1)) break;
            assert_true(tries < 40);
        }
        for (int i = 0; i < 20; i++) assert_true(step_culls(d, s.x1, s.x1));
    }
    cscd_detector_destroy(d);
    rig_destroy(&r);
}

/* A torus of so many triangles that workers share them; it is pressed flat and bent. */
static void make_large_scene(void) {
    static const double origin[3] = {0, 0, 0};
    scene_clear(&s);
    scene_add_torus(&s, origin, 1.0, 0.4, 44, 22, false);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        const double *p = s.x0 + (size_t)v * 3;
        double *q = s.x1 + (size_t)v * 3;
        q[0] = p[0] * (p[0] > 0.0 ? 0.5 : 1.0);
        q[2] = p[2] * 0.1 + 0.3 * p[0] * p[0];
    }
}

/* The choice rests on counts, which the workers share. */
TEST(counters_do_not_depend_on_threads) {
    for (uint32_t seed = 0; seed < SCENES / 4; seed++) {
        random_stream random = stream_start(seed);
        scene_make((scene_family)(seed % SCENE_FAMILY_COUNT), seed + 90000, &s);
        if (seed < 4) make_large_scene();
        make_path(&random);
        rig rigs[3];
        cscd_detector *detectors[3];
        for (uint32_t i = 0; i < 3; i++) {
            rigs[i] = rig_create(&s, i == 2 ? 16 : i + 1, NULL);
            detectors[i] = make_detector(&rigs[i], CSCD_METHOD_AUTO,
                                         seed % 3 == 0 ? CSCD_MODE_EARLIEST : CSCD_MODE_ALL, 0);
        }
        for (int k = 0; k < INTERVALS; k++) {
            cscd_counters counters[3];
            for (int i = 0; i < 3; i++) {
                cscd_contacts found;
                assert_int_equal(step_packed(detectors[i], path[k], path[k + 1], &found), CSCD_OK);
                counters[i] = cscd_detector_counters(detectors[i]);
                assert_memory_equal(&counters[i], &counters[0], sizeof counters[0]);
                for (uint32_t c = 0; c < detectors[i]->mesh->component_count; c++)
                    assert_true(
                        detectors[i]->known.starts.of[c].kept == detectors[0]->known.starts.of[c].kept &&
                        detectors[i]->known.starts.of[c].regret == detectors[0]->known.starts.of[c].regret);
            }
        }
        for (int i = 0; i < 3; i++) {
            cscd_detector_destroy(detectors[i]);
            rig_destroy(&rigs[i]);
        }
    }
}
