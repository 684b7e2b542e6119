/* Orientation signs against exact arithmetic: one wrong S+ or S- fails. */
#include "runtime/orientation.h"
#include "tests/support/random.h"

#include <gmp.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

enum { TRIANGLE_COUNT = 100000, UNIT_EXPONENT = -120 };

static const uint32_t corners[3] = {0, 1, 2};

static int seed(void **state) {
    (void)state;
    random_seed(41);
    return 0;
}

/* ---- the exact value ---- */

typedef struct exact_vector {
    mpz_t x[3];
} exact_vector;

/* p0 - d, p1 - p0 and p2 - p0 at both ends, in units of 2^UNIT_EXPONENT. */
typedef struct exact_triangle {
    exact_vector c[2], a[2], b[2];
} exact_triangle;

static void exact_difference(const double p[3], const double q[3], exact_vector *out) {
    mpz_t other;
    mpz_init(other);
    for (int k = 0; k < 3; k++) {
        mpz_set_d(out->x[k], ldexp(p[k], -UNIT_EXPONENT));
        mpz_set_d(other, ldexp(q[k], -UNIT_EXPONENT));
        mpz_sub(out->x[k], out->x[k], other);
    }
    mpz_clear(other);
}

/* sum += (a x b) . c */
static void add_determinant(const exact_vector *a, const exact_vector *b, const exact_vector *c, mpz_t sum) {
    mpz_t minor;
    mpz_init(minor);
    for (int k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;
        mpz_mul(minor, a->x[y], b->x[z]);
        mpz_submul(minor, a->x[z], b->x[y]);
        mpz_addmul(sum, minor, c->x[k]);
    }
    mpz_clear(minor);
}

/* The signs of the four exact Bernstein coefficients of (p0 - d) . n. */
static void exact_signs(const double x0[9], const double x1[9], const moving_point *d, int signs[4]) {
    static exact_triangle t;
    static bool ready;
    exact_vector *vectors[6] = {&t.c[0], &t.c[1], &t.a[0], &t.a[1], &t.b[0], &t.b[1]};
    for (int i = 0; i < 18 && !ready; i++) mpz_init(vectors[i / 3]->x[i % 3]);
    ready = true;
    for (int end = 0; end < 2; end++) {
        const double *x = end == 0 ? x0 : x1;
        exact_difference(x, end == 0 ? d->start : d->end, &t.c[end]);
        exact_difference(x + 3, x, &t.a[end]);
        exact_difference(x + 6, x, &t.b[end]);
    }
    mpz_t sum;
    mpz_init(sum);
    for (int ends = 0; ends < 4; ends++) { /* how many of the three vectors are taken at t = 1 */
        mpz_set_ui(sum, 0);
        for (int choice = 0; choice < 8; choice++) {
            int a = choice & 1, b = choice >> 1 & 1, c = choice >> 2;
            if (a + b + c == ends) add_determinant(&t.a[a], &t.b[b], &t.c[c], sum);
        }
        signs[ends] = mpz_sgn(sum);
    }
    mpz_clear(sum);
}

/* ---- triangles ---- */

static double nudged(double x) {
    for (int i = random_integer(0, 3); i > 0; i--)
        x = nextafter(x, random_integer(0, 1) ? INFINITY : -INFINITY);
    return x;
}

/* A point of the triangle's plane, to rounding and a few units in the last place. */
static void nearly_in_plane(const double x[9], double u, double v, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = nudged(x[k] + u * (x[3 + k] - x[k]) + v * (x[6 + k] - x[k]));
}

typedef struct orientation_case {
    double x0[9], x1[9];
    moving_point d;
} orientation_case;

