/* The table of the narrow phase's kernels, one per instruction set. */
#include "runtime/narrow_phase/narrow_phase_kernels_simd.h"

const narrow_phase_kernels SIMD_NAME(narrow_phase_kernels) = {
    .feature_filter = SIMD_NAME(feature_filter),
    .represent = SIMD_NAME(represent),
};
