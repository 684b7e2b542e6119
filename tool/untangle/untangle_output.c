/* The positions that `cscd untangle` writes: a mesh as the model's, or a point cache. */
#include "tool/untangle/untangle_run.h"

#include "tool/io/output_file.h"

#include <stdlib.h>
#include <string.h>

static bool names_cache(const char *path) {
    return path_has_extension(path, ".pc2") || path_has_extension(path, ".mdd");
}

/* Is it to be a file of the model's own format? "-" is. */
static bool copies_model(const char *path, const recorded_object *model) {
    unsigned length;
    return mesh_copy_knows(model->file.format) &&
           (output_file_is_standard(path) || mesh_format_of_path(path, &length) == model->file.format);
}

static bool fail_ending(const char *path, io_error *error) {
    return io_fail(
        error,
        "-o %s: expected a name that ends in .pc2, .mdd or .obj, or in that of MODEL, if it is an " MESH_COPY_FORMATS
        " file",
        path);
}

bool untangle_output_named(const char *path, io_error *error) {
    unsigned length;
    return output_file_is_standard(path) || names_cache(path) ||
           mesh_copy_knows(mesh_format_of_path(path, &length)) || fail_ending(path, error);
}

bool untangle_output_fits(const char *path, const recorded_object *model, uint32_t frame_count,
                          io_error *error) {
    if (names_cache(path)) return true;
    const bool is_mesh = copies_model(path, model) || path_has_extension(path, ".obj");
    if (is_mesh && frame_count > 1)
        return io_fail(
            error,
            "-o %s: a mesh file has one frame, and these are %u; expected a name that ends in .pc2 or "
            ".mdd, or one frame (--frames N)",
            path, frame_count);
    return is_mesh || fail_ending(path, error);
}

static bool open_cache(const char *path, const recording *r, const frame_choice *frames, untangle_output *out,
                       io_error *error) {
    const recorded_object *model = &r->objects[0];
    const int32_t *numbers = r->frame_numbers;
    const uint32_t count = frame_choice_count(frames), first = frames->first;
    int64_t step = count > 1 ? (int64_t)numbers[first + frames->step] - numbers[first] : 1;
    for (uint32_t i = 2; i < count; i++)
        if ((int64_t)numbers[first + i * frames->step] - numbers[first + (i - 1) * frames->step] != step)
            step = 0;
    out->is_cache = out->holds_floats = true;
    return point_cache_writer_open(path, model->file.vertex_count, count, &out->cache, error) &&
           (step <= 0 || step > INT32_MAX ||
            point_cache_writer_number(out->cache, numbers[first], (uint32_t)step, error));
}

static bool open_mesh(const char *path, const recorded_object *model, untangle_output *out, io_error *error) {
    if (!output_path_opens(path, error)) return false;
    if (!copies_model(path, model)) return true;
    if (!mesh_copy_open(model->source.model_path, &out->copy, error)) return false;
    out->holds_floats = mesh_copy_holds_floats(out->copy);
    return mesh_copy_vertex_count(out->copy) == model->file.vertex_count ||
           io_fail(error, "%s: it has changed since it was read", model->source.model_path);
}

bool untangle_output_open(const char *path, const recording *r, const frame_choice *frames,
                          untangle_output *out, io_error *error) {
    const recorded_object *model = &r->objects[0];
    *out = (untangle_output){.path = path};
    out->file_positions = malloc((size_t)model->file.vertex_count * 3 * sizeof *out->file_positions);
    if (out->file_positions == NULL) return io_fail(error, "out of memory");
    return names_cache(path) ? open_cache(path, r, frames, out, error) : open_mesh(path, model, out, error);
}

/* Of what welding has joined, all vertices go where it goes; what has not moved stays as the file has it. */
static void place_file_vertices(untangle_output *out, const recorded_object *model, const double *positions,
                                const bool *moved) {
    for (uint32_t v = 0; v < model->file.vertex_count; v++) {
        const uint32_t own = model->welded ? model->weld.vertex_of_file_vertex[v] : v;
        const double *place =
            moved[own] ? positions + (size_t)own * 3 : model->file_positions + (size_t)v * 3;
        memcpy(out->file_positions + (size_t)v * 3, place, 3 * sizeof *place);
    }
}

static bool write_triangles(const untangle_output *out, const mesh_file *file, io_error *error) {
    const mesh_file mesh =
        mesh_file_of(file->vertex_count, file->triangle_count, out->file_positions, file->triangles);
    return mesh_file_write_obj(out->path, &mesh, error);
}

bool untangle_output_write(untangle_output *out, const recording *r, uint32_t i, const double *positions,
                           const bool *moved, io_error *error) {
    const recorded_object *model = &r->objects[0];
    place_file_vertices(out, model, positions, moved);
    if (out->is_cache)
        return point_cache_writer_seek(out->cache, i, error) &&
               point_cache_writer_write(out->cache, out->file_positions, error);
    if (out->copy != NULL) return mesh_copy_write(out->copy, out->path, out->file_positions, error);
    return write_triangles(out, &model->file, error);
}

bool untangle_output_close(untangle_output *out, uint32_t first, uint32_t count, io_error *error) {
    bool closed = true;
    if (count == 0) point_cache_writer_abandon(out->cache);
    if (count > 0 && out->cache != NULL) {
        closed = point_cache_writer_keep(out->cache, first, count, error);
        closed = point_cache_writer_close(out->cache, closed ? error : NULL) && closed;
    }
    mesh_copy_close(out->copy);
    free(out->file_positions);
    *out = (untangle_output){0};
    return closed;
}
