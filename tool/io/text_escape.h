/* Texts of users (names, paths) as parts of other formats. */
#pragma once

#include <stddef.h>
#include <stdio.h>

/* Bytes of the UTF-8 character at s; 0 if it is none. */
size_t text_utf8_length(const unsigned char *s);

/* Bytes of the longest beginning of a text that has at most so many bytes and does not end within a character. */
int text_cut_length(const char *text, int most);

/* The two arguments of "%.*s" that print such a beginning. */
#define TEXT_CUT(text, most) text_cut_length((text), (most)), (text)

/* In quotes, with those of the text doubled, so that any text is one field of a CSV file. */
void text_write_csv(FILE *file, const char *text);

/* As the content of an element or of an attribute in double quotes. What XML cannot hold becomes U+FFFD. */
void text_write_xml(FILE *file, const char *text);
