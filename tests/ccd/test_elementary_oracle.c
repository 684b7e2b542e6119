/* The elementary tests against the algebraic oracle and against themselves, on queries of every degeneracy.
 */
#include "tests/support/ccd/algebraic_oracle.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/ccd/feature_distance.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>

/* make fuzz-elementary asks millions; here each family comes often enough for every count below to be large. */
enum { QUERIES_A_FAMILY = PACED(1000, 300) };

enum { SHOWN = 3 };

/* Differences are shown up to SHOWN and counted all. */
typedef struct failures {
    int count;
} failures;

static void note_difference(failures *f, const char *what, cscd_contact_kind kind,
                            const elementary_query *query) {
    if (f->count++ >= SHOWN) return;
    compared result = compare_with_oracle(kind, query);
    printf("%s:\n", what);
    print_compared(kind, query, &result);
}

typedef void query_check(failures *f, cscd_contact_kind kind, const elementary_query *query);

static void on_each_family(uint64_t seed, int count, query_check *check) {
    failures f = {0};
    random_stream random = stream_start(seed);
    for (int i = 0; i < 2 * count * FAMILY_COUNT; i++) {
        cscd_contact_kind kind = (cscd_contact_kind)(i % 2);
        elementary_query query = generate_query(&random, kind, (query_family)(i / 2 % FAMILY_COUNT));
        check(&f, kind, &query);
    }
    if (f.count > 0) fail_msg("%d differences", f.count);
}

/* ---- the oracle ---- */

typedef struct oracle_tally {
    int hits, misses, results[COMPARISON_COUNT];
} oracle_tally;

static void print_tally(query_family family, const oracle_tally *t) {
    printf("%-15s %6d %6d |", query_family_name(family), t->hits, t->misses);
    for (int i = 1; i < COMPARISON_COUNT; i++) printf(" %6d", t->results[i]);
    printf("\n");
}

enum { QUERIES = QUERIES_A_FAMILY * FAMILY_COUNT };

/* All families go through the queue together; query i is of family i % FAMILY_COUNT. */
static void compare_kind(cscd_contact_kind kind) {
    static elementary_query queries[QUERIES];
    static compared results[QUERIES];
    oracle_tally tallies[FAMILY_COUNT] = {{0}};
    random_stream random = stream_start(31 + kind);
    failures f = {0};
    for (int i = 0; i < QUERIES; i++)
        queries[i] = generate_query(&random, kind, (query_family)(i % FAMILY_COUNT));
    compare_all_with_oracle(kind, queries, QUERIES, results);
    const uint64_t *levels = pair_test_decided();
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) assert_true(levels[i] >= QUERIES / 8);
    for (int i = 0; i < QUERIES; i++) {
        query_family family = (query_family)(i % FAMILY_COUNT);
        tallies[family].hits += results[i].oracle.touching;
        tallies[family].misses += !results[i].oracle.touching;
        tallies[family].results[results[i].result]++;
        if (results[i].result != COMPARISON_AGREES)
            note_difference(&f, query_family_name(family), kind, &queries[i]);
    }
    printf("                  hits misses | missed  false   late  early\n");
    for (int i = 0; i < FAMILY_COUNT; i++) {
        const oracle_tally *t = &tallies[i];
        print_tally((query_family)i, t);
        assert_true(t->hits >= QUERIES_A_FAMILY / 20);
        assert_true(i == FAMILY_CORNER_CONTACT ? t->misses == 0 : t->misses >= QUERIES_A_FAMILY / 20);
    }
    if (f.count > 0) fail_msg("%d differences", f.count);
}

TEST(vf_agrees_with_oracle) {
    compare_kind(CSCD_CONTACT_VF);
}

TEST(ee_agrees_with_oracle) {
    compare_kind(CSCD_CONTACT_EE);
}

/* ---- symmetries ---- */

static bool same_verdict(cscd_contact_kind kind, const elementary_query *query, bool touching, double toi) {
    elementary_contact hit = {.toi = toi};
    return pair_test(kind, query, &hit).touching == touching && fabs(hit.toi - toi) <= 1e-9;
}

