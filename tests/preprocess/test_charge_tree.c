/* Charges by the treecode against those of the dense system, and what may go wrong on the way. */
#include "benchmarks/lib/density_ranks.h"
#include "preprocess/treecode/treecode.h"
#include "tests/support/calls.h"
#include "tests/support/preprocess/charge_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FINE = NIGHTLY(3, 4) };

static conductor bent_body(int level) {
    conductor s = conductor_sphere(level);
    const double axes[3] = {2.0, 0.5, 0.7}, nowhere[3] = {0.0, 0.0, 0.0};
    conductor_transform(&s, axes, nowhere);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        double *p = s.positions + (size_t)v * 3;
        p[1] += 0.4 * p[0] * p[0];
        p[2] *= 1.0 + 0.6 * cos(3.0 * p[0]);
    }
    return s;
}

/* A cube whose triangles are small at edges, bent until none is the mirror image of another: equal densities have no order,
 * and which of them are among the lowest tenth would be rounding. */
static conductor crowded_body(int level) {
    conductor s = conductor_cube(level);
    conductor_crowd_edges(&s);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        double *p = s.positions + (size_t)v * 3;
        p[0] += 0.15 * p[1] + 0.1 * p[2] * p[2];
        p[1] += 0.2 * p[2] + 0.1 * p[0] * p[0];
    }
    return s;
}

TEST(agrees_with_the_dense_system) {
    conductor crowded = crowded_body(FINE), bent = bent_body(FINE), sphere = conductor_sphere(FINE);
    const conductor *all[] = {&bent, &crowded, &sphere};
    static const char *const names[] = {"bent body", "crowded cube", "sphere"};
    for (int i = 0; i < 3; i++) {
        const uint32_t count = all[i]->triangle_count;
        charge_rig a = charge_rig_solve(all[i], 2), b = charge_rig_solve_by(&by_tree, all[i], 2);
        double worst = 0.0, mean = 0.0;
        rank_agreement ranks = density_ranks_compare(a.density, b.density, count);
        for (uint32_t t = 0; t < count; t++) {
            worst = fmax(worst, fabs(a.density[t] - b.density[t]));
            mean += a.density[t] / count;
        }
        print_message(
            "%s, %u triangles: capacitance within %.1e, densities within %.1e, ranks %.7f, lowest tenth %.4f\n",
            names[i], count, fabs(b.capacitance[0] / a.capacitance[0] - 1.0), worst / mean, ranks.correlation,
            ranks.overlap);
        assert_true(fabs(b.capacitance[0] / a.capacitance[0] - 1.0) < 1e-5);
        assert_true(worst < 0.02 * mean);
        if (i < 2) assert_true(ranks.correlation > 0.9995 && ranks.overlap >= 0.97);
        charge_rig coarse = charge_rig_solve_by(&by_coarse_tree, all[i], 2);
        ranks = density_ranks_compare(a.density, coarse.density, count);
        print_message("    coarse: capacitance within %.1e, ranks %.5f, lowest tenth %.4f\n",
                      fabs(coarse.capacitance[0] / a.capacitance[0] - 1.0), ranks.correlation, ranks.overlap);
        assert_true(fabs(coarse.capacitance[0] / a.capacitance[0] - 1.0) < 1e-3);
        if (i < 2) assert_true(ranks.correlation > 0.98 && ranks.overlap >= 0.85);
        charge_rig_destroy(&coarse);
        charge_rig_destroy(&a);
        charge_rig_destroy(&b);
    }
    conductor_free(&crowded);
    conductor_free(&bent);
    conductor_free(&sphere);
}

/* A millionth and a million times as large, somewhere else: the same densities but for the scale. */
TEST(scale_and_place_do_not_matter) {
    conductor s = bent_body(2);
    charge_rig a = charge_rig_solve_by(&by_tree, &s, 1);
    for (int exponent = -20; exponent <= 20; exponent += 40) {
        conductor moved = bent_body(2);
        const double scale = ldexp(1.0, exponent), scales[3] = {scale, scale, scale},
                     nowhere[3] = {0.0, 0.0, 0.0};
        conductor_transform(&moved, scales, nowhere);
        charge_rig b = charge_rig_solve_by(&by_tree, &moved, 1);
        assert_true(b.capacitance[0] == a.capacitance[0] * scale);
        for (uint32_t t = 0; t < s.triangle_count; t++) assert_true(b.density[t] * scale == a.density[t]);
        charge_rig_destroy(&b);
        conductor_free(&moved);
    }
    charge_rig_destroy(&a);
    conductor_free(&s);
}

