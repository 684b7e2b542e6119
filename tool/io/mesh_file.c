/* Triangle meshes from files: which format it is, and writing OBJ. */
#include "tool/io/mesh_file.h"

#include "tool/io/foreign_format.h"
#include "tool/io/format_reader.h"
#include "tool/io/output_file.h"
#include "tool/io/path_name.h"
#include "tool/io/text_encoding.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* In the order in which they are asked whether a file is theirs. */
static const format_reader *const readers[] = {&gltf_reader, &gifti_reader, &stl_reader,
                                               &ply_reader,  &off_reader,   &obj_reader};

enum { READERS = sizeof readers / sizeof *readers };

/* NULL: what is in the file does not say. */
static const format_reader *recognise_reader(const file_reader *reader) {
    for (size_t i = 0; i < READERS; i++)
        if (readers[i]->recognise != NULL && readers[i]->recognise(reader)) return readers[i];
    return NULL;
}

/* NULL: the file's ending does not say either. */
static const format_reader *reader_of_ending(const file_reader *reader) {
    unsigned length;
    const char *name = path_file_name(reader->path);
    const mesh_format format = mesh_format_of_path(name, &length);
    for (size_t i = 0; i < READERS && strlen(name) > length; i++)
        if (readers[i]->by_ending && readers[i]->format == format) return readers[i];
    return NULL;
}

/* Formats without groups and materials have no parts of that kind; but for OBJ, parts by object are the file's. */
static bool read_format(file_reader *reader, const format_reader *chosen, mesh_file *out) {
    const bool by_object = reader->parts_by == MESH_PARTS_BY_OBJECT;
    if (by_object && chosen->format != MESH_FORMAT_OBJ) reader->parts_by = MESH_PARTS_BY_FILE;
    if (!chosen->read(reader, out)) return false;
    out->format = chosen->format;
    out->parts_by = reader->parts_by;
    if (!chosen->names_parts && out->parts_by != MESH_PARTS_BY_FILE) {
        out->own_parts = out->parts;
        out->parts = (mesh_parts){0};
    }
    return true;
}

static bool read_any(file_reader *reader, mesh_file *out) {
    if (reader->size == 0)
        return file_reader_fail(reader, "the file is empty, expected an " MESH_FORMAT_CHOICE " mesh");
    reader->at = text_mark_size(reader->bytes, reader->size);
    const format_reader *chosen = recognise_reader(reader);
    if (chosen == NULL && text_is_utf16(reader->bytes, reader->size))
        return file_reader_fail(reader, TEXT_UTF16_ADVICE);
    if (chosen == NULL) chosen = reader_of_ending(reader);
    if (chosen != NULL) return read_format(reader, chosen, out);
    const char *advice = foreign_format_advice(reader->path, reader->bytes, reader->size);
    if (advice != NULL) return file_reader_fail(reader, "this is %s", advice);
    return file_reader_fail(reader, "unknown format, expected a mesh: " MESH_FORMAT_ENDINGS);
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
    return mesh_file_read_parts(path, MESH_PARTS_BY_FILE, out, error);
}

bool mesh_file_read_parts(const char *path, mesh_parts_by parts_by, mesh_file *out, io_error *error) {
    file_reader reader;
    if (!file_reader_open(&reader, path, error)) return false;
    reader.parts_by = parts_by;
    bool done = read_any(&reader, out);
    if (done) count_triangles_as_faces(out);
    file_reader_close(&reader);
    return done;
}

void mesh_file_free(mesh_file *mesh) {
    free(mesh->positions);
    free(mesh->triangles);
    free(mesh->polygons);
    free(mesh->stiffness);
    free(mesh->unread);
    mesh_parts_free(&mesh->parts);
    mesh_parts_free(&mesh->own_parts);
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

bool mesh_file_write_obj(const char *path, const mesh_file *mesh, io_error *error) {
    file_reader place = {.path = path, .error = error}; /* for its messages */
    output_file out;
    if (!output_file_open(path, &out))
        return file_reader_fail(&place, "cannot open for writing: %s", strerror(errno));
    const bool printed = print_obj(out.file, mesh);
    if (output_file_close(&out, printed ? OUTPUT_WHOLE : OUTPUT_ABANDONED)) return true;
    return file_reader_fail(&place, "cannot write: %s", io_write_reason());
}
