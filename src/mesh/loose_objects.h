/* Objects of a mesh that are not of triangles: wires, points and half-spaces. */
#pragma once

#include "src/core/context.h"

/* Wires are edges whose stars are empty, among the other edges. Behind the last edge the array of edges goes on with
 * one for each vertex of an object of points, in their order: it joins the vertex with itself. So a point and a wire, or
 * two points, are two edges for every elementary test. */
typedef struct loose_objects {
    uint32_t wire_count, point_count, half_space_count;

    /* The wires at a vertex, as vertex_stars has its triangles; NULL: there are none. */
    uint32_t *wire_star_offsets, *wire_stars;

    double (*normals)[3]; /* per object, of half-spaces; NULL: there are none */
} loose_objects;

/* What descriptions ask for together. */
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
