/* Reproducible random numbers: streams, and one stream for a whole test program, which random_seed starts again. */
#include "tests/support/random.h"

#include <math.h>

static random_stream stream;

void random_seed(uint64_t seed) {
    stream = stream_start(seed);
}

uint64_t random_bits(void) {
    return stream_bits(&stream);
}

int random_integer(int lowest, int highest) {
    return lowest + (int)stream_below(&stream, (uint32_t)(highest - lowest + 1));
}

double random_unit(void) {
    return ldexp((double)(int64_t)random_bits(), -63);
}

double random_between(double low, double high) {
    return stream_between(&stream, low, high);
}
