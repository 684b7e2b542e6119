/* The encodings of texts: UTF-8 and UTF-16 of files that are read, quotes and escapes of formats that are
 * written, and Base64. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* ---- files that are read ------------------------------------------------------------------------------- */

/* The end of a sentence about a file in UTF-16. */
#define TEXT_UTF16_ADVICE "this is text in UTF-16, expected UTF-8: save it as UTF-8 in an editor"

/* The size of the mark of UTF-8, which some editors put in front of a text; 0: there is none. */
static inline size_t text_mark_size(const char *bytes, size_t size) {
    static const char mark[] = "\xef\xbb\xbf";
    const size_t length = sizeof mark - 1;
    return size >= length && memcmp(bytes, mark, length) == 0 ? length : 0;
}

/* True if the characters are ASCII, of two bytes each. high: which of the two is zero. */
static inline bool text_is_wide(const char *bytes, size_t size, size_t high) {
    enum { CHARACTERS_LOOKED_AT = 4 };
    if (size < 2 * CHARACTERS_LOOKED_AT) return false;
    for (size_t i = 0; i < 2 * (size_t)CHARACTERS_LOOKED_AT; i += 2)
        if (bytes[i + high] != '\0' || (unsigned char)bytes[i + 1 - high] - 1u >= 0x7f) return false;
    return true;
}

/* True if a file that should be text begins as one in UTF-16 does, of either byte order: with its mark, or
 * with a character of ASCII beside a zero, several times. */
static inline bool text_is_utf16(const char *bytes, size_t size) {
    const bool little = size >= 2 && memcmp(bytes, "\xff\xfe", 2) == 0,
               big = size >= 2 && memcmp(bytes, "\xfe\xff", 2) == 0;
    const size_t start = little || big ? 2 : 0;
    return (!big && text_is_wide(bytes + start, size - start, 1)) ||
           (!little && text_is_wide(bytes + start, size - start, 0));
}

/* ---- texts of users (names, paths) as parts of other formats ------------------------------------------- */

/* Bytes of the UTF-8 character at s; 0 if it is none. */
size_t text_utf8_length(const unsigned char *s);

/* Bytes of the longest beginning of a text that has at most `most` bytes and does not end within a
 * character. */
int text_cut_length(const char *text, int most);

/* The two arguments of "%.*s" that print such a beginning. */
#define TEXT_CUT(text, most) text_cut_length((text), (most)), (text)

/* In quotes, with those of the text doubled, so that any text is one field of a CSV file. */
void text_write_csv(FILE *file, const char *text);

/* As the content of an element or of an attribute in double quotes. What XML cannot hold becomes U+FFFD. */
void text_write_xml(FILE *file, const char *text);

/* ---- Base64, as data URIs and GIFTI files hold it ------------------------------------------------------ */

/* The most bytes that length characters stand for. */
size_t base64_room(size_t length);

/* Decodes length characters to out, which has that room. Blanks and line ends may stand anywhere, and the
 * padding at the end may be missing. On false *wrong is the place of the first character that does not belong
 * there. */
bool base64_decode(const char *text, size_t length, unsigned char *out, size_t *size, size_t *wrong);
