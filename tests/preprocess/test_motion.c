/* Plans for a motion: what points see in frames counts as what they see at rest; and method auto, which compares plans. */
#include "cscd/cscd.h"
#include "tests/support/models/body_of.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 12 };

/* A body, and frames that bend it. */
typedef struct bending {
    body shape;
    cscd_context *context;
    cscd_mesh *mesh;
    double *frames[FRAMES];
    cscd_view views[FRAMES];
    const cscd_view *items[FRAMES];
} bending;

static int longest_axis(const body *b, double *low, double *length) {
    int longest = 0;
    *length = 0.0;
    for (int k = 0; k < 3; k++) {
        double least = INFINITY, most = -INFINITY;
        for (uint32_t v = 0; v < b->vertex_count; v++) {
            least = fmin(least, b->positions[(size_t)v * 3 + (size_t)k]);
            most = fmax(most, b->positions[(size_t)v * 3 + (size_t)k]);
        }
        if (most - least <= *length) continue;
        *length = most - least;
        *low = least;
        longest = k;
    }
    return longest;
}

/* Makes a body several times as long. */
static void stretch_body(body *b, double times) {
    double low = 0.0, length;
    const int along = longest_axis(b, &low, &length);
    for (uint32_t v = 0; v < b->vertex_count; v++) b->positions[(size_t)v * 3 + (size_t)along] *= times;
}

/* Bends the longest axis to an arc of this angle. */
static void bend_body(const body *b, double angle, double *out) {
    double low = 0.0, length;
    const int along = longest_axis(b, &low, &length), side = (along + 1) % 3, other = (along + 2) % 3;
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        const double *p = b->positions + (size_t)v * 3, at = (p[along] - low) / length - 0.5;
        double *q = out + (size_t)v * 3;
        memcpy(q, p, sizeof(double[3]));
        if (angle == 0.0) continue;
        const double radius = length / angle - p[side];
        q[along] = radius * sin(angle * at);
        q[side] = length / angle - radius * cos(angle * at);
        q[other] = p[other];
    }
}

static bending bending_of(body_kind kind, uint32_t triangles, double angle, int threads) {
    bending b = {.shape = body_of(kind, triangles)};
    if (kind == BODY_CAPSULE) stretch_body(&b.shape, 3.0);
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = (uint32_t)threads;
    assert_int_equal(cscd_context_create(&options, &b.context), CSCD_OK);
    const cscd_object_desc desc =
        cscd_object_of_triangles(b.shape.vertex_count, b.shape.triangle_count, b.shape.triangles);
    assert_int_equal(cscd_mesh_create(b.context, &desc, 1, &b.mesh), CSCD_OK);
    for (int f = 0; f < FRAMES; f++) {
        b.frames[f] = body_allocate((size_t)b.shape.vertex_count * 3, sizeof(double));
        bend_body(&b.shape, angle * f / (FRAMES - 1), b.frames[f]);
    }
    return b;
}

/* Views hold addresses of the frames, so they are made where the structure stays. */
static const cscd_view *const *frames_of(bending *b) {
    for (int f = 0; f < FRAMES; f++) {
        b->views[f] = cscd_view_doubles(b->frames[f], b->shape.vertex_count);
        b->items[f] = &b->views[f];
    }
    return b->items;
}

static void bending_free(bending *b) {
    cscd_mesh_destroy(b->mesh);
    cscd_context_destroy(b->context);
    body_free(&b->shape);
    for (int f = 0; f < FRAMES; f++) free(b->frames[f]);
}

static cscd_plan *plan_of(const bending *b, cscd_method method, const cscd_view *const *frames,
                          uint32_t count) {
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    options.method = method;
    options.frames = frames;
    options.frame_count = count;
    if (cscd_plan_create(b->context, b->mesh, CSCD_DOUBLES(b->shape.positions, b->shape.vertex_count),
                         &options, &plan) != CSCD_OK)
        fail_msg("%s", cscd_context_detail(b->context));
    return plan;
}

