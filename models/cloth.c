/* Records cloth that falls, drapes and folds without ever passing through anything: a model, its frames, and
 * what it falls onto. */
#include "models/textile/cloth_simulation.h"
#include "src/io/mesh_file.h"
#include "src/io/point_cache_write.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_MAX_LENGTH = 4096 };

/* The files of a recording, written side by side. */
typedef struct outputs {
    point_cache_writer *frames, *scenery_frames;
} outputs;

/* FOLDER/NAMEending; the current folder where the folder has no name. */
static bool name_file(const char *folder, const char *name, const char *ending, char path[PATH_MAX_LENGTH],
                      io_error *error) {
    int length = snprintf(path, PATH_MAX_LENGTH, "%s/%s%s", folder[0] != '\0' ? folder : ".", name, ending);
    return (length > 0 && length < PATH_MAX_LENGTH) ||
           io_fail(error, "%s%s: the folder's name is too long", name, ending);
}

static bool write_model(const char *folder, const char *name, const char *ending, const body *b,
                        io_error *error) {
    char path[PATH_MAX_LENGTH];
    const mesh_file mesh = {b->vertex_count, b->triangle_count, b->positions, b->triangles};
    return name_file(folder, name, ending, path, error) && mesh_file_write_obj(path, &mesh, error);
}

static bool open_frames(const char *folder, const cloth_scene *s, const char *ending, uint32_t vertex_count,
                        point_cache_writer **out, io_error *error) {
    char path[PATH_MAX_LENGTH];
    return name_file(folder, s->name, ending, path, error) &&
           point_cache_writer_open(path, vertex_count, s->frame_count, out, error);
}

static bool obstacles_move(const cloth_scene *s) {
    bool move = false;
    for (uint32_t i = 0; i < s->obstacle_count; i++) move = move || s->obstacles[i].seconds > 0.0;
    return move;
}

/* All obstacles as they begin. */
static body make_scenery(const cloth_simulation *c) {
    body scenery = {0};
    for (uint32_t i = 0; i < c->scene->obstacle_count; i++)
        body_append(&scenery, &c->obstacles[i], (double[3]){0.0, 0.0, 0.0});
    memcpy(scenery.positions, c->positions + c->garment.vertex_count * 3,
           (size_t)scenery.vertex_count * 3 * sizeof *scenery.positions);
    return scenery;
}

static bool open_outputs(const char *folder, const cloth_simulation *c, outputs *out, io_error *error) {
    const cloth_scene *s = c->scene;
    body scenery = make_scenery(c);
    bool good = write_model(folder, s->name, ".obj", &c->garment, error) &&
                write_model(folder, s->name, "-scenery.obj", &scenery, error) &&
                open_frames(folder, s, ".pc2", c->garment.vertex_count, &out->frames, error);
    if (good && obstacles_move(s))
        good = open_frames(folder, s, "-scenery.pc2", scenery.vertex_count, &out->scenery_frames, error);
    body_free(&scenery);
    return good;
}

static bool write_frame(const cloth_simulation *c, const outputs *out, io_error *error) {
    return point_cache_writer_write(out->frames, c->positions, error) &&
           (out->scenery_frames == NULL ||
            point_cache_writer_write(out->scenery_frames, c->positions + c->garment.vertex_count * 3, error));
}

/* True if all that was opened is complete. */
static bool close_outputs(outputs *out, io_error *error) {
    bool good = out->frames == NULL || point_cache_writer_close(out->frames, error);
    if (out->scenery_frames != NULL) good = point_cache_writer_close(out->scenery_frames, error) && good;
    return good;
}

