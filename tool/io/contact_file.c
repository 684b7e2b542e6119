/* Contacts as rows of a CSV file or lines of a JSON Lines file. */
#include "tool/io/contact_file.h"

#include "tool/io/json.h"
#include "tool/io/output_file.h"
#include "tool/io/path_name.h"
#include "tool/io/text_escape.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct contact_file {
    output_file out;
    char *path;
    bool csv;
    contact_columns columns;
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

static bool write_header(const contact_file *file) {
    const char *bounded = file->columns.bounded ? ",bounded" : "";
    const char *objects = file->columns.object_names != NULL ? ",object_a,object_b" : "";
    return !file->csv || fprintf(file->out.file, "frame,kind,toi,a0,a1,b0,b1,b2,u,v,x,y,z,nx,ny,nz%s%s\n",
                                 bounded, objects) >= 0;
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
    file->columns = columns;
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

static void write_csv(FILE *file, const contact_record *r, const contact_columns *columns) {
    fprintf(file, "%" PRId32 ",%s,%.17g,", r->frame, cscd_contact_kind_name(r->kind), r->toi);
    if (r->kind == CSCD_CONTACT_VF)
        fprintf(file, "%" PRIu32 ",,%" PRIu32 ",%" PRIu32 ",%" PRIu32, r->a[0], r->b[0], r->b[1], r->b[2]);
    else
        fprintf(file, "%" PRIu32 ",%" PRIu32 ",%" PRIu32 ",%" PRIu32 ",", r->a[0], r->a[1], r->b[0], r->b[1]);
    fprintf(file, ",%.17g,%.17g", r->u, r->v);
    for (int k = 0; k < 3; k++) fprintf(file, ",%.17g", r->point[k]);
    for (int k = 0; k < 3; k++) fprintf(file, ",%.17g", r->normal[k]);
    if (columns->bounded) fprintf(file, ",%d", r->bounded);
    for (int i = 0; i < 2 && columns->object_names != NULL; i++) {
        fputc(',', file);
        text_write_csv(file, columns->object_names[r->objects[i]]);
    }
    fputc('\n', file);
}

static void write_indices(json *out, const char *key, const uint32_t *indices, int count) {
    json_begin_array(out, key);
    for (int i = 0; i < count; i++) json_integer(out, NULL, indices[i]);
    json_end_array(out);
}

static void write_vector(json *out, const char *key, const double vector[3]) {
    json_begin_array(out, key);
    for (int k = 0; k < 3; k++) json_number(out, NULL, vector[k]);
    json_end_array(out);
}

static void write_json_line(FILE *file, const contact_record *r, const contact_columns *columns) {
    json out = {.file = file};
    bool vf = r->kind == CSCD_CONTACT_VF;
    json_begin_object(&out, NULL);
    json_signed(&out, "frame", r->frame);
    json_string(&out, "kind", cscd_contact_kind_name(r->kind));
    json_number(&out, "toi", r->toi);
    write_indices(&out, "a", r->a, vf ? 1 : 2);
    write_indices(&out, "b", r->b, vf ? 3 : 2);
    json_number(&out, "u", r->u);
    json_number(&out, "v", r->v);
    write_vector(&out, "point", r->point);
    write_vector(&out, "normal", r->normal);
    if (columns->bounded) json_boolean(&out, "bounded", r->bounded);
    if (columns->object_names != NULL) {
        json_begin_array(&out, "objects");
        for (int i = 0; i < 2; i++) json_string(&out, NULL, columns->object_names[r->objects[i]]);
        json_end_array(&out);
    }
    json_end_object(&out);
    fputc('\n', file);
}

bool contact_file_write(contact_file *file, const contact_record *record, io_error *error) {
    if (file->csv)
        write_csv(file->out.file, record, &file->columns);
    else
        write_json_line(file->out.file, record, &file->columns);
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
