/* One random stream for a whole test program; random_seed starts it anew. */
#pragma once

#include <stdint.h>

void random_seed(uint64_t seed);

uint64_t random_bits(void);

/* Both ends included. */
int random_integer(int lowest, int highest);

/* In [-1, 1), all bits of the double in use. */
double random_unit(void);

/* In [low, high], up to rounding. */
double random_between(double low, double high);
