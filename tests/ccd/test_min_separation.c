/* Minimum separation where the answer is known by hand: regions, degenerate features, grazing, the bound on
 * work.
 */
#include "tests/support/ccd/separation_check.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static separation separation_within(double distance) {
    return (separation){distance, 1e-6 * distance};
}

/* ---- one approach for each region ------------------------------------------------------------------- */

typedef struct known {
    const char *name;
    cscd_contact_kind kind;
    elementary_query query;
    double distance, toi, u, v; /* u below 0: any, the nearest points are not unique */
    double point[3], normal[3];
} known;

/* The face, and one edge, that the approaches below lead to: at rest. */
#define FACE                                                                                                 \
    {0, 0, 0}, {4, 0, 0}, {                                                                                  \
        0, 4, 0                                                                                              \
    }
#define EDGE                                                                                                 \
    {-1, 0, 0}, {                                                                                            \
        1, 0, 0                                                                                              \
    }

static const known approaches[] = {
    {"face",
     CSCD_CONTACT_VF,
     {{{1, 1, 3}, FACE}, {{1, 1, -1}, FACE}},
     0.5,
     0.625,
     0.25,
     0.25,
     {1, 1, 0.25},
     {0, 0, 1}},
    {"face from below",
     CSCD_CONTACT_VF,
     {{{1, 2, -3}, FACE}, {{1, 2, 1}, FACE}},
     1,
     0.5,
     0.25,
     0.5,
     {1, 2, -0.5},
     {0, 0, -1}},
    {"side",
     CSCD_CONTACT_VF,
     {{{2, -3, 0}, FACE}, {{2, 1, 0}, FACE}},
     1,
     0.5,
     0.5,
     0,
     {2, -0.5, 0},
     {0, -1, 0}},
    {"long side",
     CSCD_CONTACT_VF,
     {{{5, 5, 0}, FACE}, {{1, 1, 0}, FACE}},
     1.4142135623730951,
     0.5,
     0.5,
     0.5,
     {2.5, 2.5, 0},
     {0.70710678118654757, 0.70710678118654757, 0}},
    {"corner",
     CSCD_CONTACT_VF,
     {{{-3, -4, 0}, FACE}, {{0, 0, 0}, FACE}},
     1,
     0.8,
     0,
     0,
     {-0.3, -0.4, 0},
     {-0.6, -0.8, 0}},
    {"face moves",
     CSCD_CONTACT_VF,
     {{{1, 1, 5}, FACE}, {{1, 1, 5}, {0, 0, 4}, {4, 0, 4}, {0, 4, 4}}},
     2,
     0.75,
     0.25,
     0.25,
     {1, 1, 4},
     {0, 0, 1}},
    {"crossing edges",
     CSCD_CONTACT_EE,
     {{{0, -1, 3}, {0, 3, 3}, EDGE}, {{0, -1, -1}, {0, 3, -1}, EDGE}},
     0.5,
     0.625,
     0.25,
     0.5,
     {0, 0, 0.25},
     {0, 0, 1}},
    {"edge and end",
     CSCD_CONTACT_EE,
     {{{0, 5, 0}, {0, 3, 0}, EDGE}, {{0, 3, 0}, {0, 1, 0}, EDGE}},
     2,
     0.5,
     1,
     0.5,
     {0, 1, 0},
     {0, 1, 0}},
    {"ends",
     CSCD_CONTACT_EE,
     {{{5, 0, 0}, {9, 0, 0}, EDGE}, {{2, 0, 0}, {6, 0, 0}, EDGE}},
     1,
     1,
     0,
     1,
     {1.5, 0, 0},
     {1, 0, 0}},
    {"parallel edges",
     CSCD_CONTACT_EE,
     {{{-2, 0, 4}, {2, 0, 4}, EDGE}, {{-2, 0, 0}, {2, 0, 0}, EDGE}},
     1,
     0.75,
     -1,
     0,
     {0, 0, 0.5},
     {0, 0, 1}},
};

