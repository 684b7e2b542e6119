/* The oracle of the elementary tests itself: cases with a truth derived by hand, subdivision of time with
 * distances in floating point, and symmetries. */
#include "tests/support/ccd/algebraic_oracle.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/ccd/feature_distance.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>

typedef struct algebraic_case {
    const char *name;
    elementary_query query;
    double scale[3];
    long double toi; /* exact to long double; 2: never */
} algebraic_case;

#define UNIT                                                                                                 \
    { 1, 1, 1 }
#define NEVER 2
#define CORNER                                                                                               \
    {0, 0, 0}, {4, 0, 0}, {                                                                                  \
        0, 4, 0                                                                                              \
    }
/* A vertex, and the face in the corner of the plane z = 0. */
#define FALL(x0, y0, z0, x1, y1, z1) {{{x0, y0, z0}, CORNER}, {{x1, y1, z1}, CORNER}}, UNIT
#define SQRT_HALF                    0.70710678118654752440084436210484903928L
#define CBRT_HALF                    0.79370052598409973737585281963615413020L

static const algebraic_case vf_cases[] = {
    {"through the inside", FALL(1, 1, 1, 1, 1, -1), 1 / 2.0L},
    {"at a third", FALL(1, 1, 2, 1, 1, -1), 2 / 3.0L},
    {"beside the face", FALL(3, 2, 1, 3, 2, -1), NEVER},
    {"through a side", FALL(2, 2, 1, 2, 2, -1), 1 / 2.0L},
    {"through a corner", FALL(4, 0, 1, 4, 0, -1), 1 / 2.0L},
    {"an ulp beside a corner", FALL(4 + 0x1p-50, 0, 1, 4 + 0x1p-50, 0, -1), NEVER},
    {"an ulp beside a side", FALL(2 + 0x1p-51, 2, 1, 2 + 0x1p-51, 2, -1), NEVER},
    {"at the end only", FALL(1, 1, 1, 1, 1, 0), 1},
    {"the least bit short of it", FALL(1, 1, 1, 1, 1, 0x1p-300), NEVER},
    {"at the start only", FALL(1, 1, 0, 1, 1, 1), 0},
    {"off at once", FALL(1, 1, 0x1p-300, 1, 1, 1), NEVER},
    {"in the plane, over a side", FALL(-2, 1, 0, 2, 1, 0), 1 / 2.0L},
    {"in the plane, past it", FALL(5, 0, 0, 0, 5, 0), NEVER},
    {"in the plane, over a corner only", FALL(4, -2, 0, 4, 2, 0), 1 / 2.0L},
    {"in the plane, through all of it", FALL(-2, 1, 0, 8, 1, 0), 1 / 5.0L},
    {"in a tilted plane that moves",
     {{{-2, 1, -1}, {0, 0, 0}, {4, 0, 4}, {0, 4, 4}}, {{2, 1, 6}, {0, 0, 3}, {4, 0, 7}, {0, 4, 7}}},
     UNIT,
     0.5L},
    {"a face without area",
     {{{1, 0, 1}, {0, 0, 0}, {4, 0, 0}, {2, 0, 0}}, {{1, 0, -1}, {0, 0, 0}, {4, 0, 0}, {2, 0, 0}}},
     UNIT,
     0.5L},
    {"beside a face without area",
     {{{1, 1, 1}, {0, 0, 0}, {4, 0, 0}, {2, 0, 0}}, {{1, 1, -1}, {0, 0, 0}, {4, 0, 0}, {2, 0, 0}}},
     UNIT,
     NEVER},
    {"before a face without area",
     {{{5, 0, 1}, {0, 0, 0}, {4, 0, 0}, {2, 0, 0}}, {{5, 0, -1}, {0, 0, 0}, {4, 0, 0}, {2, 0, 0}}},
     UNIT,
     NEVER},
    {"a face that is a point",
     {{{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{2, 2, 2}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}},
     UNIT,
     0.5L},
    {"past a face that is a point",
     {{{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{2, 2, 3}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}},
     UNIT,
     NEVER},
    {"along a line",
     {{{0, 0, 0}, {4, 4, 4}, {6, 6, 6}, {5, 5, 5}}, {{6, 6, 6}, {4, 4, 4}, {6, 6, 6}, {5, 5, 5}}},
     UNIT,
     2 / 3.0L},
    {"along a line, not far enough",
     {{{0, 0, 0}, {4, 4, 4}, {6, 6, 6}, {5, 5, 5}}, {{3, 3, 3}, {4, 4, 4}, {6, 6, 6}, {5, 5, 5}}},
     UNIT,
     NEVER},
    {"no area at the moment of contact",
     {{{3, 0, 1}, {0, 0, 0}, {4, 0, 0}, {2, 1, 0}}, {{3, 0, -1}, {0, 0, 0}, {4, 0, 0}, {2, -1, 0}}},
     UNIT,
     0.5L},
    {"no area at the moment, beside",
     {{{5, 0, 1}, {0, 0, 0}, {4, 0, 0}, {2, 1, 0}}, {{5, 0, -1}, {0, 0, 0}, {4, 0, 0}, {2, -1, 0}}},
     UNIT,
     NEVER},
    {"grazes, height (t - 1/2)^2",
     {{{1, 1.5, -0.5}, {0, 0, 0}, {4, 0, 0}, {0, 4, -2}}, {{1, 0.5, 0.5}, {0, 0, 0}, {4, 0, 0}, {0, 4, 2}}},
     UNIT,
     0.5L},
    {"all but grazes",
     {{{1, 1.5, -0.5 + 0x1p-53}, {0, 0, 0}, {4, 0, 0}, {0, 4, -2}},
      {{1, 0.5, 0.5 + 0x1p-53}, {0, 0, 0}, {4, 0, 0}, {0, 4, 2}}},
     UNIT,
     NEVER},
    {"more than grazes",
     {{{1, 1.5, -0.5 - 0x1p-53}, {0, 0, 0}, {4, 0, 0}, {0, 4, -2}},
      {{1, 0.5, 0.5 - 0x1p-53}, {0, 0, 0}, {4, 0, 0}, {0, 4, 2}}},
     UNIT,
     0.5L - 0x1p-26L * SQRT_HALF},
    {"all through one point",
     {{{1, 1, 3}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{-1, -1, -3}, {-4, 0, 0}, {0, -4, 0}, {0, 0, -4}}},
     UNIT,
     0.5L},
    {"at rest, touching", FALL(1, 1, 0, 1, 1, 0), 0},
    {"at rest, apart", FALL(1, 1, 1, 1, 1, 1), NEVER},
    {"one motion", {{{1, 1, 1}, CORNER}, {{2, 2, 2}, {1, 1, 1}, {5, 1, 1}, {1, 5, 1}}}, UNIT, NEVER},
    {"one with a corner for good",
     {{{0, 0, 0}, CORNER}, {{2, 2, 2}, {2, 2, 2}, {5, 1, 7}, {1, 9, 1}}},
     UNIT,
     0},
    {"an irrational moment",
     {{{1, 1, -0.5}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 0, 0.5}, {0, 0, 0}, {4, 0, 0}, {0, 4, 4}}},
     UNIT,
     SQRT_HALF},
    {"an irrational moment, beside",
     {{{5, 1, -0.5}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{5, 0, 0.5}, {0, 0, 0}, {4, 0, 0}, {0, 4, 4}}},
     UNIT,
     NEVER},
    {"a cubic moment",
     {{{0, 0, 0}, {0, 0, -0.5}, {-1, 0, 0}, {0, -1, 0}}, {{0, 0, 0}, {1, 0, -0.5}, {-1, 1, 0}, {0, -1, 1}}},
     UNIT,
     CBRT_HALF},
    {"a cubic moment, beside",
     {{{0, 0, 0}, {0, 0, 0.5}, {-1, 0, 0}, {0, -1, 0}}, {{0, 0, 0}, {-1, 0, 0.5}, {-1, 1, 0}, {0, -1, 1}}},
     UNIT,
     NEVER},
    {"axes of all scales", {{{1, 1, 2}, CORNER}, {{1, 1, -1}, CORNER}}, {0x1p290, 0x1p-290, 1}, 2 / 3.0L},
    {"a cubic moment, all scales",
     {{{0, 0, 0}, {0, 0, -0.5}, {-1, 0, 0}, {0, -1, 0}}, {{0, 0, 0}, {1, 0, -0.5}, {-1, 1, 0}, {0, -1, 1}}},
     {0x1p-290, 1, 0x1p290},
     CBRT_HALF},
};

/* The edge along x from -1 to 1 at rest, and another. */
#define LYING                                                                                                \
    {-1, 0, 0}, {                                                                                            \
        1, 0, 0                                                                                              \
    }

static const algebraic_case ee_cases[] = {
    {"cross", {{LYING, {0, -1, 1}, {0, 1, 1}}, {LYING, {0, -1, -1}, {0, 1, -1}}}, UNIT, 0.5L},
    {"at a third", {{LYING, {0, -1, 2}, {0, 1, 2}}, {LYING, {0, -1, -1}, {0, 1, -1}}}, UNIT, 2 / 3.0L},
    {"beside the end", {{LYING, {2, -1, 1}, {2, 1, 1}}, {LYING, {2, -1, -1}, {2, 1, -1}}}, UNIT, NEVER},
    {"an end on an edge", {{LYING, {1, -1, 1}, {1, 1, 1}}, {LYING, {1, -1, -1}, {1, 1, -1}}}, UNIT, 0.5L},
    {"an ulp beside the end",
     {{LYING, {1 + 0x1p-52, -1, 1}, {1 + 0x1p-52, 1, 1}},
      {LYING, {1 + 0x1p-52, -1, -1}, {1 + 0x1p-52, 1, -1}}},
     UNIT,
     NEVER},
    {"end meets end", {{LYING, {1, 0, 1}, {1, 2, 1}}, {LYING, {1, 0, -1}, {1, 2, -1}}}, UNIT, 0.5L},
    {"parallel, side by side", {{LYING, {0, 1, 0}, {2, 1, 0}}, {LYING, {0, -1, 0}, {2, -1, 0}}}, UNIT, 0.5L},
    {"parallel, beyond the end",
     {{LYING, {2, 1, 0}, {3, 1, 0}}, {LYING, {2, -1, 0}, {3, -1, 0}}},
     UNIT,
     NEVER},
    {"parallel, end to end", {{LYING, {1, 1, 0}, {3, 1, 0}}, {LYING, {1, -1, 0}, {3, -1, 0}}}, UNIT, 0.5L},
    {"along a line", {{LYING, {2, 0, 0}, {3, 0, 0}}, {LYING, {0.5, 0, 0}, {1.5, 0, 0}}}, UNIT, 2 / 3.0L},
    {"along a line, not far enough",
     {{LYING, {2, 0, 0}, {3, 0, 0}}, {LYING, {1.5, 0, 0}, {4, 0, 0}}},
     UNIT,
     NEVER},
    {"an edge that is a point", {{LYING, {0, 0, 1}, {0, 0, 1}}, {LYING, {0, 0, -1}, {0, 0, -1}}}, UNIT, 0.5L},
    {"past an edge that is a point",
     {{LYING, {0, 1, 1}, {0, 1, 1}}, {LYING, {0, 1, -1}, {0, 1, -1}}},
     UNIT,
     NEVER},
    {"two points",
     {{{0, 0, 0}, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}}, {{0, 0, 0}, {0, 0, 0}, {-1, -1, -1}, {-1, -1, -1}}},
     UNIT,
     0.5L},
    {"two points pass",
     {{{0, 0, 0}, {0, 0, 0}, {1, 1, 2}, {1, 1, 2}}, {{0, 0, 0}, {0, 0, 0}, {-1, -1, -1}, {-1, -1, -1}}},
     UNIT,
     NEVER},
    {"no length at the moment of contact",
     {{{0, -1, 0}, {0, 1, 0}, {-1, 0, 1}, {1, 0, 1}}, {{0, -1, 0}, {0, 1, 0}, {1, 0, -1}, {-1, 0, -1}}},
     UNIT,
     0.5L},
    {"no length at the moment, beside",
     {{{0, -1, 0}, {0, 1, 0}, {-1, 3, 1}, {1, 3, 1}}, {{0, -1, 0}, {0, 1, 0}, {1, 3, -1}, {-1, 3, -1}}},
     UNIT,
     NEVER},
    {"in a plane",
     {{{0, 0, 0}, {4, 0, 0}, {1, 2, 0}, {1, 3, 0}}, {{0, 0, 0}, {4, 0, 0}, {1, -1, 0}, {1, 0, 0}}},
     UNIT,
     2 / 3.0L},
    {"in a tilted plane that moves",
     {{{0, 0, 0}, {4, 0, 4}, {1, 2, 3}, {1, 3, 4}}, {{0, 0, 5}, {4, 0, 9}, {1, -1, 5}, {1, 0, 6}}},
     UNIT,
     2 / 3.0L},
    {"scissors that close",
     {{{-2, 2, 0}, {2, -2, 0}, {1, 0, 0}, {6, 0, 0}}, {{-2, 0, 0}, {2, 0, 0}, {0, 0, 0}, {5, 0, 0}}},
     UNIT,
     1},
    {"scissors that all but close",
     {{{-2, 2, 0}, {2, -2, 0}, {1, 0x1p-300, 0}, {6, 0x1p-300, 0}},
      {{-2, 0, 0}, {2, 0, 0}, {0, 0x1p-300, 0}, {5, 0x1p-300, 0}}},
     UNIT,
     NEVER},
    {"at the end only", {{LYING, {0, -1, 1}, {0, 1, 1}}, {LYING, {0, -1, 0}, {0, 1, 0}}}, UNIT, 1},
    {"at the start only", {{LYING, {0, -1, 0}, {0, 1, 0}}, {LYING, {0, -1, 1}, {0, 1, 1}}}, UNIT, 0},
    {"grazes, height (t - 1/2)^2",
     {{{-2, 0, 0}, {2, 0, 0}, {0, -1.5, 1}, {0, 2.5, -1}},
      {{-2, 0, 0}, {2, 0, 0}, {0, -2.5, -1}, {0, 1.5, 1}}},
     UNIT,
     0.5L},
    {"all but grazes",
     {{{-2, 0, 0}, {2, 0, 0}, {0, -1.5, 1 + 0x1p-52}, {0, 2.5, -1 + 0x1p-52}},
      {{-2, 0, 0}, {2, 0, 0}, {0, -2.5, -1 + 0x1p-52}, {0, 1.5, 1 + 0x1p-52}}},
     UNIT,
     NEVER},
    {"more than grazes",
     {{{-2, 0, 0}, {2, 0, 0}, {0, -1.5, 1 - 0x1p-52}, {0, 2.5, -1 - 0x1p-52}},
      {{-2, 0, 0}, {2, 0, 0}, {0, -2.5, -1 - 0x1p-52}, {0, 1.5, 1 - 0x1p-52}}},
     UNIT,
     0.5L - 0x1p-26L},
    {"all through one point",
     {{{1, 1, 1}, {2, 1, 1}, {1, 2, 7}, {1, 3, 4}}, {{-1, -1, -1}, {-2, -1, -1}, {-1, -2, -7}, {-1, -3, -4}}},
     UNIT,
     0.5L},
    {"an irrational moment",
     {{{-2, 0, 0}, {2, 0, 0}, {0, -2, -0.5}, {0, 2, -0.5}},
      {{-2, 0, 0}, {2, 0, 0}, {0, -3, -2.5}, {0, 1, 1.5}}},
     UNIT,
     SQRT_HALF},
    {"at rest, crossed", {{LYING, {0, -1, 0}, {0, 1, 0}}, {LYING, {0, -1, 0}, {0, 1, 0}}}, UNIT, 0},
    {"at rest, apart", {{LYING, {0, -1, 1}, {0, 1, 1}}, {LYING, {0, -1, 1}, {0, 1, 1}}}, UNIT, NEVER},
    {"one with the other", {{LYING, LYING}, {{3, 3, 3}, {4, 5, 6}, {3, 3, 3}, {4, 5, 6}}}, UNIT, 0},
    {"axes of all scales",
     {{LYING, {0, -1, 2}, {0, 1, 2}}, {LYING, {0, -1, -1}, {0, 1, -1}}},
     {0x1p-290, 0x1p290, 1},
     2 / 3.0L},
    /* at t = 1, x and z in units of 2^-17 and 1/8: (4,-2)-(3,3) and (4,3)-(1,1) cross */
    {"all of it in a plane at the end",
     {{{-1, -4, 4}, {2, -3, 3}, {2, -3, -2}, {-2, 4, -1}}, {{4, -3, -2}, {3, -3, 3}, {4, -3, 3}, {1, -3, 1}}},
     {0x1p-17, 0x1p8, 0x1p-3},
     1},
};

