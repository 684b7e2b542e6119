/* A list of names, and a table to find them in: a file may name a part in each of its lines. */
#include "tool/io/mesh_parts.h"

#include "tool/io/growable.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_PLACES = 64 };

void mesh_parts_free(mesh_parts *parts) {
    for (uint32_t i = 0; i < parts->count; i++) free(parts->names[i]);
    free(parts->names);
    free(parts->of_triangle);
    free(parts->places);
    *parts = (mesh_parts){0};
}

/* FNV-1a, from where the table happens to lie: names that meet in one place of every table cannot be made up beforehand. */
static uint64_t hash_name(const uint32_t *places, const char *name, size_t length) {
    uint64_t hash =
        UINT64_C(0xcbf29ce484222325) ^ ((uint64_t)(uintptr_t)places >> 4) * UINT64_C(0x9e3779b97f4a7c15);
    for (size_t i = 0; i < length; i++) hash = (hash ^ (unsigned char)name[i]) * UINT64_C(0x100000001b3);
    return hash ^ hash >> 32;
}

/* Where the name stands, or would. There is a free place. */
static uint32_t *find_place(const mesh_parts *parts, const char *name, size_t length) {
    const size_t mask = parts->place_count - 1;
    for (size_t i = (size_t)hash_name(parts->places, name, length) & mask;; i = (i + 1) & mask) {
        uint32_t *place = &parts->places[i];
        const char *other = *place != 0 ? parts->names[*place - 1] : NULL;
        if (other == NULL || (strlen(other) == length && memcmp(other, name, length) == 0)) return place;
    }
}

/* Makes a table with room for one more part. */
static bool reserve_place(mesh_parts *parts) {
    if (parts->place_count > 2 * ((size_t)parts->count + 1)) return true;
    const size_t count = parts->place_count > 0 ? 2 * parts->place_count : FIRST_PLACES;
    uint32_t *places = count < SIZE_MAX / sizeof *places ? io_zeroed(count * sizeof *places) : NULL;
    if (places == NULL) return false;
    free(parts->places);
    parts->places = places;
    parts->place_count = count;
    for (uint32_t i = 0; i < parts->count; i++)
        *find_place(parts, parts->names[i], strlen(parts->names[i])) = i + 1;
    return true;
}

/* The list doubles, so that it is seldom copied. */
static bool reserve_name(mesh_parts *parts) {
    const size_t count = parts->count;
    if ((count & (count - 1)) != 0) return true; /* it was full at powers of 2 alone */
    char **names = io_realloc(parts->names, (count > 0 ? 2 * count : 1) * sizeof *names);
    if (names == NULL) return false;
    parts->names = names;
    return true;
}

uint32_t mesh_parts_find(mesh_parts *parts, const char *name, size_t length) {
    if (!reserve_place(parts)) return NO_MESH_PART;
    uint32_t *place = find_place(parts, name, length);
    if (*place != 0) return *place - 1;
    char *copy = io_realloc(NULL, length + 1);
    if (copy == NULL || !reserve_name(parts)) {
        free(copy);
        return NO_MESH_PART;
    }
    memcpy(copy, name, length);
    copy[length] = '\0';
    parts->names[parts->count] = copy;
    *place = ++parts->count;
    return parts->count - 1;
}
