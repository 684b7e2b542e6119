/* The functions of GSL that libcscd-baselines exports. They of GSL call no error handler, and cannot fail. */
#include "runtime/baselines/plain_cubic.h"
#include "src/core/baseline_library.h"

#include <gsl/gsl_poly.h>

CSCD_API baseline_entry cscd_baseline_plain_cubic;

const void *cscd_baseline_plain_cubic(uint32_t interface) {
    static const plain_cubic_functions functions = {gsl_poly_solve_cubic, gsl_poly_solve_quadratic};
    return interface == PLAIN_CUBIC_INTERFACE ? &functions : NULL;
}
