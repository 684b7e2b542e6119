/* The parts of the published cuts (Yeh 2012, section 3.3): clusters, the cutting list that grows and shrinks, and contours. */
#pragma once

#include "preprocess/baselines/baselines.h"

/* ---- clusters ------------------------------------------------------------------------------------------ */

/* Triangles of low charge that are joined by edges. */

/* Cluster i is triangles[offsets[i] .. offsets[i + 1]); clusters are in the order of their first triangles. */
typedef struct clusters {
    uint32_t count;
    uint32_t *offsets, *triangles;
} clusters;

/* Finds the clusters of the triangles whose equalized density is below the threshold, in the components that are closed and no
 * obstacles. */
cscd_status clusters_find(const cscd_mesh *mesh, const double *equalized, double threshold, clusters *out);
void clusters_free(const cscd_mesh *mesh, clusters *found);

/* ---- the cutting list ---------------------------------------------------------------------------------- */

/* The cuttingList of the thesis (Yeh 2012, section 3.3): the triangles of a closed component in which a cut is sought, and the
 * contours that bound them. */

#define NO_CONTOUR UINT32_MAX

/* Side i of a triangle is its edge i, as in mesh->triangle_edges. Arrays are over the mesh; one list follows another in them. */
typedef struct cutting_list {
    const cscd_mesh *mesh;
    uint32_t count, *triangles;   /* those of the list, in the order in which they came in */
    bool *listed;                 /* per triangle: it is in the list */
    uint32_t contour_count;       /* of the list, as it was traced last */
    uint32_t (*side_contours)[3]; /* per listed triangle and side: its contour, or NO_CONTOUR */
    uint32_t *ring;               /* the growingList: triangles around the list */
    uint32_t ring_count;
    uint32_t *stack; /* scratch, of as many triangles */
    bool *seen;      /* scratch, false between calls */
} cutting_list;

/* On failure *out holds nothing. */
cscd_status cutting_list_create(const cscd_mesh *mesh, cutting_list *out);
void cutting_list_destroy(cutting_list *c);

/* Makes the list that of a cluster, which is connected and lies in a closed component. */
void cutting_list_begin(cutting_list *c, const uint32_t *cluster, uint32_t count);

/* The triangle beyond a side; in a closed component there is exactly one. */
static inline uint32_t triangle_beyond(const cscd_mesh *mesh, uint32_t triangle, uint32_t side) {
    const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[mesh->triangle_edges[triangle][side]];
    return star[0] == triangle ? star[1] : star[0];
}

/* Returns the side of this triangle that is the edge. */
static inline uint32_t side_of_edge(const cscd_mesh *mesh, uint32_t triangle, uint32_t edge) {
    const uint32_t *edges = mesh->triangle_edges[triangle];
    return edges[0] == edge ? 0 : edges[1] == edge ? 1 : 2;
}

/* Adds the islands: pieces of the rest of the component that the list encloses and that have at most this many triangles. */
void cutting_list_fill(cutting_list *c, uint32_t most);

/* Traces the contours of the list: each is a closed walk along sides that have the list on one side alone. Sets contour_count and
 * side_contours. */
void cutting_list_trace(cutting_list *c);

/* Cluster-growing: adds the triangles around the list, ring by ring, until a ring falls in two. The ring that does is not added.
 * False: no ring ever did, and the list is the component. */
bool cutting_list_grow(cutting_list *c);

/* Cluster-shrinking: takes triangles away, beginning at the contours, until all that have a side on a contour are cutting
 * triangles, which have sides on two contours. The list has been traced, and has two contours or more. */
void cutting_list_shrink(cutting_list *c);

/* ---- contours ------------------------------------------------------------------------------------------ */

/* Closed walks along edges, smoothed: the contours between which a cut is chosen. */

/* Edges of a closed manifold component that form closed walks. */
typedef struct contour {
    const cscd_mesh *mesh;
    uint32_t count, *edges; /* its edges; while it is smoothed, also some that have left it */
    bool *on;               /* per edge: it is on the contour */
    bool *passed;           /* scratch, per triangle, false between calls */
    uint32_t *crossed;      /* scratch, per triangle */
} contour;

/* On failure *out holds nothing. */
cscd_status contour_create(const cscd_mesh *mesh, contour *out);
void contour_destroy(contour *c);

/* Empties the contour. */
void contour_clear(contour *c);

/* Adds an edge that is not on the contour yet. */
void contour_add(contour *c, uint32_t edge);

/* If two sides of a triangle are on the contour, the third one replaces them, which is shorter than both,
 * until no triangle has two. Each triangle is passed over once at most. */
void contour_smooth(contour *c);

/* The sum of the lengths of its edges. */
double contour_length(const contour *c, const double *positions);
