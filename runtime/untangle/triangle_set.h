/* Some triangles of a mesh, with a tree for nearest points and rays. */
#pragma once

#include "src/mesh/mesh.h"

/* The place that a search has found. */
typedef struct set_place {
    uint32_t triangle; /* UINT32_MAX: there is none */
    double weights[3]; /* of its corners */
    double distance;
} set_place;

/* Begins with the context, and nothing else set; memory is kept from one set to the next. */
typedef struct triangle_set {
    cscd_context *context;
    const cscd_mesh *mesh;
    const double *x;
    uint32_t *items; /* the triangles, in the order of the tree */
    uint32_t count, leaf_size;
    struct set_middle *middles; /* while the tree is made */
    struct set_node *nodes;
    uint32_t node_count;
    size_t capacity;
} triangle_set;

void triangle_set_free(triangle_set *s);

/* Makes the tree of the triangles at the positions, which the set then uses; triangles are copied. questions: about how many searches
 * there will be. False: no memory. */
bool triangle_set_make(triangle_set *s, const cscd_mesh *mesh, const double *x, const uint32_t *triangles,
                       uint32_t count, size_t questions);

/* The nearest point of the set. */
set_place triangle_set_nearest(const triangle_set *s, const double point[3]);

/* The farthest point in which the ray in this direction, a unit vector, meets the set. */
set_place triangle_set_farthest_hit(const triangle_set *s, const double point[3], const double direction[3]);
