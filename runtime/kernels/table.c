/* The table of one level: compiled once per instruction set. */
#include "runtime/kernels/this_level.h"

#define NAME_OF_LEVEL(level) (level == SIMD_AVX512 ? "avx512" : level == SIMD_AVX2 ? "avx2" : "scalar")

const kernels SIMD_NAME(kernels) = {
    .name = NAME_OF_LEVEL(SIMD_LEVEL),
    .copy_in = SIMD_NAME(copy_in),
    .refit = SIMD_NAME(refit),
    .orient = SIMD_NAME(orient),
    .search = SIMD_NAME(search),
};
