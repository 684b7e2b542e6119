/* Rows of tables and lines of JSON, from one list of fields; and contacts as such rows or lines of a file. */
#pragma once

#include "cscd/cscd.h"
#include "tool/io/io.h"
#include "tool/io/json.h"

#include <stddef.h>

/* The type of a field in the struct, and what it looks like. What is unknown is an empty column, and null in
 * JSON. */
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

/* ---- contacts ------------------------------------------------------------------------------------------ */

/* A contact in terms of the mesh files' own vertices. VF: a[0] touches the triangle b. EE: the edge a[0] a[1]
 * touches the edge b[0] b[1]. */
typedef struct contact_record {
    int32_t frame; /* the interval from this frame to the next, by the name that the recording gives it */
    cscd_contact_kind kind;
    uint32_t objects[2]; /* of a and of b */
    uint32_t a[2], b[3];
    double toi, u, v;
    double point[3], normal[3];
    bool bounded;
} contact_record;

typedef struct contact_file contact_file;

/* True if the extension says a format that contact_file_open knows. */
bool contact_file_names_format(const char *path);

typedef struct contact_columns {
    bool bounded; /* each row says whether its contact is bounded; else none has a place for it */
    const char *const
        *object_names; /* each row names its two objects; NULL: none does. They outlive the file */
} contact_columns;

/* The format follows from the extension: .csv or .jsonl; "-", the standard output, is CSV. On false *out is
 * untouched. */
bool contact_file_open(const char *path, contact_columns columns, contact_file **out, io_error *error);
bool contact_file_write(contact_file *file, const contact_record *record, io_error *error);
/* Passes everything written so far to the system. That much is kept even if the disk is full later. */
bool contact_file_flush(contact_file *file, io_error *error);
/* Puts the file in its place. False when the rest could not be written. NULL does nothing and is fine. */
bool contact_file_close(contact_file *file, io_error *error);
