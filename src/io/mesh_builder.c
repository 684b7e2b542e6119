/* Collects the vertices and faces of a mesh file, checking each. */
#include "src/io/mesh_builder.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

mesh_builder mesh_builder_of(file_reader *reader, uint32_t index_base) {
    return (mesh_builder){
        .reader = reader,
        .index_base = index_base,
        .positions = growable_of(3 * sizeof(double)),
        .triangles = growable_of(3 * sizeof(uint32_t)),
    };
}

void mesh_builder_free(mesh_builder *builder) {
    growable_free(&builder->positions);
    growable_free(&builder->triangles);
}

/* A new element of one of the two arrays, or NULL and an error. */
static void *push_item(mesh_builder *builder, growable *array, const char *what) {
    if (array->count >= MESH_COUNT_LIMIT) {
        file_reader_fail_here(builder->reader, "more than %" PRId32 " %s, the most of a mesh",
                              MESH_COUNT_LIMIT, what);
        return NULL;
    }
    void *element = growable_push(array);
    if (element == NULL) {
        file_reader_fail_here(builder->reader, "out of memory after %zu %s", array->count, what);
    }
    return element;
}

bool mesh_builder_add_vertex(mesh_builder *builder, const double position[3]) {
    for (int axis = 0; axis < 3; axis++) {
        if (!isfinite(position[axis])) {
            return file_reader_fail_here(
                builder->reader, "coordinate %c of vertex %zu is %g, expected a finite number", "xyz"[axis],
                builder -> positions.count + builder->index_base, position[axis]);
        }
    }
    double *vertex = push_item(builder, &builder->positions, "vertices");
    if (vertex == NULL) return false;
    memcpy(vertex, position, 3 * sizeof *vertex);
    return true;
}

static bool add_triangle(mesh_builder *builder, uint32_t a, uint32_t b, uint32_t c) {
    if (a == b || b == c || c == a) {
        uint32_t base = builder->index_base, twice = b == c ? b : a;
        return file_reader_fail_here(builder->reader,
                                     "triangle %" PRIu32 " %" PRIu32 " %" PRIu32 " repeats vertex %" PRIu32
                                     ", expected three different corners",
                                     a + base, b + base, c + base, twice + base);
    }
    uint32_t *triangle = push_item(builder, &builder->triangles, "triangles");
    if (triangle == NULL) return false;
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
    return true;
}

void mesh_builder_begin_face(mesh_builder *builder) {
    builder->corner_count = 0;
}

bool mesh_builder_add_corner(mesh_builder *builder, uint32_t vertex) {
    if (builder->corner_count == 0) builder->first_corner = vertex;
    if (builder->corner_count >= 2 &&
        !add_triangle(builder, builder->first_corner, builder->last_corner, vertex)) {
        return false;
    }
    builder->last_corner = vertex;
    builder->corner_count++;
    return true;
}

bool mesh_builder_end_face(mesh_builder *builder) {
    if (builder->corner_count >= 3) return true;
    return file_reader_fail_here(builder->reader, "a face of %zu %s, expected 3 or more",
                                 builder->corner_count, builder->corner_count == 1 ? "corner" : "corners");
}

bool mesh_builder_finish(mesh_builder *builder, mesh_file *out) {
    if (builder->positions.count == 0) {
        return file_reader_fail(builder->reader, "no vertices found, expected a triangle mesh");
    }
    if (builder->triangles.count == 0) {
        return file_reader_fail(builder->reader,
                                "no faces found for the %zu vertices, expected a triangle mesh",
                                builder->positions.count);
    }
    out->vertex_count = (uint32_t)builder->positions.count;
    out->triangle_count = (uint32_t)builder->triangles.count;
    out->positions = growable_take(&builder->positions);
    out->triangles = growable_take(&builder->triangles);
    return true;
}
