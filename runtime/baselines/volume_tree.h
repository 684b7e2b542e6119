/* Binary trees over the triangles of each region, whose leaves are single triangles (Yeh 2012, section 4.2), and volumes of five kinds
 * for their nodes. Only the volumes differ: they all share the nodes and the order of the search. */
#pragma once

#include "src/core/kernels.h"
#include "src/mesh/mesh.h"

/* The k-DOPs from the box on: each has the directions of the box; those of 26 are the ones of 14 and of 18. */
typedef enum volume_kind {
    VOLUME_SPHERE,
    VOLUME_BOX,
    VOLUME_KDOP14, /* axes and diagonals of the cube */
    VOLUME_KDOP18, /* axes and diagonals of its faces */
    VOLUME_KDOP26, /* all of these */
    VOLUME_KINDS
} volume_kind;

const char *volume_kind_name(volume_kind kind);

/* A k-DOP is a row of floats, the least coordinate along each of k directions that come in pairs of opposite ones, and
 * as many fillers as make the row a multiple of eight: 8, 16, 24 and 32 floats. A sphere has its centre and radius. */
enum { SPHERE_FLOATS = 4, VOLUME_FLOATS_MAX = 32 };

/* The floats of a volume of this kind. */
static inline size_t volume_floats(volume_kind kind) {
    return kind == VOLUME_SPHERE ? (size_t)SPHERE_FLOATS : (size_t)LANES * (size_t)kind;
}

/* Nodes stand before their children, the first child right behind its parent. */
typedef struct volume_node {
    uint32_t second;   /* the second child; 0: it is a leaf */
    uint32_t triangle; /* of a leaf */
    uint32_t region;   /* of all its triangles */
    uint8_t flags;     /* the orientations of all its triangles, joined by or: both bits for zero (4.5) */
    bool sealed;       /* no pair of its triangles is looked for */
} volume_node;

/* A tree for each region, one behind the other. */
typedef struct volume_tree {
    cscd_context *context;
    uint32_t vertex_count, triangle_count, root_count, node_count, depth;
    const uint32_t (*triangles)[3];
    volume_node *nodes;
    uint32_t *roots; /* per region */

    /* Per vertex: x y z 0 at the start, x y z 0 at the end, relative to the frame's origin. */
    float (*records)[LANES];

    float *vertex_volumes; /* of k-DOPs, of what a vertex covers in the interval */
    float *volumes;        /* of nodes */
} volume_tree;

/* From the top: the bounding 14-DOP of the triangles is halved in the middle of its longest axis, and triangles go to the half that
 * their centroid is in, until each leaf has one. Each region has a triangle. On failure *out holds nothing. */
cscd_status volume_tree_build(const cscd_mesh *mesh, const double *positions, const uint32_t *regions,
                              uint32_t region_count, volume_tree *out);
void volume_tree_free(volume_tree *t);

/* Takes over orientations of triangles, by which the search leaves out pairs as in culling; NULL: none are left out. */
void volume_tree_orient(volume_tree *t, const uint8_t *orientations);

/* The results of a search, in an order that is the same for all kinds except for what they leave out. */
typedef struct volume_search {
    cscd_context *context;
    uint32_t (*pairs)[2]; /* triangles whose volumes overlap, the smaller number first */
    size_t count, capacity;

    /* Per region: pairs of its triangles that share a vertex are listed; NULL: none are. */
    const bool *keeps_adjacent;

    uint64_t tests, adjacent; /* pairs of volumes; pairs that share a vertex, listed or not */
    uint32_t (*stack)[2];
    bool out_of_memory;
} volume_search;

/* On failure *out holds nothing. */
cscd_status volume_search_open(const volume_tree *t, volume_search *out);
void volume_search_close(volume_search *s);

/* Makes room for more pairs. Called by kernels. */
void volume_search_grow(volume_search *s);

typedef struct volume_kernels {
    /* Moves records and volumes to the interval, from the leaves to the roots. */
    void (*refit)(volume_tree *t, volume_kind kind, const double *x0, const double *x1);
    /* Compares each tree with itself and with the others. */
    void (*search)(const volume_tree *t, volume_kind kind, volume_search *s);
} volume_kernels;

DECLARE_KERNELS(volume_kernels);

static inline const volume_kernels *volume_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, volume_kernels);
}
