/* A stable sort that allocates nothing. */
#ifndef CSCD_SORT_H
#define CSCD_SORT_H

#include "src/parallel.h"

#include <stddef.h>

/* Sorts count items of size bytes; scratch has room for as many. compare as for qsort. (glibc's qsort takes
 * memory from malloc, behind the back of the context's allocator.) */
void sort_items(void *items, void *scratch, size_t count, size_t size,
                int (*compare)(const void *, const void *));

/* The same, and the same result, by all threads where there are items enough. */
void sort_items_together(parallel *threads, void *items, void *scratch, size_t count, size_t size,
                         int (*compare)(const void *, const void *));

#endif
