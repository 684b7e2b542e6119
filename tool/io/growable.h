/* An array that grows by doubling, every size checked for overflow before memory is asked for. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct growable {
    void *data;
    size_t count, capacity; /* elements */
    size_t element_size;
} growable;

/* An empty array; it owns no memory yet. */
growable growable_of(size_t element_size);
void growable_free(growable *array);

/* Room for at least capacity elements. On false the array is as before. */
bool growable_reserve(growable *array, size_t capacity);

/* Adds one element, its bytes undefined, and returns it; NULL when memory ran out. The pointer holds until
 * the next push or reserve. */
void *growable_push(growable *array);

/* Hands the data over, trimmed to count, and leaves the array empty. */
void *growable_take(growable *array);

/* realloc: the one place where the mesh readers get memory. It has a file of its own, so that a test can put a failing one
 * in its place. */
void *io_realloc(void *memory, size_t size);

/* New memory from it, all bytes 0. */
void *io_zeroed(size_t size);
