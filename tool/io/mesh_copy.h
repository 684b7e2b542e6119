/* Copies of mesh files in which vertices have other places. All else stays as it is, byte for byte: names,
 * materials, texture coordinates, polygons, comments; but for the normals of an STL, which follow. */
#pragma once

#include "tool/io/io.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>

typedef struct mesh_copy mesh_copy;

/* The formats that can be copied so, for people. */
#define MESH_COPY_FORMATS "OBJ, PLY, OFF or STL"

/* True if files of the format can be copied so. */
bool mesh_copy_knows(mesh_format format);

/* Reads the file that is copied, which must be a regular one. On false *out is untouched. */
bool mesh_copy_open(const char *path, mesh_copy **out, io_error *error);
void mesh_copy_close(mesh_copy *copy); /* NULL is fine */

/* As many vertices, and their places, as mesh_file_read has them. */
uint32_t mesh_copy_vertex_count(const mesh_copy *copy);
const double *mesh_copy_positions(const mesh_copy *copy);

/* True if the file holds coordinates as floats, so that what is written is rounded to floats. */
bool mesh_copy_holds_floats(const mesh_copy *copy);

/* Writes a copy, which takes the place of an older file when it is whole. positions: finite, of all vertices.
 * A coordinate that is that of the file, bit for bit, keeps its digits; others of a text get as many as bring
 * the same double back. */
bool mesh_copy_write(const mesh_copy *copy, const char *path, const double *positions, io_error *error);
