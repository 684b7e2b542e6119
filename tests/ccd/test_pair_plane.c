/* Gaps between features at rest, and planes that prove them, against rational numbers. */
#include "runtime/ccd/ccd.h"
#include "runtime/ccd/exact.h"
#include "tests/support/random.h"
#include "tests/support/solver/exact_distance.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

typedef double points[4][3];

/* ---- pairs --------------------------------------------------------------------------------------------- */

typedef enum pair_family {
    PAIR_RANDOM,
    PAIR_GRID,   /* small integers: parallel, coplanar, coincident */
    PAIR_NEAR,   /* a small step above a point of the other feature */
    PAIR_THIN,   /* points close to a line */
    PAIR_FLOATS, /* far from the origin, as floats */
    PAIR_POINTS, /* features without length or area */
    PAIR_FAMILY_COUNT
} pair_family;

static void random_points(double size, points x) {
    for (int i = 0; i < 12; i++) x[i / 3][i % 3] = size * random_unit();
}

/* Moves the first feature next to a point of the other one. */
static void bring_near(cscd_contact_kind kind, double height, points x) {
    double u = random_between(0.0, 0.5), v = random_between(0.0, 0.5), side[3];
    for (int k = 0; k < 3; k++) side[k] = height * random_unit();
    int base = kind == CSCD_CONTACT_VF ? 1 : 2;
    for (int k = 0; k < 3; k++) {
        double at =
            x[base][k] + u * (x[base + 1][k] - x[base][k]) + (base == 1 ? v * (x[3][k] - x[1][k]) : 0.0);
        double move = at + side[k] - (base == 1 ? x[0][k] : (1.0 - v) * x[0][k] + v * x[1][k]);
        for (int i = 0; i < base; i++) x[i][k] += move;
    }
}

static void make_thin(points x) {
    double along[3], width = ldexp(1.0, random_integer(-60, -2));
    for (int k = 0; k < 3; k++) along[k] = random_unit();
    for (int i = 0; i < 4; i++) {
        double place = random_unit();
        for (int k = 0; k < 3; k++) x[i][k] = place * along[k] + width * random_unit();
    }
}

static void make_pair(pair_family family, cscd_contact_kind kind, points x) {
    random_points(1.0, x);
    if (family == PAIR_GRID || family == PAIR_POINTS) {
        for (int i = 0; i < 12; i++) x[i / 3][i % 3] = 0.25 * random_integer(-2, 2);
    }
    if (family == PAIR_POINTS) memcpy(x[3], x[2], sizeof x[3]);
    if (family == PAIR_POINTS && random_integer(0, 1) == 1)
        memcpy(x[1], x[kind == CSCD_CONTACT_VF ? 2 : 0], sizeof x[1]);
    if (family == PAIR_THIN) make_thin(x);
    if (family == PAIR_NEAR) bring_near(kind, ldexp(1.0, random_integer(-70, -1)), x);
    if (family == PAIR_FLOATS) {
        bring_near(kind, ldexp(1.0, random_integer(-20, -1)), x);
        for (int i = 0; i < 12; i++) x[i / 3][i % 3] = (double)(float)(1000.0 + x[i / 3][i % 3]);
    }
    if (random_integer(0, 7) == 0) {
        double scale = ldexp(1.0, random_integer(-240, 240));
        for (int i = 0; i < 12; i++) x[i / 3][i % 3] *= scale;
    }
}

/* Half of all lengths are just about the distance. */
static double make_length(const pair_plane *plane) {
    switch (random_integer(0, 3)) {
    case 0:
        return 0.0;
    case 1:
        return plane->distance * random_between(0.1, 1.5);
    case 2:
        return plane->distance * (1.0 - ldexp(1.0, random_integer(-60, -2)));
    default:
        return plane->gap > 0.0 ? plane->gap : 0.0;
    }
}

/* ---- checks -------------------------------------------------------------------------------------------- */

/* The gap is at most the distance less the length, and at least `share` of that. */
static void check_gap(cscd_contact_kind kind, const points x, double length, double share, double gap) {
    const double(*p)[3] = (const double(*)[3])x;
    assert_true(gap >= 0.0 && gap < INFINITY);
    if (gap > 0.0) assert_true(distance_sign_of_sum(kind, p, length, gap, 1.0) >= 0);
    double most = gap > 0.0 ? gap : 0x1p-352;
    assert_true(distance_sign_of_sum(kind, p, length, most, share) <= 0);
}

