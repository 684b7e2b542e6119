/* Triangle meshes from OBJ, PLY, OFF, STL, glTF and GIFTI files: which format it is, and writing OBJ. */
#include "src/io/mesh_file.h"

#include "src/io/file_reader.h"
#include "src/io/foreign_format.h"
#include "src/io/gifti.h"
#include "src/io/gltf.h"
#include "src/io/obj.h"
#include "src/io/off.h"
#include "src/io/path_name.h"
#include "src/io/ply.h"
#include "src/io/stl.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* Some editors put a UTF-8 byte order mark in front of a text. */
static void skip_byte_order_mark(file_reader *reader) {
    if (reader->size >= 3 && memcmp(reader->bytes, "\xef\xbb\xbf", 3) == 0) reader->at = 3;
}

static bool read_any(file_reader *reader, mesh_file *out) {
    if (reader->size == 0)
        return file_reader_fail(reader,
                                "the file is empty, expected an OBJ, PLY, OFF, STL, glTF or GIFTI mesh");
    skip_byte_order_mark(reader);
    if (gltf_recognise(reader)) return gltf_read(reader, out);
    if (gifti_recognise(reader)) return gifti_read(reader, out);
    if (stl_recognise(reader)) return stl_read(reader, out);
    if (ply_recognise(reader)) return ply_read(reader, out);
    if (off_recognise(reader)) return off_read(reader, out);
    if (path_has_extension(reader->path, ".obj")) return obj_read(reader, out);
    if (path_has_extension(reader->path, ".ply")) return ply_read(reader, out);
    if (path_has_extension(reader->path, ".off")) return off_read(reader, out);
    if (path_has_extension(reader->path, ".stl")) return stl_read(reader, out);
    const char *advice = foreign_format_advice(reader->path, reader->bytes, reader->size);
    if (advice != NULL) return file_reader_fail(reader, "this is %s", advice);
    return file_reader_fail(reader, "unknown format, expected a mesh: " PATH_MESH_ENDINGS);
}

/* Readers of formats that have triangles only leave this to be filled. */
static void count_triangles_as_faces(mesh_file *mesh) {
    if (mesh->polygon_count > 0) return;
    mesh->polygon_count = mesh->triangle_count;
    mesh->faces_hash = MESH_HASH_START;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        mesh->faces_hash = mesh_file_hash(mesh->faces_hash, mesh->triangles + (size_t)t * 3, 3);
}

bool mesh_file_read(const char *path, mesh_file *out, io_error *error) {
    file_reader reader;
    if (!file_reader_open(&reader, path, error)) return false;
    bool done = read_any(&reader, out);
    if (done) count_triangles_as_faces(out);
    file_reader_close(&reader);
    return done;
}

void mesh_file_free(mesh_file *mesh) {
    free(mesh->positions);
    free(mesh->triangles);
    free(mesh->polygons);
    mesh_parts_free(&mesh->parts);
    *mesh = (mesh_file){0};
}

static bool print_obj(FILE *file, const mesh_file *mesh) {
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const double *x = mesh->positions + 3 * (size_t)i;
        if (fprintf(file, "v %.17g %.17g %.17g\n", x[0], x[1], x[2]) < 0) return false;
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *corner = mesh->triangles + 3 * (size_t)i;
        if (fprintf(file, "f %" PRIu32 " %" PRIu32 " %" PRIu32 "\n", corner[0] + 1, corner[1] + 1,
                    corner[2] + 1) < 0) {
            return false;
        }
    }
    return fflush(file) == 0;
}

/* A device or a pipe that could not take the mesh is not removed. */
static void remove_regular_file(const char *path) {
    struct stat status;
    if (lstat(path, &status) == 0 && S_ISREG(status.st_mode)) remove(path);
}

bool mesh_file_write_obj(const char *path, const mesh_file *mesh, io_error *error) {
    file_reader place = {.path = path, .error = error}; /* for its messages */
    FILE *file = fopen(path, "wb");
    if (file == NULL) return file_reader_fail(&place, "cannot open for writing: %s", strerror(errno));
    bool done = print_obj(file, mesh);
    int cause = errno;
    if (fclose(file) != 0 && done) {
        done = false;
        cause = errno;
    }
    if (done) return true;
    remove_regular_file(path);
    return file_reader_fail(&place, "cannot write: %s", strerror(cause));
}
