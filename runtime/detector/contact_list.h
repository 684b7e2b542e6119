/* Lists that calls return: their memory, and the contacts of all workers gathered into one sorted list. */
#pragma once

#include "runtime/detector/search.h"

/* Memory for a list that a call returns, and for sorting it. */
typedef struct result_buffer {
    void *items;
    void *keys, *spare_keys; /* keys are sorted in place of items, by way of the spare ones */
    size_t capacity;
} result_buffer;

/* Makes room for count items of item_size bytes, 0 for none, and as many keys of key_size bytes, always the same sizes for one
 * buffer. What the buffer held is lost. */
cscd_status result_buffer_reserve(cscd_context *context, result_buffer *buffer, size_t count,
                                  size_t item_size, size_t key_size);

/* Makes room for items alone, which may hold anything, and gives back the keys. */
cscd_status result_buffer_reserve_items(cscd_context *context, result_buffer *buffer, size_t count,
                                        size_t item_size);

void result_buffer_free(cscd_context *context, result_buffer *buffer);

/* ---- contacts ------------------------------------------------------------------------------------------ */

/* A contact in a worker, and a number to sort it by. */
typedef struct contact_key {
    uint64_t key;
    const cscd_contact *contact;
} contact_key;

/* Writes a key, whose number is 0, for each contact of the workers that the caller does not ignore to buffer->keys, and
 * makes room for as many items of item_size bytes. Workers get room for their share of a next search like this one.
 * LIST_TOO_LONG: there would be *count contacts, and there is a cap below that. */
cscd_status contact_list_gather(search_space *s, const exclusions *e, size_t item_size, result_buffer *buffer,
                                size_t *count);

/* Lists the contacts that the caller does not ignore, sorted by (toi, kind, a, b). LIST_TOO_LONG: *out has their number
 * alone. Adds the numbers that the workers have counted, and the length of the list, to the counters. */
cscd_status contact_list_collect(search_space *s, const exclusions *e, result_buffer *buffer,
                                 cscd_counters *counters, cscd_contacts *out);
