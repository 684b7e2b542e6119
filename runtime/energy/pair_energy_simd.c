/* Energies of as many pairs as the processor takes at once, with their gradients: the same operations in the same order as
 * energy_pair_evaluate, so the same bits.
 *
 * Pairs of all kinds go through one sequence. The signs of its weights say along which features a pair's nearest points slide; a slide
 * that it lacks is 0, and so is what depends on it. */
#include "runtime/energy/energy.h"
#include "src/core/simd_wide.h"

#include <assert.h>
#include <stddef.h>

/* Whole, so that a value alone has no part of a gradient. */
#define INLINED static inline __attribute__((always_inline))

static inline f64w dot_lanes(const f64w a[3], const f64w b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cross_lanes(const f64w a[3], const f64w b[3], f64w out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* ---- frames ------------------------------------------------------------------------------------------------- */

/* As pair_frame, with what else a law needs; tangents and slides that a pair lacks are 0. */
typedef struct frame_lanes {
    f64w points[4][3], sides[3][3]; /* from the first point to the others */
    f64w weights[4], normal[3], distance;
    f64w tangents[2][3], slides[2][4];  /* of any length */
    f64w factor, separation, threshold; /* the last is 0 except of two edges */
    uint32_t half_spaces;               /* a set of lanes */
    f64w squares[2], inverses[2];       /* of the lengths of tangents; 0 where there is none */
    uint32_t resting; /* the lanes whose points are in one place, of no normal that the positions say */
} frame_lanes;

/* The slides along an edge of a, and along an edge or a face of b, as those of pair_frame.c. */
static inline void name_slide_lanes(const f64w w[4], f64w slides[2][4]) {
    const f64w zero = f64w_all(0.0), one = f64w_all(1.0), minus = f64w_all(-1.0);
    const maskw edge_a = maskw_below(zero, w[0]) & maskw_below(zero, w[1]);
    const maskw on_1 = maskw_below(w[1], zero), on_2 = maskw_below(w[2], zero),
                on_3 = maskw_below(w[3], zero);
    const maskw along_12 = on_1 & on_2, along_13 = on_1 & on_3, along_23 = on_2 & on_3;
    const maskw face = along_12 & on_3, edge_b = edge_a & along_23;
    slides[0][0] = maskw_choose(edge_a, minus, zero);
    slides[0][1] = maskw_choose(edge_a | along_12 | along_13, one, zero);
    slides[0][2] =
        maskw_choose(edge_a, zero, maskw_choose(along_12, minus, maskw_choose(along_23 & ~on_1, one, zero)));
    slides[0][3] = maskw_choose(edge_a | along_12, zero, maskw_choose(along_13 | along_23, minus, zero));
    slides[1][0] = zero;
    slides[1][1] = maskw_choose(face, one, zero);
    slides[1][2] = maskw_choose(edge_b, one, zero);
    slides[1][3] = maskw_choose(face | edge_b, minus, zero);
}

/* The sum of amounts[i] times the i-th point, by the sides from the first point to the others. */
static inline void combine_sides(const f64w sides[3][3], const f64w amounts[4], f64w out[3]) {
    for (int k = 0; k < 3; k++)
        out[k] = amounts[1] * sides[0][k] + amounts[2] * sides[1][k] + amounts[3] * sides[2][k];
}

/* Takes off v what it has along the first `count` tangents, and changes its weights with it, unless they are NULL. */
INLINED void take_off_lanes(f64w v[3], f64w *weights, const frame_lanes *f, int count) {
    f64w along[2];
    for (int j = 0; j < count; j++) along[j] = dot_lanes(v, f->tangents[j]) * f->inverses[j];
    for (int j = 0; j < count; j++) {
        for (int k = 0; k < 3; k++) v[k] -= along[j] * f->tangents[j][k];
        for (int i = 0; i < 4 && weights != NULL; i++) weights[i] -= along[j] * f->slides[j][i];
    }
}

/* Makes the j-th tangent orthogonal to the one before. */
INLINED void straighten_slide(int j, bool derived, frame_lanes *f) {
    const f64w zero = f64w_all(0.0);
    f64w *along = f->tangents[j];
    combine_sides(f->sides, f->slides[j], along);
    f64w whole = dot_lanes(along, along);
    for (int again = 0; again < 2; again++) take_off_lanes(along, derived ? f->slides[j] : NULL, f, j);
    f64w squared = dot_lanes(along, along);
    maskw has = maskw_below(f64w_all(LEAST_SQUARED_SINE) * whole, squared);
    f->inverses[j] = maskw_choose(has, 1.0 / squared, zero);
    f->squares[j] = maskw_choose(has, squared, zero);
}

/* The last four doubles of an item: threshold, weight and separation come after a number that is not needed. */
enum { LAST_FOUR = offsetof(cscd_proximity, threshold) - sizeof(double) };
static_assert(offsetof(cscd_proximity, weight) == LAST_FOUR + 2 * sizeof(double) &&
                  offsetof(cscd_proximity, separation) == LAST_FOUR + 3 * sizeof(double),
              "a kernel loads them at once");

INLINED void read_items(const near_terms *near, const cscd_proximity *const items[WIDTH], frame_lanes *f) {
    const double *weights[WIDTH], *last[WIDTH];
    const cscd_energy_options *options = &near->options;
    uint32_t edges = 0;
    f64w numbers[4];
    f->half_spaces = 0;
    for (int lane = 0; lane < WIDTH; lane++) {
        energy_item_prefetch(items[lane]);
        weights[lane] = items[lane]->weights;
        last[lane] = (const double *)(const void *)((const char *)items[lane] + LAST_FOUR);
        edges |= (uint32_t)(items[lane]->kind == CSCD_CONTACT_EE) << lane;
        f->half_spaces |= (uint32_t)(items[lane]->kind == CSCD_CONTACT_VH) << lane;
    }
    f64w_load_quads(weights, f->weights);
    f64w_load_quads(last, numbers);
    f->threshold = f64w_select(edges, numbers[1], f64w_all(0.0));
    f->separation = options->beyond ? numbers[3] : f64w_all(0.0);
    for (int lane = 0; lane < WIDTH && options->by_count; lane++) numbers[2][lane] = items[lane]->count;
    f->factor = options->stiffness * numbers[2];
    for (int i = 0; i < 4; i++) {
        uint32_t vertices[WIDTH];
        for (int lane = 0; lane < WIDTH; lane++) vertices[lane] = items[lane]->vertices[i];
        f64w_load_points(near->x, vertices, f->points[i]);
    }
}

INLINED void find_tangents(const near_terms *near, const cscd_proximity *const items[WIDTH], bool derived,
                           frame_lanes *f) {
    read_items(near, items, f);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) f->sides[i][k] = f->points[i + 1][k] - f->points[0][k];
    }
    name_slide_lanes(f->weights, f->slides);
    for (int j = 0; j < 2; j++) straighten_slide(j, derived, f);
}

