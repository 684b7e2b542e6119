/* A stable sort that allocates nothing. */
#ifndef CSCD_SORT_H
#define CSCD_SORT_H

#include <stddef.h>
#include <stdint.h>

/* Sorts count items of size bytes; scratch has room for as many. compare as for qsort. (glibc's qsort takes
 * memory from malloc, behind the back of the context's allocator.) */
void sort_items(void *items, void *scratch, size_t count, size_t size,
                int (*compare)(const void *, const void *));

/* Something to be sorted by a number. */
typedef struct sort_key {
    uint64_t key;
    const void *of;
} sort_key;

/* Ascending by key, stable. scratch: room for count more. */
void sort_keys(sort_key *keys, sort_key *scratch, size_t count);

#endif
