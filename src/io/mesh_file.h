/* Triangle meshes from OBJ, PLY, OFF, STL, glTF and GIFTI files. */
#pragma once

#include "src/io/io_error.h"

#include <stdbool.h>
#include <stdint.h>

/* Vertices in the file's own order; faces in file order, polygons as triangle fans around their first
 * corner. */
typedef struct mesh_file {
    uint32_t vertex_count, triangle_count;
    double *positions;   /* vertex_count * 3 */
    uint32_t *triangles; /* triangle_count * 3 */
} mesh_file;

/* The format follows from the content where it says so ("ply", "OFF", "glTF"), else from the extension.
 * On false *out is untouched and *error says file, line or byte offset, what was found and expected. */
bool mesh_file_read(const char *path, mesh_file *out, io_error *error);

/* Frees what read allocated and zeroes the struct; a zeroed struct is fine. */
void mesh_file_free(mesh_file *mesh);

bool mesh_file_write_obj(const char *path, const mesh_file *mesh, io_error *error);
