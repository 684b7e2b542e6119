/* The kernels that OpenBLAS has chosen, and those that it should have chosen. */
#include "preprocess/baselines/dense/blas_choice.h"

#include <stddef.h>
#include <string.h>

/* Weak: the program may be linked with another BLAS, or with none. */
__attribute__((weak)) char *openblas_get_corename(void);

/* The kernels of OpenBLAS (cpuid_x86.c, dynamic.c) that do not use AVX2. Others, and those of later processors, do. */
static const char *const old_cores[] = {
    "Katmai", "Coppermine", "Northwood",   "Prescott",  "Banias",     "Atom",         "Core2",
    "Penryn", "Dunnington", "Nehalem",     "Athlon",    "Opteron",    "Opteron_SSE3", "Barcelona",
    "Bobcat", "Nano",       "Sandybridge", "Bulldozer", "Piledriver", "Steamroller",
};

const char *blas_better_core(const char *core, bool avx2, bool avx512) {
    for (size_t i = 0; avx2 && i < sizeof old_cores / sizeof *old_cores; i++) {
        if (strcmp(core, old_cores[i]) == 0) return avx512 ? "SkylakeX" : "Haswell";
    }
    return NULL;
}

const char *blas_choice_name(void) {
    return openblas_get_corename != NULL ? openblas_get_corename() : NULL;
}

const char *blas_choice_better(void) {
    bool avx2 = false, avx512 = false;
    const char *core = blas_choice_name();
    if (core == NULL) return NULL;
#if defined(__x86_64__)
    __builtin_cpu_init();
    avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
#endif
    return blas_better_core(core, avx2, avx512);
}
