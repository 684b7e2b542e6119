/* Rows of tables and lines of JSON, from one list of fields. */
#include "tool/io/record.h"

#include "tool/io/text_escape.h"

#include <inttypes.h>
#include <math.h>

static const void *place_of(const record_field *field, const void *record) {
    return (const char *)record + field->place;
}

static int column_count(const record_field *field) {
    int count = 1;
    for (const char *c = field->columns; *c != '\0'; c++) count += *c == ',';
    return count;
}

void record_write_header(FILE *file, const record_field *fields, size_t count) {
    for (size_t i = 0; i < count; i++) fprintf(file, "%s%s", i > 0 ? "," : "", fields[i].columns);
    fputc('\n', file);
}

/* ---- CSV ----------------------------------------------------------------------------------------------------- */

static void write_name(FILE *file, const char *name) {
    if (name != NULL) text_write_csv(file, name);
}

static void write_indices(FILE *file, const record_indices *indices, int columns) {
    for (int i = 0; i < columns; i++) {
        if (i > 0) fputc(',', file);
        if (i < indices->count) fprintf(file, "%" PRIu32, indices->items[i]);
    }
}

static void write_words(FILE *file, const record_words *words) {
    for (int i = 0; i < words->count; i++) fprintf(file, "%s%s", i > 0 ? " " : "", words->items[i]);
}

static void write_vector(FILE *file, const double x[3]) {
    if (isnan(x[0]))
        fputs(",,", file);
    else
        fprintf(file, "%.17g,%.17g,%.17g", x[0], x[1], x[2]);
}

static void write_columns(FILE *file, const record_field *field, const void *at) {
    const char *const *names = at;
    const double *number = at;
    const uint32_t *index = at;
    switch (field->kind) {
    case RECORD_NAME:
        write_name(file, names[0]);
        break;
    case RECORD_NAMES:
        write_name(file, names[0]);
        fputc(',', file);
        write_name(file, names[1]);
        break;
    case RECORD_WORD:
        fputs(names[0], file);
        break;
    case RECORD_WORDS:
        write_words(file, at);
        break;
    case RECORD_SIGNED:
        fprintf(file, "%" PRId32, *(const int32_t *)at);
        break;
    case RECORD_INDEX:
        if (*index != UINT32_MAX) fprintf(file, "%" PRIu32, *index);
        break;
    case RECORD_INDICES:
        write_indices(file, at, column_count(field));
        break;
    case RECORD_COUNT:
        fprintf(file, "%" PRIu64, *(const uint64_t *)at);
        break;
    case RECORD_NUMBER:
        if (!isnan(*number)) fprintf(file, "%.17g", *number);
        break;
    case RECORD_VECTOR:
        write_vector(file, number);
        break;
    case RECORD_FLAG:
        fputc(*(const bool *)at ? '1' : '0', file);
        break;
    }
}

void record_write_row(FILE *file, const record_field *fields, size_t count, const void *record) {
    for (size_t i = 0; i < count; i++) {
        if (i > 0) fputc(',', file);
        write_columns(file, &fields[i], place_of(&fields[i], record));
    }
    fputc('\n', file);
}

/* ---- JSON ---------------------------------------------------------------------------------------------------- */

static void write_array_of_names(json *out, const char *member, const char *const *names, int count) {
    json_begin_array(out, member);
    for (int i = 0; i < count; i++) json_string(out, NULL, names[i]);
    json_end_array(out);
}

static void write_array_of_indices(json *out, const char *member, const record_indices *indices) {
    json_begin_array(out, member);
    for (int i = 0; i < indices->count; i++) json_integer(out, NULL, indices->items[i]);
    json_end_array(out);
}

static void write_array_of_numbers(json *out, const char *member, const double x[3]) {
    json_begin_array(out, member);
    for (int k = 0; k < 3; k++) json_number(out, NULL, x[k]);
    json_end_array(out);
}

static bool is_unknown(const record_field *field, const void *at) {
    if (field->kind == RECORD_NAME) return *(const char *const *)at == NULL;
    if (field->kind == RECORD_INDEX) return *(const uint32_t *)at == UINT32_MAX;
    return field->kind == RECORD_VECTOR && isnan(*(const double *)at);
}

static void write_member(json *out, const record_field *field, const void *at) {
    const char *const *names = at;
    const record_words *words = at;
    switch (field->kind) {
    case RECORD_NAME:
    case RECORD_WORD:
        json_string(out, field->member, names[0]);
        break;
    case RECORD_NAMES:
        write_array_of_names(out, field->member, names, 2);
        break;
    case RECORD_WORDS:
        write_array_of_names(out, field->member, words->items, words->count);
        break;
    case RECORD_SIGNED:
        json_signed(out, field->member, *(const int32_t *)at);
        break;
    case RECORD_INDEX:
        json_integer(out, field->member, *(const uint32_t *)at);
        break;
    case RECORD_INDICES:
        write_array_of_indices(out, field->member, at);
        break;
    case RECORD_COUNT:
        json_integer(out, field->member, *(const uint64_t *)at);
        break;
    case RECORD_NUMBER:
        json_number(out, field->member, *(const double *)at);
        break;
    case RECORD_VECTOR:
        write_array_of_numbers(out, field->member, at);
        break;
    case RECORD_FLAG:
        json_boolean(out, field->member, *(const bool *)at);
        break;
    }
}

void record_write_members(json *out, const record_field *fields, size_t count, const void *record) {
    for (size_t i = 0; i < count; i++) {
        const void *at = place_of(&fields[i], record);
        if (is_unknown(&fields[i], at))
            json_null(out, fields[i].member);
        else
            write_member(out, &fields[i], at);
    }
}
