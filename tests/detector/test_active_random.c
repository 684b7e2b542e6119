/* Active vertices in random scenes and sequences: steps against brute force, and every call against a detector that looks at
 * everything and leaves out what is not active. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/active_twins.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/loose/loose_scene.h"
#include "tests/support/object_scene.h"
#include "tests/support/oracle.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <string.h>

static active_twins twins; /* large, as the others; one test at a time */
static scene s;
static sequence recording;
static loose_scene loose;

static const cscd_method methods[] = {CSCD_METHOD_NONE,   CSCD_METHOD_SINGLE, CSCD_METHOD_KMEANS,
                                      CSCD_METHOD_CHARGE, CSCD_METHOD_BRUTE,  CSCD_METHOD_ICCD};
enum { METHODS = sizeof methods / sizeof *methods };

/* Of the numbers of a scene, each option another digit. */
static cscd_detector_options options_for(uint64_t seed) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method_or_none(methods[seed % METHODS]);
    options.mode = seed / METHODS % 2 == 0 ? CSCD_MODE_ALL : CSCD_MODE_EARLIEST;
    options.volume = seed / 5 % 2 == 0 ? CSCD_VOLUME_BOX : CSCD_VOLUME_KDOP14;
    return options;
}

static rig make_detector(const scene *of, const cscd_detector_options *options, uint64_t seed) {
    rig r = {NULL};
    cscd_context_options context_options = cscd_context_defaults();
    context_options.thread_count = 1 + (uint32_t)(seed % 3);
    context_options.simd = seed % 4 == 1 ? CSCD_SIMD_SCALAR : CSCD_SIMD_AUTO;
    expect_ok(cscd_context_create(&context_options, &r.context));
    r.mesh = mesh_of_scene(r.context, of);
    if (options->method == CSCD_METHOD_KMEANS || options->method == CSCD_METHOD_CHARGE) {
        cscd_plan_options plan = cscd_plan_defaults();
        plan.method = options->method;
        expect_ok(plan_create_packed(r.mesh, of->x0, &plan, &r.plan));
    }
    expect_ok(detector_create_here(r.mesh, r.plan, options, &r.detector));
    return r;
}

/* ---- steps against the oracle ------------------------------------------------------------------------- */

/* Removes what is not looked at; returns how much. */
static size_t filter_truth(const active_twins *t, oracle_list *truth) {
    size_t kept = 0, all = truth->count;
    for (size_t i = 0; i < all; i++) {
        const oracle_contact *c = &truth->items[i];
        if (active_twins_look_at(t, c->kind, c->a, c->b)) truth->items[kept++] = *c;
    }
    truth->count = kept;
    return all - kept;
}

static bool same_contact(const oracle_contact *t, const cscd_contact *f) {
    return f->kind == t->kind && f->a == t->a && f->b == t->b && f->toi == t->toi;
}

/* In mode EARLIEST a part of the list, which begins at the same time. Returns how many are missing. */
static size_t compare_with_truth(const oracle_list *truth, const cscd_contacts *found, bool earliest) {
    size_t next = 0;
    for (size_t i = 0; i < truth->count; i++) {
        bool same = next < found->count && same_contact(&truth->items[i], &found->items[next]);
        assert_true(same || earliest);
        next += same;
    }
    assert_int_equal(next, found->count);
    if (truth->count > 0) assert_true(found->count > 0 && found->items[0].toi == truth->items[0].toi);
    return truth->count - next;
}

typedef struct filtered_tally {
    size_t contacts, dropped, later, oriented;
} filtered_tally;

