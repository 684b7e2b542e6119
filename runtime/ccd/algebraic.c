/* Real roots of integer polynomials, and exact signs of other polynomials at them.
 *
 * No sign needs a root to be refined. A root is told from its neighbours by its number among the distinct
 * real roots, and the sign of another polynomial at it follows from its place among the roots of that
 * polynomial. By Sturm's theorem and by reduction modulo a polynomial, this comes down to signs of
 * polynomials at roots of quadratics, and these to signs of integers. So the cost has a bound, however close
 * the roots are. */
#include "runtime/ccd/elementary_levels.h"
#include "runtime/ccd/exact.h"

#include <assert.h>
#include <math.h>

/* ---- polynomials --------------------------------------------------------------------------------------- */

static void find_degree(polynomial *a) {
    a->degree = POLYNOMIAL_DEGREE_MAX;
    while (a->degree >= 0 && a->c[a->degree].size == 0) a->degree--;
}

polynomial polynomial_zero(void) {
    return (polynomial){.degree = -1};
}

polynomial polynomial_linear(integer c0, integer c1) {
    polynomial out = {.c = {c0, c1}};
    find_degree(&out);
    return out;
}

polynomial polynomial_add(integer_pool *pool, const polynomial *a, const polynomial *b) {
    polynomial out;
    for (int i = 0; i <= POLYNOMIAL_DEGREE_MAX; i++) out.c[i] = integer_add(pool, a->c[i], b->c[i]);
    find_degree(&out);
    return out;
}

polynomial polynomial_negate(const polynomial *a) {
    polynomial out = {.degree = a->degree};
    for (int i = 0; i <= POLYNOMIAL_DEGREE_MAX; i++) out.c[i] = integer_negate(a->c[i]);
    return out;
}

polynomial polynomial_subtract(integer_pool *pool, const polynomial *a, const polynomial *b) {
    polynomial negated = polynomial_negate(b);
    return polynomial_add(pool, a, &negated);
}

polynomial polynomial_multiply(integer_pool *pool, const polynomial *a, const polynomial *b) {
    polynomial out = polynomial_zero();
    assert(a->degree < 0 || b->degree < 0 || a->degree + b->degree <= POLYNOMIAL_DEGREE_MAX);
    uint32_t mark = pool->used;
    for (int i = 0; i <= a->degree; i++) {
        for (int j = 0; j <= b->degree; j++) {
            integer product = integer_multiply(pool, a->c[i], b->c[j]);
            out.c[i + j] = integer_add(pool, out.c[i + j], product);
        }
    }
    find_degree(&out);
    polynomial_keep(pool, mark, &out);
    return out;
}

polynomial polynomial_remainder(integer_pool *pool, const polynomial *a, const polynomial *b) {
    polynomial out = *a;
    uint32_t mark = pool->used;
    while (out.degree >= b->degree) {
        integer leading = out.c[out.degree];
        int shift = out.degree - b->degree;
        for (int i = 0; i < out.degree; i++) {
            out.c[i] = integer_multiply(pool, out.c[i], b->c[b->degree]);
            if (i >= shift)
                out.c[i] = integer_subtract(pool, out.c[i], integer_multiply(pool, leading, b->c[i - shift]));
        }
        out.c[out.degree] = (integer){0, out.c[out.degree].limbs};
        find_degree(&out);
    }
    polynomial_keep(pool, mark, &out);
    return out;
}

/* The Bernstein coefficients for degree 2 are c0, c0 + c1 / 2 and c0 + c1 + c2. */
int polynomial_sign_on_interval(integer_pool *pool, const polynomial *a) {
    if (a->degree < 0 || a->degree > 2) return 0;
    uint32_t mark = pool->used;
    integer sum = integer_add(pool, a->c[0], a->c[1]);
    int start = integer_sign(a->c[0]), end = integer_sign(integer_add(pool, sum, a->c[2]));
    int middle = a->degree < 2 ? start : integer_sign(integer_add(pool, sum, a->c[0]));
    pool->used = mark;
    return start == middle && middle == end ? start : 0;
}

void polynomial_keep(integer_pool *pool, uint32_t mark, polynomial *a) {
    integer_pool_keep(pool, mark, a->c, POLYNOMIAL_DEGREE_MAX + 1);
}

/* ---- roots --------------------------------------------------------------------------------------------- */

/* Places are given in units of 1 / grid. The first width that is tried about a guess is first_width. It grows
 * by the factor width_growth until it holds the root. A bracket below `narrow` is narrow enough; this is also
 * the size of a cell, ROOT_CELL. */