/* The heights are those of the points, up to their error, and the gap lies between them. */
static void check_plane(cscd_contact_kind kind, const points x, const pair_plane *plane) {
    const double(*p)[3] = (const double(*)[3])x;
    long double length = 0.0L, extent = 0.0L;
    for (int k = 0; k < 3; k++) length += (long double)plane->normal[k] * plane->normal[k];
    assert_true(fabsl(sqrtl(length) - 1.0L) <= 0x1p-50L);
    for (int i = 0; i < 12; i++)
        extent = fmaxl(extent, fabsl((long double)x[i / 3][i % 3] - (long double)x[0][i % 3]));
    for (int i = 0; i < 4; i++) {
        long double height = 0.0L;
        for (int k = 0; k < 3; k++)
            height += (long double)plane->normal[k] * ((long double)x[i][k] - (long double)x[0][k]);
        assert_true(fabsl(height - plane->height[i]) <= 0x1p-49L * extent);
        bool of_a = i < points_of_first(kind);
        assert_true(of_a ? plane->height[i] >= plane->low_a : plane->height[i] <= plane->high_b);
    }
    assert_true(plane->gap < plane->low_a - plane->high_b);
    assert_true(distance_sign_of_sum(kind, p, plane->gap, 0.0, 1.0) > 0);
}

/* The plane across the connection of the nearest points, as a search describes it, is as sound as any other. */
static bool check_plane_along(cscd_contact_kind kind, const points x) {
    elementary_query query;
    elementary_contact nearest = {.toi = 0.0};
    pair_plane plane;
    double weights[4];
    memcpy(query.x0, x, sizeof query.x0);
    memcpy(query.x1, x, sizeof query.x1);
    separation_describe(&query, kind, &nearest);
    cscd_stencil_weights(kind, nearest.u, nearest.v, weights);
    if (!pair_plane_along(kind, x, weights, nearest.normal, &plane)) return false;
    check_plane(kind, x, &plane);
    assert_true(plane.gap >= 0.985 * plane.distance);
    assert_true(distance_sign_of_sum(kind, x, plane.distance, 0.0, 1.0) <= 0);
    return true;
}

TEST(gaps_equal_rational_numbers) {
    int proven = 0, blocked = 0, along = 0;
    random_seed(1);
    for (int i = 0; i < 4500; i++) {
        cscd_contact_kind kind = i % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
        points x;
        pair_plane plane;
        make_pair((pair_family)(i / 2 % PAIR_FAMILY_COUNT), kind, x);
        const double(*p)[3] = (const double(*)[3])x;
        pair_plane_find(kind, p, &plane);
        assert_true(plane.gap == 0.0 || distance_sign_of_sum(kind, p, plane.distance, 0.0, 1.0) <= 0);
        double length = make_length(&plane), gap = pair_gap(kind, p, length);
        if (plane.gap > 0.0) check_plane(kind, x, &plane);
        check_gap(kind, x, length, 0.985, gap);
        check_gap(kind, x, length, 1.0 - 0x1p-39, exact_gap(kind, p, length));
        proven += plane.gap > 0.0;
        blocked += gap == 0.0;
        along += check_plane_along(kind, p);
    }
    print_message("  %d planes along the connection\n", along);
    assert_true(proven > 2000 && blocked > 700 && along > 1000);
}

/* What the exact level is for: a step of one unit in the last place above a face, where no plane in doubles helps. */
TEST(the_least_gaps_are_found) {
    const points above = {{0.25, 0.25, 0x1p-52}, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    double gap = pair_gap(CSCD_CONTACT_VF, above, 0.0);
    assert_true(gap <= 0x1p-52 && gap >= 0x1p-52 * (1.0 - 0x1p-39));
    const points tilted = {{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {1.1, 0.7, 0.4}, {-0.3, 0.9, 0.1}};
    assert_true(pair_gap(CSCD_CONTACT_VF, tilted, 0.0) == 0.0);
    const points crossing = {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}};
    assert_true(pair_gap(CSCD_CONTACT_EE, crossing, 0.0) == 0.0);
    const points apart = {{0.0, 0.0, 3.0}, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    gap = pair_gap(CSCD_CONTACT_VF, apart, 3.0 - 0x1p-51);
    assert_true(gap <= 0x1p-51 && gap >= 0x1p-51 * (1.0 - 0x1p-39));
    assert_true(pair_gap(CSCD_CONTACT_VF, apart, 3.0) == 0.0);
}
