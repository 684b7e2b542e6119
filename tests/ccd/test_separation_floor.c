/* Floors of pairs, against distances in long double: never too high, never lost on a motion that is let through, and
 * never in the way of features that part. */
#include "runtime/ccd/ccd.h"
#include "src/core/vec3.h"
#include "tests/support/ccd/separation_check.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { ROUND_COUNT = 1500 };

static int seed_random(void **state) {
    (void)state;
    random_seed(31);
    return 0;
}

/* ---- queries ------------------------------------------------------------------------------------------ */

static elementary_query query_at(const double x[4][3]) {
    elementary_query q;
    memcpy(q.x0, x, sizeof q.x0);
    memcpy(q.x1, x, sizeof q.x1);
    return q;
}

static double extent_at_start(const elementary_query *q) {
    elementary_query still = query_at((const double(*)[3])q->x0);
    return query_extent_of(&still);
}

/* The direction from b's nearest point to a's at the start. */
static void connection_at_start(cscd_contact_kind kind, const elementary_query *q, double normal[3]) {
    elementary_query still = query_at((const double(*)[3])q->x0);
    elementary_contact nearest;
    separation_describe(&still, kind, &nearest);
    memcpy(normal, nearest.normal, sizeof nearest.normal);
}

/* Moves the first feature, at the start or the end. */
static void shift_first(cscd_contact_kind kind, double x[4][3], double way, const double direction[3]) {
    for (int i = 0; i < points_of_first(kind); i++) vec3_add_scaled(x[i], way, direction, x[i]);
}

/* A query whose features are mostly far nearer to each other than they are long, and often move as little. */
static elementary_query make_query(int family, cscd_contact_kind kind) {
    elementary_query q;
    double normal[3];
    separation_families[family].make(&q);
    double extent = extent_at_start(&q);
    if (extent == 0.0 || random_integer(0, 3) == 0) return q;
    double near = ldexp(extent * random_between(0.5, 1.0), -random_integer(2, 39));
    double way = near - (double)sampled_distance(kind, &q, 0.0L);
    connection_at_start(kind, &q, normal);
    shift_first(kind, q.x0, way, normal);
    shift_first(kind, q.x1, way, normal);
    if (random_integer(0, 1) == 0) return q;
    double speed = random_integer(0, 1) ? near : ldexp(near, random_integer(0, 10));
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) q.x1[i][k] = q.x0[i][k] + speed * random_unit();
    }
    return q;
}

/* ---- at rest ------------------------------------------------------------------------------------------ */

/* A floor is below the distance; and where a rung is below the distance by what the header says and little more, it is
 * the floor. */
TEST(floors_are_as_high_as_they_may_be) {
    size_t found = 0, none = 0;
    for (int round = 0; round < SEPARATION_FAMILY_COUNT * ROUND_COUNT; round++) {
        cscd_contact_kind kind = round % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
        elementary_query q = make_query(round / 2 % SEPARATION_FAMILY_COUNT, kind);
        double extent = extent_at_start(&q);
        long double distance = sampled_distance(kind, &q, 0.0L);
        double rung = (double)(distance - (FLOOR_FINEST + 0x1p-42L) * extent);
        floor_ladder high = {ldexp((double)distance, random_integer(1, 60)), 0.9, 1e-6};
        double floor = separation_floor_at((const double(*)[3])q.x0, kind, &high);
        assert_true(floor < distance || floor == 0.0);
        if (floor > 0.0) assert_true(floor > 0.89L * (distance - 2.0L * FLOOR_FINEST * extent));
        if (rung > 1.01 * FLOOR_FINEST * extent) {
            floor_ladder low = {rung, random_between(0.1, 0.99), 0.0};
            assert_true(separation_floor_at((const double(*)[3])q.x0, kind, &low) == rung);
            found++;
        } else if (distance < FLOOR_FINEST * extent) {
            assert_true(floor == 0.0);
            none++;
        }
    }
    print_message("  %zu floors, %zu pairs without one\n", found, none);
    assert_true(found > 8 * ROUND_COUNT / 2 && none > 10);
}

