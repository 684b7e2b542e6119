/* Reads the parts of a recording from a table of numbers and names. */
#include "tool/common/part_names.h"

#include "tool/io/growable.h"
#include "tool/io/mesh_parts.h"
#include "tool/io/pipe_file.h"
#include "tool/io/text_encoding.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the numbers of a table count. */
typedef enum table_kind { TABLE_OF_TRIANGLES, TABLE_OF_FACES, TABLE_OF_VERTICES } table_kind;

typedef struct part_table {
    const recording *recording;
    const char *path;
    int line; /* counted from 1 */
    table_kind kind;
    mesh_parts names;
    uint32_t *labels[RECORDING_OBJECTS_MAX + 1]; /* per object: one for each thing that is counted */
} part_table;

static uint32_t count_things(const part_table *table, uint32_t object) {
    const mesh_file *file = &table->recording->objects[object].file;
    if (table->kind == TABLE_OF_VERTICES) return file->vertex_count;
    return table->kind == TABLE_OF_FACES ? file->polygon_count : file->triangle_count;
}

/* Cuts a line into two fields, without blanks and quotes around them. */
static bool split_fields(char *line, char *fields[2]) {
    line[strcspn(line, "\r\n")] = '\0';
    fields[0] = line;
    fields[1] = strpbrk(line, ",\t;");
    if (fields[1] == NULL) return false;
    *fields[1]++ = '\0';
    for (int i = 0; i < 2; i++) {
        char *text = fields[i] + strspn(fields[i], " \"");
        size_t length = strlen(text);
        while (length > 0 && (text[length - 1] == ' ' || text[length - 1] == '"')) length--;
        text[length] = '\0';
        fields[i] = text;
    }
    return fields[0][0] != '\0' && fields[1][0] != '\0';
}

static bool read_kind(part_table *table, char *line, size_t length, io_error *error) {
    static const char *const names[] = {"triangle", "face", "vertex"};
    char *fields[2];
    if (text_is_utf16(line, length)) return io_fail(error, "%s: " TEXT_UTF16_ADVICE, table->path);
    line += text_mark_size(line, length);
    if (split_fields(line, fields)) {
        for (int i = 0; i < 3; i++) {
            table->kind = (table_kind)i;
            if (strcmp(fields[0], names[i]) == 0) return true;
        }
    }
    return io_fail(error, "%s:1: expected 'triangle,name', 'face,name' or 'vertex,name'", table->path);
}

static bool allocate_things(part_table *table, io_error *error) {
    for (uint32_t i = 0; i < table->recording->object_count; i++) {
        const uint32_t count = count_things(table, i);
        table->labels[i] = io_realloc(NULL, ((size_t)count + 1) * sizeof *table->labels[i]);
        if (table->labels[i] == NULL) return io_fail(error, "%s: out of memory", table->path);
        for (uint32_t k = 0; k < count; k++) table->labels[i][k] = NO_PART;
    }
    return true;
}

/* Reads [NAME:]NUMBER. */
static bool read_number(const part_table *table, char *text, uint32_t *object, uint32_t *number) {
    char *colon = strrchr(text, ':'), *end = NULL;
    *object = table->recording->object_count == 1 ? 0 : UINT32_MAX;
    if (colon != NULL) {
        *colon = '\0';
        *object = recording_find_object(table->recording, text);
        text = colon + 1;
    }
    if (*object == UINT32_MAX || *text < '0' || *text > '9') return false;
    errno = 0;
    const unsigned long long value = strtoull(text, &end, 10);
    if (errno != 0 || *end != '\0' || value >= count_things(table, *object)) return false;
    *number = (uint32_t)value;
    return true;
}

static bool read_row(part_table *table, char *line, io_error *error) {
    char *fields[2];
    uint32_t object, number;
    if (line[strspn(line, " \t\r\n")] == '\0' || line[0] == '#') return true;
    if (!split_fields(line, fields) || !read_number(table, fields[0], &object, &number))
        return io_fail(error, "%s:%d: expected a number of the model file, a comma and a name%s", table->path,
                       table->line,
                       table->recording->object_count > 1 ? "; with several objects the number is NAME:12"
                                                          : "");
    const uint32_t part = mesh_parts_find(&table->names, fields[1], strlen(fields[1]));
    if (part == NO_MESH_PART) return io_fail(error, "%s:%d: out of memory", table->path, table->line);
    table->labels[object][number] = part;
    return true;
}

static bool read_rows(part_table *table, FILE *file, io_error *error) {
    char *line = NULL;
    size_t size = 0;
    const ssize_t length = getline(&line, &size, file);
    bool read = length >= 0 ? read_kind(table, line, (size_t)length, error)
                            : io_fail(error, "%s: the file is empty", table->path);
    read = read && allocate_things(table, error);
    for (table->line = 2; read && getline(&line, &size, file) >= 0; table->line++)
        read = read_row(table, line, error);
    if (read && ferror(file)) read = io_fail(error, "%s: cannot read: %s", table->path, strerror(errno));
    if (read && table->names.count == 0)
        read = io_fail(error, "%s: no part is named below the first line", table->path);
    free(line);
    return read;
}

/* The part that most corners are in; of equally many, that of the first one. */
static uint32_t choose_of_corners(const uint32_t *labels, const uint32_t corners[3]) {
    const uint32_t a = labels[corners[0]], b = labels[corners[1]], c = labels[corners[2]];
    return b == c ? b : a;
}

static bool label_triangles(part_table *table, part_names *out, io_error *error) {
    const recording *r = table->recording;
    const uint32_t count = cscd_mesh_triangle_count(r->mesh);
    out->labels = io_realloc(NULL, ((size_t)count + 1) * sizeof *out->labels);
    if (out->labels == NULL) return io_fail(error, "%s: out of memory", table->path);
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t index = recording_object_of_triangle(r, t), *labels = table->labels[index];
        const mesh_file *file = &r->objects[index].file;
        const uint32_t own = recording_file_triangle(r, t);
        if (table->kind == TABLE_OF_VERTICES)
            out->labels[t] = choose_of_corners(labels, file->triangles + (size_t)own * 3);
        else
            out->labels[t] = labels[table->kind == TABLE_OF_FACES ? mesh_file_polygon(file, own) : own];
    }
    out->count = table->names.count;
    out->names = table->names.names;
    table->names.count = 0; /* they are the caller's now */
    table->names.names = NULL;
    return true;
}

bool part_names_read(const recording *r, const char *path, part_names *out, io_error *error) {
    part_table table = {.recording = r, .path = path};
    part_names parts = {.named = true};
    FILE *file = pipe_file_read(path);
    if (file == NULL) return io_fail(error, "%s: cannot open: %s", path, strerror(errno));
    const bool read = read_rows(&table, file, error) && label_triangles(&table, &parts, error);
    fclose(file);
    for (uint32_t i = 0; i < r->object_count; i++) free(table.labels[i]);
    mesh_parts_free(&table.names);
    if (read) *out = parts;
    return read;
}
