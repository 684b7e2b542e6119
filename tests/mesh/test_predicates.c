/* The orientation predicates against exact integers: grids, mixed magnitudes, points an ulp off a line or
 * plane. */
#include <math.h>
#include <stdio.h>

#include "src/mesh/predicates.h"
#include "tests/support/ccd/wide_numbers.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

enum { ROUND_COUNT = PACED(NIGHTLY(50000, 100000), 20000) };

static int seed_random(void **state) {
    (void)state;
    random_seed(20240229);
    return 0;
}

/* The domain of the predicates: smaller values become 0. */
static double into_domain(double value) {
    return fabs(value) < 0x1p-300 ? 0.0 : value;
}

static double nudge_by_ulp(double value) {
    int ulps = random_integer(-1, 1);

    return ulps == 0 ? value : nextafter(value, ulps * (double)INFINITY);
}

static void nudge_point(double point[3]) {
    for (int k = 0; k < 3; k++) point[k] = into_domain(nudge_by_ulp(point[k]));
}

static struct exact_integer exact_difference(double a, double b) {
    struct exact_integer ea = exact_from_double(a), eb = exact_from_double(b);

    return exact_subtract(&ea, &eb);
}

static struct exact_integer exact_cross(const double a[2], const double b[2], const double origin[2]) {
    struct exact_integer ax = exact_difference(a[0], origin[0]), ay = exact_difference(a[1], origin[1]);
    struct exact_integer bx = exact_difference(b[0], origin[0]), by = exact_difference(b[1], origin[1]);
    struct exact_integer left = exact_multiply(&ax, &by), right = exact_multiply(&ay, &bx);

    return exact_subtract(&left, &right);
}

static int exact_orient2d(const double a[2], const double b[2], const double c[2]) {
    return exact_cross(a, b, c).sign;
}

/* Expands the determinant along the z coordinates of a, b and c relative to d. */
static int exact_orient3d(const double *a, const double *b, const double *c, const double *d) {
    const double *cycle[5] = {a, b, c, a, b};
    struct exact_integer sum = {0};

    for (int i = 0; i < 3; i++) {
        struct exact_integer z = exact_difference(cycle[i][2], d[2]);
        struct exact_integer area = exact_cross(cycle[i + 1], cycle[i + 2], d);
        struct exact_integer product = exact_multiply(&z, &area);

        sum = exact_add(&sum, &product);
    }
    return -sum.sign;
}

struct tally {
    int count[3];
};

static void require_all_signs(const char *name, const struct tally *tally) {
    printf("%-28s %7d negative %7d zero %7d positive\n", name, tally->count[0], tally->count[1],
           tally->count[2]);
    for (int i = 0; i < 3; i++) assert_true(tally->count[i] >= PACED(250, 100));
}

static int orient2d_points(const double *a, const double *b, const double *c) {
    return orient2d(a[0], a[1], b[0], b[1], c[0], c[1]);
}

/* Checks all orders of the points; an odd permutation turns the sign. */
static void check_plane(double p[3][3], struct tally *tally) {
    int expected = exact_orient2d(p[0], p[1], p[2]);

    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;

        assert_int_equal(orient2d_points(p[i], p[j], p[k]), expected);
        assert_int_equal(orient2d_points(p[i], p[k], p[j]), -expected);
    }
    tally->count[expected + 1]++;
}

static void check_space(double p[4][3], struct tally *tally) {
    int expected = exact_orient3d(p[0], p[1], p[2], p[3]);

    for (int order = 0; order < 256; order++) {
        int i = order & 3, j = order >> 2 & 3, k = order >> 4 & 3, l = order >> 6;
        int parity = (i > j) + (i > k) + (i > l) + (j > k) + (j > l) + (k > l);

        if ((1 << i | 1 << j | 1 << k | 1 << l) != 15) continue;
        assert_int_equal(orient3d(p[i], p[j], p[k], p[l]), parity % 2 ? -expected : expected);
    }
    tally->count[expected + 1]++;
}

