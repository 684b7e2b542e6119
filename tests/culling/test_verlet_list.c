/* Marches with and without lists of pairs: contacts, guarantees and certified steps are those of a detector that has none,
 * and of brute force, however slowly bodies approach, fold, turn or jump, and whatever comes between two steps. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "runtime/bvh/bvh_parts.h"
#include "runtime/detector/detector.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/culling/march.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { INTERVALS = NIGHTLY(200, 360), ORACLE_EVERY = 24 };

/* ---- detectors ------------------------------------------------------------------------------------------- */

enum { WITH_LISTS, WITHOUT, DETECTORS };

typedef struct marching {
    march m;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detectors[DETECTORS];
    cscd_method method;
    cscd_mode mode;
    double *x0, *x1, *reached[DETECTORS];
    uint32_t answered, with_contacts, ended_by_contact;
    uint64_t strays; /* leaves, over all intervals */
    bool answered_last;
} marching;

static cscd_detector *make_detector(const marching *a, cscd_method method, cscd_coherence coherence) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *d;
    options.method = method;
    options.mode = a->mode;
    options.coherence = coherence;
    cscd_plan *plan = method == CSCD_METHOD_KMEANS ? a->plan : NULL;
    assert_int_equal(detector_create_here(a->mesh, plan, &options, &d), CSCD_OK);
    return d;
}

/* Closes the jaws until the teeth are half an edge from each other, or less. */
static void close_jaws(marching *a) {
    cscd_detector *d = make_detector(a, CSCD_METHOD_NONE, CSCD_COHERENCE_OFF);
    cscd_intersections found = {.count = 0};
    for (; found.count == 0; a->m.closed += 0.125) {
        march_place(&a->m, 0.0, a->x1);
        assert_int_equal(check_packed(d, a->x1, &found), CSCD_OK);
        assert_true(a->m.closed < 100.0);
    }
    a->m.closed -= 0.5;
    cscd_detector_destroy(d);
}