static void expect_same_plan(const cscd_plan *a, const cscd_plan *b, uint32_t triangles) {
    assert_int_equal(cscd_plan_method(a), cscd_plan_method(b));
    assert_int_equal(cscd_plan_region_count(a), cscd_plan_region_count(b));
    for (uint32_t t = 0; t < triangles; t++)
        assert_int_equal(cscd_plan_triangle_region(a, t), cscd_plan_triangle_region(b, t));
    for (uint32_t r = 0; r < cscd_plan_region_count(a); r++) {
        const cscd_region x = cscd_plan_region(a, r), y = cscd_plan_region(b, r);
        assert_memory_equal(x.detector_point, y.detector_point, sizeof x.detector_point);
    }
}

/* The share of the triangles that a detector with the plan does not cull in a frame, as it counts them itself. */
static double unseen_in(const bending *b, const cscd_plan *plan, int frame) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    cscd_contacts contacts;
    options.method = cscd_plan_method(plan);
    options.start = CSCD_START_VOUCHED;
    assert_int_equal(cscd_detector_create(b->context, b->mesh, plan, &options, &detector), CSCD_OK);
    const cscd_view *x = CSCD_DOUBLES(b->frames[frame], b->shape.vertex_count);
    assert_int_equal(cscd_detector_step(detector, x, x, &contacts), CSCD_OK);
    const double plus = (double)cscd_detector_counters(detector).plus;
    cscd_detector_destroy(detector);
    return 1.0 - plus / b->shape.triangle_count;
}

/* ---- frames ---------------------------------------------------------------------------------------------- */

static void a_capsule_is_cut_for_its_bend(void **state) {
    (void)state;
    bending b = bending_of(BODY_CAPSULE, 2000, 3.0, 1);
    cscd_plan *rest = plan_of(&b, CSCD_METHOD_CHARGE, NULL, 0),
              *motion = plan_of(&b, CSCD_METHOD_CHARGE, frames_of(&b), FRAMES);
    assert_int_equal(cscd_plan_region_count(rest), 1);
    assert_in_range(cscd_plan_region_count(motion), 2, 5);
    assert_true(unseen_in(&b, rest, FRAMES - 1) > 0.25);
    for (int f = 0; f < FRAMES; f++) assert_true(unseen_in(&b, motion, f) < 0.02);
    cscd_plan_destroy(rest);
    cscd_plan_destroy(motion);
    bending_free(&b);
}

/* Frames as the rest, one and three of them, so that a mean of them is the same bits. */
static void frames_at_rest_change_nothing(void **state) {
    (void)state;
    static const uint32_t counts[] = {1, 3};
    bending b = bending_of(BODY_FIGURE, 2000, 0.0, 1);
    cscd_plan *rest = plan_of(&b, CSCD_METHOD_CHARGE, NULL, 0);
    for (int i = 0; i < 2; i++) {
        cscd_plan *motion = plan_of(&b, CSCD_METHOD_CHARGE, frames_of(&b), counts[i]);
        expect_same_plan(rest, motion, b.shape.triangle_count);
        cscd_plan_destroy(motion);
    }
    cscd_plan_destroy(rest);
    bending_free(&b);
}

