/* The one function that libcscd-charge exports. */
#include "preprocess/dense/dense_interface.h"

CSCD_API dense_entry cscd_charge_functions;

const dense_functions *cscd_charge_functions(uint32_t interface) {
    return dense_functions_of(interface);
}
