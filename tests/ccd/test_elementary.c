/* Elementary tests in general position: contacts built backwards, near misses, invariances. Degenerate
 * configurations have their own suite. */
#include "runtime/ccd/ccd.h"
#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>

enum { ROUND_COUNT = 5000, SYMMETRY_ROUND_COUNT = 1000 };

static int seed_random(void **state) {
    (void)state;
    random_seed(3);
    return 0;
}

static const char *kind_name(cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_VF ? "vf" : "ee";
}

/* The contact that was built in, unless the features met before: then whatever was found holds. */
static bool check_contact(const contact_case *c) {
    elementary_contact hit;
    assert_true(pair_test(c->kind, &c->query, &hit).touching);
    check_hit(c->kind, &c->query, c->size, &hit);
    assert_true(hit.toi <= c->toi + 1e-9);
    bool earlier = hit.toi < c->toi - 1e-9;
    if (crosses_once(&c->query, c->kind)) assert_false(earlier);
    if (earlier) return false;
    assert_true(fabs(hit.u - c->u) <= 1e-6 && fabs(hit.v - c->v) <= 1e-6);
    assert_true(hit.normal[0] != 0.0 || hit.normal[1] != 0.0 || hit.normal[2] != 0.0);
    return true;
}

static void check_contacts(cscd_contact_kind kind) {
    int built = 0, earlier = 0, once = 0;
    for (int round = 0; round < ROUND_COUNT; round++) {
        contact_case c = random_contact(kind);
        once += crosses_once(&c.query, kind);
        if (check_contact(&c))
            built++;
        else
            earlier++;
    }
    printf("%s contacts: %d as built, %d of them at the only crossing, %d earlier\n", kind_name(kind), built,
           once, earlier);
    assert_true(built >= 4000 && once >= 1000 && earlier >= 20);
}

TEST(vf_contacts) {
    check_contacts(CSCD_CONTACT_VF);
}

TEST(ee_contacts) {
    check_contacts(CSCD_CONTACT_EE);
}

static void check_misses(cscd_contact_kind kind, const char *name, contact_case (*make)(cscd_contact_kind)) {
    int count[ELEMENTARY_LEVEL_COUNT] = {0};
    for (int round = 0; round < ROUND_COUNT; round++) {
        contact_case c = make(kind);
        elementary_contact hit = {.toi = 47.0}, untouched = hit;
        elementary_verdict verdict = pair_test(kind, &c.query, &hit);
        count[verdict.level]++;
        assert_false(verdict.touching);
        assert_memory_equal(&hit, &untouched, sizeof hit);
    }
    printf("%s %s misses: %d decided by signs, %d at roots, %d exactly\n", kind_name(kind), name,
           count[ELEMENTARY_SIGNS], count[ELEMENTARY_ROOTS], count[ELEMENTARY_EXACT]);
}

TEST(vf_near_misses) {
    check_misses(CSCD_CONTACT_VF, "side", random_side_miss);
    check_misses(CSCD_CONTACT_VF, "short", random_short_miss);
}

TEST(ee_near_misses) {
    check_misses(CSCD_CONTACT_EE, "side", random_side_miss);
    check_misses(CSCD_CONTACT_EE, "short", random_short_miss);
}

/* Orders of the four points that leave the features what they are; the last four of EE exchange the edges. */
static const int vf_orders[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                    {0, 1, 3, 2}, {0, 3, 2, 1}, {0, 2, 1, 3}};
static const int ee_orders[8][4] = {{0, 1, 2, 3}, {1, 0, 2, 3}, {0, 1, 3, 2}, {1, 0, 3, 2},
                                    {2, 3, 0, 1}, {3, 2, 0, 1}, {2, 3, 1, 0}, {3, 2, 1, 0}};

static void check_same_contact(const contact_case *c, const elementary_contact *a,
                               const elementary_contact *b, double side) {
    double place = 1e-9 * c->size;
    assert_true(fabs(a->toi - b->toi) <= 1e-9);
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(a->point[k] - b->point[k]) <= place);
        assert_true(fabs(a->normal[k] - side * b->normal[k]) <= 1e-6);
    }
}

