/* Directions that separate two features in a part of the interval: never about a contact, and for parallel edges that pass a
 * common plane beside each other. */
#include "runtime/ccd/elementary_levels.h"
#include "runtime/ccd/exact.h"
#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/test.h"

#include <math.h>

enum { QUERIES_PER_FAMILY = 1500, RINGS = 400 };

static double random_margin(random_stream *random) {
    static const double margins[5] = {0.0, 0x1p-40, 0x1p-30, 0x1p-8, 1.0};
    return margins[stream_below(random, 5)];
}

/* The first touch is at most 2^-34 after the time that the exact test names. */
TEST(never_about_a_contact) {
    random_stream random = stream_start(17);
    size_t touching = 0;
    for (int n = 0; n < 2 * FAMILY_COUNT * QUERIES_PER_FAMILY; n++) {
        cscd_contact_kind kind = n % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
        elementary_query query = generate_query(&random, kind, (query_family)(n / 2 % FAMILY_COUNT));
        double toi;
        if (!exact_touch(&query, kind, &toi)) continue;
        double begin = fmax(toi - random_margin(&random), 0.0);
        double end = fmin(toi + 0x1p-34 + random_margin(&random), 1.0);
        assert_false(separated_in_part(&query, kind, begin, end));
        touching++;
    }
    print_message("%zu touching\n", touching);
    assert_true(touching > 10000);
}

/* Features that are far smaller than where they are and how far they go: only the slack covers what blending loses. */
TEST(nor_far_from_the_origin) {
    random_stream random = stream_start(18);
    size_t touching = 0;
    for (int n = 0; n < 20000; n++) {
        cscd_contact_kind kind = n % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
        elementary_query query;
        double toi, far[2][3];
        for (int k = 0; k < 6; k++) far[k / 3][k % 3] = (double)stream_below(&random, 1u << 20) / 3.0;
        for (int i = 0; i < 4; i++) {
            for (int k = 0; k < 3; k++) {
                query.x0[i][k] = far[0][k] + (double)stream_below(&random, 4) * 0x1p-30;
                query.x1[i][k] = far[1][k] + (double)stream_below(&random, 4) * 0x1p-30;
            }
        }
        if (!exact_touch(&query, kind, &toi)) continue;
        assert_false(separated_in_part(&query, kind, toi, fmin(toi + 0x1p-34, 1.0)));
        touching++;
    }
    print_message("%zu touching\n", touching);
    assert_true(touching > 1000);
}

/* Edges of two horizontal rings of any height, turned about the same axis, that rise evenly: they are coplanar at one time,
 * for parallel edges always. */
TEST(edges_of_rings_need_no_integers) {
    random_stream random = stream_start(19);
    uint64_t by_integers = 0;
    for (int n = 0; n < RINGS; n++) {
        double angle = 0.01 * n, along[2] = {cos(angle), sin(angle)},
               shift = 0.1 * (double)(1 + stream_below(&random, 9));
        double rise[2] = {0.3, 0.3 + 0.01 * (double)stream_below(&random, 5)};
        elementary_query query;
        elementary_contact contact;
        for (int i = 0; i < 4; i++) {
            double s = i % 2 == 0 ? -0.5 : 0.5, side = i < 2 ? 0.0 : shift;
            const double start[3] = {s * along[0] - side * along[1], s * along[1] + side * along[0],
                                     i < 2 ? 0.0 : 0.001};
            for (int k = 0; k < 3; k++) {
                query.x0[i][k] = start[k];
                query.x1[i][k] = start[k] + (k == 2 ? rise[1 - i / 2] : 0.0);
            }
        }
        assert_false(pair_test(CSCD_CONTACT_EE, &query, &contact).touching);
        by_integers += pair_test_decided()[ELEMENTARY_EXACT];
    }
    assert_int_equal(by_integers, 0);
}
