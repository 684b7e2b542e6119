/* The tool sees to it that OpenBLAS runs kernels for the processor. */
#include "src/tool/common/blas_kernels.h"

#include "src/blas/blas_choice.h"
#include "src/tool/common/command.h"

#include <stddef.h>
#include <stdlib.h>
#include <unistd.h>

#define CORE_VARIABLE "OPENBLAS_CORETYPE"

void blas_kernels_run_again(char **arguments) {
    if (getenv(CORE_VARIABLE) != NULL) return;
    const char *better = blas_choice_better();
    if (better == NULL || setenv(CORE_VARIABLE, better, 1) != 0) return;
    execv("/proc/self/exe", arguments);
    unsetenv(CORE_VARIABLE);
}

void blas_kernels_warn(void) {
    const char *better = blas_choice_better();
    if (better == NULL) return;
    warn("OpenBLAS runs its kernels for %s, which are slow on this processor: with " CORE_VARIABLE
         "=%s a plan by charge takes about a third of the time",
         blas_choice_name(), better);
}
