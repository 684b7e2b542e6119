/* Plays a sequence of mesh files: keeps their names and reads one file for each frame asked for. */
#include "tool/io/format_reader.h"

#include "tool/io/file_reader.h"
#include "tool/io/frames/frame_names.h"
#include "tool/io/io.h"
#include "tool/io/mesh_file.h"
#include "tool/io/point_cache.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct frame_files {
    uint32_t vertex_count;
    char *folder; /* what precedes each name: a folder with its '/', or "" */
    frame_names list;
    char *path; /* room for the folder and the longest name */
    size_t path_size;
    const char *note;
    uint32_t model_face_count; /* 0: not known */
    uint64_t model_faces_hash;
    bool faces_seen; /* of the first frame read: */
    uint64_t faces_hash;
    uint32_t faces_frame;
};

static frame_files *create_files(const char *source, uint32_t vertex_count, io_error *error) {
    frame_files *files = io_realloc(NULL, sizeof *files);
    if (files == NULL)
        io_fail(error, "%s: out of memory", source);
    else
        *files = (frame_files){.vertex_count = vertex_count, .list = frame_names_none()};
    return files;
}

/* Does everything that follows once the names are known; closes files if it fails. */
static bool finish_files(frame_files *files, const char *source, frame_files **out, io_error *error) {
    size_t longest = 0;
    for (size_t i = 0; i < frame_names_count(&files->list); i++) {
        const size_t length = strlen(frame_names_at(&files->list, i));
        longest = length > longest ? length : longest;
    }
    files->path_size = strlen(files->folder) + longest + 1;
    files->path = io_realloc(NULL, files->path_size);
    bool finished = files->path != NULL;
    if (!finished)
        io_fail(error, "%s: out of memory", source);
    else if (frame_names_count(&files->list) > UINT32_MAX)
        finished = io_fail(error, "%s: %zu frames, expected at most %" PRIu32, source,
                           frame_names_count(&files->list), UINT32_MAX);
    if (finished)
        *out = files;
    else
        frame_files_close(files);
    return finished;
}

bool frame_files_open_pattern(const char *pattern, bool allow_gaps, uint32_t vertex_count, frame_files **out,
                              io_error *error) {
    frame_files *files = create_files(pattern, vertex_count, error);
    if (files == NULL) return false;
    if (!frame_pattern_find(pattern, allow_gaps, &files->folder, &files->list, error)) {
        frame_files_close(files);
        return false;
    }
    return finish_files(files, pattern, out, error);
}

static char *with_slash(const char *folder) {
    const size_t length = strlen(folder);
    char *copy = io_realloc(NULL, length + 2);
    if (copy != NULL)
        snprintf(copy, length + 2, "%s%s", folder,
                 length > 0 && !path_is_separator(folder[length - 1]) ? "/" : "");
    return copy;
}

bool frame_files_open_folder(const char *folder, bool allow_gaps, uint32_t vertex_count, frame_files **out,
                             io_error *error) {
    frame_files *files = create_files(folder, vertex_count, error);
    if (files == NULL) return false;
    files->folder = with_slash(folder);
    if (files->folder == NULL) {
        frame_files_close(files);
        return io_fail(error, "%s: out of memory", folder);
    }
    bool fractions;
    if (!frame_folder_find(folder, files->folder, allow_gaps, &files->list, &fractions, error)) {
        frame_files_close(files);
        return false;
    }
    if (fractions) files->note = FRAME_FRACTIONS_NOTE;
    return finish_files(files, folder, out, error);
}

static bool check_listed(const char *path, io_error *error) {
    struct stat status;
    if (stat(path, &status) != 0)
        return io_fail(error, "%s: cannot open: %s%s", path, strerror(errno),
                       errno == ENOENT ? path_missing_advice(path) : "");
    if (!S_ISREG(status.st_mode))
        return io_fail(error, "%s: %s, expected a mesh file: a folder must be the only path given", path,
                       S_ISDIR(status.st_mode) ? "a folder" : "not a regular file");
    if (point_cache_recognise(path))
        return io_fail(error, "%s: a point cache among several paths, expected it to be the only one", path);
    const char *advice = foreign_format_advice(path, NULL, 0);
    if (advice != NULL) return io_fail(error, "%s: this is %s", path, advice);
    if (path_mesh_ending(path) == 0)
        return io_fail(error,
                       "%s: unknown extension, expected " MESH_FORMAT_ENDINGS
                       " (one a frame), or one .pc2 or .mdd",
                       path);
    return true;
}

