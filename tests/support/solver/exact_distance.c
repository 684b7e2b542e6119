/* Distances of features at rest, compared with lengths by rational numbers: no rounding anywhere. The nearest points are
 * found from their parameters, which solve linear equations; the product's exact level knows areas and heights only. */
#include "tests/support/solver/exact_distance.h"

typedef struct rational_vector {
    mpq_t at[3];
} rational_vector;

static void vector_init(rational_vector *v) {
    for (int k = 0; k < 3; k++) mpq_init(v->at[k]);
}

static void vector_clear(rational_vector *v) {
    for (int k = 0; k < 3; k++) mpq_clear(v->at[k]);
}

/* out = a - b */
static void vector_between(const double b[3], const double a[3], rational_vector *out) {
    mpq_t start;
    mpq_init(start);
    for (int k = 0; k < 3; k++) {
        mpq_set_d(out->at[k], a[k]);
        mpq_set_d(start, b[k]);
        mpq_sub(out->at[k], out->at[k], start);
    }
    mpq_clear(start);
}

static void vector_dot(const rational_vector *a, const rational_vector *b, mpq_t out) {
    mpq_t product, sum;
    mpq_inits(product, sum, NULL);
    for (int k = 0; k < 3; k++) {
        mpq_mul(product, a->at[k], b->at[k]);
        mpq_add(sum, sum, product);
    }
    mpq_set(out, sum);
    mpq_clears(product, sum, NULL);
}

static void clamp_parameter(mpq_t parameter) {
    if (mpq_sgn(parameter) < 0) mpq_set_ui(parameter, 0, 1);
    if (mpq_cmp_ui(parameter, 1, 1) > 0) mpq_set_ui(parameter, 1, 1);
}

/* The squared length of c - u a - v b, if it is less than the best. */
static void take_squared(const rational_vector *a, const rational_vector *b, const rational_vector *c,
                         const mpq_t u, const mpq_t v, mpq_t best) {
    rational_vector rest;
    mpq_t product;
    vector_init(&rest);
    mpq_init(product);
    for (int k = 0; k < 3; k++) {
        mpq_mul(product, u, a->at[k]);
        mpq_sub(rest.at[k], c->at[k], product);
        mpq_mul(product, v, b->at[k]);
        mpq_sub(rest.at[k], rest.at[k], product);
    }
    vector_dot(&rest, &rest, product);
    if (mpq_sgn(best) < 0 || mpq_cmp(product, best) < 0) mpq_set(best, product);
    vector_clear(&rest);
    mpq_clear(product);
}

/* The least squared length of c - u a for u in [0, 1]. */
static void take_segment(const rational_vector *a, const rational_vector *c, mpq_t best) {
    mpq_t u, squared, zero;
    mpq_inits(u, squared, zero, NULL);
    vector_dot(a, c, u);
    vector_dot(a, a, squared);
    if (mpq_sgn(squared) > 0)
        mpq_div(u, u, squared);
    else
        mpq_set_ui(u, 0, 1);
    clamp_parameter(u);
    take_squared(a, a, c, u, zero, best);
    mpq_clears(u, squared, zero, NULL);
}

/* Solves the normal equations of c = u a + v b; false: a and b are parallel. */
static bool solve_normal_equations(const rational_vector *a, const rational_vector *b,
                                   const rational_vector *c, mpq_t u, mpq_t v) {
    mpq_t aa, ab, bb, ac, bc, determinant, product;
    mpq_inits(aa, ab, bb, ac, bc, determinant, product, NULL);
    vector_dot(a, a, aa);
    vector_dot(a, b, ab);
    vector_dot(b, b, bb);
    vector_dot(a, c, ac);
    vector_dot(b, c, bc);
    mpq_mul(determinant, aa, bb);
    mpq_mul(product, ab, ab);
    mpq_sub(determinant, determinant, product);
    bool solved = mpq_sgn(determinant) != 0;
    if (solved) {
        mpq_mul(u, ac, bb);
        mpq_mul(product, bc, ab);
        mpq_sub(u, u, product);
        mpq_div(u, u, determinant);
        mpq_mul(v, bc, aa);
        mpq_mul(product, ac, ab);
        mpq_sub(v, v, product);
        mpq_div(v, v, determinant);
    }
    mpq_clears(aa, ab, bb, ac, bc, determinant, product, NULL);
    return solved;
}

