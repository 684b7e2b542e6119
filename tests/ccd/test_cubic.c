/* The coplanarity cubic: roots of known polynomials, and the error bound against exact integers. */
#include "runtime/ccd/ccd.h"
#include "runtime/ccd/elementary_levels.h"
#include "tests/support/ccd/wide_numbers.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUND_COUNT = 20000 };

static int seed_random(void **state) {
    (void)state;
    random_seed(7);
    return 0;
}

/* ---- isolation of roots ---- */

/* leading (t - root) ((t - centre)^2 + shift): a pair of real roots, a double one, or a pair of complex
 * ones. */
typedef struct test_polynomial {
    long double leading, root, centre, shift;
} test_polynomial;

static long double value_at(const test_polynomial *f, long double t) {
    return f->leading * (t - f->root) * ((t - f->centre) * (t - f->centre) + f->shift);
}

static void to_bernstein(const test_polynomial *f, double b[4]) {
    long double l0 = -f->leading * f->root, l1 = f->leading * (1 - f->root);
    long double c = f->centre, q0 = c * c + f->shift, q1 = q0 - c, q2 = (1 - c) * (1 - c) + f->shift;
    b[0] = (double)(l0 * q0);
    b[1] = (double)((l1 * q0 + 2 * l0 * q1) / 3);
    b[2] = (double)((2 * l1 * q1 + l0 * q2) / 3);
    b[3] = (double)(l1 * q2);
}

static double largest_coefficient(const double b[4]) {
    return fmax(fmax(fabs(b[0]), fabs(b[1])), fmax(fabs(b[2]), fabs(b[3])));
}

typedef struct root_list {
    root_interval items[ROOTS_MAX];
    int count;
    double error, slack; /* slack: rounding of coefficients, evaluation and ends */
} root_list;

/* Outside of the intervals no cubic within error of this one has a root. */
static void check_where_small(const root_list *list, const test_polynomial *f, long double t) {
    if (t < 0 || t > 1 || fabsl(value_at(f, t)) > list->error - list->slack) return;
    bool found = false;
    for (int i = 0; i < list->count; i++) found |= t >= list->items[i].begin && t <= list->items[i].end;
    assert_true(found);
}

/* Ascending, disjoint, narrow; where certain, every cubic within error changes its sign between the ends. */
static void check_intervals(const root_list *list, const test_polynomial *f) {
    for (int i = 0; i < list->count; i++) {
        double begin = list->items[i].begin, end = list->items[i].end;
        assert_true(begin >= 0.0 && begin <= end && end <= 1.0 && end - begin < 1.0 / 64.0);
        if (i > 0) assert_true(list->items[i - 1].end < begin);
        double toi = list->items[i].toi;
        assert_true(toi == -1.0 || (toi >= 0.0 && toi <= begin && toi > begin - 0x1p-34));
        if (!list->items[i].certain) continue;
        long double start = value_at(f, begin), stop = value_at(f, end), least = list->error - list->slack;
        assert_true((start >= least && stop <= -least) || (start <= -least && stop >= least));
    }
}

static root_list find_roots(const test_polynomial *f, double relative_error) {
    coplanarity cubic;
    to_bernstein(f, cubic.b);
    cubic.error = relative_error * largest_coefficient(cubic.b);
    root_list list = {.error = cubic.error, .slack = 0x1p-46 * largest_coefficient(cubic.b)};
    list.count = cubic_isolate(&cubic, list.items);
    assert_true(list.count >= ROOTS_UNCERTAIN && list.count <= ROOTS_MAX);
    return list;
}

/* Returns whether the roots could be isolated. */
static bool check_polynomial(const test_polynomial *f) {
    root_list list = find_roots(f, random_integer(0, 1) ? 0x1p-44 : ldexp(1.0, -random_integer(20, 43)));
    if (list.count == ROOTS_UNCERTAIN) return false;
    check_intervals(&list, f);
    long double spread = f->shift < 0 ? sqrtl(-f->shift) : 0;
    const long double places[4] = {f->root, f->centre - spread, f->centre + spread, f->centre};
    for (int i = 0; i < 4; i++) {
        check_where_small(&list, f, places[i]);
        for (int exponent = -50; exponent < 0; exponent++) {
            check_where_small(&list, f, places[i] + ldexpl(1.0L, exponent));
            check_where_small(&list, f, places[i] - ldexpl(1.0L, exponent));
        }
    }
    for (int i = 0; i <= 100; i++) check_where_small(&list, f, i / 100.0L);
    return true;
}

static long double random_root(void) {
    switch (random_integer(0, 7)) {
    case 0:
        return 0;
    case 1:
        return 1;
    case 2:
        return random_integer(-4, 8) / 4.0L;
    case 3:
        return random_unit() * pow(10.0, random_integer(1, 9));
    default:
        return random_between(0.0, 1.0);
    }
}

