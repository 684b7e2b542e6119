/* The search for a free step, which shortens steps until one is free, on motions that the test makes up. */
#include "runtime/solver/free_step.h"
#include "tests/support/calls.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>

static scene shape; /* large; one test at a time */
static double ends[SCENE_VERTICES_MAX * 3], reached[SCENE_VERTICES_MAX * 3];

/* A wall that every motion of vertex 0 along x reaches at this coordinate; INFINITY means no wall. */
typedef struct wall {
    double at;
    uint32_t tests;
    cscd_contact contact;
} wall;

static cscd_status test_wall(void *of, const double *from, const double *to, cscd_contacts *out) {
    wall *w = of;
    double way = to[0] - from[0];
    bool touches = from[0] >= w->at || to[0] >= w->at;
    w->tests++;
    w->contact = (cscd_contact){.kind = CSCD_CONTACT_VF, .a = 4, .b = 9};
    w->contact.toi = from[0] >= w->at || way <= 0.0 ? 0.0 : (w->at - from[0]) / way;
    *out = (cscd_contacts){.items = &w->contact, .count = touches};
    return CSCD_OK;
}

/* All vertices fly by 1 along x. */
static rig make_flight(straight_motion *m) {
    scene_make(SCENE_TWO_SPHERES, 1, &shape);
    for (uint32_t i = 0; i < shape.vertex_count * 3; i++) ends[i] = shape.x0[i] + (i % 3 == 0);
    rig r = rig_create(&shape, 1, NULL);
    *m = (straight_motion){.mesh = r.mesh, .x0 = shape.x0, .x1 = ends};
    return r;
}

static cscd_status fly_towards(const rig *r, const straight_motion *m, double longest, wall *w,
                               cscd_free_step *out) {
    const step_quest quest = {r->context, 0.8, longest, test_wall, w};
    return free_step_find(&quest, m, reached, out);
}

TEST(free_motions_are_whole_steps) {
    straight_motion m;
    cscd_free_step out;
    rig r = make_flight(&m);
    wall nowhere = {.at = INFINITY};
    expect_ok(fly_towards(&r, &m, 1.0, &nowhere, &out));
    assert_true(out.fraction == 1.0 && !out.limited && out.moved && nowhere.tests == 1);
    assert_memory_equal(reached, ends, shape.vertex_count * sizeof(double[3]));
    expect_ok(fly_towards(&r, &m, 0.25, &nowhere, &out));
    assert_true(out.fraction == 0.25 && fabs(reached[0] - shape.x0[0] - 0.25) < 1e-12);
    rig_destroy(&r);
}

TEST(limited_steps_end_before_the_wall) {
    straight_motion m;
    cscd_free_step out;
    rig r = make_flight(&m);
    for (double share = 0.9; share > 1e-6; share *= 0.1) {
        wall w = {.at = shape.x0[0] + share};
        expect_ok(fly_towards(&r, &m, 1.0, &w, &out));
        assert_true(out.limited && out.limit.a == 4 && out.limit.b == 9);
        assert_true(fabs(out.limit.toi - share) < 1e-12);
        assert_true(fabs(out.fraction - 0.8 * share) < 1e-12 && reached[0] < w.at && w.tests == 2);
        if (share > 0.4) continue;
        w.tests = 0; /* half of the motion at most, but times are still of the whole motion */
        expect_ok(fly_towards(&r, &m, 0.5, &w, &out));
        assert_true(out.limited && fabs(out.limit.toi - share) < 1e-12);
        assert_true(fabs(out.fraction - 0.8 * share) < 1e-12 && reached[0] < w.at && w.tests == 2);
    }
    rig_destroy(&r);
}

TEST(no_step_is_free_from_within) {
    straight_motion m;
    cscd_free_step out = {.fraction = -1.0};
    rig r = make_flight(&m);
    wall w = {.at = shape.x0[0]};
    assert_int_equal(fly_towards(&r, &m, 1.0, &w, &out), CSCD_IN_CONTACT);
    assert_true(out.fraction == 0.0 && out.limited && w.tests < 10);
    assert_true(out.limit.a == 4 && out.limit.b == 9 && out.limit.toi == 0.0);
    rig_destroy(&r);
}

/* A coordinate that would be nearer to 0 than any position may be is 0, at three quarters of the way from 2^-299 to it. */
TEST(nothing_comes_too_near_to_zero) {
    straight_motion m;
    rig r = make_flight(&m);
    shape.x0[0] = 0x1p-299;
    ends[0] = 0.0;
    motion_at(&m, 0.5, reached);
    assert_true(reached[0] == 0x1p-300);
    motion_at(&m, 0.75, reached);
    assert_true(reached[0] == 0.0);
    rig_destroy(&r);
}