static void check_known(const known *k) {
    separation limit = separation_within(k->distance);
    elementary_contact hit;
    bool bounded;
    print_message("  %s\n", k->name);
    assert_true(check_separation(k->kind, &k->query, &limit, &bounded));
    assert_false(bounded);
    assert_true(separation_test(k->kind, &k->query, &limit, &hit, &bounded));
    assert_true(hit.toi <= k->toi && hit.toi >= k->toi - 1e-5);
    for (int i = 0; i < 3; i++) {
        if (k->u >= 0.0 || k->normal[i] != 0.0) assert_true(fabs(hit.point[i] - k->point[i]) <= 1e-5);
        assert_true(fabs(hit.normal[i] - k->normal[i]) <= 1e-9);
    }
    if (k->u >= 0.0) assert_true(fabs(hit.u - k->u) <= 1e-9 && fabs(hit.v - k->v) <= 1e-9);
}

TEST(all_regions) {
    for (size_t i = 0; i < sizeof approaches / sizeof *approaches; i++) check_known(&approaches[i]);
}

/* At rest at their distance, or nearer, or just beyond; and flying apart. */
TEST(distance_is_closed) {
    elementary_query query = {{{1, 1, 0.5}, FACE}, {{1, 1, 0.5}, FACE}};
    elementary_contact hit;
    bool bounded;
    for (int flies = 0; flies < 2; flies++) {
        query.x1[0][2] = flies ? 7.0 : 0.5;
        separation limit = separation_within(0.5), less = separation_within(0.5 * (1 - 1e-5)),
                   more = separation_within(2.0);
        assert_true(separation_vf(&query, &limit, &hit, &bounded) && hit.toi == 0.0 && !bounded);
        assert_true(separation_vf(&query, &more, &hit, &bounded) && hit.toi == 0.0 && !bounded);
        assert_true(hit.normal[2] == 1.0 && hit.point[2] == 0.25 && hit.u == 0.25 && hit.v == 0.25);
        assert_false(separation_vf(&query, &less, &hit, &bounded));
    }
}

/* Touching at the start: the direction is the features' own, against the motion. */
TEST(touching_at_the_start) {
    elementary_query query = {{{1, 1, 0}, FACE}, {{1, 1, 2}, FACE}};
    separation limit = separation_within(0.25);
    elementary_contact hit;
    bool bounded;
    assert_true(separation_vf(&query, &limit, &hit, &bounded) && hit.toi == 0.0);
    assert_true(hit.normal[0] == 0.0 && hit.normal[1] == 0.0 && hit.normal[2] == -1.0);
    query.x1[0][2] = -2.0;
    assert_true(separation_vf(&query, &limit, &hit, &bounded) && hit.normal[2] == 1.0);
    memset(&query, 0, sizeof query); /* four points in one place have no direction */
    assert_true(separation_ee(&query, &limit, &hit, &bounded) && hit.toi == 0.0);
    assert_true(hit.normal[0] == 0.0 && hit.normal[1] == 0.0 && hit.normal[2] == 0.0);
}

/* ---- degenerate features ---------------------------------------------------------------------------- */

static const elementary_query degenerate[] = {
    {{{1, 0, 3}, {0, 0, 0}, {1, 0, 0}, {4, 0, 0}},
     {{1, 0, -1}, {0, 0, 0}, {1, 0, 0}, {4, 0, 0}}}, /* a line */
    {{{1, 0, 3}, {0, 0, 0}, {4, 0, 0}, {0, 0, 0}}, {{1, 0, -1}, {0, 0, 0}, {4, 0, 0}, {0, 0, 0}}},
    {{{1, 0, 3}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}},
     {{1, 0, -1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}}}, /* a point */
    {{{1, 0, 3}, {1, 0, 3}, {1, 0, 0}, {1, 0, 0}}, {{1, 0, -1}, {1, 0, -1}, {1, 0, 0}, {1, 0, 0}}},
    {{{1, 0, 3}, {1, 0, 3}, {0, 0, 0}, {4, 0, 0}}, {{1, 0, -1}, {1, 0, -1}, {0, 0, 0}, {4, 0, 0}}},
};