/* The rungs of a ladder have one value each, whatever the distance that looks for them. */
TEST(rungs_are_few) {
    double x[4][3] = {{0.2, 0.3, 0.0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const floor_ladder ladder = {1e-2, 0.9, 1e-6};
    double last = INFINITY;
    size_t rungs = 0;
    for (int i = 0; i < 3000; i++) {
        x[0][2] = 2e-2 * pow(0.99, i);
        double floor = separation_floor_at((const double(*)[3])x, CSCD_CONTACT_VF, &ladder);
        assert_true(floor <= last && floor < x[0][2]);
        rungs += floor < last;
        if (floor == 0.0) break;
        assert_true(fabs(log(floor / 1e-2) / log(0.9) - round(log(floor / 1e-2) / log(0.9))) < 1e-9);
        last = floor;
    }
    assert_int_equal(rungs, 1 + 1 + (size_t)floor(log(0.8 * FLOOR_FINEST / 1e-2) / log(0.9)));
}

/* ---- motions ------------------------------------------------------------------------------------------ */

typedef struct motion_tally {
    size_t kept, broken, none;
} motion_tally;

static void check_motion(cscd_contact_kind kind, const elementary_query *q, const floor_ladder *ladder,
                         motion_tally *sum) {
    elementary_contact contact = {.toi = -1.0};
    bool bounded = false;
    double floor = separation_floor_at((const double(*)[3])q->x0, kind, ladder);
    floor_verdict verdict = separation_floor_test(q, kind, ladder, &contact, &bounded);
    assert_int_equal(verdict == FLOOR_NONE, floor == 0.0);
    sum->none += verdict == FLOOR_NONE;
    sum->broken += verdict == FLOOR_BROKEN;
    sum->kept += verdict == FLOOR_KEPT;
    if (verdict == FLOOR_BROKEN) assert_true(contact.toi >= 0.0 && contact.toi <= 1.0);
    if (verdict != FLOOR_KEPT) return;
    elementary_query end = query_at((const double(*)[3])q->x1);
    assert_true(sampled_least(kind, q) > floor * (1.0L - 0x1p-50L));
    double after = separation_floor_at((const double(*)[3])q->x1, kind, ladder);
    assert_true(after >= floor || floor <= FLOOR_FINEST * query_extent_of(&end));
}

static void check_parting(cscd_contact_kind kind, const elementary_query *q, const floor_ladder *ladder) {
    elementary_query parting = query_at((const double(*)[3])q->x0);
    elementary_contact contact;
    bool bounded;
    double normal[3], way = ldexp(extent_at_start(q), -random_integer(0, 30));
    assert_int_not_equal(separation_floor_test(&parting, kind, ladder, &contact, &bounded), FLOOR_BROKEN);
    connection_at_start(kind, q, normal);
    shift_first(kind, parting.x1, way, normal);
    if (separation_floor_at((const double(*)[3])q->x0, kind, ladder) > 0.0)
        assert_int_equal(separation_floor_test(&parting, kind, ladder, &contact, &bounded), FLOOR_KEPT);
}

/* What is kept is kept for certain, resting features are kept, and so are those that part. */
TEST(motions_keep_floors) {
    motion_tally sum = {0};
    for (int round = 0; round < SEPARATION_FAMILY_COUNT * ROUND_COUNT; round++) {
        cscd_contact_kind kind = round % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
        elementary_query q = make_query(round / 2 % SEPARATION_FAMILY_COUNT, kind);
        double distance = (double)sampled_distance(kind, &q, 0.0L);
        floor_ladder ladder = {ldexp(random_between(0.5, 1.0), -random_integer(0, 20)), 0.9, 1e-6};
        if (random_integer(0, 1) == 0 && distance > 0.0)
            ladder.distance = distance * random_between(0.3, 3.0);
        check_motion(kind, &q, &ladder, &sum);
        check_parting(kind, &q, &ladder);
    }
    print_message("  %zu kept, %zu broken, %zu without a floor\n", sum.kept, sum.broken, sum.none);
    assert_true(sum.kept > 4000 && sum.broken > 1000 && sum.none > 50);
}

/* Features that fly together, far and fast, have no motion of their own. */
TEST(common_motion_is_no_motion) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        cscd_contact_kind kind = round % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
        elementary_query q = make_query(round % 7, kind);
        elementary_contact contact;
        bool bounded;
        const floor_ladder ladder = {(double)sampled_distance(kind, &q, 0.0L) * 0.99, 0.9, 1e-6};
        if (!(ladder.distance > 1e-6)) continue;
        for (int i = 0; i < 4; i++) {
            for (int k = 0; k < 3; k++) q.x1[i][k] = q.x0[i][k] + 1e7 * (k + 1);
        }
        if (sampled_distance(kind, &q, 1.0L) < ladder.distance * 1.001) continue;
        assert_int_equal(separation_floor_test(&q, kind, &ladder, &contact, &bounded), FLOOR_KEPT);
    }
}

AROUND_EACH(seed_random, NULL)