static bool add_listed(frame_files *files, const char *const *paths, size_t path_count, io_error *error) {
    files->folder = frame_names_copy("", 0);
    if (files->folder == NULL) return io_fail(error, "%s: out of memory", paths[0]);
    for (size_t i = 0; i < path_count; i++) {
        if (!check_listed(paths[i], error)) return false;
        if (!frame_names_add(&files->list, paths[i])) return io_fail(error, "%s: out of memory", paths[i]);
    }
    return true;
}

static bool lists_path(const frame_names *list, const char *path) {
    for (size_t i = 0; i < frame_names_count(list); i++)
        if (strcmp(frame_names_at(list, i), path) == 0) return true;
    return false;
}

/* Copies a list, with one more name unless it is NULL, in natural order; false when out of memory. */
static bool copy_sorted(const frame_names *list, const char *name, frame_names *copy) {
    bool copied = name == NULL || frame_names_add(copy, name);
    for (size_t i = 0; i < frame_names_count(list) && copied; i++)
        copied = frame_names_add(copy, frame_names_at(list, i));
    if (copied) frame_names_sort(copy);
    return copied;
}

/* The kinds of names that may be listed. */
typedef enum list_kind { LIST_OF_NAMES, LIST_IS_SERIES, LIST_HAS_FRACTIONS } list_kind;

/* If the list, with the model unless that is NULL, is a series, it becomes the list in its order, and *number
 * the one that counts the frames; the same of subframes. */
static bool take_series(frame_files *files, const char *model_path, list_kind *kind, size_t *number,
                        io_error *error) {
    frame_names unused = frame_names_none();
    bool fractions = false;
    bool good = copy_sorted(&files->list, model_path, &unused);
    const bool series = good && frame_series_find(&unused, number);
    good = good && (series || frame_series_take_fractions(&unused, &fractions));
    *kind = series ? LIST_IS_SERIES : fractions ? LIST_HAS_FRACTIONS : LIST_OF_NAMES;
    if (*kind != LIST_OF_NAMES) {
        const frame_names taken = unused;
        unused = files->list;
        files->list = taken;
    }
    frame_names_free(&unused);
    return good || io_fail(error, "%s: out of memory", frame_names_at(&files->list, 0));
}

/* Names that are no series make one story with the model, which is told first: it is looked at as they
 * are. */
static bool put_model_first(frame_names *list, const char *model_path, io_error *error) {
    frame_names all = frame_names_none();
    bool good = frame_names_add(&all, model_path);
    for (size_t i = 0; i < frame_names_count(list) && good; i++)
        good = frame_names_add(&all, frame_names_at(list, i));
    frame_names unused = good ? *list : all;
    if (good) *list = all;
    frame_names_free(&unused);
    return good || io_fail(error, "%s: out of memory", model_path);
}

static const char *note_on_order(list_kind kind, bool sorted, bool model_joined) {
    if (kind == LIST_HAS_FRACTIONS) return FRAME_FRACTIONS_NOTE;
    if (kind == LIST_IS_SERIES) return sorted ? NULL : "the frames are taken in the order of their numbers";
    return model_joined
               ? "the frames are taken in the order given, the model first, because their names differ in "
                 "more than one number"
               : "the frames are taken in the order given, because their names differ in more than one "
                 "number";
}

/* Finds the order of the frames, and their numbers. */
static bool order_list(frame_files *files, const char *model_path, bool allow_gaps, io_error *error) {
    frame_names *list = &files->list;
    const bool joins =
        model_path != NULL && path_mesh_ending(model_path) > 0 && !lists_path(list, model_path);
    const bool sorted = frame_names_are_sorted(list);
    list_kind kind = LIST_OF_NAMES;
    size_t number = SIZE_MAX;
    if (joins && !take_series(files, model_path, &kind, &number, error)) return false;
    if (kind == LIST_OF_NAMES && !take_series(files, NULL, &kind, &number, error)) return false;
    const bool first = kind == LIST_OF_NAMES && joins;
    if (first && !put_model_first(list, model_path, error)) return false;
    if (kind == LIST_HAS_FRACTIONS || frame_names_count(list) > 1)
        files->note = note_on_order(kind, sorted, first);
    if (kind == LIST_HAS_FRACTIONS) return frame_series_end_fractions("", list, allow_gaps, error);
    if (kind == LIST_OF_NAMES && frame_names_count(list) > 1) return true;
    return frame_series_read("", list, number, &list->numbers, error) &&
           (allow_gaps || frame_series_is_complete("", list, number, error));
}

