/* Finds the parts of a recording, and keeps their names. */
#include "tool/common/part_names.h"

#include "tool/io/io.h"
#include "tool/io/mesh_file.h"
#include "tool/io/text_encoding.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void part_names_free(part_names *parts) {
    for (uint32_t i = 0; i < parts->count; i++) free(parts->names[i]);
    free(parts->names);
    free(parts->labels);
    free(parts->bodies);
    *parts = (part_names){0};
}

cscd_status part_names_tell(const part_names *parts, cscd_detector *detector) {
    const cscd_status status = cscd_detector_set_parts(detector, parts->labels, parts->count);
    return status == CSCD_OK ? cscd_detector_set_bodies(detector, parts->bodies, parts->body_count) : status;
}

const char *part_names_at(const part_names *parts, uint32_t part) {
    return part < parts->count ? parts->names[part] : "(no part)";
}

uint32_t part_names_choose(const part_names *parts, const char *name, size_t length, bool *chosen) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < parts->count; i++) {
        const char *own = parts->names[i];
        const bool fits = strncmp(own, name, length) == 0 && (own[length] == '\0' || own[length] == '/');
        count += fits;
        chosen[i] = chosen[i] || fits;
    }
    return count;
}

bool part_names_fail(const part_names *parts, const char *option, const char *name, size_t length,
                     io_error *error) {
    char known[400] = "";
    size_t used = 0;
    for (uint32_t i = 0; i < parts->count && used + 48 < sizeof known; i++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%.*s", i > 0 ? ", " : "",
                                 TEXT_CUT(parts->names[i], 40));
    return io_fail(error, "%s: there is no part '%.*s'; the parts are %s%s", option, (int)length, name, known,
                   parts->count > 0 && used + 48 >= sizeof known ? ", ..." : "");
}

static bool allocate_labels(const recording *r, part_names *parts, io_error *error) {
    uint32_t count = cscd_mesh_triangle_count(r->mesh);
    parts->labels = io_realloc(NULL, ((size_t)count + 1) * sizeof *parts->labels);
    if (parts->labels == NULL) return io_fail(error, "out of memory for the parts of %u triangles", count);
    for (uint32_t t = 0; t < count; t++) parts->labels[t] = NO_PART;
    return true;
}

/* Appends a part called OBJECT/PART, or by one of them if the other is NULL. */
static bool add_part(part_names *parts, const char *object, const char *part, io_error *error) {
    const size_t size = (object != NULL ? strlen(object) + 1 : 0) + (part != NULL ? strlen(part) : 0) + 1;
    char **names = io_realloc(parts->names, ((size_t)parts->count + 1) * sizeof *names);
    char *name = io_realloc(NULL, size);
    if (names != NULL) parts->names = names;
    if (names == NULL || name == NULL) {
        free(name);
        return io_fail(error, "out of memory for %u parts", parts->count + 1);
    }
    snprintf(name, size, "%s%s%s", object != NULL ? object : "", object != NULL && part != NULL ? "/" : "",
             part != NULL ? part : "");
    names[parts->count++] = name;
    return true;
}

/* A file with one part that is called as the object names the object once more: Body.obj of "o Body". */
static uint32_t count_parts(const mesh_parts *own, const char *object) {
    const bool again = object != NULL && own->count == 1 && strcmp(own->names[0], object) == 0;
    return again ? 0 : own->count;
}

/* The parts of an object: those of its file, from `first` on, and what is left. */
typedef struct object_parts {
    const mesh_parts *named;
    const char *name; /* NULL: it is the only object */
    uint32_t first, count, end;
    uint32_t rest; /* the part of what its file names in none */
} object_parts;

/* The parts that an object's file names; of a file that names none, the object itself. What the file leaves
 * without a name is in no part, unless the object has a name of its own. */
static object_parts parts_of_object(const recording *r, uint32_t index, const mesh_parts *named,
                                    uint32_t first) {
    object_parts own = {.named = named, .first = first, .rest = NO_PART};
    if (r->object_count > 1) own.name = r->objects[index].source.name;
    own.count = count_parts(named, own.name);
    own.end = first + own.count;
    if (own.name != NULL) own.rest = own.end++;
    return own;
}

static void label_object(const recorded_object *object, const object_parts *own, uint32_t *labels) {
    for (uint32_t t = 0; t < object->triangle_count; t++) {
        const uint32_t part =
            own->count > 0 ? own->named->of_triangle[recorded_object_file_triangle(object, t)] : NO_MESH_PART;
        labels[object->first_triangle + t] = part != NO_MESH_PART ? own->first + part : own->rest;
    }
}

static bool add_object(const recording *r, uint32_t index, part_names *parts, io_error *error) {
    const recorded_object *object = &r->objects[index];
    const object_parts own = parts_of_object(r, index, &object->file.parts, parts->count);
    for (uint32_t i = 0; i < own.count; i++)
        if (!add_part(parts, own.name, own.named->names[i], error)) return false;
    if (own.name != NULL && !add_part(parts, own.name, NULL, error)) return false;
    label_object(object, &own, parts->labels);
    return true;
}