static void check_collinear(double p[3][3], struct tally *tally) {
    int turns = 0;

    for (int k = 0; k < 3; k++) {
        double q[3][2];

        for (int i = 0; i < 3; i++) {
            q[i][0] = p[i][k];
            q[i][1] = p[i][(k + 1) % 3];
        }
        turns |= exact_orient2d(q[0], q[1], q[2]);
    }
    assert_true(collinear(p[0], p[1], p[2]) == (turns == 0));
    assert_true(collinear(p[2], p[0], p[1]) == (turns == 0));
    tally->count[turns == 0]++;
}

TEST(known_signs) {
    const double o[3] = {0, 0, 0}, x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    const double d1[3] = {1, 1, 1}, d3[3] = {3, 3, 3}, bent[3] = {3, 3, nextafter(3, 4)};

    assert_int_equal(orient2d(0, 0, 1, 0, 0, 1), 1);
    assert_int_equal(orient2d(0, 0, 0, 1, 1, 0), -1);
    assert_int_equal(orient2d(0, 0, 1, 1, 3, 3), 0);
    assert_int_equal(orient3d(o, x, y, z), 1);
    assert_int_equal(orient3d(o, y, x, z), -1);
    assert_int_equal(orient3d(o, x, y, d1), 1);
    assert_int_equal(orient3d(o, x, d1, d3), 0);
    assert_true(collinear(o, d1, d3));
    assert_true(collinear(o, o, o));
    assert_true(collinear(o, o, d3));
    assert_false(collinear(o, d1, bent));
    assert_false(collinear(o, x, y));
}

/* Integers below 2^40 are also computed in 128 bits, which checks the oracle as well. */
TEST(integer_coordinates) {
    struct tally tally = {{0}};

    for (int round = 0; round < ROUND_COUNT; round++) {
        double p[4][3];
        __int128 e[3][3], sum = 0;
        int64_t size = (int64_t)1 << random_integer(0, 39);

        for (int i = 0; i < 12; i++)
            p[i / 3][i % 3] = (double)((int64_t)(random_bits() % (uint64_t)(2 * size + 1)) - size);
        for (int i = 0; i < 9; i++) e[i / 3][i % 3] = (__int128)(p[i / 3 + 1][i % 3] - p[0][i % 3]);
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, k = (i + 2) % 3;

            sum += e[0][i] * (e[1][j] * e[2][k] - e[1][k] * e[2][j]);
        }
        assert_int_equal(orient3d(p[0], p[1], p[2], p[3]), (sum > 0) - (sum < 0));
        check_space(p, &tally);
    }
    require_all_signs("integers", &tally);
}

/* Few mantissas and two exponents from the whole domain: large terms cancel and small ones decide. */
static double random_mixed(const int exponents[2]) {
    int exponent = exponents[random_integer(0, 1)];
    double value = ldexp(random_integer(-2, 2), exponent);

    return random_integer(0, 9) == 0 ? into_domain(nudge_by_ulp(value)) : value;
}

static double random_wide(void) {
    int exponent = random_integer(-310, 300);

    return into_domain(ldexp(random_unit(), exponent));
}

TEST(mixed_magnitudes) {
    static const int choices[] = {-300, -299, -150, 0, 150, 297, 298};
    struct tally plane = {{0}}, space = {{0}}, lines = {{0}};

    for (int round = 0; round < ROUND_COUNT; round++) {
        const int exponents[2] = {choices[round % 7], choices[round / 7 % 7]};
        double p[4][3];

        for (int i = 0; i < 12; i++)
            p[i / 3][i % 3] = round % 4 == 0 ? random_wide() : random_mixed(exponents);
        check_plane(p, &plane);
        check_space(p, &space);
        check_collinear(p, &lines);
    }
    require_all_signs("mixed magnitudes, plane", &plane);
    require_all_signs("mixed magnitudes, space", &space);
}

