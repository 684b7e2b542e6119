/* Recordings that benchmarks replay: all frames in memory, and a new plan by charge. */
#include "benchmarks/lib/scene_files.h"

#include "models/softbody/softbody.h"
#include "src/core/timer.h"
#include "tool/io/animation.h"
#include "tool/io/point_cache.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_LENGTH = 4096 };

const double *recording_data_frame(const recording_data *r, uint32_t frame) {
    return r->frames + (size_t)frame * r->model.vertex_count * 3;
}

static bool record_frames(recorder *r, const char *path, io_error *error) {
    point_cache_writer *writer;
    uint32_t count = r->scene->frame_count;
    if (!point_cache_writer_open(path, r->shape.vertex_count, count, &writer, error)) return false;
    bool good = true;
    for (uint32_t frame = 0; good && frame < count; frame++)
        good =
            (frame == 0 || recorder_advance(r, error)) && point_cache_writer_write(writer, r->frame, error);
    io_error closing;
    bool complete = point_cache_writer_close(writer, &closing);
    if (good && !complete) *error = closing;
    return good && complete;
}

/* Makes a recording unless both files are there. */
static bool make_recording(const char *model, const char *frames, const char *name, io_error *error) {
    const soft_scene *s = soft_scene_find(name);
    recorder r;
    if ((access(model, F_OK) == 0 && access(frames, F_OK) == 0) || s == NULL) return true;
    if (!recorder_open(s, NULL, &r, error)) return false;
    const mesh_file mesh =
        mesh_file_of(r.shape.vertex_count, r.shape.triangle_count, r.shape.positions, r.shape.triangles);
    bool made = mesh_file_write_obj(model, &mesh, error) && record_frames(&r, frames, error);
    recorder_close(&r);
    return made;
}

static bool read_frames(recording_data *r, const char *path, io_error *error) {
    animation *frames;
    size_t size = (size_t)r->model.vertex_count * 3;
    if (!animation_open(&path, 1, r->model.vertex_count, NULL, &frames, error)) return false;
    r->frame_count = animation_frame_count(frames);
    bool read = r->frame_count > 1 ||
                io_fail(error, "%s: %u frames, at least two were expected", path, r->frame_count);
    if (read) {
        r->frames = malloc(r->frame_count * size * sizeof *r->frames);
        read = r->frames != NULL || io_fail(error, "%s: out of memory for %u frames", path, r->frame_count);
    }
    for (uint32_t i = 0; read && i < r->frame_count; i++)
        read = animation_read(frames, i, r->frames + i * size, error);
    animation_close(frames);
    return read;
}

static bool make_mesh(recording_data *r, const char *model, uint32_t thread_count, io_error *error) {
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = thread_count;
    const cscd_object_desc desc =
        cscd_object_of_triangles(r->model.vertex_count, r->model.triangle_count, r->model.triangles);
    return (cscd_context_create(&options, &r->context) == CSCD_OK &&
            cscd_mesh_create(r->context, &desc, 1, &r->mesh) == CSCD_OK) ||
           io_fail(error, "%s: the mesh could not be made", model);
}

static bool any_closed(const cscd_mesh *mesh) {
    for (uint32_t i = 0; i < cscd_mesh_component_count(mesh); i++) {
        if (cscd_mesh_component(mesh, i).closed_manifold) return true;
    }
    return false;
}

static bool make_plan(recording_data *r, io_error *error) {
    if (!any_closed(r->mesh)) return true;
    const cscd_view *rest = CSCD_DOUBLES(r->model.positions, cscd_mesh_vertex_count(r->mesh));
    return cscd_plan_create(r->context, r->mesh, rest, NULL, &r->charge) == CSCD_OK ||
           io_fail(error, "%s: %s", r->name, cscd_context_detail(r->context));
}

bool recording_data_open(const char *folder, const char *name, uint32_t thread_count, recording_data *out,
                         io_error *error) {
    recording_data r = {.frame_count = 0};
    char model[PATH_LENGTH], frames[PATH_LENGTH];
    double since = timer_now_ms(), ignored = 0.0;
    snprintf(r.name, sizeof r.name, "%s", name);
    snprintf(model, sizeof model, "%s/%s.obj", folder, name);
    snprintf(frames, sizeof frames, "%s/%s.pc2", folder, name);
    bool good = make_recording(model, frames, name, error);
    timer_lap(&since, &r.made_ms);
    good = good && mesh_file_read(model, &r.model, error) && read_frames(&r, frames, error);
    good = good && make_mesh(&r, model, thread_count, error);
    timer_lap(&since, &ignored);
    good = good && make_plan(&r, error);
    timer_lap(&since, &r.made_ms);
    if (good)
        *out = r;
    else
        recording_data_close(&r);
    return good;
}

/* Puts the positions of both files one behind the other. */
static bool join_frames(recording_data *r, const char *end, io_error *error) {
    mesh_file last = {0};
    size_t size = (size_t)r->model.vertex_count * 3;
    bool good = mesh_file_read(end, &last, error);
    if (good && last.vertex_count != r->model.vertex_count)
        good = io_fail(error, "%s: %u vertices, %u were expected", end, last.vertex_count,
                       r->model.vertex_count);
    if (good) r->frames = malloc(2 * size * sizeof *r->frames);
    if (good && r->frames == NULL) good = io_fail(error, "%s: out of memory", end);
    if (good) {
        memcpy(r->frames, r->model.positions, size * sizeof *r->frames);
        memcpy(r->frames + size, last.positions, size * sizeof *r->frames);
        r->frame_count = 2;
    }
    mesh_file_free(&last);
    return good;
}

bool recording_data_open_frames(const char *name, const char *start, const char *end, uint32_t thread_count,
                                recording_data *out, io_error *error) {
    recording_data r = {.frame_count = 0};
    snprintf(r.name, sizeof r.name, "%s", name);
    bool good = mesh_file_read(start, &r.model, error) && join_frames(&r, end, error) &&
                make_mesh(&r, start, thread_count, error);
    if (good)
        *out = r;
    else
        recording_data_close(&r);
    return good;
}

void recording_data_close(recording_data *r) {
    cscd_plan_destroy(r->charge);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    mesh_file_free(&r->model);
    free(r->frames);
    *r = (recording_data){.frame_count = 0};
}
