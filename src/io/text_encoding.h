/* How the characters of a text file are encoded: UTF-8, with a mark or without, or UTF-16, which is not read. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* The size of the mark of UTF-8, which some editors put in front of a text; 0: there is none. */
size_t text_mark_size(const char *bytes, size_t size);

/* Whether a file that should be text begins as one in UTF-16 does, of either byte order: with its mark, or with a character
 * of ASCII beside a zero, several times. */
bool text_is_utf16(const char *bytes, size_t size);

/* The end of a sentence about a file in UTF-16. */
#define TEXT_UTF16_ADVICE "this is text in UTF-16, expected UTF-8: save it as UTF-8 in an editor"
