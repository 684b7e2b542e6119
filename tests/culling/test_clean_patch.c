/* Which triangles are clean after a static check, after contacts, and after they heal. */
#include "cscd/cscd.h"
#include "runtime/detector/detector.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <string.h>

enum { RINGS = 9, SEGMENTS = 6 };

static scene s; /* large; one test at a time */
static bool unproven[SCENE_TRIANGLES_MAX], crossing[SCENE_TRIANGLES_MAX];

typedef struct states {
    rig r;
    start_states starts;
} states;

static states states_of_sphere(int count) {
    states out;
    scene_clear(&s);
    for (int i = 0; i < count; i++) scene_add_sphere(&s, (double[3]){3.0 * i, 0, 0}, 1.0, RINGS, SEGMENTS);
    out.r = rig_create(&s, 1, NULL);
    assert_int_equal(start_states_create(out.r.mesh, &out.starts), CSCD_OK);
    start_states_begin(&out.starts, s.x0);
    return out;
}

static void states_destroy(states *c) {
    start_states_destroy(&c->starts);
    rig_destroy(&c->r);
}

static double height_of(uint32_t triangle) {
    const uint32_t *t = s.triangles + (size_t)triangle * 3;
    return (s.x0[t[0] * 3 + 2] + s.x0[t[1] * 3 + 2] + s.x0[t[2] * 3 + 2]) / 3.0;
}

/* Runs a check that finds contacts at the triangles between two heights. */
static void check_with_belt(states *c, double low, double high) {
    for (uint32_t t = 0; t < s.triangle_count; t++) {
        unproven[t] = true;
        crossing[t] = height_of(t) > low && height_of(t) < high;
    }
    start_states_checked(&c->starts, unproven, crossing);
}

static uint32_t count_between(const states *c, triangle_state state, double low, double high) {
    uint32_t found = 0;
    for (uint32_t t = 0; t < s.triangle_count; t++)
        found += height_of(t) > low && height_of(t) < high && c->starts.triangles[t] == state;
    return found;
}

TEST(all_free_is_all_clean) {
    states c = states_of_sphere(2);
    check_with_belt(&c, 5, 6);
    assert_int_equal(count_between(&c, TRIANGLE_CLEAN, -2, 2), s.triangle_count);
    assert_int_equal(c.starts.of[0].clean + c.starts.of[1].clean, s.triangle_count);
    states_destroy(&c);
}

/* A belt of contacts cuts off a cap. The cap may be inside another part, so it is not clean. */
TEST(what_is_cut_off_is_not_clean) {
    states c = states_of_sphere(1);
    check_with_belt(&c, 0.3, 0.7);
    uint32_t cap = count_between(&c, TRIANGLE_FREE, 0.7, 2),
             rest = count_between(&c, TRIANGLE_CLEAN, -2, 0.3);
    assert_true(cap > 0 && rest > cap);
    assert_int_equal(cap + rest + count_between(&c, TRIANGLE_CROSSING, -2, 2), s.triangle_count);
    assert_int_equal(c.starts.of[0].clean, rest);
    check_with_belt(&c, 5, 6); /* the belt is gone */
    assert_int_equal(count_between(&c, TRIANGLE_CLEAN, -2, 2), s.triangle_count);
    states_destroy(&c);
}

/* Healed triangles connect a patch that was cut off, and the clean state spreads through them only. */
TEST(clean_spreads_through_what_has_healed) {
    states c = states_of_sphere(1);
    check_with_belt(&c, 0.1, 0.6);
    uint32_t cap = count_between(&c, TRIANGLE_FREE, 0.6, 2);
    assert_true(cap > 0);
    for (uint32_t t = 0; t < s.triangle_count; t++) {
        unproven[t] = c.starts.triangles[t] == TRIANGLE_CROSSING;
        crossing[t] = unproven[t] && s.x0[s.triangles[(size_t)t * 3] * 3] > 0.0;
    }
    start_states_end(&c.starts, s.x0, (bool[1]){false});
    assert_int_equal(count_between(&c, TRIANGLE_UNKNOWN, 0.1, 0.6),
                     count_between(&c, TRIANGLE_UNKNOWN, -2, 2));
    start_states_checked(&c.starts, unproven, crossing);
    assert_int_equal(count_between(&c, TRIANGLE_CLEAN, 0.6, 2), cap);
    assert_true(count_between(&c, TRIANGLE_CROSSING, 0.1, 0.6) > 0);
    states_destroy(&c);
}

/* When contacts have left only a remnant of a patch, a larger patch of free triangles takes its place. */
TEST(a_larger_patch_replaces_a_remnant) {
    states c = states_of_sphere(1);
    check_with_belt(&c, 0.3, 0.7);
    for (uint32_t t = 0; t < s.triangle_count; t++) {
        if (c.starts.triangles[t] == TRIANGLE_CLEAN && height_of(t) > -0.8) start_states_taint(&c.starts, t);
    }
    start_states_end(&c.starts, s.x0, (bool[1]){false});
    uint32_t remnant = count_between(&c, TRIANGLE_CLEAN, -2, 2),
             cap = count_between(&c, TRIANGLE_FREE, 0.7, 2);
    assert_true(remnant > 0 && remnant < cap);
    check_with_belt(&c, -0.8, 0.7);
    assert_int_equal(count_between(&c, TRIANGLE_CLEAN, 0.7, 2), cap);
    assert_int_equal(count_between(&c, TRIANGLE_FREE, -2, -0.8), remnant);
    assert_int_equal(count_between(&c, TRIANGLE_CLEAN, -2, 2), c.starts.of[0].clean);
    states_destroy(&c);
}

