/* Minimum separation on random queries, against dense sampling: no pair lost, no time late, no tolerance
 * broken. */
#include "tests/support/ccd/separation_check.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>

enum { ROUND_COUNT = 800 };

static int seed_random(void **state) {
    (void)state;
    random_seed(20);
    return 0;
}

/* ---- families of queries ---------------------------------------------------------------------------- */

typedef void family(elementary_query *query);

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

static const struct {
    const char *name;
    family *make;
} families[] = {{"wild", wild_motion},           {"slow", slow_motion},
                {"rigid", rigid_motion},         {"grid", on_a_grid},
                {"thin", thin_features},         {"side by side", side_by_side},
                {"hovering", hovering_features}, {"far away", far_away}};

enum { FAMILY_COUNT = sizeof families / sizeof *families };

/* ---- distances -------------------------------------------------------------------------------------- */

/* About the least distance, where it matters, or anything. */
static separation random_limit(cscd_contact_kind kind, const elementary_query *query) {
    static const double factors[] = {0.5, 1 - 1e-3, 1 - 1e-6, 1 - 1e-9, 1.0, 1 + 1e-9, 1 + 1e-3, 2.0};
    separation limit = {ldexp(random_between(0.5, 1.0), -random_integer(0, 40)), 0.0};
    double least = (double)sampled_least(kind, query);
    if (least > 1e-200 && random_integer(0, 3) > 0) limit.distance = least * factors[random_integer(0, 7)];
    limit.tolerance = random_integer(0, 2) > 0 ? 1e-6 * limit.distance
                                               : limit.distance * ldexp(1.0, -random_integer(1, 45));
    return limit;
}

static void against_samples(void **state) {
    (void)state;
    size_t all_reported = 0, all_bounded = 0;
    for (size_t f = 0; f < FAMILY_COUNT; f++) {
        size_t reported = 0, bounded = 0;
        for (int round = 0; round < ROUND_COUNT; round++) {
            elementary_query query;
            families[f].make(&query);
            for (int kind = 0; kind < 2; kind++) {
                separation limit = random_limit((cscd_contact_kind)kind, &query);
                bool bound = false;
                reported += check_separation((cscd_contact_kind)kind, &query, &limit, &bound);
                bounded += bound;
            }
        }
        print_message("  %-13s %5d queries, %5zu reported, %3zu bounded\n", families[f].name, 2 * ROUND_COUNT,
                      reported, bounded);
        all_reported += reported;
        all_bounded += bounded;
    }
    assert_true(all_bounded * 100 < all_reported);
}

/* ---- symmetry ---------------------------------------------------------------------------------------- */

static const int vf_orders[][4] = {{0, 2, 3, 1}, {0, 3, 1, 2}, {0, 1, 3, 2}, {0, 3, 2, 1}};
static const int ee_orders[][4] = {{1, 0, 2, 3}, {0, 1, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};

/* All that must hold does so in any order. */
static void order_of_points(void **state) {
    (void)state;
    for (int round = 0; round < ROUND_COUNT; round++) {
        elementary_query query;
        families[(size_t)round % FAMILY_COUNT].make(&query);
        for (int kind = 0; kind < 2; kind++) {
            separation limit = random_limit((cscd_contact_kind)kind, &query);
            bool bounded;
            long double surely = limit.distance - tolerance_of(&query, &limit);
            bool certain = sampled_least((cscd_contact_kind)kind, &query) < surely;
            for (int i = 0; i < 4; i++) {
                const int *order = kind == CSCD_CONTACT_VF ? vf_orders[i] : ee_orders[i];
                elementary_query other = query_permuted(&query, order);
                bool reported = check_separation((cscd_contact_kind)kind, &other, &limit, &bounded);
                assert_true(reported || !certain);
            }
        }
    }
}

/* The same bits at any power of two. */
static void powers_of_two(void **state) {
    (void)state;
    for (int round = 0; round < ROUND_COUNT; round++) {
        elementary_query query;
        families[(size_t)round % FAMILY_COUNT].make(&query);
        for (int kind = 0; kind < 2; kind++) {
            int exponent = random_integer(-200, 240);
            separation limit = random_limit((cscd_contact_kind)kind, &query);
            separation scaled = {ldexp(limit.distance, exponent), ldexp(limit.tolerance, exponent)};
            elementary_query other = query_scaled(&query, exponent);
            elementary_contact hit = {0}, other_hit = {0};
            bool bounded = false, other_bounded = false;
            bool found = separation_test((cscd_contact_kind)kind, &query, &limit, &hit, &bounded);
            assert_true(separation_test((cscd_contact_kind)kind, &other, &scaled, &other_hit,
                                        &other_bounded) == found);
            assert_true(bounded == other_bounded && hit.toi == other_hit.toi);
            assert_true(hit.u == other_hit.u && hit.v == other_hit.v);
            assert_memory_equal(hit.normal, other_hit.normal, sizeof hit.normal);
            for (int k = 0; k < 3; k++) assert_true(ldexp(hit.point[k], exponent) == other_hit.point[k]);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup(against_samples, seed_random),
                                       cmocka_unit_test_setup(order_of_points, seed_random),
                                       cmocka_unit_test_setup(powers_of_two, seed_random)};
    return cmocka_run_group_tests_name("separation_random", tests, NULL, NULL);
}
