/* A recording of a few frames for programs that replay recordings: a dumbbell whose balls are bent into each other. */
#include "tests/support/models/tiny_recording.h"

#include "src/io/mesh_file.h"
#include "src/io/point_cache_write.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>

void tiny_recording_place(const body *shape, int frame, double *out) {
    for (uint32_t v = 0; v < shape->vertex_count; v++) {
        const double *p = shape->positions + v * 3;
        double angle = 0.28 * frame * fmin(fmax(p[2], -0.6), 0.6) / 0.6;
        out[v * 3] = (float)(p[0] * cos(angle) + fabs(p[2]) * sin(fabs(angle)));
        out[v * 3 + 1] = (float)p[1];
        out[v * 3 + 2] = (float)(p[2] * cos(angle) - p[0] * sin(angle));
    }
}

body tiny_recording_write(temp_folder *folder) {
    body shape;
    io_error error;
    point_cache_writer *writer;
    temp_path model = temp_file_path(folder, "tiny.obj"), frames = temp_file_path(folder, "tiny.pc2");
    if (!body_make(BODY_DUMBBELL, 300, &shape, &error)) fail_msg("%s", error.text);
    const mesh_file mesh =
        mesh_file_of(shape.vertex_count, shape.triangle_count, shape.positions, shape.triangles);
    double *moved = malloc((size_t)shape.vertex_count * 3 * sizeof *moved);
    if (moved == NULL || !mesh_file_write_obj(model.text, &mesh, &error) ||
        !point_cache_writer_open(frames.text, shape.vertex_count, TINY_FRAMES, &writer, &error))
        fail_msg("no recording");
    for (int frame = 0; frame < TINY_FRAMES; frame++) {
        tiny_recording_place(&shape, frame, moved);
        assert_true(point_cache_writer_write(writer, moved, &error));
    }
    assert_true(point_cache_writer_close(writer, &error));
    free(moved);
    return shape;
}
