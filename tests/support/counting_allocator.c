/* An allocator that counts its calls and can be told to fail. */
#include "tests/support/counting_allocator.h"

#include <stdlib.h>
#include <string.h>

counting_allocator counting_allocator_start(void) {
    return (counting_allocator){.fail_at = SIZE_MAX};
}

static void *count_and_allocate(void *user, size_t size, size_t alignment) {
    counting_allocator *counter = user;
    if (counter->calls++ == counter->fail_at) return NULL;
    void *block = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (block == NULL) return NULL;
    counter->live++;
    counter->bytes += size;
    if (counter->bytes > counter->peak) counter->peak = counter->bytes;
    return block;
}

static void count_and_release(void *user, void *block, size_t size) {
    counting_allocator *counter = user;
    counter->live--;
    counter->bytes -= size;
    memset(block, 0xdd, size); /* so that what is read after its release is noticed */
    __asm__ volatile("" : : "r"(block) : "memory");
    free(block);
}

cscd_allocator counting_allocator_interface(counting_allocator *counter) {
    return (cscd_allocator){count_and_allocate, count_and_release, counter};
}
