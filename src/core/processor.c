/* Finds the vector instructions of the processor. */
#include "src/core/processor.h"

#include <stddef.h>
#include <string.h>

static const char *const simd_names[] = {"auto", "scalar", "avx2", "avx512"};

const char *cscd_simd_name(cscd_simd simd) {
    return (unsigned)simd <= CSCD_SIMD_AVX512 ? simd_names[simd] : "unknown";
}

bool cscd_simd_from_name(const char *name, cscd_simd *out) {
    for (size_t i = 0; i < sizeof simd_names / sizeof *simd_names; i++) {
        if (strcmp(name, simd_names[i]) != 0) continue;
        *out = (cscd_simd)i;
        return true;
    }
    return false;
}

cscd_simd processor_best_simd(void) {
#ifdef CSCD_WITH_AVX
    __builtin_cpu_init();
    bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                  __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    if (avx512) return CSCD_SIMD_AVX512;
    if (__builtin_cpu_supports("avx2")) return CSCD_SIMD_AVX2;
#endif
    return CSCD_SIMD_SCALAR;
}