static const int64_t grid = (int64_t)1 << 60;
static const int64_t first_width = (int64_t)1 << 14, width_growth = 32, narrow = (int64_t)1 << 26;

static integer multiply_three(integer_pool *pool, integer a, integer b, integer c) {
    return integer_multiply(pool, integer_multiply(pool, a, b), c);
}

static polynomial with_positive_lead(const polynomial *a) {
    return a->c[a->degree].size > 0 ? *a : polynomial_negate(a);
}

static algebraic simple_root(const polynomial *p) {
    return (algebraic){.p = with_positive_lead(p)};
}

static int linear_root(integer c0, integer c1, algebraic *out) {
    polynomial p = polynomial_linear(c0, c1);
    *out = simple_root(&p);
    return 1;
}

static int quadratic_roots(integer_pool *pool, const polynomial *p, algebraic out[2]) {
    const integer *c = p->c;
    integer product = integer_scale(pool, integer_multiply(pool, c[0], c[2]), 4);
    int discriminant = integer_sign(integer_subtract(pool, integer_multiply(pool, c[1], c[1]), product));
    if (discriminant < 0) return 0;
    if (discriminant == 0) return linear_root(c[1], integer_scale(pool, c[2], 2), out);
    for (int i = 0; i < 2; i++) {
        out[i] = simple_root(p);
        out[i].index = i;
    }
    return 2;
}

static int sign_changes(const int *signs, int count) {
    int changes = 0, last = 0;
    for (int i = 0; i < count; i++) {
        if (signs[i] == 0) continue;
        changes += last != 0 && signs[i] != last;
        last = signs[i];
    }
    return changes;
}

/* Writes the roots of p = c3 (t - d)^2 (t - e), where d = -r0 / r1 and 2 d + e = -c2 / c3. */
static int double_and_simple_root(integer_pool *pool, const integer c[4], integer r0, integer r1,
                                  algebraic out[2]) {
    integer numerator = integer_subtract(pool, integer_scale(pool, integer_multiply(pool, r0, c[3]), 2),
                                         integer_multiply(pool, c[2], r1));
    linear_root(r0, r1, &out[0]);
    linear_root(integer_negate(numerator), integer_multiply(pool, c[3], r1), &out[1]);
    return 2;
}

/* Sturm's chain for c3 > 0 is
 *     p,
 *     p',
 *     -(r0 + r1 t), where 9 c3 p = (3 c3 t + c2) p' + r0 + r1 t, r1 = 6 c1 c3 - 2 c2^2, r0 = 9 c0 c3 - c1 c2,
 *     a constant whose sign is opposite to that of p' at -r0 / r1. */
static int cubic_roots(integer_pool *pool, const polynomial *p, algebraic out[3]) {
    const integer *c = p->c;
    integer r1 = integer_subtract(pool, integer_scale(pool, integer_multiply(pool, c[1], c[3]), 6),
                                  integer_scale(pool, integer_multiply(pool, c[2], c[2]), 2));
    integer r0 = integer_subtract(pool, integer_scale(pool, integer_multiply(pool, c[0], c[3]), 9),
                                  integer_multiply(pool, c[1], c[2]));
    integer c3_3 = integer_scale(pool, c[3], 3), c2_2 = integer_scale(pool, c[2], 2);
    if (r1.size == 0 && r0.size == 0) return linear_root(c[2], c3_3, out); /* a triple root */
    algebraic root = {.p = *p};
    if (r1.size != 0) {
        uint32_t mark = pool->used;
        integer at_root =
            integer_add(pool, multiply_three(pool, c[1], r1, r1), multiply_three(pool, c3_3, r0, r0));
        at_root = integer_subtract(pool, at_root, multiply_three(pool, c2_2, r0, r1));
        root.last = -integer_sign(at_root);
        pool->used = mark;
        if (root.last == 0) return double_and_simple_root(pool, c, r0, r1, out);
    }
    root.derivative = (polynomial){2, {c[1], c2_2, c3_3}};
    root.linear = polynomial_linear(integer_negate(r0), integer_negate(r1));
    int lead = -integer_sign(r1), constant = -integer_sign(r0);
    const int before[4] = {-1, 1, lead != 0 ? -lead : constant, root.last};
    const int after[4] = {1, 1, lead != 0 ? lead : constant, root.last};
    root.changes = sign_changes(before, 4);
    int count = root.changes - sign_changes(after, 4);
    for (int i = 0; i < count; i++) {
        out[i] = root;
        out[i].index = i;
    }
    return count;
}

