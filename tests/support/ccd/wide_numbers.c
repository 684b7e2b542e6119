/* Numbers wider than a double: integers of up to 2112 bits, an oracle that shares nothing with the code under test;
 * floats of 113 bits. */
#include "tests/support/ccd/wide_numbers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void append_limb(struct exact_integer *a, uint32_t limb) {
    if (a->limb_count == EXACT_LIMB_COUNT) {
        fprintf(stderr, "exact_integer: more than %d limbs\n", EXACT_LIMB_COUNT);
        abort();
    }
    a->limb[a->limb_count++] = limb;
}

static void trim_limbs(struct exact_integer *a) {
    while (a->limb_count > 0 && a->limb[a->limb_count - 1] == 0) a->limb_count--;
    if (a->limb_count == 0) a->sign = 0;
}

static int compare_magnitudes(const struct exact_integer *a, const struct exact_integer *b) {
    if (a->limb_count != b->limb_count) return a->limb_count < b->limb_count ? -1 : 1;
    for (int i = a->limb_count - 1; i >= 0; i--) {
        if (a->limb[i] != b->limb[i]) return a->limb[i] < b->limb[i] ? -1 : 1;
    }
    return 0;
}

static uint32_t limb_at(const struct exact_integer *a, int i) {
    return i < a->limb_count ? a->limb[i] : 0;
}

static struct exact_integer add_magnitudes(const struct exact_integer *a, const struct exact_integer *b,
                                           int sign) {
    struct exact_integer result = {.sign = sign};
    uint64_t carry = 0;

    for (int i = 0; i < a->limb_count || i < b->limb_count || carry != 0; i++) {
        carry += (uint64_t)limb_at(a, i) + limb_at(b, i);
        append_limb(&result, (uint32_t)carry);
        carry >>= 32;
    }
    trim_limbs(&result);
    return result;
}

/* |a| >= |b| */
static struct exact_integer subtract_magnitudes(const struct exact_integer *a, const struct exact_integer *b,
                                                int sign) {
    struct exact_integer result = {.sign = sign};
    uint64_t borrow = 0;

    for (int i = 0; i < a->limb_count; i++) {
        uint64_t taken = (uint64_t)limb_at(b, i) + borrow;

        borrow = taken > a->limb[i];
        append_limb(&result, (uint32_t)(a->limb[i] - taken));
    }
    trim_limbs(&result);
    return result;
}

struct exact_integer exact_from_double(double value) {
    struct exact_integer result = {.sign = (value > 0.0) - (value < 0.0)};
    int exponent;
    double mantissa = frexp(fabs(value), &exponent);
    uint64_t bits = (uint64_t)ldexp(mantissa, 53);
    int shift = exponent - 53 - EXACT_UNIT_EXPONENT;

    if (value == 0.0) return result;
    if (shift < 0 || exponent > 301) {
        fprintf(stderr, "exact_integer: %a is outside the domain\n", value);
        abort();
    }
    for (int i = 0; i < shift / 32; i++) append_limb(&result, 0);
    append_limb(&result, (uint32_t)(bits << shift % 32));
    append_limb(&result, (uint32_t)(bits >> (32 - shift % 32)));
    append_limb(&result, (uint32_t)(bits >> 32 >> (32 - shift % 32)));
    trim_limbs(&result);
    return result;
}

struct exact_integer exact_add(const struct exact_integer *a, const struct exact_integer *b) {
    if (a->sign == 0) return *b;
    if (b->sign == 0) return *a;
    if (a->sign == b->sign) return add_magnitudes(a, b, a->sign);
    if (compare_magnitudes(a, b) >= 0) return subtract_magnitudes(a, b, a->sign);
    return subtract_magnitudes(b, a, b->sign);
}

struct exact_integer exact_subtract(const struct exact_integer *a, const struct exact_integer *b) {
    struct exact_integer negative = *b;

    negative.sign = -b->sign;
    return exact_add(a, &negative);
}

struct exact_integer exact_multiply(const struct exact_integer *a, const struct exact_integer *b) {
    struct exact_integer result = {.sign = a->sign * b->sign};

    for (int i = 0; i < a->limb_count + b->limb_count; i++) append_limb(&result, 0);
    for (int i = 0; i < a->limb_count; i++) {
        uint64_t carry = 0;

        for (int j = 0; j < b->limb_count; j++) {
            carry += (uint64_t)a->limb[i] * b->limb[j] + result.limb[i + j];
            result.limb[i + j] = (uint32_t)carry;
            carry >>= 32;
        }
        result.limb[i + b->limb_count] = (uint32_t)carry;
    }
    trim_limbs(&result);
    return result;
}
