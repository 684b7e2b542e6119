/* Chooses the reader that the given paths call for and passes the frames on. */
#include "tool/io/animation.h"

#include "tool/io/format_reader.h"
#include "tool/io/io.h"
#include "tool/io/point_cache.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct animation_source {
    const char *const *paths;
    size_t count;
    uint32_t vertex_count;
    animation_options options;
} animation_source;

/* Reads frames that are recorded in one way; source is the handle of the open reader. */
typedef struct animation_reader {
    bool (*open)(const animation_source *from, void **source, io_error *error);
    uint32_t (*frame_count)(const void *source);
    int32_t (*number)(const void *source, uint32_t frame);
    const char *(*note)(const void *source); /* NULL: never says anything */
    bool (*read)(void *source, uint32_t frame, double *positions, io_error *error);
    void (*expect)(void *source, uint32_t frame); /* NULL: all frames are in one file */
    void (*close)(void *source);
} animation_reader;

struct animation {
    const animation_reader *reader;
    void *source;
    char name[]; /* the first path */
};

/* ---- the readers, as the table wants them ------------------------------------------------------------ */

static bool open_cache(const animation_source *from, void **source, io_error *error) {
    point_cache *cache;
    if (!point_cache_open(from->paths[0], from->vertex_count, &cache, error)) return false;
    *source = cache;
    return true;
}

static uint32_t count_cache(const void *source) {
    return point_cache_frame_count(source);
}

static int32_t number_in_cache(const void *source, uint32_t frame) {
    return point_cache_frame_number(source, frame);
}

static bool read_cache(void *source, uint32_t frame, double *positions, io_error *error) {
    return point_cache_read(source, frame, positions, error);
}

static void close_cache(void *source) {
    point_cache_close(source);
}

static bool keep_files(const animation_source *from, frame_files *files, void **source) {
    frame_files_expect_faces(files, from->options.model_face_count, from->options.model_faces_hash);
    *source = files;
    return true;
}

static bool open_pattern(const animation_source *from, void **source, io_error *error) {
    frame_files *files;
    if (!frame_files_open_pattern(from->paths[0], from->options.allow_gaps, from->vertex_count, &files,
                                  error))
        return false;
    return keep_files(from, files, source);
}

static bool open_folder(const animation_source *from, void **source, io_error *error) {
    frame_files *files;
    if (!frame_files_open_folder(from->paths[0], from->options.allow_gaps, from->vertex_count, &files, error))
        return false;
    return keep_files(from, files, source);
}

static bool open_list(const animation_source *from, void **source, io_error *error) {
    frame_files *files;
    if (!frame_files_open_list(from->paths, from->count, from->options.model_path, from->options.allow_gaps,
                               from->vertex_count, &files, error))
        return false;
    return keep_files(from, files, source);
}

static uint32_t count_files(const void *source) {
    return frame_files_frame_count(source);
}

static int32_t number_of_file(const void *source, uint32_t frame) {
    return frame_files_number(source, frame);
}

static const char *note_on_files(const void *source) {
    return frame_files_note(source);
}

static bool read_files(void *source, uint32_t frame, double *positions, io_error *error) {
    return frame_files_read(source, frame, positions, error);
}

static void expect_file(void *source, uint32_t frame) {
    frame_files_expect(source, frame);
}

static void close_files(void *source) {
    frame_files_close(source);
}

static bool open_gltf(const animation_source *from, void **source, io_error *error) {
    const double fps = from->options.fps != 0 ? from->options.fps : ANIMATION_FPS;
    gltf_frames *frames;
    if (!gltf_frames_open(from->paths[0], from->vertex_count, fps, from->options.animation_name, &frames,
                          error))
        return false;
    *source = frames;
    return true;
}

static uint32_t count_gltf(const void *source) {
    return gltf_frames_count(source);
}

static int32_t number_in_gltf(const void *source, uint32_t frame) {
    return gltf_frames_number(source, frame);
}

static const char *note_on_gltf(const void *source) {
    return gltf_frames_note(source);
}

static bool read_gltf(void *source, uint32_t frame, double *positions, io_error *error) {
    return gltf_frames_read(source, frame, positions, error);
}

