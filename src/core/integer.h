/* Integers of any sign and up to thousands of bits, in a pool on the caller's stack: no allocation. */
#pragma once

#include <stdint.h>

/* The exact level of one elementary test always holds fewer limbs of 64 bits than this at once, with
 * coordinates from 2^-300 to 2^300 in one query. docs/theory/elementary.md counts them. */
enum { INTEGER_POOL_LIMBS = 6144 };

/* A number has |size| limbs, least significant first, and the last one is not 0. A negative size means a
 * negative number. */
typedef struct integer {
    int32_t size;
    const uint64_t *limbs;
} integer;

/* Numbers are taken from it one after the other and given back by setting `used` to an earlier value. */
typedef struct integer_pool {
    uint32_t used, peak;
    uint64_t limbs[INTEGER_POOL_LIMBS];
} integer_pool;

void integer_pool_start(integer_pool *pool);

/* Keeps count numbers and gives back all others taken since pool->used was mark. */
void integer_pool_keep(integer_pool *pool, uint32_t mark, integer *numbers, int count);

/* Returns the exponent of the lowest bit set in x, which is finite and not 0: x is an odd multiple of 2 to
 * this power. */
int integer_lowest_bit(double x);

/* Returns x / 2^exponent, which must be an integer. */
integer integer_from_double(integer_pool *pool, double x, int exponent);
integer integer_from_int(integer_pool *pool, int64_t x);

integer integer_add(integer_pool *pool, integer a, integer b);
integer integer_subtract(integer_pool *pool, integer a, integer b);
integer integer_multiply(integer_pool *pool, integer a, integer b);

/* Returns a * factor, where |factor| is below 2^31. */
integer integer_scale(integer_pool *pool, integer a, int factor);

static inline integer integer_negate(integer a) {
    return (integer){-a.size, a.limbs};
}

static inline int integer_sign(integer a) {
    return (a.size > 0) - (a.size < 0);
}

/* Returns a number in (-1, 1). Times 2^*exponent it is a, to a relative error of 2^-52. Nothing over- or
 * underflows. */
double integer_to_double(integer a, int *exponent);

/* Returns the double nearest to a / b * 2^exponent, ties to even; b > 0. The quotient lies within the range of
 * doubles. */
double integer_nearest_quotient(integer_pool *pool, integer a, integer b, int exponent);