static void compare_scene(uint64_t seed, random_stream *random, filtered_tally *sum) {
    cscd_detector_options options = options_for(seed);
    rig m = make_detector(&s, &options, seed);
    oracle_list truth = {NULL, 0, 0};
    active_twins_join(&twins, m.detector, NULL);
    for (int i = 0; i < 3; i++) {
        static scene motion;
        cscd_contacts found;
        memcpy(&motion, &s, sizeof motion);
        for (uint32_t k = 0; i > 0 && k < s.vertex_count * 3; k++) { /* and back, from where more touches */
            motion.x0[k] = s.x0[k] + 1.6 * (s.x1[k] - s.x0[k]);
            motion.x1[k] = s.x0[k];
        }
        active_twins_choose(&twins, motion.x0, random);
        active_twins_hold(&twins, motion.x0, motion.x1);
        oracle_find(&motion, &truth);
        sum->dropped += filter_truth(&twins, &truth);
        expect_ok(step_packed(m.detector, motion.x0, motion.x1, &found));
        expect_one_number(m.detector, "active objects");
        sum->later += compare_with_truth(&truth, &found, options.mode == CSCD_MODE_EARLIEST);
        sum->contacts += found.count;
        for (uint32_t t = 0; t < s.triangle_count; t++)
            sum->oriented += cscd_detector_orientation(m.detector, t) != 0;
    }
    oracle_free(&truth);
    rig_destroy(&m);
}

TEST(scenes_equal_brute_force) {
    filtered_tally sum = {0, 0, 0, 0};
    for (uint64_t seed = 0; seed < 96; seed++) {
        random_stream random = stream_start(seed);
        scene_make((scene_family)(seed % SCENE_FAMILY_COUNT), seed * 7 + 1, &s);
        compare_scene(seed + seed / SCENE_FAMILY_COUNT, &random, &sum);
    }
    print_message("scenes: %zu contacts, %zu dropped, %zu later, %zu oriented\n", sum.contacts, sum.dropped,
                  sum.later, sum.oriented);
    assert_true(sum.contacts > 1000 && sum.dropped > 20 && sum.later > 0 && sum.oriented > 1000);
}

/* ---- sequences: every call ------------------------------------------------------------------------------ */

/* Mostly steps, each from where the last one ended. What is reached becomes x1. */
static void call_something(random_stream *random, const double *x0, double *x1) {
    switch (stream_below(random, 12)) {
    case 0:
        active_twins_check(&twins, x0);
        active_twins_step(&twins, x0, x1); /* from what the check has left known */
        break;
    case 1:
        active_twins_near(&twins, x0, 0.06);
        break;
    case 2:
        active_twins_max_step(&twins, x0, x1);
        break;
    case 3:
        active_twins_bounds(&twins, x0, 0.06);
        break;
    case 4:
        active_twins_truncate(&twins, x0, x1, 0.06);
        break;
    case 5:
        active_twins_line(&twins, x0, x1, 0.06);
        break;
    default:
        active_twins_step(&twins, x0, x1);
    }
}

static void clear_tally(void) {
    memset(&twins, 0, sizeof twins);
}

static void print_tally(const char *name) {
    print_message(
        "%s: %zu contacts, %zu intersections, %zu near, %zu bounding, %zu cutting, %zu limited, %zu left out\n",
        name, twins.contacts, twins.intersections, twins.near, twins.blocked, twins.held, twins.limited,
        twins.left_out);
}

/* Where vertices are at rest they stay until they are active. */
static void run_sequence(uint64_t seed) {
    static double x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];
    random_stream random = stream_start(seed);
    cscd_detector_options options = options_for(seed);
    options.mode = CSCD_MODE_ALL;
    if (seed % 5 == 3) options.min_separation = 0.02;
    sequence_make((sequence_kind)(seed % SEQUENCE_KIND_COUNT), seed, 14, &recording);
    rig m = make_detector(&recording.shape, &options, seed);
    active_twins_begin(&twins, m.detector, &options, seed % 7 == 0);
    memcpy(x0, recording.frames[0], sizeof x0);
    for (uint32_t f = 1; f < recording.frame_count; f++) {
        memcpy(x1, recording.frames[f], sizeof x1);
        if (stream_below(&random, 2) == 0) active_twins_choose(&twins, x0, &random);
        active_twins_hold(&twins, x0, x1);
        call_something(&random, x0, x1);
        memcpy(x0, x1, sizeof x0);
    }
    active_twins_end(&twins);
    rig_destroy(&m);
}

