/* Records bodies that touch and never pass through each other, by incremental potential
 * contact: a model and its frames. */
#include "models/ipc/ipc.h"
#include "models/common/motion.h"
#include "models/common/scene_program.h"

#include <stdio.h>
#include <string.h>

static bool open_outputs(const char *folder, const ipc_solver *p, point_cache_writer **frames,
                         io_error *error) {
    const ipc_scene *s = p->scene;
    return recording_write_model(folder, s->name, ".obj", &p->shape, error) &&
           recording_open_frames(folder, s->name, ".pc2", p->shape.vertex_count, s->frame_count, frames,
                                 error);
}

static double mean_of(uint64_t sum, uint32_t count) {
    return (double)sum / count;
}

static void print_summary(const ipc_solver *p, const recording_motion *m) {
    const ipc_statistics *s = &p->statistics;
    const ipc_scene *scene = p->scene;
    printf("%s: %s\n", scene->name, scene->text);
    printf("  %u frames of %u triangles, %g s each; %u springs\n", m->frame_count, p->shape.triangle_count,
           scene->step_seconds * scene->steps, p->springs.count);
    printf(
        "  a time step: %.1f Newton iterations (%u steps stopped at the bound), %.2f of them with obstacles\n",
        mean_of(s->newton, s->steps), s->unfinished, mean_of(s->driven, s->steps));
    printf(
        "  a Newton iteration: %.0f conjugate gradients, %.0f candidates, %.2f trials of %.0f near pairs\n",
        mean_of(s->conjugate_gradients, s->newton), mean_of(s->candidates, s->newton),
        mean_of(s->trials, s->newton), mean_of(s->near, s->trials));
    printf("  lines limited by contact: %u of %u; least distance %.2g, reach %g, never below %g\n", s->cut,
           s->newton, s->least_distance, scene->barrier.reach, scene->min_separation);
    printf("  from frame to frame: contacts in %u of %u intervals, intersections in %u of %u frames\n",
           m->contact_intervals, m->frame_count - 1, m->intersecting_frames, m->frame_count);
    printf(
        "  motion: at most %.1f edge lengths a frame; softness: at most %.1f %% of the diagonal from rigid\n",
        m->largest_motion, 100.0 * m->largest_residual);
    printf("  %.1f s; in cscd %.2f s (%.0f %%): lines %.2f, certified steps %.2f, proximity %.2f\n",
           1e-3 * s->total_ms, 1e-3 * s->detect_ms, 100.0 * s->detect_ms / s->total_ms, 1e-3 * s->begin_ms,
           1e-3 * s->certify_ms, 1e-3 * s->near_ms);
}

static cscd_status advance_frame(ipc_solver *p) {
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; i < p->scene->steps && status == CSCD_OK; i++) status = ipc_solver_advance(p);
    return status;
}

/* Writes all frames; the first is the start of the solver. Motion is measured in single precision, as the
 * file has it. */
static bool record_frames(ipc_solver *p, cscd_context *context, point_cache_writer *frames,
                          recording_motion *m, io_error *error) {
    size_t bytes = (size_t)p->shape.vertex_count * 3 * sizeof(double);
    body rounded = {.vertex_count = p->shape.vertex_count, .positions = body_allocate(bytes, 1)};
    bool good = true;
    for (uint32_t frame = 0; good && frame < p->scene->frame_count; frame++) {
        scene_program_show(p->scene->name, frame, p->scene->frame_count);
        cscd_status status = frame > 0 ? advance_frame(p) : CSCD_OK;
        memcpy(rounded.positions, p->positions, bytes);
        body_round(&rounded);
        if (status == CSCD_OK)
            status = frame > 0 ? recording_motion_add(m, rounded.positions)
                               : recording_motion_begin(p->mesh, rounded.positions, m);
        good = (status == CSCD_OK || io_fail(error, "%s: frame %u: %s: %s", p->scene->name, frame,
                                             cscd_status_string(status), cscd_context_detail(context))) &&
               point_cache_writer_write(frames, rounded.positions, error);
    }
    scene_program_show(p->scene->name, p->scene->frame_count, p->scene->frame_count);
    body_free(&rounded);
    return good;
}

static bool record_solver(ipc_solver *p, cscd_context *context, const char *folder, io_error *error) {
    recording_motion m = {.mesh = NULL};
    point_cache_writer *frames = NULL;
    bool good = open_outputs(folder, p, &frames, error) && record_frames(p, context, frames, &m, error);
    io_error closing;
    bool complete = frames == NULL || point_cache_writer_close(frames, &closing);
    if (good && !complete) *error = closing;
    if (good && complete) print_summary(p, &m);
    if (m.mesh != NULL) recording_motion_free(&m);
    return good && complete;
}

static bool record_scene(void *user, uint32_t index, const char *folder, io_error *error) {
    const ipc_scene *s = &ipc_scenes[index];
    cscd_context *context = NULL;
    ipc_solver p;
    (void)user;
    cscd_status status = cscd_context_create(NULL, &context);
    if (status != CSCD_OK) return io_fail(error, "%s: %s", s->name, cscd_status_string(status));
    status = ipc_solver_make(s, 0, context, &p);
    bool good = status == CSCD_OK ? record_solver(&p, context, folder, error)
                                  : io_fail(error, "%s: %s", s->name, cscd_context_detail(context));
    if (status == CSCD_OK) ipc_solver_free(&p);
    cscd_context_destroy(context);
    return good;
}

static const char *scene_name(uint32_t index) {
    return ipc_scenes[index].name;
}

static const char *scene_text(uint32_t index) {
    return ipc_scenes[index].text;
}

int main(int argument_count, char **arguments) {
    const scene_program program = {
        .name = "ipc",
        .help = "usage: ipc SCENE... FOLDER\n"
                "\n"
                "Simulates bodies that touch and never pass through each other, and writes, for each scene,\n"
                "FOLDER/SCENE.obj and SCENE.pc2. The folder must exist. `all` stands for all scenes:\n"
                "\n",
        .scene_count = ipc_scene_count,
        .scene_name = scene_name,
        .scene_text = scene_text,
        .record = record_scene};
    return scene_program_run(&program, argument_count, arguments);
}