static orientation_case random_case(bool near_zero) {
    orientation_case c;
    double offset = random_integer(0, 1) ? 0.0 : ldexp(random_unit(), random_integer(0, 20));
    double motion = ldexp(1.0, -random_integer(0, 12));
    int bits = random_integer(0, 3) == 0 ? 3 : 40;
    for (int i = 0; i < 9; i++) {
        c.x0[i] = offset + ldexp(rint(ldexp(random_unit(), bits)), -bits);
        c.x1[i] = c.x0[i] + motion * random_unit();
    }
    for (int k = 0; k < 3; k++) {
        c.d.start[k] = offset + 2.0 * random_unit();
        c.d.end[k] = c.d.start[k] + motion * random_unit();
    }
    if (!near_zero) return c;
    double u = 3.0 * random_unit(), v = 3.0 * random_unit();
    int where = random_integer(0, 2); /* at the start, at the end, at both */
    if (where != 1) nearly_in_plane(c.x0, u, v, c.d.start);
    if (where != 0) nearly_in_plane(c.x1, u, v, c.d.end);
    return c;
}

static void signs_are_exact(void **state) {
    int count[4] = {0}, lost = 0;
    (void)state;
    for (int i = 0; i < TRIANGLE_COUNT; i++) {
        orientation_case c = random_case(i % 3 == 0);
        int signs[4];
        exact_signs(c.x0, c.x1, &c.d, signs);
        int sum = signs[0] + signs[1] + signs[2] + signs[3];
        uint8_t flag = orientation_of(corners, c.x0, c.x1, &c.d);
        if (flag == ORIENTATION_PLUS) assert_int_equal(sum, 4);
        if (flag == ORIENTATION_MINUS) assert_int_equal(sum, -4);
        count[flag]++;
        lost += flag == ORIENTATION_ZERO && (sum == 4 || sum == -4);
    }
    printf("S+ %d, S- %d, S0 %d, of which exact signs would decide %d\n", count[ORIENTATION_PLUS],
           count[ORIENTATION_MINUS], count[ORIENTATION_ZERO], lost);
    assert_true(count[ORIENTATION_PLUS] > 10000 && count[ORIENTATION_MINUS] > 10000);
    assert_true(lost < TRIANGLE_COUNT / 3);
}

static void sides_of_a_plane(void **state) {
    const double x[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, lifted[9] = {0, 0, 3, 1, 0, 3, 0, 1, 3};
    const moving_point below = {{0, 0, -1}, {5, 5, -1}}, above = {{0, 0, 1}, {5, 5, 1}},
                       through = {{0, 0, -1}, {0, 0, 1}}, within = {{7, 7, 0}, {8, 8, 0}};
    (void)state;
    assert_int_equal(orientation_of(corners, x, x, &below), ORIENTATION_PLUS);
    assert_int_equal(orientation_of(corners, x, x, &above), ORIENTATION_MINUS);
    assert_int_equal(orientation_of(corners, x, x, &through), ORIENTATION_ZERO);
    assert_int_equal(orientation_of(corners, x, x, &within), ORIENTATION_ZERO);
    assert_int_equal(orientation_of(corners, x, lifted, &above), ORIENTATION_ZERO);
    assert_int_equal(orientation_of(corners, x, lifted, &below), ORIENTATION_PLUS);
}

static void flags_of_sets(void **state) {
    (void)state;
    assert_false(orientations_may_touch(ORIENTATION_PLUS, ORIENTATION_PLUS));
    assert_false(orientations_may_touch(ORIENTATION_MINUS, ORIENTATION_MINUS));
    assert_true(orientations_may_touch(ORIENTATION_PLUS, ORIENTATION_MINUS));
    assert_true(orientations_may_touch(ORIENTATION_ZERO, ORIENTATION_PLUS));
    assert_true(orientations_may_touch(ORIENTATION_MINUS, ORIENTATION_ZERO));
    assert_true(orientations_may_touch(ORIENTATION_ZERO, ORIENTATION_ZERO));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(signs_are_exact, seed),
        cmocka_unit_test(sides_of_a_plane),
        cmocka_unit_test(flags_of_sets),
    };
    return cmocka_run_group_tests_name("orientation", tests, NULL, NULL);
}
