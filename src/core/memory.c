/* Blocks of memory from the host's allocator: zeroed, aligned, counted. */
#include "src/core/memory.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Precedes each block and fills one alignment unit, so that the block itself is aligned. */
typedef struct block_header {
    size_t size; /* of the whole, header included */
} block_header;

_Static_assert(sizeof(block_header) <= MEMORY_ALIGNMENT, "a header fills one alignment unit");

static void *system_allocate(void *user, size_t size, size_t alignment) {
    (void)user;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void system_release(void *user, void *block, size_t size) {
    (void)user;
    (void)size;
    free(block);
}

cscd_allocator memory_system_allocator(void) {
    return (cscd_allocator){system_allocate, system_release, NULL};
}

bool memory_begin(host_memory *m, cscd_allocator allocator) {
    m->allocator = allocator;
    atomic_init(&m->bytes, 0);
    return pthread_mutex_init(&m->lock, NULL) == 0;
}

void memory_end(host_memory *m) {
    pthread_mutex_destroy(&m->lock);
}

void *memory_allocate(host_memory *m, size_t count, size_t size) {
    if (size != 0 && count > (SIZE_MAX / 2 - MEMORY_ALIGNMENT) / size) return NULL;
    size_t whole = count * size + MEMORY_ALIGNMENT;
    pthread_mutex_lock(&m->lock);
    char *block = m->allocator.allocate(m->allocator.user, whole, MEMORY_ALIGNMENT);
    if (block != NULL) m->bytes += whole;
    pthread_mutex_unlock(&m->lock);
    if (block == NULL) return NULL;
    memset(block, 0, whole);
    ((block_header *)block)->size = whole;
    return block + MEMORY_ALIGNMENT;
}

void *memory_grow(host_memory *m, void *block, size_t old_count, size_t new_count, size_t size) {
    assert(old_count <= new_count);
    void *grown = memory_allocate(m, new_count, size);
    if (grown == NULL) return NULL;
    if (block != NULL) memcpy(grown, block, old_count * size);
    memory_free(m, block);
    return grown;
}

void memory_free(host_memory *m, void *block) {
    if (block == NULL) return;
    char *whole_block = (char *)block - MEMORY_ALIGNMENT;
    size_t whole = ((block_header *)whole_block)->size;
    pthread_mutex_lock(&m->lock);
    assert(whole <= m->bytes);
    m->bytes -= whole;
    m->allocator.release(m->allocator.user, whole_block, whole);
    pthread_mutex_unlock(&m->lock);
}

/* ---- the arrays of a structure ------------------------------------------------------------------------- */

/* Pointers of different types are written as bytes. */
static void set_pointer(void *pointer, void *value) {
    memcpy(pointer, &value, sizeof value);
}

void memory_free_all(host_memory *m, array_list list) {
    for (const array_block *block = list.blocks; block->pointer != NULL; block++) {
        void *array;
        memcpy(&array, block->pointer, sizeof array);
        memory_free(m, array);
        set_pointer(block->pointer, NULL);
    }
}

bool memory_allocate_all(host_memory *m, array_list list) {
    for (const array_block *block = list.blocks; block->pointer != NULL; block++)
        set_pointer(block->pointer, NULL);
    for (const array_block *block = list.blocks; block->pointer != NULL; block++) {
        if (block->size == 0) continue;
        void *array = memory_allocate(m, block->count, block->size);
        if (array == NULL) {
            memory_free_all(m, list);
            return false;
        }
        set_pointer(block->pointer, array);
    }
    return true;
}
