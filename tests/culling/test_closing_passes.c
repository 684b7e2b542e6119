/* Scenes that need two and three closing passes, by construction.
 *
 * Each is a ring: a profile in a plane, turned about the z axis. Some of its corners move, fully in the middle of a part
 * of the ring and less towards its ends. The detector point is far below, so all that faces upwards is S+, and its pairs
 * are culled; what faces downwards is S-, and so are its pairs. Upwards from below, a ray passes through
 *
 *     A (+), the floor of a hollow that is open on the left only through the gap between B and N;
 *     M (-) and B (+), underside and top of a tongue in that hollow, whose tip V points to the right;
 *     N (-) and C (+), underside and top of a lip above the tongue, which hangs on the right.
 *
 * A and N meet at the edge e, at the hollow's right end. e moves to the left over the tongue, so that A passes through M
 * and through B, and then A and N are gone there. Now nothing is between B and C any more, and C comes down to B.
 *
 *     at first:        A with M, of different signs;            this taints A
 *     closing pass 1:  A with B, both S+, but A is tainted;     this taints B
 *     closing pass 2:  B with C, both S+, but B is tainted;     this taints C
 *
 * For a third one, an overhang with underside O (-) and top D (+) lies above the lip. B and O meet at the edge f, at the
 * left. f moves to the right over the lip, after B has passed through C, and then B and O are gone. Nothing is between C
 * and D any more, and D comes down to C.
 *
 *     closing pass 3:  C with D, both S+, but C is tainted */
#include "runtime/detector/detector.h"
#include "tests/support/culling/exact_numbers.h"
#include "tests/support/oracle.h"
#include "tests/support/packed.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { ROWS = 16, MIDDLE_ROW = 8, SEEDS = 3 };

/* A corner of the profile at the start, and its way. The inside is on the left when corners are followed in order. */
typedef struct profile_corner {
    double x, z, way_x, way_z;
} profile_corner;

static const profile_corner two_passes[] = {
    {-6, -3, 0, 0},     {6, -3, 0, 0},      {6, 3, 0, 0},     {3, 3, 0, 0}, /* C */
    {1, 3, 0, 0},       {0.3, 3, 0, -3.05}, {-0.4, 3, 0, 0},  {-2, 3, 0, 0},
    {-4, 3, 0, 0},      {-4, 1, 0, 0},    /* N */
    {2, 0, -2.5, 0.6},                    /* e, then A */
    {-2.5, -0.7, 0, 0}, {-4, -1, 0, 0},   /* the tongue's root, then M */
    {-1, -0.15, 0, 0},  {1, -0.05, 0, 0}, /* V, then B */
    {0.75, 0, 0, 0},    {-0.15, 0.1, 0, 0}, {-2, 0.12, 0, 0}, {-5, 0.2, 0, 0},
    {-5, 3, 0, 0},      {-6, 3, 0, 0},
};

static const profile_corner three_passes[] = {
    {-20, -3, 0, 0},         {14, -3, 0, 0},          {14, 2.3, 0, 0},           {8.5, 2.3, 0, 0}, /* C */
    {5, 2.3, 0, 0},          {3, 2.3, 0, -1.9},       {0, 2.3, 0, -1.9},         {-4, 2.3, 0, 0},
    {-10, 2.05, 0, 0},       {-17.2, 1.7, 0, 0},  /* the lip's tip, then N */
    {9, 0.3, -25.7, 1.3},                         /* e, then A */
    {7.5, -0.8, -24.6, 0.3}, {-17.5, -0.4, 0, 0}, /* the tongue's root, then M */
    {8, -0.05, 0, 0},                             /* V, then B */
    {6, 0.1, 1.7, 1.1},      {1, 0.1, 6.4, 1.5},      {-5, 0.1, 12.1, 1.5},      {-11, 0.1, 17.8, 1.5},
    {-14, 0.1, 20.6, 1.5},   {-16.5, 0.1, 22.9, 1.5}, {-18.2, 1.85, 24.27, 1.2}, /* f, then O */
    {12, 3.4, 0, 0},         {12, 22, 0, 0},                                     /* D */
    {3.5, 22, 0, 0},         {1.5, 22, 0, -21.9},     {-0.5, 22, 0, 0},          {-20, 22, 0, 0},
};

