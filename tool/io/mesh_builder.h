/* Collects the vertices and faces of a mesh file, checking each. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/io.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The most vertices and the most triangles of a mesh. */
#define MESH_COUNT_LIMIT INT32_MAX

/* A face, and where its corners end. */
typedef struct built_face {
    size_t corner_end;
    uint32_t part, own_part;
} built_face;

typedef struct mesh_builder {
    file_reader *reader;
    uint32_t index_base; /* what the format calls the first vertex, for messages */
    growable positions;  /* of double[3] */
    growable corners;    /* of uint32_t, face by face */
    growable faces;      /* of built_face */
    growable stiffness;  /* of double: of all faces, or empty */
    uint32_t part;       /* of the faces to come; NO_MESH_PART: none */
    mesh_parts parts;
    uint32_t own_part; /* the same by MESH_PARTS_BY_FILE, where the reader wants other parts */
    mesh_parts own_parts;
    mesh_repairs repairs;
    uint64_t triangle_count; /* of all faces together */
    uint64_t faces_hash;
} mesh_builder;

mesh_builder mesh_builder_of(file_reader *reader, uint32_t index_base);
void mesh_builder_free(mesh_builder *builder);

/* On false the reader's error is set, as in all below. */
bool mesh_builder_add_vertex(mesh_builder *builder, const double position[3]);

/* The faces to come belong to the part of that name; length 0: to none. */
bool mesh_builder_set_part(mesh_builder *builder, const char *name, size_t length);

/* The same of the parts by MESH_PARTS_BY_FILE, where the reader wants others. */
bool mesh_builder_set_own_part(mesh_builder *builder, const char *name, size_t length);

/* The face that was begun last belongs to the part of that name, and so do those to come. */
bool mesh_builder_set_face_part(mesh_builder *builder, const char *name, size_t length);

/* Begin a face, add its corners (0-based, in range or checked later), and end it. */
bool mesh_builder_begin_face(mesh_builder *builder);
bool mesh_builder_add_corner(mesh_builder *builder, uint32_t vertex);
bool mesh_builder_end_face(mesh_builder *builder);

/* Adds the stiffness of the face that was begun last; every face has one, or none. */
bool mesh_builder_add_face_stiffness(mesh_builder *builder, double stiffness);

/* Cuts the faces into triangles, now that all vertices are known, and moves the mesh to *out; false, and *out
 * untouched, when it has no vertices or no triangles. */
bool mesh_builder_finish(mesh_builder *builder, mesh_file *out);
