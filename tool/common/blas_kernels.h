/* The tool sees to it that OpenBLAS starts as it should: on one thread, and with kernels for the processor. */
#pragma once

#include <stdbool.h>

/* The process is the tool's own, not one that has the tool as a library: it may change its environment. */
void blas_kernels_own_process(void);

/* Called before charge is solved for by a dense matrix, which loads OpenBLAS. That starts its threads and chooses its kernels when it is
 * loaded, and listens to the environment alone. So in a process of our own this sets OPENBLAS_NUM_THREADS to 1, because the
 * threads are ours, and lets another process find out which kernels would be chosen: if these are below the processor's, it
 * sets OPENBLAS_CORETYPE to what is better. A variable that is set already is the user's choice and stays; warns: says on
 * stderr when that leaves kernels below the processor's. */
void blas_kernels_prepare(bool warns);
