/* GSL's error handler belongs to the process: the library leaves it as it finds it, and never causes a call.
 */
#include "tests/support/ccd/queue_test.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <gsl/gsl_errno.h>

enum { QUERY_COUNT = 100000 };

static int calls;

static void count_call(const char *reason, const char *file, int line, int error) {
    (void)reason;
    (void)file;
    (void)line;
    (void)error;
    calls++;
}

TEST(handler_left_alone) {
    random_seed(31);
    gsl_error_handler_t *before = gsl_set_error_handler(count_call);
    for (int i = 0; i < QUERY_COUNT; i++) {
        elementary_query query;
        elementary_contact hit;
        int range = random_integer(1, 3);
        for (int j = 0; j < 12; j++) {
            query.x0[j / 3][j % 3] = random_integer(-range, range);
            query.x1[j / 3][j % 3] = random_integer(-range, range);
        }
        pair_test(CSCD_CONTACT_VF, &query, &hit);
        pair_test(CSCD_CONTACT_EE, &query, &hit);
    }
    assert_true(gsl_set_error_handler(before) == count_call);
    assert_int_equal(calls, 0);
}
