/* The leading terms of all determinants of a few moved points. */
#include "tests/support/intersections/leading_terms.h"

#include <stdlib.h>
#include <string.h>

enum { DIFFERENCE_TERMS = 3, PRODUCT_TERMS = 6 * DIFFERENCE_TERMS * DIFFERENCE_TERMS * DIFFERENCE_TERMS };

/* A sum of terms in any order; a power may be there more than once. */
typedef struct term_sum {
    leading_term terms[PRODUCT_TERMS];
    int count;
} term_sum;

void leading_terms_clear(leading_terms *t) {
    memset(t, 0, sizeof *t);
}

/* What coordinate k of a point is less that of another one. */
static void difference_of(const leading_terms *t, uint32_t from, uint32_t to, int k,
                          leading_term out[DIFFERENCE_TERMS]) {
    out[0] = (leading_term){0, t->points[to][k] - t->points[from][k]};
    out[1] = (leading_term){UINT64_C(1) << (3 * to + (uint32_t)k), 1};
    out[2] = (leading_term){UINT64_C(1) << (3 * from + (uint32_t)k), -1};
}

static leading_term least_term(const term_sum *sum) {
    uint64_t above = 0; /* the least power that has not been looked at */
    for (;;) {
        leading_term least = {UINT64_MAX, 0};
        for (int i = 0; i < sum->count; i++) {
            const leading_term *term = &sum->terms[i];
            if (term->power < above || term->power > least.power) continue;
            if (term->power < least.power) least = (leading_term){term->power, 0};
            least.coefficient += term->coefficient;
        }
        if (least.power == UINT64_MAX) abort(); /* the polynomial is 0 */
        if (least.coefficient != 0) return least;
        above = least.power + 1;
    }
}

/* Adds the product of so many differences, of coordinate axes[i] of point to[i] and point from. */
static void add_products(const leading_terms *t, uint32_t from, const uint32_t *to, const int *axes,
                         int factors, int sign, term_sum *sum) {
    leading_term differences[3][DIFFERENCE_TERMS];
    int all = 1;
    for (int i = 0; i < factors; i++) {
        difference_of(t, from, to[i], axes[i], differences[i]);
        all *= DIFFERENCE_TERMS;
    }
    for (int choice = 0; choice < all; choice++) {
        leading_term product = {0, sign};
        for (int i = 0, rest = choice; i < factors; i++, rest /= DIFFERENCE_TERMS) {
            product.power += differences[i][rest % DIFFERENCE_TERMS].power;
            product.coefficient *= differences[i][rest % DIFFERENCE_TERMS].coefficient;
        }
        if (product.coefficient != 0) sum->terms[sum->count++] = product;
    }
}

static leading_term expand_spatial(const leading_terms *t, const uint32_t names[4]) {
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}, {1, 0, 2}, {0, 2, 1}};
    term_sum sum = {.count = 0};
    for (int i = 0; i < 6; i++) add_products(t, names[0], names + 1, orders[i], 3, i < 3 ? 1 : -1, &sum);
    return least_term(&sum);
}

static leading_term expand_flat(const leading_terms *t, const uint32_t names[3], int axis) {
    const int along[2][2] = {{(axis + 1) % 3, (axis + 2) % 3}, {(axis + 2) % 3, (axis + 1) % 3}};
    term_sum sum = {.count = 0};
    for (int i = 0; i < 2; i++) add_products(t, names[0], names + 1, along[i], 2, i == 0 ? 1 : -1, &sum);
    return least_term(&sum);
}

/* Sorts names; -1 if that is an odd number of exchanges, else 1. */
static int sort_names(uint32_t *names, int count) {
    int sign = 1;
    for (int i = 1; i < count; i++) {
        for (int j = i; j > 0 && names[j - 1] > names[j]; j--) {
            uint32_t swapped = names[j];
            names[j] = names[j - 1];
            names[j - 1] = swapped;
            sign = -sign;
        }
    }
    return sign;
}

/* Where sorted names stand among all of their number: the combinatorial number system. */
static uint32_t rank_of(const uint32_t *names, int count) {
    uint32_t rank = 0;
    for (int i = 0; i < count; i++) {
        uint32_t ways = 1; /* names[i] over i + 1 */
        for (uint32_t k = 0; k <= (uint32_t)i; k++) ways = ways * (names[i] - k) / (k + 1);
        if (names[i] >= (uint32_t)i + 1) rank += ways;
    }
    return rank;
}

leading_term leading_orient3d(leading_terms *t, const uint32_t names[4]) {
    uint32_t sorted[4] = {names[0], names[1], names[2], names[3]};
    int sign = sort_names(sorted, 4);
    leading_term *known = &t->spatial[rank_of(sorted, 4)];
    if (known->coefficient == 0) *known = expand_spatial(t, sorted);
    return (leading_term){known->power, sign * known->coefficient};
}

int leading_orient_along(leading_terms *t, const uint32_t names[3], int axis) {
    uint32_t sorted[3] = {names[0], names[1], names[2]};
    int sign = sort_names(sorted, 3);
    leading_term *known = &t->flat[axis][rank_of(sorted, 3)];
    if (known->coefficient == 0) *known = expand_flat(t, sorted, axis);
    return sign * leading_sign(*known);
}
