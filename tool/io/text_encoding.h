/* How the characters of a text file are encoded: UTF-8, with a mark or without, or UTF-16, which is not read. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* The end of a sentence about a file in UTF-16. */
#define TEXT_UTF16_ADVICE "this is text in UTF-16, expected UTF-8: save it as UTF-8 in an editor"

/* The size of the mark of UTF-8, which some editors put in front of a text; 0: there is none. */
static inline size_t text_mark_size(const char *bytes, size_t size) {
    static const char mark[] = "\xef\xbb\xbf";
    const size_t length = sizeof mark - 1;
    return size >= length && memcmp(bytes, mark, length) == 0 ? length : 0;
}

/* Are the characters ASCII, of two bytes each? high: which of the two is zero. */
static inline bool text_is_wide(const char *bytes, size_t size, size_t high) {
    enum { CHARACTERS_LOOKED_AT = 4 };
    if (size < 2 * CHARACTERS_LOOKED_AT) return false;
    for (size_t i = 0; i < 2 * (size_t)CHARACTERS_LOOKED_AT; i += 2)
        if (bytes[i + high] != '\0' || (unsigned char)bytes[i + 1 - high] - 1u >= 0x7f) return false;
    return true;
}

/* Whether a file that should be text begins as one in UTF-16 does, of either byte order: with its mark, or with a character
 * of ASCII beside a zero, several times. */
static inline bool text_is_utf16(const char *bytes, size_t size) {
    const bool little = size >= 2 && memcmp(bytes, "\xff\xfe", 2) == 0,
               big = size >= 2 && memcmp(bytes, "\xfe\xff", 2) == 0;
    const size_t start = little || big ? 2 : 0;
    return (!big && text_is_wide(bytes + start, size - start, 1)) ||
           (!little && text_is_wide(bytes + start, size - start, 0));
}
