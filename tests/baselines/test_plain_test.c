/* The published elementary test: what it finds by plain roots is, but for a rounding error, what the certified test proves. */
#include "tests/support/test.h"
#include "runtime/baselines/published.h"
#include "src/core/baseline_library.h"
#include "tests/support/random.h"

#include <math.h>

static cscd_context *context;
static const plain_cubic_functions *roots;

static int open_library(void **state) {
    (void)state;
    const void *functions = NULL;
    if (cscd_context_create(NULL, &context) != CSCD_OK) return -1;
    if (baseline_library_find(context, PLAIN_CUBIC_ENTRY, PLAIN_CUBIC_INTERFACE, "a test", &functions) !=
        CSCD_OK)
        return -1;
    roots = functions;
    return 0;
}

static int close_library(void **state) {
    (void)state;
    cscd_context_destroy(context);
    return 0;
}

/* A vertex falls through the middle of a face. */
TEST(a_vertex_falls_through_a_face) {
    const elementary_query query = {{{0.25, 0.25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                    {{0.25, 0.25, -3}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    elementary_contact found;
    assert_true(plain_test(roots, &query, CSCD_CONTACT_VF, &found));
    assert_true(fabs(found.toi - 0.25) < 1e-9 && fabs(found.u - 0.25) < 1e-9 && fabs(found.v - 0.25) < 1e-9);
}

/* Beside it, and after the interval, it does not touch. */
TEST(beside_or_later) {
    elementary_query query = {{{0.75, 0.75, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                              {{0.75, 0.75, -3}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    elementary_contact found;
    assert_false(plain_test(roots, &query, CSCD_CONTACT_VF, &found));
    query.x0[0][0] = query.x1[0][0] = query.x0[0][1] = query.x1[0][1] = 0.25;
    query.x1[0][2] = 0.5;
    assert_false(plain_test(roots, &query, CSCD_CONTACT_VF, &found));
}

/* Edges that cross: the middle of one passes the middle of the other at t = 0.5. */
TEST(edges_cross) {
    const elementary_query query = {{{-1, 0, 1}, {1, 0, 1}, {0, -1, 0}, {0, 1, 0}},
                                    {{-1, 0, -1}, {1, 0, -1}, {0, -1, 0}, {0, 1, 0}}};
    elementary_contact found;
    assert_true(plain_test(roots, &query, CSCD_CONTACT_EE, &found));
    assert_true(fabs(found.toi - 0.5) < 1e-9 && fabs(found.u - 0.5) < 1e-9 && fabs(found.v - 0.5) < 1e-9);
}

/* Points that never leave a plane have a cubic without coefficients: no root, no contact. */
TEST(always_coplanar_is_no_contact) {
    const elementary_query query = {{{-1, 0.2, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                    {{1, 0.2, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    elementary_contact found;
    assert_false(plain_test(roots, &query, CSCD_CONTACT_VF, &found));
}

static elementary_query random_query(random_stream *random) {
    elementary_query query;
    for (int i = 0; i < 12; i++) {
        query.x0[i / 3][i % 3] = stream_between(random, 0.0, 1.0);
        query.x1[i / 3][i % 3] = stream_between(random, 0.0, 1.0);
    }
    return query;
}

/* Random features: no verdict differs, and times agree. */
TEST(agrees_with_the_certified_test) {
    enum { QUERIES = 20000 };
    uint32_t touching = 0, differing = 0;
    random_stream random = stream_start(5);
    for (uint32_t i = 0; i < QUERIES; i++) {
        const cscd_contact_kind kind = i % 2 ? CSCD_CONTACT_EE : CSCD_CONTACT_VF;
        const elementary_query query = random_query(&random);
        elementary_contact plain, certified;
        const bool found = plain_test(roots, &query, kind, &plain);
        const elementary_verdict verdict = elementary_after_signs(&query, kind, &certified);
        touching += verdict.touching;
        differing += found != verdict.touching || (found && fabs(plain.toi - certified.toi) > 1e-6);
    }
    print_message("  %u of %u queries touch, %u verdicts or times differ\n", touching, QUERIES, differing);
    assert_true(touching > QUERIES / 20 && differing == 0);
}

AROUND_ALL(open_library, close_library)
