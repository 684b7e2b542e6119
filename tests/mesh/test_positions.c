/* Which positions are taken: 0 and magnitudes from 2^-300 to 2^300, wherever in an array they stand. */
#include "src/mesh/positions.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { VERTICES = 5000 }; /* of more than one task */

static double x[VERTICES * 3];

TEST(limits_are_those_that_are_said) {
    static const size_t places[] = {0, 1, 2, 6143, 6144, 3 * VERTICES - 1};
    const double good[] = {0.0, -0.0, 0x1p-300, -0x1p-300, 0x1p300, -0x1p300, 1.0};
    const double bad[] = {nextafter(0x1p-300, 0.0),
                          nextafter(0x1p300, INFINITY),
                          -0x1.8p300,
                          0x1p-301,
                          5e-324,
                          INFINITY,
                          -INFINITY,
                          NAN};
    cscd_context *context = NULL;
    char words[64];
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const size_t at = places[i];
        snprintf(words, sizeof words, "things: vertex %zu has %c", at / 3, "xyz"[at % 3]);
        for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
            x[at] = good[k];
            assert_int_equal(positions_check(context, x, VERTICES, "things"), CSCD_OK);
        }
        for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
            x[at] = bad[k];
            assert_int_equal(positions_check(context, x, VERTICES, "things"), CSCD_INVALID_ARGUMENT);
            assert_non_null(strstr(cscd_context_detail(context), words));
        }
        x[at] = 0.0;
    }
    cscd_context_destroy(context);
}
