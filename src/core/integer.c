/* Integers of any sign and up to thousands of bits, in a pool on the caller's stack: no allocation.
 *
 * Multiplication is by the schoolbook: at the sizes that occur (mostly 1 to 4 limbs, always below 190)
 * nothing beats it by enough to be worth a dependency. */
#include "src/core/integer.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

__extension__ typedef unsigned __int128 wide;

void integer_pool_start(integer_pool *pool) {
    pool->used = pool->peak = 0;
}

static uint64_t *take_limbs(integer_pool *pool, int32_t limbs) {
    uint64_t *taken = pool->limbs + pool->used;
    pool->used += (uint32_t)limbs;
    assert(pool->used <= INTEGER_POOL_LIMBS);
    if (pool->used > pool->peak) pool->peak = pool->used;
    return taken;
}

static int32_t limb_count(integer a) {
    return a.size < 0 ? -a.size : a.size;
}

/* Drops leading zeros and gives their room back. These limbs must be the last that were taken. */
static integer finish_integer(integer_pool *pool, const uint64_t *limbs, int32_t count, bool negative) {
    while (count > 0 && limbs[count - 1] == 0) count--;
    pool->used = (uint32_t)(limbs - pool->limbs) + (uint32_t)count;
    return (integer){negative ? -count : count, limbs};
}

enum { KEEP_MAX = 16 };

/* Sorts the numbers by their place, so that none is overwritten before it is moved. Older ones stay where
 * they are. */
static int order_by_place(const integer_pool *pool, uint32_t mark, integer *numbers, int count,
                          integer *order[KEEP_MAX]) {
    int kept = 0;
    assert(count <= KEEP_MAX);
    for (int i = 0; i < count; i++) {
        if (numbers[i].size == 0 || numbers[i].limbs < pool->limbs + mark) continue;
        int j = kept++;
        for (; j > 0 && order[j - 1]->limbs > numbers[i].limbs; j--) order[j] = order[j - 1];
        order[j] = &numbers[i];
    }
    return kept;
}

void integer_pool_keep(integer_pool *pool, uint32_t mark, integer *numbers, int count) {
    integer *order[KEEP_MAX];
    const uint64_t *moved_from = NULL, *moved_to = NULL;
    int kept = order_by_place(pool, mark, numbers, count, order);
    pool->used = mark;
    for (int i = 0; i < kept; i++) {
        if (order[i]->limbs != moved_from) { /* otherwise it is the same number again, or its negative */
            int32_t limbs = limb_count(*order[i]);
            uint64_t *place = take_limbs(pool, limbs);
            moved_from = order[i]->limbs;
            moved_to = memmove(place, moved_from, (size_t)limbs * sizeof *place);
        }
        order[i]->limbs = moved_to;
    }
}

int integer_lowest_bit(double x) {
    int exponent;
    int64_t mantissa = (int64_t)ldexp(frexp(x, &exponent), 53);
    return exponent - 53 + __builtin_ctzll((uint64_t)mantissa);
}

/* Returns magnitude * 2^shift. */
static integer place_magnitude(integer_pool *pool, uint64_t magnitude, int shift, bool negative) {
    int32_t whole = shift / 64, bits = shift % 64;
    uint64_t *limbs = take_limbs(pool, whole + 2);
    memset(limbs, 0, (size_t)whole * sizeof *limbs);
    limbs[whole] = magnitude << bits;
    limbs[whole + 1] = bits == 0 ? 0 : magnitude >> (64 - bits);
    return finish_integer(pool, limbs, whole + 2, negative);
}

integer integer_from_double(integer_pool *pool, double x, int exponent) {
    if (x == 0.0) return (integer){0, pool->limbs};
    int own;
    uint64_t magnitude = (uint64_t)ldexp(frexp(fabs(x), &own), 53);
    int zeros = __builtin_ctzll(magnitude);
    return place_magnitude(pool, magnitude >> zeros, own - 53 + zeros - exponent, x < 0.0);
}

integer integer_from_int(integer_pool *pool, int64_t x) {
    return place_magnitude(pool, x < 0 ? -(uint64_t)x : (uint64_t)x, 0, x < 0);
}

/* Returns |a| + |b|, where |a| is no shorter. */
static integer add_magnitudes(integer_pool *pool, integer a, integer b, bool negative) {
    int32_t longer = limb_count(a), shorter = limb_count(b);
    uint64_t *limbs = take_limbs(pool, longer + 1);
    uint64_t carry = 0;
    for (int32_t i = 0; i < longer; i++) {
        wide sum = (wide)a.limbs[i] + (i < shorter ? b.limbs[i] : 0) + carry;
        limbs[i] = (uint64_t)sum;
        carry = (uint64_t)(sum >> 64);
    }
    limbs[longer] = carry;
    return finish_integer(pool, limbs, longer + 1, negative);
}

static int compare_magnitudes(integer a, integer b) {
    int32_t n = limb_count(a), m = limb_count(b);
    if (n != m) return n < m ? -1 : 1;
    while (n-- > 0) {
        if (a.limbs[n] != b.limbs[n]) return a.limbs[n] < b.limbs[n] ? -1 : 1;
    }
    return 0;
}

