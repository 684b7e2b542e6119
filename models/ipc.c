/* Records bodies that meet and never pass through each other, by incremental potential contact: a model and
 * its frames. */
#include "models/potential/solver.h"
#include "models/softbody/motion.h"
#include "src/io/mesh_file.h"
#include "src/io/point_cache_write.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_MAX_LENGTH = 4096 };

/* FOLDER/NAMEending; the current folder where the folder has no name. */
static bool name_file(const char *folder, const char *name, const char *ending, char path[PATH_MAX_LENGTH],
                      io_error *error) {
    int length = snprintf(path, PATH_MAX_LENGTH, "%s/%s%s", folder[0] != '\0' ? folder : ".", name, ending);
    return (length > 0 && length < PATH_MAX_LENGTH) ||
           io_fail(error, "%s%s: the folder's name is too long", name, ending);
}

static bool open_outputs(const char *folder, const ipc_solver *p, point_cache_writer **frames,
                         io_error *error) {
    char path[PATH_MAX_LENGTH];
    const body *b = &p->shape;
    const mesh_file mesh = {b->vertex_count, b->triangle_count, b->positions, b->triangles};
    return name_file(folder, p->scene->name, ".obj", path, error) &&
           mesh_file_write_obj(path, &mesh, error) &&
           name_file(folder, p->scene->name, ".pc2", path, error) &&
           point_cache_writer_open(path, b->vertex_count, p->scene->frame_count, frames, error);
}

/* On a terminal only, on one line. */
static void show_progress(const ipc_scene *s, uint32_t frame) {
    if (!isatty(STDERR_FILENO)) return;
    if (frame < s->frame_count)
        fprintf(stderr, "\r%s: frame %u of %u ", s->name, frame + 1, s->frame_count);
    else
        fprintf(stderr, "\r\033[K");
    fflush(stderr);
}

static double each(uint64_t sum, uint32_t count) {
    return (double)sum / count;
}

static void print_summary(const ipc_solver *p, const motion *m) {
    const ipc_statistics *s = &p->statistics;
    const ipc_scene *scene = p->scene;
    printf("%s: %s\n", scene->name, scene->text);
    printf("  %u frames of %u triangles, %g s each; %u springs\n", m->frame_count, p->shape.triangle_count,
           scene->step_seconds * scene->steps, p->springs.count);
    printf("  a time step: %.1f Newton iterations (%u steps stopped at the bound), %.2f of them with "
           "obstacles\n",
           each(s->newton, s->steps), s->unfinished, each(s->driven, s->steps));
    printf(
        "  a Newton iteration: %.0f conjugate gradients, %.0f candidates, %.2f trials of %.0f near pairs\n",
        each(s->conjugate_gradients, s->newton), each(s->candidates, s->newton), each(s->trials, s->newton),
        each(s->near, s->trials));
    printf("  lines limited by contact: %u of %u; least distance %.2g, reach %g, never below %g\n", s->cut,
           s->newton, s->least_distance, scene->barrier.reach, scene->min_separation);
    printf("  from frame to frame: contacts in %u of %u intervals, crossing in %u of %u frames\n",
           m->contact_intervals, m->frame_count - 1, m->crossing_frames, m->frame_count);
    printf(
        "  motion: at most %.1f edge lengths a frame; softness: at most %.1f %% of the diagonal from rigid\n",
        m->largest_motion, 100.0 * m->largest_residual);
    printf("  %.1f s; in cscd %.2f s (%.0f %%): lines %.2f, certified steps %.2f, nearness %.2f\n",
           1e-3 * s->total_ms, 1e-3 * s->detect_ms, 100.0 * s->detect_ms / s->total_ms, 1e-3 * s->begin_ms,
           1e-3 * s->certify_ms, 1e-3 * s->near_ms);
}

static cscd_status advance(ipc_solver *p) {
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; i < p->scene->steps && status == CSCD_OK; i++) status = ipc_solver_advance(p);
    return status;
}

/* The frames, the first as the solver begins; a frame is measured as the files have it, in single precision.
 */
