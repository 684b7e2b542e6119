/* The nearest double to the quotient of two long integers: multiples of numbers whose quotient the processor rounds. */
#include "src/core/integer.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>

enum { ROUNDS = 20000 };

/* A number of up to three limbs. */
static integer random_factor(random_stream *random, integer_pool *pool) {
    integer factor = integer_from_int(pool, 1 + (int64_t)(stream_bits(random) >> 2));
    for (uint32_t i = stream_below(random, 3); i > 0; i--)
        factor =
            integer_multiply(pool, factor, integer_from_int(pool, 1 + (int64_t)(stream_bits(random) >> 2)));
    return factor;
}

TEST(multiples_have_the_same_quotient) {
    random_stream random = stream_start(1);
    integer_pool pool;
    for (int round = 0; round < ROUNDS; round++) {
        integer_pool_start(&pool);
        int64_t a = (int64_t)(stream_bits(&random) >> (11 + stream_below(&random, 40)));
        int64_t b = 1 + (int64_t)(stream_bits(&random) >> (12 + stream_below(&random, 40)));
        int exponent = (int)stream_below(&random, 200) - 100;
        if (stream_below(&random, 2) == 0) a = -a;
        integer factor = random_factor(&random, &pool);
        integer top = integer_multiply(&pool, integer_from_int(&pool, a), factor);
        integer bottom = integer_multiply(&pool, integer_from_int(&pool, b), factor);
        double nearest = integer_nearest_quotient(&pool, top, bottom, exponent);
        assert_true(nearest == ldexp((double)a / (double)b, exponent));
    }
}

/* Between two doubles, to the even one; a little beside, to the nearer one. */
TEST(ties_go_to_the_even_one) {
    integer_pool pool;
    integer_pool_start(&pool);
    integer large = integer_from_int(&pool, INT64_C(1) << 62), three = integer_from_int(&pool, 3);
    integer middle =
        integer_add(&pool, integer_multiply(&pool, large, large), integer_scale(&pool, large, 512));
    assert_true(integer_nearest_quotient(&pool, middle, large, 0) == 0x1p62);
    integer above = integer_add(&pool, middle, three);
    assert_true(integer_nearest_quotient(&pool, above, large, 0) == 0x1p62 + 1024.0);
    integer odd = integer_add(&pool, middle, integer_scale(&pool, large, 1024));
    assert_true(integer_nearest_quotient(&pool, odd, large, 0) == 0x1p62 + 2048.0);
}
