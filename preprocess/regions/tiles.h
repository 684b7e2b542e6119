/* Tiles, small connected pieces of a component, of which regions are put together; and what is found of tiles: cuts, what a point
 * sees of them, and how soft the material between them is. */
#pragma once

#include "preprocess/regions/regions.h"

#include <math.h>

/* ---- the dual graph ------------------------------------------------------------------------------------ */

#define DUAL_NO_EDGE UINT32_MAX

/* Link i of triangle t lies in [offsets[t], offsets[t + 1]). The triangles of one edge are joined in a chain,
 * in their order. If patches of one component meet at a vertex only, one link without an edge joins them, so
 * that each component is connected. */
typedef struct dual_graph {
    uint32_t triangle_count, link_count; /* each link counts twice, once from either end */
    uint32_t *offsets, *neighbours;
    uint32_t *edges; /* of the mesh; DUAL_NO_EDGE */
} dual_graph;

cscd_status dual_graph_build(const cscd_mesh *mesh, dual_graph *out);
void dual_graph_free(const cscd_mesh *mesh, dual_graph *graph);

/* Numbers the connected pieces of equal label from 0, in the order of the list, which is ascending and
 * holds whole components.
 * labels may be the same array as pieces; scratch has room for every triangle of the mesh. */
uint32_t dual_graph_pieces(const dual_graph *graph, const uint32_t *list, uint32_t count,
                           const uint32_t *labels, uint32_t *pieces, uint32_t *scratch);

/* ---- minimum cuts -------------------------------------------------------------------------------------- */

/* A minimum cut of a graph whose nodes have supplies and drains is found by maximum flow (Dinic 1970). */

/* Link i of node n lies in [offsets[n], offsets[n + 1]); twins[i] is the same link from its other end. */
typedef struct flow_graph {
    uint32_t node_count, link_count;
    const uint32_t *offsets, *neighbours, *twins;
} flow_graph;

/* Room for many cuts. Before each the caller sets residuals, supplies and drains: of the nodes of the cut and of their links. Links
 * out of these nodes have a residual of 0. */
typedef struct min_cut {
    cscd_context *context;
    flow_graph graph;
    int64_t *residuals;         /* of a link: what it carries from here to its neighbour */
    int64_t *supplies, *drains; /* of a node */
    uint32_t *levels, *current; /* steps from the supplies; the next link to try */
    uint32_t *queue, *path;     /* nodes; links */
    int64_t cost;               /* of the last cut */
} min_cut;

cscd_status min_cut_create(cscd_context *context, const flow_graph *graph, min_cut *out);
void min_cut_destroy(min_cut *c);

/* Separates all supplies from all drains of the nodes at the least cost. The first nodes of the queue, as many as the result
 * says, stay with the supplies: of all such cuts this is the one with the fewest of them. Capacities are integers, so the flow is
 * exact and the same on every machine. */
uint32_t min_cut_run(min_cut *c, const uint32_t *nodes, uint32_t node_count);

/* ---- tiles --------------------------------------------------------------------------------------------- */

/* About how many tiles a component has; smaller ones have a tile for each triangle. */
enum { TILES_WANTED = 3000 };

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

/* Finds what it costs to cut along each edge: its length, and less where the charge is low or the material soft. equalized: of each triangle; stiffness_shares: likewise, or NULL. */
void weigh_edges(const cscd_mesh *mesh, const double *positions, const double *equalized,
                 const double *stiffness_shares, const region_options *options, double *weights);

