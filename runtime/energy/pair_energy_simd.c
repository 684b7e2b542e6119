/* Energies of as many pairs as the processor takes at once, with their gradients: the same operations in the same order as
 * energy_pair_evaluate, so the same bits.
 *
 * Pairs of all kinds go through one sequence. The signs of its weights say along which features a pair's nearest points slide; a slide
 * that it lacks is 0, and so is what depends on it. */
#include "runtime/energy/energy.h"
#include "src/core/simd_wide.h"

/* Whole, so that a value alone has no part of a gradient. */
#define INLINED static inline __attribute__((always_inline))

/* ---- eight items, lane by lane ------------------------------------------------------------------------------ */

typedef struct item_lanes {
    uint32_t vertices[4][LANES];
    double weights[4][LANES];
    double named[2][LANES]; /* the last two weights; 0 where the kind has no such vertex */
    double factors[LANES], separations[LANES];
    double thresholds[LANES]; /* 0 except of two edges */
    uint32_t half_spaces;     /* a set of lanes */
    bool with_thresholds;
} item_lanes;

static inline void gather_items(const cscd_energy_options *options, const cscd_proximity *items, size_t count,
                                item_lanes *out) {
    out->half_spaces = 0;
    out->with_thresholds = false;
    for (size_t lane = 0; lane < LANES; lane++) {
        const cscd_proximity *item = &items[lane < count ? lane : count - 1];
        const int size = energy_vertices_of(item->kind);
        energy_item_prefetch(item);
        for (int i = 0; i < 4; i++) out->vertices[i][lane] = item->vertices[i];
        for (int i = 0; i < 4; i++) out->weights[i][lane] = item->weights[i];
        out->named[0][lane] = size > 2 ? item->weights[2] : 0.0;
        out->named[1][lane] = size > 3 ? item->weights[3] : 0.0;
        out->factors[lane] = options->stiffness * energy_weight_of(options, item);
        out->separations[lane] = energy_separation_of(options, item);
        out->thresholds[lane] = item->kind == CSCD_CONTACT_EE ? item->threshold : 0.0;
        out->half_spaces |= (uint32_t)(item->kind == CSCD_CONTACT_VH) << lane;
        out->with_thresholds |= out->thresholds[lane] > 0.0;
    }
}

static inline f64w load_lanes(const double *from) {
    f64w v;
    memcpy(&v, from, sizeof v);
    return v;
}

static inline void store_lanes(f64w v, double *to) {
    memcpy(to, &v, sizeof v);
}