INLINED void find_distances(bool derived, frame_lanes *f) {
    const f64w zero = f64w_all(0.0);
    f64w apart[3], across[3];
    const maskw both = maskw_below(zero, f->squares[0]) & maskw_below(zero, f->squares[1]);
    combine_sides(f->sides, f->weights, apart);
    for (int again = 0; again < 2; again++) take_off_lanes(apart, derived ? f->weights : NULL, f, 2);
    cross_lanes(f->tangents[0], f->tangents[1], across);
    f64w height = dot_lanes(apart, across);
    f64w length = f64w_sqrt(maskw_choose(both, f->squares[1] * f->inverses[0], dot_lanes(apart, apart)));
    f64w size = maskw_choose(both, f->squares[0] * length, length);
    f64w inverse = maskw_choose(maskw_below(zero, size), 1.0 / size, zero);
    inverse = maskw_choose(both & maskw_below(height, zero), -inverse, inverse);
    f->distance = maskw_choose(both, height * inverse, length);
    for (int k = 0; k < 3; k++) f->normal[k] = maskw_choose(both, across[k], apart[k]) * inverse;
    f->resting = f64w_at_most(maskw_choose(both, f64w_all(1.0), length), zero);
}

/* The lanes of half-spaces: the plane's normal is that of the item. */
static inline void set_half_spaces(const cscd_proximity *const items[WIDTH], frame_lanes *f) {
    f64w apart[3], normal[3];
    for (int k = 0; k < 3; k++) {
        double numbers[WIDTH];
        for (int lane = 0; lane < WIDTH; lane++) numbers[lane] = items[lane]->normal[k];
        memcpy(&normal[k], numbers, sizeof numbers);
        apart[k] = f64w_all(0.0) - f->sides[0][k];
        f->normal[k] = f64w_select(f->half_spaces, normal[k], f->normal[k]);
    }
    f->distance = f64w_select(f->half_spaces, dot_lanes(apart, normal), f->distance);
    f->resting &= ~f->half_spaces;
}

