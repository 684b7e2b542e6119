/* Finds the parts of a recording, and keeps their names. */
#include "src/tool/common/part_names.h"

#include "src/io/growable.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void part_names_free(part_names *parts) {
    for (uint32_t i = 0; i < parts->count; i++) free(parts->names[i]);
    free(parts->names);
    free(parts->labels);
    *parts = (part_names){0};
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

/* The parts that an object's file names; of a file that names none, the object itself. What the file leaves without a name
 * is in no part, unless the object has a name of its own. */
static bool add_object(const recording *r, uint32_t index, part_names *parts, io_error *error) {
    const recorded_object *object = &r->objects[index];
    const mesh_parts *own = &object->file.parts;
    const char *name = r->object_count > 1 ? object->source.name : NULL;
    const uint32_t first = parts->count, count = count_parts(own, name);
    const uint32_t rest = name != NULL ? first + count : NO_PART;
    for (uint32_t i = 0; i < count; i++)
        if (!add_part(parts, name, own->names[i], error)) return false;
    if (name != NULL && !add_part(parts, name, NULL, error)) return false;
    for (uint32_t t = 0; t < object->triangle_count; t++) {
        const uint32_t part =
            count > 0 ? own->of_triangle[recorded_object_file_triangle(object, t)] : NO_MESH_PART;
        parts->labels[object->first_triangle + t] = part != NO_MESH_PART ? first + part : rest;
    }
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

static bool find_parts(const recording *r, const cscd_plan *plan, part_names *parts, io_error *error) {
    if (!allocate_labels(r, parts, error)) return false;
    bool named = r->object_count > 1;
    for (uint32_t i = 0; i < r->object_count; i++) named |= r->objects[i].file.parts.count > 0;
    for (uint32_t i = 0; i < r->object_count && named; i++)
        if (!add_object(r, i, parts, error)) return false;
    parts->named = named;
    if (named) return true;
    const uint32_t components = cscd_mesh_component_count(r->mesh);
    if (components == 1 && plan != NULL && cscd_plan_region_count(plan) > 1)
        return number_parts(parts, "region", cscd_plan_region_labels(plan, parts->labels), error);
    cscd_mesh_component_labels(r->mesh, parts->labels);
    if (components > 1) return number_parts(parts, "component", components, error);
    return add_part(parts, r->objects[0].source.name, NULL, error);
}

bool part_names_find(const recording *r, const cscd_plan *plan, part_names *out, io_error *error) {
    part_names parts = {0};
    if (!find_parts(r, plan, &parts, error)) {
        part_names_free(&parts);
        return false;
    }
    *out = parts;
    return true;
}
