/* Families of random queries for distances: ordinary, thin, parallel, degenerate, and far from the origin. */
#include "tests/support/ccd/separation_families.h"

#include "tests/support/random.h"

#include <math.h>

/* Any features, any motion. */
static void wild_motion(elementary_query *query) {
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            query->x0[i][k] = random_unit();
            query->x1[i][k] = random_unit();
        }
    }
}

/* A tenth of their size at most, as in recordings. */
static void slow_motion(elementary_query *query) {
    wild_motion(query);
    double speed = ldexp(1.0, -random_integer(3, 20));
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) query->x1[i][k] = query->x0[i][k] + speed * random_unit();
    }
}

/* Each feature flies without turning. */
static void rigid_motion(elementary_query *query) {
    double motion[4][3];
    wild_motion(query);
    for (int k = 0; k < 3; k++) {
        motion[0][k] = random_unit();
        motion[1][k] = random_unit();
        for (int i = 0; i < 4; i++) query->x1[i][k] = query->x0[i][k] + motion[i > 1][k];
    }
}

/* Small integers: coplanar, parallel, coincident and zero features are common. */
static void on_a_grid(elementary_query *query) {
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            query->x0[i][k] = random_integer(-2, 2);
            query->x1[i][k] = random_integer(0, 2) ? query->x0[i][k] : random_integer(-2, 2);
        }
    }
}

/* Needles and nearly parallel edges: two points of a feature nearly on a line with the others. */
static void thin_features(elementary_query *query) {
    slow_motion(query);
    double width = ldexp(1.0, -random_integer(4, 50)), along = random_between(-0.5, 1.5);
    for (int k = 0; k < 3; k++) {
        double offset = width * random_unit();
        query->x0[3][k] = query->x0[1][k] + along * (query->x0[2][k] - query->x0[1][k]) + offset;
        query->x1[3][k] = query->x1[1][k] + along * (query->x1[2][k] - query->x1[1][k]) + offset;
    }
}

/* Edges side by side that turn through being parallel. */
static void side_by_side(elementary_query *query) {
    wild_motion(query);
    double turn = ldexp(1.0, -random_integer(0, 30)), height = ldexp(1.0, -random_integer(0, 12));
    for (int k = 0; k < 3; k++) {
        double along = random_unit(), up = k == 2 ? height : 0.0;
        query->x0[0][k] = query->x1[0][k] = query->x0[2][k] = query->x1[2][k] = 0.0;
        query->x0[1][k] = query->x1[1][k] = along;
        query->x0[3][k] = along + turn * random_unit();
        query->x1[3][k] = along + turn * random_unit();
        for (int i = 2; i < 4; i++) {
            query->x0[i][k] += up;
            query->x1[i][k] += up * random_between(0.5, 1.0);
        }
    }
}

/* A vertex, or an edge, that stays as near to a turning face, or edge, as it can. */
static void hovering_features(elementary_query *query) {
    double h = ldexp(1.0, -random_integer(1, 20)), turn = ldexp(1.0, -random_integer(0, 12));
    wild_motion(query);
    for (int i = 0; i < 4; i++) {
        query->x0[i][2] = query->x1[i][2] = 0.0;
        query->x0[i][2] = i == 0 ? h : turn * random_unit();
        query->x1[i][2] = i == 0 ? h : -query->x0[i][2];
        for (int k = 0; k < 2; k++) query->x1[i][k] = query->x0[i][k] + turn * random_unit();
    }
}

/* Far from the origin, where coordinates have fewer digits. */
static void far_away(elementary_query *query) {
    double place[3] = {4e5 * random_unit(), -3e6, 7e4};
    slow_motion(query);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            query->x0[i][k] += place[k];
            query->x1[i][k] += place[k];
        }
    }
}

const separation_family separation_families[SEPARATION_FAMILY_COUNT] = {
    {"wild", wild_motion},           {"slow", slow_motion},
    {"rigid", rigid_motion},         {"grid", on_a_grid},
    {"thin", thin_features},         {"side by side", side_by_side},
    {"hovering", hovering_features}, {"far away", far_away}};