/* Returns |a| - |b|, where |a| is no smaller. */
static integer subtract_magnitudes(integer_pool *pool, integer a, integer b, bool negative) {
    int32_t longer = limb_count(a), shorter = limb_count(b);
    uint64_t *limbs = take_limbs(pool, longer);
    uint64_t borrow = 0;
    for (int32_t i = 0; i < longer; i++) {
        wide difference = (wide)a.limbs[i] - (i < shorter ? b.limbs[i] : 0) - borrow;
        limbs[i] = (uint64_t)difference;
        borrow = (uint64_t)(difference >> 64) & 1;
    }
    return finish_integer(pool, limbs, longer, negative);
}

integer integer_add(integer_pool *pool, integer a, integer b) {
    if (a.size == 0) return b;
    if (b.size == 0) return a;
    bool negative = a.size < 0;
    if (negative == (b.size < 0))
        return limb_count(a) >= limb_count(b) ? add_magnitudes(pool, a, b, negative)
                                              : add_magnitudes(pool, b, a, negative);
    return compare_magnitudes(a, b) >= 0 ? subtract_magnitudes(pool, a, b, negative)
                                         : subtract_magnitudes(pool, b, a, !negative);
}

integer integer_subtract(integer_pool *pool, integer a, integer b) {
    return integer_add(pool, a, integer_negate(b));
}

/* Adds a * factor to limbs, and returns what is carried out of them. */
static uint64_t add_product(uint64_t *limbs, const uint64_t *a, int32_t count, uint64_t factor) {
    uint64_t carry = 0;
    for (int32_t i = 0; i < count; i++) {
        wide sum = (wide)a[i] * factor + limbs[i] + carry;
        limbs[i] = (uint64_t)sum;
        carry = (uint64_t)(sum >> 64);
    }
    return carry;
}

integer integer_multiply(integer_pool *pool, integer a, integer b) {
    int32_t n = limb_count(a), m = limb_count(b);
    if (n == 0 || m == 0) return (integer){0, pool->limbs};
    uint64_t *limbs = take_limbs(pool, n + m);
    memset(limbs, 0, (size_t)n * sizeof *limbs);
    for (int32_t j = 0; j < m; j++) limbs[n + j] = add_product(limbs + j, a.limbs, n, b.limbs[j]);
    return finish_integer(pool, limbs, n + m, (a.size < 0) != (b.size < 0));
}

integer integer_scale(integer_pool *pool, integer a, int factor) {
    uint64_t magnitude = (uint64_t)(factor < 0 ? -(int64_t)factor : factor);
    return integer_multiply(pool, a, (integer){factor == 0 ? 0 : factor < 0 ? -1 : 1, &magnitude});
}

double integer_to_double(integer a, int *exponent) {
    int32_t count = limb_count(a);
    *exponent = 0;
    if (count == 0) return 0.0;
    double value = (double)a.limbs[count - 1];
    if (count > 1) value += ldexp((double)a.limbs[count - 2], -64);
    int own;
    value = frexp(value, &own);
    *exponent = own + 64 * (count - 1);
    return a.size < 0 ? -value : value;
}

/* a 2^exponent - x b, over a power of 2. */
static integer rest_of_quotient(integer_pool *pool, integer a, integer b, int exponent, double x) {
    int unit = exponent;
    if (x != 0.0 && integer_lowest_bit(x) < unit) unit = integer_lowest_bit(x);
    integer left = integer_multiply(pool, a, place_magnitude(pool, 1, exponent - unit, false));
    return integer_subtract(pool, left, integer_multiply(pool, b, integer_from_double(pool, x, unit)));
}

/* The sign of a 2^exponent / b minus the middle between x and y. */
static int side_of_middle(integer_pool *pool, integer a, integer b, int exponent, double x, double y) {
    int unit = exponent;
    if (x != 0.0 && integer_lowest_bit(x) < unit) unit = integer_lowest_bit(x);
    if (y != 0.0 && integer_lowest_bit(y) < unit) unit = integer_lowest_bit(y);
    integer sum = integer_add(pool, integer_from_double(pool, x, unit), integer_from_double(pool, y, unit));
    integer twice = integer_multiply(pool, a, place_magnitude(pool, 1, exponent - unit + 1, false));
    return integer_sign(integer_subtract(pool, twice, integer_multiply(pool, b, sum)));
}

static bool is_even(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits % 2 == 0;
}

double integer_nearest_quotient(integer_pool *pool, integer a, integer b, int exponent) {
    uint32_t mark = pool->used;
    int of_a, of_b;
    double top = integer_to_double(a, &of_a), bottom = integer_to_double(b, &of_b);
    double x = a.size == 0 ? 0.0 : ldexp(top / bottom, of_a - of_b + exponent);
    for (bool done = a.size == 0; !done;) { /* x is off by a few units in the last place at most */
        int side = integer_sign(rest_of_quotient(pool, a, b, exponent, x));
        double next = nextafter(x, side * (double)INFINITY);
        int beyond = side == 0 ? -1 : side * side_of_middle(pool, a, b, exponent, x, next);
        done = beyond < 0 || (beyond == 0 && is_even(x));
        if (!done) x = next;
        pool->used = mark;
    }
    return x;
}