static bool record_frames(ipc_solver *p, cscd_context *context, point_cache_writer *frames, motion *m,
                          io_error *error) {
    size_t bytes = (size_t)p->shape.vertex_count * 3 * sizeof(double);
    body rounded = {.vertex_count = p->shape.vertex_count, .positions = body_allocate(bytes, 1)};
    bool good = true;
    for (uint32_t frame = 0; good && frame < p->scene->frame_count; frame++) {
        show_progress(p->scene, frame);
        cscd_status status = frame > 0 ? advance(p) : CSCD_OK;
        memcpy(rounded.positions, p->positions, bytes);
        body_round(&rounded);
        if (status == CSCD_OK)
            status =
                frame > 0 ? motion_add(m, rounded.positions) : motion_begin(p->mesh, rounded.positions, m);
        good = (status == CSCD_OK || io_fail(error, "%s: frame %u: %s: %s", p->scene->name, frame,
                                             cscd_status_string(status), cscd_context_detail(context))) &&
               point_cache_writer_write(frames, rounded.positions, error);
    }
    show_progress(p->scene, p->scene->frame_count);
    body_free(&rounded);
    return good;
}

static bool record(const ipc_scene *s, const char *folder, cscd_context *context, io_error *error) {
    ipc_solver p;
    motion m = {.mesh = NULL};
    point_cache_writer *frames = NULL;
    cscd_status status = ipc_solver_make(s, 0, context, &p);
    if (status != CSCD_OK) return io_fail(error, "%s: %s", s->name, cscd_context_detail(context));
    bool good = open_outputs(folder, &p, &frames, error) && record_frames(&p, context, frames, &m, error);
    io_error closing;
    bool complete = frames == NULL || point_cache_writer_close(frames, &closing);
    if (good && !complete) *error = closing;
    if (good && complete) print_summary(&p, &m);
    if (m.mesh != NULL) motion_free(&m);
    ipc_solver_free(&p);
    return good && complete;
}

static int print_help(FILE *stream) {
    fprintf(stream,
            "usage: ipc SCENE... FOLDER\n"
            "\n"
            "Simulates bodies that meet and never pass through each other, and writes, for each scene,\n"
            "FOLDER/SCENE.obj and SCENE.pc2. The folder must exist. `all` stands for all scenes:\n"
            "\n");
    for (uint32_t i = 0; i < ipc_scene_count; i++)
        fprintf(stream, "  %-10s %s\n", ipc_scenes[i].name, ipc_scenes[i].text);
    return stream == stdout ? 0 : 2;
}

static bool record_all(int argument_count, char **arguments, cscd_context *context, io_error *error) {
    for (uint32_t i = 0; i < ipc_scene_count; i++) {
        bool wanted = false;
        for (int j = 1; j + 1 < argument_count; j++)
            wanted =
                wanted || strcmp(arguments[j], "all") == 0 || strcmp(arguments[j], ipc_scenes[i].name) == 0;
        if (wanted && !record(&ipc_scenes[i], arguments[argument_count - 1], context, error)) return false;
    }
    return true;
}

static int run(int argument_count, char **arguments) {
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) return print_help(stdout);
    if (argument_count < 3) return print_help(stderr);
    for (int i = 1; i + 1 < argument_count; i++) {
        if (strcmp(arguments[i], "all") == 0 || ipc_scene_find(arguments[i]) != NULL) continue;
        fprintf(stderr, "ipc: no scene is called '%s'; ipc --help lists them\n", arguments[i]);
        return 2;
    }
    io_error error;
    cscd_context *context = NULL;
    cscd_status status = cscd_context_create(NULL, &context);
    bool good = status == CSCD_OK ? record_all(argument_count, arguments, context, &error)
                                  : io_fail(&error, "%s", cscd_status_string(status));
    cscd_context_destroy(context);
    if (!good) fprintf(stderr, "ipc: %s\n", error.text);
    return good ? 0 : 1;
}

int main(int argument_count, char **arguments) {
    int code = run(argument_count, arguments);
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    fprintf(stderr, "ipc: standard output: %s\n", strerror(errno));
    return 1;
}
