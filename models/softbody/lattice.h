/* A lattice of cubes around a closed surface: the lattice is simulated, and carries the surface along. */
#pragma once

#include <stdint.h>

typedef struct lattice {
    uint32_t node_count, cell_count, vertex_count;
    double *rest;               /* node_count * 3 */
    uint32_t (*cells)[8];       /* corners: the bits of 0 to 7 are x, y, z */
    uint32_t *parities;         /* per cell, 0 or 1, as on a chessboard */
    uint32_t *vertex_cells;     /* the cell that each vertex of the surface lies in */
    double (*vertex_shares)[8]; /* trilinear weights of that cell's corners, sum 1 */
    double spacing;
} lattice;

/* Makes the lattice of the cells, `spacing` wide, that the surface touches or encloses. Parts of the
 * surface that are nearer than spacing to each other share cells, and so stick together. lattice_free
 * releases it. */
lattice lattice_make(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                     uint32_t triangle_count, double spacing);
void lattice_free(lattice *l);

/* Computes the vertices of the surface, vertex_count * 3, from any places of the nodes. */
void lattice_place_vertices(const lattice *l, const double *nodes, double *positions);
void lattice_place_vertex(const lattice *l, const double *nodes, uint32_t vertex, double position[3]);
