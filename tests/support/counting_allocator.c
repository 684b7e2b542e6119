/* An allocator that counts its calls and can be told to fail. */
#include "tests/support/counting_allocator.h"

#include "src/core/system.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GUARD_SIZE = 256, GUARD_BYTE = 0xdd }; /* behind each block */

counting_allocator counting_allocator_start(void) {
    return (counting_allocator){.fail_at = SIZE_MAX};
}

static void *count_and_allocate(void *user, size_t size, size_t alignment) {
    counting_allocator *counter = user;
    if (counter->calls++ == counter->fail_at) return NULL;
    unsigned char *block = system_memory(size + GUARD_SIZE, alignment);
    if (block == NULL) return NULL;
    memset(block + size, GUARD_BYTE, GUARD_SIZE);
    counter->live++;
    counter->bytes += size;
    if (counter->bytes > counter->peak) counter->peak = counter->bytes;
    return block;
}

/* Ends the program: a test that has written there has shown nothing. */
static void check_guard(const unsigned char *guard, size_t size) {
    for (size_t i = 0; i < GUARD_SIZE; i++) {
        if (guard[i] == GUARD_BYTE) continue;
        fprintf(stderr, "counting_allocator: byte %zu behind a block of %zu was written\n", i, size);
        abort();
    }
}

static void count_and_release(void *user, void *block, size_t size) {
    counting_allocator *counter = user;
    check_guard((const unsigned char *)block + size, size);
    counter->live--;
    counter->bytes -= size;
    memset(block, GUARD_BYTE, size); /* so that what is read after its release is noticed */
    __asm__ volatile("" : : "r"(block) : "memory");
    system_memory_free(block);
}

cscd_allocator counting_allocator_interface(counting_allocator *counter) {
    return (cscd_allocator){count_and_allocate, count_and_release, counter};
}
