/* No pair leaves the rung on which it starts: not one that is just above its distance when kernels part it, and not one
 * below it that is pressed until doubles end. */
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static scene pair; /* two triangles; one test at a time */

static const cscd_simd levels[] = {CSCD_SIMD_SCALAR, CSCD_SIMD_AUTO};

/* Returns a detector of two triangles with this distance. */
static rig rig_of_pair(double distance, cscd_simd simd) {
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5};
    cscd_context_options options = cscd_context_defaults();
    cscd_object_desc object = cscd_object_of_triangles(6, 2, triangles);
    cscd_detector_options detector_options = cscd_detector_defaults();
    options.simd = simd;
    detector_options.min_separation = distance;
    cscd_context *context = NULL;
    expect_ok(cscd_context_create(&options, &context));
    rig r = rig_of_objects(context, &object, 1, NULL, &detector_options);
    return r;
}

static void lift_upper(double *x, double by) {
    for (int v = 3; v < 6; v++) x[3 * v + 2] += by;
}

/* Goes as far as it may, and starts there the next time. */
static double go_on(const rig *r) {
    cscd_free_step step;
    double reached[18];
    expect_ok(max_step_packed(r->detector, pair.x0, pair.x1, reached, &step));
    memcpy(pair.x0, reached, sizeof reached);
    return step.fraction;
}

/* Two edges that cross, one of them far from its middle: the extent from their first point is nearly twice the longest
 * of the vectors in which the kernel measures. */
TEST(pairs_just_above_stay_above) {
    static const double flat[18] = {0, 0, 0, .99, 0, 0, .5, 0, -.9, .95, -.02, 0, 1.85, .5, 0, 1.4, .2, .5};
    const double distance = 0.5;
    for (int level = 0; level < 2; level++) {
        rig r = rig_of_pair(distance, levels[level]);
        uint32_t in_full = 0;
        for (int i = 0; i < 400; i++) {
            double above = distance * (1.0 + 1e-6) + (1.0 + i / 100.0) * 0x1p-40;
            memcpy(pair.x0, flat, sizeof flat);
            memcpy(pair.x1, flat, sizeof flat);
            lift_upper(pair.x0, 0.7);
            lift_upper(pair.x1, above);
            if (go_on(&r) < 1.0) continue;
            in_full++;
            memcpy(pair.x1, pair.x0, sizeof flat);
            lift_upper(pair.x1, -0.3);
            go_on(&r);
            if (!(pair.x0[11] >= distance)) fail_msg("sinks to %.17g", pair.x0[11]);
        }
        assert_true(in_full > 100);
        rig_destroy(&r);
    }
}

static uint32_t rung_number(double share) {
    uint32_t k = 0;
    for (double rung = 1.0; rung > share; rung *= 0.9) k++;
    return k;
}

static void place_torn(random_stream *random, double height) {
    static const double torn[18] = {0, 0, 0, 1, 0, 0, .5, 0, -.9, .5, -.5, 0, .5, .5, 0, .5, .1, .8};
    for (int i = 0; i < 18; i++) {
        bool level = i == 2 || i == 5 || i == 11 || i == 14;
        pair.x0[i] = torn[i] + (level ? 0.0 : stream_between(random, -0.1, 0.1));
    }
    lift_upper(pair.x0, height);
}

/* A hundred steps bring it as near to its floor as doubles allow, where the last bit of the rung counts. */
TEST(pressed_pairs_keep_their_rung) {
    random_stream random = stream_start(4711);
    for (int trial = 0; trial < 300; trial++) {
        double distance = stream_between(&random, 0.001, 0.02), share = stream_between(&random, 0.3, 0.9);
        rig r = rig_of_pair(distance, CSCD_SIMD_AUTO);
        place_torn(&random, share * distance);
        for (int step = 0; step < 100; step++) {
            memcpy(pair.x1, pair.x0, 18 * sizeof *pair.x1);
            lift_upper(pair.x1, -stream_between(&random, 0.5, 2.0) * distance);
            go_on(&r);
        }
        double end = pair.x0[11] / distance;
        if (rung_number(end * (1.0 + 1e-9)) > rung_number(share))
            fail_msg("trial %d sinks from %.9g to %.9g of its distance", trial, share, end);
        rig_destroy(&r);
    }
}