/* Adds weight (to - from), rounded; with few bits the result is often exactly on the line or plane. */
static void add_blend(const double from[3], const double to[3], double weight, double result[3]) {
    for (int k = 0; k < 3; k++) result[k] = into_domain(result[k] + weight * (to[k] - from[k]));
}

static void random_point(double point[3], int bits, int exponent) {
    for (int k = 0; k < 3; k++) {
        point[k] = into_domain(ldexp(rint(ldexp(random_unit(), bits)), exponent - bits));
    }
}

static double random_weight(void) {
    return random_integer(0, 1) ? random_unit() : ldexp(random_integer(-8, 8), -2);
}

TEST(near_planes) {
    struct tally space = {{0}};

    for (int round = 0; round < ROUND_COUNT; round++) {
        int bits = random_integer(2, 53), exponent = random_integer(-295, 296);
        double p[4][3] = {{0.0}};

        for (int i = 0; i < 3; i++) random_point(p[i], bits, exponent);
        for (int k = 0; k < 3; k++) p[3][k] = p[0][k];
        add_blend(p[0], p[1], random_weight(), p[3]);
        add_blend(p[0], p[2], random_weight(), p[3]);
        if (random_integer(0, 1)) nudge_point(p[3]);
        nudge_point(p[3 - round % 2 * 3]);
        check_space(p, &space);
    }
    require_all_signs("an ulp off a plane", &space);
}

TEST(near_lines) {
    struct tally plane = {{0}}, lines = {{0}};

    for (int round = 0; round < ROUND_COUNT; round++) {
        int bits = random_integer(2, 53), exponent = random_integer(-295, 296);
        double p[3][3] = {{0.0}};

        for (int i = 0; i < 2; i++) random_point(p[i], bits, exponent);
        for (int k = 0; k < 3; k++) p[2][k] = p[0][k];
        add_blend(p[0], p[1], random_weight(), p[2]);
        if (random_integer(0, 1)) nudge_point(p[2]);
        check_plane(p, &plane);
        check_collinear(p, &lines);
    }
    require_all_signs("an ulp off a line", &plane);
    printf("%-28s %7d bent %7d straight\n", "collinear", lines.count[0], lines.count[1]);
    assert_true(lines.count[0] >= 500 && lines.count[1] >= 500);
}

/* n (n + 2) - (n + 1)^2 = -1: determinants of one lowest bit, down to 2^-1056, the last that can occur. */
TEST(lowest_bit) {
    const double n = 0x1p52 + 1;
    struct tally tally = {{0}};

    for (int exponent = -352; exponent <= 247; exponent++) {
        double x = ldexp(n, exponent), y = ldexp(n + 1, exponent), z = ldexp(n + 2, exponent);
        double p[4][3] = {{0, 0, 0}, {x, y, 0}, {y, z, 0}, {0, 0, 0}};

        for (int shift = -300; shift <= 300; shift += 150) {
            p[3][2] = ldexp(1.0, shift);
            assert_int_equal(exact_orient3d(p[0], p[1], p[2], p[3]), -1);
            check_space(p, &tally);
            p[3][0] = nextafter(0x1p-300, 1);
            p[3][1] = 0x1p300;
            check_space(p, &tally);
            p[3][0] = p[3][1] = 0;
        }
    }
}

/* Scaling by powers of two, up to the ends of the domain, changes no sign. */
TEST(powers_of_two) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        double p[4][3], q[4][3];
        int exponent = random_integer(-300, 297);

        for (int i = 0; i < 12; i++) {
            p[i / 3][i % 3] = random_integer(-4, 4);
            q[i / 3][i % 3] = ldexp(p[i / 3][i % 3], exponent);
        }
        assert_int_equal(orient3d(q[0], q[1], q[2], q[3]), orient3d(p[0], p[1], p[2], p[3]));
        assert_int_equal(orient2d_points(q[0], q[1], q[2]), orient2d_points(p[0], p[1], p[2]));
        assert_true(collinear(q[0], q[1], q[2]) == collinear(p[0], p[1], p[2]));
    }
}

AROUND_EACH(seed_random, NULL)
