/* What stands in the place of libcscd-baselines in the tests on Windows and in WebAssembly, which have none: it hands out the dense
 * solver of the tests. */
#include "preprocess/baselines/dense/dense.h"
#include "src/core/baseline_library.h"

#include <string.h>

cscd_status baseline_library_find(cscd_context *context, const char *entry_name, uint32_t interface,
                                  const char *what, const void **out) {
    *out = strcmp(entry_name, DENSE_ENTRY) == 0 ? dense_functions_of(interface) : NULL;
    return *out != NULL ? CSCD_OK : context_fail(context, CSCD_SYSTEM_ERROR, "%s is not there", what);
}