static long double tiny_number(void) {
    return random_integer(0, 2) * pow(10.0, -random_integer(1, 18));
}

/* Single, double and triple roots, roots near each other, roots at the ends, complex pairs near the axis. */
TEST(known_roots) {
    int isolated = 0;
    for (int round = 0; round < 5 * ROUND_COUNT; round++) {
        test_polynomial f = {.root = random_root(), .centre = random_root()};
        if (random_integer(0, 2) == 0) f.root = f.centre + random_integer(-1, 1) * tiny_number();
        f.shift = random_integer(-1, 1) * tiny_number();
        if (random_integer(0, 3) == 0) f.shift = random_unit();
        f.leading = ldexp(random_integer(0, 1) ? 1.0 : -1.0, random_integer(-300, 300));
        isolated += check_polynomial(&f);
    }
    printf("isolated: %d of %d\n", isolated, 5 * ROUND_COUNT);
    assert_true(isolated > ROUND_COUNT);
}

/* One root far outside: the cubic's leading coefficient is tiny beside the others. */
TEST(tiny_leading_coefficient) {
    for (int exponent = 1; exponent < 1000; exponent++) {
        test_polynomial f = {.root = ldexp(random_unit(), exponent), .centre = random_between(0.0, 1.0)};
        f.leading = ldexp(1.0, -exponent);
        f.shift = random_integer(-1, 1) * tiny_number();
        if (fabsl(f.root) > 1) check_polynomial(&f);
    }
}

/* Well separated roots, a small error: as many intervals as roots, each about its root. */
TEST(separate_roots) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        double spread = random_between(0.05, 0.25), between = random_between(0.3, 0.7);
        test_polynomial f = {1, between + (random_integer(0, 1) ? spread / 2 : -spread / 2), between,
                             -(long double)spread * spread};
        root_list list = find_roots(&f, 0x1p-44);
        assert_int_equal(list.count, 3);
        check_intervals(&list, &f);
        for (int i = 0; i < 3; i++)
            assert_true(list.items[i].certain && list.items[i].end - list.items[i].begin < 1e-9);
    }
}

static int isolate_roots(double b0, double b1, double b2, double b3, double error,
                         root_interval found[ROOTS_MAX]) {
    const coplanarity f = {{b0, b1, b2, b3}, error};
    return cubic_isolate(&f, found);
}

TEST(special_cases) {
    root_interval found[ROOTS_MAX];
    assert_int_equal(isolate_roots(1, 1, 1, 1, 0.5, found), 0);
    assert_int_equal(isolate_roots(-1, -1, -1, -1, 0.5, found), 0);
    assert_int_equal(isolate_roots(1, -0.25, 0.25, 1, 0x1p-44, found), 0); /* by subdivision */
    assert_int_equal(isolate_roots(0, 0, 0, 0, 0x1p-1060, found), ROOTS_UNCERTAIN);
    assert_int_equal(isolate_roots(1, 1, 1, 1, 1.0, found), ROOTS_UNCERTAIN);
    assert_int_equal(isolate_roots(0, 1, 1, 1, 0x1p-44, found), 1);
    assert_true(found[0].begin == 0.0 && found[0].end < 1e-12 && !found[0].certain);
    assert_int_equal(isolate_roots(1, 1, 1, 0, 0x1p-44, found), 1);
    assert_true(found[0].begin > 1.0 - 1e-12 && found[0].end == 1.0 && !found[0].certain);
    assert_int_equal(isolate_roots(1, 0, 0, -1, 0x1p-44, found), 1);
    assert_true(found[0].begin < 0.5 && found[0].end > 0.5 && found[0].certain);
}

/* ---- the error bound ---- */

typedef struct exact_integer exact;

static exact exact_sum(exact a, exact b) {
    return exact_add(&a, &b);
}

static exact exact_difference(exact a, exact b) {
    return exact_subtract(&a, &b);
}

static exact exact_product(exact a, exact b) {
    return exact_multiply(&a, &b);
}

/* Points at both ends; vectors[d][end] is the exact difference of point d + 1 and point 0. */
typedef struct tetrahedra {
    double x[2][4][3];
    exact vectors[3][2][3];
} tetrahedra;

static double nudge_value(double value) {
    return value == 0.0 ? 0.0 : nextafter(value, random_integer(0, 1) ? INFINITY : -INFINITY);
}

/* One coordinate the same for all points at one end or both: a plane, which a nudge may then undo. */
static void flatten_coordinate(double x[2][4][3]) {
    int k = random_integer(0, 2), first = random_integer(0, 1), last = random_integer(first, 1);
    for (int end = first; end <= last; end++) {
        for (int i = 1; i < 4; i++) x[end][i][k] = x[end][0][k];
    }
    if (random_integer(0, 1)) x[first][3][k] = nudge_value(x[first][3][k]);
}

