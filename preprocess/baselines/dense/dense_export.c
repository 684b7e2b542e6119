/* The interface of the dense solution that libcscd-baselines exports. */
#include "preprocess/baselines/dense/dense.h"

#include "src/core/baseline_library.h"

CSCD_API baseline_entry cscd_baseline_dense;

const void *cscd_baseline_dense(uint32_t interface) {
    return dense_functions_of(interface);
}
