/* io_realloc of the tests, which fails once when its time has come. */
#include "tests/support/files.h"

#include <stddef.h>

long io_allocations_left = -1;
bool io_allocation_failed;

void *__real_io_realloc(void *memory, size_t size);
void *__wrap_io_realloc(void *memory, size_t size);

void *__wrap_io_realloc(void *memory, size_t size) {
    if (io_allocations_left-- != 0) return __real_io_realloc(memory, size);
    io_allocation_failed = true;
    return NULL;
}

bool io_allocations_go_on(long place) {
    const bool goes_on = place == 0 || io_allocation_failed;
    io_allocations_left = goes_on ? place : -1;
    io_allocation_failed = false;
    return goes_on;
}
