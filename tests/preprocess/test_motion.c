/* Plans for a motion: what points see in frames counts as what they see at rest. */
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The share of the triangles that a detector with the plan does not cull in a frame, as it counts them itself. */
static double unseen_in(const bending *b, const cscd_plan *plan, int frame) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    cscd_contacts contacts;
    options.method = cscd_plan_method(plan);
    options.start = CSCD_START_VOUCHED;
    expect_ok(cscd_detector_create(b->context, b->mesh, plan, &options, &detector));
    const cscd_view *x = CSCD_DOUBLES(b->frames[frame], b->shape.vertex_count);
    expect_ok(cscd_detector_step(detector, x, x, &contacts));
    const double plus = (double)cscd_detector_counters(detector).plus;
    cscd_detector_destroy(detector);
    return 1.0 - plus / b->shape.triangle_count;
}

TEST(a_capsule_is_cut_for_its_bend) {
    bending b = bending_of(BODY_CAPSULE, 2000, 3.0, 1);
    cscd_plan *rest = bending_plan(&b, CSCD_METHOD_CHARGE, NULL, 0),
              *motion = bending_plan(&b, CSCD_METHOD_CHARGE, bending_frames(&b), BENDING_FRAMES);
    assert_int_equal(cscd_plan_region_count(rest), 1);
    assert_in_range(cscd_plan_region_count(motion), 2, 5);
    assert_true(unseen_in(&b, rest, BENDING_FRAMES - 1) > 0.25);
    for (int f = 0; f < BENDING_FRAMES; f++) assert_true(unseen_in(&b, motion, f) < 0.02);
    cscd_plan_destroy(rest);
    cscd_plan_destroy(motion);
    bending_free(&b);
}

/* Frames as the rest, one and three of them, so that a mean of them is the same bits. */
TEST(frames_at_rest_change_nothing) {
    static const uint32_t counts[] = {1, 3};
    bending b = bending_of(BODY_FIGURE, 2000, 0.0, 1);
    cscd_plan *rest = bending_plan(&b, CSCD_METHOD_CHARGE, NULL, 0);
    for (int i = 0; i < 2; i++) {
        cscd_plan *motion = bending_plan(&b, CSCD_METHOD_CHARGE, bending_frames(&b), counts[i]);
        bending_expect_same(rest, motion, b.shape.triangle_count);
        cscd_plan_destroy(motion);
    }
    cscd_plan_destroy(rest);
    bending_free(&b);
}

/* Of more frames than eight the first and the last count. */
TEST(some_of_many_frames_count) {
    bending b = bending_of(BODY_CAPSULE, 1000, 0.0, 1);
    bending_bend(&b.shape, 3.0, b.frames[BENDING_FRAMES - 1]);
    cscd_plan *last = bending_plan(&b, CSCD_METHOD_CHARGE, bending_frames(&b), BENDING_FRAMES),
              *without = bending_plan(&b, CSCD_METHOD_CHARGE, bending_frames(&b), BENDING_FRAMES - 1);
    assert_int_equal(cscd_plan_region_count(without), 1);
    assert_true(cscd_plan_region_count(last) > 1);
    cscd_plan_destroy(last);
    cscd_plan_destroy(without);
    bending_free(&b);
}

static void expect_refusal(const bending *b, const cscd_view *const *frames, uint32_t count,
                           const char *word) {
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    options.frames = frames;
    options.frame_count = count;
    assert_int_equal(cscd_plan_create(b->context, b->mesh,
                                      CSCD_DOUBLES(b->shape.positions, b->shape.vertex_count), &options,
                                      &plan),
                     CSCD_INVALID_ARGUMENT);
    assert_null(plan);
    if (strstr(cscd_context_detail(b->context), word) == NULL)
        fail_msg("expected '%s' in: %s", word, cscd_context_detail(b->context));
}

TEST(refuses_bad_frames) {
    bending b = bending_of(BODY_CAPSULE, 200, 1.0, 1);
    bending_frames(&b);
    expect_refusal(&b, NULL, 2, "frame_count is 2");
    b.items[1] = NULL;
    expect_refusal(&b, b.items, 3, "frames[1] is NULL");
    bending_frames(&b);
    b.frames[2][4] = NAN;
    expect_refusal(&b, b.items, 3, "frames[2]");
    bending_free(&b);
}
