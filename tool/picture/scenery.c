/* A mesh that is drawn beside the recording and never tested: ground, stairs, a ball. */
#include "tool/picture/picture.h"

#include <math.h>

static bool open_frames(const char *frames_path, uint32_t frame_count, picture_scenery *s, io_error *error) {
    io_error reason;
    if (!animation_open(&frames_path, 1, s->file.vertex_count, NULL, &s->frames, &reason))
        return io_fail(error, "--scenery-frames: %s", reason.text);
    s->frame_count = animation_frame_count(s->frames);
    if (s->frame_count == 1 || s->frame_count == frame_count) return true;
    return io_fail(error, "--scenery-frames %s: %u frames, expected one or the recording's %u", frames_path,
                   s->frame_count, frame_count);
}

bool picture_scenery_open(const char *model_path, const char *frames_path, uint32_t frame_count,
                          picture_scenery *out, io_error *error) {
    picture_scenery s = {.path = frames_path != NULL ? frames_path : model_path};
    if (!mesh_file_read(model_path, &s.file, error) ||
        (frames_path != NULL && !open_frames(frames_path, frame_count, &s, error))) {
        picture_scenery_close(&s);
        return false;
    }
    s.mesh = (picture_mesh){s.file.vertex_count, s.file.triangle_count, s.file.positions, s.file.triangles};
    *out = s;
    return true;
}

/* Checks the range that can be drawn: products of a few coordinates must stay finite. */
static bool check_range(const picture_scenery *s, uint32_t frame, io_error *error) {
    const double *x = s->file.positions;
    for (size_t i = 0; i < (size_t)s->file.vertex_count * 3; i++)
        if (!(fabs(x[i]) <= 0x1p300))
            return io_fail(
                error, "%s: frame %u of it: vertex %zu has %c = %g, expected a magnitude of 2^300 at most",
                s->path, frame, i / 3, "xyz"[i % 3], x[i]);
    return true;
}

bool picture_scenery_read(picture_scenery *s, uint32_t frame, io_error *error) {
    uint32_t own = s->frame_count > 1 ? frame : 0;
    if (s->frames != NULL && !animation_read(s->frames, own, s->file.positions, error)) return false;
    return check_range(s, own, error);
}

void picture_scenery_close(picture_scenery *s) {
    animation_close(s->frames);
    mesh_file_free(&s->file);
    *s = (picture_scenery){0};
}