static scene ring; /* large; one test at a time */

/* How much of its way a row goes: all of it in the middle, nothing from five rows on. */
static double share_of(int row) {
    return fmin(1.0, 1.6 * fmax(0.0, 1.0 - abs(row - MIDDLE_ROW) / 5.0));
}

static void place_corner(double x, double z, double angle, double *out) {
    const double radius = 40.0;
    out[0] = (radius + x) * cos(angle);
    out[1] = (radius + x) * sin(angle);
    out[2] = z;
}

/* Everything is shaken a little, so that contacts are in general position. */
static void place_row(const profile_corner *corners, uint32_t count, int row) {
    const double shake = 0.01;
    for (uint32_t j = 0; j < count; j++) {
        const profile_corner *c = &corners[j];
        double x = c->x + shake * random_unit(), z = c->z + shake * random_unit();
        double angle = 2.0 * PI * row / ROWS + 0.02 * shake * random_unit();
        place_corner(x, z, angle, ring.x0 + (size_t)ring.vertex_count * 3);
        x += share_of(row) * c->way_x + shake * random_unit();
        z += share_of(row) * c->way_z + shake * random_unit();
        place_corner(x, z, angle, ring.x1 + (size_t)ring.vertex_count * 3);
        ring.vertex_count++;
    }
}

static void make_ring(const profile_corner *corners, uint32_t count, uint64_t seed) {
    scene_clear(&ring);
    random_seed(seed);
    for (int row = 0; row < ROWS; row++) place_row(corners, count, row);
    for (uint32_t row = 0; row < ROWS; row++) {
        for (uint32_t j = 0; j < count; j++) {
            uint32_t here = row * count, there = (row + 1) % ROWS * count, next = (j + 1) % count;
            const uint32_t quad[6] = {here + j, there + j, there + next, here + j, there + next, here + next};
            memcpy(ring.triangles + (size_t)ring.triangle_count * 3, quad, sizeof quad);
            ring.triangle_count += 2;
        }
    }
}

/* Brute force, and what culling finds, are the same list; the last pass finds nothing more. */
static void check_passes(const profile_corner *corners, uint32_t count, uint64_t expected) {
    oracle_list truth = {0};
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_SINGLE;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        make_ring(corners, count, seed);
        oracle_find(&ring, &truth);
        rig r = rig_create(&ring, 1, &options);
        r.detector->culling.detector_offsets[0][2] =
            -2000.0; /* the detector point, from the middle of the ring */
        cscd_contacts found = rig_step(&r, &ring);
        cscd_counters counters = cscd_detector_counters(r.detector);
        assert_int_equal(counters.clean, ring.triangle_count);
        assert_true(counters.plus * 3 > ring.triangle_count * 2);
        assert_int_equal(found.count, truth.count);
        for (size_t i = 0; i < found.count; i++) {
            const oracle_contact *t = &truth.items[i];
            assert_true(found.items[i].kind == t->kind && found.items[i].a == t->a &&
                        found.items[i].b == t->b);
        }
        assert_int_equal(counters.passes, expected + 1);
        assert_true(expect_one_number_everywhere(r.detector, true, "the ring's end") > 0);
        rig_destroy(&r);
    }
    oracle_free(&truth);
}

static void two_closing_passes(void **state) {
    (void)state;
    check_passes(two_passes, sizeof two_passes / sizeof *two_passes, 2);
}

static void three_closing_passes(void **state) {
    (void)state;
    check_passes(three_passes, sizeof three_passes / sizeof *three_passes, 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_closing_passes),
        cmocka_unit_test(three_closing_passes),
    };
    return cmocka_run_group_tests_name("closing_passes", tests, NULL, NULL);
}
