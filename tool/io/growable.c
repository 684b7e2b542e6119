/* An array that grows by doubling, every size checked for overflow before memory is asked for. */
#include "tool/io/growable.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 64 };

growable growable_of(size_t element_size) {
    return (growable){.element_size = element_size};
}

void growable_free(growable *array) {
    free(array->data);
    *array = growable_of(array->element_size);
}

static bool resize_array(growable *array, size_t capacity) {
    void *data = io_realloc(array->data, capacity * array->element_size);
    if (data == NULL) return false;
    array->data = data;
    array->capacity = capacity;
    return true;
}

bool growable_reserve(growable *array, size_t capacity) {
    if (capacity <= array->capacity) return true;
    if (capacity > SIZE_MAX / array->element_size) return false;
    return resize_array(array, capacity);
}

void *io_zeroed(size_t size) {
    void *memory = io_realloc(NULL, size);
    if (memory != NULL) memset(memory, 0, size);
    return memory;
}

void *growable_push(growable *array) {
    if (array->count == array->capacity) {
        size_t most = SIZE_MAX / array->element_size;
        size_t wanted = array->capacity > most / 2 ? most : 2 * array->capacity;
        if (wanted < FIRST_CAPACITY) wanted = FIRST_CAPACITY;
        if (array->count >= most || !growable_reserve(array, wanted)) return NULL;
    }
    return (char *)array->data + array->element_size * array->count++;
}

void *growable_take(growable *array) {
    /* Failing to trim costs only memory. */
    if (array->count > 0 && array->count < array->capacity) (void)resize_array(array, array->count);
    void *data = array->data;
    *array = growable_of(array->element_size);
    return data;
}
