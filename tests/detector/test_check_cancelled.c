/* A static check that is cancelled when all is found leaves nothing behind that a later step could believe. */
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { TRIALS = 60 };

static scene shape; /* large; one test at a time */
static double crossing[SCENE_VERTICES_MAX * 3], end[SCENE_VERTICES_MAX * 3];

typedef struct ignoring_host {
    cscd_context *context;
    bool cancels;
} ignoring_host;

static bool cancel_in_ignore(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    ignoring_host *h = user;
    (void)kind, (void)a, (void)b;
    if (h->cancels) cscd_context_cancel(h->context);
    return false;
}

static bool report_nothing(void *user, const char *stage, double fraction) {
    (void)user, (void)stage, (void)fraction;
    return true;
}

/* A sphere at x0, wrung so that it crosses itself, and moved a little from there. */
static void make_positions(random_stream *random) {
    double by = stream_between(random, 0.3, 2.0), wave[4];
    scene_clear(&shape);
    scene_add_sphere(&shape, (double[3]){0, 0, 0}, 1.0, 10, 14);
    for (int i = 0; i < 4; i++) wave[i] = stream_between(random, 1.0, 6.0);
    for (uint32_t v = 0; v < shape.vertex_count; v++) {
        const double *p = shape.x0 + 3 * v;
        double *q = crossing + 3 * v;
        q[0] = p[0] + by * sin(wave[0] * p[1] + wave[2]);
        q[1] = p[1] + by * sin(wave[1] * p[2] + wave[3]);
        q[2] = p[2] + by * sin(wave[0] * p[0] + wave[3]);
        for (int k = 0; k < 3; k++) end[3 * v + (uint32_t)k] = q[k] + stream_between(random, -0.02, 0.02);
    }
}

static cscd_detector *create_detector(ignoring_host *h, const cscd_mesh *mesh, cscd_method method) {
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.ignore = cancel_in_ignore;
    options.ignore_user = h;
    expect_ok(cscd_detector_create(h->context, mesh, NULL, &options, &detector));
    return detector;
}

/* Returns whether the check was cancelled. */
static bool step_after_check(ignoring_host *h, const cscd_mesh *mesh) {
    cscd_detector *culling = create_detector(h, mesh, CSCD_METHOD_SINGLE);
    cscd_detector *brute = create_detector(h, mesh, CSCD_METHOD_BRUTE);
    cscd_contacts found, expected;
    cscd_intersections state;
    h->cancels = false;
    expect_ok(step_packed(culling, shape.x0, shape.x0, &found)); /* the sphere is proven */
    h->cancels = true;
    cscd_status status = check_packed(culling, crossing, &state);
    h->cancels = false;
    assert_true(status == CSCD_OK || status == CSCD_CANCELLED);
    expect_ok(step_packed(culling, crossing, end, &found));
    expect_ok(step_packed(brute, crossing, end, &expected));
    assert_int_equal(found.count, expected.count);
    cscd_detector_destroy(culling);
    cscd_detector_destroy(brute);
    return status == CSCD_CANCELLED;
}

TEST(later_steps_lose_nothing) {
    random_stream random = stream_start(17);
    ignoring_host h = {NULL, false};
    cscd_context_options options = cscd_context_defaults();
    uint32_t cancelled = 0;
    options.progress.report = report_nothing;
    expect_ok(cscd_context_create(&options, &h.context));
    for (int trial = 0; trial < TRIALS; trial++) {
        make_positions(&random);
        cscd_mesh *mesh = mesh_of_scene(h.context, &shape);
        cancelled += step_after_check(&h, mesh);
        cscd_mesh_destroy(mesh);
    }
    assert_true(cancelled > TRIALS / 2);
    cscd_context_destroy(h.context);
}