TEST(components_are_solved_alone) {
    conductor one = bent_body(2), both = bent_body(2), other = conductor_cube(2);
    conductor_append(&both, &other);
    charge_rig a = charge_rig_solve_by(&by_tree, &one, 2), b = charge_rig_solve_by(&by_tree, &both, 2);
    assert_memory_equal(a.density, b.density, one.triangle_count * sizeof *a.density);
    assert_true(a.capacitance[0] == b.capacitance[0]);
    assert_true(fabs(b.capacitance[1] - 0.66) < 0.01);
    charge_rig_destroy(&a);
    charge_rig_destroy(&b);
    conductor_free(&one);
    conductor_free(&both);
    conductor_free(&other);
}

enum {
    SHEET_SIDE = 8,
    SHEET_VERTICES = (SHEET_SIDE + 1) * (SHEET_SIDE + 1),
    SHEET_TRIANGLES = 2 * SHEET_SIDE * SHEET_SIDE
};

/* Adds a square sheet beside the body, which hangs on it by a triangle. */
static void hang_sheet(conductor *s, double height) {
    double positions[SHEET_VERTICES * 3];
    uint32_t triangles[(SHEET_TRIANGLES + 1) * 3], count = 0;
    const uint32_t body_vertices = s->vertex_count;
    conductor sheet = {SHEET_VERTICES, SHEET_TRIANGLES, positions, triangles};
    for (int i = 0; i < SHEET_VERTICES; i++) {
        positions[i * 3] = 3.0 + i % (SHEET_SIDE + 1) * 0.1;
        positions[i * 3 + 1] = i / (SHEET_SIDE + 1) * 0.1;
        positions[i * 3 + 2] = height;
    }
    for (uint32_t i = 0; i < SHEET_SIDE * SHEET_SIDE; i++) {
        const uint32_t a = i / SHEET_SIDE * (SHEET_SIDE + 1) + i % SHEET_SIDE, b = a + SHEET_SIDE + 1;
        const uint32_t both[6] = {a, a + 1, b, b, a + 1, b + 1};
        memcpy(triangles + count, both, sizeof both);
        count += 6;
    }
    conductor_append(s, &sheet);
    const uint32_t hanger[3] = {0, 1, body_vertices};
    s->triangles = realloc(s->triangles, (size_t)(s->triangle_count + 1) * sizeof hanger);
    assert_non_null(s->triangles);
    memcpy(s->triangles + (size_t)s->triangle_count * 3, hanger, sizeof hanger);
    s->triangle_count++;
}

enum { SPHERE_TRIANGLES = 320 };

/* A sphere, and two sheets that hang on it, one above the other. */
static conductor sphere_with_sheets(double distance) {
    conductor s = conductor_sphere(2);
    assert_int_equal(s.triangle_count, SPHERE_TRIANGLES);
    hang_sheet(&s, 0.0);
    hang_sheet(&s, distance);
    return s;
}

static double residual_of(const conductor *s, const charge_rig *r) {
    treecode_rig t = treecode_rig_create(s, 1, CSCD_SIMD_AUTO);
    const double residual = treecode_rig_residual(&t, r->density);
    treecode_rig_destroy(&t);
    return residual;
}

/* The potential is 1 to the tolerance: densities of fine meshes need 1e-6 of it. */
TEST(iterations_end_at_the_tolerance) {
    conductor s = bent_body(FINE);
    charge_rig fine = charge_rig_solve_by(&by_tree, &s, 2),
               coarse = charge_rig_solve_by(&by_coarse_tree, &s, 2);
    const double of_fine = residual_of(&s, &fine), of_coarse = residual_of(&s, &coarse);
    print_message("residuals: %.2g, coarse %.2g\n", of_fine, of_coarse);
    assert_true(of_fine <= 1.05e-6);
    assert_true(of_coarse > 1e-4 && of_coarse <= 3.01e-3);
    charge_rig_destroy(&fine);
    charge_rig_destroy(&coarse);
    conductor_free(&s);
}

/* The iteration comes no closer to sheets that are 1e-9 apart: what it has found is good enough. */
TEST(makes_do_with_a_small_residual) {
    conductor s = sphere_with_sheets(1e-9), wide = sphere_with_sheets(1e-6);
    charge_rig r = charge_rig_solve_by(&by_tree, &s, 1), expected = charge_rig_solve_by(&by_tree, &wide, 1);
    const double residual = residual_of(&s, &r);
    print_message("residual: %.2g\n", residual);
    assert_true(residual > 1e-5 && residual <= 1e-3);
    assert_true(fabs(r.capacitance[0] / expected.capacitance[0] - 1.0) < 1e-5);
    for (uint32_t t = 0; t < SPHERE_TRIANGLES; t++)
        assert_true(fabs(r.density[t] / expected.density[t] - 1.0) < 1e-3);
    charge_rig_destroy(&r);
    charge_rig_destroy(&expected);
    conductor_free(&s);
    conductor_free(&wide);
}

