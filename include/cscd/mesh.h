/* A mesh: connectivity that never changes. Part of cscd/cscd.h, which says what holds for every function. */
#ifndef CSCD_MESH_API_H
#define CSCD_MESH_API_H

#include <cscd/context.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cscd_mesh cscd_mesh;

typedef struct cscd_mesh_desc {
    uint32_t vertex_count;     /* 1 or more, below 2^32 - 1 */
    uint32_t triangle_count;   /* 1 or more, at most (2^32 - 1) / 3 */
    const uint32_t *triangles; /* triangle_count * 3 vertex indices, counter-clockwise from outside */
} cscd_mesh_desc;

/* Vertices without a triangle are allowed and take no part in collisions. Open, non-manifold and
 * inconsistently oriented meshes are allowed: see cscd_component. INVALID_MESH names the triangle. */
CSCD_API cscd_status cscd_mesh_create(cscd_context *context, const cscd_mesh_desc *desc, cscd_mesh **out);
CSCD_API void cscd_mesh_destroy(cscd_mesh *mesh);

/* ---- several meshes as one scene --------------------------------------------------------------------- */

typedef struct cscd_object_desc {
    cscd_mesh_desc mesh; /* triangles name the object's own vertices, from 0 on */
    bool obstacle;       /* moves as the caller says: contacts, crossings and proximity of its features with
                          * each other, and with other obstacles, are not looked for */
} cscd_object_desc;

/* In the scene the vertices, edges and triangles of an object follow those of the object before. */
CSCD_API cscd_status cscd_mesh_create_scene(cscd_context *context, const cscd_object_desc *objects,
                                            uint32_t object_count, cscd_mesh **out);

/* Where an object's features lie in the scene's numbering: subtract the first to have its own. */
typedef struct cscd_object {
    uint32_t first_vertex, vertex_count;
    uint32_t first_edge, edge_count;
    uint32_t first_triangle, triangle_count;
    bool obstacle;
} cscd_object;

/* 1 for a mesh of cscd_mesh_create. */
CSCD_API uint32_t cscd_mesh_object_count(const cscd_mesh *mesh);

/* Objects are numbered as given; object < object_count. */
CSCD_API cscd_object cscd_mesh_object(const cscd_mesh *mesh, uint32_t object);

/* The object of a vertex; vertex < vertex_count. */
CSCD_API uint32_t cscd_mesh_vertex_object(const cscd_mesh *mesh, uint32_t vertex);

/* ---- its features ------------------------------------------------------------------------------------ */

CSCD_API uint32_t cscd_mesh_vertex_count(const cscd_mesh *mesh);
CSCD_API uint32_t cscd_mesh_triangle_count(const cscd_mesh *mesh);

/* The triangle's three vertices as given; triangle < triangle_count. */
CSCD_API void cscd_mesh_triangle(const cscd_mesh *mesh, uint32_t triangle, uint32_t vertices[3]);

/* Edges are numbered in the order of (smaller vertex, larger vertex), each once. */
CSCD_API uint32_t cscd_mesh_edge_count(const cscd_mesh *mesh);

/* The edge's vertices, the smaller one first; edge < edge_count. */
CSCD_API void cscd_mesh_edge(const cscd_mesh *mesh, uint32_t edge, uint32_t vertices[2]);

/* The triangle's edges: from its vertex 0 to 1, 1 to 2, 2 to 0. */
CSCD_API void cscd_mesh_triangle_edges(const cscd_mesh *mesh, uint32_t triangle, uint32_t edges[3]);

/* The triangles that contain a vertex or an edge, ascending, *count of them. They live as long as the mesh.
 */
CSCD_API const uint32_t *cscd_mesh_vertex_triangles(const cscd_mesh *mesh, uint32_t vertex, uint32_t *count);
CSCD_API const uint32_t *cscd_mesh_edge_triangles(const cscd_mesh *mesh, uint32_t edge, uint32_t *count);

/* A component: triangles connected through shared vertices, so it lies in one object. Numbered by their first
 * triangle. */
typedef struct cscd_component {
    uint32_t vertex_count, edge_count, triangle_count;
    uint32_t open_edges;            /* in one triangle only */
    uint32_t non_manifold_edges;    /* in three triangles or more */
    uint32_t non_manifold_vertices; /* their triangles do not form one fan (bow-tie) */
    uint32_t inconsistent_edges;    /* traversed in the same direction by their two triangles */
    uint32_t first_open_edge;       /* an example of each, UINT32_MAX if there is none */
    uint32_t first_non_manifold_edge;
    uint32_t first_non_manifold_vertex;
    uint32_t first_inconsistent_edge;
    int64_t euler_characteristic; /* V - E + F; a closed oriented component has genus 1 - euler / 2 */
    bool closed_manifold;         /* closed, manifold and consistently oriented */
} cscd_component;

CSCD_API uint32_t cscd_mesh_component_count(const cscd_mesh *mesh);
CSCD_API cscd_component cscd_mesh_component(const cscd_mesh *mesh, uint32_t component);

/* The component of a triangle; triangle < triangle_count. */
CSCD_API uint32_t cscd_mesh_triangle_component(const cscd_mesh *mesh, uint32_t triangle);

/* A hash of the vertex count and the triangles in their order, not of positions: plans fit where it is equal.
 */
CSCD_API uint64_t cscd_mesh_hash(const cscd_mesh *mesh);

/* ---- positions as a solver has them ------------------------------------------------------------------ */

typedef enum cscd_scalar { CSCD_SCALAR_DOUBLE, CSCD_SCALAR_FLOAT } cscd_scalar;

/* Vertex i has its x at byte i * stride, y and z each coordinate_stride bytes further on. Aligned or not. */
typedef struct cscd_view {
    const void *data;
    cscd_scalar scalar;
    size_t stride;            /* 0: three scalars; of a matrix whose columns are x, y, z: one scalar, */
    size_t coordinate_stride; /* and a column's size in bytes here; 0: one scalar */
} cscd_view;

/* Copies positions in any layout, one view per object (a mesh of cscd_mesh_create is one object), to the
 * packed doubles that all other functions take: vertex_count * 3 of them. Floats are widened, which is exact.
 */
CSCD_API cscd_status cscd_mesh_pack(const cscd_mesh *mesh, const cscd_view *views, double *positions);

#ifdef __cplusplus
}
#endif

#endif
