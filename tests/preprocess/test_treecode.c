/* The treecode against sums over all triangles: on even meshes, on slivers, and where large triangles lie beside small ones. */
#include "tests/support/preprocess/charge_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A sphere of 1,280 triangles errs by 1.4e-5, and one of 5,120 by half of that: the mesh makes the difference, not the processor. */
enum { LEVEL = PACED(4, 3) };
static const double sphere_tolerance = PACED(1e-5, 2e-5);

/* Charges of even density, a quarter more or less. In the tree's order. */
static double *make_charges(const treecode_rig *r) {
    double *charges = malloc(r->system.count * sizeof *charges);
    assert_non_null(charges);
    random_seed(7);
    for (uint32_t i = 0; i < r->system.count; i++)
        charges[i] = triangle_of(&r->t.tree, i)->area * (1.0 + 0.25 * random_unit());
    return charges;
}

static void expect_close(const char *name, const conductor *s, double tolerance) {
    treecode_rig r = treecode_rig_create(s, 2, CSCD_SIMD_AUTO);
    double *charges = make_charges(&r), *potentials = malloc(r.system.count * sizeof *potentials),
           worst = 0.0;
    assert_non_null(potentials);
    expect_ok(treecode_evaluate(&r.t, charges, potentials));
    const uint32_t step = r.system.count / 300 + 1;
    for (uint32_t i = 0; i < r.system.count; i += step)
        worst = fmax(worst, fabs(potentials[i] / treecode_rig_exact_at(&r, charges, i) - 1.0));
    print_message("%s, %u triangles: %zu far pairs, %zu near; within %.1e\n", name, r.system.count,
                  r.t.lists.far_count, r.t.lists.near_count, worst);
    assert_true(worst <= tolerance);
    free(charges);
    free(potentials);
    treecode_rig_destroy(&r);
}

static conductor flat_ellipsoid(int level, double z) {
    const double axes[3] = {1.5, 1.0, z}, nowhere[3] = {0.0, 0.0, 0.0};
    conductor s = conductor_sphere(level);
    conductor_transform(&s, axes, nowhere);
    return s;
}

/* A cube of twelve triangles around a fine sphere, and one beside a corner. */
static conductor large_beside_small(void) {
    conductor s = conductor_cube(0), inner = conductor_sphere(LEVEL), outer = conductor_sphere(LEVEL - 1);
    const double small[3] = {0.3, 0.3, 0.3}, middle[3] = {0.5, 0.5, 0.5}, tiny[3] = {0.01, 0.01, 0.01},
                 corner[3] = {1.02, 1.0, 1.0};
    conductor_transform(&inner, small, middle);
    conductor_transform(&outer, tiny, corner);
    conductor_append(&s, &inner);
    conductor_append(&s, &outer);
    conductor_free(&inner);
    conductor_free(&outer);
    return s;
}

TEST(potentials_are_those_of_all_triangles) {
    conductor one = conductor_tetrahedron(), sphere = conductor_sphere(LEVEL),
              disc = flat_ellipsoid(LEVEL, 0.01), mixed = large_beside_small(),
              crowded = conductor_cube(LEVEL);
    conductor_crowd_edges(&crowded);
    expect_close("tetrahedron", &one, 1e-6);
    expect_close("sphere", &sphere, sphere_tolerance);
    expect_close("disc with slivers at its edge", &disc, 1e-4);
    expect_close("cube with slivers", &crowded, 1e-4);
    expect_close("large beside small", &mixed, 1e-4);
    conductor *all[] = {&one, &sphere, &disc, &mixed, &crowded};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) conductor_free(all[i]);
}

/* Every source reaches every target once: by the far or long items of the nodes above it, or in its leaf's list. Far items come by
 * order. */
static void expect_pairs_once(const conductor *s) {
    treecode_rig r = treecode_rig_create(s, 1, CSCD_SIMD_AUTO);
    const source_tree *tree = &r.t.tree;
    const interactions *lists = &r.t.lists;
    uint8_t *reached = malloc(tree->count);
    assert_non_null(reached);
    for (uint32_t l = 0; l < tree->leaf_count; l++) {
        const source_node *leaf = &tree->nodes[tree->leaves[l]];
        memset(reached, 0, tree->count);
        for (uint32_t n = 0; n < tree->node_count; n++) {
            if (tree->nodes[n].begin > leaf->begin || tree->nodes[n].end < leaf->end) continue;
            for (size_t i = lists->far_begins[n]; i < lists->far_begins[n + 1]; i++) {
                assert_true(i == lists->far_begins[n] || lists->far_items[i] > lists->far_items[i - 1]);
                const source_node *source = &tree->nodes[lists->far_items[i] & ((1u << FAR_NODE_BITS) - 1)];
                for (uint32_t k = source->begin; k < source->end; k++) reached[k]++;
            }
            for (size_t i = lists->long_begins[n]; i < lists->long_begins[n + 1]; i++) {
                const source_node *source = &tree->nodes[lists->long_sources[i]];
                for (uint32_t k = source->begin; k < source->end; k++) reached[k]++;
            }
        }
        for (size_t i = lists->near_begins[2 * l]; i < lists->near_begins[2 * l + 2]; i++)
            reached[lists->near_sources[i]]++;
        for (uint32_t k = 0; k < tree->count; k++) assert_int_equal(reached[k], 1);
    }
    free(reached);
    treecode_rig_destroy(&r);
}

TEST(pairs_are_taken_once) {
    conductor mixed = large_beside_small(), cylinder = conductor_extreme(EXTREME_CYLINDER, 1000);
    expect_pairs_once(&mixed);
    expect_pairs_once(&cylinder);
    conductor_free(&mixed);
    conductor_free(&cylinder);
}

TEST(threads_and_levels_give_the_same_bits) {
    conductor s = large_beside_small();
    treecode_rig expected = treecode_rig_create(&s, 1, CSCD_SIMD_SCALAR);
    double *charges = make_charges(&expected),
           *potentials = malloc(2 * s.triangle_count * sizeof *potentials);
    assert_non_null(potentials);
    double *found = potentials + s.triangle_count;
    expect_ok(treecode_evaluate(&expected.t, charges, potentials));
    for (uint32_t threads = 1; threads <= 3; threads++) {
        treecode_rig r = treecode_rig_create(&s, threads, CSCD_SIMD_AUTO);
        expect_ok(treecode_evaluate(&r.t, charges, found));
        assert_memory_equal(found, potentials, expected.system.count * sizeof *found);
        treecode_rig_destroy(&r);
    }
    free(charges);
    free(potentials);
    treecode_rig_destroy(&expected);
    conductor_free(&s);
}