/* Of more frames than eight the first and the last count. */
static void some_of_many_frames_count(void **state) {
    (void)state;
    bending b = bending_of(BODY_CAPSULE, 1000, 0.0, 1);
    bend_body(&b.shape, 3.0, b.frames[FRAMES - 1]);
    cscd_plan *last = plan_of(&b, CSCD_METHOD_CHARGE, frames_of(&b), FRAMES),
              *without = plan_of(&b, CSCD_METHOD_CHARGE, frames_of(&b), FRAMES - 1);
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

static void refuses_bad_frames(void **state) {
    (void)state;
    bending b = bending_of(BODY_CAPSULE, 200, 1.0, 1);
    frames_of(&b);
    expect_refusal(&b, NULL, 2, "frame_count is 2");
    b.items[1] = NULL;
    expect_refusal(&b, b.items, 3, "frames[1] is NULL");
    frames_of(&b);
    b.frames[2][4] = NAN;
    expect_refusal(&b, b.items, 3, "frames[2]");
    bending_free(&b);
}

static void threads_change_nothing(void **state) {
    (void)state;
    bending one = bending_of(BODY_HAND, 3000, 1.0, 1), four = bending_of(BODY_HAND, 3000, 1.0, 4);
    cscd_plan *a = plan_of(&one, CSCD_METHOD_AUTO, frames_of(&one), FRAMES),
              *b = plan_of(&four, CSCD_METHOD_AUTO, frames_of(&four), FRAMES);
    expect_same_plan(a, b, one.shape.triangle_count);
    for (uint32_t i = 0; i < cscd_plan_compared_count(a); i++)
        assert_true(cscd_plan_compared(a, i).tested_share == cscd_plan_compared(b, i).tested_share);
    cscd_plan_destroy(a);
    cscd_plan_destroy(b);
    bending_free(&one);
    bending_free(&four);
}

/* ---- method auto ----------------------------------------------------------------------------------------- */

/* The plan kept is that of its own method, and leaves no more than any other. */
static void keeps_the_best(void **state) {
    (void)state;
    static const body_kind kinds[] = {BODY_SPHERE, BODY_FIGURE, BODY_TORUS, BODY_CAPSULE};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        bending b = bending_of(kinds[i], 1500, 0.0, 1);
        cscd_plan *best = plan_of(&b, CSCD_METHOD_AUTO, NULL, 0);
        const uint32_t count = cscd_plan_compared_count(best);
        double kept = 2.0, least = 2.0;
        assert_int_equal(count, 5);
        for (uint32_t c = 0; c < count; c++) {
            const cscd_compared_plan found = cscd_plan_compared(best, c);
            assert_true(found.failure == NULL && found.region_count > 0);
            least = fmin(least, found.tested_share);
            if (!found.kept) continue;
            assert_true(kept == 2.0 && found.method == cscd_plan_method(best));
            assert_int_equal(found.region_count, cscd_plan_region_count(best));
            kept = found.tested_share;
        }
        assert_true(kept <= least / 0.98);
        if (cscd_plan_method(best) == CSCD_METHOD_CHARGE) {
            cscd_plan *charge = plan_of(&b, CSCD_METHOD_CHARGE, NULL, 0);
            expect_same_plan(best, charge, b.shape.triangle_count);
            cscd_plan_destroy(charge);
        }
        if (kinds[i] != BODY_CAPSULE) assert_int_equal(cscd_plan_method(best), CSCD_METHOD_CHARGE);
        cscd_plan_destroy(best);
        bending_free(&b);
    }
}

static cscd_plan *plan_again(const bending *b, const cscd_compared_plan *found,
                             const cscd_view *const *frames, uint32_t count) {
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    options.method = found->method;
    options.k = found->k;
    options.frames = frames;
    options.frame_count = count;
    assert_int_equal(cscd_plan_create(b->context, b->mesh,
                                      CSCD_DOUBLES(b->shape.positions, b->shape.vertex_count), &options,
                                      &plan),
                     CSCD_OK);
    return plan;
}

static bool *find_borders(const bending *b, const cscd_plan *plan) {
    bool *vertices = body_allocate(b->shape.vertex_count, sizeof *vertices);
    bool *triangles = body_allocate(b->shape.triangle_count, sizeof *triangles);
    uint32_t *regions = body_allocate(b->shape.vertex_count, sizeof *regions);
    for (size_t i = 0; i < (size_t)b->shape.triangle_count * 3; i++) {
        const uint32_t v = b->shape.triangles[i], r = cscd_plan_triangle_region(plan, (uint32_t)(i / 3)) + 1;
        vertices[v] |= regions[v] != 0 && regions[v] != r;
        regions[v] = r;
    }
    for (size_t i = 0; i < (size_t)b->shape.triangle_count * 3; i++)
        triangles[i / 3] |= vertices[b->shape.triangles[i]];
    free(vertices);
    free(regions);
    return triangles;
}

/* The share of the triangles at borders, or not S+ for a detector that stands still in the frame. */
static double tested_in(const bending *b, const cscd_plan *plan, const double *frame) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    cscd_contacts contacts;
    bool *borders = find_borders(b, plan);
    uint32_t count = 0;
    options.method = cscd_plan_method(plan);
    options.start = CSCD_START_VOUCHED;
    assert_int_equal(cscd_detector_create(b->context, b->mesh, plan, &options, &detector), CSCD_OK);
    const cscd_view *x = CSCD_DOUBLES(frame, b->shape.vertex_count);
    assert_int_equal(cscd_detector_step(detector, x, x, &contacts), CSCD_OK);
    for (uint32_t t = 0; t < b->shape.triangle_count; t++)
        count += borders[t] || cscd_detector_orientation(detector, t) != 1;
    cscd_detector_destroy(detector);
    free(borders);
    return (double)count / b->shape.triangle_count;
}

