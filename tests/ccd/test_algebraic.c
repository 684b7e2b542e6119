/* The exact level from below: integers against GMP, signs at roots against rational arithmetic, and the room
 * that the worst queries take. */
#include "runtime/ccd/exact.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <gmp.h>
#include <math.h>
#include <stdio.h>

enum { ROUND_COUNT = PACED(20000, 4000), LIMBS_MAX = 12 };

static integer_pool pool;

static int seed_and_start_pool(void **state) {
    (void)state;
    random_seed(23);
    integer_pool_start(&pool);
    return 0;
}

/* ---- integers ---- */

/* Limbs of all ones and all zeros, so that carries run far. */
static void random_mpz(mpz_t out) {
    mpz_set_ui(out, 0);
    int count = random_integer(0, LIMBS_MAX);
    for (int i = 0; i < count; i++) {
        int kind = random_integer(0, 3);
        mpz_mul_2exp(out, out, 32);
        mpz_add_ui(out, out,
                   kind == 0   ? 0
                   : kind == 1 ? 0xffffffff
                               : (unsigned long)random_integer(0, 0x7ffffffe));
    }
    if (random_integer(0, 1)) mpz_neg(out, out);
}

static integer from_mpz(const mpz_t x) {
    integer sum = {0};
    for (size_t i = mpz_size(x); i-- > 0;) {
        integer limb = integer_from_int(&pool, (int64_t)(mpz_getlimbn(x, (mp_size_t)i) >> 32));
        sum = integer_multiply(&pool, sum, integer_from_int(&pool, (int64_t)1 << 32));
        sum = integer_add(&pool, sum, limb);
        limb = integer_from_int(&pool, (int64_t)(mpz_getlimbn(x, (mp_size_t)i) & 0xffffffff));
        sum = integer_multiply(&pool, sum, integer_from_int(&pool, (int64_t)1 << 32));
        sum = integer_add(&pool, sum, limb);
    }
    return mpz_sgn(x) < 0 ? integer_negate(sum) : sum;
}

static void check_equal(integer found, const mpz_t expected) {
    size_t limbs = (size_t)(found.size < 0 ? -found.size : found.size);
    assert_int_equal(integer_sign(found), mpz_sgn(expected));
    assert_int_equal(limbs, mpz_size(expected));
    for (size_t i = 0; i < limbs; i++) assert_true(found.limbs[i] == mpz_getlimbn(expected, (mp_size_t)i));
}

TEST(integers_against_gmp) {
    mpz_t x, y, expected;
    mpz_inits(x, y, expected, NULL);
    for (int round = 0; round < ROUND_COUNT; round++) {
        pool.used = 0;
        random_mpz(x);
        random_mpz(y);
        if (random_integer(0, 7) == 0) mpz_set(y, x);
        integer a = from_mpz(x), b = from_mpz(y);
        int factor = random_integer(-9, 9);
        check_equal(a, x);
        mpz_add(expected, x, y);
        check_equal(integer_add(&pool, a, b), expected);
        mpz_sub(expected, x, y);
        check_equal(integer_subtract(&pool, a, b), expected);
        mpz_mul(expected, x, y);
        check_equal(integer_multiply(&pool, a, b), expected);
        mpz_mul_si(expected, x, factor);
        check_equal(integer_scale(&pool, a, factor), expected);
        signed long exponent;
        double mantissa = mpz_get_d_2exp(&exponent, x);
        int found_exponent;
        double found = integer_to_double(a, &found_exponent);
        assert_true(fabs(ldexp(found, found_exponent - (int)exponent) - mantissa) <= 0x1p-52);
    }
    mpz_clears(x, y, expected, NULL);
}

TEST(doubles_as_integers) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        pool.used = 0;
        double x = ldexp(random_unit(), random_integer(-300, 300));
        if (round % 2 == 0) x = ldexp(random_integer(-5, 5), random_integer(-300, 290));
        if (x == 0.0) continue;
        int lowest = integer_lowest_bit(x), below = random_integer(0, 200), exponent;
        integer whole = integer_from_double(&pool, x, lowest - below);
        double back = integer_to_double(whole, &exponent);
        assert_true(ldexp(back, exponent + lowest - below) == x);
        assert_true(below > 0 || (whole.limbs[0] & 1) == 1);
    }
}

