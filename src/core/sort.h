/* A stable sort that allocates nothing. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Sorts count items of size bytes; scratch has room for as many. compare as for qsort. (glibc's qsort takes
 * memory from malloc, behind the back of the context's allocator.) */
void sort_items(void *items, void *scratch, size_t count, size_t size,
                int (*compare)(const void *, const void *));

/* Sorts items of 8 or 16 bytes that begin with a uint64_t by that, ascending, stable; scratch has room for as
 * many. */
void sort_by_number(void *items, void *scratch, size_t count, size_t size);
