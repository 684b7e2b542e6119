/* The kernels for pairs of features under the names that they have on the level that is compiled. */
#pragma once

#include "runtime/ccd/ccd_kernels.h"
#include "src/core/simd.h"

void SIMD_NAME(reject_by_signs_vf)(const feature_source *source, feature_pairs *pairs);
void SIMD_NAME(reject_by_signs_ee)(const feature_source *source, feature_pairs *pairs);
root_kernel SIMD_NAME(roots_vf), SIMD_NAME(roots_ee);
root_kernel SIMD_NAME(two_roots_vf), SIMD_NAME(two_roots_ee);
describe_kernel SIMD_NAME(describe_vf), SIMD_NAME(describe_ee);
proximity_kernel SIMD_NAME(proximity_vf), SIMD_NAME(proximity_ee);