static void check_renumbered(failures *f, cscd_contact_kind kind, const elementary_query *query,
                             bool touching, double toi) {
    static const int vf_orders[5][4] = {{0, 2, 3, 1}, {0, 3, 1, 2}, {0, 1, 3, 2}, {0, 2, 1, 3}, {0, 3, 2, 1}};
    static const int ee_orders[5][4] = {{1, 0, 2, 3}, {0, 1, 3, 2}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
    for (int i = 0; i < 5; i++) {
        elementary_query other = query_permuted(query, kind == CSCD_CONTACT_VF ? vf_orders[i] : ee_orders[i]);
        if (!same_verdict(kind, &other, touching, toi)) note_difference(f, "renumbered", kind, query);
    }
}

/* Mirrored if odd. */
static elementary_query axes_exchanged(const elementary_query *query, int turn, bool odd) {
    elementary_query out;
    for (int i = 0; i < 12; i++) {
        int from = odd ? (5 - turn - i % 3) % 3 : (i % 3 + turn) % 3;
        out.x0[i / 3][i % 3] = query->x0[i / 3][from];
        out.x1[i / 3][i % 3] = query->x1[i / 3][from];
    }
    return out;
}

static void check_symmetries(failures *f, cscd_contact_kind kind, const elementary_query *query) {
    elementary_contact hit = {.toi = 2.0}, unused;
    bool touching = pair_test(kind, query, &hit).touching;
    elementary_query reversed = query_reversed(query), large = query_scaled(query, 17);
    elementary_query small = query_scaled(query, -9);
    check_renumbered(f, kind, query, touching, hit.toi);
    if (pair_test(kind, &reversed, &unused).touching != touching) note_difference(f, "reversed", kind, query);
    if (!same_verdict(kind, &large, touching, hit.toi)) note_difference(f, "times 2^17", kind, query);
    if (!same_verdict(kind, &small, touching, hit.toi)) note_difference(f, "times 2^-9", kind, query);
    for (int turn = 0; turn < 3; turn++) {
        elementary_query even = axes_exchanged(query, turn, false), odd = axes_exchanged(query, turn, true);
        if (!same_verdict(kind, &even, touching, hit.toi)) note_difference(f, "turned axes", kind, query);
        if (!same_verdict(kind, &odd, touching, hit.toi)) note_difference(f, "exchanged axes", kind, query);
    }
}

TEST(has_the_symmetries) {
    on_each_family(33, QUERIES_A_FAMILY / 10, check_symmetries);
}

/* ---- the named points ---- */

static long double ulp_of_largest(const elementary_query *query) {
    double largest = (double)largest_coordinate(query);
    return (long double)nextafter(largest, INFINITY) - largest;
}

static void check_named_points(failures *f, cscd_contact_kind kind, const elementary_query *query) {
    elementary_contact hit;
    if (!pair_test(kind, query, &hit).touching) return;
    bool inside = hit.toi >= 0.0 && hit.toi <= 1.0 && hit.u >= 0.0 && hit.u <= 1.0 && hit.v >= 0.0 &&
                  hit.v <= 1.0 && (kind == CSCD_CONTACT_EE || hit.u + hit.v <= 1.0 + 0x1p-50);
    long double allowed = 1e-8L * largest_displacement(query) + 64 * ulp_of_largest(query);
    if (!inside) note_difference(f, "outside the features", kind, query);
    if (!(named_distance(kind, query, hit.toi, hit.u, hit.v) <= allowed)) {
        note_difference(f, "named points apart", kind, query);
        if (f->count <= SHOWN) printf("u %a, v %a\n", hit.u, hit.v);
    }
}

TEST(names_points_that_meet) {
    on_each_family(34, QUERIES_A_FAMILY / 4, check_named_points);
}

/* ---- stepping ---- */

static elementary_query step_to(const elementary_query *query, double toi) {
    elementary_query out = *query;
    for (int i = 0; i < 12; i++)
        out.x1[i / 3][i % 3] =
            query->x0[i / 3][i % 3] + toi * (query->x1[i / 3][i % 3] - query->x0[i / 3][i % 3]);
    return out;
}

static int stepped;

/* Simple roots of pairs well apart at the start that move visibly, and are still apart a millionth of the way
 * before the impact and at all times earlier: by more than the rounding of the step can move them. */
static bool step_is_certain(cscd_contact_kind kind, const elementary_query *query, elementary_contact *hit) {
    long double ulp = ulp_of_largest(query);
    return pair_test(kind, query, hit).touching && algebraic_oracle(kind, query).simple &&
           feature_distance(kind, query, 0) >= 64 * ulp &&
           largest_displacement(query) >= 1e-5L * largest_coordinate(query) &&
           proved_apart(kind, query, 0, hit->toi * (1 - 1e-6L), 16 * ulp);
}

static void check_step(failures *f, cscd_contact_kind kind, const elementary_query *query) {
    elementary_contact hit = {.toi = 2.0}, again = {.toi = 2.0};
    if (!step_is_certain(kind, query, &hit)) return;
    elementary_query shorter = step_to(query, hit.toi);
    stepped++;
    if (pair_test(kind, &shorter, &again).touching && again.toi < 1.0 - 1e-6)
        note_difference(f, "again", kind, query);
    if (compare_with_oracle(kind, &shorter).result != COMPARISON_AGREES)
        note_difference(f, "step", kind, &shorter);
}

TEST(steps_to_the_impact) {
    stepped = 0;
    on_each_family(35, QUERIES_A_FAMILY / 4, check_step);
    printf("%d steps\n", stepped);
    assert_true(stepped >= QUERIES_A_FAMILY * 5 / 11);
}

static int finish_oracle(void **state) {
    (void)state;
    algebraic_oracle_finish();
    return 0;
}

AROUND_ALL(NULL, finish_oracle)
