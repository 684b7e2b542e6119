/* The table of one level: compiled once per instruction set. */
#include "runtime/bvh/this_level.h"

#include "runtime/ccd/ccd_kernels.h"

#define NAME_OF_LEVEL(level) (level == SIMD_AVX512 ? "avx512" : level == SIMD_AVX2 ? "avx2" : "scalar")

const kernels SIMD_NAME(kernels) = {
    .name = NAME_OF_LEVEL(SIMD_LEVEL),
    .copy_in = SIMD_NAME(copy_in),
    .refit = SIMD_NAME(refit),
    .extents_at_start = SIMD_NAME(extents_at_start),
    .orient = SIMD_NAME(orient),
    .search = SIMD_NAME(search),
    .feature_filter = SIMD_NAME(feature_filter),
    .represent = SIMD_NAME(represent),
    .keep_open_vf = SIMD_NAME(keep_open_vf),
    .keep_open_ee = SIMD_NAME(keep_open_ee),
    .roots_vf = SIMD_NAME(roots_vf),
    .roots_ee = SIMD_NAME(roots_ee),
    .two_roots_vf = SIMD_NAME(two_roots_vf),
    .two_roots_ee = SIMD_NAME(two_roots_ee),
    .proximity_vf = SIMD_NAME(proximity_vf),
    .proximity_ee = SIMD_NAME(proximity_ee),
    .keep_meeting = SIMD_NAME(keep_meeting),
    .keep_thin = SIMD_NAME(keep_thin),
};