TEST(lines_and_points) {
    for (size_t i = 0; i < sizeof degenerate / sizeof *degenerate; i++) {
        separation limit = separation_within(1.0);
        elementary_contact hit;
        bool bounded;
        cscd_contact_kind kind = i < 3 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
        assert_true(check_separation(kind, &degenerate[i], &limit, &bounded) && !bounded);
        separation_test(kind, &degenerate[i], &limit, &hit, &bounded);
        assert_true(hit.toi <= 0.5 && hit.toi > 0.5 - 1e-6 && fabs(hit.normal[2] - 1.0) < 1e-9);
        limit = separation_within(1e-9);
        assert_true(check_separation(kind, &degenerate[i], &limit, &bounded) && !bounded);
    }
}

/* ---- grazing ---------------------------------------------------------------------------------------- */

/* Passes a corner, or the end of an edge, at height h. */
static elementary_query passing_query(cscd_contact_kind kind, double h) {
    if (kind == CSCD_CONTACT_VF)
        return (elementary_query){{{-3, 0, h}, {0, 0, 0}, {4, 3, -1}, {4, -3, -1}},
                                  {{3, 0, h}, {0, 0, 0}, {4, 3, -1}, {4, -3, -1}}};
    return (elementary_query){{{-3, -1, h}, {-3, 1, h}, {0, 0, 0}, {4, 0, -4}},
                              {{3, -1, h}, {3, 1, h}, {0, 0, 0}, {4, 0, -4}}};
}

TEST(grazing_contacts) {
    for (int exponent = 0; exponent > -20; exponent--) {
        for (int kind = 0; kind < 2; kind++) {
            double d = ldexp(1.0, exponent);
            separation limit = separation_within(d);
            elementary_query exact = passing_query((cscd_contact_kind)kind, d),
                             far = passing_query((cscd_contact_kind)kind, d * (1 + 1e-3)),
                             near = passing_query((cscd_contact_kind)kind, d * (1 - 1e-9));
            elementary_contact hit;
            bool bounded;
            assert_true(check_separation((cscd_contact_kind)kind, &exact, &limit, &bounded) && !bounded);
            assert_false(check_separation((cscd_contact_kind)kind, &far, &limit, &bounded));
            assert_true(check_separation((cscd_contact_kind)kind, &near, &limit, &bounded) && !bounded);
            separation_test((cscd_contact_kind)kind, &near, &limit, &hit, &bounded);
            assert_true(hit.toi < 0.5 && hit.toi > 0.5 - 1e-3);
        }
    }
}

/* ---- sizes ------------------------------------------------------------------------------------------ */

/* Distances far beyond and far below what the coordinates resolve, and at the ends of the range. */
TEST(extreme_distances) {
    elementary_query through = {{{1, 1, 1}, FACE}, {{1, 1, -1}, FACE}}, past = through;
    past.x0[0][0] = past.x1[0][0] = -1e-6;
    elementary_contact hit;
    bool bounded;
    static const double tiny[] = {1e-10, 1e-20, 1e-60, 0x1p-300};
    for (size_t i = 0; i < sizeof tiny / sizeof *tiny; i++) {
        separation limit = separation_within(tiny[i]);
        assert_true(separation_vf(&through, &limit, &hit, &bounded) && !bounded);
        assert_true(hit.toi <= 0.5 && hit.toi > 0.5 - 1e-9);
        assert_false(separation_vf(&past, &limit, &hit, &bounded));
    }
    separation huge = separation_within(0x1p300);
    assert_true(separation_vf(&past, &huge, &hit, &bounded) && hit.toi == 0.0 && !bounded);
    for (int exponent = -298; exponent <= 296; exponent += 99) {
        elementary_query scaled = query_scaled(&through, exponent);
        separation limit = {ldexp(0.5, exponent), ldexp(0.5, exponent - 20)};
        assert_true(separation_vf(&scaled, &limit, &hit, &bounded) && !bounded);
        assert_true(hit.toi <= 0.25 && hit.toi > 0.25 - 1e-6);
        elementary_query apart = query_scaled(&through, exponent);
        for (int i = 0; i < 4; i++) apart.x0[i][2] = apart.x1[i][2] = i == 0 ? ldexp(1.0, exponent) : 0.0;
        assert_false(separation_vf(&apart, &limit, &hit, &bounded));
    }
}

