/* Charge densities against physics: spheres, cubes, ellipsoids, and the laws of scale and place. */
#include "tests/support/preprocess/charge_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* How often shapes are split: to 5,120 and 3,072 triangles, or to 1,280 and 768. */
enum { FINEST = PACED(4, 3) };

static const double PI = 0x1.921fb54442d18p+1;

static double capacitance_of(const conductor *s) {
    charge_rig r = charge_rig_solve(s, 2);
    double capacitance = r.capacitance[0];
    charge_rig_destroy(&r);
    return capacitance;
}

static void assert_near(double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.12g, expected %.12g", value, expected);
}

/* Area of a triangle, and its centroid. */
static double triangle_area(const conductor *s, uint32_t triangle, double centroid[3]) {
    const double *p[3];
    double e[2][3], n[3];
    for (int i = 0; i < 3; i++) p[i] = s->positions + s->triangles[triangle * 3 + (uint32_t)i] * 3;
    for (int k = 0; k < 3; k++) {
        e[0][k] = p[1][k] - p[0][k];
        e[1][k] = p[2][k] - p[0][k];
        centroid[k] = (p[0][k] + p[1][k] + p[2][k]) / 3.0;
    }
    for (int k = 0; k < 3; k++)
        n[k] = e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
    return 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

TEST(charge_of_sphere) {
    double error_before = NAN, spread_before = NAN;
    for (int level = 1; level <= FINEST; level++) {
        conductor s = conductor_sphere(level);
        charge_rig r = charge_rig_solve(&s, 2);
        double spread = 0.0, error = 1.0 - r.capacitance[0], charge = 0.0, unused[3];
        for (uint32_t t = 0; t < s.triangle_count; t++) {
            spread = fmax(spread, fabs(r.density[t] * 4.0 * PI - 1.0));
            charge += r.density[t] * triangle_area(&s, t, unused);
        }
        print_message("sphere %u: C = %.9f, densities within %.2e\n", s.triangle_count, r.capacitance[0],
                      spread);
        assert_near(charge, r.capacitance[0], 1e-13);
        if (level > 1) {
            assert_near(error_before / error, 3.9, 0.2);                                  /* second order */
            assert_near((4.0 * error - error_before) / 3.0, 0.0, 0.12 * pow(0.1, level)); /* extrapolated */
            assert_true(spread < 0.6 * spread_before);
        }
        error_before = error;
        spread_before = spread;
        charge_rig_destroy(&r);
        conductor_free(&s);
    }
    assert_true(spread_before < PACED(0.005, 0.01));
}

/* 0.6606782 (the best values known agree in these digits). The density is infinite at the edges, so even
 * steps converge at first order; crowded towards the edges they do better. */
TEST(charge_of_cube) {
    const double exact = 0.6606782;
    double before = NAN, crowded = NAN;
    for (int level = 1; level <= FINEST; level++) {
        conductor s = conductor_cube(level);
        double even = capacitance_of(&s);
        conductor_crowd_edges(&s);
        crowded = capacitance_of(&s);
        print_message("cube %u: C = %.9f, crowded %.9f\n", s.triangle_count, even, crowded);
        assert_true(even < exact && crowded < exact);
        if (level > 1) assert_true(crowded > even); /* at first, edges have nothing but their middles */
        if (level > 1) assert_true((exact - even) < 0.65 * (exact - before));
        before = even;
        conductor_free(&s);
    }
    assert_near(crowded, exact, PACED(2e-4, 1e-3));
}

/* Carlson's R_F by duplication: 1 / R_F(a^2, b^2, c^2) is the capacitance of an ellipsoid. */
static double carlson_rf(double x, double y, double z) {
    for (int i = 0; i < 40; i++) {
        double shift = sqrt(x) * sqrt(y) + sqrt(y) * sqrt(z) + sqrt(z) * sqrt(x);
        x = 0.25 * (x + shift);
        y = 0.25 * (y + shift);
        z = 0.25 * (z + shift);
    }
    return 1.0 / sqrt((x + y + z) / 3.0);
}

/* density = Q / (4 pi a b c) / sqrt(x^2 / a^4 + y^2 / b^4 + z^2 / c^4) */
TEST(charge_of_ellipsoid) {
    const double axes[3] = {1.6, 1.0, 0.7}, nowhere[3] = {0.0, 0.0, 0.0};
    const double exact = 1.0 / carlson_rf(axes[0] * axes[0], axes[1] * axes[1], axes[2] * axes[2]);
    double error_before = NAN, worst = 0.0;
    assert_near(carlson_rf(1.0, 1.0, 1.0), 1.0, 1e-14);
    assert_near(carlson_rf(1.0, 2.0, 0.0), 1.3110287771461, 1e-12);
    for (int level = 2; level <= FINEST; level++) {
        conductor s = conductor_sphere(level);
        conductor_transform(&s, axes, nowhere);
        charge_rig r = charge_rig_solve(&s, 2);
        double error = exact - r.capacitance[0];
        worst = 0.0;
        for (uint32_t t = 0; t < s.triangle_count; t++) {
            double p[3], norm = 0.0, sum = 0.0;
            triangle_area(&s, t, p);
            for (int k = 0; k < 3; k++) norm += (p[k] / axes[k]) * (p[k] / axes[k]);
            for (int k = 0; k < 3; k++) sum += p[k] * p[k] / norm / pow(axes[k], 4.0);
            double law = exact / (4.0 * PI * axes[0] * axes[1] * axes[2]) / sqrt(sum);
            worst = fmax(worst, fabs(r.density[t] / law - 1.0));
        }
        print_message("ellipsoid %u: C = %.9f of %.9f, densities within %.2e\n", s.triangle_count,
                      r.capacitance[0], exact, worst);
        if (level > 2) assert_near(error_before / error, 3.9, 0.2);
        error_before = error;
        charge_rig_destroy(&r);
        conductor_free(&s);
    }
    assert_true(worst < 0.03);
}

/* The charge of one triangle at potential 1 at its centroid. */
TEST(one_triangle) {
    double positions[9] = {0, 0, 0, 1, 0, 0, 0.5, sqrt(0.75), 0};
    uint32_t triangle[3] = {0, 1, 2};
    conductor s = {3, 1, positions, triangle};
    charge_rig r = charge_rig_solve(&s, 1);
    assert_near(r.capacitance[0], 0.25 / log(2.0 + sqrt(3.0)), 1e-14);
    assert_near(r.density[0], 1.0 / sqrt(3.0) / log(2.0 + sqrt(3.0)), 1e-14);
    charge_rig_destroy(&r);
}

/* Four triangles; the capacitance lies between those of the spheres inside and around. */
TEST(charge_of_tetrahedron) {
    conductor s = conductor_tetrahedron();
    charge_rig r = charge_rig_solve(&s, 3);
    assert_true(r.capacitance[0] > 1.0 / (3.0 + sqrt(3.0)) && r.capacitance[0] < sqrt(0.75));
    for (int t = 1; t < 4; t++) assert_true(r.density[t] > 0.0);
    assert_near(r.density[0], r.density[1], 1e-14); /* by symmetry */
    assert_near(r.density[0], r.density[3], 1e-14);
    charge_rig_destroy(&r);
    conductor_free(&s);
}

static void assert_same(const double *a, const double *b, uint32_t count) {
    assert_memory_equal(a, b, count * sizeof *a);
}

/* Each component gives what it gives alone. */
TEST(components_are_independent) {
    const double half[3] = {0.5, 0.5, 0.5}, near[3] = {0.9, 0.1, 0.2};
    conductor first = conductor_sphere(2), second = conductor_cube(2), both = conductor_sphere(2);
    conductor_transform(&second, half, near);
    conductor_append(&both, &second);
    charge_rig a = charge_rig_solve(&first, 2), b = charge_rig_solve(&second, 2),
               r = charge_rig_solve(&both, 2);
    assert_int_equal(cscd_mesh_component_count(r.mesh), 2);
    assert_same(r.density, a.density, first.triangle_count);
    assert_same(r.density + first.triangle_count, b.density, second.triangle_count);
    assert_true(r.capacitance[0] == a.capacitance[0] && r.capacitance[1] == b.capacitance[0]);
    charge_rig_destroy(&a);
    charge_rig_destroy(&b);
    charge_rig_destroy(&r);
    conductor_free(&first);
    conductor_free(&second);
    conductor_free(&both);
}

/* density ~ 1 / length, capacitance ~ length; with powers of two, to the bit. */
TEST(scales_with_length) {
    const double factors[4] = {0x1p20, 0x1p-250, 0x1p280, 3.7}, nowhere[3] = {0.0, 0.0, 0.0};
    for (int f = 0; f < 4; f++) {
        const double scale[3] = {factors[f], factors[f], factors[f]}, off[3] = {0.75, 0.25, 0.5};
        const double stretch[3] = {1.0, 2.0, 0.5};
        conductor s = conductor_cube(2);
        conductor_transform(&s, stretch, off);
        charge_rig a = charge_rig_solve(&s, 2);
        conductor_transform(&s, scale, nowhere);
        charge_rig b = charge_rig_solve(&s, 2);
        double tolerance = f < 3 ? 0.0 : 1e-11;
        for (uint32_t t = 0; t < s.triangle_count; t++)
            assert_near(b.density[t] * factors[f] / a.density[t], 1.0, tolerance);
        assert_near(b.capacitance[0] / factors[f] / a.capacitance[0], 1.0, tolerance);
        charge_rig_destroy(&a);
        charge_rig_destroy(&b);
        conductor_free(&s);
    }
}

/* The cube's coordinates stay exact far from the origin, and so does the result. */
TEST(far_from_the_origin) {
    const double same[3] = {1.0, 1.0, 1.0}, offset[3] = {1e6, -1e6, 5e5};
    conductor s = conductor_cube(2);
    charge_rig a = charge_rig_solve(&s, 2);
    conductor_transform(&s, same, offset);
    charge_rig b = charge_rig_solve(&s, 2);
    assert_same(a.density, b.density, s.triangle_count);
    assert_true(a.capacitance[0] == b.capacitance[0]);
    charge_rig_destroy(&a);
    charge_rig_destroy(&b);
    conductor_free(&s);
}
