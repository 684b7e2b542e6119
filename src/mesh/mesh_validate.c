/* A validator of meshes, for debug builds and tests. */
#include "src/mesh/mesh.h"

#include <stddef.h>

/* ---- features -------------------------------------------------------------------------------------------- */

static bool joins_corners(const uint32_t edge[2], uint32_t a, uint32_t b) {
    return a < b ? edge[0] == a && edge[1] == b : edge[0] == b && edge[1] == a;
}

static const char *check_triangles(const cscd_mesh *mesh) {
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles[t], *e = mesh->triangle_edges[t];
        for (int i = 0; i < 3; i++) {
            if (v[i] >= mesh->vertex_count) return "a triangle of a mesh names a vertex that there is not";
            if (v[i] == v[(i + 1) % 3]) return "a triangle of a mesh has a vertex twice";
        }
        for (int i = 0; i < 3; i++) {
            if (e[i] >= mesh->edge_count || !joins_corners(mesh->edges[e[i]], v[i], v[(i + 1) % 3]))
                return "an edge of a triangle does not join its corners";
        }
    }
    return NULL;
}

static bool comes_before(const uint32_t a[2], const uint32_t b[2]) {
    return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
}

static const char *check_edges(const cscd_mesh *mesh) {
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *ends = mesh->edges[e];
        if (ends[0] >= ends[1] || ends[1] >= mesh->vertex_count)
            return "the vertices of an edge are out of order or range";
        if (e > 0 && !comes_before(mesh->edges[e - 1], ends)) return "the edges of a mesh are not sorted";
    }
    return NULL;
}

/* ---- stars ----------------------------------------------------------------------------------------------- */

typedef struct star_list {
    const uint32_t *offsets, *stars;
    uint32_t count; /* of vertices, or of edges */
    bool of_edges;
} star_list;

static bool triangle_has(const cscd_mesh *mesh, uint32_t triangle, const star_list *list, uint32_t feature) {
    const uint32_t *of = list->of_edges ? mesh->triangle_edges[triangle] : mesh->triangles[triangle];
    return triangle_contains(of, feature);
}

/* With the right number of entries in all, and no entry twice, every triangle is in the star of each of its features. */
static const char *check_stars(const cscd_mesh *mesh, star_list list) {
    if (list.offsets[0] != 0 || list.offsets[list.count] != mesh->triangle_count * 3)
        return "the stars of a mesh do not hold every triangle three times";
    for (uint32_t i = 0; i < list.count; i++) {
        if (list.offsets[i] > list.offsets[i + 1]) return "the stars of a mesh overlap";
    }
    for (uint32_t i = 0; i < list.count; i++) {
        for (uint32_t k = list.offsets[i]; k < list.offsets[i + 1]; k++) {
            uint32_t t = list.stars[k];
            if (t >= mesh->triangle_count || !triangle_has(mesh, t, &list, i))
                return "a star holds a triangle that does not contain its feature";
            if (k > list.offsets[i] && list.stars[k - 1] >= t) return "a star of a mesh is not sorted";
        }
    }
    return NULL;
}

/* ---- components and objects ------------------------------------------------------------------------------ */

/* Components are numbered in the order of their first triangles, and triangles at one vertex are of one component. */
static const char *check_components(const cscd_mesh *mesh) {
    uint32_t next = 0;
    uint64_t triangles = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t c = mesh->triangle_components[t];
        if (c > next || c >= mesh->component_count) return "the components of a mesh are not in order";
        next += c == next;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (uint32_t i = mesh->vertex_star_offsets[v] + 1; i < mesh->vertex_star_offsets[v + 1]; i++) {
            const uint32_t *star = mesh->vertex_stars + i;
            if (mesh->triangle_components[star[-1]] != mesh->triangle_components[star[0]])
                return "two components of a mesh have a vertex in common";
        }
    }
    for (uint32_t c = 0; c < mesh->component_count; c++) triangles += mesh->components[c].triangle_count;
    return next == mesh->component_count && triangles == mesh->triangle_count
               ? NULL
               : "the components of a mesh do not hold every triangle once";
}

/* Objects follow each other in all numberings. */
static const char *check_objects(const cscd_mesh *mesh) {
    uint32_t vertex = 0, edge = 0, triangle = 0;
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        const cscd_object *o = &mesh->objects[i];
        if (o->first_vertex != vertex || o->first_edge != edge || o->first_triangle != triangle)
            return "the objects of a mesh do not follow each other";
        vertex += o->vertex_count;
        edge += o->edge_count;
        triangle += o->triangle_count;
        for (uint32_t t = o->first_triangle; t < triangle && t < mesh->triangle_count; t++) {
            for (int k = 0; k < 3; k++) {
                uint32_t v = mesh->triangles[t][k];
                if (v < o->first_vertex || v >= vertex) return "a triangle lies in two objects";
            }
            if (triangle_of_obstacle(mesh, t) != o->obstacle)
                return "a component is no obstacle, but its object is";
        }
    }
    bool whole = vertex == mesh->vertex_count && edge == mesh->edge_count && triangle == mesh->triangle_count;
    return whole ? NULL : "the objects of a mesh do not hold every feature once";
}

/* ---- loose objects --------------------------------------------------------------------------------------- */

/* Wires have no triangle, and every other edge has one; points stand behind the edges, in their order. */
static const char *check_loose_objects(const cscd_mesh *mesh) {
    uint32_t wires = 0, place = mesh->edge_count;
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        const cscd_object *o = &mesh->objects[i];
        if (o->kind != CSCD_OBJECT_TRIANGLES && o->triangle_count > 0) return "a loose object has triangles";
        for (uint32_t e = o->first_edge; e < o->first_edge + o->edge_count; e++) {
            bool loose = edge_is_loose(mesh, e);
            if (loose != (o->kind == CSCD_OBJECT_WIRES))
                return "an edge without a triangle is no wire, or one with is";
            wires += loose;
        }
        for (uint32_t v = 0; o->kind == CSCD_OBJECT_POINTS && v < o->vertex_count; v++, place++) {
            if (mesh->edges[place][0] != o->first_vertex + v || mesh->edges[place][1] != o->first_vertex + v)
                return "a point does not stand behind the edges";
        }
    }
    if (wires != mesh->loose.wire_count || place - mesh->edge_count != mesh->loose.point_count)
        return "wires or points of a mesh are not counted";
    uint32_t ends = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) ends += wires_at_vertex(mesh, v);
    return ends == 2 * wires ? NULL : "the wires of a mesh are not at their ends";
}

const char *mesh_validate(const cscd_mesh *mesh) {
    const star_list vertices = {mesh->vertex_star_offsets, mesh->vertex_stars, mesh->vertex_count, false};
    const star_list edges = {mesh->edge_star_offsets, mesh->edge_stars, mesh->edge_count, true};
    const char *fault = check_edges(mesh);
    if (fault == NULL) fault = check_triangles(mesh);
    if (fault == NULL) fault = check_stars(mesh, vertices);
    if (fault == NULL) fault = check_stars(mesh, edges);
    if (fault == NULL) fault = check_components(mesh);
    if (fault == NULL) fault = check_objects(mesh);
    if (fault == NULL) fault = check_loose_objects(mesh);
    return fault;
}
