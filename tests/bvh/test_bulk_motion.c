/* Bodies that fly a hundred times their length within an interval have the same pairs and contacts as at
 * rest. */
#include "cscd/research.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>

/* Positions and translations that are multiples of this unit add up exactly. */
#define GRID_UNIT 0x1p-20

enum { CONTACTS_MAX = 20000, SEED_COUNT = 3 };

static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_ICCD};
enum { METHOD_COUNT = sizeof methods / sizeof *methods };

static scene at_rest, in_flight; /* large; one test at a time */

typedef struct contact_set {
    size_t count;
    cscd_contact items[CONTACTS_MAX];
    cscd_counters counters;
} contact_set;

static contact_set expected, found;

static int compare_pairs(const void *left, const void *right) {
    const cscd_contact *a = left, *b = right;
    if (a->kind != b->kind) return a->kind < b->kind ? -1 : 1;
    if (a->a != b->a) return a->a < b->a ? -1 : 1;
    return (a->b > b->b) - (a->b < b->b);
}

static void step_motion(const scene *s, cscd_method method, cscd_mode mode, contact_set *out) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.mode = mode;
    rig r = rig_create(s, 1, &options);
    cscd_contacts contacts = rig_step(&r, s);
    assert_true(contacts.count <= CONTACTS_MAX);
    out->count = contacts.count;
    out->counters = cscd_detector_counters(r.detector);
    for (size_t i = 0; i < contacts.count; i++) out->items[i] = contacts.items[i];
    qsort(out->items, out->count, sizeof *out->items, compare_pairs);
    rig_destroy(&r);
}

/* Compares the contacts of both. Their times are found by other sums, so the last bits may differ. */
static void assert_same_contacts(void) {
    assert_int_equal(found.count, expected.count);
    for (size_t i = 0; i < found.count; i++) {
        assert_int_equal(compare_pairs(&found.items[i], &expected.items[i]), 0);
        assert_true(fabs(found.items[i].toi - expected.items[i].toi) <= 1e-6);
    }
}

static void round_to_grid(scene *s) {
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) {
        s->x0[i] = rint(s->x0[i] / GRID_UNIT) * GRID_UNIT;
        s->x1[i] = rint(s->x1[i] / GRID_UNIT) * GRID_UNIT;
    }
}

static double body_length(const scene *s) {
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < s->vertex_count; i++) {
        low = fmin(low, s->x0[(size_t)i * 3]);
        high = fmax(high, s->x0[(size_t)i * 3]);
    }
    return high - low;
}

/* Moves all bodies by one translation, a multiple of `unit`; 0 allows any translation. */
static void fly_along(const scene *from, double unit, scene *out) {
    static const double start[3] = {0.31, -0.7, 1.9}, end[3] = {77.7, -50.1, 38.3};
    double length = body_length(from), by[2][3];
    for (int k = 0; k < 3; k++) {
        by[0][k] = length * start[k];
        by[1][k] = length * end[k];
        if (unit > 0.0) by[0][k] = rint(by[0][k] / unit) * unit;
        if (unit > 0.0) by[1][k] = rint(by[1][k] / unit) * unit;
    }
    *out = *from;
    translate(out->x0, out->vertex_count, by[0]);
    translate(out->x1, out->vertex_count, by[1]);
}

/* Calls check for the body at rest and the body in flight, for each scene, method and mode. */
static void for_all(double unit, int first_family, int end_family, void (*check)(void)) {
    for (int i = first_family * SEED_COUNT; i < end_family * SEED_COUNT; i++) {
        scene_make((scene_family)(i / SEED_COUNT), (uint64_t)(500 + i % SEED_COUNT), &at_rest);
        round_to_grid(&at_rest);
        fly_along(&at_rest, unit, &in_flight);
        for (int k = 0; k < 2 * METHOD_COUNT; k++) {
            cscd_mode mode = k % 2 == 0 ? CSCD_MODE_ALL : CSCD_MODE_EARLIEST;
            step_motion(&at_rest, method_or_none(methods[k / 2]), mode, &expected);
            step_motion(&in_flight, method_or_none(methods[k / 2]), mode, &found);
            assert_same_contacts();
            check();
        }
    }
}

static void check_same_work(void) {
    const cscd_counters *a = &expected.counters, *b = &found.counters;
    assert_int_equal(a->boxes_tested, b->boxes_tested);
    assert_int_equal(a->pcp, b->pcp);
    assert_int_equal(a->feature_pairs, b->feature_pairs);
    assert_int_equal(a->tests, b->tests);
    assert_int_equal(a->plus, b->plus);
    assert_int_equal(a->minus, b->minus);
    assert_int_equal(a->sealed, b->sealed);
}

TEST(same_where_the_sums_are_exact) {
    for_all(GRID_UNIT, 0, SCENE_FAMILY_COUNT, check_same_work);
}

static uint64_t sums[2][2];

static void add_work(void) {
    sums[0][0] += expected.counters.pcp;
    sums[0][1] += expected.counters.tests;
    sums[1][0] += found.counters.pcp;
    sums[1][1] += found.counters.tests;
}

/* Scenes in generic position: all families before the grid. */
TEST(nearly_the_same_where_they_are_not) {
    for_all(0.0, 0, SCENE_GRID, add_work);
    for (int i = 0; i < 2; i++) {
        print_message("at rest %llu, in flight %llu\n", (unsigned long long)sums[0][i],
                      (unsigned long long)sums[1][i]);
        assert_true(fabs((double)sums[1][i] - (double)sums[0][i]) <= 1e-3 * (double)sums[0][i]);
    }
}