static bool number_parts(part_names *parts, const char *what, uint32_t count, io_error *error) {
    for (uint32_t i = 0; i < count; i++) {
        char name[48];
        snprintf(name, sizeof name, "%s %u", what, i);
        if (!add_part(parts, NULL, name, error)) return false;
    }
    return true;
}

/* By --parts-by, the parts that the file has by itself. Returns how many there are. */
static uint32_t label_own_parts(const recording *r, uint32_t *labels) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->object_count; i++) {
        const recorded_object *object = &r->objects[i];
        const object_parts own = parts_of_object(r, i, mesh_file_own_parts(&object->file), count);
        label_object(object, &own, labels);
        count = own.end;
    }
    return count;
}

/* Names say what belongs together if there are several; one name for all says as little as none. */
static bool tell_apart(const uint32_t *labels, uint32_t triangle_count, uint32_t part_count) {
    if (part_count > 1) return true;
    for (uint32_t t = 0; t < triangle_count; t++)
        if (labels[t] != labels[0]) return true;
    return false;
}

/* Says what the bodies are, where that is not the parts. */
static bool label_bodies(const recording *r, part_names *parts, io_error *error) {
    const uint32_t count = cscd_mesh_triangle_count(r->mesh);
    const bool by_choice = r->parts_by != MESH_PARTS_BY_FILE;
    if (parts->named && !by_choice && tell_apart(parts->labels, count, parts->count)) return true;
    parts->bodies = io_realloc(NULL, ((size_t)count + 1) * sizeof *parts->bodies);
    if (parts->bodies == NULL) return io_fail(error, "out of memory for the parts of %u triangles", count);
    parts->body_count = by_choice ? label_own_parts(r, parts->bodies) : 0;
    if (parts->body_count > 0 && tell_apart(parts->bodies, count, parts->body_count)) return true;
    for (uint32_t t = 0; t < count; t++) parts->bodies[t] = NO_PART;
    parts->body_count = 1; /* which no triangle is in */
    return true;
}

/* Who asks for parts of a kind must get some: else all of a file would silently be one part, or its
 * components parts. */
static bool fail_without_parts(const recording *r, io_error *error) {
    char reason[120];
    recorded_object_explain_parts(&r->objects[0], reason, sizeof reason);
    return io_fail(error,
                   "%s: --parts-by %s finds no parts: %s; leave it out, or export the model as %s with them",
                   r->objects[0].source.model_path, recorded_object_parts_word(r->parts_by), reason,
                   r->parts_by == MESH_PARTS_BY_GROUP ? "OBJ" : "OBJ or glTF");
}

static bool files_name_parts(const recording *r) {
    for (uint32_t i = 0; i < r->object_count; i++)
        if (r->objects[i].file.parts.count > 0) return true;
    return false;
}

static bool label_by(const recording *r, const uint32_t *labels, const char *word, uint32_t count,
                     part_names *parts, io_error *error) {
    memcpy(parts->labels, labels, cscd_mesh_triangle_count(r->mesh) * sizeof *labels);
    return number_parts(parts, word, count, error);
}

static bool label_parts(const recording *r, const cscd_plan *plan, part_names *parts, io_error *error) {
    parts->named = r->object_count > 1 || files_name_parts(r);
    if (r->parts_by != MESH_PARTS_BY_FILE && !files_name_parts(r)) return fail_without_parts(r, error);
    for (uint32_t i = 0; i < r->object_count && parts->named; i++)
        if (!add_object(r, i, parts, error)) return false;
    if (parts->named) return true;
    const uint32_t components = cscd_mesh_component_count(r->mesh);
    if (components == 1 && plan != NULL && cscd_plan_region_count(plan) > 1)
        return label_by(r, cscd_plan_triangle_regions(plan), "region", cscd_plan_region_count(plan), parts,
                        error);
    const uint32_t *labels = cscd_mesh_array(r->mesh, CSCD_TRIANGLE_COMPONENTS);
    if (components > 1) return label_by(r, labels, "component", components, parts, error);
    memset(parts->labels, 0, cscd_mesh_triangle_count(r->mesh) * sizeof *parts->labels);
    return add_part(parts, r->objects[0].source.name, NULL, error);
}

bool part_names_find(const recording *r, const cscd_plan *plan, part_names *out, io_error *error) {
    part_names parts = {0};
    if (!allocate_labels(r, &parts, error) || !label_parts(r, plan, &parts, error) ||
        !label_bodies(r, &parts, error)) {
        part_names_free(&parts);
        return false;
    }
    *out = parts;
    return true;
}

/* ---- reads the parts of a recording from a table of numbers and names ------------------------------------ */

/* The things that the numbers of a table count. */
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
