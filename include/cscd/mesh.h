/* A mesh: the triangles of one object or of a scene of several, which never change, and what follows from
 * them: edges, components, neighbours. Objects may also be wires, points or half-spaces. It holds no
 * positions. Part of cscd/cscd.h, which says what holds for every function. */
#ifndef CSCD_MESH_API_H
#define CSCD_MESH_API_H

#include <cscd/view.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The connectivity of one object or of a scene. */
typedef struct cscd_mesh cscd_mesh;

/* What an object is made of. Later versions may add values. Objects that are not of triangles are *loose*: their
 * features belong to no triangle, and no component. */
typedef enum cscd_object_kind {
    CSCD_OBJECT_TRIANGLES,
    CSCD_OBJECT_WIRES,      /* segments between its vertices, as of hair: edges of the mesh. A vertex that
                             * no wire has takes no part in contacts */
    CSCD_OBJECT_POINTS,     /* its vertices, as of particles; spheres with a thickness (cscd_object_rule) */
    CSCD_OBJECT_HALF_SPACE, /* all that is behind a plane, as the ground. Its one vertex is a point of the
                             * plane and moves as others do; its normal never changes */
    CSCD_OBJECT_KIND_MAX_ENUM = 0x7fffffff
} cscd_object_kind;

/* An object of a mesh. Set members that you do not need to 0. */
typedef struct cscd_object_desc {
    uint32_t vertex_count;     /* 1 or more, below 2^32 - 1; of a half-space 1, of all points at most 2^26 */
    uint32_t triangle_count;   /* 1 or more, at most (2^32 - 1) / 3; 0 unless it is of triangles */
    const uint32_t *triangles; /* triangle_count * 3 indices of the object's own vertices, from 0 on,
                                * counter-clockwise from outside */
    bool obstacle;             /* the caller moves it: pairs within it, and pairs with other obstacles, are
                                * not looked at, neither for contacts nor for intersections nor for proximity */
    uint8_t reserved[7];       /* 0 */
    cscd_object_kind kind;
    uint32_t wire_count;   /* of wires: 1 or more; else 0 */
    const uint32_t *wires; /* wire_count * 2 indices of the object's own vertices; twins count as one */
    double normal[3];      /* of a half-space: out of it, of any length but 0; else 0 */
} cscd_object_desc;

/* Describes a moving object of triangles; all other members are 0. */
static inline cscd_object_desc cscd_object_of_triangles(uint32_t vertex_count, uint32_t triangle_count,
                                                        const uint32_t *triangles) {
    cscd_object_desc desc = {vertex_count, triangle_count, triangles, false, {0}, CSCD_OBJECT_TRIANGLES, 0,
                             NULL,         {0.0, 0.0, 0.0}};
    return desc;
}

/* The same of wires, */
static inline cscd_object_desc cscd_object_of_wires(uint32_t vertex_count, uint32_t wire_count,
                                                    const uint32_t *wires) {
    cscd_object_desc desc = {vertex_count,      0,          NULL,  false,          {0},
                             CSCD_OBJECT_WIRES, wire_count, wires, {0.0, 0.0, 0.0}};
    return desc;
}

/* of points, */
static inline cscd_object_desc cscd_object_of_points(uint32_t vertex_count) {
    cscd_object_desc desc = {vertex_count, 0, NULL, false, {0}, CSCD_OBJECT_POINTS, 0, NULL, {0.0, 0.0, 0.0}};
    return desc;
}

/* and of a half-space. */
static inline cscd_object_desc cscd_object_half_space(const double normal[3]) {
    cscd_object_desc desc = {
        1, 0, NULL, false, {0}, CSCD_OBJECT_HALF_SPACE, 0, NULL, {normal[0], normal[1], normal[2]}};
    return desc;
}

/* Creates a mesh of object_count objects, 1 or more, of any kinds. Vertices, edges and triangles are numbered
 * object by object, in the given order. Vertices without a triangle are allowed and, unless they are loose, take
 * no part in contacts. Open, non-manifold and inconsistently oriented surfaces are allowed, too; they cost culling
 * only (see cscd_component). INVALID_MESH: the sentence names object and triangle.
 *
 * Loose objects take part in everything that a detector does, but the static check, which is about triangles:
 *   points     against triangles (VF), exactly; against points (VV) and wires (EV) only where these have to keep a
 *              distance, since a point that moves meets no other one exactly
 *   wires      against triangles (VF, EE) and wires (EE), exactly
 *   half-space every vertex of another object that takes part in contacts (VH), exactly. A vertex that is behind the
 *              plane is in contact. Two half-spaces have nothing to do with each other
 * With a distance (min_separation, thickness) all of them keep it. An example, rain on a roof above the ground:
 *
 *     const double up[3] = {0, 0, 1};
 *     cscd_object_desc objects[3] = {cscd_object_of_triangles(vertex_count, triangle_count, roof),
 *                                    cscd_object_of_points(1000), cscd_object_half_space(up)};
 *     objects[2].obstacle = true;
 *     cscd_mesh_create(context, objects, 3, &mesh); // positions: roof, drops, and one point of the ground
 */
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
    cscd_object_kind kind;
    uint32_t first_vertex, vertex_count;
    uint32_t first_edge, edge_count;
    uint32_t first_triangle, triangle_count;
} cscd_object;

/* The number of objects. */
CSCD_API uint32_t cscd_mesh_object_count(const cscd_mesh *mesh);

/* An object, by its place among those given to cscd_mesh_create. */
CSCD_API cscd_object cscd_mesh_object(const cscd_mesh *mesh, uint32_t object);

/* The object that a vertex belongs to. */
CSCD_API uint32_t cscd_mesh_vertex_object(const cscd_mesh *mesh, uint32_t vertex);

/* ---- its features ------------------------------------------------------------------------------------ */

/* The number of vertices of all objects, those without a triangle included, and points of half-spaces. */
CSCD_API uint32_t cscd_mesh_vertex_count(const cscd_mesh *mesh);

/* The number of triangles of all objects. */
CSCD_API uint32_t cscd_mesh_triangle_count(const cscd_mesh *mesh);

/* Writes the three vertices of a triangle, in the given order. */
CSCD_API void cscd_mesh_triangle(const cscd_mesh *mesh, uint32_t triangle, uint32_t vertices[3]);

/* The number of edges, wires among them. They are numbered in the order of (smaller vertex, larger vertex); an
 * edge of several triangles is one edge. */
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

/* The triangles that contain a vertex or an edge, in ascending order; their number, 0 for loose ones, is written
 * to *count. The array belongs to the mesh and lives as long. */
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
CSCD_API cscd_component cscd_mesh_component(const cscd_mesh *mesh, uint32_t component);

/* The component that a triangle belongs to. */
CSCD_API uint32_t cscd_mesh_triangle_component(const cscd_mesh *mesh, uint32_t triangle);

/* A hash of the vertex count and of the triangles in their order, and of all objects where some are loose. A plan
 * that was saved fits a mesh with the same hash. */
CSCD_API uint64_t cscd_mesh_hash(const cscd_mesh *mesh);

#ifdef __cplusplus
}
#endif

#endif
