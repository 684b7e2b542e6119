/* Chains of intervals through deep intersections and back: after each, all triangles that are called clean have one
 * winding number, counted exactly, and each finds what is found without culling. */
#include "cscd/cscd.h"
#include "runtime/detector/detector.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <string.h>

enum { SEEDS = 6 };

/* From one of these shares of the scene's motion to the next: beyond its end parts go through each other, and have others
 * cut off; then they come apart. */
static const double shares[] = {0.0, 1.0, 1.9, 2.0, 2.1, 1.4, 0.0};

enum { SHARES = sizeof shares / sizeof *shares };

static scene motion, interval; /* large; one test at a time */

typedef struct chain_tally {
    uint32_t clean, crossing; /* triangles, over all moments */
    uint32_t cut_off;         /* free, with another number than clean ones */
} chain_tally;

static void place_interval(double from, double to) {
    for (uint32_t i = 0; i < motion.vertex_count * 3; i++) {
        double way = motion.x1[i] - motion.x0[i];
        interval.x0[i] = motion.x0[i] + from * way;
        interval.x1[i] = motion.x0[i] + to * way;
    }
}

/* Free triangles that must not be called clean, in the components of which less than half is. */
static uint32_t count_cut_off(const cscd_detector *d, const int *numbers) {
    uint32_t found = 0;
    for (uint32_t t = 0; t < d->mesh->triangle_count; t++) {
        int number;
        if (d->known.starts.triangles[t] != TRIANGLE_FREE) continue;
        bool decided = exact_number_outside(d->mesh, d->known.starts.positions, t, &number);
        found += decided && number != numbers[d->mesh->triangle_components[t]];
    }
    return found;
}

/* Checks the moment that the detector has seen last, as a static check and the steps since have left it. */
static void check_moment(const cscd_detector *d, const char *where, chain_tally *sum) {
    int numbers[SCENE_TRIANGLES_MAX] = {0};
    sum->clean += expect_one_number_everywhere(d, false, where);
    for (uint32_t t = 0; t < d->mesh->triangle_count; t++) {
        sum->crossing += d->known.starts.triangles[t] == TRIANGLE_CROSSING;
        if (d->known.starts.triangles[t] == TRIANGLE_CLEAN)
            exact_number_outside(d->mesh, d->known.starts.positions, t,
                                 &numbers[d->mesh->triangle_components[t]]);
    }
    sum->cut_off += count_cut_off(d, numbers);
}

static void step_both(const rig *culled, const rig *plain, const char *where) {
    cscd_contacts found = rig_step(culled, &interval), truth = rig_step(plain, &interval);
    if (found.count != truth.count)
        fail_msg("%s: %zu contacts, without culling %zu", where, found.count, truth.count);
    assert_true(found.count == 0 || memcmp(found.items, truth.items, found.count * sizeof *found.items) == 0);
}

/* Intervals that begin elsewhere than the last one has ended: apart, then where parts go through each other, and back. */
static const double jumps[][2] = {{0.0, 0.5}, {2.0, 1.2}, {0.2, 0.6}, {1.9, 2.1}, {0.0, 0.3}, {2.1, 1.4}};

enum { JUMPS = sizeof jumps / sizeof *jumps };

/* All that is clean is culled, however little that is. */
static void make_rigs(rig *plain, rig *culled) {
    cscd_detector_options options = cscd_detector_defaults();
    *plain = rig_create(&motion, 1, &options);
    options.method = CSCD_METHOD_SINGLE;
    *culled = rig_create(&motion, 1, &options);
    culled->detector->known.starts.share_worth_it = 0.0;
}

/* Each start is checked. */
static void run_chain(scene_family family, uint64_t seed, chain_tally *sum) {
    rig plain, culled;
    scene_make(family, seed, &motion);
    interval = motion;
    make_rigs(&plain, &culled);
    for (int i = 0; i + 1 < SHARES; i++) {
        char where[128];
        cscd_intersections crossing;
        snprintf(where, sizeof where, "%s, seed %u, at %.1f", scene_family_name(family), (unsigned)seed,
                 shares[i + 1]);
        place_interval(shares[i], shares[i + 1]);
        step_both(&culled, &plain, where);
        check_moment(culled.detector, where, sum);
        assert_int_equal(check_packed(culled.detector, interval.x1, &crossing), CSCD_OK);
        check_moment(culled.detector, where, sum);
    }
    rig_destroy(&culled);
    rig_destroy(&plain);
}

static void run_jumps(scene_family family, uint64_t seed, chain_tally *sum) {
    rig plain, culled;
    scene_make(family, seed, &motion);
    interval = motion;
    make_rigs(&plain, &culled);
    for (int i = 0; i < JUMPS; i++) {
        char where[128];
        snprintf(where, sizeof where, "%s, seed %u, %.1f to %.1f", scene_family_name(family), (unsigned)seed,
                 jumps[i][0], jumps[i][1]);
        place_interval(jumps[i][0], jumps[i][1]);
        step_both(&culled, &plain, where);
        check_moment(culled.detector, where, sum);
    }
    rig_destroy(&culled);
    rig_destroy(&plain);
}

static const scene_family families[] = {SCENE_NOISY_SPHERE, SCENE_BENT_CAPSULE, SCENE_SQUASHED_TORUS,
                                        SCENE_NESTED_SPHERES, SCENE_SPIKE};

TEST(intervals_begin_elsewhere) {
    chain_tally sum = {0, 0, 0};
    for (size_t f = 0; f < sizeof families / sizeof *families; f++)
        for (uint64_t seed = 0; seed < SEEDS; seed++) run_jumps(families[f], seed, &sum);
    assert_true(sum.clean > 0);
}

TEST(clean_triangles_have_one_number) {
    chain_tally all = {0, 0, 0};
    for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
        chain_tally sum = {0, 0, 0};
        for (uint64_t seed = 0; seed < SEEDS; seed++) run_chain(families[f], seed, &sum);
        print_message("  %-15s %7u clean, %6u crossing, %5u cut off\n", scene_family_name(families[f]),
                      sum.clean, sum.crossing, sum.cut_off);
        all.clean += sum.clean;
        all.crossing += sum.crossing;
        all.cut_off += sum.cut_off;
    }
    assert_true(all.clean > 0 && all.crossing > 0 && all.cut_off > 100);
}
