/* 14-DOPs: every bound against exact sums, closed overlap. */
#include "runtime/kdop.h"
#include "tests/support/exact_integer.h"
#include "tests/support/random.h"

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
    double size = fabs(p[0]) + fabs(p[1]) + fabs(p[2]);
    for (int i = 0; i < KDOP_AXIS_COUNT; i++) {
        struct exact_integer projection = exact_projection(p, axes[i]);
        check_bound(exact.bounds[i], projection, -1);
        check_bound(exact.bounds[KDOP_AXIS_COUNT + i], projection, 1);
        assert_true(exact.bounds[i] + exact.bounds[KDOP_AXIS_COUNT + i] <= 0x1p-48 * size);
    }
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
        assert_true(kdop_exact_overlap(&a, &b) && kdop_exact_overlap(&b, &a));
    }
}

static void zero_is_zero(void **state) {
    const double zero[3] = {0.0, 0.0, 0.0}, negative[3] = {-0.0, -0.0, -0.0};
    (void)state;
    kdop_exact a = volume_of(zero, zero), b = volume_of(negative, negative);
    for (int i = 0; i < KDOP_BOUND_COUNT; i++) assert_true(a.bounds[i] == 0.0 && b.bounds[i] == 0.0);
    assert_true(kdop_exact_overlap(&a, &b));
}

/* All of [-1, 1] along each axis, but for one, where [low, high] is given. */
static kdop_exact slab(int axis, double low, double high) {
    kdop_exact out;
    for (int i = 0; i < KDOP_BOUND_COUNT; i++) out.bounds[i] = 1.0;
    out.bounds[axis] = -low;
    out.bounds[KDOP_AXIS_COUNT + axis] = high;
    return out;
}

static void overlap_is_closed(void **state) {
    static const double places[] = {0.0, -0.0, 1.0, -3.0, 0x1p-300, 0x1p300};
    (void)state;
    for (int axis = 0; axis < KDOP_AXIS_COUNT; axis++) {
        for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
            double x = places[i];
            kdop_exact below = slab(axis, -INFINITY, x), above = slab(axis, x, INFINITY);
            kdop_exact beyond = slab(axis, nextafter(x, INFINITY), INFINITY);
            assert_true(kdop_exact_overlap(&below, &above) && kdop_exact_overlap(&above, &below));
            assert_false(kdop_exact_overlap(&below, &beyond) || kdop_exact_overlap(&beyond, &below));
            kdop_exact joined = below;
            kdop_exact_add(&joined, &beyond);
            assert_true(kdop_exact_overlap(&joined, &below) && kdop_exact_overlap(&joined, &beyond));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(projections_contained, seed),
        cmocka_unit_test_setup(whole_domain, seed),
        cmocka_unit_test_setup(common_point, seed),
        cmocka_unit_test(zero_is_zero),
        cmocka_unit_test(overlap_is_closed),
    };
    return cmocka_run_group_tests_name("kdop", tests, NULL, NULL);
}
