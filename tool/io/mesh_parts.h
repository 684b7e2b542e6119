/* The named parts of a mesh file: objects, groups or materials of an OBJ, nodes or materials of a glTF, labels of a PLY. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define NO_MESH_PART UINT32_MAX

/* What makes the parts of a mesh file. */
typedef enum mesh_parts_by {
    MESH_PARTS_BY_FILE, /* what the file has: of an OBJ objects with their groups, of a glTF nodes, STL solids, PLY labels */
    MESH_PARTS_BY_OBJECT,  /* of an OBJ objects alone; else as above */
    MESH_PARTS_BY_GROUP,   /* groups of an OBJ; no other format has any */
    MESH_PARTS_BY_MATERIAL /* materials of an OBJ or glTF; no other format has any */
} mesh_parts_by;

typedef struct mesh_parts {
    uint32_t count;        /* 0: the file names none, and there are no labels */
    char **names;          /* count of them, each another one */
    uint32_t *of_triangle; /* per triangle: which part, or NO_MESH_PART */

    /* A hash table of the names, for mesh_parts_find: parts + 1, 0 for a free place. */
    uint32_t *places;
    size_t place_count; /* a power of 2, more than twice the parts; 0: there is no table yet */
} mesh_parts;

/* Frees names and labels; a zeroed struct is fine. */
void mesh_parts_free(mesh_parts *parts);

/* The part of that name, which is added if there is none yet; the first length characters of name count. NO_MESH_PART when
 * out of memory. The list was empty at first, and all of its names came by this function. */
uint32_t mesh_parts_find(mesh_parts *parts, const char *name, size_t length);
