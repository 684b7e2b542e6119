/* Moments of [0,1] at which an integer polynomial in t vanishes: isolated by factorisation over the rationals
 * and Descartes' rule of signs, refined by interval Newton steps; exact signs of other polynomials there. */
#include "tests/support/ccd/algebraic_moment.h"

#include <arb_fmpz_poly.h>
#include <assert.h>
#include <flint/fmpz_poly_factor.h>
#include <math.h>
#include <stdlib.h>

enum { FIRST_PRECISION = 96, BISECTIONS = 4 };

void moments_init(moment_list *list) {
    list->count = 0;
}

void moments_clear(moment_list *list) {
    for (slong i = 0; i < list->count; i++) {
        algebraic_moment *m = &list->items[i];
        fmpz_poly_clear(m->factor);
        fmpz_poly_clear(m->local);
        fmpz_clear(m->num);
        fmpz_clear(m->den);
        arb_clear(m->root);
    }
    list->count = 0;
}

static algebraic_moment *append_moment(moment_list *list) {
    if (list->count == MOMENT_MAX) abort();
    algebraic_moment *m = &list->items[list->count++];
    fmpz_poly_init(m->factor);
    fmpz_poly_init(m->local);
    fmpz_init(m->num);
    fmpz_init_set_ui(m->den, 1);
    arb_init(m->root);
    m->depth = 0;
    return m;
}

void moments_add_rational(moment_list *list, slong num, slong den) {
    algebraic_moment *m = append_moment(list);
    fmpz_set_si(m->num, num);
    fmpz_set_si(m->den, den);
}

bool moment_is_rational(const algebraic_moment *m) {
    return fmpz_poly_is_zero(m->factor);
}

/* ---- isolation ---- */

static slong sign_changes(const fmpz_poly_struct *p) {
    slong changes = 0;
    int last = 0;
    for (slong i = 0; i < fmpz_poly_length(p); i++) {
        int sign = fmpz_sgn(p->coeffs + i);
        changes += sign != 0 && last != 0 && sign != last;
        last = sign != 0 ? sign : last;
    }
    return changes;
}

static void shift_by_one(fmpz_poly_struct *p) {
    for (slong i = 0; i + 1 < p->length; i++)
        for (slong j = p->length - 2; j >= i; j--) fmpz_add(p->coeffs + j, p->coeffs + j, p->coeffs + j + 1);
}

/* At most, and modulo 2, the number of roots in the open interval (0,1): Descartes' rule for
 * (1 + x)^n p(1 / (1 + x)). */
static slong descartes_bound(const fmpz_poly_struct *p) {
    fmpz_poly_t q;
    fmpz_poly_init(q);
    fmpz_poly_reverse(q, p, p->length);
    shift_by_one(q);
    slong bound = sign_changes(q);
    fmpz_poly_clear(q);
    return bound;
}

/* p(x / 2), times 2^degree */
static void stretch_roots(fmpz_poly_struct *p) {
    slong degree = fmpz_poly_degree(p);
    for (slong i = 0; i < degree; i++) fmpz_mul_2exp(p->coeffs + i, p->coeffs + i, (ulong)(degree - i));
}

/* No end of any interval met here is a root: the factor is irreducible and not linear. */
static void isolate_roots(moment_list *list, const fmpz_poly_struct *factor, const fmpz_poly_struct *local,
                          const fmpz_t num, slong depth) {
    slong bound = descartes_bound(local);
    if (bound == 1) {
        algebraic_moment *m = append_moment(list);
        fmpz_poly_set(m->factor, factor);
        fmpz_poly_set(m->local, local);
        fmpz_set(m->num, num);
        m->depth = depth;
    }
    if (bound <= 1) return;
    fmpz_poly_t half;
    fmpz_t half_num;
    fmpz_init(half_num);
    fmpz_poly_init(half);
    fmpz_poly_set(half, local);
    stretch_roots(half);
    fmpz_mul_2exp(half_num, num, 1);
    isolate_roots(list, factor, half, half_num, depth + 1);
    shift_by_one(half);
    fmpz_add_ui(half_num, half_num, 1);
    isolate_roots(list, factor, half, half_num, depth + 1);
    fmpz_poly_clear(half);
    fmpz_clear(half_num);
}

/* Of a + b t, where it lies in [0,1]. */
static void add_linear(moment_list *list, const fmpz_poly_struct *p) {
    const fmpz *a = p->coeffs, *b = p->coeffs + 1;
    if (fmpz_sgn(a) * fmpz_sgn(b) > 0 || fmpz_cmpabs(a, b) > 0) return;
    algebraic_moment *m = append_moment(list);
    fmpz_abs(m->num, a);
    fmpz_abs(m->den, b);
}

static void add_roots_of_factor(moment_list *list, const fmpz_poly_struct *factor) {
    if (fmpz_poly_degree(factor) == 1) {
        add_linear(list, factor);
        return;
    }
    fmpz_t zero;
    fmpz_init(zero);
    isolate_roots(list, factor, factor, zero, 0);
    fmpz_clear(zero);
}

static bool vanishes_at_end(const fmpz_poly_struct *p) {
    fmpz_t sum;
    fmpz_init(sum);
    for (slong i = 0; i < p->length; i++) fmpz_add(sum, sum, p->coeffs + i);
    bool vanishes = fmpz_is_zero(p->coeffs) || fmpz_is_zero(sum);
    fmpz_clear(sum);
    return vanishes;
}

void moments_add_roots(moment_list *list, const fmpz_poly_struct *p) {
    assert(!fmpz_poly_is_zero(p));
    if (fmpz_poly_degree(p) == 0 || (descartes_bound(p) == 0 && !vanishes_at_end(p))) return;
    fmpz_poly_factor_t factors;
    fmpz_poly_factor_init(factors);
    fmpz_poly_factor(factors, p);
    for (slong i = 0; i < factors->num; i++) add_roots_of_factor(list, factors->p + i);
    fmpz_poly_factor_clear(factors);
}

