/* The orientation check of the thesis against values sampled over the interval. */
#include "runtime/baselines/published.h"
#include "tests/support/oracle.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

static scene s; /* large; one test at a time */

/* (p0 - dp) . n, equation 4.2, at one moment. */
static double value_at(const cscd_mesh *mesh, uint32_t triangle, const double point[2][3], double t) {
    double p[3][3], u[3], v[3], d[3];
    for (int i = 0; i < 3; i++) {
        const size_t at = (size_t)mesh->triangles[triangle][i] * 3;
        for (size_t k = 0; k < 3; k++) p[i][k] = (1.0 - t) * s.x0[at + k] + t * s.x1[at + k];
    }
    for (int k = 0; k < 3; k++) {
        u[k] = p[1][k] - p[0][k];
        v[k] = p[2][k] - p[0][k];
        d[k] = p[0][k] - ((1.0 - t) * point[0][k] + t * point[1][k]);
    }
    return d[0] * (u[1] * v[2] - u[2] * v[1]) + d[1] * (u[2] * v[0] - u[0] * v[2]) +
           d[2] * (u[0] * v[1] - u[1] * v[0]);
}

TEST(signs_hold_during_the_interval) {
    uint32_t counts[4] = {0}, missed = 0;
    for (uint32_t seed = 0; seed < 24; seed++) {
        scene_make(seed % 2 ? SCENE_BENT_CAPSULE : SCENE_SPIKE, seed, &s);
        for (uint32_t i = 0; i < s.vertex_count * 3 && seed % 3 == 0;
             i++) /* so that triangles turn over and back */
            s.x1[i] = s.x0[(i + 3 * (seed + 7)) % (s.vertex_count * 3)];
        rig r = rig_create(&s, 1, NULL);
        culling c;
        bool culled[COMPONENTS_MAX];
        memset(culled, true, sizeof culled);
        expect_ok(culling_create(r.mesh, NULL, &c));
        const swept_interval swept = {.mesh = r.mesh, .x0 = s.x0, .x1 = s.x1};
        const own_interval interval = {.swept = &swept, .culling = &c, .culled = culled};
        detector_points_move(&interval, seed % 4 < 2);
        orientations_check(&interval);
        for (uint32_t t = 0; t < r.mesh->triangle_count; t++) {
            const double(*point)[3] = (const double(*)[3])c.detector_points[c.triangle_regions[t]];
            double low = value_at(r.mesh, t, point, 0.0), high = low;
            for (int i = 1; i <= 32; i++) {
                const double value = value_at(r.mesh, t, point, i / 32.0);
                low = value < low ? value : low;
                high = value > high ? value : high;
            }
            counts[c.facing[t]]++;
            if (c.facing[t] == ORIENTATION_PLUS) assert_true(low > -1e-12);
            if (c.facing[t] == ORIENTATION_MINUS) assert_true(high < 1e-12);
            missed += seed % 3 != 0 && c.facing[t] == ORIENTATION_ZERO && (low > 0.0 || high < 0.0);
        }
        assert_true(c.plus + c.minus <= r.mesh->triangle_count);
        culling_destroy(&c);
        rig_destroy(&r);
    }
    print_message("  %u face away, %u towards, %u neither; %u of them have one sign\n",
                  counts[ORIENTATION_PLUS], counts[ORIENTATION_MINUS], counts[ORIENTATION_ZERO], missed);
    assert_true(counts[ORIENTATION_PLUS] > 1000 && counts[ORIENTATION_MINUS] > 20 &&
                counts[ORIENTATION_ZERO] > 20);
    assert_true(missed <
                counts[ORIENTATION_PLUS] / 20); /* coefficients of both signs, and one sign of the value */
}

/* What is not clean, or not culled, has no sign. */
TEST(only_what_is_clean_has_a_sign) {
    static bool clean[SCENE_TRIANGLES_MAX];
    bool culled[COMPONENTS_MAX] = {true};
    scene_make(SCENE_NOISY_SPHERE, 1, &s);
    rig r = rig_create(&s, 1, NULL);
    culling c;
    expect_ok(culling_create(r.mesh, NULL, &c));
    const swept_interval swept = {.mesh = r.mesh, .x0 = s.x0, .x1 = s.x1};
    own_interval interval = {.swept = &swept, .culling = &c, .culled = culled, .clean = clean};
    for (uint32_t t = 0; t < r.mesh->triangle_count; t++) clean[t] = t % 2 == 0;
    detector_points_move(&interval, true);
    orientations_check(&interval);
    for (uint32_t t = 1; t < r.mesh->triangle_count; t += 2) assert_int_equal(c.facing[t], ORIENTATION_ZERO);
    assert_true(c.plus > 0);
    culled[0] = false;
    interval.clean = NULL;
    orientations_check(&interval);
    assert_true(c.plus == 0 && c.minus == 0);
    culling_destroy(&c);
    rig_destroy(&r);
}