/* Numbers before the mark stay, kept ones move down unharmed, whatever their order. */
TEST(kept_numbers) {
    mpz_t values[6];
    for (int i = 0; i < 6; i++) mpz_init(values[i]);
    for (int round = 0; round < ROUND_COUNT; round++) {
        integer numbers[6];
        pool.used = 0;
        for (int i = 0; i < 6; i++) random_mpz(values[i]);
        numbers[0] = from_mpz(values[0]);
        uint32_t mark = pool.used;
        for (int i = 1; i < 5; i++) numbers[i] = from_mpz(values[i]);
        mpz_neg(values[5], values[2]);
        numbers[5] = integer_negate(numbers[2]);
        integer shuffled[4] = {numbers[4], numbers[5], numbers[2], numbers[0]};
        integer_pool_keep(&pool, mark, shuffled, 4);
        check_equal(shuffled[0], values[4]);
        check_equal(shuffled[1], values[5]);
        check_equal(shuffled[2], values[2]);
        check_equal(shuffled[3], values[0]);
        assert_true(pool.used <= mark + mpz_size(values[4]) + mpz_size(values[2]));
    }
    for (int i = 0; i < 6; i++) mpz_clear(values[i]);
}

/* ---- signs at roots ---- */

static polynomial from_coefficients(const int64_t *c, int count) {
    polynomial sum = polynomial_zero(), t = polynomial_linear((integer){0}, integer_from_int(&pool, 1));
    for (int i = count - 1; i >= 0; i--) {
        polynomial constant = polynomial_linear(integer_from_int(&pool, c[i]), (integer){0});
        sum = polynomial_multiply(&pool, &sum, &t);
        sum = polynomial_add(&pool, &sum, &constant);
    }
    return sum;
}

/* factor (bottom t - top) */
static polynomial linear_polynomial(int64_t top, int64_t bottom) {
    return from_coefficients((int64_t[]){-top, bottom}, 2);
}

/* The sign of c[0] + c[1] t + c[2] t^2 at top / bottom, bottom > 0. */
static int sign_at(const int64_t c[3], int64_t top, int64_t bottom) {
    int64_t value = c[0] * bottom * bottom + c[1] * top * bottom + c[2] * top * top;
    return (value > 0) - (value < 0);
}

static int compare_fractions(const int64_t a[2], const int64_t b[2]) {
    return (a[0] * b[1] > b[0] * a[1]) - (a[0] * b[1] < b[0] * a[1]);
}

/* Products of up to three lines: rational roots, often multiple ones. */
TEST(rational_roots) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        pool.used = 0;
        int degree = random_integer(1, 3), distinct = 0;
        int64_t roots[3][2], c[3];
        polynomial p = from_coefficients((int64_t[]){random_integer(0, 1) ? 3 : -2}, 1);
        for (int i = 0; i < degree; i++) {
            int64_t fraction[2] = {random_integer(-6, 9), random_integer(1, 6)};
            polynomial factor = linear_polynomial(fraction[0], fraction[1]);
            p = polynomial_multiply(&pool, &p, &factor);
            int place = 0;
            while (place < distinct && compare_fractions(fraction, roots[place]) > 0) place++;
            if (place < distinct && compare_fractions(fraction, roots[place]) == 0) continue;
            for (int j = distinct++; j > place; j--) {
                roots[j][0] = roots[j - 1][0];
                roots[j][1] = roots[j - 1][1];
            }
            roots[place][0] = fraction[0];
            roots[place][1] = fraction[1];
        }
        algebraic found[3];
        assert_int_equal(algebraic_roots(&pool, &p, found), distinct);
        for (int k = 0; k < 3; k++) c[k] = random_integer(-20, 20);
        polynomial q = from_coefficients(c, 3);
        bool met[3] = {false};
        for (int i = 0; i < distinct; i++) {
            int which = 0; /* the multiple roots of a cubic come in no order */
            while (which < distinct) {
                polynomial here = linear_polynomial(roots[which][0], roots[which][1]);
                if (algebraic_sign(&pool, &found[i], &here) == 0) break;
                which++;
            }
            assert_true(which < distinct && !met[which]);
            met[which] = true;
            double value = (double)roots[which][0] / (double)roots[which][1];
            assert_int_equal(algebraic_sign(&pool, &found[i], &q),
                             sign_at(c, roots[which][0], roots[which][1]));
            bool inside = value >= 0.0 && value <= 1.0;
            assert_true(algebraic_locate(&pool, &found[i]) == inside);
            if (!inside) continue;
            assert_true(found[i].low <= value + 0x1p-52 && found[i].high >= value - 0x1p-52);
            assert_true(found[i].high - found[i].low < 0x1p-34);
            assert_true(found[i].cell ==
                        (double)(roots[which][0] * ((int64_t)1 << 34) / roots[which][1]) * 0x1p-34);
            assert_int_equal(algebraic_sign(&pool, &found[i], &q),
                             sign_at(c, roots[which][0], roots[which][1]));
        }
    }
}

