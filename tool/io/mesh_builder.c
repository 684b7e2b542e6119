/* Collects the vertices and faces of a mesh file, checking each. */
#include "tool/io/mesh_builder.h"
#include "tool/io/polygon.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

mesh_builder mesh_builder_of(file_reader *reader, uint32_t index_base) {
    return (mesh_builder){
        .reader = reader,
        .index_base = index_base,
        .positions = growable_of(3 * sizeof(double)),
        .corners = growable_of(sizeof(uint32_t)),
        .faces = growable_of(sizeof(built_face)),
        .stiffness = growable_of(sizeof(double)),
        .part = NO_MESH_PART,
        .own_part = NO_MESH_PART,
        .faces_hash = MESH_HASH_START,
    };
}

void mesh_builder_free(mesh_builder *builder) {
    growable_free(&builder->positions);
    growable_free(&builder->corners);
    growable_free(&builder->faces);
    growable_free(&builder->stiffness);
    mesh_parts_free(&builder->parts);
    mesh_parts_free(&builder->own_parts);
}

/* A new element of an array, or NULL and an error. */
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
    if (builder->reader->places == NULL) return true;
    void *places = push_item(builder, builder->reader->places, "vertices");
    if (places != NULL) memcpy(places, builder->reader->coordinates, sizeof builder->reader->coordinates);
    return places != NULL;
}

static bool find_part(mesh_builder *builder, mesh_parts *parts, const char *name, size_t length,
                      uint32_t *part) {
    *part = length > 0 ? mesh_parts_find(parts, name, length) : NO_MESH_PART;
    return length == 0 || *part != NO_MESH_PART ||
           file_reader_fail_here(builder->reader, "out of memory after %" PRIu32 " parts", parts->count);
}

bool mesh_builder_set_part(mesh_builder *builder, const char *name, size_t length) {
    return find_part(builder, &builder->parts, name, length, &builder->part);
}

bool mesh_builder_set_own_part(mesh_builder *builder, const char *name, size_t length) {
    return find_part(builder, &builder->own_parts, name, length, &builder->own_part);
}

bool mesh_builder_set_face_part(mesh_builder *builder, const char *name, size_t length) {
    if (!mesh_builder_set_part(builder, name, length)) return false;
    ((built_face *)builder->faces.data)[builder->faces.count - 1].part = builder->part;
    return true;
}

/* The first corner of the face that was begun last. */
static size_t corner_start(const mesh_builder *builder) {
    const built_face *faces = builder->faces.data;
    return builder->faces.count > 1 ? faces[builder->faces.count - 2].corner_end : 0;
}

bool mesh_builder_begin_face(mesh_builder *builder) {
    built_face *face = push_item(builder, &builder->faces, "faces");
    if (face == NULL) return false;
    *face = (built_face){builder->corners.count, builder->part, builder->own_part};
    return true;
}

bool mesh_builder_add_corner(mesh_builder *builder, uint32_t vertex) {
    uint32_t *corner = growable_push(&builder->corners);
    if (corner == NULL)
        return file_reader_fail_here(builder->reader, "out of memory after %zu corners of faces",
                                     builder->corners.count);
    *corner = vertex;
    return true;
}

/* Counts a repair of a face, and keeps the smallest number of one. */
static void note_repair(uint32_t face, uint32_t *count, uint32_t *first) {
    if ((*count)++ == 0 || face < *first) *first = face;
}

/* Leaves a vertex out that follows itself in the face, which is a cycle; returns how many corners are
 * left. */
static size_t shorten_face(uint32_t *corners, size_t count) {
    size_t left = 0;
    for (size_t i = 0; i < count; i++)
        if (left == 0 || corners[i] != corners[left - 1]) corners[left++] = corners[i];
    while (left > 1 && corners[left - 1] == corners[0]) left--;
    return left;
}

bool mesh_builder_end_face(mesh_builder *builder) {
    const size_t start = corner_start(builder), count = builder->corners.count - start;
    uint32_t *corners = count > 0 ? (uint32_t *)builder->corners.data + start : NULL;
    const size_t shortened = shorten_face(corners, count), left = shortened < 3 ? 0 : shortened;
    mesh_repairs *repairs = &builder->repairs;
    const uint32_t face = (uint32_t)builder->faces.count - 1;
    if (left == 0) {
        note_repair(face, &repairs->dropped, &repairs->first_dropped);
    } else if (left < count) {
        note_repair(face, &repairs->shortened, &repairs->first_shortened);
    }
    builder->corners.count = start + left;
    builder->faces_hash = mesh_file_hash(builder->faces_hash, corners, left);
    ((built_face *)builder->faces.data)[builder->faces.count - 1].corner_end = builder->corners.count;
    if (left > 0) builder->triangle_count += left - 2;
    return builder->triangle_count <= MESH_COUNT_LIMIT ||
           file_reader_fail_here(builder->reader, "more than %" PRId32 " triangles, the most of a mesh",
                                 MESH_COUNT_LIMIT);
}

