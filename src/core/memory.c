/* Blocks of memory from the host's allocator: zeroed, aligned, counted. */
#include "src/core/memory.h"

#include "src/core/system.h"

#include <assert.h>
#include <string.h>

/* Precedes each block and fills one alignment unit, so that the block itself is aligned. */
typedef struct memory_block {
    size_t size; /* of the whole, header included */
} memory_block;

_Static_assert(sizeof(memory_block) <= MEMORY_ALIGNMENT, "a header fills one alignment unit");

static void *system_allocate(void *user, size_t size, size_t alignment) {
    (void)user;
    return system_memory(size, alignment);
}

static void system_release(void *user, void *block, size_t size) {
    (void)user;
    (void)size;
    system_memory_free(block);
}

/* Much else may be on the machine, other objects too. */
enum { SHARE_OF_MEMORY_LEFT = 4 };

size_t memory_share(void) {
    const size_t share = system_memory_left() / SHARE_OF_MEMORY_LEFT;
    return share > 0 ? share : 1;
}

cscd_allocator memory_system_allocator(void) {
    return (cscd_allocator){system_allocate, system_release, NULL};
}

bool memory_begin(host_memory *m, cscd_allocator allocator, entry_state *entry) {
    m->allocator = allocator;
    m->entry = entry;
    atomic_init(&m->bytes, 0);
    return pthread_mutex_init(&m->lock, NULL) == 0;
}

/* ---- blocks -------------------------------------------------------------------------------------------- */

/* In debug builds reserved memory holds nonsense, so that a read that comes too early is noticed. */
enum { AS_IT_WAS = -1 };
#ifdef NDEBUG
enum { RESERVED = AS_IT_WAS };
#else
enum { RESERVED = 0xcd };
#endif

/* Our own allocator cares for no environment. */
static entry_state *state_for_host(const host_memory *m) {
    return m->allocator.allocate != system_allocate ? m->entry : NULL;
}

static memory_block *take_block(host_memory *m, size_t size) {
    pthread_mutex_lock(&m->lock);
    host_call call = host_call_begin(state_for_host(m));
    memory_block *block = m->allocator.allocate(m->allocator.user, size, MEMORY_ALIGNMENT);
    host_call_end(&call);
    if (block != NULL) {
        block->size = size;
        m->bytes += size;
    }
    pthread_mutex_unlock(&m->lock);
    return block;
}

static void give_back(host_memory *m, memory_block *block) {
    pthread_mutex_lock(&m->lock);
    assert(block->size <= m->bytes);
    m->bytes -= block->size;
    host_call call = host_call_begin(state_for_host(m));
    m->allocator.release(m->allocator.user, block, block->size);
    host_call_end(&call);
    pthread_mutex_unlock(&m->lock);
}

static void *allocate_filled(host_memory *m, size_t count, size_t size, int byte) {
    if (size != 0 && count > (SIZE_MAX / 2 - MEMORY_ALIGNMENT) / size) return NULL;
    memory_block *block = take_block(m, count * size + MEMORY_ALIGNMENT);
    if (block == NULL) return NULL;
    void *array = (char *)block + MEMORY_ALIGNMENT;
    if (byte != AS_IT_WAS) memset(array, byte, count * size);
    return array;
}

void *memory_allocate(host_memory *m, size_t count, size_t size) {
    return allocate_filled(m, count, size, 0);
}

void *memory_reserve(host_memory *m, size_t count, size_t size) {
    return allocate_filled(m, count, size, RESERVED);
}

void memory_free(host_memory *m, void *block) {
    if (block != NULL) give_back(m, (memory_block *)((char *)block - MEMORY_ALIGNMENT));
}

void memory_end(host_memory *m) {
    pthread_mutex_destroy(&m->lock);
}

void *memory_grow(host_memory *m, void *block, size_t old_count, size_t new_count, size_t size) {
    assert(old_count <= new_count);
    void *grown = memory_allocate(m, new_count, size);
    if (grown == NULL) return NULL;
    if (block != NULL) memcpy(grown, block, old_count * size);
    memory_free(m, block);
    return grown;
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

static bool take_all(host_memory *m, array_list list, void *(*take)(host_memory *, size_t, size_t)) {
    for (const array_block *block = list.blocks; block->pointer != NULL; block++)
        set_pointer(block->pointer, NULL);
    for (const array_block *block = list.blocks; block->pointer != NULL; block++) {
        if (block->size == 0) continue;
        void *array = take(m, block->count, block->size);
        if (array == NULL) {
            memory_free_all(m, list);
            return false;
        }
        set_pointer(block->pointer, array);
    }
    return true;
}

bool memory_allocate_all(host_memory *m, array_list list) {
    return take_all(m, list, memory_allocate);
}

bool memory_reserve_all(host_memory *m, array_list list) {
    return take_all(m, list, memory_reserve);
}

static void *get_pointer(const void *pointer) {
    void *value;
    memcpy(&value, pointer, sizeof value);
    return value;
}

size_t memory_size_of_all(array_list list) {
    size_t sum = 0;
    for (const array_block *block = list.blocks; block->pointer != NULL; block++) {
        if (block->size > 0 && block->count > (SIZE_MAX - sum) / block->size) return SIZE_MAX;
        sum += block->count * block->size;
    }
    return sum;
}

bool memory_copy_all(host_memory *m, array_list list) {
    bool copied = true;
    for (const array_block *block = list.blocks; block->pointer != NULL; block++) {
        const void *from = get_pointer(block->pointer);
        void *to = from != NULL && copied ? memory_reserve(m, block->count, block->size) : NULL;
        copied = copied && (from == NULL || to != NULL);
        if (to != NULL) memcpy(to, from, block->count * block->size);
        set_pointer(block->pointer, to);
    }
    if (!copied) memory_free_all(m, list);
    return copied;
}