/* ---- laws --------------------------------------------------------------------------------------------------- */

typedef uint64_t u64w __attribute__((vector_size(WIDTH * sizeof(uint64_t))));

/* As natural_logarithm. The exponent becomes a double as the last bits of 2^52. */
static inline f64w logarithm_lanes(f64w x) {
    const uint64_t mantissa = 0x000fffffffffffff, half = 0x3fe0000000000000, power = 0x4330000000000000;
    u64w bits = (u64w)x;
    f64w k = (f64w)(bits >> 52 | power) - (0x1p52 + 1022.0), m = (f64w)((bits & mantissa) | half);
    maskw low = maskw_below(m, f64w_all(0x1.6a09e667f3bcdp-1));
    m = maskw_choose(low, m * 2.0, m);
    k = maskw_choose(low, k - 1.0, k);
    f64w f = m - 1.0, s = f / (2.0 + f), z = s * s, zz = z * z;
    f64w even = f64w_all(logarithm_series[LOGARITHM_TERMS - 1]),
         odd = f64w_all(logarithm_series[LOGARITHM_TERMS - 2]);
    for (int i = LOGARITHM_TERMS - 3; i > 0; i -= 2) {
        even = logarithm_series[i] + zz * even;
        odd = logarithm_series[i - 1] + zz * odd;
    }
    f64w sum = z * (logarithm_series[0] + zz * even + z * odd);
    f64w tail = s * (f - 2.0 * sum) - k * LOGARITHM_2_LOW;
    return k * LOGARITHM_2_HIGH + (f - tail);
}

typedef struct curve_lanes {
    f64w value, slope;
} curve_lanes;

INLINED curve_lanes clamped_barriers(f64w x, f64w r) {
    f64w ratio = x / r, beyond = x - r, share = beyond / x, logarithm = logarithm_lanes(ratio);
    maskw finite = maskw_at_most(f64w_all(0x1p-1022), ratio);
    return (curve_lanes){maskw_choose(finite, -beyond * beyond * logarithm, f64w_all(INFINITY)),
                         -beyond * (2.0 * logarithm + share)};
}

static inline f64w physical_factors(const cscd_energy_options *options, f64w s) {
    const f64w r = f64w_all(options->reach);
    if (options->law != CSCD_ENERGY_BARRIER_SQUARED) return 1.0 / r;
    f64w square = r * (2.0 * s + r);
    return r / (square * square);
}

/* The law times the factor. Where the value is 0 or infinite, the slope is 0. */
INLINED curve_lanes laws_at(const cscd_energy_options *options, f64w distance, f64w separation, f64w factor,
                            f64w *gap) {
    const f64w r = f64w_all(options->reach), zero = f64w_all(0.0), infinite = f64w_all(INFINITY);
    *gap = distance - separation;
    f64w left = r - *gap;
    curve_lanes c = {0.5 * left * left, -left};
    if (options->law == CSCD_ENERGY_CUBIC)
        c = (curve_lanes){left * left * left / (6.0 * r), -left * left / (2.0 * r)};
    if (options->law == CSCD_ENERGY_BARRIER) c = clamped_barriers(*gap, r);
    if (options->law == CSCD_ENERGY_BARRIER_SQUARED) {
        c = clamped_barriers(*gap * (distance + separation), r * (2.0 * separation + r));
        c.slope *= 2.0 * distance;
    }
    if (options->law == CSCD_ENERGY_BARRIER || options->law == CSCD_ENERGY_BARRIER_SQUARED)
        c.value = maskw_choose(maskw_at_most(*gap, zero), infinite, c.value);
    if (options->physical) {
        f64w physical = physical_factors(options, separation);
        c = (curve_lanes){physical * c.value, physical * c.slope};
    }
    maskw counts = maskw_below(*gap, r) & maskw_below(zero, factor);
    c.value = maskw_choose(counts, factor * c.value, zero);
    maskw derived = maskw_below(zero, c.value) & maskw_below(c.value, infinite);
    c.slope = maskw_choose(derived, factor * c.slope, zero);
    return c;
}

/* ---- nearly parallel edges ---------------------------------------------------------------------------------- */

