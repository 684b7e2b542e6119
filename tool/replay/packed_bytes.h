/* Structs and arrays one after the other in memory, each on a multiple of 8 bytes: how the file of a shard has them. They are as
 * the compiler lays them out, so only the same build on the same kind of machine reads them. */
#pragma once

#include "tool/io/growable.h"

#include <stdint.h>

typedef struct packed_bytes {
    growable bytes; /* of one byte each */
    bool failed;    /* out of memory: nothing more was added */
} packed_bytes;

packed_bytes packed_bytes_create(void);
void packed_bytes_free(packed_bytes *p); /* a zeroed struct is fine */
void packed_bytes_clear(packed_bytes *p);

void packed_bytes_add(packed_bytes *p, const void *data, size_t size);
/* The count, and the elements. */
void packed_bytes_add_array(packed_bytes *p, const void *items, size_t count, size_t element_size);

/* Takes them out again in the same order. */
typedef struct packed_reader {
    const unsigned char *at, *end; /* at: on a multiple of 8 bytes */
    bool torn;                     /* what was asked for goes past the end; NULL is returned from then on */
} packed_reader;

const void *packed_reader_take(packed_reader *r, size_t size);
bool packed_reader_copy(packed_reader *r, void *out, size_t size);
const void *packed_reader_take_array(packed_reader *r, size_t *count, size_t element_size);
