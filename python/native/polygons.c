/* Cuts faces that Python has into triangles, by the way that faces of files go. */
#include "python/native/exports.h"

#include "tool/io/mesh_builder.h"

#include <stdlib.h>
#include <string.h>

static bool add_faces(mesh_builder *builder, const double *positions, uint32_t vertex_count,
                      const uint32_t *corners, const uint32_t *face_sizes, size_t face_count) {
    for (uint32_t v = 0; v < vertex_count; v++)
        if (!mesh_builder_add_vertex(builder, positions + (size_t)v * 3)) return false;
    for (size_t face = 0; face < face_count; face++) {
        if (!mesh_builder_begin_face(builder)) return false;
        for (uint32_t i = 0; i < face_sizes[face]; i++)
            if (!mesh_builder_add_corner(builder, *corners++)) return false;
        if (!mesh_builder_end_face(builder)) return false;
    }
    return true;
}

/* Faces of face_sizes corners, one after the other, become *out, which cscdpy_polygons_free gives back. Faces without three
 * different corners are left without a triangle. On false `error` says why. */
PYTHON_API bool cscdpy_polygons_cut(const double *positions, uint32_t vertex_count, const uint32_t *corners,
                                    const uint32_t *face_sizes, size_t face_count, mesh_file **out,
                                    io_error *error) {
    file_reader reader = {.path = "faces", .error = error};
    mesh_builder builder = mesh_builder_of(&reader, 0);
    mesh_file *mesh = calloc(1, sizeof *mesh);
    bool cut = mesh != NULL &&
               add_faces(&builder, positions, vertex_count, corners, face_sizes, face_count) &&
               (builder.triangle_count == 0 || mesh_builder_finish(&builder, mesh));
    if (mesh == NULL) io_fail(error, "out of memory");
    mesh_builder_free(&builder);
    if (!cut) {
        free(mesh);
        return false;
    }
    *out = mesh;
    return true;
}

PYTHON_API uint32_t cscdpy_polygons_count(const mesh_file *mesh) {
    return mesh->triangle_count;
}

/* Copies the triangles, three vertices each, and the face that each is cut from. */
PYTHON_API void cscdpy_polygons_copy(const mesh_file *mesh, uint32_t *triangles, uint32_t *faces) {
    memcpy(triangles, mesh->triangles, (size_t)mesh->triangle_count * 3 * sizeof *triangles);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) faces[i] = mesh_file_polygon(mesh, i);
}

PYTHON_API void cscdpy_polygons_free(mesh_file *mesh) {
    mesh_file_free(mesh);
    free(mesh);
}
