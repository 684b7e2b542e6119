/* A mesh: the triangles of one object or of a scene of several, which never change, and what follows from
 * them: edges, components, neighbours. It holds no positions. Part of cscd/cscd.h, which says what holds
 * for every function. */
#ifndef CSCD_MESH_API_H
#define CSCD_MESH_API_H

#include <cscd/view.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The connectivity of one object or of a scene. */
typedef struct cscd_mesh cscd_mesh;

/* An object of a mesh. Set members that you do not need to 0. */
typedef struct cscd_object_desc {
    uint32_t vertex_count;     /* 1 or more, below 2^32 - 1 */
    uint32_t triangle_count;   /* 1 or more, at most (2^32 - 1) / 3 */
    const uint32_t *triangles; /* triangle_count * 3 indices of the object's own vertices, from 0 on,
                                * counter-clockwise from outside */
    bool obstacle;             /* the caller moves it: pairs within it, and pairs with other obstacles, are
                                * not looked at, neither for contacts nor for intersections nor for proximity */
    uint8_t reserved[7];       /* 0 */
} cscd_object_desc;

/* Describes a moving object of triangles; all other members are 0. */
static inline cscd_object_desc cscd_object_of_triangles(uint32_t vertex_count, uint32_t triangle_count,
                                                        const uint32_t *triangles) {
    cscd_object_desc desc = {vertex_count, triangle_count, triangles, false, {0}};
    return desc;
}

/* Creates a mesh of object_count objects, 1 or more. Vertices, edges and triangles are numbered object by
 * object, in the given order. Vertices without a triangle are allowed and take no part in contacts. Open,
 * non-manifold and inconsistently oriented surfaces are allowed, too; they cost culling only (see
 * cscd_component). INVALID_MESH: the sentence names object and triangle. */
CSCD_API cscd_status cscd_mesh_create_sized(cscd_context *context, const cscd_object_desc *objects,
                                            size_t object_size, uint32_t object_count, cscd_mesh **out);
static inline cscd_status cscd_mesh_create(cscd_context *context, const cscd_object_desc *objects,
                                           uint32_t object_count, cscd_mesh **out) {
    return cscd_mesh_create_sized(context, objects, sizeof *objects, object_count, out);
}

/* Gives the mesh back. Objects that were made from it keep it. */
CSCD_API void cscd_mesh_destroy(cscd_mesh *mesh);

/* The context that the mesh was created in. */
CSCD_API cscd_context *cscd_mesh_context(const cscd_mesh *mesh);

/* ---- its objects --------------------------------------------------------------------------------------- */

/* Where an object's features lie in the numbering of the mesh. Subtract the first index to have the
 * object's own. */
typedef struct cscd_object {
    bool obstacle;
    uint32_t first_vertex, vertex_count;
    uint32_t first_edge, edge_count;
    uint32_t first_triangle, triangle_count;
} cscd_object;

/* The number of objects. */
CSCD_API uint32_t cscd_mesh_object_count(const cscd_mesh *mesh);

/* An object, by its place among those given to cscd_mesh_create. */
CSCD_API void cscd_mesh_object_sized(const cscd_mesh *mesh, uint32_t object, cscd_object *out, size_t size);
static inline cscd_object cscd_mesh_object(const cscd_mesh *mesh, uint32_t object) {
    cscd_object found;
    cscd_mesh_object_sized(mesh, object, &found, sizeof found);
    return found;
}

/* The object that a vertex belongs to. */
CSCD_API uint32_t cscd_mesh_vertex_object(const cscd_mesh *mesh, uint32_t vertex);

/* ---- its features ------------------------------------------------------------------------------------ */

/* The number of vertices of all objects, those without a triangle included. */
CSCD_API uint32_t cscd_mesh_vertex_count(const cscd_mesh *mesh);

/* The number of triangles of all objects. */
CSCD_API uint32_t cscd_mesh_triangle_count(const cscd_mesh *mesh);

/* Writes the three vertices of a triangle, in the given order. */
CSCD_API void cscd_mesh_triangle(const cscd_mesh *mesh, uint32_t triangle, uint32_t vertices[3]);

/* The number of edges. They are numbered in the order of (smaller vertex, larger vertex); an edge of
 * several triangles is one edge. */
CSCD_API uint32_t cscd_mesh_edge_count(const cscd_mesh *mesh);

/* Writes the two vertices of an edge, the smaller one first. */
CSCD_API void cscd_mesh_edge(const cscd_mesh *mesh, uint32_t edge, uint32_t vertices[2]);

/* Writes the three edges of a triangle: from its vertex 0 to 1, from 1 to 2, from 2 to 0. */
CSCD_API void cscd_mesh_triangle_edges(const cscd_mesh *mesh, uint32_t triangle, uint32_t edges[3]);

/* The same of all features at once: three vertices of each triangle, two of each edge, three edges of each
 * triangle, one after the other. The arrays belong to the mesh and live as long. */
CSCD_API const uint32_t *cscd_mesh_all_triangles(const cscd_mesh *mesh);
CSCD_API const uint32_t *cscd_mesh_all_edges(const cscd_mesh *mesh);
CSCD_API const uint32_t *cscd_mesh_all_triangle_edges(const cscd_mesh *mesh);

/* The triangles that contain a vertex or an edge, in ascending order; their number is written to *count.
 * The array belongs to the mesh and lives as long. */
CSCD_API const uint32_t *cscd_mesh_vertex_triangles(const cscd_mesh *mesh, uint32_t vertex, uint32_t *count);
CSCD_API const uint32_t *cscd_mesh_edge_triangles(const cscd_mesh *mesh, uint32_t edge, uint32_t *count);

/* A component: all triangles that can be reached from one of them over common vertices, so it lies in one
 * object. Components are numbered in the order of their first triangles. Only components that are closed
 * manifolds are culled. */
typedef struct cscd_component {
    bool closed_manifold; /* closed, manifold and consistently oriented */
    uint32_t vertex_count, edge_count, triangle_count;
    uint32_t open_edges;            /* edges of one triangle only */
    uint32_t non_manifold_edges;    /* edges of three triangles or more */
    uint32_t non_manifold_vertices; /* vertices whose triangles do not form one fan */
    uint32_t inconsistent_edges;    /* edges whose two triangles run through them in the same direction */
    uint32_t first_open_edge;       /* an example of each defect, UINT32_MAX if there is none */
    uint32_t first_non_manifold_edge;
    uint32_t first_non_manifold_vertex;
    uint32_t first_inconsistent_edge;
    int64_t euler_characteristic; /* V - E + F; a closed oriented component has genus 1 - euler / 2 */
} cscd_component;

/* The number of components. */
CSCD_API uint32_t cscd_mesh_component_count(const cscd_mesh *mesh);

/* A component, its counts and its defects. */
CSCD_API void cscd_mesh_component_sized(const cscd_mesh *mesh, uint32_t component, cscd_component *out,
                                        size_t size);
static inline cscd_component cscd_mesh_component(const cscd_mesh *mesh, uint32_t component) {
    cscd_component found;
    cscd_mesh_component_sized(mesh, component, &found, sizeof found);
    return found;
}

/* The component that a triangle belongs to. */
CSCD_API uint32_t cscd_mesh_triangle_component(const cscd_mesh *mesh, uint32_t triangle);

/* A hash of the vertex count and of the triangles in their order. A plan that was saved fits a mesh with
 * the same hash. */
CSCD_API uint64_t cscd_mesh_hash(const cscd_mesh *mesh);

#ifdef __cplusplus
}
#endif

#endif
