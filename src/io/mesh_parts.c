/* A list of names. Files have few parts, and name one of them at a time, so it is searched from its end. */
#include "src/io/mesh_parts.h"

#include "src/io/growable.h"

#include <stdlib.h>
#include <string.h>

void mesh_parts_free(mesh_parts *parts) {
    for (uint32_t i = 0; i < parts->count; i++) free(parts->names[i]);
    free(parts->names);
    free(parts->of_triangle);
    *parts = (mesh_parts){0};
}

uint32_t mesh_parts_find(mesh_parts *parts, const char *name, size_t length) {
    for (uint32_t i = parts->count; i-- > 0;)
        if (strlen(parts->names[i]) == length && memcmp(parts->names[i], name, length) == 0) return i;
    char *copy = io_realloc(NULL, length + 1);
    char **names = copy != NULL ? io_realloc(parts->names, ((size_t)parts->count + 1) * sizeof *names) : NULL;
    if (names == NULL) {
        free(copy);
        return NO_MESH_PART;
    }
    memcpy(copy, name, length);
    copy[length] = '\0';
    parts->names = names;
    parts->names[parts->count] = copy;
    return parts->count++;
}
