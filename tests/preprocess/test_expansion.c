/* Expansions of 1 / r against sums over the charges, and the bound of their error. */
#include "preprocess/treecode/expansion.h"
#include "preprocess/treecode/source_tree.h"
#include "tests/support/random.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

enum { CHARGES = 40, TARGETS = 20 };

/* Charges in a ball about a centre, and places in another. */
typedef struct two_balls {
    double centers[2][3], radii[2]; /* of the sources, of the targets */
    double sources[CHARGES][3], charges[CHARGES], targets[TARGETS][3];
} two_balls;

static expansion_tables tables;

static int make_tables(void **state) {
    expansion_tables_set(&tables);
    return open_levels(state);
}

static const treecode_kernels *scalar_kernels(void) {
    return KERNELS_OF(contexts[0], treecode_kernels);
}

static void subtract_points(const double a[3], const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

static double length_of(const double v[3]) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* On the surface of a ball, where the error is the largest, or inside it. */
static void place_in_ball(const double center[3], double radius, bool outmost, double out[3]) {
    double v[3], length;
    do {
        for (int k = 0; k < 3; k++) v[k] = random_unit();
        length = length_of(v);
    } while (length > 1.0 || length < 0.1);
    for (int k = 0; k < 3; k++) out[k] = center[k] + radius * v[k] / (outmost ? length : 1.0);
}

static two_balls make_balls(double ratio, double scale) {
    two_balls b;
    double direction[3];
    for (int k = 0; k < 3; k++) b.centers[0][k] = scale * random_unit();
    place_in_ball((const double[3]){0.0, 0.0, 0.0}, scale, true, direction);
    for (int k = 0; k < 3; k++) b.centers[1][k] = b.centers[0][k] + direction[k];
    b.radii[0] = ratio * scale * 0.7;
    b.radii[1] = ratio * scale * 0.3;
    for (int i = 0; i < CHARGES; i++) {
        place_in_ball(b.centers[0], b.radii[0], i % 2 == 0, b.sources[i]);
        b.charges[i] = 1.0 + 0.5 * random_unit();
    }
    for (int i = 0; i < TARGETS; i++) place_in_ball(b.centers[1], b.radii[1], i % 2 == 0, b.targets[i]);
    return b;
}

static double sum_at(const two_balls *b, const double target[3]) {
    double sum = 0.0, d[3];
    for (int i = 0; i < CHARGES; i++) {
        subtract_points(b->sources[i], target, d);
        sum += b->charges[i] / length_of(d);
    }
    return sum;
}

static void find_moments(const two_balls *b, const double center[3], double moments[HARMONIC_COUNT]) {
    double full[FULL_COUNT] = {0.0}, place[3];
    for (int i = 0; i < CHARGES; i++) {
        subtract_points(b->sources[i], center, place);
        expansion_add_charge(&tables, place, b->charges[i], full);
    }
    expansion_fold(&tables, full, moments);
}

static void find_coefficients(const treecode_kernels *kernels, const double source[3], const double *moments,
                              uint32_t order, const double target[3], double coefficients[HARMONIC_COUNT]) {
    source_node node = {.begin = 0};
    const far_item item = order << FAR_NODE_BITS;
    memcpy(node.center, source, sizeof node.center);
    const far_field field = {&tables, &node, moments, &item, 1};
    memset(coefficients, 0, HARMONIC_COUNT * sizeof *coefficients);
    kernels->add_far_field(&field, target, coefficients);
}

static double value_at(const double *coefficients, const double center[3], const double target[3]) {
    double full[FULL_COUNT], place[3];
    expansion_unfold(&tables, coefficients, full);
    subtract_points(target, center, place);
    return expansion_potential(&tables, place, full);
}

/* Of every order, at every distance: never above the bound, and near it for charges at one point. */
TEST(errors_keep_to_the_bound) {
    for (uint32_t order = 0; order <= EXPANSION_ORDER; order++) {
        double largest = 0.0;
        for (int trial = 0; trial < 200; trial++) {
            const double ratio = 0.05 + 0.7 * (trial % 10) / 10.0;
            const two_balls b = make_balls(ratio, trial % 2 == 0 ? 1.0 : 1e-4);
            const double bound = pow(ratio, order + 1.0) * (1.0 + ratio) / (1.0 - ratio);
            double moments[HARMONIC_COUNT], coefficients[HARMONIC_COUNT];
            find_moments(&b, b.centers[0], moments);
            find_coefficients(scalar_kernels(), b.centers[0], moments, order, b.centers[1], coefficients);
            for (int i = 0; i < TARGETS; i++) {
                const double exact = sum_at(&b, b.targets[i]);
                const double error = fabs(value_at(coefficients, b.centers[1], b.targets[i]) / exact - 1.0);
                if (!(error <= bound + 1e-13))
                    fail_msg("order %u, ratio %g: error %g, bound %g", order, ratio, error, bound);
                largest = fmax(largest, error / bound);
            }
        }
        print_message("order %u: errors are up to %.2f of the bound\n", order, largest);
        assert_true(largest > 0.01);
    }
}

/* Moments about another centre are those of the charges about it, and coefficients about another centre are the same polynomial. */
TEST(centres_may_move) {
    for (int trial = 0; trial < 50; trial++) {
        const two_balls b = make_balls(0.3, 1.0);
        double moments[HARMONIC_COUNT], moved[HARMONIC_COUNT], expected[HARMONIC_COUNT],
            full[FULL_COUNT] = {0.0};
        double place[3], other[3], coefficients[HARMONIC_COUNT], shifted[HARMONIC_COUNT] = {0.0};
        place_in_ball(b.centers[0], 0.2, false, other);
        find_moments(&b, b.centers[0], moments);
        find_moments(&b, other, expected);
        subtract_points(b.centers[0], other, place);
        expansion_add_moments(&tables, place, moments, full);
        expansion_fold(&tables, full, moved);
        for (int i = 0; i < HARMONIC_COUNT; i++) assert_true(fabs(moved[i] - expected[i]) <= 1e-12);
        find_coefficients(scalar_kernels(), b.centers[0], moments, EXPANSION_ORDER, b.centers[1],
                          coefficients);
        place_in_ball(b.centers[1], 0.1, false, other);
        subtract_points(other, b.centers[1], place);
        expansion_add_coefficients(&tables, place, coefficients, shifted);
        for (int i = 0; i < TARGETS; i++) {
            const double before = value_at(coefficients, b.centers[1], b.targets[i]);
            assert_true(fabs(value_at(shifted, other, b.targets[i]) - before) <= 1e-11 * fabs(before));
        }
    }
}

/* As many items as there may be in the last batch, of mixed orders, on every level. */
TEST(levels_give_the_same_bits) {
    enum { ITEMS = 21 };
    source_node nodes[ITEMS];
    double moments[ITEMS * HARMONIC_COUNT];
    far_item items[ITEMS];
    for (uint32_t i = 0; i < ITEMS; i++) {
        const two_balls b = make_balls(0.3, 1.0);
        find_moments(&b, b.centers[0], moments + (size_t)i * HARMONIC_COUNT);
        nodes[i] = (source_node){.begin = 0};
        memcpy(nodes[i].center, b.centers[0], sizeof nodes[i].center);
        items[i] = (i / 3) << FAR_NODE_BITS | i;
    }
    const double target[3] = {4.0, -3.0, 5.0};
    for (size_t count = 0; count <= ITEMS; count++) {
        const far_field field = {&tables, nodes, moments, items, count};
        double expected[HARMONIC_COUNT] = {0.0};
        scalar_kernels()->add_far_field(&field, target, expected);
        for (int l = 1; l < LEVEL_COUNT; l++) {
            double found[HARMONIC_COUNT] = {0.0};
            if (contexts[l] == NULL) continue;
            KERNELS_OF(contexts[l], treecode_kernels)->add_far_field(&field, target, found);
            assert_memory_equal(found, expected, sizeof found);
        }
    }
}

AROUND_ALL(make_tables, close_levels)