static elementary_query scaled_axes(const elementary_query *query, const double scale[3]) {
    elementary_query out;
    for (int i = 0; i < 12; i++) {
        out.x0[i / 3][i % 3] = query->x0[i / 3][i % 3] * scale[i % 3];
        out.x1[i / 3][i % 3] = query->x1[i / 3][i % 3] * scale[i % 3];
    }
    return out;
}

static void check_known(cscd_contact_kind kind, const algebraic_case *known, size_t count) {
    for (size_t i = 0; i < count; i++) {
        elementary_query query = scaled_axes(&known[i].query, known[i].scale);
        oracle_verdict found = algebraic_oracle(kind, &query);
        long double toi = known[i].toi;
        bool right = found.touching == (toi <= 1) && found.toi_low <= toi * (1 + 0x1p-62L) &&
                     found.toi_high >= toi * (1 - 0x1p-62L) && nextafter(found.toi_low, 2) >= found.toi_high;
        if ((double)toi == toi) right = right && found.toi_low == found.toi_high;
        if (!right) fail_msg("%s: %.17g .. %.17g", known[i].name, found.toi_low, found.toi_high);
    }
    printf("%zu known cases\n", count);
}

TEST(known_vf) {
    check_known(CSCD_CONTACT_VF, vf_cases, sizeof vf_cases / sizeof *vf_cases);
}