int algebraic_roots(integer_pool *pool, const polynomial *a, algebraic out[3]) {
    if (a->degree < 1) return 0;
    polynomial p = with_positive_lead(a);
    if (p.degree == 1) return linear_root(p.c[0], p.c[1], out);
    return p.degree == 2 ? quadratic_roots(pool, &p, out) : cubic_roots(pool, &p, out);
}

/* Returns the sign of q at -c0 / c1, the root of p, by Horner's rule with the denominators multiplied out. c1
 * is above 0. */
static int sign_at_rational(integer_pool *pool, const polynomial *p, const polynomial *q) {
    integer numerator = integer_negate(p->c[0]), denominator = p->c[1], power = denominator;
    integer value = q->c[q->degree];
    for (int i = q->degree - 1; i >= 0; i--) {
        value = integer_multiply(pool, value, numerator);
        value = integer_add(pool, value, integer_multiply(pool, q->c[i], power));
        if (i > 0) power = integer_multiply(pool, power, denominator);
    }
    return integer_sign(value);
}

/* Returns the sign of root - tau, where root is one of the two roots of p, and tau = -l0 / l1 is the root of
 * the line l. Between the two roots p is negative. Beyond them, and at them, the sign of p' says on which
 * side tau is. */
static int compare_with_line(integer_pool *pool, const algebraic *root, const polynomial *l) {
    integer p0 = root->p.c[0], p1 = root->p.c[1], p2 = root->p.c[2], l0 = l->c[0], l1 = l->c[1];
    integer p2_l0 = integer_multiply(pool, p2, l0), p1_l1 = integer_multiply(pool, p1, l1);
    integer at_tau = integer_multiply(pool, integer_subtract(pool, p2_l0, p1_l1), l0);
    at_tau = integer_add(pool, at_tau, multiply_three(pool, p0, l1, l1));
    int value = integer_sign(at_tau);
    if (value < 0) return root->index == 0 ? -1 : 1;
    integer slope = integer_subtract(pool, p1_l1, integer_scale(pool, p2_l0, 2));
    bool beyond_second = integer_sign(slope) * integer_sign(l1) > 0;
    if (value == 0 && beyond_second == (root->index == 1)) return 0;
    return beyond_second ? -1 : 1;
}

static int sign_at_quadratic_root(integer_pool *pool, const algebraic *root, const polynomial *q) {
    polynomial rest = q->degree >= 2 ? polynomial_remainder(pool, q, &root->p) : *q;
    if (rest.degree < 1) return integer_sign(rest.c[0]);
    return integer_sign(rest.c[1]) * compare_with_line(pool, root, &rest);
}

static int sign_below_cubic(integer_pool *pool, const algebraic *root, const polynomial *q) {
    uint32_t mark = pool->used;
    int sign = q->degree < 1         ? integer_sign(q->c[0])
               : root->p.degree == 1 ? sign_at_rational(pool, &root->p, q)
                                     : sign_at_quadratic_root(pool, root, q);
    pool->used = mark;
    return sign;
}

/* Returns the sign of root - other, where root is one of a cubic's roots and other is one of a polynomial of
 * lower degree. */
static int compare_roots(integer_pool *pool, const algebraic *root, const algebraic *other) {
    const int signs[4] = {sign_below_cubic(pool, other, &root->p),
                          sign_below_cubic(pool, other, &root->derivative),
                          sign_below_cubic(pool, other, &root->linear), root->last};
    int up_to_other = root->changes - sign_changes(signs, 4);
    if (signs[0] == 0 && up_to_other == root->index + 1) return 0;
    return up_to_other > root->index ? -1 : 1;
}

static int sign_at_cubic_root(integer_pool *pool, const algebraic *root, const polynomial *q) {
    uint32_t mark = pool->used;
    algebraic others[3];
    int count = algebraic_roots(pool, q, others), sign = integer_sign(q->c[q->degree]);
    for (int i = 0; i < count && sign != 0; i++) sign *= compare_roots(pool, root, &others[i]);
    if (q->degree == 2 && count == 1 && sign != 0) sign = integer_sign(q->c[2]); /* a double root */
    pool->used = mark;
    return sign;
}

/* Writes the coefficients, each to a relative error of 2^-52, times a power of two that brings the largest
 * one near 1. */
static void approximate_coefficients(const polynomial *p, double c[4]) {
    int exponents[4], largest = INT32_MIN;
    for (int i = 0; i <= POLYNOMIAL_DEGREE_MAX; i++) {
        c[i] = integer_to_double(p->c[i], &exponents[i]);
        if (c[i] != 0.0 && exponents[i] > largest) largest = exponents[i];
    }
    for (int i = 0; i <= POLYNOMIAL_DEGREE_MAX; i++)
        if (c[i] != 0.0) c[i] = ldexp(c[i], exponents[i] - largest);
}

