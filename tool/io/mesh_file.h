/* Triangle meshes from files of all formats, and the list of these formats. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- the list of formats ------------------------------------------------------------------------------- */

/* Each row is the constant behind MESH_FORMAT_, the name for people, and the endings. */
#define MESH_FORMATS(FIRST, NEXT, LAST)                                                                      \
    FIRST(OBJ, "OBJ", ".obj")                                                                                \
    NEXT(PLY, "PLY", ".ply")                                                                                 \
    NEXT(OFF, "OFF", ".off")                                                                                 \
    NEXT(STL, "STL", ".stl")                                                                                 \
    NEXT(GLTF, "glTF", ".glb, .gltf")                                                                        \
    LAST(GIFTI, "GIFTI", ".gii")

#define MESH_FORMAT_CONSTANT(constant, name, endings) MESH_FORMAT_##constant,
typedef enum mesh_format {
    MESH_FORMAT_NONE, /* a mesh that was not read */
    MESH_FORMATS(MESH_FORMAT_CONSTANT, MESH_FORMAT_CONSTANT, MESH_FORMAT_CONSTANT)
} mesh_format;

#define MESH_FIRST_NAME(constant, name, endings)   name
#define MESH_NEXT_NAME(constant, name, endings)    ", " name
#define MESH_OR_NAME(constant, name, endings)      " or " name
#define MESH_FIRST_ENDING(constant, name, endings) endings
#define MESH_NEXT_ENDING(constant, name, endings)  ", " endings
#define MESH_OR_ENDING(constant, name, endings)    " or " endings

/* "OBJ, PLY, .., GIFTI"; "OBJ, PLY, .. or GIFTI"; ".obj, .ply, .. or .gii". */
#define MESH_FORMAT_NAMES   MESH_FORMATS(MESH_FIRST_NAME, MESH_NEXT_NAME, MESH_NEXT_NAME)
#define MESH_FORMAT_CHOICE  MESH_FORMATS(MESH_FIRST_NAME, MESH_NEXT_NAME, MESH_OR_NAME)
#define MESH_FORMAT_ENDINGS MESH_FORMATS(MESH_FIRST_ENDING, MESH_NEXT_ENDING, MESH_OR_ENDING)

/* The format that the ending of a path says, or MESH_FORMAT_NONE. *length is that of the ending. */
mesh_format mesh_format_of_path(const char *path, unsigned *length);

/* The name of a format; "" for MESH_FORMAT_NONE. */
const char *mesh_format_name(mesh_format format);

/* ---- parts --------------------------------------------------------------------------------------------- */

#define NO_MESH_PART UINT32_MAX

/* The choice of what makes the parts of a mesh file. */
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

/* The part of that name, which is added if there is none yet; the first length characters of name count.
 * NO_MESH_PART when out of memory. The list was empty at first, and all of its names came by this
 * function. */
uint32_t mesh_parts_find(mesh_parts *parts, const char *name, size_t length);

/* ---- meshes -------------------------------------------------------------------------------------------- */

/* The repairs of a reader to faces that are no polygons of three different corners or more, or that it could
 * not fill by their shape. Faces are counted from 0, in the file's order. */
typedef struct mesh_repairs {
    uint32_t shortened,
        first_shortened;             /* faces that named a vertex twice in a row, which then counts once */
    uint32_t dropped, first_dropped; /* faces that are left without a triangle */
    uint32_t fanned, first_fanned;   /* faces that cross themselves in every plane of two coordinates */
    uint32_t skipped_primitives;     /* of a glTF: points and lines */
} mesh_repairs;

/* Vertices in the file's own order; faces in file order, polygons cut into triangles by their shape
 * (mesh_builder.h), as they are in this file. */
typedef struct mesh_file {
    mesh_format format;
    uint32_t vertex_count, triangle_count,
        polygon_count;   /* polygons: faces of the file, dropped ones included */
    double *positions;   /* vertex_count * 3 */
    uint32_t *triangles; /* triangle_count * 3 */
    uint32_t *polygons;  /* triangle_count: the face that each is cut from; NULL: triangle i is face i */
    double *stiffness;   /* triangle_count: as the file has it, unchecked; NULL: it has none */
    mesh_parts parts;
    mesh_parts_by parts_by;
    mesh_parts
        own_parts; /* those by MESH_PARTS_BY_FILE, which say what belongs together; none if parts are they */
    uint64_t faces_hash; /* of the faces as the file has them: their corners, face by face */
    mesh_repairs repairs;
    uint32_t animation_count; /* that the file holds beside the mesh, whose positions are those at rest */
    char *unread;             /* a sentence about what may change the mesh and is not read; NULL: nothing */
} mesh_file;

/* Adds a face to the hash of those before it (64-bit FNV-1a). Files whose faces have the same hash have the
 * same faces. */
#define MESH_HASH_START 0xcbf29ce484222325u
static inline uint64_t mesh_file_hash(uint64_t hash, const uint32_t *corners, size_t count) {
    hash = (hash ^ count) * 0x100000001b3u;
    for (size_t i = 0; i < count; i++) hash = (hash ^ corners[i]) * 0x100000001b3u;
    return hash;
}

/* A mesh of triangles, to be written. */
static inline mesh_file mesh_file_of(uint32_t vertex_count, uint32_t triangle_count, double *positions,
                                     uint32_t *triangles) {
    mesh_file mesh = {.vertex_count = vertex_count,
                      .triangle_count = triangle_count,
                      .positions = positions,
                      .triangles = triangles};
    return mesh;
}

/* The face of the file that a triangle is cut from, counted from 0. */
static inline uint32_t mesh_file_polygon(const mesh_file *mesh, uint32_t triangle) {
    return mesh->polygons != NULL ? mesh->polygons[triangle] : triangle;
}

/* The format follows from the content where it says so ("ply", "OFF", "glTF"), else from the extension.
 * On false *out is untouched and *error says file, line or byte offset, what was found and expected. */
bool mesh_file_read(const char *path, mesh_file *out, io_error *error);

/* The same with other parts. There are none where the file names nothing of that kind. */
bool mesh_file_read_parts(const char *path, mesh_parts_by parts_by, mesh_file *out, io_error *error);

/* The parts by MESH_PARTS_BY_FILE, whatever the mesh was read by. */
static inline const mesh_parts *mesh_file_own_parts(const mesh_file *mesh) {
    return mesh->parts_by == MESH_PARTS_BY_FILE ? &mesh->parts : &mesh->own_parts;
}

/* Frees what read allocated and zeroes the struct; a zeroed struct is fine. */
void mesh_file_free(mesh_file *mesh);

/* The file takes the place of an older one when it is whole (output_file.h). */
bool mesh_file_write_obj(const char *path, const mesh_file *mesh, io_error *error);