/* Multiplies with the mollifier, as mollify_term. */
static inline void mollify_lanes(const f64w points[4][3], f64w threshold, curve_lanes *c, f64w *gradient) {
    const f64w zero = f64w_all(0.0);
    f64w a[3], b[3], across[3], by_a[3], by_b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = points[1][k] - points[0][k];
        b[k] = points[3][k] - points[2][k];
    }
    cross_lanes(a, b, across);
    f64w crossing = dot_lanes(across, across), share = crossing / threshold;
    maskw fading = maskw_below(crossing, threshold) & maskw_below(zero, c->value) &
                   maskw_below(c->value, f64w_all(INFINITY));
    f64w value = maskw_choose(fading, share * (2.0 - share), f64w_all(1.0));
    if (gradient != NULL) {
        f64w turn = maskw_choose(fading, c->value * (2.0 * (1.0 - share) / threshold), zero);
        cross_lanes(b, across, by_a);
        cross_lanes(across, a, by_b);
        for (int k = 0; k < 3; k++) {
            f64w along_a = turn * (2.0 * by_a[k]), along_b = turn * (2.0 * by_b[k]);
            gradient[k] = value * gradient[k] - along_a;
            gradient[3 + k] = value * gradient[3 + k] + along_a;
            gradient[6 + k] = value * gradient[6 + k] - along_b;
            gradient[9 + k] = value * gradient[9 + k] + along_b;
        }
    }
    c->value *= value;
}

/* ---- a batch ------------------------------------------------------------------------------------------------ */

/* Writes each lane's twelve numbers, one after the other; those behind the last item are lost. */
static inline void store_gradients(const f64w gradient[12], size_t first, size_t count, double (*out)[4][3]) {
    double lost[12], *rows[WIDTH];
    for (int i = 0; i < 12; i += 4) {
        for (size_t lane = 0; lane < WIDTH; lane++)
            rows[lane] = (first + lane < count ? out[first + lane][0] : lost) + i;
        f64w_store_quads(gradient + i, rows);
    }
}

INLINED uint64_t finish_lanes(const frame_lanes *f, curve_lanes c, size_t first, size_t count, bool derived,
                              const energy_outputs *out) {
    const uint64_t resting = f->resting & f64w_below(f64w_all(0.0), c.value);
    f64w gradient[12];
    for (int i = 0; derived && i < 12; i++) gradient[i] = c.slope * f->weights[i / 3] * f->normal[i % 3];
    if (f64w_below(f64w_all(0.0), f->threshold) != 0)
        mollify_lanes(f->points, f->threshold, &c, derived ? gradient : NULL);
    memcpy(out->values + first, &c.value, sizeof c.value);
    if (derived) store_gradients(gradient, first, count, out->gradients);
    return resting << first;
}

/* Step by step for all vectors: each step is a long chain, so the processor works at several vectors at a time. The last item is
 * repeated up to a whole vector. */
INLINED uint64_t evaluate_batch(const near_terms *near, size_t first, size_t count, bool derived,
                                const energy_outputs *out) {
    const cscd_proximity *items[ENERGY_BATCH];
    frame_lanes frames[ENERGY_BATCH / WIDTH];
    curve_lanes curves[ENERGY_BATCH / WIDTH];
    uint64_t resting = 0;
    const size_t vectors = (count + WIDTH - 1) / WIDTH;
    for (size_t i = 0; i < vectors * WIDTH; i++) items[i] = &near->items[first + (i < count ? i : count - 1)];
    for (size_t i = 0; i < vectors; i++) find_tangents(near, items + WIDTH * i, derived, &frames[i]);
    for (size_t i = 0; i < vectors; i++) {
        find_distances(derived, &frames[i]);
        if (frames[i].half_spaces != 0) set_half_spaces(items + WIDTH * i, &frames[i]);
    }
    for (size_t i = 0; i < vectors; i++) {
        f64w gap;
        curves[i] = laws_at(&near->options, frames[i].distance, frames[i].separation, frames[i].factor, &gap);
        memcpy(out->gaps + WIDTH * i, &gap, sizeof gap);
    }
    for (size_t i = 0; i < vectors; i++)
        resting |= finish_lanes(&frames[i], curves[i], WIDTH * i, count, derived, out);
    return resting;
}

static uint64_t evaluate_values(const near_terms *near, size_t first, size_t count,
                                const energy_outputs *out) {
    return evaluate_batch(near, first, count, false, out);
}

static uint64_t evaluate_gradients(const near_terms *near, size_t first, size_t count,
                                   const energy_outputs *out) {
    return evaluate_batch(near, first, count, true, out);
}

const energy_kernels SIMD_NAME(energy_kernels) = {evaluate_values, evaluate_gradients};