static inline f64w dot_lanes(const f64w a[3], const f64w b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cross_lanes(const f64w a[3], const f64w b[3], f64w out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* ---- frames ------------------------------------------------------------------------------------------------- */

/* As pair_frame; tangents and slides that a pair lacks are 0. */
typedef struct frame_lanes {
    f64w weights[4], normal[3], distance;
    f64w tangents[2][3], slides[2][4]; /* of any length */
    f64w inverses[2];                  /* of the squared lengths of tangents */
    uint32_t resting; /* the lanes whose points are in one place, of no normal that the positions say */
} frame_lanes;

/* The slides along an edge of a, and along an edge or a face of b, as those of pair_frame.c. */
static inline void name_slide_lanes(const f64w w[4], const f64w named[2], f64w slides[2][4]) {
    const f64w zero = f64w_all(0.0), one = f64w_all(1.0), minus = f64w_all(-1.0);
    const maskw edge_a = maskw_below(zero, w[0]) & maskw_below(zero, w[1]);
    const maskw on_1 = maskw_below(w[1], zero), on_2 = maskw_below(named[0], zero),
                on_3 = maskw_below(named[1], zero);
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
static inline void combine_sides(f64w sides[3][3], const f64w amounts[4], f64w out[3]) {
    for (int k = 0; k < 3; k++)
        out[k] = amounts[1] * sides[0][k] + amounts[2] * sides[1][k] + amounts[3] * sides[2][k];
}

/* Takes off v what it has along the first `count` tangents, and changes its weights with it. */
static inline void take_off_lanes(f64w v[3], f64w weights[4], const frame_lanes *f, int count) {
    f64w along[2];
    for (int j = 0; j < count; j++) along[j] = dot_lanes(v, f->tangents[j]) * f->inverses[j];
    for (int j = 0; j < count; j++) {
        for (int k = 0; k < 3; k++) v[k] -= along[j] * f->tangents[j][k];
        for (int i = 0; i < 4; i++) weights[i] -= along[j] * f->slides[j][i];
    }
}

/* Makes the j-th tangent orthogonal to the one before, and returns its squared length; 0 where there is none. */
static inline f64w straighten_slide(f64w sides[3][3], int j, frame_lanes *f) {
    const f64w zero = f64w_all(0.0);
    f64w *along = f->tangents[j];
    combine_sides(sides, f->slides[j], along);
    f64w whole = dot_lanes(along, along);
    for (int again = 0; again < 2; again++) take_off_lanes(along, f->slides[j], f, j);
    f64w squared = dot_lanes(along, along);
    maskw has = maskw_below(f64w_all(LEAST_SQUARED_SINE) * whole, squared);
    f->inverses[j] = maskw_choose(has, 1.0 / squared, zero);
    return maskw_choose(has, squared, zero);
}

/* The lanes of half-spaces: the plane's normal is that of the item. */
static inline void set_half_spaces(const cscd_proximity *items, size_t count, uint32_t lanes, int first,
                                   f64w sides[3][3], frame_lanes *f) {
    double normals[3][WIDTH];
    f64w apart[3], normal[3];
    for (int lane = 0; lane < WIDTH; lane++) {
        const size_t i = (size_t)(first + lane);
        for (int k = 0; k < 3; k++) normals[k][lane] = items[i < count ? i : count - 1].normal[k];
    }
    for (int k = 0; k < 3; k++) {
        normal[k] = load_lanes(normals[k]);
        apart[k] = f64w_all(0.0) - sides[0][k];
        f->normal[k] = f64w_select(lanes, normal[k], f->normal[k]);
    }
    f->distance = f64w_select(lanes, dot_lanes(apart, normal), f->distance);
    f->resting &= ~lanes;
}

INLINED void find_frames(f64w points[4][3], const f64w named[2], frame_lanes *f) {
    const f64w zero = f64w_all(0.0);
    f64w sides[3][3], apart[3], across[3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) sides[i][k] = points[i + 1][k] - points[0][k];
    }
    name_slide_lanes(f->weights, named, f->slides);
    const f64w first = straighten_slide(sides, 0, f), second = straighten_slide(sides, 1, f);
    const maskw both = maskw_below(zero, first) & maskw_below(zero, second);
    combine_sides(sides, f->weights, apart);
    for (int again = 0; again < 2; again++) take_off_lanes(apart, f->weights, f, 2);
    cross_lanes(f->tangents[0], f->tangents[1], across);
    f64w height = dot_lanes(apart, across), length = f64w_sqrt(dot_lanes(apart, apart));
    f64w size = maskw_choose(both, f64w_sqrt(first) * f64w_sqrt(second), length);
    f64w inverse = maskw_choose(maskw_below(zero, size), 1.0 / size, zero);
    inverse = maskw_choose(both & maskw_below(height, zero), -inverse, inverse);
    f->distance = maskw_choose(both, height * inverse, length);
    for (int k = 0; k < 3; k++) f->normal[k] = maskw_choose(both, across[k], apart[k]) * inverse;
    f->resting = f64w_at_most(maskw_choose(both, f64w_all(1.0), length), zero);
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

static inline curve_lanes clamped_barriers(f64w x, f64w r) {
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
static inline curve_lanes laws_at(const cscd_energy_options *options, f64w distance, f64w separation,
                                  f64w factor, f64w *gap) {
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
static inline void mollify_lanes(f64w points[4][3], f64w threshold, curve_lanes *c, f64w *gradient) {
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

/* ---- eight pairs -------------------------------------------------------------------------------------------- */

/* Writes each lane's twelve numbers, one after the other. */
static inline void store_gradients(f64w gradient[12], int first, size_t count, double (*out)[4][3]) {
    double lanes[12][WIDTH];
    for (int i = 0; i < 12; i++) store_lanes(gradient[i], lanes[i]);
    for (int lane = 0; lane < WIDTH && (size_t)(first + lane) < count; lane++) {
        for (int i = 0; i < 12; i++) out[first + lane][i / 3][i % 3] = lanes[i][lane];
    }
}

INLINED uint32_t evaluate_some(const near_terms *near, const cscd_proximity *items, size_t count,
                               bool derived, const item_lanes *lanes, int first, const energy_outputs *out) {
    f64w points[4][3], named[2], gradient[12], gap;
    frame_lanes f;
    for (int i = 0; i < 4; i++) {
        f64w_load_points(near->x, lanes->vertices[i] + first, points[i]);
        f.weights[i] = load_lanes(lanes->weights[i] + first);
    }
    for (int i = 0; i < 2; i++) named[i] = load_lanes(lanes->named[i] + first);
    find_frames(points, named, &f);
    const uint32_t half_spaces = lanes->half_spaces >> first & ALL_WIDTH;
    if (half_spaces != 0) {
        f64w sides[3][3];
        for (int k = 0; k < 3; k++) sides[0][k] = points[1][k] - points[0][k];
        set_half_spaces(items, count, half_spaces, first, sides, &f);
    }
    curve_lanes c = laws_at(&near->options, f.distance, load_lanes(lanes->separations + first),
                            load_lanes(lanes->factors + first), &gap);
    const f64w unmollified = c.value;
    for (int i = 0; derived && i < 12; i++) gradient[i] = c.slope * f.weights[i / 3] * f.normal[i % 3];
    if (lanes->with_thresholds)
        mollify_lanes(points, load_lanes(lanes->thresholds + first), &c, derived ? gradient : NULL);
    store_lanes(c.value, out->values + first);
    store_lanes(gap, out->gaps + first);
    if (!derived) return 0;
    store_gradients(gradient, first, count, out->gradients);
    return (f.resting & f64w_below(f64w_all(0.0), unmollified)) << first;
}

INLINED uint32_t evaluate_eight(const near_terms *near, size_t first, size_t count, bool derived,
                                const energy_outputs *out) {
    item_lanes lanes;
    uint32_t resting = 0;
    gather_items(&near->options, near->items + first, count, &lanes);
    for (int i = 0; i < LANES; i += WIDTH)
        resting |= evaluate_some(near, near->items + first, count, derived, &lanes, i, out);
    return resting;
}

static uint32_t evaluate_values(const near_terms *near, size_t first, size_t count,
                                const energy_outputs *out) {
    return evaluate_eight(near, first, count, false, out);
}

static uint32_t evaluate_gradients(const near_terms *near, size_t first, size_t count,
                                   const energy_outputs *out) {
    return evaluate_eight(near, first, count, true, out);
}

const energy_kernels SIMD_NAME(energy_kernels) = {evaluate_values, evaluate_gradients};
