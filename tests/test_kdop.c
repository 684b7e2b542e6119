/* 14-DOPs: every bound against exact sums, rounding to float at the ends of its range, closed overlap. */
#include "runtime/kdop.h"
#include "tests/support/exact_integer.h"
#include "tests/support/random.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { ROUND_COUNT = 50000 };

static const int axes[KDOP_AXIS_COUNT][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                             {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

static int seed(void **state) {
    (void)state;
    random_seed(8);
    return 0;
}

static struct exact_integer exact_projection(const double p[3], const int axis[3]) {
    struct exact_integer sum = {0};
    for (int k = 0; k < 3; k++) {
        struct exact_integer term = exact_from_double(axis[k] * p[k]);
        sum = exact_add(&sum, &term);
    }
    return sum;
}

/* bound >= sign * projection, exactly. */
static void check_bound(double bound, struct exact_integer projection, int sign) {
    struct exact_integer value = exact_from_double(bound);
    projection.sign *= sign;
    assert_true(exact_subtract(&value, &projection).sign >= 0);
}

static void check_point(const double p[3]) {
    kdop_exact exact;
    kdop_point(p, &exact);
    kdop rounded = kdop_round(&exact);
    double size = fabs(p[0]) + fabs(p[1]) + fabs(p[2]);
    for (int i = 0; i < KDOP_AXIS_COUNT; i++) {
        struct exact_integer projection = exact_projection(p, axes[i]);
        check_bound(exact.bounds[i], projection, -1);
        check_bound(exact.bounds[KDOP_AXIS_COUNT + i], projection, 1);
        assert_true(exact.bounds[i] + exact.bounds[KDOP_AXIS_COUNT + i] <= 0x1p-48 * size);
    }
    for (int i = 0; i < KDOP_BOUND_COUNT; i++) assert_true((double)rounded.bounds[i] >= exact.bounds[i]);
}

/* Any exponents; every fourth point nearly on a plane through the origin, where a sum cancels. */
static void random_point(double p[3], int lowest, int highest) {
    int exponent = random_integer(lowest, highest);
    for (int k = 0; k < 3; k++) {
        bool same = random_integer(0, 1);
        p[k] = ldexp(random_unit(), same ? exponent : random_integer(lowest, highest));
        if (fabs(p[k]) < ldexp(1.0, lowest)) p[k] = random_integer(0, 1) ? 0.0 : -0.0;
    }
    int k = random_integer(0, 2), sign = random_integer(0, 1) * 2 - 1;
    if (random_integer(0, 3) == 0) p[k] = sign * p[(k + 1) % 3];
    if (random_integer(0, 3) == 0) p[k] = sign * (p[(k + 1) % 3] + p[(k + 2) % 3]);
    if (fabs(p[k]) < ldexp(1.0, lowest)) p[k] = 0.0;
}

static void projections_contained(void **state) {
    (void)state;
    for (int round = 0; round < ROUND_COUNT; round++) {
        double p[3];
        random_point(p, round % 2 ? -190 : -20, round % 2 ? 296 : 20);
        check_point(p);
    }
}

/* Where the exact integers end: powers of two scale every bound, down to 2^-300 and up to 2^300. */
static void whole_domain(void **state) {
    (void)state;
    for (int round = 0; round < ROUND_COUNT; round++) {
        double p[3], scaled[3];
        kdop_exact a, b;
        random_point(p, -4, 0);
        int exponent = random_integer(-296, 300);
        for (int k = 0; k < 3; k++) scaled[k] = ldexp(p[k], exponent);
        kdop_point(p, &a);
        kdop_point(scaled, &b);
        for (int i = 0; i < KDOP_BOUND_COUNT; i++)
            assert_true(ldexp(a.bounds[i], exponent) == b.bounds[i] && isfinite(b.bounds[i]));
    }
}

static void check_round_up(double x) {
    float up = round_up(x);
    assert_true((double)up >= x);
    if (x < -(double)FLT_MAX * (1.0 + 0x1p-22))
        assert_true(up == -FLT_MAX);
    else if (x < 0.999 * (double)FLT_MAX)
        assert_true((double)up <= x + fabs(x) * 0x1p-22 + 0x1p-148);
}

static void rounded_outward(void **state) {
    static const double places[] = {0.0,   0x1p-149, 0x1p-150, 0x1p-126, 0x1p-300, 1.0,
                                    1e300, FLT_MAX,  0x1p128,  0x1p300,  0x1p127,  16777217.0};
    (void)state;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            double x = sign * places[i];
            check_round_up(x);
            check_round_up(nextafter(x, INFINITY));
            check_round_up(nextafter(x, -INFINITY));
            check_round_up(x * (1.0 + 0x1p-25));
            check_round_up(x * (1.0 - 0x1p-25));
        }
    }
    for (int round = 0; round < 20 * ROUND_COUNT; round++)
        check_round_up(ldexp(random_unit(), random_integer(-302, 302)));
    for (int round = 0; round < ROUND_COUNT; round++)
        check_round_up(ldexp(random_unit(), random_integer(-152, -120)));
}

