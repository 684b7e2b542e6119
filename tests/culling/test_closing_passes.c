/* Scenes that need one, two and three closing passes, by construction.
 *
 * Two are rings: a profile in a plane, turned about the z axis. Some of its corners move, fully in the middle of a part
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
 *     closing pass 3:  C with D, both S+, but C is tainted
 *
 * The third scene is a mouth, in which no edge touches anything: all that happens is of a vertex and the one large triangle f
 * of its floor. */
#include "cscd/research.h"
#include "runtime/detector/detector.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/oracle.h"
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
static void check_passes(uint64_t expected) {
    oracle_list truth = {0};
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_SINGLE;
    oracle_find(&ring, &truth);
    rig r = rig_create(&ring, 1, &options);
    r.detector->interval.culling.detector_offsets[0][2] =
        -2000.0; /* the detector point, from the body's middle */
    cscd_contacts found = rig_step(&r, &ring);
    cscd_counters counters = cscd_detector_counters(r.detector);
    assert_int_equal(counters.clean, ring.triangle_count);
    assert_int_equal(found.count, truth.count);
    for (size_t i = 0; i < found.count; i++) {
        const oracle_contact *t = &truth.items[i];
        assert_true(found.items[i].kind == t->kind && found.items[i].a == t->a && found.items[i].b == t->b);
    }
    assert_int_equal(counters.passes, expected + 1);
    assert_true(counters.plus * 3 > ring.triangle_count);
    uint64_t facing[3] = {0, 0, 0};
    for (uint32_t i = 0; i < ring.triangle_count; i++) facing[1 + cscd_detector_orientation(r.detector, i)]++;
    assert_true(counters.minus == facing[0] && counters.plus == facing[2] && counters.minus > 0);
    assert_true(expect_one_number_everywhere(r.detector, true, "the end") > 0);
    rig_destroy(&r);
    oracle_free(&truth);
}

static void check_rings(const profile_corner *corners, uint32_t count, uint64_t expected) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        make_ring(corners, count, seed);
        check_passes(expected);
    }
}

TEST(two_closing_passes) {
    check_rings(two_passes, sizeof two_passes / sizeof *two_passes, 2);
}

TEST(three_closing_passes) {
    check_rings(three_passes, sizeof three_passes / sizeof *three_passes, 3);
}

/* ---- a mouth -------------------------------------------------------------------------------------------- */

/* The profile of a C that is open on the right, in x and z, counterclockwise: a front at y = -3 and a back at y = 3. */
enum {
    MOUTH_CORNERS = 9,
    FLOOR_AT = 2,
    PALATE_AT = 4,
    TOP_AT = 6,
    SPIKE = 2 * MOUTH_CORNERS,
    DIP,
    F_VERTICES
};

static const double mouth[MOUTH_CORNERS][2] = {{-4, -1}, {3, -1}, {3, 0},  {-3, 0}, {-3, 1.5},
                                               {3, 1.5}, {3, 2},  {-3, 2}, {-4, 2}};
static const uint32_t mouth_caps[7][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 8},
                                          {4, 7, 8}, {4, 5, 6}, {4, 6, 7}};
/* What is around f, whose corners are 4, 5 and 6, in a square with the corners 0 to 3; then f. */
static const uint32_t mouth_floor[8][3] = {{0, 1, 5}, {1, 6, 5}, {1, 2, 6}, {2, 4, 6},
                                           {2, 3, 4}, {3, 5, 4}, {3, 0, 5}, {4, 5, 6}};

static void add_triangle(uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t corners[3] = {a, b, c};
    memcpy(ring.triangles + (size_t)ring.triangle_count * 3, corners, sizeof corners);
    ring.triangle_count++;
}

/* rise: how far the vertex moves up. */
static void add_vertex(double x, double y, double z, double rise) {
    double *start = ring.x0 + (size_t)ring.vertex_count * 3, *end = ring.x1 + (size_t)ring.vertex_count * 3;
    const double at[3] = {x, y, z};
    for (int k = 0; k < 3; k++) start[k] = end[k] = at[k] + 0.01 * random_unit();
    end[2] += rise;
    ring.vertex_count++;
}

/* The square between two corners of the profile and those behind them, with the front's first. */
static void square_behind(uint32_t corner, uint32_t out[4]) {
    const uint32_t next = (corner + 1) % MOUTH_CORNERS;
    const uint32_t square[4] = {next, corner, corner + MOUTH_CORNERS, next + MOUTH_CORNERS};
    memcpy(out, square, sizeof square);
}

static void add_square(uint32_t corner) {
    uint32_t q[7];
    square_behind(corner, q);
    for (uint32_t i = 0; i < 3; i++) q[4 + i] = F_VERTICES + i;
    if (corner == FLOOR_AT) {
        for (int i = 0; i < 8; i++)
            add_triangle(q[mouth_floor[i][0]], q[mouth_floor[i][1]], q[mouth_floor[i][2]]);
    } else if (corner == PALATE_AT || corner == TOP_AT) {
        const uint32_t tip = corner == PALATE_AT ? SPIKE : DIP;
        for (int i = 0; i < 4; i++) add_triangle(q[i], q[(i + 1) % 4], tip);
    } else {
        add_triangle(q[0], q[1], q[2]);
        add_triangle(q[0], q[2], q[3]);
    }
}

/* The palate has a spike that points down, and the top above it a dip. The floor's middle, f, rises over both tips. */
static void make_mouth(uint64_t seed) {
    scene_clear(&ring);
    random_seed(seed);
    for (int side = -1; side <= 1; side += 2)
        for (int i = 0; i < MOUTH_CORNERS; i++) add_vertex(mouth[i][0], 3.0 * side, mouth[i][1], 0.0);
    add_vertex(0.0, 0.0, 0.5, 0.0);
    add_vertex(0.0, 0.0, 0.65, 0.0);
    for (int i = 0; i < 3; i++) {
        const double angle = PI / 2.0 + 2.0 * PI * i / 3.0;
        add_vertex(2.4 * cos(angle), 2.4 * sin(angle), 0.0, 0.76);
    }
    for (int i = 0; i < 7; i++) {
        const uint32_t *c = mouth_caps[i];
        add_triangle(c[0], c[1], c[2]);
        add_triangle(c[0] + MOUTH_CORNERS, c[2] + MOUTH_CORNERS, c[1] + MOUTH_CORNERS);
    }
    for (uint32_t i = 0; i < MOUTH_CORNERS; i++) add_square(i);
}

/* f passes the spike, which is S- and looked at; this taints f. The dip is S+ as f is: only in the closing pass f is looked at with
 * it. No other triangle of the two stars reaches the dip, so f itself must be tainted. */
TEST(faces_are_tainted) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        make_mouth(seed);
        check_passes(1);
    }
}
