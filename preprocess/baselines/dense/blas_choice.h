/* The kernels that OpenBLAS has chosen, and those that it should have chosen. It chooses by the processor's
 * model when it is loaded. On one that it does not know it takes kernels of 2004, with which a plan by charge
 * takes about three times as long, and says nothing. */
#pragma once

#include <stdbool.h>

/* Returns the name of the kernels in OpenBLAS, such as "SkylakeX"; NULL: another BLAS is linked here, or
 * none. */
const char *blas_choice_name(void);

/* Returns what OPENBLAS_CORETYPE should be set to before OpenBLAS is loaded; NULL: the choice will do, or nobody knows it. */
const char *blas_choice_better(void);

/* Returns the core type in place of `core` on a processor with AVX2 and FMA, or with AVX-512 (F, VL, DQ, BW) too; NULL: it will do. */
const char *blas_better_core(const char *core, bool avx2, bool avx512);
