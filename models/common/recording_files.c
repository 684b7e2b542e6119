/* The files of a recording, side by side in one folder: a model, its frames, and the same of its scenery. */
#include "models/common/recording_files.h"

#include "tool/io/mesh_file.h"

#include <stdio.h>

enum { PATH_MAX_LENGTH = 4096 };

static bool name_file(const char *folder, const char *name, const char *ending, char path[PATH_MAX_LENGTH],
                      io_error *error) {
    int length = snprintf(path, PATH_MAX_LENGTH, "%s/%s%s", folder[0] != '\0' ? folder : ".", name, ending);
    return (length > 0 && length < PATH_MAX_LENGTH) ||
           io_fail(error, "%s%s: the folder's name is too long", name, ending);
}

bool recording_write_model(const char *folder, const char *name, const char *ending, const body *b,
                           io_error *error) {
    char path[PATH_MAX_LENGTH];
    const mesh_file mesh = mesh_file_of(b->vertex_count, b->triangle_count, b->positions, b->triangles);
    return name_file(folder, name, ending, path, error) && mesh_file_write_obj(path, &mesh, error);
}

bool recording_open_frames(const char *folder, const char *name, const char *ending, uint32_t vertex_count,
                           uint32_t frame_count, point_cache_writer **out, io_error *error) {
    char path[PATH_MAX_LENGTH];
    return name_file(folder, name, ending, path, error) &&
           point_cache_writer_open(path, vertex_count, frame_count, out, error);
}