/* ---- refinement ---- */

static void bisect_interval(algebraic_moment *m) {
    fmpz_t middle;
    fmpz_init(middle);
    int start = fmpz_sgn(m->local->coeffs);
    stretch_roots(m->local);
    for (slong i = 0; i < m->local->length; i++) fmpz_add(middle, middle, m->local->coeffs + i);
    m->depth++;
    fmpz_mul_2exp(m->num, m->num, 1);
    if (fmpz_sgn(middle) == start) {
        fmpz_add_ui(m->num, m->num, 1);
        shift_by_one(m->local);
    }
    fmpz_clear(middle);
}

static void enclose_root(algebraic_moment *m) {
    arb_set_fmpz(m->root, m->num);
    arb_mul_2exp_si(m->root, m->root, 1);
    arb_add_ui(m->root, m->root, 1, ARF_PREC_EXACT);
    arb_add_error_2exp_si(m->root, 0);
    arb_mul_2exp_si(m->root, m->root, -m->depth - 1);
}

/* Newton steps from the enclosure, as long as they help. The derivative has no root in the enclosure, so the
 * enclosure has no other root. */
static void newton_steps(algebraic_moment *m, const fmpz_poly_struct *derivative, slong precision) {
    arb_t slope, value, middle;
    arb_init(slope);
    arb_init(value);
    arb_init(middle);
    for (slong last = -ARF_PREC_EXACT, now; (now = arb_rel_accuracy_bits(m->root)) < precision; last = now) {
        if (now <= last) break;
        arb_fmpz_poly_evaluate_arb(slope, derivative, m->root, precision + 30);
        if (arb_contains_zero(slope)) break;
        arb_get_mid_arb(middle, m->root);
        arb_fmpz_poly_evaluate_arb(value, m->factor, middle, 3 * precision);
        arb_div(value, value, slope, precision + 30);
        arb_sub(m->root, middle, value, precision + 30);
    }
    arb_clear(slope);
    arb_clear(value);
    arb_clear(middle);
}

static void refine_root(algebraic_moment *m, slong precision) {
    if (arb_is_positive(m->root) && arb_rel_accuracy_bits(m->root) >= precision) return;
    fmpz_poly_t derivative;
    fmpz_poly_init(derivative);
    fmpz_poly_derivative(derivative, m->factor);
    do {
        for (int i = 0; i < BISECTIONS; i++) bisect_interval(m);
        enclose_root(m);
        newton_steps(m, derivative, precision);
    } while (arb_rel_accuracy_bits(m->root) < precision);
    fmpz_poly_clear(derivative);
}

/* ---- questions ---- */

/* The sign of den^n p(num / den). */
static int sign_at_rational(const algebraic_moment *m, const fmpz_poly_struct *p) {
    slong degree = fmpz_poly_degree(p);
    fmpz_t value, power;
    fmpz_init(value);
    fmpz_init_set_ui(power, 1);
    for (slong i = degree; i >= 0; i--) {
        fmpz_mul(value, value, m->num);
        fmpz_addmul(value, power, p->coeffs + i);
        fmpz_mul(power, power, m->den);
    }
    int sign = fmpz_sgn(value);
    fmpz_clear(value);
    fmpz_clear(power);
    return sign;
}

/* In the field Q[t] / factor. */
static bool is_zero_at(const algebraic_moment *m, const fmpz_poly_struct *p) {
    fmpz_poly_t remainder;
    ulong power;
    fmpz_poly_init(remainder);
    fmpz_poly_pseudo_rem(remainder, &power, p, m->factor);
    bool zero = fmpz_poly_is_zero(remainder);
    fmpz_poly_clear(remainder);
    return zero;
}

int moment_sign(algebraic_moment *m, const fmpz_poly_struct *p) {
    if (fmpz_poly_is_zero(p)) return 0;
    if (moment_is_rational(m)) return sign_at_rational(m, p);
    arb_t value;
    arb_init(value);
    int sign = 0;
    for (slong precision = FIRST_PRECISION; sign == 0; precision *= 2) {
        refine_root(m, precision);
        arb_fmpz_poly_evaluate_arb(value, p, m->root, precision + 30);
        sign = arb_is_positive(value) - arb_is_negative(value);
        if (sign == 0 && precision == FIRST_PRECISION && is_zero_at(m, p)) break;
    }
    arb_clear(value);
    return sign;
}

static void rational_bounds(const algebraic_moment *m, double *low, double *high) {
    arf_t quotient;
    arf_init(quotient);
    arf_fmpz_div_fmpz(quotient, m->num, m->den, 53, ARF_RND_FLOOR);
    *low = arf_get_d(quotient, ARF_RND_FLOOR);
    arf_fmpz_div_fmpz(quotient, m->num, m->den, 53, ARF_RND_CEIL);
    *high = arf_get_d(quotient, ARF_RND_CEIL);
    arf_clear(quotient);
}

void moment_bounds(algebraic_moment *m, double *low, double *high) {
    if (moment_is_rational(m)) {
        rational_bounds(m, low, high);
        return;
    }
    arf_t bound;
    arf_init(bound);
    slong precision = FIRST_PRECISION;
    do {
        refine_root(m, precision);
        arb_get_lbound_arf(bound, m->root, precision + 30);
        *low = arf_get_d(bound, ARF_RND_FLOOR);
        arb_get_ubound_arf(bound, m->root, precision + 30);
        *high = arf_get_d(bound, ARF_RND_CEIL);
        precision *= 2;
    } while (nextafter(*low, 2.0) < *high);
    arf_clear(bound);
}
