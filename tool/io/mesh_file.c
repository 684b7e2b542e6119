/* Triangle meshes from files: which format it is, the names of parts, and writing OBJ; and files of other
 * programs that are not read, with the way out of them. */
#include "tool/io/mesh_file.h"

#include "tool/io/format_reader.h"
#include "tool/io/io.h"
#include "tool/io/output_file.h"
#include "tool/io/text_encoding.h"

#include <errno.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- files of other programs --------------------------------------------------------------------------- */

enum { STARTS_MOST = 2, ENDINGS_MOST = 4 };

#define SCENE_ADVICE                                                                                         \
    ", which is not read: export the mesh as OBJ, and its frames as an OBJ sequence, a PC2 or MDD point "    \
    "cache or animated glTF (.glb); see docs/artist/formats.md"
#define MESH_ADVICE ", which is not read: convert it to OBJ, PLY, OFF or STL; see docs/artist/formats.md"
#define SURFACE_ADVICE                                                                                       \
    ", which is not read: mris_convert makes a GIFTI surface (.gii) of it; see docs/artist/formats.md"

typedef struct foreign_format {
    const char *advice;
    const char *starts[STARTS_MOST];   /* of their content */
    const char *endings[ENDINGS_MOST]; /* of their names */
} foreign_format;

static const foreign_format formats[] = {
    {"an Alembic archive" SCENE_ADVICE, {"Ogawa"}, {".abc"}},
    {"a USD file" SCENE_ADVICE, {"PXR-USDC", "#usda"}, {".usd", ".usda", ".usdc", ".usdz"}},
    {"an FBX file" SCENE_ADVICE, {"Kaydara FBX", "; FBX"}, {".fbx"}},
    {"a Blender file" SCENE_ADVICE, {"BLENDER"}, {".blend"}},
    {"an X3D file" SCENE_ADVICE, {"#X3D"}, {".x3d", ".x3dv", ".x3db"}},
    {"a VRML file" SCENE_ADVICE, {"#VRML"}, {".wrl"}},
    {"a COLLADA file" SCENE_ADVICE, {NULL}, {".dae"}},
    {"a Maya scene" SCENE_ADVICE, {"//Maya"}, {".ma", ".mb"}},
    {"a 3ds Max scene" SCENE_ADVICE, {NULL}, {".max", ".3ds"}},
    {"a Cinema 4D scene" SCENE_ADVICE, {NULL}, {".c4d"}},
    {"a Houdini file" SCENE_ADVICE, {NULL}, {".hip", ".hipnc", ".bgeo", ".geo"}},
    {"a ZBrush project" SCENE_ADVICE, {NULL}, {".zpr", ".ztl"}},
    {"a Marvelous Designer project" SCENE_ADVICE, {NULL}, {".zprj"}},
    {"a VTK file" MESH_ADVICE, {"# vtk DataFile"}, {".vtk", ".vtp", ".vtu"}},
    {"a mesh of Gmsh or Medit" MESH_ADVICE,
     {"$MeshFormat", "MeshVersionFormatted"},
     {".msh", ".mesh", ".meshb"}},
    {"a 3MF package" MESH_ADVICE, {NULL}, {".3mf"}},
    {"a FreeSurfer surface" SURFACE_ADVICE, {"\xff\xff\xfe"}, {".pial", ".white", ".inflated", ".sphere"}},
};

static bool has_start(const foreign_format *format, const char *bytes, size_t size) {
    for (int i = 0; i < STARTS_MOST && format->starts[i] != NULL; i++) {
        const size_t length = strlen(format->starts[i]);
        if (size >= length && memcmp(bytes, format->starts[i], length) == 0) return true;
    }
    return false;
}

static bool has_ending(const foreign_format *format, const char *path) {
    for (int i = 0; i < ENDINGS_MOST && format->endings[i] != NULL; i++)
        if (path_has_extension(path, format->endings[i])) return true;
    return false;
}

const char *foreign_format_advice(const char *path, const char *bytes, size_t size) {
    const size_t count = sizeof formats / sizeof *formats;
    for (size_t i = 0; bytes != NULL && i < count; i++)
        if (has_start(&formats[i], bytes, size)) return formats[i].advice;
    for (size_t i = 0; i < count; i++)
        if (has_ending(&formats[i], path)) return formats[i].advice;
    return NULL;
}

/* ---- names of parts, and a table to find them in: a file may name a part in each of its lines ---------- */

enum { FIRST_PLACES = 64 };

void mesh_parts_free(mesh_parts *parts) {
    for (uint32_t i = 0; i < parts->count; i++) free(parts->names[i]);
    free(parts->names);
    free(parts->of_triangle);
    free(parts->places);
    *parts = (mesh_parts){0};
}

/* FNV-1a, from where the table happens to lie: names that meet in one place of every table cannot be made up
 * beforehand. */
static uint64_t hash_name(const uint32_t *places, const char *name, size_t length) {
    uint64_t hash =
        UINT64_C(0xcbf29ce484222325) ^ ((uint64_t)(uintptr_t)places >> 4) * UINT64_C(0x9e3779b97f4a7c15);
    for (size_t i = 0; i < length; i++) hash = (hash ^ (unsigned char)name[i]) * UINT64_C(0x100000001b3);
    return hash ^ hash >> 32;
}

/* Finds the place of the name, or the free one that it would get. There is a free place. */
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

/* ---- meshes -------------------------------------------------------------------------------------------- */

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

/* Formats without groups and materials have no parts of that kind; except of OBJ, parts by object are the
 * file's. */
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

bool mesh_reader_read(file_reader *reader, mesh_file *out) {
    const bool done = read_any(reader, out);
    if (done) count_triangles_as_faces(out);
    return done;
}

bool mesh_file_read(const char *path, mesh_file *out, io_error *error) {
    return mesh_file_read_parts(path, MESH_PARTS_BY_FILE, out, error);
}

bool mesh_file_read_parts(const char *path, mesh_parts_by parts_by, mesh_file *out, io_error *error) {
    file_reader reader;
    if (!file_reader_open(&reader, path, error)) return false;
    reader.parts_by = parts_by;
    const bool done = mesh_reader_read(&reader, out);
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
