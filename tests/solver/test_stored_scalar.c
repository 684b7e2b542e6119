/* Numbers are rounded to the scalar in which they are stored, in loops that a compiler turns into vectors, too. */
#include "runtime/solver/free_step.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

/* gcc 12 gives the sums unrounded terms where conversions to float and back stand in the first loop. */
TEST(sums_are_those_of_what_is_stored) {
    double x[15];
    random_seed(1);
    for (int i = 0; i < 15; i++) x[i] = random_between(0.0, 10.0);
    for (int k = 0; k < 6; k++) x[k] = stored_coordinate(x[k], CSCD_SCALAR_FLOAT);
    for (int k = 0; k < 3; k++) x[9 + k] = 0.5 * (x[k] + x[3 + k]);
    for (int k = 0; k < 3; k++) {
        const volatile double a = x[k], b = x[3 + k];
        assert_true(x[9 + k] == 0.5 * (a + b));
        assert_true((double)(float)a == a && (double)(float)b == b);
    }
}

TEST(doubles_below_the_least_length_are_0) {
    assert_true(stored_coordinate(0.5 * LENGTH_MIN, CSCD_SCALAR_DOUBLE) == 0.0);
    assert_true(stored_coordinate(-LENGTH_MIN, CSCD_SCALAR_DOUBLE) == -LENGTH_MIN);
}

TEST(what_is_stored_is_not_above) {
    const double third = 1.0 / 3.0, tenth = 0.1; /* as floats above and below */
    assert_true(stored_below(third, CSCD_SCALAR_FLOAT) <= third &&
                stored_below(third, CSCD_SCALAR_FLOAT) > third - 1e-7);
    assert_true(stored_below(tenth, CSCD_SCALAR_FLOAT) <= tenth &&
                stored_below(tenth, CSCD_SCALAR_FLOAT) > tenth - 1e-7);
    assert_true(stored_below(third, CSCD_SCALAR_DOUBLE) == third);
}
