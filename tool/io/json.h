/* Writes JSON as it goes, with its commas, nesting and escapes; and bounds the JSON of strangers before it is
 * parsed. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
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

/* False: the text has more than an object in ten bytes, beside a thousand, which no program writes. Parsed,
 * each takes a thousand bytes, so that text of nothing but braces would become 350 times as large; what is
 * left becomes 100 times as large at most. */
bool json_has_room(const char *text, size_t size);
