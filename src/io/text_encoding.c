/* How the characters of a text file are encoded: UTF-8, with a mark or without, or UTF-16, which is not read. */
#include "src/io/text_encoding.h"

#include <string.h>

size_t text_mark_size(const char *bytes, size_t size) {
    static const char mark[] = "\xef\xbb\xbf";
    const size_t length = sizeof mark - 1;
    return size >= length && memcmp(bytes, mark, length) == 0 ? length : 0;
}

/* Are the characters ASCII, of two bytes each? high: which of the two is zero. */
static bool are_wide(const char *bytes, size_t size, size_t high) {
    enum { CHARACTERS_LOOKED_AT = 4 };
    if (size < 2 * CHARACTERS_LOOKED_AT) return false;
    for (size_t i = 0; i < 2 * (size_t)CHARACTERS_LOOKED_AT; i += 2)
        if (bytes[i + high] != '\0' || (unsigned char)bytes[i + 1 - high] - 1u >= 0x7f) return false;
    return true;
}

bool text_is_utf16(const char *bytes, size_t size) {
    const bool little = size >= 2 && memcmp(bytes, "\xff\xfe", 2) == 0,
               big = size >= 2 && memcmp(bytes, "\xfe\xff", 2) == 0;
    const size_t start = little || big ? 2 : 0;
    return (!big && are_wide(bytes + start, size - start, 1)) ||
           (!little && are_wide(bytes + start, size - start, 0));
}
