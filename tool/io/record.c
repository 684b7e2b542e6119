/* Rows of tables and lines of JSON, from one list of fields; and contacts as such rows or lines of a file. */
#include "tool/io/record.h"

#include "tool/io/io.h"
#include "tool/io/output_file.h"
#include "tool/io/text_encoding.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

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

/* ---- contacts ------------------------------------------------------------------------------------------ */

/* A contact as its fields have it. */
typedef struct contact_row {
    contact_record record;
    const char *kind, *objects[2];
    record_indices a, b;
} contact_row;

#define FIELD_OF(member) offsetof(contact_row, member)

/* Columns and members of a contact. The last two are written only if the file has them. */
static const record_field fields[] = {
    {"frame", "frame", RECORD_SIGNED, FIELD_OF(record.frame)},
    {"kind", "kind", RECORD_WORD, FIELD_OF(kind)},
    {"toi", "toi", RECORD_NUMBER, FIELD_OF(record.toi)},
    {"a0,a1", "a", RECORD_INDICES, FIELD_OF(a)},
    {"b0,b1,b2", "b", RECORD_INDICES, FIELD_OF(b)},
    {"u", "u", RECORD_NUMBER, FIELD_OF(record.u)},
    {"v", "v", RECORD_NUMBER, FIELD_OF(record.v)},
    {"x,y,z", "point", RECORD_VECTOR, FIELD_OF(record.point)},
    {"nx,ny,nz", "normal", RECORD_VECTOR, FIELD_OF(record.normal)},
    {"bounded", "bounded", RECORD_FLAG, FIELD_OF(record.bounded)},
    {"object_a,object_b", "objects", RECORD_NAMES, FIELD_OF(objects)},
};

enum { FIELDS = sizeof fields / sizeof *fields, BOUNDED = FIELDS - 2, OBJECTS = FIELDS - 1 };

struct contact_file {
    output_file out;
    char *path;
    bool csv;
    const char *const *object_names;
    record_field fields[FIELDS]; /* those that the file has */
    size_t field_count;
};

static bool write_failed(const contact_file *file, io_error *error) {
    return io_fail_write(error, file->path);
}

static void free_contact_file(contact_file *file) {
    free(file->path);
    free(file);
}

static bool names_csv(const char *path) {
    return path_has_extension(path, ".csv") || output_file_is_standard(path);
}

bool contact_file_names_format(const char *path) {
    return names_csv(path) || path_has_extension(path, ".jsonl");
}

static void choose_fields(contact_file *file, contact_columns columns) {
    file->object_names = columns.object_names;
    for (size_t i = 0; i < FIELDS; i++)
        if ((i != BOUNDED || columns.bounded) && (i != OBJECTS || columns.object_names != NULL))
            file->fields[file->field_count++] = fields[i];
}

static bool write_header(const contact_file *file) {
    if (file->csv) record_write_header(file->out.file, file->fields, file->field_count);
    return !ferror(file->out.file);
}

bool contact_file_open(const char *path, contact_columns columns, contact_file **out, io_error *error) {
    bool csv = names_csv(path);
    if (!contact_file_names_format(path))
        return io_fail(error, "%s: contacts are written as .csv or .jsonl", path);
    contact_file *file = calloc(1, sizeof *file);
    if (file == NULL || (file->path = strdup(path)) == NULL) {
        free(file);
        return io_fail(error, "%s: out of memory", path);
    }
    file->csv = csv;
    choose_fields(file, columns);
    if (!output_file_open(path, &file->out)) {
        write_failed(file, error);
        free_contact_file(file);
        return false;
    }
    if (!write_header(file)) {
        write_failed(file, error);
        output_file_close(&file->out, OUTPUT_ABANDONED);
        free_contact_file(file);
        return false;
    }
    *out = file;
    return true;
}

static contact_row row_of(const contact_file *file, const contact_record *r) {
    const bool vf = r->kind == CSCD_CONTACT_VF;
    contact_row row = {.record = *r,
                       .kind = cscd_contact_kind_name(r->kind),
                       .a = {{r->a[0], r->a[1]}, vf ? 1 : 2},
                       .b = {{r->b[0], r->b[1], r->b[2]}, vf ? 3 : 2}};
    for (int i = 0; i < 2 && file->object_names != NULL; i++)
        row.objects[i] = file->object_names[r->objects[i]];
    return row;
}

bool contact_file_write(contact_file *file, const contact_record *record, io_error *error) {
    const contact_row row = row_of(file, record);
    if (file->csv)
        record_write_row(file->out.file, file->fields, file->field_count, &row);
    else {
        json out = {.file = file->out.file};
        json_begin_object(&out, NULL);
        record_write_members(&out, file->fields, file->field_count, &row);
        json_end_object(&out);
        fputc('\n', out.file);
    }
    return output_file_writes(&file->out) || write_failed(file, error);
}

bool contact_file_flush(contact_file *file, io_error *error) {
    return output_file_flush(&file->out) || write_failed(file, error);
}

bool contact_file_close(contact_file *file, io_error *error) {
    if (file == NULL) return true;
    bool written = output_file_close(&file->out, OUTPUT_WHOLE_LINES) || write_failed(file, error);
    free_contact_file(file);
    return written;
}
