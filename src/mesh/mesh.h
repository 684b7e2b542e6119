/* A mesh with its connectivity: edges, stars and components, which are built once. */
#pragma once

#include "src/core/context.h"

/* ---- objects that are not of triangles: wires, points and half-spaces -------------------------------------- */

/* Wires are edges whose stars are empty, among the other edges. Behind the last edge the array of edges goes on with
 * one for each vertex of an object of points, in their order: it joins the vertex with itself. So a point and a wire, or
 * two points, are two edges for every elementary test. */
typedef struct loose_objects {
    uint32_t wire_count, point_count, half_space_count;

    /* The wires at a vertex, as vertex_stars has its triangles; NULL: there are none. */
    uint32_t *wire_star_offsets, *wire_stars;

    double (*normals)[3]; /* per object, of half-spaces; NULL: there are none */
} loose_objects;

/* The sums of what descriptions ask for. */
typedef struct loose_totals {
    uint64_t wires, points;
} loose_totals;

/* Checks what an object of any kind says of wires, points and half-spaces. `object` is how messages begin. */
cscd_status loose_desc_check(cscd_context *context, const cscd_object_desc *desc, const char *object);

void loose_totals_add(loose_totals *totals, const cscd_object_desc *desc);

/* The number of vertices that loose objects give a reason for, at the most. */
uint64_t loose_totals_vertices(const loose_totals *totals);

/* Returns INVALID_MESH, with a sentence, if there are more points or edges than numbers for them. */
cscd_status loose_totals_check(cscd_context *context, const loose_totals *totals, uint64_t triangles);

/* Puts wires among the edges of triangles, and makes room for points behind them. */
cscd_status mesh_add_wires(cscd_mesh *mesh, const cscd_object_desc *objects);

/* The number, behind the edges, of a vertex of an object of points. */
uint32_t mesh_edge_of_point(const cscd_mesh *mesh, uint32_t vertex);

/* Fills in mesh->loose from the objects, whose edges are known, and lists the points behind the edges, where there is room
 * for them. Normals are left 0 for the caller. */
cscd_status mesh_list_loose_objects(cscd_mesh *mesh);

/* ---- the mesh ---------------------------------------------------------------------------------------------- */

/* Its facts about the triangles never change, and any number of objects in any contexts read it at the same time.
 * Each of them has a copy of this struct, its own view of the mesh, whose context is the one that the object works
 * in: it allocates there, runs tasks there and fails there. Arrays belong to the mesh that they were copied from. */
struct cscd_mesh {
    cscd_context *context;
    struct shared_mesh *shared; /* what all views have in common; NULL in a mesh that only a test has */
    uint32_t vertex_count, triangle_count, edge_count, component_count;

    uint32_t (*triangles)[3];
    uint32_t (*edges)[2];          /* smaller vertex first, sorted; loose points follow */
    uint32_t (*triangle_edges)[3]; /* edge i joins the corners i and i + 1 */

    /* The star of x is the list of triangles stars[offsets[x] .. offsets[x + 1]), ascending. */
    uint32_t *vertex_star_offsets, *vertex_stars;
    uint32_t *edge_star_offsets, *edge_stars;

    uint32_t *triangle_components;
    cscd_component *components;

    uint32_t object_count;
    cscd_object *objects;

    /* Per component: it is an obstacle, whose features are not tested with those of obstacles; NULL: there are none. */
    bool *obstacles;

    loose_objects loose; /* objects that are not of triangles */
};

/* An object that keeps a mesh holds it, and with it the context whose allocator has its memory. */
void mesh_hold(const cscd_mesh *mesh);
void mesh_release(const cscd_mesh *mesh);

/* The mesh as an object of the given context sees it, for as long as the mesh is held. */
cscd_mesh mesh_seen_from(cscd_context *context, const cscd_mesh *mesh);

/* The mesh that its creator has. */
const cscd_mesh *mesh_of_creator(const cscd_mesh *mesh);

/* Tells whether these are views of one mesh. */
static inline bool mesh_is_same(const cscd_mesh *a, const cscd_mesh *b) {
    return a->shared == b->shared;
}

/* The objects of two features, or triangles, as in a cscd_contact. */
void mesh_objects_of_pair(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b,
                          uint32_t out[2]);

static inline void copy_vertices(const uint32_t *from, int count, uint32_t *to) {
    for (int i = 0; i < count; i++) to[i] = from[i];
}

/* The vertices of cscd_mesh_stencil. */
static inline void mesh_vertices_of_pair(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a,
                                         uint32_t b, uint32_t out[4]) {
    uint32_t last = kind == CSCD_CONTACT_VH ? mesh->objects[b].first_vertex : b;
    out[0] = a;
    out[1] = out[2] = out[3] = last;
    if (kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_EV) copy_vertices(mesh->edges[a], 2, out);
    if (kind == CSCD_CONTACT_EE) copy_vertices(mesh->edges[b], 2, out + 2);
    if (kind == CSCD_CONTACT_VF) copy_vertices(mesh->triangles[b], 3, out + 1);
}

/* cscd_mesh_stencil, in whatever floating-point environment is set. Not inline, so that no arithmetic leaves it. */
cscd_stencil mesh_stencil(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b, double u,
                          double v) __attribute__((noinline));

