/* The mesh readers get memory here, in a file of its own, so that a test that has a failing io_realloc links
 * without it. */
#include "tool/io/io.h"

#include <stdlib.h>

void *io_realloc(void *memory, size_t size) {
    return realloc(memory, size);
}