TEST(sequences_equal_the_whole) {
    clear_tally();
    for (uint64_t seed = 0; seed < NIGHTLY(30, 60); seed++) run_sequence(seed);
    print_tally("sequences");
    assert_true(twins.contacts > 1000 && twins.intersections > 100 && twins.near > 1000 && twins.limited > 2);
    assert_true(twins.blocked > 100 && twins.held > 100 && twins.left_out > 1000);
}

/* ---- several objects, with rules ------------------------------------------------------------------------ */

static void run_objects(uint64_t seed) {
    random_stream random = stream_start(1000 + seed);
    random_rules set;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = seed % 3 == 0   ? CSCD_METHOD_SINGLE
                     : seed % 3 == 1 ? CSCD_METHOD_KMEANS
                                     : CSCD_METHOD_NONE;
    object_scene_make(&random);
    for (int i = 0; i < SCENE_OBJECTS; i++) set.obstacles[i] = stream_below(&random, 3) == 0;
    random_rules_neutral(&set);
    rig made = rules_rig(&set, &options, 1 + (uint32_t)(seed % 2));
    active_twins_begin(&twins, made.detector, &options, false);
    for (int step = 0; step < 6; step++) {
        object_scene_go(0.2 * step, 0.2 * step + 0.2);
        if (stream_below(&random, 2) == 0) random_rules_make(&random, (uint32_t)(seed % 3), &set);
        rules_set(made.detector, &set);
        rules_set(twins.theirs, &set);
        active_twins_choose(&twins, objects_motion.x0, &random);
        active_twins_hold(&twins, objects_motion.x0, objects_motion.x1);
        active_twins_step(&twins, objects_motion.x0, objects_motion.x1);
        call_something(&random, objects_motion.x0, objects_motion.x1);
    }
    active_twins_end(&twins);
    rig_destroy(&made);
}

TEST(objects_equal_the_whole) {
    clear_tally();
    for (uint64_t seed = 0; seed < NIGHTLY(9, 18); seed++) run_objects(seed);
    print_tally("objects");
    assert_true(twins.contacts > 1000 && twins.left_out > 1000);
}

/* ---- wires, points and half-spaces ---------------------------------------------------------------------- */

static loose_recipe recipe_for(uint64_t seed) {
    loose_recipe recipe = {.triangles = seed % 4 != 3,
                           .wires = true,
                           .points = true,
                           .half_spaces = seed % 2 == 0,
                           .grid = seed % 5 == 0,
                           .rules = seed % 3 == 0,
                           .obstacles = seed % 2 == 1,
                           .motion = 0.5};
    recipe.thickness = seed % 3 == 1;
    recipe.min_separation = seed % 3 == 2 ? 0.08 : 0.0;
    return recipe;
}

static void run_loose(uint64_t seed) {
    random_stream random = stream_start(2000 + seed);
    const loose_recipe recipe = recipe_for(seed);
    cscd_detector *ours = NULL;
    loose_scene_make(&loose, &recipe, &random, 1 + (uint32_t)(seed % 3), CSCD_SIMD_AUTO);
    cscd_detector_options options = loose_scene_options(&loose);
    options.method = seed % 7 == 1   ? CSCD_METHOD_BRUTE
                     : seed % 2 == 0 ? CSCD_METHOD_SINGLE
                                     : CSCD_METHOD_NONE;
    expect_ok(detector_create_here(loose.mesh, NULL, &options, &ours));
    active_twins_begin(&twins, ours, &options, seed % 5 == 2);
    for (int step = 0; step < 8; step++) {
        loose_scene_move(&loose, &random);
        active_twins_choose(&twins, loose.x0, &random);
        active_twins_hold(&twins, loose.x0, loose.x1);
        active_twins_step(&twins, loose.x0, loose.x1);
        call_something(&random, loose.x0, loose.x1);
    }
    active_twins_end(&twins);
    cscd_detector_destroy(ours);
    loose_scene_free(&loose);
}

TEST(loose_objects_equal_the_whole) {
    clear_tally();
    for (uint64_t seed = 0; seed < NIGHTLY(30, 60); seed++) run_loose(seed);
    print_tally("loose");
    assert_true(twins.contacts > 1000 && twins.near > 500 && twins.left_out > 1000);
}
