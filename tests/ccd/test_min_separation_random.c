/* Minimum separation on random queries, against dense sampling: no pair lost, no time late, no tolerance
 * broken. */
#include "tests/support/ccd/separation_check.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>

enum { ROUND_COUNT = PACED(800, 100) };

static int seed_random(void **state) {
    (void)state;
    random_seed(20);
    return 0;
}

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

TEST(against_samples) {
    size_t all_reported = 0, all_bounded = 0;
    for (size_t f = 0; f < SEPARATION_FAMILY_COUNT; f++) {
        size_t reported = 0, bounded = 0;
        for (int round = 0; round < ROUND_COUNT; round++) {
            elementary_query query;
            separation_families[f].make(&query);
            for (int kind = 0; kind < 2; kind++) {
                separation limit = random_limit((cscd_contact_kind)kind, &query);
                bool bound = false;
                reported += check_separation((cscd_contact_kind)kind, &query, &limit, &bound);
                bounded += bound;
            }
        }
        print_message("  %-13s %5d queries, %5zu reported, %3zu bounded\n", separation_families[f].name,
                      2 * ROUND_COUNT, reported, bounded);
        all_reported += reported;
        all_bounded += bounded;
    }
    assert_true(all_bounded * 100 < all_reported);
}

/* ---- symmetry ---------------------------------------------------------------------------------------- */

static const int vf_orders[][4] = {{0, 2, 3, 1}, {0, 3, 1, 2}, {0, 1, 3, 2}, {0, 3, 2, 1}};
static const int ee_orders[][4] = {{1, 0, 2, 3}, {0, 1, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};

/* All that must hold does so in any order. */
TEST(order_of_points) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        elementary_query query;
        separation_families[(size_t)round % SEPARATION_FAMILY_COUNT].make(&query);
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
TEST(powers_of_two) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        elementary_query query;
        separation_families[(size_t)round % SEPARATION_FAMILY_COUNT].make(&query);
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

AROUND_EACH(seed_random, NULL)
