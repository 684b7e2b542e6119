/* Finds the parts of a recording, and keeps their names. */
#include "tool/common/part_names.h"

#include "tool/io/growable.h"

#include <assert.h>
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

/* The parts that an object's file names; of a file that names none, the object itself. What the file leaves without a name
 * is in no part, unless the object has a name of its own. */
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

/* Who asks for parts of a kind must get some: else all of a file would silently be one part, or its components parts. */
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

static bool label_parts(const recording *r, const cscd_plan *plan, part_names *parts, io_error *error) {
    parts->named = r->object_count > 1 || files_name_parts(r);
    if (r->parts_by != MESH_PARTS_BY_FILE && !files_name_parts(r)) return fail_without_parts(r, error);
    for (uint32_t i = 0; i < r->object_count && parts->named; i++)
        if (!add_object(r, i, parts, error)) return false;
    if (parts->named) return true;
    const uint32_t components = cscd_mesh_component_count(r->mesh);
    if (components == 1 && plan != NULL && cscd_plan_region_count(plan) > 1)
        return number_parts(parts, "region", cscd_plan_region_labels(plan, parts->labels), error);
    cscd_mesh_component_labels(r->mesh, parts->labels);
    if (components > 1) return number_parts(parts, "component", components, error);
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
