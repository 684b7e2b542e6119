/* The one function that libcscd-charge exports. */
#include "preprocess/charge/charge_interface.h"

CSCD_API charge_entry cscd_charge_functions;

const charge_functions *cscd_charge_functions(uint32_t interface) {
    return charge_functions_of(interface);
}
