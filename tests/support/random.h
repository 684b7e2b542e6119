/* One random stream for a whole test program; random_seed starts it again. */
#pragma once

#include <stdint.h>

void random_seed(uint64_t seed);

uint64_t random_bits(void);

/* Returns a whole number in [lowest, highest]. */
int random_integer(int lowest, int highest);

/* Returns a number in [-1, 1) that uses all bits of a double. */
double random_unit(void);

/* Returns a number in [low, high], up to rounding. */
double random_between(double low, double high);