TEST(known_ee) {
    check_known(CSCD_CONTACT_EE, ee_cases, sizeof ee_cases / sizeof *ee_cases);
}

/* ---- subdivision ---- */

enum { SUBDIVIDED = PACED(300, 60) };

typedef struct subdivided {
    uint32_t hits, misses, open;
} subdivided;

/* Contacts are close at their time, and nothing is before it; where there is none, nothing is at any time,
 * but for near misses that are too close to tell. */
static void check_by_subdivision(cscd_contact_kind kind, const elementary_query *query, subdivided *counts) {
    oracle_verdict verdict = algebraic_oracle(kind, query);
    if (verdict.touching) {
        counts->hits++;
        assert_true(feature_distance(kind, query, verdict.toi_low) <= 0x1p-50L * largest_coordinate(query));
        counts->open +=
            verdict.toi_low > 0x1p-12 && !proved_apart(kind, query, 0, verdict.toi_low - 0x1p-12, 0);
    } else {
        bool apart = proved_apart(kind, query, 0, 1, 0);
        counts->misses += apart;
        counts->open += !apart;
    }
}

TEST(agrees_with_subdivision) {
    random_stream random = stream_start(21);
    for (int family = 0; family < FAMILY_NUDGED; family++) {
        subdivided counts = {0, 0, 0};
        for (int i = 0; i < 2 * SUBDIVIDED; i++) {
            elementary_query query = exact_query(&random, (cscd_contact_kind)(i % 2), (query_family)family);
            check_by_subdivision((cscd_contact_kind)(i % 2), &query, &counts);
        }
        printf("%-15s %4u contacts, %4u misses, %3u too close to tell\n",
               query_family_name((query_family)family), counts.hits, counts.misses, counts.open);
        assert_true(counts.open <= (family < FAMILY_DOUBLE_ROOT ? SUBDIVIDED / 10 : SUBDIVIDED));
    }
}

