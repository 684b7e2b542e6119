/* Options and other structs that callers fill are as large as the caller's header says, which may be older or newer
 * than the library. */
#include "src/core/struct_size.h"

#include <string.h>

static size_t smaller_of(size_t a, size_t b) {
    return a < b ? a : b;
}

void struct_give_options(void *out, size_t out_size, const void *from, size_t size) {
    const uint32_t own_size = (uint32_t)out_size;
    const size_t known = smaller_of(out_size, size);
    memcpy(out, from, known);
    memset((char *)out + known, 0, out_size - known);
    memcpy(out, &own_size, sizeof own_size);
}

cscd_status struct_take(cscd_context *context, void *into, size_t size, size_t least_size, const void *from,
                        size_t from_size, const char *name) {
    if (from_size < least_size)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%s: its size is %zu, expected at least %zu",
                            name, from_size, least_size);
    memcpy(into, from, smaller_of(from_size, size));
    const char *bytes = from;
    for (size_t i = size; i < from_size; i++) {
        if (bytes[i] == 0) continue;
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "%s: the member at byte %zu is not 0, and this library, version %s, does not know it: "
            "set it to 0, or use a newer library",
            name, i, cscd_version_string());
    }
    return CSCD_OK;
}

cscd_status struct_take_options(cscd_context *context, void *into, size_t size, size_t least_size,
                                const void *from, const char *maker) {
    uint32_t from_size;
    memcpy(&from_size, from, sizeof from_size);
    if (from_size < least_size)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "the options were not made by %s: struct_size is %u, expected at least %zu",
                            maker, from_size, least_size);
    return struct_take(context, into, size, least_size, from, from_size, maker);
}