/* On whichever side the sheets hang: the tree has the triangles in an order of its own. */
static void check_named_triangle(uint32_t turns) {
    conductor s = sphere_with_sheets(1e-13);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        double *p = s.positions + (size_t)v * 3;
        const double x[3] = {p[0], p[1], p[2]};
        for (uint32_t k = 0; k < 3; k++) p[k] = x[(k + turns) % 3];
    }
    charge_rig r = charge_rig_create(&s, 1, NULL);
    assert_int_equal(charge_solve(r.mesh, s.positions, &by_tree, r.density, r.capacitance, NULL),
                     CSCD_INVALID_ARGUMENT);
    const char *where = strstr(cscd_context_detail(r.context), "most at triangle ");
    assert_non_null(where);
    assert_true(strtoul(where + strlen("most at triangle "), NULL, 10) >= SPHERE_TRIANGLES);
    charge_rig_destroy(&r);
    conductor_free(&s);
}

TEST(says_where_charges_cannot_be_told_apart) {
    for (uint32_t turns = 0; turns < 3; turns++) check_named_triangle(turns);
}

/* Without a number for a residual there are no charges. */
TEST(equations_without_numbers) {
    conductor s = conductor_sphere(2);
    treecode_rig r = treecode_rig_create(&s, 1, CSCD_SIMD_AUTO);
    charge_timings timings = {0};
    expect_ok(tree_solve(r.context, &r.system, SIZE_MAX, 1e-6, &timings));
    r.system.sources[7].area = (double)NAN;
    assert_int_equal(tree_solve(r.context, &r.system, SIZE_MAX, 1e-6, &timings), CSCD_INVALID_ARGUMENT);
    treecode_rig_destroy(&r);
    conductor_free(&s);
}

/* It lies above or below 1. */
TEST(the_worst_potential_is_named) {
    const double low[4] = {1.0, 1.5, 0.25, 1.25}, high[3] = {0.75, 1.0, 1.5}, equal[3] = {1.0, 0.5, 1.5};
    assert_int_equal(tree_solve_worst(low, 4), 2);
    assert_int_equal(tree_solve_worst(high, 3), 2);
    assert_int_equal(tree_solve_worst(equal, 3), 1);
}

/* Sheets that lie almost on each other have no charges that can be told apart, and the sentence says so; the others are solved. */
TEST(sheets_near_each_other) {
    for (int digits = 2; digits <= 14; digits += 4) {
        double h = pow(10.0, -digits);
        double positions[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, h, 1, 0, h, 0, 1, h};
        uint32_t triangles[9] = {0, 1, 2, 3, 4, 5, 0, 1, 4};
        conductor s = {6, 3, positions, triangles};
        charge_rig r = charge_rig_create(&s, 1, NULL);
        const cscd_status status =
            charge_solve(r.mesh, s.positions, &by_tree, r.density, r.capacitance, NULL);
        print_message("%g apart: %s %s\n", h, cscd_status_string(status),
                      status == CSCD_OK ? "" : cscd_context_detail(r.context));
        assert_int_equal(status, digits < 14 ? CSCD_OK : CSCD_INVALID_ARGUMENT);
        if (status == CSCD_OK)
            assert_true(r.capacitance[0] > 0.2 && r.capacitance[0] < 0.4);
        else
            assert_non_null(strstr(cscd_context_detail(r.context), "lie (almost) on each other"));
        charge_rig_destroy(&r);
    }
}

TEST(keeps_to_the_limit) {
    conductor s = bent_body(3);
    counting_allocator counter = counting_allocator_start();
    const cscd_allocator allocator = counting_allocator_interface(&counter);
    charge_rig r = charge_rig_create(&s, 2, &allocator);
    const size_t held = cscd_context_describe(r.context).bytes, bytes = counter.bytes;
    expect_ok(charge_solve(r.mesh, s.positions, &by_tree, r.density, r.capacitance, NULL));
    const size_t taken = counter.peak - bytes;
    const charge_options enough = {CSCD_CHARGE_TREE, taken + taken / 8};
    expect_ok(charge_solve(r.mesh, s.positions, &enough, r.density, r.capacitance, NULL));
    for (uint32_t t = 0; t < s.triangle_count; t++) r.density[t] = -1.0;
    r.capacitance[0] = -1.0;
    const charge_options little = {CSCD_CHARGE_TREE, taken - taken / 16};
    assert_int_equal(charge_solve(r.mesh, s.positions, &little, r.density, r.capacitance, NULL),
                     CSCD_OUT_OF_MEMORY);
    assert_non_null(strstr(cscd_context_detail(r.context), "a component of 1280 triangles takes"));
    assert_true(charge_rig_untouched(&r));
    assert_int_equal(cscd_context_describe(r.context).bytes, held);
    charge_rig_destroy(&r);
    conductor_free(&s);
}
