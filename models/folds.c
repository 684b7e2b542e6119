/* A folded surface, as of a cortex, whose ridges swell into each other. */
#include "models/folds/folds.h"
#include "tool/io/mesh_file.h"
#include "tool/io/point_cache_write.h"

#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: folds FOLDER\n"
    "\n"
    "Writes folds.obj, a closed surface of 20,480 triangles with deep folds, and folds.pc2, 100 frames in which ridges swell\n"
    "until the banks of some folds have passed through each other, and back again. Nothing meets in the first frames.\n";

typedef double frame_positions[FOLDS_VERTICES][3];

static bool write_cache(const char *path, const folds *f, io_error *error) {
    static frame_positions positions;
    point_cache_writer *writer;
    if (!point_cache_writer_open(path, FOLDS_VERTICES, FOLDS_FRAMES, &writer, error)) return false;
    for (int frame = 0; frame < FOLDS_FRAMES; frame++) {
        folds_pose(f, frame, positions);
        if (!point_cache_writer_write(writer, positions[0], error)) break;
    }
    return point_cache_writer_close(writer, error);
}

static bool write_folds(const char *folder, folds *f, io_error *error) {
    char path[4096];
    const mesh_file model = mesh_file_of(FOLDS_VERTICES, FOLDS_TRIANGLES, f->positions[0], f->triangles[0]);
    snprintf(path, sizeof path, "%s/folds.obj", folder);
    if (!mesh_file_write_obj(path, &model, error)) return false;
    snprintf(path, sizeof path, "%s/folds.pc2", folder);
    return write_cache(path, f, error);
}

int main(int argument_count, char **arguments) {
    static folds f;
    io_error error;
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        fputs(help, stdout);
        return 0;
    }
    if (argument_count != 2 || strlen(arguments[1]) > 4000) {
        fputs("folds: expected a folder; see --help\n", stderr);
        return 2;
    }
    folds_make(&f);
    if (!write_folds(arguments[1], &f, &error)) {
        fprintf(stderr, "folds: %s\n", error.text);
        return 1;
    }
    printf("%d vertices, %d triangles, %d frames\n", FOLDS_VERTICES, FOLDS_TRIANGLES, FOLDS_FRAMES);
    return 0;
}
