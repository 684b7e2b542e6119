/* Records soft bodies that fall, bend and run into themselves: a model, its frames, and what they fall
 * onto. */
#include "models/common/motion.h"
#include "models/common/scene_program.h"
#include "models/softbody/softbody.h"

#include <math.h>
#include <stdio.h>

/* The files of a recording, written side by side. */
typedef struct record_files {
    point_cache_writer *frames, *scenery_frames;
    body scenery;
} record_files;

/* Opens the files; the scenery has frames only when balls move. */
static bool open_outputs(const char *folder, const recorder *r, record_files *out, io_error *error) {
    if (!scenery_make(&r->around, &out->scenery, error)) return false;
    const soft_scene *s = r->scene;
    return recording_write_model(folder, s->name, ".obj", &r->shape, error) &&
           recording_write_model(folder, s->name, "-scenery.obj", &out->scenery, error) &&
           recording_open_frames(folder, s->name, ".pc2", r->shape.vertex_count, s->frame_count, &out->frames,
                                 error) &&
           (r->around.ball_count == 0 ||
            recording_open_frames(folder, s->name, "-scenery.pc2", out->scenery.vertex_count, s->frame_count,
                                  &out->scenery_frames, error));
}

static bool write_frame(const recorder *r, record_files *out, io_error *error) {
    if (!point_cache_writer_write(out->frames, r->frame, error)) return false;
    if (out->scenery_frames == NULL) return true;
    return scenery_follow(&r->around, &out->scenery, error) &&
           point_cache_writer_write(out->scenery_frames, out->scenery.positions, error);
}

/* Closes the files; false when one of them is not complete. */
static bool close_outputs(record_files *out, io_error *error) {
    bool good = out->frames == NULL || point_cache_writer_close(out->frames, error);
    if (out->scenery_frames != NULL) good = point_cache_writer_close(out->scenery_frames, error) && good;
    body_free(&out->scenery);
    return good;
}

static bool measure_frame(const recorder *r, recording_motion *m, io_error *error) {
    cscd_status status =
        m->mesh == NULL ? recording_motion_begin(r->mesh, r->frame, m) : recording_motion_add(m, r->frame);
    return status == CSCD_OK || io_fail(error, "%s: %s", r->scene->name, cscd_context_detail(r->context));
}

static void print_summary(const recorder *r, const recording_motion *m, double start_energy,
                          double most_energy) {
    printf("%s: %s\n", r->scene->name, r->scene->text);
    printf("  %u frames of %u triangles, %g s each; lattice of %u cells\n", m->frame_count,
           r->shape.triangle_count, r->scene->frame_seconds, r->soft.frame.cell_count);
    printf("  contacts in %u of %u intervals, intersections in %u of %u frames\n", m->contact_intervals,
           m->frame_count - 1, m->intersecting_frames, m->frame_count);
    printf("  softness: %u frames more than 3 %% of the diagonal from rigid, at most %.1f %%\n",
           m->soft_frames, 100.0 * m->largest_residual);
    printf("  motion: at most %.1f edge lengths from frame to frame; energy at most %.3f of the start's\n",
           m->largest_motion, most_energy / start_energy);
}

static bool record_scene(void *user, uint32_t index, const char *folder, io_error *error) {
    const soft_scene *s = &soft_scenes[index];
    (void)user;
    recorder r;
    record_files out = {NULL, NULL, {0}};
    recording_motion m = {.mesh = NULL};
    if (!recorder_open(s, NULL, &r, error)) return false;
    double start_energy = recorder_energy(&r), most_energy = start_energy;
    bool good = open_outputs(folder, &r, &out, error);
    for (uint32_t frame = 0; good && frame < s->frame_count; frame++) {
        scene_program_show(s->name, frame, s->frame_count);
        good = (frame == 0 || recorder_advance(&r, error)) && measure_frame(&r, &m, error) &&
               write_frame(&r, &out, error);
        most_energy = fmax(most_energy, recorder_energy(&r));
    }
    scene_program_show(s->name, s->frame_count, s->frame_count);
    io_error closing;
    bool complete = close_outputs(&out, &closing);
    if (good && !complete) *error = closing;
    if (good && complete) print_summary(&r, &m, start_energy, most_energy);
    if (m.mesh != NULL) recording_motion_free(&m);
    recorder_close(&r);
    return good && complete;
}

static const char *scene_name(uint32_t index) {
    return soft_scenes[index].name;
}

static const char *scene_text(uint32_t index) {
    return soft_scenes[index].text;
}

int main(int argument_count, char **arguments) {
    const scene_program program = {
        .name = "record",
        .help =
            "usage: record SCENE... FOLDER\n"
            "\n"
            "Simulates soft bodies and writes, for each scene, FOLDER/SCENE.obj and SCENE.pc2, and what the body\n"
            "falls onto as SCENE-scenery.obj and, if it moves, SCENE-scenery.pc2. The folder must exist.\n"
            "`all` stands for all scenes:\n"
            "\n",
        .scene_count = soft_scene_count,
        .scene_name = scene_name,
        .scene_text = scene_text,
        .record = record_scene};
    return scene_program_run(&program, argument_count, arguments);
}