/* Returns the first fault of the structure as a sentence, or NULL: indices out of range, stars, components and objects that
 * do not agree with the triangles. Takes linear time; see live_objects_add. */
const char *mesh_validate(const cscd_mesh *mesh);

/* Builds edges, triangle_edges and both kinds of stars from the triangles. */
cscd_status mesh_build_topology(cscd_mesh *mesh);

/* Builds triangle_components and components from the topology. */
cscd_status mesh_build_components(cscd_mesh *mesh);

/* Lists the triangles component by component: those of c are list[offsets[c] .. offsets[c + 1]). offsets: component_count + 1,
 * all 0. */
void mesh_list_by_component(const cscd_mesh *mesh, uint32_t *list, uint32_t *offsets);

/* Descriptions of objects, and the sizes of the mesh that they become a part of. */
typedef struct described_objects {
    const cscd_object_desc *descs;
    uint32_t count;
    const uint32_t *numbers;                  /* which objects of the mesh they are; NULL: 0, 1, 2, ... */
    uint32_t total;                           /* objects of the mesh */
    uint64_t other_vertices, other_triangles; /* those of its other objects */
    loose_totals other_loose;                 /* the same */
} described_objects;

/* The steps of cscd_mesh_create. Copies descriptions of the caller's size to descriptions of this library's. */
cscd_status mesh_take_objects(cscd_context *context, const cscd_object_desc *objects, size_t object_size,
                              uint32_t count, cscd_object_desc *out);

/* INVALID_MESH or INVALID_ARGUMENT names the object and what is wrong. */
cscd_status mesh_check_objects(cscd_context *context, const described_objects *objects);

/* A mesh without any object yet, and with the caller as its holder; NULL: no memory. */
cscd_mesh *mesh_begin(cscd_context *context);

/* Fills an empty mesh. On failure, which is OUT_OF_MEMORY without a sentence, the caller destroys it. */
cscd_status mesh_build_objects(cscd_mesh *mesh, const cscd_object_desc *objects, uint32_t count);

/* The mesh is whole; see context_list_object. */
void mesh_list(cscd_mesh *mesh);

static inline bool component_is_obstacle(const cscd_mesh *mesh, uint32_t component) {
    return mesh->obstacles != NULL && mesh->obstacles[component];
}

static inline bool triangle_of_obstacle(const cscd_mesh *mesh, uint32_t triangle) {
    return component_is_obstacle(mesh, mesh->triangle_components[triangle]);
}

/* Tells whether some objects are not of triangles. */
static inline bool mesh_has_loose_objects(const cscd_mesh *mesh) {
    const loose_objects *loose = &mesh->loose;
    return loose->wire_count > 0 || loose->point_count > 0 || loose->half_space_count > 0;
}

/* Tells whether this is the number of a point behind the edges. */
static inline bool edge_is_point(const cscd_mesh *mesh, uint32_t edge) {
    return mesh->loose.point_count > 0 && edge >= mesh->edge_count;
}

/* The number of triangles that contain an edge. */
static inline uint32_t edge_star_size(const cscd_mesh *mesh, uint32_t edge) {
    return mesh->edge_star_offsets[edge + 1] - mesh->edge_star_offsets[edge];
}

/* A vertex of no triangle is loose, or takes no part in anything. */
static inline bool vertex_has_no_triangle(const cscd_mesh *mesh, uint32_t vertex) {
    return mesh->vertex_star_offsets[vertex + 1] == mesh->vertex_star_offsets[vertex];
}

/* The number of pairs of triangles at a vertex grows with the square of theirs. A vertex of this many triangles is a hub,
 * whose pairs are found in another way. */
enum { HUB_TRIANGLES = 256 };

static inline bool vertex_is_hub(const cscd_mesh *mesh, uint32_t vertex) {
    return mesh->vertex_star_offsets[vertex + 1] - mesh->vertex_star_offsets[vertex] >= HUB_TRIANGLES;
}

/* The number of wires at a vertex. */
static inline uint32_t wires_at_vertex(const cscd_mesh *mesh, uint32_t vertex) {
    const uint32_t *offsets = mesh->loose.wire_star_offsets;
    return offsets != NULL ? offsets[vertex + 1] - offsets[vertex] : 0;
}

/* Tells whether it is a wire, or a point behind the edges. */
static inline bool edge_is_loose(const cscd_mesh *mesh, uint32_t edge) {
    return edge_is_point(mesh, edge) || edge_star_size(mesh, edge) == 0;
}

/* Tells whether the triangle runs along one of its edges from edge[0] to edge[1]. */
static inline bool triangle_runs_along(const uint32_t triangle[3], const uint32_t edge[2]) {
    const uint32_t *t = triangle;
    return (t[0] == edge[0] && t[1] == edge[1]) || (t[1] == edge[0] && t[2] == edge[1]) ||
           (t[2] == edge[0] && t[0] == edge[1]);
}

static inline bool triangle_contains(const uint32_t triangle[3], uint32_t vertex) {
    return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

static inline bool edges_share_vertex(const uint32_t a[2], const uint32_t b[2]) {
    return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
}
