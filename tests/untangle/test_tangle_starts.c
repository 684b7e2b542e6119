/* What untangling keeps bit for bit: coordinates next to 0 of pinned vertices, and seams between floats and doubles. */
#include "tests/support/calls.h"
#include "tests/support/scenes.h"

#include <math.h>
#include <stdlib.h>

/* Two balls, an object each, in each other, and one far away. */
enum { RINGS = 8, SEGMENTS = 10, ONE = RINGS * SEGMENTS + 2, ALL = 3 * ONE };

typedef struct ball_rig {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_untangled found;
    double x[ALL * 3], reached[ALL * 3], weights[ALL];
} ball_rig;

static ball_rig *balls_open(cscd_detector_options options, const cscd_context_options *host) {
    static scene one;
    ball_rig *b = calloc(1, sizeof *b);
    assert_non_null(b);
    scene_clear(&one);
    scene_add_sphere(&one, (const double[]){0.0, 0.0, 0.0}, 1.0, RINGS, SEGMENTS);
    assert_int_equal(one.vertex_count, ONE);
    cscd_object_desc objects[3];
    for (int i = 0; i < 3; i++) {
        objects[i] = cscd_object_of_triangles(ONE, one.triangle_count, one.triangles);
        for (size_t v = 0; v < ONE; v++) {
            for (size_t k = 0; k < 3; k++)
                b->x[3 * ((size_t)i * ONE + v) + k] =
                    one.x0[3 * v + k] + (k == 0 ? (const double[]){0.0, 1.7, 50.0}[i] : 0.03 * (i == 1));
        }
    }
    for (size_t v = 0; v < ALL; v++) b->weights[v] = 1.0;
    expect_ok(cscd_context_create(host, &b->context));
    expect_ok(cscd_mesh_create(b->context, objects, 3, &b->mesh));
    expect_ok(detector_create_here(b->mesh, NULL, &options, &b->detector));
    return b;
}

static void balls_close(ball_rig *b) {
    cscd_detector_destroy(b->detector);
    cscd_mesh_destroy(b->mesh);
    cscd_context_destroy(b->context);
    free(b);
}

static cscd_status balls_untangle(ball_rig *b) {
    cscd_untangle_options options = cscd_untangle_defaults();
    options.weights = b->weights;
    return cscd_detector_untangle(b->detector, CSCD_DOUBLES(b->x, ALL), &options,
                                  CSCD_MUTABLE_DOUBLES(b->reached, ALL), &b->found);
}

/* Signs of 0, and numbers that are nearly too near to 0 for the exact predicates, are kept where vertices are pinned, and pin nothing else. */
TEST(pinned_zeros_keep_their_signs) {
    for (int tiny = 0; tiny < 2; tiny++) {
        ball_rig *b = balls_open(cscd_detector_defaults(), NULL);
        size_t zeros = 0;
        for (size_t v = 0; v < ONE; v++) {
            b->weights[v] = (double)INFINITY;
            for (size_t k = 3 * v; k < 3 * v + 3; k++) {
                if (fabs(b->x[k]) > 1e-9) continue;
                b->x[k] = tiny ? 0x1p-295 : -0.0;
                zeros++;
            }
        }
        assert_true(zeros > 0);
        expect_ok(balls_untangle(b));
        assert_true(b->found.clean && b->found.start != CSCD_UNTANGLE_NO_START);
        assert_memory_equal(b->reached, b->x, ONE * sizeof(double[3]));
        assert_true(b->found.moved_vertices <= ONE);
        balls_close(b);
    }
}

/* What does not move keeps the sign of 0, too. */
TEST(unmoved_zeros_are_not_moved) {
    ball_rig *b = balls_open(cscd_detector_defaults(), NULL);
    for (size_t k = 0; k < (size_t)3 * ALL; k++) {
        if (fabs(b->x[k]) <= 1e-9) b->x[k] = -0.0;
    }
    expect_ok(balls_untangle(b));
    assert_true(b->found.clean && b->found.moved_vertices > 0 && b->found.moved_vertices <= 2 * ONE);
    assert_memory_equal(b->reached + (size_t)6 * ONE, b->x + (size_t)6 * ONE, ONE * sizeof(double[3]));
    balls_close(b);
}

/* One object is stored as floats, the other as doubles, and a seam joins the two. */
TEST(seams_of_floats_and_doubles_stay_together) {
    static float floats[ONE * 3];
    for (int other = 0; other < 2; other++) { /* the first object is of floats, or the second */
        const uint32_t seam[2] = {ONE / 2, ONE + ONE / 2 + 3};
        cscd_detector_options options = cscd_detector_defaults();
        options.seams = seam;
        options.seam_count = 1;
        options.seam_reach = (double)INFINITY;
        ball_rig *b = balls_open(options, NULL);
        for (size_t k = 0; k < 3; k++)
            b->x[3 * (size_t)seam[0] + k] = b->x[3 * (size_t)seam[1] + k] =
                (double)(float)b->x[3 * (size_t)seam[0] + k];
        double *doubles = b->x + (other ? 0 : 3 * ONE), *far = b->x + (size_t)6 * ONE;
        const double *rounded = b->x + (other ? 3 * ONE : 0);
        for (size_t k = 0; k < (size_t)3 * ONE; k++) floats[k] = (float)rounded[k];
        cscd_mutable_view views[3] = {*CSCD_MUTABLE_FLOATS(floats, ONE), *CSCD_MUTABLE_DOUBLES(doubles, ONE),
                                      *CSCD_MUTABLE_DOUBLES(far, ONE)};
        cscd_view given[3] = {*CSCD_FLOATS(floats, ONE), *CSCD_DOUBLES(doubles, ONE),
                              *CSCD_DOUBLES(far, ONE)};
        for (int i = 0; i < 3; i++) views[i].object_count = given[i].object_count = 1;
        const cscd_mutable_view reached[3] = {views[other], views[1 - other], views[2]};
        const cscd_view positions[3] = {given[other], given[1 - other], given[2]};
        expect_ok(cscd_detector_untangle(b->detector, positions, NULL, reached, &b->found));
        assert_true(b->found.moved);
        const size_t of_floats = 3 * (size_t)(other ? seam[1] - ONE : seam[0]),
                     of_doubles = 3 * (size_t)(other ? seam[0] : seam[1] - ONE);
        for (size_t k = 0; k < 3; k++) assert_true((double)floats[of_floats + k] == doubles[of_doubles + k]);
        balls_close(b);
    }
}

