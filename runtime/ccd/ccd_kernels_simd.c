/* The table of the kernels for pairs of features, one per instruction set. */
#include "runtime/ccd/ccd_kernels_simd.h"

const ccd_kernels SIMD_NAME(ccd_kernels) = {
    .reject_by_signs_vf = SIMD_NAME(reject_by_signs_vf),
    .reject_by_signs_ee = SIMD_NAME(reject_by_signs_ee),
    .roots_vf = SIMD_NAME(roots_vf),
    .roots_ee = SIMD_NAME(roots_ee),
    .two_roots_vf = SIMD_NAME(two_roots_vf),
    .two_roots_ee = SIMD_NAME(two_roots_ee),
    .describe_vf = SIMD_NAME(describe_vf),
    .describe_ee = SIMD_NAME(describe_ee),
    .proximity_vf = SIMD_NAME(proximity_vf),
    .proximity_ee = SIMD_NAME(proximity_ee),
};