static void random_tetrahedra(tetrahedra *s) {
    int bits = random_integer(0, 3) == 0 ? 53 : random_integer(1, 10);
    int exponent = random_integer(-30, 30);
    double offset = random_integer(0, 1) ? ldexp(random_unit(), exponent + random_integer(0, 30)) : 0.0;
    for (int i = 0; i < 24; i++) {
        double *x = &s->x[i / 12][i / 3 % 4][i % 3];
        *x = offset + ldexp(rint(ldexp(random_unit(), bits)), exponent - random_integer(0, 2) - bits);
        if (random_integer(0, 15) == 0) *x = nudge_value(*x);
    }
    if (random_integer(0, 1)) flatten_coordinate(s->x);
    for (int i = 0; i < 18; i++) {
        int d = i / 6, end = i / 3 % 2, k = i % 3;
        s->vectors[d][end][k] =
            exact_difference(exact_from_double(s->x[end][d + 1][k]), exact_from_double(s->x[end][0][k]));
    }
}

static exact exact_determinant(const tetrahedra *s, int a, int b, int c) {
    const exact *u = s->vectors[0][a], *v = s->vectors[1][b], *w = s->vectors[2][c];
    exact sum = {0};
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        sum = exact_sum(
            sum, exact_product(w[i], exact_difference(exact_product(u[j], v[k]), exact_product(u[k], v[j]))));
    }
    return sum;
}

/* Three times the coefficient, in units of 2^(3 EXACT_UNIT_EXPONENT). */
static exact exact_coefficient(const tetrahedra *s, int i) {
    if (i == 0 || i == 3) {
        int end = i == 3;
        return exact_product((exact){1, 1, {3}}, exact_determinant(s, end, end, end));
    }
    int one = i == 1, other = i == 2; /* the end that is taken once, and the one taken twice */
    return exact_sum(
        exact_determinant(s, one, other, other),
        exact_sum(exact_determinant(s, other, one, other), exact_determinant(s, other, other, one)));
}

/* 3 value in the same units; values below 2^-300 count as 0. */
static exact tripled_exact(double value) {
    exact one = exact_from_double(1.0), three = {1, 1, {3}};
    if (fabs(value) < 0x1p-300) return (exact){0};
    return exact_product(three, exact_product(exact_from_double(value), exact_product(one, one)));
}

/* As a vertex, the last point, and the face of the others. */
static coplanarity computed_cubic(const tetrahedra *s) {
    elementary_query query;
    point_vectors vectors;
    for (int i = 0; i < 4; i++) {
        memcpy(query.x0[(i + 1) % 4], s->x[0][i], sizeof query.x0[0]);
        memcpy(query.x1[(i + 1) % 4], s->x[1][i], sizeof query.x1[0]);
    }
    point_vectors_from(&query, CSCD_CONTACT_VF, &vectors);
    return coplanarity_cubic(&vectors);
}

TEST(error_bound) {
    static tetrahedra s;
    int excluded = 0, zeros = 0, uncertain = 0;
    for (int round = 0; round < ROUND_COUNT; round++) {
        random_tetrahedra(&s);
        coplanarity f = computed_cubic(&s);
        int signs = 0;
        for (int i = 0; i < 4; i++) {
            exact value = exact_coefficient(&s, i);
            exact difference = exact_difference(tripled_exact(f.b[i]), value);
            difference.sign = abs(difference.sign);
            assert_true(exact_difference(tripled_exact(f.error), difference).sign >= 0);
            signs += value.sign;
            zeros += value.sign == 0;
        }
        bool out = coplanarity_excluded(&f);
        if (out) assert_true(signs == 4 || signs == -4);
        excluded += out;
        uncertain += !out && (signs == 4 || signs == -4);
    }
    printf("excluded %d, excluded by exact signs only %d, coefficients that are 0 %d\n", excluded, uncertain,
           zeros);
    assert_true(excluded >= 500 && zeros >= 500);
}

TEST(excluded_by_signs) {
    assert_true(coplanarity_excluded(&(coplanarity){{1, 2, 3, 4}, 0.5}));
    assert_true(coplanarity_excluded(&(coplanarity){{-1, -2, -3, -4}, 0.5}));
    for (int i = 0; i < 4; i++) {
        coplanarity f = {{1, 1, 1, 1}, 0.5}, g = {{-1, -1, -1, -1}, 0.5};
        f.b[i] = 0.5;
        g.b[i] = -0.5;
        assert_false(coplanarity_excluded(&f));
        assert_false(coplanarity_excluded(&g));
        f.b[i] = -1;
        g.b[i] = 1;
        assert_false(coplanarity_excluded(&f));
        assert_false(coplanarity_excluded(&g));
    }
}

AROUND_EACH(seed_random, NULL)
