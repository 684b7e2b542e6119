/* Gathers the contacts of all lanes into one sorted list. */
#pragma once

#include "runtime/detector/result_buffer.h"
#include "runtime/detector/search_space.h"
#include "runtime/narrow_phase/narrow_phase.h"

/* A contact in a lane, and a number to sort it by. */
typedef struct contact_key {
    uint64_t key;
    const cscd_contact *contact;
} contact_key;

/* Writes a key, whose number is 0, for each contact of the lanes that the caller does not ignore to buffer->keys, and
 * makes room for as many items of item_size bytes. Lanes get room for their share of a next search like this one.
 * LIST_TOO_LONG: there would be *count contacts, and there is a cap below that. */
cscd_status contact_list_gather(search_space *s, const exclusions *e, size_t item_size, result_buffer *buffer,
                                size_t *count);

/* Lists the contacts that the caller does not ignore, sorted by (toi, kind, a, b). LIST_TOO_LONG: *out has their number
 * alone. Adds the numbers that the lanes
 * have counted, and the length of the list, to the counters. */
cscd_status contact_list_collect(search_space *s, const exclusions *e, result_buffer *buffer,
                                 cscd_counters *counters, cscd_contacts *out);