bool frame_files_open_list(const char *const *paths, size_t path_count, const char *model_path,
                           bool allow_gaps, uint32_t vertex_count, frame_files **out, io_error *error) {
    frame_files *files = create_files(paths[0], vertex_count, error);
    if (files == NULL) return false;
    if (!add_listed(files, paths, path_count, error) || !order_list(files, model_path, allow_gaps, error)) {
        frame_files_close(files);
        return false;
    }
    return finish_files(files, paths[0], out, error);
}

void frame_files_close(frame_files *files) {
    if (files == NULL) return;
    frame_names_free(&files->list);
    free(files->folder);
    free(files->path);
    free(files);
}

uint32_t frame_files_frame_count(const frame_files *files) {
    return (uint32_t)frame_names_count(&files->list);
}

int32_t frame_files_number(const frame_files *files, uint32_t frame) {
    const growable *numbers = &files->list.numbers;
    return numbers->count > 0 ? ((const int32_t *)numbers->data)[frame] : (int32_t)frame;
}

const char *frame_files_note(const frame_files *files) {
    return files->note;
}

static bool copy_positions(const frame_files *files, const mesh_file *mesh, double *positions,
                           io_error *error) {
    if (mesh->vertex_count != files->vertex_count)
        return io_fail(error,
                       "%s: holds %" PRIu32 " vertices, the model has %" PRIu32
                       " vertices: it was exported from another mesh",
                       files->path, mesh->vertex_count, files->vertex_count);
    const size_t count = (size_t)mesh->vertex_count * 3;
    for (size_t i = 0; i < count; i++) {
        const double value = mesh->positions[i];
        if (!isfinite(value))
            return io_fail(error, "%s: vertex %zu, %c is %f, expected a finite number", files->path, i / 3,
                           "xyz"[i % 3], value);
        positions[i] = value;
    }
    return true;
}

void frame_files_expect_faces(frame_files *files, uint32_t face_count, uint64_t faces_hash) {
    files->model_face_count = face_count;
    files->model_faces_hash = faces_hash;
}

static bool fail_faces(const frame_files *files, const mesh_file *mesh, const char *other, io_error *error) {
    return io_fail(error, "%s: has other faces than %s: expected frames of one mesh, vertices in one order%s",
                   files->path, other,
                   mesh->polygons == NULL
                       ? "; if the exporter triangulates each frame by itself, export without triangulating"
                       : "");
}

/* If the faces differ from those of earlier frames, the vertices most likely have another order. A model with
 * another number of faces may be the same mesh all the same, triangulated or with its quads. */
static bool same_faces(frame_files *files, uint32_t frame, const mesh_file *mesh, io_error *error) {
    if (files->faces_seen && mesh->faces_hash != files->faces_hash)
        return fail_faces(files, mesh, frame_names_at(&files->list, files->faces_frame), error);
    if (mesh->polygon_count == files->model_face_count && mesh->polygon_count > 0 &&
        mesh->faces_hash != files->model_faces_hash)
        return fail_faces(files, mesh, "the model, though as many", error);
    if (!files->faces_seen) files->faces_frame = frame;
    files->faces_seen = true;
    files->faces_hash = mesh->faces_hash;
    return true;
}

static void write_path(frame_files *files, uint32_t frame) {
    snprintf(files->path, files->path_size, "%s%s", files->folder, frame_names_at(&files->list, frame));
}

bool frame_files_read(frame_files *files, uint32_t frame, double *positions, io_error *error) {
    write_path(files, frame);
    mesh_file mesh = {0};
    if (!mesh_file_read(files->path, &mesh, error)) return false;
    const bool copied =
        copy_positions(files, &mesh, positions, error) && same_faces(files, frame, &mesh, error);
    mesh_file_free(&mesh);
    return copied;
}

void frame_files_expect(frame_files *files, uint32_t frame) {
    write_path(files, frame);
    file_reader_expect(files->path);
}
