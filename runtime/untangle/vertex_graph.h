/* The vertices of a mesh as unknowns: their neighbours with the weights of a Laplacian, their masses, and regions of them. */
#pragma once

#include "src/mesh/mesh.h"

/* Made for one call from the positions that it is given. The vertices of a seam are one unknown, the first of them; all numbers of
 * the others are those of the first. */
typedef struct vertex_graph {
    cscd_context *context;
    const cscd_mesh *mesh;
    uint32_t *names; /* per vertex: the unknown */
    bool *fixed;     /* per vertex: it does not move */
    size_t *begins;  /* per vertex and one more: its range of the next two; empty unless it is an unknown */
    uint32_t *neighbours; /* unknowns, which may repeat at seams */
    /* All are divided by the square of a power of two near edge_length, so that energies are squares of lengths. */
    double *couplings;  /* of the edges there: halves of cotangents, clamped */
    double *areas;      /* a third of those of the triangles */
    double *masses;     /* areas, times the weight of the caller */
    double *coupled;    /* per unknown: the sum of its couplings */
    double edge_length; /* the mean */
} vertex_graph;

/* What a graph is made from. */
typedef struct graph_source {
    const double *positions;
    const double *rest;    /* for areas and couplings; NULL: the positions */
    const uint32_t *names; /* per vertex: the first of its seam; NULL: there are no seams */
    const double *weights; /* per vertex, INFINITY: fixed; NULL: 1 each */
    const bool *movable;   /* per vertex; NULL: all */
} graph_source;

/* OUT_OF_MEMORY. Vertices of obstacles and those without triangles are fixed, and so are those of a seam with them. */
cscd_status vertex_graph_make(vertex_graph *g, cscd_context *context, const cscd_mesh *mesh,
                              const graph_source *from);
void vertex_graph_free(vertex_graph *g);

#define NO_ROW UINT32_MAX

/* Some unknowns, which are the rows of a system, in the order in which they came. */
typedef struct vertex_region {
    uint32_t *rows;     /* per vertex: its row; NO_ROW */
    uint32_t *vertices; /* per row */
    uint32_t count;
} vertex_region;

bool vertex_region_make(vertex_region *r, const vertex_graph *g);
void vertex_region_free(vertex_region *r, cscd_context *context);
void vertex_region_clear(vertex_region *r);

/* Adds the unknown of a vertex, unless it is fixed or there. */
void vertex_region_add(vertex_region *r, const vertex_graph *g, uint32_t vertex);

/* Adds neighbours, and so on, this many times. */
void vertex_region_grow(vertex_region *r, const vertex_graph *g, uint32_t rings);

/* The row of a vertex's unknown. */
static inline uint32_t vertex_region_row(const vertex_region *r, const vertex_graph *g, uint32_t vertex) {
    return r->rows[g->names[vertex]];
}
