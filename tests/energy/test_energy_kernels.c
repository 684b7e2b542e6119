/* Kernels of energies, a batch of pairs at a time: the bits of each pair by itself, on every instruction set. */
#include "runtime/energy/energy.h"
#include "tests/support/energy/energy_truth.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

/* Up to a batch of pairs of one law, with the positions of all. */
typedef struct case_list {
    cscd_proximity items[ENERGY_BATCH];
    double x[ENERGY_BATCH * 12];
    near_terms near;
} case_list;

static cscd_energy_options make_options(random_stream *random) {
    cscd_energy_options options = cscd_energy_defaults();
    options.law = stream_below(random, 4);
    options.reach = exp(stream_between(random, -6.0, 0.0));
    options.stiffness = stream_below(random, 9) == 0 ? 0.0 : exp(stream_between(random, -9.0, 9.0));
    options.beyond = stream_below(random, 2) == 1;
    options.by_count = stream_below(random, 2) == 1;
    options.physical = stream_below(random, 2) == 1;
    return options;
}

/* Moves all points to those of b, so that the pair has no normal but the item's. */
static void let_touch(energy_case *c) {
    for (int i = 0; i < 12; i++) c->x[i] = c->x[3 + i % 3];
}

/* A pair within the reach, beyond it, nearer than it has to keep, or in one place. */
static void add_pair(random_stream *random, case_list *list, uint32_t i) {
    const double reach = list->near.options.reach, share = stream_between(random, -0.1, 1.2);
    const double keep = list->near.options.beyond ? stream_between(random, 0.0, 2.0) * reach : 0.0;
    energy_case c = energy_case_make(random, stream_below(random, SHAPE_COUNT), fabs(keep + share * reach));
    c.item.separation = list->near.options.beyond ? keep : 4711.0;
    if (stream_below(random, 2) == 1) c.item.threshold = stream_between(random, 0.1, 30.0);
    if (stream_below(random, 20) == 0) let_touch(&c);
    for (int k = 0; k < 4; k++) c.item.vertices[k] += 4 * i;
    list->items[i] = c.item;
    memcpy(list->x + 12 * i, c.x, sizeof c.x);
}

static void expect_same(const double a[4][3], const double b[4][3]) {
    for (int i = 0; i < 12; i++) {
        if (a[i / 3][i % 3] != b[i / 3][i % 3])
            fail_msg("number %d is %.17g, by itself %.17g", i, a[i / 3][i % 3], b[i / 3][i % 3]);
    }
}

static void compare_pairs(const case_list *list, uint32_t count) {
    double values[2][ENERGY_BATCH], gaps[2][ENERGY_BATCH], gradients[ENERGY_BATCH][4][3];
    const energy_outputs plain = {values[0], gaps[0], NULL}, derived = {values[1], gaps[1], gradients};
    list->near.kernels->values(&list->near, 0, count, &plain);
    const uint64_t left = list->near.kernels->gradients(&list->near, 0, count, &derived);
    for (uint32_t i = 0; i < count; i++) {
        double truth[4][3];
        energy_term term = {.gradient = truth};
        energy_pair_evaluate(&list->near.options, &list->items[i], list->x, &term);
        for (int k = 0; k < 2; k++) {
            assert_true(values[k][i] == term.value);
            assert_true(gaps[k][i] == term.gap);
        }
        if ((left >> i & 1) == 0) expect_same(gradients[i], truth);
    }
}

TEST(pairs_are_as_each_by_itself) {
    random_stream random = stream_start(4);
    for (int i = 0; i < NIGHTLY(3000, 100000); i++) {
        case_list list = {.near.options = make_options(&random)};
        const uint32_t count = 1 + stream_below(&random, ENERGY_BATCH);
        for (uint32_t j = 0; j < count; j++) add_pair(&random, &list, j);
        list.near.items = list.items;
        list.near.x = list.x;
        for (int level = 0; level < LEVEL_COUNT; level++) {
            if (contexts[level] == NULL) continue;
            list.near.kernels = energy_kernels_of(contexts[level]);
            compare_pairs(&list, count);
        }
    }
}

/* A kernel leaves out what only an item's normal tells; a sum does not. */
TEST(points_in_one_place_have_the_normal_of_their_item) {
    const cscd_object_desc points = cscd_object_of_points(2);
    const double x[6] = {1.0, 2.0, 3.0, 1.0, 2.0, 3.0};
    const cscd_proximity item = {.kind = CSCD_CONTACT_VV,
                                 .count = 1,
                                 .vertices = {0, 1, 1, 1},
                                 .weights = {1.0, -1.0, 0.0, 0.0},
                                 .normal = {0.0, 0.6, 0.8},
                                 .weight = 1.0};
    const cscd_proximities one = {&item, 1};
    double gradient[6];
    const cscd_energy_targets targets = {.gradient = gradient};
    cscd_energy_options options = cscd_energy_defaults();
    options.reach = 0.5;
    options.law = CSCD_ENERGY_QUADRATIC;
    for (int level = 0; level < LEVEL_COUNT; level++) {
        cscd_mesh *mesh;
        cscd_energy *energy;
        cscd_energy_sum sum;
        if (contexts[level] == NULL) continue;
        expect_ok(cscd_mesh_create(contexts[level], &points, 1, &mesh));
        expect_ok(cscd_energy_create(contexts[level], mesh, &energy));
        expect_ok(cscd_energy_evaluate(energy, &one, CSCD_DOUBLES(x, 2), &options, &targets, &sum));
        assert_true(sum.value == 0.125 && sum.least == 0.0);
        assert_true(fabs(gradient[1] + 0.3) < 1e-15 && fabs(gradient[5] - 0.4) < 1e-15);
        cscd_energy_destroy(energy);
        cscd_mesh_destroy(mesh);
    }
}

AROUND_ALL(open_levels, close_levels)
