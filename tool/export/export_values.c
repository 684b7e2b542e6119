/* Values of each vertex and triangle of a frame, as arrays with names, and the names of the files. */
#include "tool/export/export_values.h"

#include "tool/common/methods.h"
#include "tool/io/io.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t export_type_size(export_type type) {
    static const size_t sizes[] = {1, 4, 4, 8};
    return sizes[type];
}

/* NULL when out of memory; the array is zero. */
static void *add_array(export_table *table, const char *name, export_type type) {
    void *values = calloc((size_t)table->count + 1, export_type_size(type));
    if (values != NULL) table->arrays[table->array_count++] = (export_array){name, type, values};
    return values;
}

static void free_table(export_table *table) {
    for (size_t i = 0; i < table->array_count; i++) free(table->arrays[i].values);
    *table = (export_table){0};
}

void export_values_free(export_values *values) {
    free_table(&values->vertices);
    free_table(&values->triangles);
    *values = (export_values){0};
}

static bool add_origins(const recording *r, const part_names *parts, export_values *v) {
    int32_t *part = add_array(&v->triangles, "part", EXPORT_INT32);
    uint32_t *object = add_array(&v->triangles, "object", EXPORT_UINT32);
    uint32_t *triangle = add_array(&v->triangles, "triangle", EXPORT_UINT32);
    uint32_t *polygon = add_array(&v->triangles, "polygon", EXPORT_UINT32);
    uint32_t *vertex = add_array(&v->vertices, "vertex", EXPORT_UINT32);
    if (part == NULL || object == NULL || triangle == NULL || polygon == NULL || vertex == NULL) return false;
    for (uint32_t t = 0; t < v->triangles.count; t++) {
        part[t] = parts->labels[t] == NO_PART ? -1 : (int32_t)parts->labels[t];
        object[t] = recording_object_of_triangle(r, t);
        triangle[t] = recording_file_triangle(r, t);
        polygon[t] = mesh_file_polygon(&r->objects[object[t]].file, triangle[t]);
    }
    for (uint32_t i = 0; i < v->vertices.count; i++) vertex[i] = recording_file_vertex(r, i);
    return true;
}

static bool add_plan(const cscd_plan *plan, export_values *v) {
    if (plan == NULL) return true;
    uint32_t *region = add_array(&v->triangles, "region", EXPORT_UINT32);
    if (region == NULL) return false;
    memcpy(region, cscd_plan_triangle_regions(plan), v->triangles.count * sizeof *region);
    if (!method_facts_of(cscd_plan_method(plan)).by_charge) return true;
    double *charge = add_array(&v->triangles, "charge", EXPORT_FLOAT64);
    if (charge == NULL) return false;
    for (uint32_t t = 0; t < v->triangles.count; t++) charge[t] = cscd_plan_triangle_charge(plan, t);
    return true;
}

static bool add_answers(export_values *v, export_choice choice) {
    v->intersecting = add_array(&v->triangles, "intersecting", EXPORT_UINT8);
    bool added = v->intersecting != NULL;
    for (int kind = CSCD_INTERSECTION_CROSSING; kind <= CSCD_INTERSECTION_TOUCHING; kind++) {
        const char *name = cscd_intersection_kind_name((cscd_intersection_kind)kind);
        v->kinds[kind] = add_array(&v->triangles, name, EXPORT_UINT32);
        added = added && v->kinds[kind] != NULL;
    }
    if (choice.depths) {
        v->buried = add_array(&v->triangles, "buried", EXPORT_UINT8);
        v->depth = add_array(&v->vertices, "depth", EXPORT_FLOAT64);
        added = added && v->buried != NULL && v->depth != NULL;
    }
    if (choice.contacts) {
        v->contacts = add_array(&v->vertices, "contacts", EXPORT_UINT32);
        added = added && v->contacts != NULL;
    }
    return added;
}

