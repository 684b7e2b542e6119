/* The frames of a glTF file: its scene, moved by one of its animations. */
#include "tool/io/gltf.h"
#include "tool/io/gltf/gltf_animation.h"
#include "tool/io/growable.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct gltf_frames {
    file_reader reader;
    gltf_scene scene;
    gltf_animation animation;
    gltf_pose pose;
    double fps;
    uint32_t count;
    char note[400]; /* "": nothing to say */
    char path[];    /* the reader's */
};

/* A frame for each step of 1 / fps from the start on; the end counts when the last step meets it but for rounding. */
static bool count_frames(gltf_frames *frames) {
    const double start = frames->animation.start, end = frames->animation.end;
    double steps = floor((end - start) * frames->fps);
    if (gltf_same_time(start + (steps + 1) / frames->fps, end)) steps++;
    if (!(steps < INT32_MAX))
        return file_reader_fail(&frames->reader, "%g frames in %g seconds, expected %" PRIu32 " at most",
                                steps + 1, end - start, UINT32_MAX);
    frames->count = (uint32_t)steps + 1;
    return true;
}

/* Whoever has several animations in a file may have meant another one. */
static bool write_note(gltf_frames *frames, const char *name) {
    char names[300];
    size_t count;
    if (!gltf_animation_names(&frames->scene, &count, names, sizeof names)) return false;
    if (count > 1 && name == NULL)
        snprintf(frames->note, sizeof frames->note, "the first of %zu animations is played: %s", count,
                 names);
    return true;
}

static bool open_frames(gltf_frames *frames, uint32_t vertex_count, const char *name) {
    if (!gltf_scene_open(&frames->reader, &frames->scene)) return false;
    if (frames->scene.vertex_count != vertex_count)
        return file_reader_fail(&frames->reader,
                                "holds %" PRIu32 " vertices, the model has %" PRIu32
                                " vertices: it was exported from another mesh",
                                frames->scene.vertex_count, vertex_count);
    return gltf_animation_open(&frames->scene, name, &frames->animation) &&
           gltf_pose_open(&frames->scene, &frames->pose) && count_frames(frames) && write_note(frames, name);
}

bool gltf_frames_open(const char *path, uint32_t vertex_count, double fps, const char *name,
                      gltf_frames **out, io_error *error) {
    const size_t size = strlen(path) + 1;
    if (!(fps > 0 && isfinite(fps)))
        return io_fail(error, "%s: %g frames a second, expected more than 0", path, fps);
    gltf_frames *frames = io_realloc(NULL, sizeof *frames + size);
    if (frames == NULL) return io_fail(error, "%s: out of memory", path);
    *frames = (gltf_frames){.fps = fps};
    memcpy(frames->path, path, size);
    if (!file_reader_open(&frames->reader, frames->path, error) || !open_frames(frames, vertex_count, name)) {
        gltf_frames_close(frames);
        return false;
    }
    *out = frames;
    return true;
}

void gltf_frames_close(gltf_frames *frames) {
    if (frames == NULL) return;
    gltf_pose_close(&frames->pose);
    gltf_animation_close(&frames->animation);
    gltf_scene_close(&frames->scene);
    file_reader_close(&frames->reader);
    free(frames);
}

uint32_t gltf_frames_count(const gltf_frames *frames) {
    return frames->count;
}

const char *gltf_frames_note(const gltf_frames *frames) {
    return frames->note[0] != '\0' ? frames->note : NULL;
}

int32_t gltf_frames_number(const gltf_frames *frames, uint32_t frame) {
    const double first = round(frames->animation.start * frames->fps);
    return first + frame > INT32_MAX || first < INT32_MIN ? (int32_t)frame : (int32_t)(first + frame);
}

bool gltf_frames_read(gltf_frames *frames, uint32_t frame, double *positions, io_error *error) {
    const double time = frames->animation.start + frame / frames->fps;
    io_error cause;
    frames->reader.error = &cause;
    gltf_animation_apply(&frames->animation, time, &frames->pose);
    const bool done = gltf_pose_write(&frames->pose, positions);
    frames->reader.error = NULL;
    return done || io_fail(error, "%s (at %g s)", cause.text, time);
}