TEST(states_follow_positions) {
    states c = states_of_sphere(2);
    uint32_t half = s.triangle_count / 2;
    check_with_belt(&c, 5, 6);
    start_states_begin(&c.starts, s.x0);
    start_states_count(&c.starts);
    assert_int_equal(c.starts.of[0].clean + c.starts.of[1].clean, s.triangle_count);
    s.x0[3 * (s.vertex_count - 1)] += 0.125; /* moves the second sphere */
    start_states_begin(&c.starts, s.x0);
    start_states_count(&c.starts);
    assert_int_equal(c.starts.of[0].clean, half);
    assert_int_equal(c.starts.of[1].unknown, half);
    assert_int_equal(start_states_mark_unproven(&c.starts, NULL, unproven), half);
    start_states_end(&c.starts, s.x0, (bool[2]){true, false});
    start_states_count(&c.starts);
    assert_int_equal(c.starts.of[0].unknown, half);
    states_destroy(&c);
}

/* The caller's promise fills in unknown states but does not override known ones; a check takes it back. */
TEST(vouching_fills_in) {
    states c = states_of_sphere(1);
    start_states_vouch(&c.starts);
    assert_int_equal(count_between(&c, TRIANGLE_CLEAN, -2, 2), s.triangle_count);
    check_with_belt(&c, 0.3, 0.7);
    assert_true(count_between(&c, TRIANGLE_FREE, 0.7, 2) > 0);
    start_states_vouch(&c.starts);
    assert_true(count_between(&c, TRIANGLE_FREE, 0.7, 2) > 0 &&
                count_between(&c, TRIANGLE_CROSSING, -2, 2) > 0);
    states_destroy(&c);
}

/* As long as most of a component is not clean, its checks wait longer and longer. */
TEST(checks_in_vain_wait) {
    states c = states_of_sphere(1);
    uint32_t checks = 0;
    for (int i = 0; i < 40; i++) {
        if (start_states_mark_unproven(&c.starts, NULL, unproven) > 0) {
            check_with_belt(&c, -0.9, 2);
            checks++;
        }
        start_states_end(&c.starts, s.x0, (bool[1]){false});
    }
    assert_int_equal(checks, 6); /* The checks are in intervals 0, 2, 5, 10, 19 and 36. */
    states_destroy(&c);
}

/* The pole of a sphere is pulled through its floor. At the next start most triangles are clean, the tip is
 * not, and only pairs with unclean triangles are tested. */
TEST(a_tip_through_the_floor) {
    static scene next;
    scene_clear(&s);
    scene_add_sphere(&s, (double[3]){0, 0, 0}, 1.0, 12, 14);
    uint32_t pole = s.x0[2] > 0 ? 0 : s.vertex_count - 1;
    s.x1[pole * 3] = 0.1;
    s.x1[pole * 3 + 2] = -1.5;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_SINGLE;
    rig r = rig_create(&s, 1, &options);
    assert_true(rig_step(&r, &s).count > 0);
    assert_int_equal(cscd_detector_counters(r.detector).clean, s.triangle_count);
    assert_true(cscd_detector_counters(r.detector).passes > 0);
    next = s;
    memcpy(next.x0, s.x1, sizeof next.x0);
    assert_int_equal(rig_step(&r, &next).count, 0); /* at rest, intersecting itself */
    cscd_counters counters = cscd_detector_counters(r.detector);
    cscd_guarantee guarantee = cscd_detector_guarantee(r.detector, 0);
    assert_int_equal(guarantee.reason, CSCD_REASON_CROSSING);
    assert_true(guarantee.complete && !guarantee.start_embedded);
    assert_true(counters.clean * 10 > s.triangle_count * 8 && counters.clean < s.triangle_count);
    assert_int_equal(counters.static_checks, 1);
    assert_int_equal(counters.passes, 0);
    rig_destroy(&r);
}

/* Lists and counters are the same for any number of threads, also while parts intersect. */
TEST(same_bits_for_any_thread_count) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_SINGLE;
    rig rigs[3];
    for (int family = SCENE_NOISY_SPHERE; family <= SCENE_SQUASHED_TORUS; family++) {
        scene_make((scene_family)family, 4, &s);
        for (uint32_t i = 0; i < s.vertex_count * 3; i++) s.x1[i] += s.x1[i] - s.x0[i];
        for (uint32_t i = 0; i < 3; i++) rigs[i] = rig_create(&s, 1 + 3 * i, &options);
        for (int step = 0; step < 4; step++) {
            cscd_contacts expected = rig_step(&rigs[0], &s);
            cscd_counters counters = cscd_detector_counters(rigs[0].detector);
            for (int i = 1; i < 3; i++) {
                cscd_contacts found = rig_step(&rigs[i], &s);
                cscd_counters own = cscd_detector_counters(rigs[i].detector);
                assert_int_equal(found.count, expected.count);
                assert_true(found.count == 0 ||
                            memcmp(found.items, expected.items, found.count * sizeof *found.items) == 0);
                assert_memory_equal(&own, &counters, sizeof own);
            }
            static double turn[SCENE_VERTICES_MAX * 3]; /* the motion back */
            memcpy(turn, s.x0, sizeof turn);
            memcpy(s.x0, s.x1, sizeof s.x0);
            memcpy(s.x1, turn, sizeof s.x1);
        }
        for (int i = 0; i < 3; i++) rig_destroy(&rigs[i]);
    }
}
