/* Charges of fans, combs and other shapes of long triangles: those of the dense system, in memory that grows with the triangles. */
#include "tests/support/calls.h"
#include "tests/support/preprocess/charge_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SMALL = NIGHTLY(400, 1000) };
static const double growth_most = NIGHTLY(2.3, 1.5); /* of so few triangles hardly any are apart */

static const extreme_kind kinds[] = {EXTREME_FAN,     EXTREME_CYLINDER, EXTREME_BIPYRAMID, EXTREME_COMB,
                                     EXTREME_NEEDLES, EXTREME_BOOK,     EXTREME_SPIRE};
enum { KINDS = sizeof kinds / sizeof *kinds };

TEST(densities_are_those_of_the_dense_system) {
    for (int k = 0; k < KINDS; k++) {
        conductor s = conductor_extreme(kinds[k], SMALL);
        charge_rig a = charge_rig_solve(&s, 2), b = charge_rig_solve_by(&by_tree, &s, 2);
        double mean = 0.0, square = 0.0, worst = 0.0;
        for (uint32_t t = 0; t < s.triangle_count; t++) mean += a.density[t] / s.triangle_count;
        for (uint32_t t = 0; t < s.triangle_count; t++) {
            const double error = (b.density[t] - a.density[t]) / mean;
            square += error * error / s.triangle_count;
            worst = fmax(worst, fabs(error));
        }
        print_message("%s: capacitance within %.1e, densities within %.1e, in the mean %.1e\n",
                      extreme_kind_name(kinds[k]), fabs(b.capacitance[0] / a.capacitance[0] - 1.0), worst,
                      sqrt(square));
        assert_true(fabs(b.capacitance[0] / a.capacitance[0] - 1.0) < 1e-5);
        /* all pages of a book touch at its edge, which hardly tells their charges apart */
        if (kinds[k] == EXTREME_BOOK)
            assert_true(sqrt(square) < 1e-2);
        else
            assert_true(sqrt(square) < 3e-4 && worst < 5e-3);
        charge_rig_destroy(&a);
        charge_rig_destroy(&b);
        conductor_free(&s);
    }
}

/* ---- potentials ------------------------------------------------------------------------------------------ */

/* Needles along x, and needles along y just above: there each column of a block has a peak of its own. */
static conductor crossing_needles(void) {
    conductor s = conductor_extreme(EXTREME_NEEDLES, 2 * SMALL),
              other = conductor_extreme(EXTREME_NEEDLES, 2 * SMALL);
    for (uint32_t v = 0; v < other.vertex_count; v++) {
        double *p = other.positions + 3 * (size_t)v;
        const double x = p[0];
        p[0] = p[1];
        p[1] = x;
        p[2] = 1e-3;
    }
    conductor_append(&s, &other);
    conductor_free(&other);
    return s;
}

/* Returns the number of blocks; *full: of those that have all potentials. */
static size_t count_blocks(const treecode *t, size_t *full) {
    size_t count = 0;
    *full = 0;
    for (uint32_t i = 0; i < TREE_TASKS_MOST; i++) {
        for (size_t b = 0; b < t->ranks.lists[i].block_count; b++)
            *full += t->ranks.lists[i].blocks[b].rank == 0;
        count += t->ranks.lists[i].block_count;
    }
    return count;
}

/* Charges of even density but for every seventh, which has three times as much. */
static void expect_close(const char *name, const conductor *s, bool expect_full) {
    treecode_rig r = treecode_rig_create(s, 2, CSCD_SIMD_AUTO),
                 one = treecode_rig_create(s, 1, CSCD_SIMD_SCALAR);
    double *charges = malloc(3 * r.system.count * sizeof *charges), worst = 0.0;
    assert_non_null(charges);
    double *potentials = charges + r.system.count, *same = potentials + r.system.count;
    for (uint32_t i = 0; i < r.system.count; i++)
        charges[i] = triangle_of(&r.t.tree, i)->area * (i % 7 == 0 ? 3.0 : 1.0);
    expect_ok(treecode_evaluate(&r.t, charges, potentials));
    expect_ok(treecode_evaluate(&one.t, charges, same));
    assert_memory_equal(same, potentials, r.system.count * sizeof *same);
    for (uint32_t i = 0; i < r.system.count; i += r.system.count / 300 + 1)
        worst = fmax(worst, fabs(potentials[i] / treecode_rig_exact_at(&r, charges, i) - 1.0));
    size_t full, count = count_blocks(&r.t, &full);
    print_message("%s, %u triangles: %zu blocks, %zu of them full; within %.1e\n", name, r.system.count,
                  count, full, worst);
    assert_true(worst < 2e-5);
    assert_true(count > 10 && (full > 0 || !expect_full));
    free(charges);
    treecode_rig_destroy(&r);
    treecode_rig_destroy(&one);
}

TEST(potentials_are_those_of_all_triangles) {
    for (int k = 0; k < KINDS; k++) {
        conductor s = conductor_extreme(kinds[k], 2 * SMALL);
        expect_close(extreme_kind_name(kinds[k]), &s, false);
        conductor_free(&s);
    }
    conductor crossing = crossing_needles();
    expect_close("crossing needles", &crossing, true);
    conductor_free(&crossing);
}

/* ---- growth ---------------------------------------------------------------------------------------------- */

static double bytes_of(extreme_kind kind, uint32_t count) {
    conductor s = conductor_extreme(kind, count);
    counting_allocator counter = counting_allocator_start();
    const cscd_allocator allocator = counting_allocator_interface(&counter);
    charge_rig r = charge_rig_create(&s, 1, &allocator);
    const size_t before = counter.bytes;
    expect_ok(charge_solve(r.mesh, s.positions, &by_coarse_tree, r.density, r.capacitance, NULL));
    const double bytes = (double)(counter.peak - before);
    charge_rig_destroy(&r);
    conductor_free(&s);
    return bytes;
}

/* Of one kind under sanitizers, which have nothing to say of it. */
TEST(memory_grows_with_the_triangles) {
    for (int k = 0; k < PACED(KINDS, 1); k++) {
        const double few = bytes_of(kinds[k], 2 * SMALL), many = bytes_of(kinds[k], 8 * SMALL);
        print_message("%s: %.0f and %.0f bytes a triangle\n", extreme_kind_name(kinds[k]), few / (2 * SMALL),
                      many / (8 * SMALL));
        assert_true(many < 4.0 * growth_most * few); /* 13 to 15 times as much without blocks */
    }
}
