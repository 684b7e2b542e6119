/* Finds the vector instructions of the processor. */
#include "src/core/processor.h"

#include <stddef.h>
#include <string.h>

#if defined(CSCD_WITH_AVX)

bool processor_has_simd(cscd_simd simd) {
    __builtin_cpu_init();
    if (simd == CSCD_SIMD_AVX512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    if (simd == CSCD_SIMD_AVX2) return __builtin_cpu_supports("avx2");
    return simd == CSCD_SIMD_SCALAR;
}

#elif defined(CSCD_WITH_NEON)

/* Every aarch64 processor has NEON. */
bool processor_has_simd(cscd_simd simd) {
    return simd == CSCD_SIMD_SCALAR || simd == CSCD_SIMD_NEON;
}

#else

bool processor_has_simd(cscd_simd simd) {
    return simd == CSCD_SIMD_SCALAR;
}

#endif

cscd_simd processor_best_simd(void) {
    cscd_simd simd = SIMD_LAST;
    while (!processor_has_simd(simd)) simd = (cscd_simd)(simd - 1);
    return simd;
}
