/* Closed meshes with adjacency: their edges can be flipped, split and collapsed. */
#pragma once

#include "models/shapes/body.h"

/* Half-edge h is the edge from corner h of the triangle h / 3 to the next corner; half-edges are numbered
 * by the position of their origin in body.triangles. Dead triangles and vertices stay until surface_close. */
typedef struct surface {
    body mesh;
    uint32_t *twins; /* per half-edge, the one in the other direction */
    uint32_t *out;   /* per vertex, one half-edge from there; UINT32_MAX: dead */
    uint32_t live_triangles;
    uint32_t twin_capacity, out_capacity;
} surface;

static inline uint32_t half_edge_next(uint32_t h) {
    return h % 3 == 2 ? h - 2 : h + 1;
}

static inline uint32_t half_edge_previous(uint32_t h) {
    return h % 3 == 0 ? h + 2 : h - 1;
}

static inline uint32_t half_edge_from(const surface *s, uint32_t h) {
    return s->mesh.triangles[h];
}

static inline uint32_t half_edge_to(const surface *s, uint32_t h) {
    return s->mesh.triangles[half_edge_next(h)];
}

/* Returns the next half-edge from the same vertex, clockwise. */
static inline uint32_t half_edge_turn(const surface *s, uint32_t h) {
    return half_edge_next(s->twins[h]);
}

static inline bool triangle_is_dead(const surface *s, uint32_t t) {
    return s->mesh.triangles[(size_t)t * 3] == UINT32_MAX;
}

/* Takes over the memory of a closed, oriented manifold; *mesh is {0} afterwards. */
void surface_open(surface *s, body *mesh);

/* Moves what is alive to *mesh and frees the rest. */
void surface_close(surface *s, body *mesh);

uint32_t surface_valence(const surface *s, uint32_t vertex);
double surface_squared_length(const surface *s, uint32_t h);

/* Computes the normal of a vertex from those of its triangles, weighted by area; it has length 1, or is
 * zero. */
void surface_normal(const surface *s, uint32_t vertex, double normal[3]);

/* Moves a vertex unless a triangle would turn over. */
bool surface_move(surface *s, uint32_t vertex, const double at[3]);

/* Flip and collapse change nothing and return false when the mesh would stop being a manifold or a
 * triangle would turn over (its normal by more than 60 degrees). A collapse joins both ends at a point. A
 * split always succeeds; the new vertex is the last one. */
bool surface_flip(surface *s, uint32_t h);
bool surface_collapse(surface *s, uint32_t h, const double at[3]);
void surface_split(surface *s, uint32_t h, const double at[3]);

/* Divides each triangle into four at the middles of its edges. */
void surface_quarter(surface *s);
