/* Structs and arrays one after the other in memory, each on a multiple of 8 bytes. */
#include "tool/replay/packed_bytes.h"

#include <string.h>

packed_bytes packed_bytes_create(void) {
    return (packed_bytes){.bytes = growable_of(1)};
}

void packed_bytes_free(packed_bytes *p) {
    growable_free(&p->bytes);
}

void packed_bytes_clear(packed_bytes *p) {
    p->bytes.count = 0;
    p->failed = false;
}

static size_t round_up(size_t size) {
    return (size + 7) / 8 * 8;
}

void packed_bytes_add(packed_bytes *p, const void *data, size_t size) {
    const size_t whole = round_up(size);
    p->failed = p->failed || whole < size || !growable_reserve(&p->bytes, p->bytes.count + whole);
    if (p->failed || size == 0) return;
    char *end = (char *)p->bytes.data + p->bytes.count;
    memcpy(end, data, size);
    memset(end + size, 0, whole - size);
    p->bytes.count += whole;
}

void packed_bytes_add_array(packed_bytes *p, const void *items, size_t count, size_t element_size) {
    const uint64_t number = count;
    packed_bytes_add(p, &number, sizeof number);
    packed_bytes_add(p, items, count * element_size); /* they are in memory, so this does not overflow */
}

const void *packed_reader_take(packed_reader *r, size_t size) {
    const size_t left = (size_t)(r->end - r->at);
    r->torn = r->torn || size > left || round_up(size) > left;
    if (r->torn) return NULL;
    const void *taken = r->at;
    r->at += round_up(size);
    return taken;
}

bool packed_reader_copy(packed_reader *r, void *out, size_t size) {
    const void *found = packed_reader_take(r, size);
    if (found != NULL) memcpy(out, found, size);
    return found != NULL;
}

const void *packed_reader_take_array(packed_reader *r, size_t *count, size_t element_size) {
    uint64_t number = 0;
    *count = 0;
    r->torn = !packed_reader_copy(r, &number, sizeof number) || number > SIZE_MAX / element_size;
    const void *items = packed_reader_take(r, (size_t)number * element_size);
    if (items != NULL) *count = (size_t)number;
    return items;
}
