/* Numbers wider than a double: integers of up to 2112 bits, an oracle that shares nothing with the code under test;
 * floats of 113 bits. */
#pragma once

#include <float.h>
#include <stdint.h>

#define EXACT_LIMB_COUNT 66

/* The lowest bit of a double of magnitude 2^-300 or more, the unit of exact_from_double. */
#define EXACT_UNIT_EXPONENT (-352)

/* Sign and magnitude, lowest limb first; the leading limb is not 0, zero has no limb. A result that does not
 * fit ends the program. */
struct exact_integer {
    int sign;
    int limb_count;
    uint32_t limb[EXACT_LIMB_COUNT];
};

/* value / 2^EXACT_UNIT_EXPONENT; value is 0 or has a magnitude in [2^-300, 2^300]. */
struct exact_integer exact_from_double(double value);

struct exact_integer exact_add(const struct exact_integer *a, const struct exact_integer *b);
struct exact_integer exact_subtract(const struct exact_integer *a, const struct exact_integer *b);
struct exact_integer exact_multiply(const struct exact_integer *a, const struct exact_integer *b);

/* Floats of 113 bits are an own type of compilers for x86, and what long double is on other 64-bit processors. */
#if LDBL_MANT_DIG == 113
typedef long double float113;
#else
typedef __float128 float113;
#endif
