/* Reads bytes as a mesh file and checks the mesh, whatever happens to the file or to memory; used inside cmocka tests. */
#pragma once

#include "tool/io/mesh_file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct file_bytes {
    const char *name; /* the file's name with its extension */
    const void *bytes;
    size_t size;
} file_bytes;

/* Makes a file of a string literal, which may contain zeros. */
#define FILE_OF(name, literal)                                                                               \
    (file_bytes) {                                                                                           \
        (name), (literal), sizeof(literal) - 1                                                               \
    }

/* Writes the file to a temporary folder, reads it and removes both. */
bool mesh_check_read(file_bytes file, mesh_file *mesh, io_error *error);
bool mesh_check_read_parts(file_bytes file, mesh_parts_by parts_by, mesh_file *mesh, io_error *error);

/* Checks that the file is read, and has exactly these arrays, bit for bit. */
void mesh_check_equal(file_bytes file, uint32_t vertex_count, const double *positions,
                      uint32_t triangle_count, const uint32_t *triangles);
/* Checks the same for a square: 0 0 0, 1 0 0, 1 1 0, 0 1 0 with the triangles 0 1 2 and 0 2 3. */
void mesh_check_square(file_bytes file);

/* Checks that the file is refused with a message, or gives a mesh whose numbers are all in range. */
void mesh_check_survives(file_bytes file);
/* Checks that the file is refused for want of memory, by its name and with the mesh unchanged, when its first allocation fails, its second
 * and so on, and that it is read the next time as if nothing had happened. */
void mesh_check_memory(file_bytes file, mesh_parts_by parts_by);

/* Checks its memory, and what mesh_check_survives does for the file cut after every byte, with every bit flipped, and with every
 * byte doubled and dropped. */
void mesh_check_damage(file_bytes file);

/* ---- random damage ------------------------------------------------------------------------------------- */

typedef struct file_damage_counts {
    uint32_t read, refused;        /* meshes */
    uint32_t animated, unanimated; /* of those that were read: animations */
} file_damage_counts;

/* Each round damages the file in one to four places, and checks that it is refused in one line, or gives numbers that are in
 * range. */
file_damage_counts file_damage_rounds(file_bytes file, uint32_t round_count, uint64_t seed);