static void check_orders(const contact_case *c) {
    elementary_contact hit;
    elementary_verdict verdict = pair_test(c->kind, &c->query, &hit);
    int count = c->kind == CSCD_CONTACT_VF ? 6 : 8;
    for (int i = 0; i < count; i++) {
        elementary_query query =
            query_permuted(&c->query, c->kind == CSCD_CONTACT_VF ? vf_orders[i] : ee_orders[i]);
        elementary_contact other;
        assert_true(pair_test(c->kind, &query, &other).touching == verdict.touching);
        double side = c->kind == CSCD_CONTACT_EE && i >= 4 ? -1.0 : 1.0;
        if (verdict.touching) check_same_contact(c, &hit, &other, side);
    }
}

static void check_reversed(const contact_case *c) {
    elementary_contact hit, other;
    elementary_query reversed = query_reversed(&c->query);
    elementary_verdict verdict = pair_test(c->kind, &c->query, &hit);
    assert_true(pair_test(c->kind, &reversed, &other).touching == verdict.touching);
    if (!verdict.touching) return;
    check_hit(c->kind, &reversed, c->size, &other);
    if (!crosses_once(&c->query, c->kind)) return;
    other.toi = 1.0 - other.toi;
    check_same_contact(c, &hit, &other, -1.0);
}

/* The same bits at any power of two. */
static void check_scaled(const contact_case *c, int exponent) {
    elementary_query scaled = query_scaled(&c->query, exponent);
    elementary_contact hit = {0}, other = {0};
    assert_int_equal(pair_test(c->kind, &c->query, &hit).touching,
                     pair_test(c->kind, &scaled, &other).touching);
    assert_true(hit.toi == other.toi && hit.u == other.u && hit.v == other.v);
    for (int k = 0; k < 3; k++) {
        assert_true(hit.normal[k] == other.normal[k]);
        assert_true(ldexp(hit.point[k], exponent) == other.point[k]);
    }
}

static void check_powers_of_two(const contact_case *c) {
    check_scaled(c, 200);
    check_scaled(c, -200);
    check_scaled(c, random_integer(-200, 200));
}

static void for_each_kind_of_case(void (*check)(const contact_case *)) {
    static contact_case (*const makers[])(cscd_contact_kind) = {random_contact, random_side_miss,
                                                                random_short_miss};
    for (int round = 0; round < SYMMETRY_ROUND_COUNT; round++) {
        for (int i = 0; i < 6; i++) {
            contact_case c = makers[i / 2](i % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE);
            check(&c);
        }
    }
}

TEST(order_of_points) {
    for_each_kind_of_case(check_orders);
}

TEST(reversed_time) {
    for_each_kind_of_case(check_reversed);
}

TEST(powers_of_two) {
    for_each_kind_of_case(check_powers_of_two);
}

/* A vertex and a face with a corner at the origin, and three vectors between them along the axes: the determinant is one
 * product, whichever axis is whose. */
TEST(the_error_holds_for_each_product) {
    static const int axes[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    static const int points[3] = {2, 3, 0};
    for (int round = 0; round < 600; round++) {
        elementary_query query = {.x0 = {{0.0}}};
        point_vectors vectors;
        long double volume = round % 6 < 3 ? 1.0L : -1.0L;
        for (int i = 0; i < 3; i++) {
            double at = 1.0 + random_unit() / 3.0;
            query.x0[points[i]][axes[round % 6][i]] = query.x1[points[i]][axes[round % 6][i]] = at;
            volume *= (long double)at;
        }
        point_vectors_from(&query, CSCD_CONTACT_VF, &vectors);
        coplanarity f = coplanarity_cubic(&vectors);
        for (int i = 0; i < 4; i++) assert_true(fabsl((long double)f.b[i] - volume) <= (long double)f.error);
    }
}

AROUND_EACH(seed_random, NULL)