bool export_values_open(const recording *r, const part_names *parts, const cscd_plan *plan,
                        export_choice choice, export_values *out, io_error *error) {
    export_values v = {.vertices = {.count = cscd_mesh_vertex_count(r->mesh)},
                       .triangles = {.count = cscd_mesh_triangle_count(r->mesh)}};
    if (!add_origins(r, parts, &v) || !add_plan(plan, &v) || !add_answers(&v, choice)) {
        export_values_free(&v);
        return io_fail(error, "out of memory for the arrays of %u triangles",
                       cscd_mesh_triangle_count(r->mesh));
    }
    *out = v;
    return true;
}

static void count_pairs(export_values *v, const cscd_intersections *found) {
    const size_t count = v->triangles.count;
    for (int kind = 0; kind < 5; kind++) memset(v->kinds[kind], 0, count * sizeof *v->kinds[kind]);
    memset(v->intersecting, 0, count);
    for (size_t i = 0; i < found->count; i++) {
        const cscd_intersection *pair = &found->items[i];
        const uint32_t sides[2] = {pair->a, pair->b};
        const uint8_t meeting = (uint8_t)export_meeting_of(pair);
        for (int k = 0; k < 2; k++) {
            v->kinds[pair->kind][sides[k]]++;
            if (v->intersecting[sides[k]] < meeting) v->intersecting[sides[k]] = meeting;
        }
    }
}

static bool patch_is_buried(const cscd_patches *patches, uint32_t index) {
    const cscd_patch *patch = &patches->items[index];
    for (uint32_t i = 0; i < patch->winding_count; i++)
        if (patches->windings[patch->first_winding + i].number >= 1) return true;
    return false;
}

/* Without patches, which did not fit the memory, as the run says, every triangle may be cut. */
static void find_buried(export_values *v, const cscd_patches *patches) {
    if (patches == NULL) memset(v->buried, EXPORT_CUT, v->triangles.count);
    if (patches == NULL) return;
    for (uint32_t t = 0; t < v->triangles.count; t++) {
        const uint32_t patch = patches->triangle_patches[t];
        v->buried[t] = (uint8_t)(patch == UINT32_MAX               ? EXPORT_CUT
                                 : patch_is_buried(patches, patch) ? EXPORT_BURIED
                                                                   : EXPORT_NOT_BURIED);
    }
}

/* Of several objects that contain a vertex the one in which it is deepest counts. */
static void find_depths(export_values *v, const cscd_depths *depths) {
    memset(v->depth, 0, v->vertices.count * sizeof *v->depth);
    for (size_t i = 0; depths != NULL && i < depths->vertex_count; i++) {
        const cscd_depth *deep = &depths->items[i];
        if (deep->depth > v->depth[deep->vertex]) v->depth[deep->vertex] = deep->depth;
    }
}

void export_values_clear_contacts(export_values *v) {
    if (v->contacts != NULL) memset(v->contacts, 0, v->vertices.count * sizeof *v->contacts);
}

void export_values_add_contacts(export_values *v, const cscd_contacts *contacts) {
    for (size_t i = 0; v->contacts != NULL && i < contacts->count; i++)
        for (int k = 0; k < 4; k++) v->contacts[contacts->items[i].vertices[k]]++;
}

void export_values_set_frame(export_values *v, const cscd_intersections *found) {
    count_pairs(v, found);
    if (v->depth == NULL) return;
    find_buried(v, found->patches);
    find_depths(v, found->depths);
}

/* ---- the names of the files of an export, one for each frame --------------------------------------------- */

char *export_names_stem(const char *path, const char *ending) {
    const size_t length = strlen(path);
    return strndup(path, path_has_extension(path, ending) ? length - strlen(ending) : length);
}

char *export_names_frame(const char *stem, int32_t number, const char *ending) {
    const size_t size = strlen(stem) + strlen(ending) + 16;
    char *name = malloc(size);
    if (name != NULL) snprintf(name, size, "%s_%04" PRId32 "%s", stem, number, ending);
    return name;
}

char *export_names_join(const char *stem, const char *ending) {
    const size_t size = strlen(stem) + strlen(ending) + 1;
    char *name = malloc(size);
    if (name != NULL) snprintf(name, size, "%s%s", stem, ending);
    return name;
}
