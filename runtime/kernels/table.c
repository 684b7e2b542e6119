/* The table of one level: compiled once per instruction set. */
#include "runtime/kernels/kernels.h"

#include "src/simd.h"

#define NAME_OF_LEVEL(level) (level == SIMD_AVX512 ? "avx512" : level == SIMD_AVX2 ? "avx2" : "scalar")

const kernels SIMD_NAME(kernels) = {
    .name = NAME_OF_LEVEL(SIMD_LEVEL),
};