/* The surface of a mesh, with the weights of its edges: lengths, less where cuts should run. */
typedef struct tile_surface {
    const cscd_mesh *mesh;
    const double *positions, *weights;
    const dual_graph *graph;
    const double *const *frames; /* positions in frames besides the rest, FRAMES_MOST at most */
    uint32_t frame_count;
    const double *stiffness; /* of triangles, as shares of that of their component; NULL: all are 1 */
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

/* ---- sight --------------------------------------------------------------------------------------------- */

/* The sine of the angle between a triangle and the line of sight from which on it counts as seen well (17 degrees): what is seen at
 * a lower angle turns away at the first deformation. */
#define SEEN_WELL_SINE 0.25

/* The blindness for what is seen edge-on; for what is turned away it is 1. */
#define GRAZING_BLINDNESS 0.7

/* A point of a region at rest, and where it is in further frames: it moves with the centroid of the region's surface. */
typedef struct sight_point {
    double rest[3], moved[FRAMES_MOST][3];
} sight_point;

static inline double frame_blindness(const tile *t, const double point[3]) {
    const double away[3] = {t->centroid[0] - point[0], t->centroid[1] - point[1], t->centroid[2] - point[2]};
    const double value =
        t->height - (t->normal[0] * point[0] + t->normal[1] * point[1] + t->normal[2] * point[2]);
    if (!(value > 0.0)) return 1.0;
    const double distance = sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
    const double well = SEEN_WELL_SINE * t->area * distance;
    return value < well ? GRAZING_BLINDNESS * (1.0 - value / well) : 0.0;
}

/* From 0, the point sees the tile well, to 1, it does not see it: the mean of the rest and all frames. */
static inline double tile_blindness(const tile_graph *g, uint32_t t, const sight_point *point) {
    double sum = frame_blindness(&g->items[t], point->rest);
    for (uint32_t f = 0; f < g->frame_count; f++)
        sum += frame_blindness(&g->moved[(size_t)f * g->count + t], point->moved[f]);
    return sum / (1.0 + g->frame_count);
}

typedef struct tile_set {
    const tile_graph *g;
    const uint32_t *members;
    uint32_t count;
} tile_set;

/* The sum of blindness times area. */
double tiles_unseen(const tile_set *set, const sight_point *point);

/* The tile of a set, not empty, whose centroid is nearest to a point at rest. */
uint32_t tiles_nearest(const tile_set *set, const double point[3]);

void tiles_centroid(const tile_set *set, sight_point *out);

/* Moves the point, given at rest, to where it costs the least: what it does not see, and a little for each step away from the
 * centroid, because the centroid stays in the middle of the set however that turns and bends. It goes along the axes, by steps
 * that become smaller. Returns the cost. */
double tiles_best_point(const tile_set *set, sight_point *point);

/* ---- stiffness ----------------------------------------------------------------------------------------- */

/* Finds the stiffness of each triangle as a share of that of its component, in (0, 1]. A component is as stiff as the least stiff
 * half of its area at most is, so a small part that is stiffer than the rest makes nothing soft. given: of each triangle, positive
 * and finite. Shares are rounded to 24 bits, so that the unit does not matter, and are never less than 1e-6. */
cscd_status stiffness_shares(const cscd_mesh *mesh, const double *positions, const double *given,
                             double *shares);

/* Returns the mean of the shares of the triangles at an edge; exactly 1 if all of them are 1. */
double stiffness_beside(const cscd_mesh *mesh, const double *shares, uint32_t edge);

/* The blindness for what lies far beyond soft material. More makes more regions than pay. */
#define BEYOND_BLINDNESS 0.3

/* Returns the blindness that a step through material of these shares adds: for one share s, 1 / s - 1 times
 * its length, in roots of the component's area. Two places are like two springs, one behind the other. */
static inline double soft_step(double share_a, double share_b, double length) {
    return (0.5 * (1.0 / share_a + 1.0 / share_b) - 1.0) * length;
}

/* ---- ways through soft material ------------------------------------------------------------------------ */

/* Sight weakens on the way through soft material: what lies beyond a soft place turns away from a point on this side of it at the
 * first deformation, so it counts as seen badly. */

/* Rows of the least blindness of all tiles, each for a seat: a tile that the way begins at. */
typedef struct soft_paths {
    const tile_graph *g;
    uint32_t row_count;
    double *steps;   /* of links */
    double *rows;    /* g->count each; NULL: nothing is soft, and the blindness is 0 */
    uint32_t *seats; /* of rows */
    uint32_t *queue; /* tiles: a ring */
    bool *in_queue;  /* in the queue */
} soft_paths;

/* Rows have no seats yet. */
cscd_status soft_paths_create(const tile_graph *g, uint32_t row_count, soft_paths *out);
void soft_paths_destroy(soft_paths *p);

/* Makes the row one of that seat. */
void soft_paths_set(soft_paths *p, uint32_t row, uint32_t seat);

/* The blindness of a tile that has this blindness by sight alone. */
static inline double soft_paths_blindness(const soft_paths *p, uint32_t row, uint32_t t, double by_sight) {
    return p->rows != NULL ? fmax(by_sight, p->rows[(size_t)row * p->g->count + t]) : by_sight;
}

/* The sum of area times blindness, beyond what the point does not see by sight alone. */
double soft_paths_unseen(const soft_paths *p, uint32_t row, const tile_set *set, const sight_point *point);

/* ---- detector points ----------------------------------------------------------------------------------- */

/* Some regions, numbered from first on, and all their triangles. */
typedef struct region_scene {
    const cscd_mesh *mesh;
    const double *positions; /* at rest */
    const uint32_t *list;    /* of triangles; NULL: all of the mesh */
    uint32_t count;
    const uint32_t *of_triangle; /* the region of each triangle of the mesh */
    uint32_t first, region_count;
    const double (*points)[3]; /* region_count detector points at rest */
} region_scene;

/* The motion of a region's point: way is the sum of its triangles' ways, weighted by their areas at rest. */
typedef struct region_way {
    double way[3], area;
} region_way;

/* Finds where the points are in a frame; ways: room for region_count. */
void region_points_move(const region_scene *scene, const double *frame, region_way *ways, double (*out)[3]);

/* The triangle number i of the list. */
static inline uint32_t region_scene_triangle(const region_scene *scene, uint32_t i) {
    return scene->list != NULL ? scene->list[i] : i;
}

/* Finds the blindness of each triangle for what lies between it and the point of its region: 0 where the way within
 * the region is stiff. It begins at the triangle that is nearest to the point; what no way leads to counts as far beyond. stiffness:
 * of each triangle, positive and finite. The scene holds all triangles of the mesh. */
cscd_status soft_ways_find(const region_scene *scene, const double *stiffness, double *ways);

/* (p0 - d) . n of one triangle and the point d: positive where the point sees its inner side. */
double orientation_value(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                         const double point[3]);
