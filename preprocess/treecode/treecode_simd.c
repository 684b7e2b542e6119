/* The kernels of the treecode: eight expansions at a time, and eight targets. */
#include "preprocess/treecode/source_tree.h"

#include "src/core/simd.h"

/* ---- far field ----------------------------------------------------------------------------------------- */

/* Derivatives of 1 / r up to the order, but those with a z exponent above 2, which no product has. */
static void list_tensors(const expansion_tables *t, uint32_t order, const f64x8 r[3],
                         f64x8 tensors[FULL_COUNT]) {
    const f64x8 inverse = f64x8_all(1.0) / (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    tensors[0] = f64x8_sqrt(inverse);
    for (int i = 1; i < t->full_end[order]; i++) {
        if (t->exponents[i][2] > 2) continue;
        if (t->exponents[i][2] == 2) {
            tensors[i] = -tensors[t->folds[i][0]] - tensors[t->folds[i][1]];
            continue;
        }
        const tensor_step *step = &t->tensor_steps[i];
        f64x8 sum = f64x8_all(0.0);
        for (int k = 0; k < 3; k++) sum += f64x8_all(step->first_factors[k]) * r[k] * tensors[step->first[k]];
        for (int k = 0; k < 2; k++) sum += f64x8_all(step->second_factors[k]) * tensors[step->second[k]];
        tensors[i] = sum * inverse;
    }
}

/* Adds eight items; those beyond the last have no moments. */
static void add_items(const far_field *field, const far_item *items, size_t count, const double center[3],
                      f64x8 sums[HARMONIC_COUNT]) {
    const expansion_tables *t = field->tables;
    const uint32_t order = items[count - 1] >> FAR_NODE_BITS; /* they are sorted by it */
    f64x8 r[3], moments[HARMONIC_COUNT], tensors[FULL_COUNT];
    for (size_t i = 0; i < LANES; i++) {
        const uint32_t node = items[i < count ? i : 0] & ((1u << FAR_NODE_BITS) - 1);
        const double *from = field->moments + (size_t)node * HARMONIC_COUNT;
        for (int k = 0; k < 3; k++) r[k][i] = center[k] - field->nodes[node].center[k];
        for (int m = 0; m < t->harmonic_end[order]; m++) moments[m][i] = i < count ? from[m] : 0.0;
    }
    list_tensors(t, order, r, tensors);
    for (int l = 0; l < t->harmonic_end[order]; l++) {
        f64x8 sum = sums[l];
        for (uint32_t p = t->products[order][l]; p < t->products[order][l + 1]; p++)
            sum += moments[t->product_moments[p]] * tensors[t->product_tensors[p]];
        sums[l] = sum;
    }
}

static void add_far_field(const far_field *field, const double center[3],
                          double coefficients[HARMONIC_COUNT]) {
    f64x8 sums[HARMONIC_COUNT];
    for (int l = 0; l < HARMONIC_COUNT; l++) sums[l] = f64x8_all(0.0);
    for (size_t i = 0; i < field->item_count; i += LANES) {
        const size_t left = field->item_count - i;
        add_items(field, field->items + i, left < LANES ? left : LANES, center, sums);
    }
    for (int l = 0; l < HARMONIC_COUNT; l++) {
        const f64x8 s = sums[l];
        coefficients[l] += ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]));
    }
}

/* ---- near field ---------------------------------------------------------------------------------------- */

/* Sums of floats move into those of doubles after this number of terms. */
enum { TERMS_IN_FLOAT = 64 };

static void move_sums(f32x8 sums[LEAF_VECTORS], f64x8 totals[LEAF_VECTORS]) {
    for (int v = 0; v < LEAF_VECTORS; v++) {
        totals[v] += f64x8_from(sums[v]);
        sums[v] = f32x8_all(0.0f);
    }
}

static void add_exact(const near_field *field, f32x8 sums[LEAF_VECTORS], f64x8 totals[LEAF_VECTORS]) {
    const float *potentials = field->potentials;
    for (size_t i = 0; i < field->exact_count; i++) {
        const f32x8 charge = f32x8_all((float)field->charges[field->exact[i]]);
        for (uint32_t v = 0; v < field->vector_count; v++, potentials += LANES)
            sums[v] += charge * f32x8_load(potentials);
        if (i % TERMS_IN_FLOAT == TERMS_IN_FLOAT - 1) move_sums(sums, totals);
    }
    move_sums(sums, totals);
}

static void add_points(const near_field *field, f32x8 sums[LEAF_VECTORS], f64x8 totals[LEAF_VECTORS]) {
    for (size_t i = 0; i < field->point_count; i++) {
        const tree_source *source = &field->sources[field->points[i]];
        const f32x8 charge = f32x8_all((float)(field->charges[field->points[i]] / SOURCE_POINTS));
        for (int p = 0; p < SOURCE_POINTS; p++) {
            const f32x8 px = f32x8_all((float)(source->points[p][0] - field->center[0]));
            const f32x8 py = f32x8_all((float)(source->points[p][1] - field->center[1]));
            const f32x8 pz = f32x8_all((float)(source->points[p][2] - field->center[2]));
            for (uint32_t v = 0; v < field->vector_count; v++) {
                const f32x8 dx = f32x8_load(field->x + v * LANES) - px,
                            dy = f32x8_load(field->y + v * LANES) - py,
                            dz = f32x8_load(field->z + v * LANES) - pz;
                sums[v] += charge / f32x8_sqrt(dx * dx + dy * dy + dz * dz);
            }
        }
        if (i % TERMS_IN_FLOAT == TERMS_IN_FLOAT - 1) move_sums(sums, totals);
    }
    move_sums(sums, totals);
}

static void near_potential(const near_field *field, double potentials[SOURCES_PER_LEAF]) {
    f32x8 sums[LEAF_VECTORS];
    f64x8 totals[LEAF_VECTORS];
    for (int v = 0; v < LEAF_VECTORS; v++) {
        sums[v] = f32x8_all(0.0f);
        totals[v] = f64x8_all(0.0);
    }
    add_exact(field, sums, totals);
    add_points(field, sums, totals);
    memcpy(potentials, totals, sizeof totals);
}

const treecode_kernels SIMD_NAME(treecode_kernels) = {add_far_field, near_potential};
