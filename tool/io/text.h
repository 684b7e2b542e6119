/* Tokens and numbers of the text formats, line by line. */
#pragma once

#include "tool/io/file_reader.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A run of characters without blanks, inside the reader's bytes. */
typedef struct text_token {
    const char *text;
    size_t length;
} text_token;

/* A token fit for a message: printable and not too long. */
typedef struct text_shown {
    char text[48];
} text_shown;

/* Finds the next token of the line; false at the line's end, which is not passed. */
bool text_next_token(file_reader *reader, text_token *token);

/* Takes all that is left of the line, with blanks and # within it, but without blanks around it; false when that is nothing. */
bool text_rest_of_line(file_reader *reader, text_token *rest);

/* Moves to the start of the next line, whatever the rest of this one holds. */
void text_skip_line(file_reader *reader);

/* Moves to the next token, over blank lines and comments; false when the file ends. */
bool text_seek_token(file_reader *reader);

/* Take the line's next token as a number. On false the error names the token and what was expected. */
bool text_number(file_reader *reader, const char *expected, double *value);
bool text_integer(file_reader *reader, const char *expected, int64_t *value);

/* Checks that the line ends here. */
bool text_expect_line_end(file_reader *reader);

/* Reads the whole token as a number, rounded to the nearest double; infinities and NaN are let through, also as 1.#INF and
 * 1.#QNAN. */
bool text_parse_number(text_token token, double *value);
/* Reads the whole token as a decimal integer of at most 18 digits. */
bool text_parse_integer(text_token token, int64_t *value);
/* Reads such an integer at the beginning of the token; returns its length, 0 when there is none. */
size_t text_parse_integer_prefix(text_token token, int64_t *value);

/* What to say behind a message about a token that should be a number: that it has a decimal comma; else "". */
const char *text_number_advice(text_token token);

bool text_equals(text_token token, const char *word);
text_shown text_show(text_token token);
