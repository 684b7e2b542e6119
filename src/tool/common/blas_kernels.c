/* Which kernels OpenBLAS runs. */
#include "src/tool/common/blas_kernels.h"

#include "src/tool/common/command.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define CORE_VARIABLE "OPENBLAS_CORETYPE"

/* Weak: the program may be linked with another BLAS, or with none. */
__attribute__((weak)) char *openblas_get_corename(void);

/* The kernels of OpenBLAS (cpuid_x86.c, dynamic.c) that do not use AVX2. Others, and those of later processors, do. */
static const char *const old_cores[] = {
    "Katmai", "Coppermine", "Northwood",   "Prescott",  "Banias",     "Atom",         "Core2",
    "Penryn", "Dunnington", "Nehalem",     "Athlon",    "Opteron",    "Opteron_SSE3", "Barcelona",
    "Bobcat", "Nano",       "Sandybridge", "Bulldozer", "Piledriver", "Steamroller",
};

const char *blas_kernels_better(const char *core, bool avx2, bool avx512) {
    for (size_t i = 0; avx2 && i < sizeof old_cores / sizeof *old_cores; i++) {
        if (strcmp(core, old_cores[i]) == 0) return avx512 ? "SkylakeX" : "Haswell";
    }
    return NULL;
}

static const char *better_kernels_here(void) {
    bool avx2 = false, avx512 = false;
    if (openblas_get_corename == NULL) return NULL;
#if defined(__x86_64__)
    __builtin_cpu_init();
    avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
#endif
    return blas_kernels_better(openblas_get_corename(), avx2, avx512);
}

void blas_kernels_run_again(char **arguments) {
    if (getenv(CORE_VARIABLE) != NULL) return;
    const char *better = better_kernels_here();
    if (better == NULL || setenv(CORE_VARIABLE, better, 1) != 0) return;
    execv("/proc/self/exe", arguments);
    unsetenv(CORE_VARIABLE);
}

void blas_kernels_warn(void) {
    const char *better = better_kernels_here();
    if (better == NULL) return;
    warn("OpenBLAS runs its kernels for %s, which are slow on this processor: with " CORE_VARIABLE
         "=%s a plan by charge takes about a third of the time",
         openblas_get_corename(), better);
}
