/* Guesses of roots, beside those of GSL and beside roots that the coefficients were made of. */
#include "runtime/ccd/elementary_levels.h"

#include "tests/support/random.h"
#include "tests/support/test.h"

#include <gsl/gsl_poly.h>
#include <math.h>
#include <stdbool.h>

enum { CUBICS = 100000 };

static bool is_inside(double root) {
    return root >= 0.0 && root <= 1.0;
}

/* Guesses inside [0, 1] are right to 2^-30, and those outside of it are outside. */
static void expect_roots(const double c[4], const double *roots, int count) {
    double guesses[3];
    const int found = cubic_guess_roots(c, guesses);
    assert_int_equal(found, count);
    for (int i = 0; i < count; i++) {
        if (i > 0) assert_true(guesses[i - 1] <= guesses[i]);
        if (is_inside(roots[i]))
            assert_true(fabs(guesses[i] - roots[i]) < 0x1p-30);
        else
            assert_false(is_inside(guesses[i]));
    }
}

/* Are simple roots this far from each other, and from the ends of [0, 1]? Then rounding does not move them far. */
static bool are_apart(const double *roots, int count, double distance) {
    for (int i = 0; i < count; i++) {
        if (fabs(roots[i]) < distance || fabs(roots[i] - 1.0) < distance) return false;
        if (i > 0 && roots[i] - roots[i - 1] < distance) return false;
    }
    return true;
}

TEST(guesses_are_those_of_gsl) {
    int compared = 0;
    random_seed(71);
    for (int i = 0; i < CUBICS; i++) {
        double c[4], roots[3];
        for (int j = 0; j < 4; j++) c[j] = random_unit();
        if (fabs(c[3]) < 0x1p-6) continue;
        const int count =
            gsl_poly_solve_cubic(c[2] / c[3], c[1] / c[3], c[0] / c[3], &roots[0], &roots[1], &roots[2]);
        if (!are_apart(roots, count, 0.01)) continue;
        expect_roots(c, roots, count);
        compared++;
    }
    assert_true(compared > CUBICS / 2);
}

/* The root that a tiny leading coefficient brings is far outside, but it counts. */
TEST(small_leading_coefficients_lose_no_root) {
    random_seed(72);
    for (int i = 0; i < CUBICS; i++) {
        const double near = random_between(0.05, 0.95),
                     far = ldexp(random_between(1.0, 2.0), random_integer(2, 60));
        const double quadratic[4] = {near, -1.0 - near / far, 1.0 / far, 0.0}, roots[2] = {near, far};
        const double mirrored[4] = {near, -1.0 + near / far, -1.0 / far, 0.0}, turned[2] = {-far, near};
        expect_roots(quadratic, roots, 2);
        expect_roots(mirrored, turned, 2);
    }
}

TEST(lower_degrees) {
    const double line[4] = {-1.0, 4.0, 0.0, 0.0}, constant[4] = {1.0, 0.0, 0.0, 0.0},
                 above[4] = {1.0, 0.0, 1.0, 0.0};
    const double halves[4] = {0.25, -1.0, 1.0, 0.0}, nothing[4] = {0.0, 0.0, 0.0, 0.0};
    expect_roots(line, (const double[]){0.25}, 1);
    expect_roots(halves, (const double[]){0.5, 0.5}, 2);
    expect_roots(constant, NULL, 0);
    expect_roots(above, NULL, 0);
    expect_roots(nothing, NULL, 0);
}
