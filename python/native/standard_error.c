/* The stream that libpng writes to inside the module, in place of the C library's variable: see link.sh. */
#include "python/native/exports.h"

#include <stdio.h>

extern FILE *cscdpy_standard_error;
FILE *cscdpy_standard_error;

__attribute__((constructor)) static void find_stream(void) {
    cscdpy_standard_error = stderr;
}
