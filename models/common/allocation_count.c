/* An allocator for a context that counts how often it is asked for memory. */
#include "models/common/allocation_count.h"

#include <stdlib.h>

static void *count_and_allocate(void *user, size_t size, size_t alignment) {
    ++*(uint64_t *)user;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void free_block(void *user, void *block, size_t size) {
    (void)user;
    (void)size;
    free(block);
}

cscd_allocator allocation_count_interface(uint64_t *count) {
    return (cscd_allocator){count_and_allocate, free_block, count};
}