/* Returns the sign of q, of degree 2 at most, at a located root if floating point is certain of it, and 0
 * otherwise. Let s be the sum of the coefficients' magnitudes. The coefficients carry relative errors of
 * 2^-52, and Horner's rule adds at most 4 roundings to each, together below 2^-50 s. The slope is at most 2
 * s. The bounds are doubled to cover their own rounding. Coefficients lost to underflow are below 2^-1020 s.
 */
static int sign_by_approximation(const algebraic *root, const polynomial *q) {
    double c[4];
    approximate_coefficients(q, c);
    double value = c[0] + root->low * (c[1] + root->low * c[2]);
    double error = (0x1p-49 + 4.0 * (root->high - root->low)) * (fabs(c[0]) + fabs(c[1]) + fabs(c[2]));
    return value > error ? 1 : value < -error ? -1 : 0;
}

int algebraic_sign(integer_pool *pool, const algebraic *root, const polynomial *q) {
    if (q->degree < 0) return 0;
    int sign = root->located ? sign_by_approximation(root, q) : 0;
    if (sign != 0) return sign;
    return root->p.degree == 3 ? sign_at_cubic_root(pool, root, q) : sign_below_cubic(pool, root, q);
}

/* Bounds of the root: low <= root <= high. */
typedef struct bracket {
    int64_t low, high;
} bracket;

/* Returns the sign of root - at, and narrows the bracket by it. */
static int compare_at(integer_pool *pool, const algebraic *root, int64_t at, bracket *known) {
    uint32_t mark = pool->used;
    polynomial line = polynomial_linear(integer_from_int(pool, -at), integer_from_int(pool, grid));
    int sign = algebraic_sign(pool, root, &line);
    pool->used = mark;
    if (sign >= 0 && at > known->low) known->low = at;
    if (sign <= 0 && at < known->high) known->high = at;
    return sign;
}

/* Returns an approximation of the root, moved into [0,1], or 1/2 if there is none. */
static double guess_root(const algebraic *root) {
    double c[4], guesses[3];
    approximate_coefficients(&root->p, c);
    int count = cubic_guess_roots(c, guesses);
    double guess = root->index < count ? guesses[root->index] : 0.5;
    return guess > 0.0 ? (guess < 1.0 ? guess : 1.0) : 0.0;
}

/* Searches for the root from a guess outwards, in growing steps. */
static void search_from_guess(integer_pool *pool, const algebraic *root, bracket *known) {
    int64_t at = (int64_t)(guess_root(root) * (double)grid), width = first_width;
    int direction = compare_at(pool, root, at, known);
    while (known->high - known->low >= narrow && direction != 0) {
        at += direction * width;
        if (at <= known->low || at >= known->high) return;
        if (compare_at(pool, root, at, known) != direction) return;
        width = width < grid / width_growth ? width * width_growth : grid;
    }
}

/* These round to a double, the first one towards zero and the second one away from it. */
static double double_below(int64_t x) {
    double rounded = (double)x;
    return (int64_t)rounded > x ? nextafter(rounded, 0.0) : rounded;
}

static double double_above(int64_t x) {
    double rounded = (double)x;
    return (int64_t)rounded < x ? nextafter(rounded, 0x1p61) : rounded;
}

/* Returns the greatest multiple of `narrow` that is not above the root. A bracket below `narrow` holds at
 * most one, and the root is compared with it. */
static int64_t cell_of(integer_pool *pool, const algebraic *root, bracket *known) {
    int64_t cell = known->low - known->low % narrow, next = cell + narrow;
    return next <= known->high && compare_at(pool, root, next, known) >= 0 ? next : cell;
}

bool algebraic_locate(integer_pool *pool, algebraic *root) {
    bracket known = {INT64_MIN, INT64_MAX};
    if (compare_at(pool, root, 0, &known) < 0 || compare_at(pool, root, grid, &known) > 0) return false;
    search_from_guess(pool, root, &known);
    while (known.high - known.low >= narrow)
        compare_at(pool, root, known.low + (known.high - known.low) / 2, &known);
    root->cell = (double)cell_of(pool, root, &known) / (double)grid;
    root->located = true;
    root->low = double_below(known.low) / (double)grid;
    root->high = double_above(known.high) / (double)grid;
    return true;
}
