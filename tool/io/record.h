/* Rows of tables and lines of JSON, from one list of fields: a field is the columns that it has in a CSV file, and its member in JSON. */
#pragma once

#include "tool/io/json.h"

#include <stddef.h>

/* The type of a field in the struct, and what it looks like. What is unknown is an empty column, and null in JSON. */
typedef enum record_kind {
    RECORD_NAME,    /* const char *: a user's text, in quotes; NULL: unknown */
    RECORD_NAMES,   /* const char *[2]: the same, a column each, and an array */
    RECORD_WORD,    /* const char *: one of our words */
    RECORD_WORDS,   /* record_words: words with blanks between them, and an array */
    RECORD_SIGNED,  /* int32_t */
    RECORD_INDEX,   /* uint32_t; UINT32_MAX: unknown */
    RECORD_INDICES, /* record_indices: a column each, and an array of those that there are */
    RECORD_COUNT,   /* uint64_t */
    RECORD_NUMBER,  /* double, with 17 digits; NAN: unknown */
    RECORD_VECTOR,  /* double[3]: a column each, and an array; NAN in the first: unknown */
    RECORD_FLAG     /* bool: 0 or 1, and false or true */
} record_kind;

typedef struct record_field {
    const char *columns; /* of the table, separated by commas */
    const char *member;  /* of an object in JSON */
    record_kind kind;
    size_t place; /* offset in the struct of a record */
} record_field;

enum { RECORD_WORDS_MAX = 8, RECORD_INDICES_MAX = 3 };

typedef struct record_words {
    const char *items[RECORD_WORDS_MAX];
    int count;
} record_words;

typedef struct record_indices {
    uint32_t items[RECORD_INDICES_MAX];
    int count; /* columns behind these stay empty */
} record_indices;

void record_write_header(FILE *file, const record_field *fields, size_t count);
void record_write_row(FILE *file, const record_field *fields, size_t count, const void *record);

/* Writes the members of an object that has begun. */
void record_write_members(json *out, const record_field *fields, size_t count, const void *record);
