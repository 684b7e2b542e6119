/* Culling is really on: on a human-like body that moves without contact, charge and single leave at most a
 * quarter of the triangle pairs, and one static check serves the whole recording. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>

enum { FRAME_COUNT = 16, TRIANGLE_COUNT = 2000 };

typedef struct share_recording {
    body shape;
    cscd_context *context;
    cscd_mesh *mesh;
    double *frames[FRAME_COUNT];
} share_recording;

/* Poses the body, which sways, turns at the hips, and walks by a few edge lengths per frame. */
static void pose_at(const body *shape, double t, double *out) {
    for (uint32_t v = 0; v < shape->vertex_count; v++) {
        const double *p = shape->positions + (size_t)v * 3;
        double angle = 0.5 * sin(2.0 * t) * p[2], lean = 0.15 * sin(3.0 * t) * p[2] * p[2];
        out[v * 3] = cos(angle) * p[0] - sin(angle) * p[1] + lean + 2.0 * t;
        out[v * 3 + 1] = sin(angle) * p[0] + cos(angle) * p[1];
        out[v * 3 + 2] = p[2];
    }
}

static int record_poses(void **state) {
    static share_recording r;
    r.shape = body_of(BODY_FIGURE, TRIANGLE_COUNT);
    cscd_object_desc desc =
        cscd_object_of_triangles(r.shape.vertex_count, r.shape.triangle_count, r.shape.triangles);
    if (cscd_context_create(NULL, &r.context) != CSCD_OK) return -1;
    if (cscd_mesh_create(r.context, &desc, 1, &r.mesh) != CSCD_OK) return -1;
    for (int i = 0; i < FRAME_COUNT; i++) {
        r.frames[i] = malloc(r.shape.vertex_count * sizeof(double[3]));
        if (r.frames[i] == NULL) return -1;
        pose_at(&r.shape, (double)i / FRAME_COUNT, r.frames[i]);
    }
    *state = &r;
    return 0;
}

static int release_recording(void **state) {
    share_recording *r = *state;
    for (int i = 0; i < FRAME_COUNT; i++) free(r->frames[i]);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    body_free(&r->shape);
    return 0;
}

typedef struct totals {
    uint64_t pairs, checks;
    size_t contacts;
    bool all_clean;
} totals;

static totals replay_poses(const share_recording *r, cscd_method method, cscd_mode mode) {
    totals sum = {.all_clean = true};
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    cscd_plan_options plan_options = cscd_plan_defaults();
    cscd_detector_options options = cscd_detector_defaults();
    plan_options.method = options.method = method;
    options.mode = mode;
    if (method != CSCD_METHOD_NONE)
        assert_int_equal(plan_create_packed(r->mesh, r->shape.positions, &plan_options, &plan), CSCD_OK);
    assert_int_equal(detector_create_here(r->mesh, plan, &options, &detector), CSCD_OK);
    for (int i = 0; i + 1 < FRAME_COUNT; i++) {
        cscd_contacts found;
        assert_int_equal(step_packed(detector, r->frames[i], r->frames[i + 1], &found), CSCD_OK);
        sum.contacts += found.count;
        sum.pairs += cscd_detector_counters(detector).pcp;
        sum.checks += cscd_detector_counters(detector).static_checks;
        sum.all_clean &= cscd_detector_guarantee(detector, 0).reason == CSCD_REASON_CLEAN;
    }
    cscd_detector_destroy(detector);
    cscd_plan_destroy(plan);
    return sum;
}

TEST(a_quarter_of_the_pairs) {
    const share_recording *r = *state;
    totals none = replay_poses(r, CSCD_METHOD_NONE, CSCD_MODE_ALL);
    assert_int_equal(none.contacts, 0);
    static const cscd_method methods[2] = {CSCD_METHOD_SINGLE, CSCD_METHOD_CHARGE};
    for (int i = 0; i < 4; i++) {
        cscd_mode mode = i < 2 ? CSCD_MODE_EARLIEST : CSCD_MODE_ALL;
        totals culled = replay_poses(r, methods[i % 2], mode);
        print_message("  %s, %s: %.1f %% of %llu pairs\n", cscd_method_name(methods[i % 2]),
                      cscd_name(CSCD_MODES, mode), 100.0 * (double)culled.pairs / (double)none.pairs,
                      (unsigned long long)none.pairs);
        assert_true(4 * culled.pairs <= none.pairs);
        assert_int_equal(culled.contacts, 0);
        assert_int_equal(culled.checks, 1);
        assert_true(culled.all_clean);
    }
}

AROUND_ALL(record_poses, release_recording)