static marching marching_begin(march_kind kind, cscd_method method, cscd_mode mode, double shake,
                               uint32_t threads) {
    marching a = {.m = march_make(kind), .method = method, .mode = mode};
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = threads;
    a.m.shake = shake;
    assert_int_equal(cscd_context_create(&options, &a.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(a.context, a.m.objects, a.m.object_count, &a.mesh), CSCD_OK);
    double **arrays[] = {&a.x0, &a.x1, &a.reached[0], &a.reached[1]};
    for (int i = 0; i < 4; i++) {
        *arrays[i] = malloc(a.m.vertex_count * sizeof(double[3]));
        assert_non_null(*arrays[i]);
    }
    if (kind == MARCH_JAWS) close_jaws(&a);
    march_place(&a.m, 0.0, a.x1);
    if (method == CSCD_METHOD_KMEANS) {
        cscd_plan_options plan = cscd_plan_defaults();
        plan.method = method;
        plan.k = 4;
        assert_int_equal(plan_create_packed(a.mesh, a.x1, &plan, &a.plan), CSCD_OK);
    }
    a.detectors[WITH_LISTS] = make_detector(&a, method, CSCD_COHERENCE_AUTO);
    a.detectors[WITHOUT] = make_detector(&a, method, CSCD_COHERENCE_OFF);
    return a;
}

static void marching_end(marching *a) {
    for (int i = 0; i < DETECTORS; i++) {
        cscd_detector_destroy(a->detectors[i]);
        free(a->reached[i]);
    }
    cscd_plan_destroy(a->plan);
    cscd_mesh_destroy(a->mesh);
    cscd_context_destroy(a->context);
    free(a->x0);
    free(a->x1);
    march_free(&a->m);
}

/* ---- intervals --------------------------------------------------------------------------------------------- */

static void assert_same_contacts(const cscd_contacts *a, const cscd_contacts *b) {
    assert_int_equal(a->count, b->count);
    if (a->count > 0) assert_memory_equal(a->items, b->items, a->count * sizeof *a->items);
}

static void compare_with_brute_force(const marching *a, const cscd_contacts *found) {
    cscd_detector *oracle = make_detector(a, CSCD_METHOD_BRUTE, CSCD_COHERENCE_OFF);
    cscd_contacts expected;
    assert_int_equal(step_packed(oracle, a->x0, a->x1, &expected), CSCD_OK);
    assert_same_contacts(found, &expected);
    cscd_detector_destroy(oracle);
}

static void compare_components(const marching *a) {
    for (uint32_t c = 0; c < a->m.object_count; c++) {
        cscd_guarantee p = cscd_detector_guarantee(a->detectors[WITH_LISTS], c);
        cscd_guarantee q = cscd_detector_guarantee(a->detectors[WITHOUT], c);
        assert_int_equal(p.complete, q.complete);
        if (a->method != CSCD_METHOD_AUTO) /* which chooses by what it has counted */
            assert_true(p.start_embedded == q.start_embedded && p.reason == q.reason);
    }
}

/* An orientation of the list is one that the triangle has, too, where the detector points are nearly the same. */
static void compare_orientations(const marching *a) {
    uint32_t opposite = 0;
    for (uint32_t t = 0; t < a->m.triangle_count; t++) {
        int p = cscd_detector_orientation(a->detectors[WITH_LISTS], t);
        opposite += p * cscd_detector_orientation(a->detectors[WITHOUT], t) < 0;
    }
    assert_int_equal(opposite, 0);
}

/* What the list knows of the start of the next interval is what is true of the end of this one. */
static void check_strays(marching *a) {
    const bvh_skin *skin = &a->detectors[WITH_LISTS]->known.verlet.skin;
    for (uint32_t i = 0; i < skin->leaf_count; i++) {
        float sum = 0.0f;
        for (int k = 4; k < 7; k++) {
            float low = INFINITY, high = -INFINITY;
            for (int j = 0; j < 3 * LANES; j++) {
                low = fminf(low, skin->items[skin->leaves[i].corners[j]][k]);
                high = fmaxf(high, skin->items[skin->leaves[i].corners[j]][k]);
            }
            sum += (high - low) * (high - low);
        }
        assert_int_equal(skin->stray_at_start[i], !(sum < skin->stretches[i]));
        a->strays += skin->stray_at_start[i];
    }
}

static void take_step(marching *a, uint32_t i) {
    cscd_contacts found[DETECTORS];
    for (int k = 0; k < DETECTORS; k++) {
        assert_int_equal(step_packed(a->detectors[k], a->x0, a->x1, &found[k]), CSCD_OK);
        expect_one_number(a->detectors[k], "a march");
    }
    bool answered = cscd_detector_counters(a->detectors[WITH_LISTS]).coherent != 0;
    assert_same_contacts(&found[0], &found[1]);
    assert_int_equal(cscd_detector_counters(a->detectors[WITHOUT]).coherent, 0);
    assert_false(answered && found[0].count > 0);
    compare_components(a);
    compare_orientations(a);
    if (answered) check_strays(a);
    bool ends = a->answered_last && found[0].count > 0;
    if (a->mode == CSCD_MODE_ALL && (ends || i % ORACLE_EVERY == 0)) compare_with_brute_force(a, &found[0]);
    a->answered += answered;
    a->with_contacts += found[0].count > 0;
    a->ended_by_contact += ends;
    a->answered_last = answered;
}

/* The certified step of both ends at the same place. */
static void take_certified_step(marching *a) {
    cscd_free_step steps[DETECTORS];
    cscd_status status[DETECTORS];
    for (int k = 0; k < DETECTORS; k++)
        status[k] = max_step_packed(a->detectors[k], a->x0, a->x1, a->reached[k], &steps[k]);
    assert_int_equal(status[0], status[1]);
    a->answered_last = false;
    if (status[0] != CSCD_OK) return;
    assert_true(steps[0].fraction == steps[1].fraction && steps[0].limited == steps[1].limited);
    assert_memory_equal(a->reached[0], a->reached[1], a->m.vertex_count * sizeof(double[3]));
    memcpy(a->x1, a->reached[0], a->m.vertex_count * sizeof(double[3]));
}

typedef cscd_status change_detector(cscd_detector *d, const marching *a, bool back);

static cscd_status change_separation(cscd_detector *d, const marching *a, bool back) {
    return cscd_detector_set_separation(d, back ? 0.0 : 0.05 * a->m.edge, 0.0);
}

/* The first vertices are those that a motion of nothing moves. */
static cscd_status change_active(cscd_detector *d, const marching *a, bool back) {
    static const uint32_t some[4] = {0, 1, 2, 3};
    (void)a;
    return cscd_detector_set_active(d, back ? NULL : some, back ? 0 : 4);
}

static cscd_status change_rules(cscd_detector *d, const marching *a, bool back) {
    const cscd_object_rule rules[MARCH_OBJECTS_MAX] = {cscd_object_rule_default(),
                                                       cscd_object_rule_default()};
    return cscd_detector_set_rules(d, back ? NULL : rules, back ? 0 : a->m.object_count, NULL, 0);
}

static cscd_status change_seams(cscd_detector *d, const marching *a, bool back) {
    static const uint32_t seam[2] = {0, 1};
    (void)a;
    return cscd_detector_set_seams(d, back ? NULL : seam, back ? 0 : 1);
}

/* Steps by other settings, which go back to what they were: one away from where the list was, or some in place, in which
 * nothing but what is active may be listed. */
static void step_by_other_settings(marching *a) {
    static change_detector *const changes[] = {change_separation, change_active, change_rules, change_seams};
    int which = random_integer(0, 3);
    cscd_contacts found[DETECTORS];
    memcpy(a->x0, a->x1, a->m.vertex_count * sizeof(double[3]));
    if (which != 1) march_place(&a->m, -0.2, a->x1);
    for (int k = 0; k < DETECTORS; k++) {
        assert_int_equal(changes[which](a->detectors[k], a, false), CSCD_OK);
        for (int i = 0; i < (which == 1 ? 3 : 1); i++)
            assert_int_equal(step_packed(a->detectors[k], a->x0, a->x1, &found[k]), CSCD_OK);
        expect_one_number(a->detectors[k], "a march");
        assert_int_equal(changes[which](a->detectors[k], a, true), CSCD_OK);
    }
    assert_same_contacts(&found[0], &found[1]);
    a->answered_last = false;
}

/* Other calls between two steps. */
static void call_otherwise(marching *a) {
    cscd_intersections found;
    cscd_detector *clone;
    switch (random_integer(0, 3)) {
    case 0: /* a check of other positions, so that the next start is not the last end; of two bodies, behind the other */
        march_place(&a->m, a->m.object_count == 2 ? 4.0 * (a->m.high[0] - a->m.low[0]) / a->m.edge : -0.1,
                    a->x1);
        for (int k = 0; k < DETECTORS; k++)
            assert_int_equal(check_packed(a->detectors[k], a->x1, &found), CSCD_OK);
        break;
    case 1: /* a check where everything is, which moves the trees */
        assert_int_equal(check_packed(a->detectors[WITH_LISTS], a->x1, &found), CSCD_OK);
        assert_int_equal(check_packed(a->detectors[WITHOUT], a->x1, &found), CSCD_OK);
        break;
    case 2:
        step_by_other_settings(a);
        break;
    default:
        assert_int_equal(cscd_detector_clone(a->context, a->detectors[WITH_LISTS], &clone), CSCD_OK);
        cscd_detector_destroy(a->detectors[WITH_LISTS]);
        a->detectors[WITH_LISTS] = clone;
    }
}

/* ---- marches ------------------------------------------------------------------------------------------------- */

/* Mostly slowly on, sometimes back; now and then not at all, or by a jump beyond every skin. */
static double next_place(double s, double *direction) {
    int kind = random_integer(0, 99);
    if (s > 0.9 || kind < 1) *direction = -1.0;
    if (s < 0.0) *direction = 1.0;
    if (kind < 4) return s;
    double by = kind < 6 ? 0.5 : ldexp(0.02, -random_integer(0, 4));
    return s + *direction * by;
}

static void march_on(marching *a, bool disturbed) {
    double s = 0.0, direction = 1.0;
    for (uint32_t i = 0; i < INTERVALS; i++) {
        if (disturbed && random_integer(0, 24) == 0) call_otherwise(a);
        memcpy(a->x0, a->x1, a->m.vertex_count * sizeof(double[3]));
        s = next_place(s, &direction);
        march_place(&a->m, s, a->x1);
        if (disturbed && random_integer(0, 3) == 0)
            take_certified_step(a);
        else
            take_step(a, i);
    }
}

/* What several marches have met. */
typedef struct marches_met {
    uint32_t ended_by_contact;
    uint64_t strays;
} marches_met;

static void run_march(march_kind kind, cscd_method method, cscd_mode mode, double shake, bool disturbed,
                      marches_met *sum) {
    static const char *const names[MARCH_KINDS] = {"approach", "land", "turn", "jaws", "fold"};
    marching a = marching_begin(kind, method, mode, shake, kind % 2 == 0 ? 1 : 3);
    march_on(&a, disturbed);
    printf(
        "%-8s %-6s %-8s shake %5.3f%s: %u of %d intervals from lists, %u with contacts, %u right after a list\n",
        names[kind], cscd_method_name(method), cscd_name(CSCD_MODES, mode), shake,
        disturbed ? ", disturbed" : "", a.answered, INTERVALS, a.with_contacts, a.ended_by_contact);
    assert_true(a.answered >= INTERVALS / 18 && a.with_contacts > 0);
    marching_end(&a);
    sum->ended_by_contact += a.ended_by_contact;
    sum->strays += a.strays;
}

TEST(smooth_marches) {
    marches_met sum = {0, 0};
    for (int kind = 0; kind < MARCH_KINDS; kind++)
        run_march((march_kind)kind, CSCD_METHOD_SINGLE, CSCD_MODE_ALL, 0.0, false, &sum);
    assert_true(sum.ended_by_contact >= INTERVALS / 72 && sum.strays > 0);
}

TEST(rough_marches) {
    marches_met sum = {0, 0};
    for (int kind = 0; kind < MARCH_KINDS; kind++)
        run_march((march_kind)kind, CSCD_METHOD_AUTO, CSCD_MODE_ALL, 0.002, false, &sum);
}

TEST(marches_by_regions) {
    marches_met sum = {0, 0};
    for (int kind = MARCH_JAWS; kind < MARCH_KINDS; kind++) {
        run_march((march_kind)kind, CSCD_METHOD_KMEANS, CSCD_MODE_ALL, 0.0, false, &sum);
        run_march((march_kind)kind, CSCD_METHOD_KMEANS, CSCD_MODE_EARLIEST, 0.001, false, &sum);
    }
}

TEST(disturbed_marches) {
    marches_met sum = {0, 0};
    for (int kind = 0; kind < MARCH_KINDS; kind++)
        run_march((march_kind)kind, CSCD_METHOD_SINGLE, CSCD_MODE_ALL, 0.0, true, &sum);
}

static int seed_march(void **state) {
    (void)state;
    random_seed(24);
    return 0;
}

AROUND_EACH(seed_march, NULL)
