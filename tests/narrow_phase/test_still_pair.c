/* Pairs that do not move: the same verdicts as integers give, and the same contacts as without the short cut. */
#include "runtime/ccd/exact/exact_test.h"
#include "runtime/narrow_phase/still_pair.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/ccd/queue_test.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { QUERIES_A_FAMILY = 400 };

typedef struct still_tally {
    int touching, apart;
} still_tally;

/* The query as it is at one of its ends, for good. */
static elementary_query stopped_query(random_stream *random, cscd_contact_kind kind, query_family family) {
    elementary_query query = generate_query(random, kind, family);
    if (stream_below(random, 2) == 0)
        memcpy(query.x1, query.x0, sizeof query.x1);
    else
        memcpy(query.x0, query.x1, sizeof query.x0);
    return query;
}

static void check_still(cscd_contact_kind kind, const elementary_query *query, still_tally *tally) {
    elementary_contact contact, expected, queued;
    elementary_verdict verdict;
    double toi = 2.0;
    bool touching = exact_touch(query, kind, &toi);
    assert_true(still_pair_decide(query, kind, &verdict, &contact));
    assert_int_equal(verdict.touching, touching);
    assert_int_equal(verdict.level, ELEMENTARY_EXACT);
    assert_int_equal(pair_test(kind, query, &queued).touching, touching);
    tally->touching += touching;
    tally->apart += !touching;
    if (!touching) return;
    assert_true(toi == 0.0);
    assert_true(elementary_after_signs(query, kind, &expected).touching);
    assert_memory_equal(&contact, &expected, sizeof contact);
    assert_memory_equal(&queued, &expected, sizeof queued);
}

static void check_kind(cscd_contact_kind kind) {
    random_stream random = stream_start(91 + (uint64_t)kind);
    for (int family = 0; family < FAMILY_COUNT; family++) {
        still_tally tally = {0};
        for (int i = 0; i < QUERIES_A_FAMILY; i++) {
            elementary_query query = stopped_query(&random, kind, (query_family)family);
            check_still(kind, &query, &tally);
        }
        if (family >= FAMILY_END_CONTACT && family <= FAMILY_STATIC)
            assert_true(tally.touching >= QUERIES_A_FAMILY / 50 && tally.apart >= QUERIES_A_FAMILY / 5);
        print_message("%-15s touching %d apart %d\n", query_family_name((query_family)family), tally.touching,
                      tally.apart);
    }
}

static void vf_agrees_with_integers(void **state) {
    (void)state;
    check_kind(CSCD_CONTACT_VF);
}

static void ee_agrees_with_integers(void **state) {
    (void)state;
    check_kind(CSCD_CONTACT_EE);
}

/* One coordinate of one point moves, by as little as it can. */
static void leaves_what_moves(void **state) {
    (void)state;
    random_stream random = stream_start(93);
    for (int i = 0; i < 24 * QUERIES_A_FAMILY; i++) {
        cscd_contact_kind kind = (cscd_contact_kind)(i % 2);
        elementary_contact contact;
        elementary_verdict verdict;
        elementary_query query = stopped_query(&random, kind, FAMILY_AXIS_PLANE);
        double *moved = &query.x1[i / 2 % 12 / 3][i / 2 % 3];
        *moved = nextafter(*moved, 1e9);
        assert_false(still_pair_decide(&query, kind, &verdict, &contact));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vf_agrees_with_integers),
        cmocka_unit_test(ee_agrees_with_integers),
        cmocka_unit_test(leaves_what_moves),
    };
    return cmocka_run_group_tests_name("still_pair", tests, NULL, NULL);
}