static bool cancel_call(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    ball_rig *rig = *(ball_rig **)user;
    (void)kind, (void)a, (void)b;
    cscd_context_cancel(rig->context);
    return false;
}

/* Before the pairs are counted, nothing can be said of them. */
TEST(what_is_cancelled_before_it_is_counted_writes_nothing) {
    ball_rig *b = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = cancel_call;
    options.ignore_user = (void *)&b;
    b = balls_open(options, NULL);
    memset(b->reached, 0x5a, sizeof b->reached);
    memset(&b->found, 0x5a, sizeof b->found);
    static double before[ALL * 3];
    memcpy(before, b->reached, sizeof before);
    assert_int_equal(balls_untangle(b), CSCD_CANCELLED);
    assert_memory_equal(b->reached, before, sizeof before);
    assert_memory_equal(&b->found, before, sizeof b->found);
    balls_close(b);
}

/* Each allocation fails once: OUT_OF_MEMORY, nothing is written or lost, and the next call is right. */
TEST(failed_allocations_change_nothing) {
    counting_allocator counter = counting_allocator_start();
    cscd_context_options host = cscd_context_defaults();
    host.allocator = counting_allocator_interface(&counter);
    ball_rig *b = balls_open(cscd_detector_defaults(), &host);
    static double right[ALL * 3];
    expect_ok(balls_untangle(b));
    memcpy(right, b->reached, sizeof right);
    size_t failed = 0;
    for (size_t n = 0; n < PACED(60, 30); n++) {
        memcpy(b->reached, b->x, sizeof b->reached);
        counter.fail_at = counter.calls + n + 1;
        const cscd_status status = balls_untangle(b);
        counter.fail_at = SIZE_MAX;
        if (status == CSCD_OK) continue;
        assert_int_equal(status, CSCD_OUT_OF_MEMORY);
        assert_memory_equal(b->reached, b->x, sizeof b->reached);
        failed++;
    }
    assert_true(failed > 20);
    expect_ok(balls_untangle(b));
    assert_memory_equal(b->reached, right, sizeof right);
    balls_close(b);
    assert_int_equal(counter.live, 0);
}

/* ---- far from 1 ---------------------------------------------------------------------------------------- */

static void scale_balls(ball_rig *b, double scale) {
    for (size_t k = 0; k < (size_t)3 * ALL; k++) b->x[k] = fabs(b->x[k]) > 1e-9 ? scale * b->x[k] : 0.0;
}

/* The areas of areas are no doubles, or all 0. */
TEST(the_size_of_the_mesh_does_not_matter) {
    for (int i = 0; i < 3; i++) {
        ball_rig *b = balls_open(cscd_detector_defaults(), NULL);
        const double scale = (const double[]){1.0, 0x1p280, 0x1p-280}[i];
        scale_balls(b, scale);
        expect_ok(balls_untangle(b));
        assert_true(b->found.clean && b->found.start == CSCD_UNTANGLE_PUSHED && b->found.steps > 0);
        assert_true(b->found.displacement < 0.5 * scale);
        balls_close(b);
    }
}

TEST(weights_may_be_any_numbers) {
    for (int i = 0; i < 2; i++) {
        ball_rig *b = balls_open(cscd_detector_defaults(), NULL);
        for (size_t v = 0; v < ALL; v++)
            b->weights[v] = v % 2 == 0 ? 1e300 : (const double[]){1e-300, 1.0}[i];
        expect_ok(balls_untangle(b));
        assert_true(b->found.clean && b->found.steps > 0);
        balls_close(b);
    }
}

/* A start in which vertices that are not active are elsewhere is of no use; the call goes on without it. */
TEST(what_is_not_active_stays_whatever_the_start) {
    ball_rig *b = balls_open(cscd_detector_defaults(), NULL);
    static double start[ALL * 3];
    static uint32_t active[ONE];
    memcpy(start, b->x, sizeof start);
    for (size_t v = 0; v < ONE; v++) {
        active[v] = (uint32_t)v;
        start[3 * (ONE + v)] += 5.0;
    }
    expect_ok(cscd_detector_set_active(b->detector, active, ONE));
    cscd_untangle_options options = cscd_untangle_defaults();
    options.start = CSCD_DOUBLES(start, ALL);
    expect_ok(cscd_detector_untangle(b->detector, CSCD_DOUBLES(b->x, ALL), &options,
                                     CSCD_MUTABLE_DOUBLES(b->reached, ALL), &b->found));
    assert_true(b->found.clean && b->found.start == CSCD_UNTANGLE_PUSHED);
    assert_memory_equal(b->reached + (size_t)3 * ONE, b->x + (size_t)3 * ONE, 2 * ONE * sizeof(double[3]));
    balls_close(b);
}
