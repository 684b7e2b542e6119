/* The detector points that a detector reports are the moved means of their regions' triangles, and the
 * reported orientations are relative to them. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "runtime/culling/culling.h"
#include "tests/support/calls.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

static uint32_t region_count(const cscd_detector *detector) {
    uint32_t count = 0;
    double points[2][3];
    while (cscd_detector_region_point(detector, count, points[0], points[1])) count++;
    return count;
}

static scene interval; /* large; one test at a time */

static void subtract_points(const double a[3], const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

/* Returns the largest coordinate of the interval; rounding is relative to it. */
static double reach_of(const scene *s) {
    double largest = 0.0;
    for (uint32_t i = 0; i < s->vertex_count * 3; i++)
        largest = fmax(largest, fmax(fabs(s->x0[i]), fabs(s->x1[i])));
    return largest;
}

/* Computes the mean of the centroids of a component's triangles. */
static void mean_of(const rig *r, const scene *s, const double *x, uint32_t component, double out[3]) {
    uint32_t count = 0;
    memset(out, 0, sizeof(double[3]));
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        if (cscd_mesh_triangle_component(r->mesh, t) != component) continue;
        count++;
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                out[k] += x[(size_t)s->triangles[t * 3 + (uint32_t)i] * 3 + (size_t)k];
    }
    for (int k = 0; k < 3; k++) out[k] /= 3.0 * count;
}

TEST(without_a_plan_points_are_means) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_SINGLE;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 3, &interval);
        rig r = rig_create(&interval, 1, &options);
        rig_step(&r, &interval);
        cscd_intersections crossing;
        assert_int_equal(check_packed(r.detector, interval.x0, &crossing), CSCD_OK); /* no trace */
        uint32_t count = cscd_mesh_component_count(r.mesh);
        assert_int_equal(region_count(r.detector), count);
        for (uint32_t c = 0; c < count; c++) {
            double start[3], end[3], means[2][3];
            cscd_detector_region_point(r.detector, c, start, end);
            mean_of(&r, &interval, interval.x0, c, means[0]);
            mean_of(&r, &interval, interval.x1, c, means[1]);
            for (int k = 0; k < 3; k++) {
                assert_true(fabs(start[k] - means[0][k]) <= 1e-5 * reach_of(&interval));
                assert_true(fabs(end[k] - means[1][k]) <= 1e-5 * reach_of(&interval));
            }
        }
        rig_destroy(&r);
    }
}

/* Returns (p0 - d) . n of a triangle at a moment, and the size that its rounding is relative to. */
static double facing_of(uint32_t t, double time, const double d0[3], const double d1[3], double *size) {
    double p[3][3], d[3], a[3], b[3];
    for (int i = 0; i < 3; i++) {
        size_t v = (size_t)interval.triangles[t * 3 + (uint32_t)i] * 3;
        for (size_t k = 0; k < 3; k++)
            p[i][k] = (1.0 - time) * interval.x0[v + k] + time * interval.x1[v + k];
    }
    for (int k = 0; k < 3; k++) d[k] = p[0][k] - ((1.0 - time) * d0[k] + time * d1[k]);
    subtract_points(p[1], p[0], a);
    subtract_points(p[2], p[0], b);
    double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    *size = sqrt((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
    return d[0] * n[0] + d[1] * n[1] + d[2] * n[2];
}

static uint32_t check_facing(const rig *r, const cscd_plan *plan) {
    uint32_t checked = 0;
    for (uint32_t t = 0; t < interval.triangle_count; t++) {
        int orientation = cscd_detector_orientation(r->detector, t);
        double start[3], end[3], size;
        cscd_detector_region_point(r->detector, cscd_plan_triangle_region(plan, t), start, end);
        for (int i = 0; i <= 4 && orientation != 0; i++, checked++) {
            double sign = facing_of(t, 0.25 * i, start, end, &size);
            assert_true(orientation * sign >= -1e-4 * size);
        }
    }
    return checked;
}

TEST(orientations_are_seen_from_these_points) {
    static const scene_family families[] = {SCENE_NOISY_SPHERE, SCENE_BENT_CAPSULE, SCENE_SQUASHED_TORUS,
                                            SCENE_LINKED_TORI};
    cscd_plan_options plan_options = cscd_plan_defaults();
    cscd_detector_options options = cscd_detector_defaults();
    plan_options.method = options.method = CSCD_METHOD_KMEANS;
    uint32_t checked = 0;
    for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
        scene_make(families[f], 2, &interval);
        rig r = rig_create(&interval, 1, NULL);
        cscd_plan *plan;
        cscd_contacts contacts;
        assert_int_equal(plan_create_packed(r.mesh, interval.x0, &plan_options, &plan), CSCD_OK);
        cscd_detector_destroy(r.detector);
        assert_int_equal(detector_create_here(r.mesh, plan, &options, &r.detector), CSCD_OK);
        assert_int_equal(step_packed(r.detector, interval.x0, interval.x1, &contacts), CSCD_OK);
        assert_int_equal(region_count(r.detector), cscd_plan_region_count(plan));
        for (uint32_t i = 0; i < cscd_plan_region_count(plan); i++) { /* at rest they are those of the plan */
            double start[3], end[3];
            cscd_region region = cscd_plan_region(plan, i);
            cscd_detector_region_point(r.detector, i, start, end);
            for (int k = 0; k < 3; k++)
                assert_true(fabs(start[k] - region.detector_point[k]) <= 1e-5 * reach_of(&interval));
        }
        checked += check_facing(&r, plan);
        cscd_plan_destroy(plan);
        rig_destroy(&r);
    }
    assert_true(checked > 1000);
}

TEST(other_methods_have_no_regions) {
    scene_make(SCENE_NOISY_SPHERE, 1, &interval);
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_BRUTE, CSCD_METHOD_ICCD};
    cscd_detector_options options = cscd_detector_defaults();
    for (int i = 0; i < 3; i++) {
        options.method = method_or_none(methods[i]);
        rig r = rig_create(&interval, 1, &options);
        assert_int_equal(region_count(r.detector), 0);
        rig_destroy(&r);
    }
    options.method = CSCD_METHOD_SINGLE;
    options.min_separation = 1e-3;
    rig r = rig_create(&interval, 1, &options);
    assert_int_equal(region_count(r.detector), 0);
    rig_destroy(&r);
}
