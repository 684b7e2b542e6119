/* Records soft bodies that fall, bend and run into themselves: a model, its frames, and what they fall onto.
 */
#include "models/softbody/motion.h"
#include "models/softbody/recorder.h"
#include "models/softbody/scenery.h"
#include "src/io/mesh_file.h"
#include "src/io/point_cache_write.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PATH_MAX_LENGTH = 4096 };

/* The files of a recording, written side by side. */
typedef struct outputs {
    point_cache_writer *frames, *scenery_frames;
    body scenery;
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

static bool open_frames(const char *folder, const recorder *r, const char *ending, uint32_t vertex_count,
                        point_cache_writer **out, io_error *error) {
    char path[PATH_MAX_LENGTH];
    return name_file(folder, r->scene->name, ending, path, error) &&
           point_cache_writer_open(path, vertex_count, r->scene->frame_count, out, error);
}

/* Scenery frames only where balls move. */
static bool open_outputs(const char *folder, const recorder *r, outputs *out, io_error *error) {
    if (!scenery_make(&r->around, &out->scenery, error)) return false;
    return write_model(folder, r->scene->name, ".obj", &r->shape, error) &&
           write_model(folder, r->scene->name, "-scenery.obj", &out->scenery, error) &&
           open_frames(folder, r, ".pc2", r->shape.vertex_count, &out->frames, error) &&
           (r->around.ball_count == 0 ||
            open_frames(folder, r, "-scenery.pc2", out->scenery.vertex_count, &out->scenery_frames, error));
}

static bool write_frame(const recorder *r, outputs *out, io_error *error) {
    if (!point_cache_writer_write(out->frames, r->frame, error)) return false;
    if (out->scenery_frames == NULL) return true;
    return scenery_follow(&r->around, &out->scenery, error) &&
           point_cache_writer_write(out->scenery_frames, out->scenery.positions, error);
}

/* True if all that was opened is complete. */
static bool close_outputs(outputs *out, io_error *error) {
    bool good = out->frames == NULL || point_cache_writer_close(out->frames, error);
    if (out->scenery_frames != NULL) good = point_cache_writer_close(out->scenery_frames, error) && good;
    body_free(&out->scenery);
    return good;
}

static bool measure(const recorder *r, motion *m, io_error *error) {
    cscd_status status = m->mesh == NULL ? motion_begin(r->mesh, r->frame, m) : motion_add(m, r->frame);
    return status == CSCD_OK || io_fail(error, "%s: %s", r->scene->name, cscd_context_detail(r->context));
}

static void print_summary(const recorder *r, const motion *m, double start_energy, double most_energy) {
    printf("%s: %s\n", r->scene->name, r->scene->text);
    printf("  %u frames of %u triangles, %g s each; lattice of %u cells\n", m->frame_count,
           r->shape.triangle_count, r->scene->frame_seconds, r->soft.frame.cell_count);
    printf("  contacts in %u of %u intervals, crossing in %u of %u frames\n", m->contact_intervals,
           m->frame_count - 1, m->crossing_frames, m->frame_count);
    printf("  softness: %u frames more than 3 %% of the diagonal from rigid, at most %.1f %%\n",
           m->soft_frames, 100.0 * m->largest_residual);
    printf("  motion: at most %.1f edge lengths from frame to frame; energy at most %.3f of the start's\n",
           m->largest_motion, most_energy / start_energy);
}

/* On a terminal only, on one line. */
static void show_progress(const scene *s, uint32_t frame) {
    if (!isatty(STDERR_FILENO)) return;
    if (frame < s->frame_count)
        fprintf(stderr, "\r%s: frame %u of %u ", s->name, frame + 1, s->frame_count);
    else
        fprintf(stderr, "\r\033[K");
    fflush(stderr);
}

static bool record(const scene *s, const char *folder, io_error *error) {
    recorder r;
    outputs out = {NULL, NULL, {0}};
    motion m = {.mesh = NULL};
    if (!recorder_open(s, NULL, &r, error)) return false;
    double start_energy = recorder_energy(&r), most_energy = start_energy;
    bool good = open_outputs(folder, &r, &out, error);
    for (uint32_t frame = 0; good && frame < s->frame_count; frame++) {
        show_progress(s, frame);
        good = (frame == 0 || recorder_advance(&r, error)) && measure(&r, &m, error) &&
               write_frame(&r, &out, error);
        most_energy = fmax(most_energy, recorder_energy(&r));
    }
    show_progress(s, s->frame_count);
    io_error closing;
    bool complete = close_outputs(&out, &closing);
    if (good && !complete) *error = closing;
    if (good && complete) print_summary(&r, &m, start_energy, most_energy);
    if (m.mesh != NULL) motion_free(&m);
    recorder_close(&r);
    return good && complete;
}

static int print_help(FILE *stream) {
    fprintf(stream,
            "usage: record SCENE... FOLDER\n"
            "\n"
            "Simulates soft bodies and writes, for each scene, FOLDER/SCENE.obj and SCENE.pc2, and what the "
            "body\n"
            "falls onto as SCENE-scenery.obj and, if it moves, SCENE-scenery.pc2. The folder must exist.\n"
            "`all` stands for all scenes:\n"
            "\n");
    for (uint32_t i = 0; i < scene_count; i++)
        fprintf(stream, "  %-22s %s\n", scenes[i].name, scenes[i].text);
    return stream == stdout ? 0 : 2;
}

static int run(int argument_count, char **arguments) {
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) return print_help(stdout);
    if (argument_count < 3) return print_help(stderr);
    const char *folder = arguments[argument_count - 1];
    for (int i = 1; i + 1 < argument_count; i++) {
        if (strcmp(arguments[i], "all") == 0 || scene_find(arguments[i]) != NULL) continue;
        fprintf(stderr, "record: no scene is called '%s'; record --help lists them\n", arguments[i]);
        return 2;
    }
    for (uint32_t i = 0; i < scene_count; i++) {
        bool wanted = false;
        for (int j = 1; j + 1 < argument_count; j++)
            wanted = wanted || strcmp(arguments[j], "all") == 0 || strcmp(arguments[j], scenes[i].name) == 0;
        io_error error;
        if (!wanted || record(&scenes[i], folder, &error)) continue;
        fprintf(stderr, "record: %s\n", error.text);
        return 1;
    }
    return 0;
}

int main(int argument_count, char **arguments) {
    int code = run(argument_count, arguments);
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    fprintf(stderr, "record: standard output: %s\n", strerror(errno));
    return 1;
}
