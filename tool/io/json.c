/* Writes JSON as it goes, with its commas, nesting and escapes; and bounds the JSON of strangers before it is
 * parsed. */
#include "tool/io/json.h"

#include "tool/io/text_encoding.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

static void write_escaped(FILE *file, const char *text) {
    fputc('"', file);
    for (const unsigned char *s = (const unsigned char *)text; *s != '\0';) {
        size_t length = text_utf8_length(s);
        if (length == 0)
            fputs("\xef\xbf\xbd", file);
        else if (*s == '"' || *s == '\\')
            fprintf(file, "\\%c", *s);
        else if (*s < 0x20)
            fprintf(file, "\\u%04x", (unsigned)*s);
        else
            fwrite(s, 1, length, file);
        s += length > 0 ? length : 1;
    }
    fputc('"', file);
}

static void begin_value(json *out, const char *key) {
    if (out->has_items[out->depth]) fputc(',', out->file);
    out->has_items[out->depth] = true;
    if (out->break_line) fputc('\n', out->file);
    out->break_line = false;
    if (key == NULL) return;
    write_escaped(out->file, key);
    fputc(':', out->file);
}

static void open_nesting(json *out, const char *key, char bracket) {
    begin_value(out, key);
    fputc(bracket, out->file);
    assert(out->depth + 1 < JSON_DEPTH_MAX);
    out->has_items[++out->depth] = false;
}

static void close_nesting(json *out, char bracket) {
    out->depth--;
    fputc(bracket, out->file);
}

void json_begin_object(json *out, const char *key) {
    open_nesting(out, key, '{');
}

void json_end_object(json *out) {
    close_nesting(out, '}');
}

void json_begin_array(json *out, const char *key) {
    open_nesting(out, key, '[');
}

void json_end_array(json *out) {
    close_nesting(out, ']');
}

void json_string(json *out, const char *key, const char *value) {
    begin_value(out, key);
    write_escaped(out->file, value);
}

void json_integer(json *out, const char *key, uint64_t value) {
    begin_value(out, key);
    fprintf(out->file, "%" PRIu64, value);
}

void json_signed(json *out, const char *key, int64_t value) {
    begin_value(out, key);
    fprintf(out->file, "%" PRId64, value);
}

void json_number(json *out, const char *key, double value) {
    begin_value(out, key);
    if (isfinite(value))
        fprintf(out->file, "%.17g", value);
    else
        fputs("null", out->file);
}

void json_boolean(json *out, const char *key, bool value) {
    begin_value(out, key);
    fputs(value ? "true" : "false", out->file);
}

void json_null(json *out, const char *key) {
    begin_value(out, key);
    fputs("null", out->file);
}

void json_verbatim(json *out, const char *key, const char *text) {
    begin_value(out, key);
    fputs(text, out->file);
}

void json_break_line(json *out) {
    out->break_line = true;
}

/* ---- JSON of strangers --------------------------------------------------------------------------------- */

enum { BYTES_AN_OBJECT = 10, FREE_OBJECTS = 1000 };

/* Braces in strings count, too: they would have to be many. */
bool json_has_room(const char *text, size_t size) {
    const size_t most = size / BYTES_AN_OBJECT + FREE_OBJECTS;
    size_t count = 0;
    for (const char *at = text, *end = text + size; (at = memchr(at, '{', (size_t)(end - at))) != NULL; at++)
        if (++count > most) return false;
    return true;
}