/* Of points that differ in the last bits of coordinates: nothing between them is resolved, nothing may be
 * lost. */
TEST(next_to_each_other) {
    elementary_query query;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            query.x0[i][k] = 1e6 + ldexp((i * 5 + k * 3) % 7, -33);
            query.x1[i][k] = 1e6 + ldexp((i * 3 + k * 5) % 7, -33);
        }
    }
    for (int exponent = -60; exponent < 0; exponent++) {
        separation limit = separation_within(ldexp(1.0, exponent));
        bool bounded;
        check_separation(CSCD_CONTACT_VF, &query, &limit, &bounded);
        check_separation(CSCD_CONTACT_EE, &query, &limit, &bounded);
    }
}

/* A vertex at the distance from a face's corner along an axis or a diagonal, anywhere: none of the directions
 * that are asked first takes them apart. */
TEST(along_the_directions) {
    static const double places[] = {0.0, 1.0, -1.5, 1e6, -1e9};
    static const double directions[][4] = {
        {1, 0, 0, 1}, {0, 0, -1, 1}, {1, 1, 1, 1.7320508075688774}, {-1, 1, 1, 1.7320508075688774}};
    for (int i = 0; i < 4 * 5; i++) {
        const double *direction = directions[i % 4];
        for (int exponent = -260; exponent <= 250; exponent += 10) {
            elementary_query query;
            for (int k = 0; k < 3; k++) {
                double corner = places[i / 4], away = direction[k];
                query.x0[0][k] = ldexp(corner + away, exponent);
                query.x0[1][k] = ldexp(corner, exponent);
                query.x0[2][k] = ldexp(corner - 2.0 * away + (k == 0), exponent);
                query.x0[3][k] = ldexp(corner - 2.0 * away + (k == 1), exponent);
            }
            memcpy(query.x1, query.x0, sizeof query.x1);
            elementary_contact hit;
            bool bounded = false;
            separation near = separation_within(ldexp(direction[3] * (1.0 + 0x1p-40), exponent));
            separation far = separation_within(ldexp(direction[3] * 0.998, exponent));
            assert_true(separation_vf(&query, &near, &hit, &bounded));
            assert_false(separation_vf(&query, &far, &hit, &bounded));
        }
    }
}

/* ---- the bound on work ------------------------------------------------------------------------------ */

/* The face is spanned by (1, s, s) and (-s, 1, s) about the origin, for s from -1 to 1, and so turns about
 * two axes; the vertex stays above the origin at a distance from 2e-9 to 2.13e-9. No plane that turns at a
 * constant rate stays between them for long: it would take some 10^5 of them. */
static const elementary_query twisting = {{{1e-9, 1e-9, 2e-9}, {-1, 0, 1}, {1, -2, -1}, {1, 2, -1}},
                                          {{-1e-9, -1e-9, 2e-9}, {0, -1, -1}, {2, 1, 1}, {-2, 1, 1}}};

TEST(bound_on_work) {
    separation limit = separation_within(1e-9);
    elementary_contact hit;
    bool bounded = false;
    assert_true(check_separation(CSCD_CONTACT_VF, &twisting, &limit, &bounded));
    assert_true(bounded);
    separation_vf(&twisting, &limit, &hit, &bounded);
    assert_true(hit.toi > 0.0 && hit.toi < 0.5);
    elementary_query diving = twisting; /* early, not late */
    diving.x1[0][2] = -3.0;
    assert_true(check_separation(CSCD_CONTACT_VF, &diving, &limit, &bounded));
}
