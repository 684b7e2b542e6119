/* A build for Windows has no OpenBLAS, so there is nothing to see to before a plan is made. */
#include "tool/common/plans.h"

void blas_kernels_own_process(void) {
}

void blas_kernels_prepare(bool warns) {
    (void)warns;
}
