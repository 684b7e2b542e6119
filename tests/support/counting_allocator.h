/* An allocator that counts its calls, can be told to fail, and ends the program where a caller has written behind a block. */
#pragma once

#include "cscd/cscd.h"

typedef struct counting_allocator {
    size_t calls;       /* calls of allocate */
    size_t fail_at;     /* the number of the call that fails; SIZE_MAX: none */
    size_t live, bytes; /* blocks and bytes not yet released */
    size_t peak;        /* the most bytes at one time */
} counting_allocator;

counting_allocator counting_allocator_start(void);
cscd_allocator counting_allocator_interface(counting_allocator *counter);
