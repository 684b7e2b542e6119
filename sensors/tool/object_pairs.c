/* Sets of object pairs, those of warnings and those of contacts, so that they can be compared. */
#include "sensors/tool/object_pairs.h"

#include <stdlib.h>
#include <string.h>

object_pairs object_pairs_none(void) {
    return (object_pairs){growable_of(sizeof(uint64_t))};
}

void object_pairs_free(object_pairs *pairs) {
    growable_free(&pairs->keys);
}

void object_pairs_clear(object_pairs *pairs) {
    pairs->keys.count = 0;
}

bool object_pairs_add(object_pairs *pairs, uint32_t a, uint32_t b) {
    uint64_t *key = growable_push(&pairs->keys);
    if (key == NULL) return false;
    *key = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    return true;
}

static int compare_keys(const void *a, const void *b) {
    uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return p < q ? -1 : p > q;
}

void object_pairs_close(object_pairs *pairs) {
    uint64_t *keys = pairs->keys.data;
    size_t count = 0;
    if (pairs->keys.count > 1) qsort(keys, pairs->keys.count, sizeof *keys, compare_keys);
    for (size_t i = 0; i < pairs->keys.count; i++)
        if (count == 0 || keys[count - 1] != keys[i]) keys[count++] = keys[i];
    pairs->keys.count = count;
}

uint32_t object_pairs_count(const object_pairs *pairs) {
    return (uint32_t)pairs->keys.count;
}

uint32_t object_pairs_common(const object_pairs *a, const object_pairs *b) {
    const uint64_t *p = a->keys.data, *q = b->keys.data;
    uint32_t common = 0;
    for (size_t i = 0, j = 0; i < a->keys.count && j < b->keys.count;) {
        common += p[i] == q[j];
        if (p[i] < q[j])
            i++;
        else
            j++;
    }
    return common;
}

/* Finds the part of each cell first, because cells are numbered part by part. */
static void fill_map(const cscd_mesh *mesh, const cscd_sensors *sensors, uint32_t *cell_parts,
                     object_map *map) {
    for (uint32_t p = 0; p < cscd_sensors_part_count(sensors); p++) {
        cscd_sensor_part part = cscd_sensors_part(sensors, p);
        for (uint32_t i = 0; i < part.cell_count; i++) cell_parts[part.first_cell + i] = p;
    }
    for (uint32_t v = 0; v < cscd_mesh_vertex_count(mesh); v++) {
        uint32_t cell = cscd_sensors_vertex_cell(sensors, v);
        map->parts[v] = cell == UINT32_MAX ? UINT32_MAX : cell_parts[cell];
        map->objects[v] = cell == UINT32_MAX ? UINT32_MAX : cscd_sensors_part(sensors, map->parts[v]).object;
    }
}

bool object_map_make(const cscd_mesh *mesh, const cscd_sensors *sensors, object_map *out) {
    uint32_t vertices = cscd_mesh_vertex_count(mesh), cells = cscd_sensors_cell_count(sensors);
    object_map map = {calloc(vertices, sizeof *map.objects), calloc(vertices, sizeof *map.parts)};
    uint32_t *cell_parts = calloc((size_t)cells + 1, sizeof *cell_parts);
    bool made = map.objects != NULL && map.parts != NULL && cell_parts != NULL;
    if (made) fill_map(mesh, sensors, cell_parts, &map);
    free(cell_parts);
    if (made)
        *out = map;
    else
        object_map_free(&map);
    return made;
}

void object_map_free(object_map *map) {
    free(map->objects);
    free(map->parts);
    *map = (object_map){0};
}

/* The first vertices of both features. */
static void first_vertices(const cscd_mesh *mesh, const cscd_contact *contact, uint32_t out[2]) {
    uint32_t corners[3];
    out[0] = contact->a;
    if (contact->kind == CSCD_CONTACT_VF) {
        cscd_mesh_triangle(mesh, contact->b, corners);
    } else {
        cscd_mesh_edge(mesh, contact->a, corners);
        out[0] = corners[0];
        cscd_mesh_edge(mesh, contact->b, corners);
    }
    out[1] = corners[0];
}

bool object_pairs_of_contacts(const cscd_mesh *mesh, const object_map *map, const cscd_contacts *contacts,
                              bool within, object_pairs *out) {
    object_pairs_clear(out);
    for (size_t i = 0; i < contacts->count; i++) {
        uint32_t v[2];
        first_vertices(mesh, &contacts->items[i], v);
        uint32_t a = map->objects[v[0]], b = map->objects[v[1]];
        if (a == b && !(within && map->parts[v[0]] != map->parts[v[1]])) continue;
        if (!object_pairs_add(out, a, b)) return false;
    }
    object_pairs_close(out);
    return true;
}

bool object_pairs_of_warnings(const cscd_warnings *warnings, bool confirmed_only, object_pairs *out) {
    object_pairs_clear(out);
    for (size_t i = 0; i < warnings->count; i++) {
        const cscd_warning *w = &warnings->items[i];
        if (confirmed_only && !w->contact) continue;
        if (!object_pairs_add(out, w->object_a, w->object_b)) return false;
    }
    object_pairs_close(out);
    return true;
}
