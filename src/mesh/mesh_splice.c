/* A mesh put together from objects of other meshes: their arrays are copied, and only offsets change. */
#include "src/mesh/mesh_change.h"

#include <string.h>

/* No component spans two objects, and those of one object are consecutive. */
static uint32_t end_of_components(const cscd_mesh *mesh, const object_range *range, uint32_t begin) {
    uint32_t next = range->triangle + range->triangle_count;
    if (range->triangle_count == 0) return begin;
    return next < mesh->triangle_count ? mesh->triangle_components[next] : mesh->component_count;
}

void mesh_find_ranges(const cscd_mesh *mesh, object_range *out) {
    uint32_t component = 0;
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        const cscd_object *object = &mesh->objects[i];
        out[i] = (object_range){.vertex = object->first_vertex,
                                .vertex_count = object->vertex_count,
                                .edge = object->first_edge,
                                .edge_count = object->edge_count,
                                .triangle = object->first_triangle,
                                .triangle_count = object->triangle_count,
                                .component = component};
        component = end_of_components(mesh, &out[i], component);
        out[i].component_count = component - out[i].component;
    }
}

/* ---- places ------------------------------------------------------------------------------------------- */

static void place_objects(cscd_mesh *mesh, object_move *moves, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const object_range *from = &moves[i].from;
        moves[i].to = *from;
        moves[i].to.vertex = mesh->vertex_count;
        moves[i].to.edge = mesh->edge_count;
        moves[i].to.triangle = mesh->triangle_count;
        moves[i].to.component = mesh->component_count;
        mesh->vertex_count += from->vertex_count;
        mesh->edge_count += from->edge_count;
        mesh->triangle_count += from->triangle_count;
        mesh->component_count += from->component_count;
    }
    mesh->object_count = count;
}

static bool any_obstacle(const object_move *moves, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        if (moves[i].source.mesh->objects[moves[i].source.object].obstacle) return true;
    }
    return false;
}

/* Points stand behind the edges. */
static size_t count_points(const object_move *moves, uint32_t count) {
    size_t points = 0;
    for (uint32_t i = 0; i < count; i++) {
        const cscd_object *object = &moves[i].source.mesh->objects[moves[i].source.object];
        if (object->kind == CSCD_OBJECT_POINTS) points += object->vertex_count;
    }
    return points;
}

static bool allocate_arrays(cscd_mesh *mesh, bool obstacles, size_t points) {
    size_t vertices = mesh->vertex_count, edges = mesh->edge_count, triangles = mesh->triangle_count;
    array_list list = {
        {ARRAY(mesh->triangles, triangles), ARRAY(mesh->edges, edges + points),
         ARRAY(mesh->triangle_edges, triangles), ARRAY(mesh->vertex_star_offsets, vertices + 1),
         ARRAY(mesh->vertex_stars, triangles * 3), ARRAY(mesh->edge_star_offsets, edges + 1),
         ARRAY(mesh->edge_stars, triangles * 3), ARRAY(mesh->triangle_components, triangles),
         ARRAY(mesh->components, mesh->component_count), ARRAY(mesh->objects, mesh->object_count),
         ARRAY_IF(obstacles, mesh->obstacles, mesh->component_count)}};
    return context_reserve_all(mesh->context, list);
}

/* ---- copies ------------------------------------------------------------------------------------------- */

static void copy_stars(const cscd_mesh *from, const object_move *m, cscd_mesh *to) {
    uint32_t by = m->to.triangle - m->from.triangle;
    size_t begin = (size_t)m->from.triangle * 3, end = (size_t)m->to.triangle * 3;
    size_t corners = (size_t)m->from.triangle_count * 3;
    copy_shifted(from->vertex_star_offsets + m->from.vertex, m->from.vertex_count, by * 3,
                 to->vertex_star_offsets + m->to.vertex);
    copy_shifted(from->vertex_stars + begin, corners, by, to->vertex_stars + end);
    copy_shifted(from->edge_star_offsets + m->from.edge, m->from.edge_count, by * 3,
                 to->edge_star_offsets + m->to.edge);
    copy_shifted(from->edge_stars + begin, corners, by, to->edge_stars + end);
}

static void copy_features(const cscd_mesh *from, const object_move *m, cscd_mesh *to) {
    uint32_t vertices = m->to.vertex - m->from.vertex, edges = m->to.edge - m->from.edge;
    size_t corners = (size_t)m->from.triangle_count * 3;
    copy_shifted(from->triangles[m->from.triangle], corners, vertices, to->triangles[m->to.triangle]);
    copy_shifted(from->edges[m->from.edge], (size_t)m->from.edge_count * 2, vertices, to->edges[m->to.edge]);
    copy_shifted(from->triangle_edges[m->from.triangle], corners, edges, to->triangle_edges[m->to.triangle]);
}

static void shift_feature(uint32_t *first, uint32_t by) {
    if (*first != UINT32_MAX) *first += by;
}

static void copy_components(const cscd_mesh *from, const object_move *m, cscd_mesh *to) {
    uint32_t vertices = m->to.vertex - m->from.vertex, edges = m->to.edge - m->from.edge;
    copy_shifted(from->triangle_components + m->from.triangle, m->from.triangle_count,
                 m->to.component - m->from.component, to->triangle_components + m->to.triangle);
    for (uint32_t i = 0; i < m->from.component_count; i++) {
        cscd_component *component = &to->components[m->to.component + i];
        memcpy(component, &from->components[m->from.component + i], sizeof *component);
        shift_feature(&component->first_open_edge, edges);
        shift_feature(&component->first_non_manifold_edge, edges);
        shift_feature(&component->first_inconsistent_edge, edges);
        shift_feature(&component->first_non_manifold_vertex, vertices);
        if (to->obstacles != NULL)
            to->obstacles[m->to.component + i] = component_is_obstacle(from, m->from.component + i);
    }
}

static void copy_object(const object_move *m, uint32_t index, cscd_mesh *to) {
    const cscd_mesh *from = m->source.mesh;
    cscd_object *object = &to->objects[index];
    memcpy(object, &from->objects[m->source.object], sizeof *object);
    object->first_vertex = m->to.vertex;
    object->first_edge = m->to.edge;
    object->first_triangle = m->to.triangle;
    copy_features(from, m, to);
    copy_stars(from, m, to);
    copy_components(from, m, to);
}

static void copy_normal(const object_source *source, double normal[3]) {
    const double(*normals)[3] = (const double(*)[3])source->mesh->loose.normals;
    if (normals != NULL) memcpy(normal, normals[source->object], sizeof normals[0]);
}

cscd_status mesh_splice(cscd_mesh *mesh, object_move *moves, uint32_t count) {
    place_objects(mesh, moves, count);
    if (!allocate_arrays(mesh, any_obstacle(moves, count), count_points(moves, count)))
        return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < count; i++) copy_object(&moves[i], i, mesh);
    mesh->vertex_star_offsets[mesh->vertex_count] = mesh->triangle_count * 3;
    mesh->edge_star_offsets[mesh->edge_count] = mesh->triangle_count * 3;
    cscd_status status = mesh_list_loose_objects(mesh);
    for (uint32_t i = 0; status == CSCD_OK && mesh->loose.normals != NULL && i < count; i++)
        copy_normal(&moves[i].source, mesh->loose.normals[i]);
    return status;
}
