/* What every object shares: the allocator, the threads, progress, the sentence behind the last failure. */
#pragma once

#include "cscd/cscd.h"
#include "src/core/parallel.h"
#include "src/core/progress.h"

#include <pthread.h>

struct cscd_context {
    cscd_allocator allocator;
    pthread_mutex_t allocator_lock;
    size_t bytes;
    parallel *threads;
    progress progress;
    cscd_simd simd; /* never AUTO */
    char detail[512];
};

/* Zeroed memory for count elements of size bytes, 64-byte aligned; NULL when count * size overflows or the
 * allocator refuses. count 0 gives a block too. Any thread may call it. */
void *context_allocate(cscd_context *context, size_t count, size_t size);

/* A block of new_count elements that begins with the first old_count of block; block is then freed, or,
 * when NULL is returned, still valid. */
void *context_grow(cscd_context *context, void *block, size_t old_count, size_t new_count, size_t size);

/* NULL does nothing. */
void context_free(cscd_context *context, void *block);

/* One array of a structure: the address of the pointer to it, and its size. An element size of 0 is an array that
 * this structure does without; its pointer stays NULL. */
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

/* Allocates all arrays of a list, or none: on failure every pointer is NULL. What the pointers were before does not
 * matter. */
bool context_allocate_all(cscd_context *context, array_list list);

/* Frees all arrays of a list, whatever their counts say, and sets their pointers to NULL. */
void context_free_all(cscd_context *context, array_list list);

/* Sets the detail and returns status, so that a function can end with it. */
cscd_status context_fail(cscd_context *context, cscd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The same words for every allocation that failed. */
cscd_status context_out_of_memory(cscd_context *context);

/* For functions below which nobody wrote a sentence: status is CANCELLED, or an allocation failed. */
cscd_status context_explain(cscd_context *context, cscd_status status);