/* What is predicted is what a detector does not cull, and a part of what is seen at a low angle. */
static void predicts_what_a_detector_does(void **state) {
    (void)state;
    enum { TAKEN = 4 };
    bending b = bending_of(BODY_HAND, 3000, 1.5, 1);
    cscd_plan *best = plan_of(&b, CSCD_METHOD_AUTO, frames_of(&b), TAKEN);
    for (uint32_t i = 0; i < cscd_plan_compared_count(best); i++) {
        const cscd_compared_plan found = cscd_plan_compared(best, i);
        cscd_plan *plan = plan_again(&b, &found, frames_of(&b), TAKEN);
        double tested = tested_in(&b, plan, b.shape.positions);
        for (int f = 0; f < TAKEN; f++) tested += tested_in(&b, plan, b.frames[f]);
        tested /= TAKEN + 1;
        assert_int_equal(cscd_plan_region_count(plan), found.region_count);
        if (found.tested_share < tested - 1e-3 || found.tested_share > tested + 0.08)
            fail_msg("%u regions: predicted %g, found %g", found.region_count, found.tested_share, tested);
        cscd_plan_destroy(plan);
    }
    cscd_plan_destroy(best);
    bending_free(&b);
}

static void turn_inside_out(body *b) {
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const uint32_t held = b->triangles[(size_t)t * 3];
        b->triangles[(size_t)t * 3] = b->triangles[(size_t)t * 3 + 1];
        b->triangles[(size_t)t * 3 + 1] = held;
    }
}

/* What one region for the figure leaves to test. */
static double share_of_figure(bool turned, uint32_t left_out) {
    body shape = body_of(BODY_FIGURE, 1000);
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    cscd_plan_options options = cscd_plan_defaults();
    options.method = CSCD_METHOD_AUTO;
    if (turned) turn_inside_out(&shape);
    const cscd_object_desc desc =
        cscd_object_of_triangles(shape.vertex_count, shape.triangle_count - left_out, shape.triangles);
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(
        cscd_plan_create(context, mesh, CSCD_DOUBLES(shape.positions, shape.vertex_count), &options, &plan),
        CSCD_OK);
    const double share = cscd_plan_compared(plan, 1).tested_share;
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    body_free(&shape);
    return share;
}

static void inside_out_is_the_same_but_open_is_not(void **state) {
    (void)state;
    const double share = share_of_figure(false, 0);
    assert_true(fabs(share - share_of_figure(true, 0)) < 1e-6 && share < 0.5);
    assert_true(share_of_figure(false, 1) == 1.0);
}

/* Two triangles with one centroid: their charge is an error, and the other methods go on. */
static void goes_on_without_charge(void **state) {
    (void)state;
    static const double corners[] = {3, 0, 0, 0, 3, 0, -3, -3, 0, -3, 0, 0, 0, -3, 0, 3, 3, 0};
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5, 0, 3, 5};
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    cscd_plan_options options = cscd_plan_defaults();
    const cscd_object_desc desc = cscd_object_of_triangles(6, 3, triangles);
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    options.method = CSCD_METHOD_AUTO;
    assert_int_equal(cscd_plan_create(context, mesh, CSCD_DOUBLES(corners, 6), &options, &plan), CSCD_OK);
    assert_string_equal(cscd_context_detail(context), "");
    assert_int_equal(cscd_plan_compared(plan, 0).region_count, 0);
    assert_non_null(strstr(cscd_plan_compared(plan, 0).failure, "same centroid"));
    assert_int_equal(cscd_plan_method(plan), CSCD_METHOD_SINGLE);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_capsule_is_cut_for_its_bend),
        cmocka_unit_test(frames_at_rest_change_nothing),
        cmocka_unit_test(some_of_many_frames_count),
        cmocka_unit_test(refuses_bad_frames),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(keeps_the_best),
        cmocka_unit_test(predicts_what_a_detector_does),
        cmocka_unit_test(inside_out_is_the_same_but_open_is_not),
        cmocka_unit_test(goes_on_without_charge),
    };
    return cmocka_run_group_tests_name("motion", tests, NULL, NULL);
}