static kdop_exact volume_of(const double p[3], const double q[3]) {
    kdop_exact volume, point;
    kdop_point(p, &volume);
    kdop_point(q, &point);
    kdop_exact_add(&volume, &point);
    return volume;
}

/* Volumes with a common point overlap, wherever it lies. */
static void common_point(void **state) {
    (void)state;
    for (int round = 0; round < ROUND_COUNT; round++) {
        double p[3], q[3], r[3];
        int highest = round % 3 == 0 ? 300 : round % 3 == 1 ? 10 : -150;
        random_point(p, -298, highest);
        random_point(q, -298, highest);
        random_point(r, -298, highest);
        kdop_exact a = volume_of(p, q), b = volume_of(r, p);
        kdop a_rounded = kdop_round(&a), b_rounded = kdop_round(&b);
        assert_true(kdop_exact_overlap(&a, &b) && kdop_exact_overlap(&b, &a));
        assert_true(kdop_overlap(&a_rounded, &b_rounded) && kdop_overlap(&b_rounded, &a_rounded));
    }
}

static void zero_is_zero(void **state) {
    const double zero[3] = {0.0, 0.0, 0.0}, negative[3] = {-0.0, -0.0, -0.0};
    (void)state;
    kdop_exact a = volume_of(zero, zero), b = volume_of(negative, negative);
    kdop a_rounded = kdop_round(&a), b_rounded = kdop_round(&b);
    for (int i = 0; i < KDOP_BOUND_COUNT; i++) {
        assert_true(a.bounds[i] == 0.0 && b.bounds[i] == 0.0);
        assert_true(a_rounded.bounds[i] >= 0.0f && b_rounded.bounds[i] >= 0.0f);
    }
    assert_true(kdop_exact_overlap(&a, &b) && kdop_overlap(&a_rounded, &b_rounded));
}

/* All of [-1, 1] along each axis, but for one, where [low, high] is given. */
static kdop slab(int axis, float low, float high) {
    kdop out;
    for (int i = 0; i < KDOP_BOUND_COUNT; i++) out.bounds[i] = 1.0f;
    out.bounds[axis] = -low;
    out.bounds[KDOP_AXIS_COUNT + axis] = high;
    return out;
}

static void overlap_is_closed(void **state) {
    static const float places[] = {0.0f, -0.0f, 1.0f, -3.0f, 0x1p-149f, FLT_MAX};
    (void)state;
    for (int axis = 0; axis < KDOP_AXIS_COUNT; axis++) {
        for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
            float x = places[i];
            kdop below = slab(axis, -FLT_MAX, x), above = slab(axis, x, FLT_MAX);
            kdop beyond = slab(axis, nextafterf(x, INFINITY), INFINITY);
            assert_true(kdop_overlap(&below, &above) && kdop_overlap(&above, &below));
            assert_false(kdop_overlap(&below, &beyond) || kdop_overlap(&beyond, &below));
            kdop joined = kdop_union(&below, &beyond);
            assert_true(kdop_overlap(&joined, &below) && kdop_overlap(&joined, &beyond));
        }
    }
}

/* Beyond the float range nothing can be told apart there, and nothing is lost. */
static void beyond_the_float_range(void **state) {
    const double far[3] = {0x1p200, -0x1p250, 0x1p-200}, farther[3] = {0x1p201, -0x1p251, 0.0};
    const double here[3] = {1.0, 2.0, 3.0};
    (void)state;
    kdop_exact a = volume_of(far, far), b = volume_of(farther, farther), c = volume_of(here, here);
    kdop a_rounded = kdop_round(&a), b_rounded = kdop_round(&b), c_rounded = kdop_round(&c);
    assert_false(kdop_exact_overlap(&a, &b));
    assert_true(kdop_overlap(&a_rounded, &b_rounded));
    assert_false(kdop_overlap(&a_rounded, &c_rounded));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(projections_contained, seed),
        cmocka_unit_test_setup(whole_domain, seed),
        cmocka_unit_test_setup(rounded_outward, seed),
        cmocka_unit_test_setup(common_point, seed),
        cmocka_unit_test(zero_is_zero),
        cmocka_unit_test(overlap_is_closed),
        cmocka_unit_test(beyond_the_float_range),
    };
    return cmocka_run_group_tests_name("kdop", tests, NULL, NULL);
}
