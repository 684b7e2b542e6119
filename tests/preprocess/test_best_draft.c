/* Method auto compares plans, and keeps the one that leaves the least to test. */
#include "cscd/research.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The plan kept is that of its own method, and leaves no more than any other. */
TEST(keeps_the_best) {
    static const body_kind kinds[] = {BODY_SPHERE, BODY_FIGURE, BODY_TORUS, BODY_CAPSULE, BODY_GENUS2};
    size_t later = 0; /* of which a later plan than the first is kept */
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const uint32_t triangles = kinds[i] == BODY_GENUS2 ? body_nearest_count(BODY_GENUS2, 800) : 1500;
        bending b = bending_of(kinds[i], triangles, 0.0, 1);
        cscd_plan *best = bending_plan(&b, CSCD_METHOD_AUTO, NULL, 0);
        const uint32_t count = cscd_plan_describe(best).compared_count;
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
            cscd_plan *charge = bending_plan(&b, CSCD_METHOD_CHARGE, NULL, 0);
            bending_expect_same(best, charge, b.shape.triangle_count);
            cscd_plan_destroy(charge);
        }
        if (i < 3) assert_int_equal(cscd_plan_method(best), CSCD_METHOD_CHARGE);
        later += cscd_plan_method(best) != CSCD_METHOD_CHARGE;
        cscd_plan_destroy(best);
        bending_free(&b);
    }
    assert_true(later > 0);
}

static cscd_plan *plan_again(const bending *b, const cscd_compared_plan *found,
                             const cscd_view *const *frames, uint32_t count) {
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    options.method = found->method;
    options.k = found->k;
    options.frames = frames;
    options.frame_count = count;
    expect_ok(cscd_plan_create(b->context, b->mesh, CSCD_DOUBLES(b->shape.positions, b->shape.vertex_count),
                               &options, &plan));
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
    expect_ok(cscd_detector_create(b->context, b->mesh, plan, &options, &detector));
    const cscd_view *x = CSCD_DOUBLES(frame, b->shape.vertex_count);
    expect_ok(cscd_detector_step(detector, x, x, &contacts));
    for (uint32_t t = 0; t < b->shape.triangle_count; t++)
        count += borders[t] || cscd_detector_orientation(detector, t) != 1;
    cscd_detector_destroy(detector);
    free(borders);
    return (double)count / b->shape.triangle_count;
}

/* What is predicted is what a detector does not cull, and a part of what is seen at a low angle. */
TEST(predicts_what_a_detector_does) {
    enum { TAKEN = 4 };
    bending b = bending_of(BODY_HAND, 3000, 1.5, 1);
    cscd_plan *best = bending_plan(&b, CSCD_METHOD_AUTO, bending_frames(&b), TAKEN);
    for (uint32_t i = 0; i < cscd_plan_describe(best).compared_count; i++) {
        const cscd_compared_plan found = cscd_plan_compared(best, i);
        cscd_plan *plan = plan_again(&b, &found, bending_frames(&b), TAKEN);
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
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, &desc, 1, &mesh));
    expect_ok(
        cscd_plan_create(context, mesh, CSCD_DOUBLES(shape.positions, shape.vertex_count), &options, &plan));
    const double share = cscd_plan_compared(plan, 1).tested_share;
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    body_free(&shape);
    return share;
}

TEST(inside_out_is_the_same_but_open_is_not) {
    const double share = share_of_figure(false, 0);
    assert_true(fabs(share - share_of_figure(true, 0)) < 1e-6 && share < 0.5);
    assert_true(share_of_figure(false, 1) == 1.0);
}

/* Two triangles with one centroid: their charge is an error, and the other methods go on. */
TEST(goes_on_without_charge) {
    static const double corners[] = {3, 0, 0, 0, 3, 0, -3, -3, 0, -3, 0, 0, 0, -3, 0, 3, 3, 0};
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5, 0, 3, 5};
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    cscd_plan_options options = cscd_plan_defaults();
    const cscd_object_desc desc = cscd_object_of_triangles(6, 3, triangles);
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, &desc, 1, &mesh));
    options.method = CSCD_METHOD_AUTO;
    expect_ok(cscd_plan_create(context, mesh, CSCD_DOUBLES(corners, 6), &options, &plan));
    assert_string_equal(cscd_context_detail(context), "");
    assert_int_equal(cscd_plan_compared(plan, 0).region_count, 0);
    assert_non_null(strstr(cscd_plan_compared(plan, 0).failure, "same centroid"));
    assert_int_equal(cscd_plan_method(plan), CSCD_METHOD_SINGLE);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

TEST(threads_change_nothing) {
    bending one = bending_of(BODY_HAND, 3000, 1.0, 1), four = bending_of(BODY_HAND, 3000, 1.0, 4);
    cscd_plan *a = bending_plan(&one, CSCD_METHOD_AUTO, bending_frames(&one), BENDING_FRAMES),
              *b = bending_plan(&four, CSCD_METHOD_AUTO, bending_frames(&four), BENDING_FRAMES);
    bending_expect_same(a, b, one.shape.triangle_count);
    for (uint32_t i = 0; i < cscd_plan_describe(a).compared_count; i++)
        assert_true(cscd_plan_compared(a, i).tested_share == cscd_plan_compared(b, i).tested_share);
    cscd_plan_destroy(a);
    cscd_plan_destroy(b);
    bending_free(&one);
    bending_free(&four);
}
