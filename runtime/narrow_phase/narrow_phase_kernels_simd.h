/* The kernels of the narrow phase under the names that they have on the level that is compiled. */
#pragma once

#include "runtime/narrow_phase/narrow_phase_kernels.h"
#include "src/core/simd.h"

feature_filter_kernel SIMD_NAME(feature_filter);
represent_kernel SIMD_NAME(represent);
