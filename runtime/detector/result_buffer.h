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
void result_buffer_free(cscd_context *context, result_buffer *buffer);
