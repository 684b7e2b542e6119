/* Blocks of memory from the host's allocator, zeroed, aligned, counted; and budgets of calls. */
#pragma once

#include "src/core/entry.h"

#include <pthread.h>
#include <stdatomic.h>

enum { MEMORY_ALIGNMENT = 64 };

typedef struct host_memory {
    cscd_allocator allocator;
    entry_state *entry;   /* of the context */
    pthread_mutex_t lock; /* of the allocator, which one thread at a time is in */
    atomic_size_t bytes;  /* in use, headers included; changed under the lock, read by any thread */
} host_memory;

/* The bytes that a max_memory of 0 stands for: a quarter of the memory that is free now, at least 1. */
size_t memory_share(void);

/* The bytes in use. */
static inline size_t memory_bytes(const host_memory *m) {
    return atomic_load_explicit(&m->bytes, memory_order_relaxed);
}

/* The allocator for a host that has none of its own. */
cscd_allocator memory_system_allocator(void);

/* Returns false when the system refuses a lock. */
bool memory_begin(host_memory *m, cscd_allocator allocator, entry_state *entry);

/* By now nothing is in use. */
void memory_end(host_memory *m);

/* Zeroed memory for count elements of size bytes, 64-byte aligned; NULL when count * size overflows or the
 * allocator refuses. count 0 gives a block too. Any thread may call this and the following functions: a mesh
 * that other contexts share is freed by whoever lets go of it last. */
void *memory_allocate(host_memory *m, size_t count, size_t size);

/* The same without the zeros, for arrays that are written at once, every element. */
void *memory_reserve(host_memory *m, size_t count, size_t size);

/* A block of new_count elements that begins with the first old_count of block; block is then freed, or,
 * when NULL is returned, still valid. */
void *memory_grow(host_memory *m, void *block, size_t old_count, size_t new_count, size_t size);

/* NULL does nothing. */
void memory_free(host_memory *m, void *block);

/* ---- the arrays of a structure ------------------------------------------------------------------------- */

/* One array: the address of the pointer to it, and its size. An element size of 0 is an array that this
 * structure does without; its pointer stays NULL. */
typedef struct array_block {
    void *pointer; /* NULL ends a list */
    size_t count, size;
} array_block;

/* The arrays of a structure, named once, for allocation and for release:
 *
 *     static array_list list_arrays(grid *g) {
 *         return (array_list){{ARRAY(g->cells, g->cell_count), ARRAY(g->names, g->name_count)}};
 *     }
 */
typedef struct array_list {
    array_block blocks[32]; /* at most 31 arrays and the end */
} array_list;

#define ARRAY(pointer, count)                                                                                \
    { &(pointer), count, sizeof *(pointer) }
#define ARRAY_IF(condition, pointer, count)                                                                  \
    { &(pointer), count, (condition) ? sizeof *(pointer) : 0 }

/* Allocates all arrays of a list, or none: on failure every pointer is NULL. The earlier values of the
 * pointers do not matter. */
bool memory_allocate_all(host_memory *m, array_list list);

bool memory_reserve_all(host_memory *m, array_list list);

/* The pointers are those of a structure that has been copied; each becomes a copy of its array, or stays NULL. On failure
 * all are NULL. */
bool memory_copy_all(host_memory *m, array_list list);

/* The bytes of all arrays of a list; SIZE_MAX if they are more than that. */
size_t memory_size_of_all(array_list list);

/* Frees all arrays of a list, whatever their counts say, and sets their pointers to NULL. */
void memory_free_all(host_memory *m, array_list list);

/* ---- budgets ------------------------------------------------------------------------------------------- */

/* A budget limits the memory and the work that a call may take for its findings. It counts the bytes that
 * lists need by their lengths, and not the bytes that are allocated. So a call leaves out the same for any
 * number of threads, whatever calls there were before. */

/* A list that grows to twice its length needs this many times its bytes until the old one is given back. */
enum { MEMORY_WHILE_DOUBLING = 3 };

typedef struct memory_budget {
    size_t most, taken; /* bytes */
    size_t wanted; /* bytes in all that the first one that did not fit needed, as far as it was counted */
    uint64_t most_work, work,
        wanted_work; /* the same; wanted_work is 0 unless it was work that did not fit */
    bool exceeded;   /* something did not fit, and has not been taken */
} memory_budget;

/* Takes count times size bytes. False if they do not fit: whoever asks then ends as if there were no memory, and gives back
 * what it has. NULL: there is no limit. */
static inline bool memory_budget_take(memory_budget *b, size_t count, size_t size) {
    if (b == NULL) return true;
    if (count > 0 && size > (b->most - b->taken) / count) {
        const size_t needed = size > SIZE_MAX / count ? SIZE_MAX : count * size;
        b->wanted = needed > SIZE_MAX - b->taken ? SIZE_MAX : b->taken + needed;
        b->exceeded = true;
        return false;
    }
    b->taken += count * size;
    return true;
}

/* The same for work, which adds to the work so far. */
static inline bool memory_budget_work(memory_budget *b, uint64_t count, uint64_t work) {
    if (b == NULL) return true;
    if (count > 0 && work > (b->most_work - b->work) / count) {
        b->wanted_work = work > (UINT64_MAX - b->work) / count ? UINT64_MAX : b->work + count * work;
        b->exceeded = true;
        return false;
    }
    b->work += count * work;
    return true;
}

/* The same for the arrays of a list. */
static inline bool memory_budget_take_all(memory_budget *b, array_list list) {
    return memory_budget_take(b, 1, memory_size_of_all(list));
}

/* Returns the number of items of this size that would fit. */
static inline size_t memory_budget_room(const memory_budget *b, size_t size) {
    return b != NULL ? (b->most - b->taken) / size : SIZE_MAX;
}