static bool inside_unit(const mpq_t x) {
    return mpq_sgn(x) >= 0 && mpq_cmp_ui(x, 1, 1) <= 0;
}

static void take_insides(const rational_vector *a, const rational_vector *b, const rational_vector *c,
                         bool triangle, mpq_t best) {
    mpq_t u, v, sum;
    mpq_inits(u, v, sum, NULL);
    if (solve_normal_equations(a, b, c, u, v)) {
        mpq_add(sum, u, v);
        if (inside_unit(u) && inside_unit(v) && (!triangle || inside_unit(sum)))
            take_squared(a, b, c, u, v, best);
    }
    mpq_clears(u, v, sum, NULL);
}

static void take_point_segment(const double point[3], const double from[3], const double to[3], mpq_t best) {
    rational_vector side, offset;
    vector_init(&side);
    vector_init(&offset);
    vector_between(from, to, &side);
    vector_between(from, point, &offset);
    take_segment(&side, &offset, best);
    vector_clear(&side);
    vector_clear(&offset);
}

static void squared_distance(cscd_contact_kind kind, const double x[4][3], mpq_t best) {
    bool vf = kind == CSCD_CONTACT_VF;
    rational_vector a, b, c;
    vector_init(&a);
    vector_init(&b);
    vector_init(&c);
    mpq_set_si(best, -1, 1);
    if (vf) {
        for (int i = 1; i < 4; i++) take_point_segment(x[0], x[i], x[i % 3 + 1], best);
        vector_between(x[1], x[2], &a);
        vector_between(x[1], x[3], &b);
        vector_between(x[1], x[0], &c);
    } else {
        for (int i = 0; i < 2; i++) {
            take_point_segment(x[i], x[2], x[3], best);
            take_point_segment(x[2 + i], x[0], x[1], best);
        }
        vector_between(x[0], x[1], &a);
        vector_between(x[3], x[2], &b); /* backwards: c = u a + v b between the lines */
        vector_between(x[0], x[2], &c);
    }
    take_insides(&a, &b, &c, vf, best);
    vector_clear(&a);
    vector_clear(&b);
    vector_clear(&c);
}

int distance_sign(cscd_contact_kind kind, const double x[4][3], const mpq_t length) {
    mpq_t squared, other;
    mpq_inits(squared, other, NULL);
    squared_distance(kind, x, squared);
    mpq_mul(other, length, length);
    int sign = mpq_cmp(squared, other);
    mpq_clears(squared, other, NULL);
    return (sign > 0) - (sign < 0);
}

int distance_sign_of_sum(cscd_contact_kind kind, const double x[4][3], double a, double b, double c) {
    mpq_t length, other, divisor;
    mpq_inits(length, other, divisor, NULL);
    mpq_set_d(other, b);
    mpq_set_d(divisor, c);
    mpq_div(other, other, divisor);
    mpq_set_d(length, a);
    mpq_add(length, length, other);
    int sign = distance_sign(kind, x, length);
    mpq_clears(length, other, divisor, NULL);
    return sign;
}

bool points_within(const double a[3], const double b[3], double length) {
    rational_vector apart;
    mpq_t squared, other;
    vector_init(&apart);
    mpq_inits(squared, other, NULL);
    vector_between(a, b, &apart);
    vector_dot(&apart, &apart, squared);
    mpq_set_d(other, length);
    mpq_mul(other, other, other);
    bool within = mpq_cmp(squared, other) <= 0;
    vector_clear(&apart);
    mpq_clears(squared, other, NULL);
    return within;
}
