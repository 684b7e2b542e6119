/* Which kernels OpenBLAS runs. On a processor that it does not know it takes those of 2004, with which a plan by charge takes
 * about three times as long, and says nothing. */
#pragma once

#include <stdbool.h>

/* Returns the core type that OpenBLAS should be told in place of `core`, its own choice, on a processor with AVX2 and FMA, or with
 * AVX-512 (F, VL, DQ, BW) too; NULL: its choice will do. */
const char *blas_kernels_better(const char *core, bool avx2, bool avx512);

/* Runs the program again with OPENBLAS_CORETYPE set, if OpenBLAS has chosen kernels below the processor's. It chooses when it is
 * loaded, so nothing else helps. A variable that is set already is the user's choice, or ours, and stays. Returns when there is
 * nothing to do, or when the program cannot be run again. arguments: those of main. */
void blas_kernels_run_again(char **arguments);

/* Says on stderr when the kernels are below the processor's all the same. */
void blas_kernels_warn(void);
