/* Elementary tests on configurations with a known first contact: in a plane, on a line, zero sizes, at rest.
 */
#include "runtime/ccd/ccd.h"
#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <string.h>

static int seed_random(void **state) {
    (void)state;
    random_seed(6);
    return 0;
}

/* An integer shear along each axis in turn, by the same factors for all: planes, lines and parameters stay
 * what they are, coordinate planes do not. */
static elementary_query query_sheared(const elementary_query *query, const int f[6]) {
    elementary_query out = *query;
    for (int i = 0; i < 8; i++) {
        double *p = i < 4 ? out.x0[i] : out.x1[i - 4];
        p[0] += f[0] * p[1] + f[1] * p[2];
        p[1] += f[2] * p[0] + f[3] * p[2];
        p[2] += f[4] * p[0] + f[5] * p[1];
    }
    return out;
}

typedef struct known_case {
    const char *name;
    cscd_contact_kind kind;
    double toi; /* of the first contact; 2: none */
    double x0[4][3], x1[4][3];
} known_case;

static const known_case in_a_plane[] = {
    {"a vertex slides in over the side p1 p2",
     CSCD_CONTACT_VF,
     0.5,
     {{4, 4, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{0, 0, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
    {"a vertex slides in over the side p0 p1, which moves",
     CSCD_CONTACT_VF,
     0.25,
     {{1, -2, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{1, 2, 0}, {0, -4, 0}, {4, -4, 0}, {0, 4, 0}}},
    {"a vertex slides onto the corner p0",
     CSCD_CONTACT_VF,
     0.75,
     {{-3, -3, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
    {"a vertex slides past the corner p1, touching it",
     CSCD_CONTACT_VF,
     0.5,
     {{4, -2, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{4, 2, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
    {"a vertex slides past the corner p1, missing it",
     CSCD_CONTACT_VF,
     2,
     {{5, -2, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{5, 2, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
    {"a vertex starts inside",
     CSCD_CONTACT_VF,
     0,
     {{1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{9, 9, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
    {"a vertex stops before the side",
     CSCD_CONTACT_VF,
     2,
     {{4, 4, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{3, 3, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
    {"an edge's end reaches the other edge",
     CSCD_CONTACT_EE,
     0.5,
     {{0, 1, 0}, {0, 3, 0}, {-2, 0, 0}, {2, 0, 0}},
     {{0, -1, 0}, {0, 1, 0}, {-2, 0, 0}, {2, 0, 0}}},
    {"crossing edges from the start",
     CSCD_CONTACT_EE,
     0,
     {{0, -1, 0}, {0, 3, 0}, {-2, 0, 0}, {2, 0, 0}},
     {{0, 5, 0}, {0, 9, 0}, {-2, 0, 0}, {2, 0, 0}}},
    {"an edge turns in the plane onto the other's end",
     CSCD_CONTACT_EE,
     0.5,
     {{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, 4, 0}},
     {{0, 0, 0}, {4, 4, 0}, {2, 1, 0}, {2, 4, 0}}},
    {"edges pass in the plane side by side",
     CSCD_CONTACT_EE,
     2,
     {{3, 1, 0}, {3, 3, 0}, {-2, 0, 0}, {2, 0, 0}},
     {{3, -3, 0}, {3, -1, 0}, {-2, 0, 0}, {2, 0, 0}}},
    {"parallel edges approach sideways",
     CSCD_CONTACT_EE,
     0.75,
     {{0, 3, 0}, {4, 3, 0}, {1, 0, 0}, {6, 0, 0}},
     {{0, -1, 0}, {4, -1, 0}, {1, 0, 0}, {6, 0, 0}}},
    {"parallel edges approach and slide along each other",
     CSCD_CONTACT_EE,
     0.75,
     {{-4, 3, 0}, {0, 3, 0}, {1, 0, 0}, {6, 0, 0}},
     {{0, -1, 0}, {4, -1, 0}, {3, 0, 0}, {8, 0, 0}}},
    {"parallel edges pass each other beyond their ends",
     CSCD_CONTACT_EE,
     2,
     {{-4, 3, 0}, {0, 3, 0}, {1, 0, 0}, {6, 0, 0}},
     {{-4, -1, 0}, {0, -1, 0}, {1, 0, 0}, {6, 0, 0}}},
    {"parallel edges stay apart",
     CSCD_CONTACT_EE,
     2,
     {{0, 1, 0}, {4, 1, 0}, {1, 0, 0}, {6, 0, 0}},
     {{2, 1, 0}, {6, 1, 0}, {1, 0, 0}, {6, 0, 0}}},
    {"antiparallel edges slide onto each other",
     CSCD_CONTACT_EE,
     0.5,
     {{4, 2, 0}, {0, 2, 0}, {0, 0, 0}, {4, 0, 0}},
     {{4, -2, 0}, {0, -2, 0}, {0, 0, 0}, {4, 0, 0}}},
};

static const known_case on_a_line[] = {
    {"edges meet end to end",
     CSCD_CONTACT_EE,
     0.5,
     {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {6, 0, 0}},
     {{0, 0, 0}, {2, 0, 0}, {0, 0, 0}, {2, 0, 0}}},
    {"an edge grows to the other",
     CSCD_CONTACT_EE,
     0.25,
     {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
     {{0, 0, 0}, {5, 0, 0}, {2, 0, 0}, {3, 0, 0}}},
    {"edges stop before they meet",
     CSCD_CONTACT_EE,
     2,
     {{0, 0, 0}, {2, 0, 0}, {5, 0, 0}, {7, 0, 0}},
     {{0, 0, 0}, {2, 0, 0}, {3, 0, 0}, {5, 0, 0}}},
    {"edges overlap from the start",
     CSCD_CONTACT_EE,
     0,
     {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {7, 0, 0}},
     {{0, 0, 0}, {2, 0, 0}, {3, 0, 0}, {5, 0, 0}}},
    {"a vertex meets a face that is a segment of its line",
     CSCD_CONTACT_VF,
     0.5,
     {{0, 0, 0}, {4, 0, 0}, {6, 0, 0}, {5, 0, 0}},
     {{8, 0, 0}, {4, 0, 0}, {6, 0, 0}, {5, 0, 0}}},
    {"the same, the middle corner first",
     CSCD_CONTACT_VF,
     0.25,
     {{9, 0, 0}, {5, 0, 0}, {6, 0, 0}, {8, 0, 0}},
     {{5, 0, 0}, {5, 0, 0}, {6, 0, 0}, {8, 0, 0}}},
    {"a vertex stops before it",
     CSCD_CONTACT_VF,
     2,
     {{0, 0, 0}, {4, 0, 0}, {6, 0, 0}, {5, 0, 0}},
     {{3, 0, 0}, {4, 0, 0}, {6, 0, 0}, {5, 0, 0}}},
};

static const known_case shrunken[] = {
    {"a face that is a segment, hit from the side",
     CSCD_CONTACT_VF,
     0.5,
     {{2, 1, 3}, {0, 0, 0}, {4, 0, 0}, {3, 0, 0}},
     {{2, -1, -3}, {0, 0, 0}, {4, 0, 0}, {3, 0, 0}}},
    {"the same, missed",
     CSCD_CONTACT_VF,
     2,
     {{5, 1, 3}, {0, 0, 0}, {4, 0, 0}, {3, 0, 0}},
     {{5, -1, -3}, {0, 0, 0}, {4, 0, 0}, {3, 0, 0}}},
    {"the same, passed at a distance",
     CSCD_CONTACT_VF,
     2,
     {{2, 2, 3}, {0, 0, 0}, {4, 0, 0}, {3, 0, 0}},
     {{2, -1, -3}, {0, 0, 0}, {4, 0, 0}, {3, 0, 0}}},
    {"a face that is a point, hit",
     CSCD_CONTACT_VF,
     0.5,
     {{1, 2, 3}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
     {{-1, -2, -3}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}},
    {"a face that is a point, missed",
     CSCD_CONTACT_VF,
     2,
     {{1, 2, 3}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
     {{-1, -2, -2}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}},
    {"a face shrinks to a segment when the vertex arrives",
     CSCD_CONTACT_VF,
     0.5,
     {{2, 0, 2}, {0, 0, 0}, {4, 0, 0}, {2, 4, 0}},
     {{2, 0, -2}, {0, 0, 0}, {4, 0, 0}, {2, -4, 0}}},
    {"a face shrinks to a point when the vertex arrives",
     CSCD_CONTACT_VF,
     0.5,
     {{0, 0, 2}, {-4, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{0, 0, -2}, {4, 0, 0}, {-4, 0, 0}, {0, -4, 0}}},
    {"an edge that is a point, hit",
     CSCD_CONTACT_EE,
     0.5,
     {{1, 2, 3}, {1, 2, 3}, {-2, 0, 0}, {2, 0, 0}},
     {{-1, -2, -3}, {-1, -2, -3}, {-2, 0, 0}, {2, 0, 0}}},
    {"an edge that is a point, missed",
     CSCD_CONTACT_EE,
     2,
     {{3, 2, 3}, {3, 2, 3}, {-2, 0, 0}, {2, 0, 0}},
     {{3, -2, -3}, {3, -2, -3}, {-2, 0, 0}, {2, 0, 0}}},
    {"two edges that are points meet",
     CSCD_CONTACT_EE,
     0.75,
     {{3, 6, 9}, {3, 6, 9}, {0, 0, 0}, {0, 0, 0}},
     {{-1, -2, -3}, {-1, -2, -3}, {0, 0, 0}, {0, 0, 0}}},
    {"two edges that are points pass",
     CSCD_CONTACT_EE,
     2,
     {{3, 6, 9}, {3, 6, 9}, {0, 0, 0}, {0, 0, 0}},
     {{-1, -2, -2}, {-1, -2, -2}, {0, 0, 0}, {0, 0, 0}}},
    {"an edge turns inside out at the moment of contact",
     CSCD_CONTACT_EE,
     0.5,
     {{-1, 0, 2}, {1, 0, 2}, {0, -2, 0}, {0, 2, 0}},
     {{1, 0, -2}, {-1, 0, -2}, {0, -2, 0}, {0, 2, 0}}},
    {"all four points meet in one: a triple root",
     CSCD_CONTACT_VF,
     0.25,
     {{1, 1, 3}, {2, 0, 0}, {0, 2, 0}, {-1, -1, 0}},
     {{-3, -3, -9}, {-6, 0, 0}, {0, -6, 0}, {3, 3, 0}}},
    {"the same of edges",
     CSCD_CONTACT_EE,
     0.25,
     {{1, 1, 3}, {2, 0, 0}, {0, 2, 0}, {-1, -1, 0}},
     {{-3, -3, -9}, {-6, 0, 0}, {0, -6, 0}, {3, 3, 0}}},
};

static const known_case at_rest[] = {
    {"a vertex inside", CSCD_CONTACT_VF, 0, {{1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0}}},
    {"a vertex on a side", CSCD_CONTACT_VF, 0, {{2, 2, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0}}},
    {"a vertex on a corner", CSCD_CONTACT_VF, 0, {{0, 4, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0}}},
    {"a vertex beside, in the plane",
     CSCD_CONTACT_VF,
     2,
     {{3, 2, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{0}}},
    {"a vertex above", CSCD_CONTACT_VF, 2, {{1, 1, 1}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0}}},
    {"a vertex on a face that is a segment",
     CSCD_CONTACT_VF,
     0,
     {{1, 1, 1}, {0, 0, 0}, {4, 4, 4}, {2, 2, 2}},
     {{0}}},
    {"a vertex beyond a face that is a segment",
     CSCD_CONTACT_VF,
     2,
     {{5, 5, 5}, {0, 0, 0}, {4, 4, 4}, {2, 2, 2}},
     {{0}}},
    {"four points in one", CSCD_CONTACT_VF, 0, {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {{0}}},
    {"edges that cross", CSCD_CONTACT_EE, 0, {{0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}}, {{0}}},
    {"edges that share an end", CSCD_CONTACT_EE, 0, {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 1}}, {{0}}},
    {"edges that form a T", CSCD_CONTACT_EE, 0, {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}}, {{0}}},
    {"edges skew", CSCD_CONTACT_EE, 2, {{0, -1, 1}, {0, 1, 1}, {-1, 0, 0}, {1, 0, 0}}, {{0}}},
    {"the same edge twice", CSCD_CONTACT_EE, 0, {{0, -1, 1}, {0, 1, 1}, {0, 1, 1}, {0, -1, 1}}, {{0}}},
    {"edges in a plane, apart", CSCD_CONTACT_EE, 2, {{0, 1, 0}, {0, 3, 0}, {-1, 0, 0}, {1, 0, 0}}, {{0}}},
    {"edges on a line, apart", CSCD_CONTACT_EE, 2, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {{0}}},
    {"two points, apart", CSCD_CONTACT_EE, 2, {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}}, {{0}}},
};

/* Degenerate at the only time at which the points are coplanar; touches at the ends of the interval; times
 * that are no fractions. */
static const known_case momentary[] = {
    {"a face shrinks to a segment when the vertex passes beyond it",
     CSCD_CONTACT_VF,
     2,
     {{5, 0, 2}, {0, 0, 0}, {4, 0, 0}, {2, 4, 0}},
     {{5, 0, -2}, {0, 0, 0}, {4, 0, 0}, {2, -4, 0}}},
    {"the same at its end",
     CSCD_CONTACT_VF,
     0.5,
     {{4, 0, 2}, {0, 0, 0}, {4, 0, 0}, {2, 4, 0}},
     {{4, 0, -2}, {0, 0, 0}, {4, 0, 0}, {2, -4, 0}}},
    {"a face shrinks to a point when the vertex passes beside it",
     CSCD_CONTACT_VF,
     2,
     {{1, 0, 2}, {-4, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{1, 0, -2}, {4, 0, 0}, {-4, 0, 0}, {0, -4, 0}}},
    {"edges on one line for a moment, apart",
     CSCD_CONTACT_EE,
     2,
     {{2, -1, 1}, {4, 1, 1}, {0, 0, 0}, {1, 0, 0}},
     {{2, 1, -1}, {4, -1, -1}, {0, 0, 0}, {1, 0, 0}}},
    {"edges on one line for a moment, end to end",
     CSCD_CONTACT_EE,
     0.5,
     {{1, -1, 1}, {3, 1, 1}, {0, 0, 0}, {1, 0, 0}},
     {{1, 1, -1}, {3, -1, -1}, {0, 0, 0}, {1, 0, 0}}},
    {"edges parallel for a moment, side by side",
     CSCD_CONTACT_EE,
     2,
     {{0, 0, 1}, {2, 2, 1}, {0, 1, 0}, {2, 1, 0}},
     {{0, 0, -1}, {2, -2, -1}, {0, 1, 0}, {2, 1, 0}}},
    {"an edge shrinks to a point on the other",
     CSCD_CONTACT_EE,
     0.5,
     {{-1, 0, 1}, {1, 0, 1}, {0, -1, 0}, {0, 1, 0}},
     {{1, 0, -1}, {-1, 0, -1}, {0, -1, 0}, {0, 1, 0}}},
    {"an edge shrinks to a point beyond the other",
     CSCD_CONTACT_EE,
     2,
     {{-1, 2, 1}, {1, 2, 1}, {0, -1, 0}, {0, 1, 0}},
     {{1, 2, -1}, {-1, 2, -1}, {0, -1, 0}, {0, 1, 0}}},
    {"a vertex leaves a face at the start",
     CSCD_CONTACT_VF,
     0,
     {{1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{1, 1, 5}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
    {"a vertex arrives at a corner at the end",
     CSCD_CONTACT_VF,
     1,
     {{1, 1, 5}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     {{0, 4, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
    {"edges arrive end on end at the end",
     CSCD_CONTACT_EE,
     1,
     {{0, 0, 7}, {3, 0, 2}, {0, 0, 0}, {0, 5, 0}},
     {{0, 0, 0}, {3, 0, 2}, {0, 0, 0}, {0, 5, 0}}},
    {"an edge turns in the plane onto an end that moves: t (1 + t) = 1",
     CSCD_CONTACT_EE,
     0.6180339887498949,
     {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {1, 4, 0}},
     {{0, 0, 0}, {4, 4, 0}, {2, 1, 0}, {2, 4, 0}}},
    {"a face opens in the plane onto a vertex that moves: t (1 + t) = 1",
     CSCD_CONTACT_VF,
     0.6180339887498949,
     {{1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {4, -4, 0}},
     {{2, 1, 0}, {0, 0, 0}, {4, 4, 0}, {4, -4, 0}}},
    {"a vertex through a turning plane: t (1 + t) = 1",
     CSCD_CONTACT_VF,
     0.6180339887498949,
     {{1, 0, 1}, {0, -9, 0}, {9, 0, 0}, {0, 9, 0}},
     {{2, 0, 1}, {0, -9, 0}, {9, 0, 9}, {0, 9, 0}}},
};

static void check_known(const known_case *c, bool resting) {
    elementary_query query;
    memcpy(query.x0, c->x0, sizeof query.x0);
    memcpy(query.x1, resting ? c->x0 : c->x1, sizeof query.x1);
    for (int round = 0; round < 100; round++) {
        int factors[6];
        for (int i = 0; i < 6; i++) factors[i] = round == 0 ? 0 : random_integer(-3, 3);
        elementary_query sheared = query_sheared(&query, factors);
        sheared = query_scaled(&sheared, random_integer(-100, 100));
        if (c->toi > 1.0)
            check_apart(c->kind, &sheared);
        else
            check_first(c->kind, &sheared, c->toi, 1e-9);
    }
}

#define CHECK_KNOWN(cases, resting)                                                                          \
    for (size_t i = 0; i < sizeof(cases) / sizeof *(cases); i++) check_known(&(cases)[i], resting)

TEST(sliding_in_a_plane) {
    CHECK_KNOWN(in_a_plane, false);
}

TEST(moving_on_a_line) {
    CHECK_KNOWN(on_a_line, false);
}

TEST(zero_sizes) {
    CHECK_KNOWN(shrunken, false);
}

TEST(static_pairs) {
    CHECK_KNOWN(at_rest, true);
}

TEST(for_a_moment) {
    CHECK_KNOWN(momentary, false);
}

AROUND_EACH(seed_random, NULL)