/* How often the library asks for memory. */
static void *count_and_allocate(void *user, size_t size, size_t alignment) {
    ++*(uint64_t *)user;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release(void *user, void *block, size_t size) {
    (void)user;
    (void)size;
    free(block);
}

static void print_summary(const cloth_simulation *c, uint64_t late_allocations) {
    const cloth_scene *s = c->scene;
    const cloth_statistics *t = &c->statistics;
    double frames = t->frames;
    printf("%s: %s\n", s->name, s->text);
    printf("  %u frames of %u triangles, %g s each; thickness %.2g, certified %.2g\n", t->frames + 1,
           c->garment.triangle_count, s->frame_seconds, cloth_thickness(c), cloth_separation(c));
    printf(
        "  near: %.0f pairs a frame; %llu of %u motions were cut, for %llu contacts, in up to %llu rounds\n",
        (double)t->near_pairs / frames, (unsigned long long)t->motion.cut, t->frames,
        (unsigned long long)t->motion.contacts, (unsigned long long)t->most_rounds);
    printf("  %llu motions began pressed together; %llu were shortened as a whole, obstacles waited %.2f "
           "frames\n",
           (unsigned long long)t->motion.tight, (unsigned long long)t->motion.fallbacks, t->waited);
    printf(
        "  %.2f ms a frame: solver %.2f, near %.2f, %.1f detector steps %.2f; %llu allocations in the last "
        "half\n",
        t->total_ms / frames, (t->total_ms - t->near_ms - t->step_ms) / frames, t->near_ms / frames,
        (double)t->motion.steps / frames, t->step_ms / frames, (unsigned long long)late_allocations);
}

/* On a terminal only, on one line. */
static void show_progress(const cloth_scene *s, uint32_t frame) {
    if (!isatty(STDERR_FILENO)) return;
    if (frame < s->frame_count)
        fprintf(stderr, "\r%s: frame %u of %u ", s->name, frame + 1, s->frame_count);
    else
        fprintf(stderr, "\r\033[K");
    fflush(stderr);
}

static bool record_frames(cloth_simulation *c, const char *folder, const uint64_t *allocations,
                          io_error *error) {
    outputs out = {NULL, NULL};
    uint64_t early = 0;
    const cloth_scene *s = c->scene;
    bool good = open_outputs(folder, c, &out, error);
    for (uint32_t frame = 0; good && frame < s->frame_count; frame++) {
        show_progress(s, frame);
        if (frame == s->frame_count / 2) early = *allocations;
        good = (frame == 0 || cloth_advance(c, error)) && write_frame(c, &out, error);
    }
    show_progress(s, s->frame_count);
    io_error closing;
    bool complete = close_outputs(&out, &closing);
    if (good && !complete) *error = closing;
    if (good && complete) print_summary(c, *allocations - early);
    return good && complete;
}

/* Resolution 0: the scene's own. */
static bool record(const cloth_scene *s, uint32_t resolution, const char *folder, io_error *error) {
    uint64_t allocations = 0;
    cscd_context *context;
    cscd_context_options options = cscd_context_defaults();
    options.allocator = (cscd_allocator){count_and_allocate, release, &allocations};
    cscd_status status = cscd_context_create(&options, &context);
    if (status != CSCD_OK) return io_fail(error, "%s: %s", s->name, cscd_status_string(status));
    cloth_simulation c;
    bool good = cloth_open(s, resolution, context, &c, error);
    if (good) {
        good = record_frames(&c, folder, &allocations, error);
        cloth_close(&c);
    }
    cscd_context_destroy(context);
    return good;
}

static int print_help(FILE *stream) {
    fprintf(stream,
            "usage: cloth [--resolution N] SCENE... FOLDER\n"
            "\n"
            "Simulates cloth and writes, for each scene, FOLDER/SCENE.obj and SCENE.pc2, and what the cloth\n"
            "falls onto as SCENE-scenery.obj and, if it moves, SCENE-scenery.pc2. The folder must exist.\n"
            "N, %u to %u, is the number of vertices along a side or around a tube; the default is 60, of a "
            "bag 45.\n"
            "`all` stands for all scenes:\n"
            "\n",
            CLOTH_RESOLUTION_MIN, CLOTH_RESOLUTION_MAX);
    for (uint32_t i = 0; i < cloth_scene_count; i++)
        fprintf(stream, "  %-22s %s\n", cloth_scenes[i].name, cloth_scenes[i].text);
    return stream == stdout ? 0 : 2;
}

static bool parse_resolution(const char *text, uint32_t *out) {
    char *end;
    errno = 0;
    unsigned long value = strtoul(text, &end, 10);
    if (errno != 0 || *end != '\0' || value < CLOTH_RESOLUTION_MIN || value > CLOTH_RESOLUTION_MAX) {
        fprintf(stderr, "cloth: --resolution '%s': a number from %u to %u is wanted\n", text,
                CLOTH_RESOLUTION_MIN, CLOTH_RESOLUTION_MAX);
        return false;
    }
    *out = (uint32_t)value;
    return true;
}

static int record_all(int name_count, char **names, uint32_t resolution, const char *folder) {
    for (int i = 0; i < name_count; i++) {
        if (strcmp(names[i], "all") == 0 || cloth_scene_find(names[i]) != NULL) continue;
        fprintf(stderr, "cloth: no scene is called '%s'; cloth --help lists them\n", names[i]);
        return 2;
    }
    for (uint32_t i = 0; i < cloth_scene_count; i++) {
        bool wanted = false;
        for (int j = 0; j < name_count; j++)
            wanted = wanted || strcmp(names[j], "all") == 0 || strcmp(names[j], cloth_scenes[i].name) == 0;
        io_error error;
        if (!wanted || record(&cloth_scenes[i], resolution, folder, &error)) continue;
        fprintf(stderr, "cloth: %s\n", error.text);
        return 1;
    }
    return 0;
}

static int run(int argument_count, char **arguments) {
    uint32_t resolution = 0;
    int first = 1;
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) return print_help(stdout);
    if (argument_count > 2 && strcmp(arguments[1], "--resolution") == 0) {
        if (!parse_resolution(arguments[2], &resolution)) return 2;
        first = 3;
    }
    if (argument_count < first + 2) return print_help(stderr);
    return record_all(argument_count - 1 - first, arguments + first, resolution,
                      arguments[argument_count - 1]);
}

int main(int argument_count, char **arguments) {
    int code = run(argument_count, arguments);
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    fprintf(stderr, "cloth: standard output: %s\n", strerror(errno));
    return 1;
}
