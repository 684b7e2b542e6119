/* Contacts as rows of a CSV file or lines of a JSON Lines file. */
#include "tool/io/contact_file.h"

#include "tool/io/output_file.h"
#include "tool/io/path_name.h"
#include "tool/io/record.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

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
