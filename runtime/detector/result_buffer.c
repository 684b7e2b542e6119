/* Memory for a list that a call returns, and for sorting it. */
#include "runtime/detector/result_buffer.h"

cscd_status result_buffer_reserve(cscd_context *context, result_buffer *buffer, size_t count,
                                  size_t item_size, size_t key_size) {
    if (count <= buffer->capacity && buffer->keys != NULL) return CSCD_OK;
    result_buffer grown = {.capacity = count + count / 2};
    grown.items = context_allocate(context, grown.capacity, item_size);
    grown.keys = context_allocate(context, grown.capacity, key_size);
    grown.spare_keys = context_allocate(context, grown.capacity, key_size);
    if (grown.items == NULL || grown.keys == NULL || grown.spare_keys == NULL) {
        result_buffer_free(context, &grown);
        return CSCD_OUT_OF_MEMORY;
    }
    result_buffer_free(context, buffer);
    *buffer = grown;
    return CSCD_OK;
}

cscd_status result_buffer_reserve_items(cscd_context *context, result_buffer *buffer, size_t count,
                                        size_t item_size) {
    result_buffer_free_keys(context, buffer);
    if (count <= buffer->capacity) return CSCD_OK;
    result_buffer_free(context, buffer);
    const size_t room = room_with_spare(count);
    buffer->items = context_reserve(context, room, item_size);
    if (buffer->items == NULL) return CSCD_OUT_OF_MEMORY;
    buffer->capacity = room;
    return CSCD_OK;
}

cscd_status result_buffer_reserve_keys(cscd_context *context, result_buffer *buffer, size_t count,
                                       size_t key_size) {
    result_buffer_free_keys(context, buffer);
    buffer->keys = context_reserve(context, count, key_size);
    buffer->spare_keys = context_reserve(context, count, key_size);
    if (buffer->keys != NULL && buffer->spare_keys != NULL) return CSCD_OK;
    result_buffer_free_keys(context, buffer);
    return CSCD_OUT_OF_MEMORY;
}

void result_buffer_free_keys(cscd_context *context, result_buffer *buffer) {
    context_free(context, buffer->keys);
    context_free(context, buffer->spare_keys);
    buffer->keys = buffer->spare_keys = NULL;
}

void result_buffer_free(cscd_context *context, result_buffer *buffer) {
    context_free(context, buffer->items);
    result_buffer_free_keys(context, buffer);
    *buffer = (result_buffer){.capacity = 0};
}