/* (b t - a) (t^2 - n) has the roots a / b and +-sqrt(n); signs of quadratics at them by squaring. */
TEST(irrational_roots) {
    static const int64_t squares[6] = {2, 3, 5, 6, 7, 8};
    for (int round = 0; round < ROUND_COUNT; round++) {
        pool.used = 0;
        int64_t n = squares[random_integer(0, 5)], a = random_integer(-9, 9), b = random_integer(1, 4);
        polynomial linear = linear_polynomial(a, b), square = from_coefficients((int64_t[]){-n, 0, 1}, 3);
        polynomial p = polynomial_multiply(&pool, &linear, &square);
        algebraic found[3];
        assert_int_equal(algebraic_roots(&pool, &p, found), 3);
        int place = a * a < n * b * b ? 1 : a < 0 ? 0 : 2;
        assert_int_equal(algebraic_sign(&pool, &found[place], &linear), 0);
        for (int i = 0; i < 3; i++) {
            if (i == place) continue;
            assert_int_equal(algebraic_sign(&pool, &found[i], &square), 0);
            int root_sign = i == 0 || (i == 1 && place == 0) ? -1 : 1;
            /* c0 + c1 t + c2 t^2 = (c0 + c2 n) + c1 (+-sqrt(n)) */
            int64_t c[3] = {random_integer(-30, 30), random_integer(-20, 20), random_integer(-9, 9)};
            if (random_integer(0, 3) == 0) c[0] = -c[2] * n; /* near or at zero */
            polynomial q = from_coefficients(c, 3);
            int64_t whole = c[0] + c[2] * n, slope = c[1] * root_sign;
            int64_t difference = whole * whole - slope * slope * n;
            int expected = whole >= 0 && slope >= 0   ? (whole > 0 || slope > 0)
                           : whole <= 0 && slope <= 0 ? -1
                           : whole > 0                ? (difference > 0) - (difference < 0)
                                                      : (difference < 0) - (difference > 0);
            assert_int_equal(algebraic_sign(&pool, &found[i], &q), expected);
        }
    }
}

/* ---- room ---- */

/* Every difference spans the whole range of exponents. */
static double far_and_near(void) {
    double x = ldexp(0.5 + 0.5 * fabs(random_unit()), random_integer(0, 1) ? 300 : -299);
    return random_integer(0, 1) ? x : -x;
}

TEST(room_for_the_worst) {
    uint32_t peak = 0;
    int touching = 0;
    for (int round = 0; round < ROUND_COUNT; round++) {
        elementary_query query;
        double toi;
        int shape = random_integer(0, 3);
        for (int i = 0; i < 24; i++) {
            int k = i % 3;
            double x = shape == 1 && k == 2 ? 0.0 : far_and_near();
            if (shape == 2 && k == 2) x = ldexp(x, -random_integer(0, 1)); /* common factors */
            *(i < 12 ? &query.x0[i / 3][k] : &query.x1[i / 3 - 4][k]) = x;
        }
        if (shape == 3) { /* points in two places each: double roots and common roots */
            for (int k = 0; k < 3; k++) {
                query.x1[1][k] = -query.x0[1][k];
                query.x0[3][k] = -query.x0[0][k];
                query.x1[3][k] = query.x0[0][k];
            }
        }
        touching += exact_touch_in(&pool, &query, (cscd_contact_kind)random_integer(0, 1), &toi);
        peak = pool.peak > peak ? pool.peak : peak;
    }
    printf("at most %u of %d limbs, %d of %d touching\n", peak, INTEGER_POOL_LIMBS, touching, ROUND_COUNT);
    assert_true(peak <= INTEGER_POOL_LIMBS && touching > 0);
}

/* A sign at both ends that is that of the middle coefficient, too, is the sign in between; another one leaves it open. */
TEST(signs_on_the_interval) {
    static const int known[][4] = {
        /* coefficients, and the sign: no root, two roots, a double root, one beyond, and roots at the ends */
        {2, -1, 1, 1},  {1, -5, 5, 0}, {-1, 5, -5, 0}, {1, -4, 4, 0},
        {-3, 1, 1, -1}, {0, 1, 1, 0},  {-2, 1, 1, 0}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        polynomial p =
            polynomial_linear(integer_from_int(&pool, known[i][0]), integer_from_int(&pool, known[i][1]));
        p.c[2] = integer_from_int(&pool, known[i][2]);
        p.degree = 2;
        assert_int_equal(polynomial_sign_on_interval(&pool, &p), known[i][3]);
    }
}

AROUND_EACH(seed_and_start_pool, NULL)
