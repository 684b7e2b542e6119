/* The rest shape of `cscd untangle`. */
#include "tool/untangle/untangle_run.h"

/* Another file of the model's faces takes the place of the model's, whose vertices are joined as before. */
bool rest_shape_read(const char *path, const recording *r, double *positions, io_error *error) {
    mesh_file shape;
    recorded_object model = r->objects[0];
    io_error reason;
    if (!mesh_file_read(path, &shape, &reason)) return io_fail(error, "--rest-shape: %s", reason.text);
    const bool fits =
        shape.vertex_count == model.file.vertex_count && shape.faces_hash == model.file.faces_hash;
    if (fits) {
        model.file.positions = shape.positions;
        recording_rest(r, positions);
        recorded_object_rest(&model, positions + (size_t)model.first_vertex * 3);
    } else {
        (void)io_fail(
            error,
            "--rest-shape: %s has %u vertices and %u triangles, and %s has %u and %u; it has to be the "
            "same mesh, face by face, in another shape",
            path, shape.vertex_count, shape.triangle_count, model.source.name, model.file.vertex_count,
            model.file.triangle_count);
    }
    mesh_file_free(&shape);
    return fits;
}
