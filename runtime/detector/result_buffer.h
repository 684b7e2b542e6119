/* Memory for a list that a call returns, and for sorting it. */
#pragma once

#include "src/core/context.h"

typedef struct result_buffer {
    void *items;
    void *keys, *spare_keys; /* keys are sorted in place of items, by way of the spare ones */
    size_t capacity;
} result_buffer;

/* Makes room for count items of item_size bytes and as many keys of key_size bytes, always the same sizes for one
 * buffer. What the buffer held is lost. */
cscd_status result_buffer_reserve(cscd_context *context, result_buffer *buffer, size_t count,
                                  size_t item_size, size_t key_size);

/* The same for a long list in two steps, so that whoever fills it may give back other memory in between: items that hold
 * anything, and then the keys, just enough of them. */
cscd_status result_buffer_reserve_items(cscd_context *context, result_buffer *buffer, size_t count,
                                        size_t item_size);
cscd_status result_buffer_reserve_keys(cscd_context *context, result_buffer *buffer, size_t count,
                                       size_t key_size);

/* Gives back what only sorting needs; the items stay. */
void result_buffer_free_keys(cscd_context *context, result_buffer *buffer);
void result_buffer_free(cscd_context *context, result_buffer *buffer);
