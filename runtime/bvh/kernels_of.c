/* Which table of inner loops serves a context. */
#include "runtime/bvh/kernels.h"

const kernels *kernels_of(const cscd_context *context) {
#ifdef CSCD_WITH_AVX
    if (context->simd == CSCD_SIMD_AVX512) return &kernels_avx512;
    if (context->simd == CSCD_SIMD_AVX2) return &kernels_avx2;
#else
    (void)context;
#endif
    return &kernels_scalar;
}
