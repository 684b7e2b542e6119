/* A whole file in memory, a position in it, errors that name the place, and the tokens and numbers of text
 * formats. */
#pragma once

#include "tool/io/io.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Where a coordinate of a vertex or of a normal stands in a file, and how. */
typedef struct coordinate_place {
    enum {
        COORDINATE_NOWHERE, /* it is made of something else, or of an integer */
        COORDINATE_TEXT,
        COORDINATE_LITTLE, /* a float or double, by its size, of that byte order */
        COORDINATE_BIG
    } form;
    size_t at, size; /* bytes */
} coordinate_place;

typedef struct file_reader {
    const char *path; /* the caller's, alive as long as the reader */
    io_error *error;
    char *bytes; /* `size` bytes, and a 0 behind the last */
    size_t size;
    size_t at;                       /* the next byte to read */
    size_t line;                     /* the line of `at`, from 1 */
    bool binary;                     /* places are byte offsets, not lines */
    size_t mark;                     /* the first byte of the value last read */
    bool comments;                   /* text: # starts a comment */
    bool continuations;              /* text: a backslash before a line's end is a blank */
    mesh_parts_by parts_by;          /* of meshes: what their parts are */
    coordinate_place coordinates[3]; /* of meshes: of the vertex that is read */
    growable *places;                /* takes these three of all vertices; NULL: nobody asks */
    growable *
        normal_places; /* and three of the normal of each face that has one, where that follows from its vertices */
} file_reader;

/* On false *reader owns nothing. */
bool file_reader_open(file_reader *reader, const char *path, io_error *error);
void file_reader_close(file_reader *reader);

/* Asks the system to begin to fetch the file from its disk, without waiting for it. Where that cannot be,
 * nothing happens. */
void file_reader_expect(const char *path);

/* Write "path: message" to reader->error, or, with the place where the reader is, "path:LINE: message", as
 * compilers do, or "path: byte N: message". The message is always one line; the result is always false. */
bool file_reader_fail(file_reader *reader, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool file_reader_fail_here(file_reader *reader, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* ---- text, line by line -------------------------------------------------------------------------------- */

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

/* Takes all that is left of the line, with blanks and # within it, but without blanks around it; false when
 * that is nothing. */
bool text_rest_of_line(file_reader *reader, text_token *rest);

/* Moves to the start of the next line, whatever the rest of this one holds. */
void text_skip_line(file_reader *reader);

/* Moves to the next token, over blank lines and comments; false when the file ends. */
bool text_seek_token(file_reader *reader);

/* Take the line's next token as a number. On false the error names the token and what was expected. */
bool text_number(file_reader *reader, const char *expected, double *value);
bool text_integer(file_reader *reader, const char *expected, int64_t *value);

/* The same of a coordinate of a vertex, whose place is kept. */
bool text_coordinate(file_reader *reader, int axis, const char *expected, double *value);

/* Checks that the line ends here. */
bool text_expect_line_end(file_reader *reader);

/* Reads the whole token as a number, rounded to the nearest double; infinities and NaN are let through, also
 * as 1.#INF and 1.#QNAN. */
bool text_parse_number(text_token token, double *value);
/* Reads the whole token as a decimal integer of at most 18 digits. */
bool text_parse_integer(text_token token, int64_t *value);
/* Reads such an integer at the beginning of the token; returns its length, 0 when there is none. */
size_t text_parse_integer_prefix(text_token token, int64_t *value);

/* Advice behind a message about a token that should be a number: that it has a decimal comma; else "". */
const char *text_number_advice(text_token token);

bool text_equals(text_token token, const char *word);
text_shown text_show(text_token token);
