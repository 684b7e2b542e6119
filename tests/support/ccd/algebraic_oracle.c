/* An exact answer to the elementary tests, by algebraic numbers, which shares nothing with the product; and
 * comparisons with it. */
#include "tests/support/ccd/algebraic_oracle.h"

#include <arb.h>
#include <arb_fmpz_poly.h>
#include <assert.h>
#include <flint/flint.h>
#include <flint/fmpz_poly.h>
#include <flint/fmpz_poly_factor.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Moments of [0,1] at which an integer polynomial in t vanishes: rational, or algebraic of degree 2 and more. */

enum { MOMENT_MAX = 24 };

/* The only root in [0,1] of a linear factor, num / den; or the only one of an irreducible factor of higher
 * degree in ((num, num + 1) / 2^depth), where local(x) = 2^(depth degree) factor((num + x) / 2^depth). */
typedef struct algebraic_moment {
    fmpz_poly_t factor, local;
    fmpz_t num, den;
    slong depth;
    arb_t root;
} algebraic_moment;

typedef struct moment_list {
    algebraic_moment items[MOMENT_MAX];
    slong count;
} moment_list;

enum { FIRST_PRECISION = 96, BISECTIONS = 4 };

static void moments_init(moment_list *list) {
    list->count = 0;
}

static void moments_clear(moment_list *list) {
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

static void moments_add_rational(moment_list *list, slong num, slong den) {
    algebraic_moment *m = append_moment(list);
    fmpz_set_si(m->num, num);
    fmpz_set_si(m->den, den);
}

static bool moment_is_rational(const algebraic_moment *m) {
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

/* All roots of p in [0,1], each once; p is not 0. */
static void moments_add_roots(moment_list *list, const fmpz_poly_struct *p) {
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

/* Exact: -1, 0, 1. */
static int moment_sign(algebraic_moment *m, const fmpz_poly_struct *p) {
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

/* Adjacent doubles about it, or twice the moment itself. */
static void moment_bounds(algebraic_moment *m, double *low, double *high) {
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

/* ---- the oracle ---------------------------------------------------------------------------------------- */

typedef struct gram {
    int count; /* of differences: 3 or 4 */
    fmpz_poly_t at[4][4];
    fmpz_poly_t det;   /* of the first three */
    fmpz_poly_t slope; /* of the root of det */
    fmpz_poly_t product, entry;
} gram;

/* ---- set-up ---- */

/* A coordinate axis along which one feature stays behind the other. */
static bool apart_along(cscd_contact_kind kind, const double x[4][3], int k, int direction) {
    int first = points_of_first(kind);
    for (int i = 0; i < first; i++)
        for (int j = first; j < 4; j++)
            if (!(direction > 0 ? x[i][k] < x[j][k] : x[i][k] > x[j][k])) return false;
    return true;
}

static bool apart_throughout(cscd_contact_kind kind, const elementary_query *query) {
    for (int k = 0; k < 3; k++)
        for (int direction = -1; direction <= 1; direction += 2)
            if (apart_along(kind, query->x0, k, direction) && apart_along(kind, query->x1, k, direction))
                return true;
    return false;
}

/* value = mantissa 2^exponent, mantissa odd or 0 */
static int64_t odd_part(double value, int *exponent) {
    int64_t mantissa = (int64_t)ldexp(frexp(value, exponent), 53);
    *exponent -= 53;
    if (mantissa == 0) return 0;
    int zeros = __builtin_ctzll((uint64_t)mantissa);
    *exponent += zeros;
    return mantissa / ((int64_t)1 << zeros);
}

/* Coordinate k of the four points as start and change, times a power of two that makes them integers.
 * Touching does not depend on the units of the axes. */
static void integer_axis(const elementary_query *query, int k, fmpz_t start[4], fmpz_t change[4]) {
    int exponents[8], smallest = INT32_MAX;
    int64_t mantissas[8];
    for (int i = 0; i < 8; i++) {
        mantissas[i] = odd_part(i < 4 ? query->x0[i][k] : query->x1[i - 4][k], &exponents[i]);
        if (mantissas[i] != 0 && exponents[i] < smallest) smallest = exponents[i];
    }
    for (int i = 0; i < 8; i++) {
        fmpz *out = i < 4 ? start[i] : change[i - 4];
        fmpz_set_si(out, mantissas[i]);
        if (mantissas[i] != 0) fmpz_mul_2exp(out, out, (ulong)(exponents[i] - smallest));
    }
    for (int i = 0; i < 4; i++) fmpz_sub(change[i], change[i], start[i]);
}

/* ends[n]: the points of which difference n is taken */
static int difference_ends(cscd_contact_kind kind, int ends[4][2]) {
    for (int n = 0; n < 4; n++) {
        ends[n][0] = kind == CSCD_CONTACT_VF ? 0 : n / 2;
        ends[n][1] = kind == CSCD_CONTACT_VF ? n % 3 + 1 : n % 2 + 2;
    }
    return kind == CSCD_CONTACT_VF ? 3 : 4;
}

/* Adds the products of the differences' coordinates k, each start + change t. */
static void add_axis(gram *g, const int ends[4][2], fmpz_t start[4], fmpz_t change[4]) {
    fmpz_t a[4], b[4];
    for (int n = 0; n < g->count; n++) {
        fmpz_init(a[n]);
        fmpz_init(b[n]);
        fmpz_sub(a[n], start[ends[n][1]], start[ends[n][0]]);
        fmpz_sub(b[n], change[ends[n][1]], change[ends[n][0]]);
    }
    for (int i = 0; i < g->count; i++) {
        for (int j = i; j < g->count; j++) {
            fmpz *c = g->at[i][j]->coeffs;
            fmpz_addmul(c, a[i], a[j]);
            fmpz_addmul(c + 1, a[i], b[j]);
            fmpz_addmul(c + 1, b[i], a[j]);
            fmpz_addmul(c + 2, b[i], b[j]);
        }
    }
    for (int n = 0; n < g->count; n++) {
        fmpz_clear(a[n]);
        fmpz_clear(b[n]);
    }
}

static void gram_init(gram *g, cscd_contact_kind kind, const elementary_query *query) {
    fmpz_t start[4], change[4];
    int ends[4][2];
    g->count = difference_ends(kind, ends);
    for (int i = 0; i < 4; i++) {
        fmpz_init(start[i]);
        fmpz_init(change[i]);
        for (int j = i; j < g->count; j++) {
            fmpz_poly_init2(g->at[i][j], 3);
            _fmpz_poly_set_length(g->at[i][j], 3);
        }
    }
    for (int k = 0; k < 3; k++) {
        integer_axis(query, k, start, change);
        add_axis(g, ends, start, change);
    }
    for (int i = 0; i < 4; i++) {
        fmpz_clear(start[i]);
        fmpz_clear(change[i]);
        for (int j = i; j < g->count; j++) _fmpz_poly_normalise(g->at[i][j]);
    }
    fmpz_poly_init(g->det);
    fmpz_poly_init(g->slope);
    fmpz_poly_init(g->product);
    fmpz_poly_init(g->entry);
}

static void gram_clear(gram *g) {
    for (int i = 0; i < g->count; i++)
        for (int j = i; j < g->count; j++) fmpz_poly_clear(g->at[i][j]);
    fmpz_poly_clear(g->det);
    fmpz_poly_clear(g->slope);
    fmpz_poly_clear(g->product);
    fmpz_poly_clear(g->entry);
}

/* ---- minors; each lies in entry until the next one ---- */

static const fmpz_poly_struct *gram_entry(const gram *g, int i, int j) {
    return i <= j ? g->at[i][j] : g->at[j][i];
}

/* g_ik g_jl - g_il g_jk: rows i, j, columns k, l */
static const fmpz_poly_struct *gram_minor(gram *g, int i, int j, int k, int l) {
    fmpz_poly_mul(g->entry, gram_entry(g, i, k), gram_entry(g, j, l));
    fmpz_poly_mul(g->product, gram_entry(g, i, l), gram_entry(g, j, k));
    fmpz_poly_sub(g->entry, g->entry, g->product);
    return g->entry;
}

/* Entry (i, column n) of the adjugate of rows and columns i, j, k. */
static const fmpz_poly_struct *adjugate_entry(gram *g, int i, int j, int k, int n) {
    if (n == 0) return gram_minor(g, j, k, j, k);
    return n == 1 ? gram_minor(g, j, k, k, i) : gram_minor(g, j, k, i, j);
}

static void find_det(gram *g) {
    fmpz_poly_t term;
    fmpz_poly_init(term);
    for (int n = 0; n < 3; n++) {
        fmpz_poly_mul(term, adjugate_entry(g, 0, 1, 2, n), gram_entry(g, 0, n));
        fmpz_poly_add(g->det, g->det, term);
    }
    fmpz_poly_clear(term);
}

/* ---- a moment ---- */

static bool pair_combines(gram *g, algebraic_moment *m, int i, int j) {
    return moment_sign(m, gram_entry(g, i, j)) < 0 && moment_sign(m, gram_minor(g, i, j, i, j)) == 0;
}

/* Where det = 0. */
static bool triple_combines(gram *g, algebraic_moment *m, int i, int j, int k) {
    for (int n = 2; n >= 0; n--)
        if (moment_sign(m, adjugate_entry(g, i, j, k, n)) <= 0) return false;
    return true;
}

static bool touching_at(gram *g, algebraic_moment *m) {
    if (moment_sign(m, g->det) != 0) return false;
    for (int i = 0; i < g->count; i++)
        if (moment_sign(m, gram_entry(g, i, i)) == 0) return true;
    for (int i = 0; i < g->count; i++)
        for (int j = i + 1; j < g->count; j++)
            if (pair_combines(g, m, i, j)) return true;
    for (int i = 0; i < g->count; i++)
        for (int j = i + 1; j < g->count; j++)
            for (int k = j + 1; k < g->count; k++)
                if (triple_combines(g, m, i, j, k)) return true;
    return false;
}

/* ---- candidates ---- */

/* p is nowhere negative. */
static void add_multiple_roots(moment_list *list, const fmpz_poly_struct *p) {
    if (fmpz_poly_is_zero(p)) return;
    fmpz_poly_t common;
    fmpz_poly_init(common);
    fmpz_poly_derivative(common, p);
    fmpz_poly_gcd(common, common, p);
    moments_add_roots(list, common);
    fmpz_poly_clear(common);
}

static void add_roots_of_det(gram *g, moment_list *list) {
    fmpz_poly_t root;
    fmpz_poly_init(root);
    if (!fmpz_poly_sqrt(root, g->det)) abort();
    moments_add_roots(list, root);
    fmpz_poly_derivative(g->slope, root);
    fmpz_poly_clear(root);
}

/* From 0 on; the moment 0 itself aside. */
static void add_candidates(gram *g, moment_list *list) {
    if (!fmpz_poly_is_zero(g->det)) {
        add_roots_of_det(g, list);
        return;
    }
    for (int i = 0; i < g->count; i++) {
        add_multiple_roots(list, gram_entry(g, i, i));
        for (int j = i + 1; j < g->count; j++) add_multiple_roots(list, gram_minor(g, i, j, i, j));
    }
}

static const oracle_verdict never = {.touching = false, .toi_low = 2.0, .toi_high = 2.0};

static oracle_verdict first_touch(gram *g, moment_list *list) {
    oracle_verdict verdict = never;
    for (slong i = 0; i < list->count; i++) {
        algebraic_moment *m = &list->items[i];
        double low, high;
        moment_bounds(m, &low, &high);
        if (low >= verdict.toi_high || !touching_at(g, m)) continue;
        verdict.touching = true;
        verdict.simple = moment_sign(m, g->slope) != 0;
        verdict.toi_low = fmin(low, verdict.toi_low);
        verdict.toi_high = fmin(high, verdict.toi_high);
    }
    return verdict;
}

oracle_verdict algebraic_oracle(cscd_contact_kind kind, const elementary_query *query) {
    if (apart_throughout(kind, query)) return never;
    gram g;
    moment_list list;
    gram_init(&g, kind, query);
    moments_init(&list);
    find_det(&g);
    moments_add_rational(&list, 0, 1);
    oracle_verdict verdict = first_touch(&g, &list);
    if (!verdict.touching) {
        add_candidates(&g, &list);
        verdict = first_touch(&g, &list);
    }
    moments_clear(&list);
    gram_clear(&g);
    return verdict;
}

void algebraic_oracle_finish(void) {
    flint_cleanup();
}

/* ---- comparisons --------------------------------------------------------------------------------------- */

#define EARLY 1e-9

static comparison judge_answer(const compared *c) {
    if (c->touching != c->oracle.touching) return c->oracle.touching ? COMPARISON_MISSED : COMPARISON_FALSE;
    if (!c->oracle.touching) return COMPARISON_AGREES;
    if (!(c->hit.toi <= c->oracle.toi_high)) return COMPARISON_TOO_LATE;
    return c->hit.toi >= c->oracle.toi_low - EARLY ? COMPARISON_AGREES : COMPARISON_TOO_EARLY;
}

void compare_all_with_oracle(cscd_contact_kind kind, const elementary_query *queries, size_t count,
                             compared *out) {
    query_answer *answers = malloc((count + 1) * sizeof *answers);
    if (answers == NULL) abort();
    pair_test_all(kind, queries, count, answers);
    for (size_t i = 0; i < count; i++) {
        out[i] = (compared){.oracle = algebraic_oracle(kind, &queries[i]), .touching = answers[i].touching};
        out[i].hit = answers[i].hit;
        if (!answers[i].touching) out[i].hit.toi = 2.0;
        out[i].result = judge_answer(&out[i]);
    }
    free(answers);
}

compared compare_with_oracle(cscd_contact_kind kind, const elementary_query *query) {
    compared c;
    compare_all_with_oracle(kind, query, 1, &c);
    return c;
}

static void print_points(const double x[4][3]) {
    for (int i = 0; i < 4; i++) printf("%s{%a, %a, %a}", i == 0 ? "{" : ",\n  ", x[i][0], x[i][1], x[i][2]);
}

void print_compared(cscd_contact_kind kind, const elementary_query *query, const compared *c) {
    static const char *const words[] = {"agrees", "missed contact", "false contact", "toi too late",
                                        "toi too early"};
    elementary_contact unused;
    printf("/* %s, %s: toi %a (2: never), exactly %a .. %a, level %d */\n",
           kind == CSCD_CONTACT_VF ? "vf" : "ee", words[c->result], c->hit.toi, c->oracle.toi_low,
           c->oracle.toi_high, (int)pair_test(kind, query, &unused).level);
    printf("{");
    print_points(query->x0);
    printf("},\n ");
    print_points(query->x1);
    printf("}},\n");
}
