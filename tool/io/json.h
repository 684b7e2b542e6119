/* Writes JSON as it goes, and takes care of commas, nesting and escapes. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { JSON_DEPTH_MAX = 16 };

typedef struct json {
    FILE *file;
    int depth;
    bool has_items[JSON_DEPTH_MAX]; /* this object or array already has an item */
    bool break_line;                /* before the next value */
} json;

/* key: NULL inside arrays and for the outermost value. */
void json_begin_object(json *out, const char *key);
void json_end_object(json *out);
void json_begin_array(json *out, const char *key);
void json_end_array(json *out);

/* Invalid UTF-8 bytes (file names) are written as U+FFFD. */
void json_string(json *out, const char *key, const char *value);
void json_integer(json *out, const char *key, uint64_t value);
void json_signed(json *out, const char *key, int64_t value);
/* Writes 17 significant digits, so that the same double comes back. NaN and infinity become null. */
void json_number(json *out, const char *key, double value);
void json_boolean(json *out, const char *key, bool value);
void json_null(json *out, const char *key);
/* Writes a value that is JSON already. */
void json_verbatim(json *out, const char *key, const char *text);
/* Starts the next value on a new line, for human readers. */
void json_break_line(json *out);
