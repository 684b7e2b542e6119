/* Tables of multi-indices, and what is done with expansions one by one. */
#include "preprocess/treecode/expansion.h"

#include <string.h>

/* ---- tables -------------------------------------------------------------------------------------------- */

/* The place of a multi-index among all: those of lower degree, those of this degree with less z, and those with less y. */
static uint8_t place_of(int x, int y, int z) {
    const int n = x + y + z;
    return (uint8_t)(n * (n + 1) * (n + 2) / 6 + z * (n + 1) - z * (z - 1) / 2 + y);
}

static void set_step(expansion_tables *t, int i) {
    const uint8_t *a = t->exponents[i];
    int axis = 0, parent[3] = {a[0], a[1], a[2]};
    while (parent[axis] == 0) axis++;
    parent[axis]--;
    t->steps[i] = (index_step){place_of(parent[0], parent[1], parent[2]), (uint8_t)axis, 1.0 / a[axis]};
}

/* n r^2 D_a = -(2n - 1) sum of a_k r_k D_(a-k) - (n - 1) sum of a_k (a_k - 1) D_(a-2k), for the degree n of a. */
static void set_tensor_step(expansion_tables *t, int i) {
    const uint8_t *a = t->exponents[i];
    const double n = a[0] + a[1] + a[2];
    tensor_step step = {{0, 0, 0}, {0, 0}, {0.0, 0.0, 0.0}, {0.0, 0.0}};
    for (int k = 0; k < 3; k++) {
        int less[3] = {a[0], a[1], a[2]};
        less[k]--;
        if (a[k] < 1) continue;
        step.first[k] = place_of(less[0], less[1], less[2]);
        step.first_factors[k] = -(2.0 * n - 1.0) / n * a[k];
        less[k]--;
        if (a[k] < 2 || k == 2) continue; /* z of 2 or more is not computed so */
        step.second[k] = place_of(less[0], less[1], less[2]);
        step.second_factors[k] = -(n - 1.0) / n * a[k] * (a[k] - 1.0);
    }
    t->tensor_steps[i] = step;
}

static void list_indices(expansion_tables *t) {
    int full = 0, harmonic = 0;
    for (int n = 0; n <= EXPANSION_ORDER; n++) {
        for (int z = 0; z <= n; z++) {
            for (int y = 0; y <= n - z; y++, full++) {
                const int x = n - z - y;
                const uint8_t exponents[3] = {(uint8_t)x, (uint8_t)y, (uint8_t)z};
                memcpy(t->exponents[full], exponents, sizeof exponents);
                if (z < 2) t->harmonic[harmonic++] = (uint8_t)full;
                if (full > 0) set_step(t, full);
                if (full > 0 && z < 2) set_tensor_step(t, full);
                t->folds[full][0] = z < 2 ? 0 : place_of(x + 2, y, z - 2);
                t->folds[full][1] = z < 2 ? 0 : place_of(x, y + 2, z - 2);
            }
        }
        t->full_end[n] = (uint8_t)full;
        t->harmonic_end[n] = (uint8_t)harmonic;
    }
}

static int degree_of(const uint8_t exponents[3]) {
    return exponents[0] + exponents[1] + exponents[2];
}

static void list_shifts(expansion_tables *t) {
    int count = 0;
    for (uint8_t h = 0; h < HARMONIC_COUNT; h++) {
        const uint8_t *a = t->exponents[t->harmonic[h]];
        for (uint8_t i = 0; i < t->full_end[EXPANSION_ORDER - degree_of(a)]; i++) {
            const uint8_t *b = t->exponents[i];
            t->shifts[count++] = (index_sum){h, i, place_of(a[0] + b[0], a[1] + b[1], a[2] + b[2])};
        }
    }
}

static void list_products(expansion_tables *t) {
    uint16_t count = 0;
    for (int order = 0; order <= EXPANSION_ORDER; order++) {
        for (int l = 0; l < HARMONIC_COUNT; l++) {
            const uint8_t *b = t->exponents[t->harmonic[l]];
            const int left = order - degree_of(b);
            t->products[order][l] = count;
            for (uint8_t m = 0; left >= 0 && m < t->harmonic_end[left]; m++) {
                const uint8_t *a = t->exponents[t->harmonic[m]];
                t->product_moments[count] = m;
                t->product_tensors[count++] = place_of(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
            }
        }
        t->products[order][HARMONIC_COUNT] = count;
    }
}

void expansion_tables_set(expansion_tables *tables) {
    memset(tables, 0, sizeof *tables);
    list_indices(tables);
    list_shifts(tables);
    list_products(tables);
}

/* ---- one expansion ------------------------------------------------------------------------------------- */

/* powers[i] = v^i / i! */
static void list_powers(const expansion_tables *t, const double v[3], double powers[FULL_COUNT]) {
    powers[0] = 1.0;
    for (int i = 1; i < FULL_COUNT; i++) {
        const index_step *step = &t->steps[i];
        powers[i] = powers[step->parent] * v[step->axis] * step->factor;
    }
}

void expansion_add_charge(const expansion_tables *tables, const double place[3], double charge,
                          double *full) {
    const double from_place[3] = {-place[0], -place[1], -place[2]};
    double powers[FULL_COUNT];
    list_powers(tables, from_place, powers);
    for (int i = 0; i < FULL_COUNT; i++) full[i] += charge * powers[i];
}

void expansion_add_moments(const expansion_tables *tables, const double place[3], const double *moments,
                           double *full) {
    const double from_place[3] = {-place[0], -place[1], -place[2]};
    double powers[FULL_COUNT];
    list_powers(tables, from_place, powers);
    for (int i = 0; i < SHIFT_COUNT; i++) {
        const index_sum *sum = &tables->shifts[i];
        full[sum->out] += moments[sum->harmonic] * powers[sum->other];
    }
}

void expansion_fold(const expansion_tables *tables, double *full, double *harmonic) {
    for (int i = FULL_COUNT - 1; i > 0; i--) {
        if (tables->exponents[i][2] < 2) continue;
        full[tables->folds[i][0]] -= full[i];
        full[tables->folds[i][1]] -= full[i];
    }
    for (int i = 0; i < HARMONIC_COUNT; i++) harmonic[i] = full[tables->harmonic[i]];
}

void expansion_unfold(const expansion_tables *tables, const double *harmonic, double *full) {
    for (int i = 0; i < HARMONIC_COUNT; i++) full[tables->harmonic[i]] = harmonic[i];
    for (int i = 0; i < FULL_COUNT; i++)
        if (tables->exponents[i][2] >= 2) full[i] = -full[tables->folds[i][0]] - full[tables->folds[i][1]];
}

void expansion_add_coefficients(const expansion_tables *tables, const double place[3],
                                const double *coefficients, double *shifted) {
    double powers[FULL_COUNT], full[FULL_COUNT];
    list_powers(tables, place, powers);
    expansion_unfold(tables, coefficients, full);
    for (int i = 0; i < SHIFT_COUNT; i++) {
        const index_sum *sum = &tables->shifts[i];
        shifted[sum->harmonic] += full[sum->out] * powers[sum->other];
    }
}

double expansion_potential(const expansion_tables *tables, const double place[3], const double *full) {
    double powers[FULL_COUNT], potential = 0.0;
    list_powers(tables, place, powers);
    for (int i = 0; i < FULL_COUNT; i++) potential += full[i] * powers[i];
    return potential;
}