bool mesh_builder_add_face_stiffness(mesh_builder *builder, double stiffness) {
    double *added = push_item(builder, &builder->stiffness, "faces");
    if (added == NULL) return false;
    *added = stiffness;
    return true;
}

/* ---- triangles --------------------------------------------------------------------------------------- */

static bool repeats_vertex(const uint32_t triangle[3]) {
    return triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
}

/* Cuts a face into triangles behind those that there are. A face that names a vertex twice, but not in a row,
 * may have triangles that do so, too, and are left out. */
static bool cut_face(mesh_builder *builder, uint32_t face, mesh_file *out) {
    const built_face *faces = builder->faces.data;
    const size_t start = face > 0 ? faces[face - 1].corner_end : 0, count = faces[face].corner_end - start;
    const uint32_t first_triangle = out->triangle_count;
    if (count == 0) return true;
    uint32_t(*triangles)[3] = (uint32_t(*)[3])out->triangles + out->triangle_count;
    switch (
        polygon_fill(out->positions, (uint32_t *)builder->corners.data + start, (uint32_t)count, triangles)) {
    case POLYGON_OUT_OF_MEMORY:
        return file_reader_fail(builder->reader, "out of memory for a face of %zu corners", count);
    case POLYGON_FANNED:
        note_repair(face, &out->repairs.fanned, &out->repairs.first_fanned);
        break;
    case POLYGON_FILLED:
        break;
    }
    for (size_t i = 0; i + 2 < count; i++) {
        if (repeats_vertex(triangles[i])) continue;
        memmove(out->triangles + (size_t)out->triangle_count * 3, triangles[i], sizeof triangles[i]);
        out->polygons[out->triangle_count] = face;
        if (out->parts.count > 0) out->parts.of_triangle[out->triangle_count] = faces[face].part;
        if (out->own_parts.count > 0) out->own_parts.of_triangle[out->triangle_count] = faces[face].own_part;
        if (out->stiffness != NULL)
            out->stiffness[out->triangle_count] = ((const double *)builder->stiffness.data)[face];
        out->triangle_count++;
    }
    if (out->triangle_count == first_triangle)
        note_repair(face, &out->repairs.dropped, &out->repairs.first_dropped);
    return true;
}

/* If there are parts, each triangle has one. */
static bool reserve_labels(mesh_parts *parts, size_t count) {
    if (parts->count == 0) return true;
    parts->of_triangle = io_realloc(NULL, count * sizeof *parts->of_triangle);
    return parts->of_triangle != NULL;
}

static bool cut_faces(mesh_builder *builder, mesh_file *out) {
    const size_t count = (size_t)builder->triangle_count + 1;
    out->triangles = io_realloc(NULL, count * 3 * sizeof *out->triangles);
    out->polygons = io_realloc(NULL, count * sizeof *out->polygons);
    if (builder->stiffness.count > 0) out->stiffness = io_realloc(NULL, count * sizeof *out->stiffness);
    if (out->triangles == NULL || out->polygons == NULL || !reserve_labels(&out->parts, count) ||
        !reserve_labels(&out->own_parts, count) || (builder->stiffness.count > 0 && out->stiffness == NULL))
        return file_reader_fail(builder->reader, "out of memory for %" PRIu64 " triangles",
                                builder->triangle_count);
    for (uint32_t face = 0; face < builder->faces.count; face++)
        if (!cut_face(builder, face, out)) return false;
    return true;
}

/* A mesh of triangles alone needs no list of the faces that they are cut from. */
static void drop_plain_polygons(mesh_file *mesh) {
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        if (mesh->polygons[i] != i) return;
    free(mesh->polygons);
    mesh->polygons = NULL;
}

bool mesh_builder_finish(mesh_builder *builder, mesh_file *out) {
    if (builder->positions.count == 0) {
        return file_reader_fail(builder->reader, "no vertices found, expected a triangle mesh");
    }
    mesh_file mesh = {.vertex_count = (uint32_t)builder->positions.count,
                      .polygon_count = (uint32_t)builder->faces.count,
                      .positions = growable_take(&builder->positions),
                      .parts = builder->parts,
                      .own_parts = builder->own_parts,
                      .faces_hash = builder->faces_hash,
                      .repairs = builder->repairs};
    builder->parts = builder->own_parts = (mesh_parts){0};
    bool done = cut_faces(builder, &mesh);
    if (done && mesh.triangle_count == 0)
        done = file_reader_fail(builder->reader,
                                "no faces found for the %" PRIu32 " vertices, expected a triangle mesh",
                                mesh.vertex_count);
    if (!done) {
        mesh_file_free(&mesh);
        return false;
    }
    drop_plain_polygons(&mesh);
    *out = mesh;
    return true;
}
