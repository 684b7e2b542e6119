/* The tool sees to it that OpenBLAS runs kernels for the processor (src/blas/blas_choice.h). */
#pragma once

/* Runs the program again with OPENBLAS_CORETYPE set, if OpenBLAS has chosen kernels below the processor's. It chooses when it is
 * loaded, so nothing else helps. A variable that is set already is the user's choice, or ours, and stays. Returns when there is
 * nothing to do, or when the program cannot be run again. arguments: those of main. */
void blas_kernels_run_again(char **arguments);

/* Says on stderr when the kernels are below the processor's all the same. */
void blas_kernels_warn(void);
