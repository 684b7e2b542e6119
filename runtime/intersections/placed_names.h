/* Which vertices are one at one moment: those that seams unite, and that are at one place. */
#pragma once

#include "src/mesh/mesh.h"

/* A vertex that is not where the vertex of its name is. */
typedef struct parted_vertex {
    double x[3];
    uint32_t name, vertex;
} parted_vertex;

/* The memory of all calls; begins with nothing but the context set. */
typedef struct placed_names {
    cscd_context *context;
    uint32_t *names; /* per vertex, of the last call */
    parted_vertex *parted, *spare;
    size_t parted_capacity;
} placed_names;

void placed_names_free(placed_names *p);

/* *out: per vertex the smallest one of its seam that is at its place; NULL if there are no seams. It lives until the next
 * call, which is about the same mesh. names: per vertex the smallest one of its seam, or NULL. False: no memory. */
bool placed_names_find(placed_names *p, const cscd_mesh *mesh, const double *positions, const uint32_t *names,
                       const uint32_t **out);