/* ---- symmetries ---- */

enum { SYMMETRIC = PACED(500, 100) };

static void assert_same(cscd_contact_kind kind, const elementary_query *query, oracle_verdict expected) {
    oracle_verdict found = algebraic_oracle(kind, query);
    assert_true(found.touching == expected.touching && found.simple == expected.simple);
    assert_true(found.toi_low == expected.toi_low && found.toi_high == expected.toi_high);
}

static elementary_query axes_turned(const elementary_query *query) {
    elementary_query out;
    for (int i = 0; i < 12; i++) {
        out.x0[i / 3][i % 3] = query->x0[i / 3][(i + 1) % 3];
        out.x1[i / 3][i % 3] = query->x1[i / 3][(i + 1) % 3];
    }
    return out;
}

static void check_symmetries(cscd_contact_kind kind, const elementary_query *query) {
    static const int vf_orders[2][4] = {{0, 2, 3, 1}, {0, 2, 1, 3}},
                     ee_orders[2][4] = {{1, 0, 2, 3}, {2, 3, 0, 1}};
    oracle_verdict verdict = algebraic_oracle(kind, query);
    for (int i = 0; i < 2; i++) {
        elementary_query other = query_permuted(query, kind == CSCD_CONTACT_VF ? vf_orders[i] : ee_orders[i]);
        assert_same(kind, &other, verdict);
    }
    elementary_query turned = axes_turned(query), reversed = query_reversed(query);
    assert_same(kind, &turned, verdict);
    elementary_query scaled = scaled_axes(query, (const double[3]){0x1p-9, 1, 0x1p20});
    assert_same(kind, &scaled, verdict);
    assert_true(algebraic_oracle(kind, &reversed).touching == verdict.touching);
}

TEST(has_the_symmetries) {
    random_stream random = stream_start(22);
    for (int i = 0; i < 2 * SYMMETRIC * FAMILY_COUNT; i++) {
        cscd_contact_kind kind = (cscd_contact_kind)(i % 2);
        elementary_query query = generate_query(&random, kind, (query_family)(i / 2 % FAMILY_COUNT));
        check_symmetries(kind, &query);
    }
}

static int finish_oracle(void **state) {
    (void)state;
    algebraic_oracle_finish();
    return 0;
}

AROUND_ALL(NULL, finish_oracle)
