/* Tiles: small connected pieces of a component, of which regions are put together. */
#pragma once

#include "preprocess/regions/dual_graph.h"
#include "preprocess/regions/min_cut.h"

/* About so many tiles a component has; smaller ones have a tile for each triangle. */
enum { TILES_WANTED = 3000 };

/* Frames of a motion that are looked at besides the rest. */
enum { FRAMES_MOST = 8 };

/* Lengths are scaled by a power of two so that the component's extent lies in [1/2, 1), about the middle of its box. Normals point
 * outwards, also where the component is inside out. */
typedef struct tile {
    double centroid[3], area;
    double normal[3]; /* the sum of its triangles' normals, each as long as its area */
    double height;    /* the sum of p . n over its triangles: height - d . normal is the sum of (p - d) . n */
} tile;

typedef struct tile_graph {
    cscd_context *context;
    uint32_t count;
    tile *items; /* at rest */
    tile *moved; /* in frame f tile t is moved[f * count + t]; areas of items count, there and here */
    uint32_t frame_count; /* besides the rest */
    double area;          /* of all */
    double *stiffness;    /* of tiles, as shares; NULL: no tile is softer than the component */
    bool turned;          /* the component is inside out */

    /* Tiles with an edge in common are linked: flow.link_count links. */
    flow_graph flow;
    uint32_t *offsets, *neighbours, *twins;
    double *weights; /* of links: the sum of those of the edges, scaled */
} tile_graph;

/* The surface of a mesh, with the weights of its edges: lengths, less where cuts should run. */
typedef struct tile_surface {
    const cscd_mesh *mesh;
    const double *positions, *weights;
    const dual_graph *graph;
    const double *const *frames; /* positions in frames besides the rest, FRAMES_MOST at most */
    uint32_t frame_count;
    const double
        *stiffness; /* of triangles, as shares of that of their component (stiffness.h); NULL: all are 1 */
} tile_surface;

/* The triangles of a component, ascending. */
typedef struct tile_component {
    const uint32_t *list;
    uint32_t count;
    double middle[3], scale; /* scaled = (p - middle) * scale */
    double area;             /* scaled */
    double side;             /* of the grid's cells, scaled: a tile lies in one; 0: a tile is a triangle */
    double least_side;       /* from which on a cell has about one triangle */
} tile_component;

tile_component tiles_component(const tile_surface *surface, const uint32_t *list, uint32_t count);

/* Numbers the first tiles; returns how many there are. tile_of and scratch have room for each triangle of the mesh. */
uint32_t tiles_number(const tile_surface *surface, tile_component *component, uint32_t *tile_of,
                      uint32_t *scratch);

/* Halves the side of the cells, and with it the tiles that are marked; returns how many there are. */
uint32_t tiles_halve(const tile_surface *surface, tile_component *component, const bool *marked,
                     uint32_t *tile_of, uint32_t *scratch);

/* Makes the graph of the tiles as they are numbered. */
cscd_status tiles_create(const tile_surface *surface, const tile_component *component,
                         const uint32_t *tile_of, uint32_t tile_count, tile_graph *out);
void tiles_destroy(tile_graph *g);