static void close_gltf(void *source) {
    gltf_frames_close(source);
}

enum { POINT_CACHE, GLTF_FILE, FILE_PATTERN, FILE_FOLDER, FILE_LIST };

static const animation_reader readers[] = {
    [POINT_CACHE] = {open_cache, count_cache, number_in_cache, NULL, read_cache, NULL, close_cache},
    [GLTF_FILE] = {open_gltf, count_gltf, number_in_gltf, note_on_gltf, read_gltf, NULL, close_gltf},
    [FILE_PATTERN] = {open_pattern, count_files, number_of_file, note_on_files, read_files, expect_file,
                      close_files},
    [FILE_FOLDER] = {open_folder, count_files, number_of_file, note_on_files, read_files, expect_file,
                     close_files},
    [FILE_LIST] = {open_list, count_files, number_of_file, note_on_files, read_files, expect_file,
                   close_files},
};

/* ---- the interface ----------------------------------------------------------------------------------- */

/* NULL after an error. A path that exists is taken as it is, even if it holds a percent sign. */
static const animation_reader *choose_reader(const animation_source *from, io_error *error) {
    if (from->count == 0) {
        io_fail(error, "no animation given: expected a .pc2 or .mdd file, a pattern such as f_%%04d.obj, "
                       "a folder, or mesh files");
        return NULL;
    }
    if (from->count > 1) return &readers[FILE_LIST];
    const char *path = from->paths[0];
    struct stat status;
    if (stat(path, &status) != 0) {
        if (strchr(path, '%') != NULL) return &readers[FILE_PATTERN];
        const char *advice = errno == ENOENT ? path_missing_advice(path) : "";
        io_fail(error, "%s: cannot open: %s%s", path, strerror(errno), advice);
        return NULL;
    }
    if (S_ISDIR(status.st_mode)) return &readers[FILE_FOLDER];
    if (!S_ISREG(status.st_mode)) return &readers[FILE_LIST];
    if (gltf_recognise_path(path)) return &readers[GLTF_FILE];
    return &readers[point_cache_recognise(path) ? POINT_CACHE : FILE_LIST];
}

bool animation_open(const char *const *paths, size_t path_count, uint32_t vertex_count,
                    const animation_options *options, animation **out, io_error *error) {
    animation_source from = {.paths = paths, .count = path_count, .vertex_count = vertex_count};
    if (options != NULL) from.options = *options;
    const animation_reader *chosen = choose_reader(&from, error);
    if (chosen == NULL) return false;
    if (vertex_count == 0)
        return io_fail(error, "%s: the model has no vertices, expected at least 1", paths[0]);
    const size_t name_size = strlen(paths[0]) + 1;
    animation *opened = io_realloc(NULL, sizeof *opened + name_size);
    if (opened == NULL) return io_fail(error, "%s: out of memory", paths[0]);
    opened->reader = chosen;
    memcpy(opened->name, paths[0], name_size);
    if (!chosen->open(&from, &opened->source, error)) {
        free(opened);
        return false;
    }
    *out = opened;
    return true;
}

void animation_close(animation *opened) {
    if (opened == NULL) return;
    opened->reader->close(opened->source);
    free(opened);
}

bool animation_is_one_file(const animation *opened) {
    return opened->reader->expect == NULL;
}

uint32_t animation_frame_count(const animation *opened) {
    return opened->reader->frame_count(opened->source);
}

int32_t animation_frame_number(const animation *opened, uint32_t frame) {
    return opened->reader->number(opened->source, frame);
}

const char *animation_note(const animation *opened) {
    return opened->reader->note != NULL ? opened->reader->note(opened->source) : NULL;
}

bool animation_read(animation *opened, uint32_t frame, double *positions, io_error *error) {
    const uint32_t count = animation_frame_count(opened);
    if (frame >= count)
        return io_fail(error, "%s: no frame %" PRIu32 ", expected one from 0 to %" PRIu32, opened->name,
                       frame, count - 1);
    return opened->reader->read(opened->source, frame, positions, error);
}

void animation_expect(animation *opened, uint32_t frame) {
    if (opened->reader->expect != NULL) opened->reader->expect(opened->source, frame);
}
