/* Depths: how deep what is buried lies below the surface of the object that contains it. Part of cscd/cscd.h, which says
 * what holds for every function. Theory: docs/theory/curves.md. */
#ifndef CSCD_DEPTHS_API_H
#define CSCD_DEPTHS_API_H

#include <cscd/patches.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A point of the mesh that an object contains, and the nearest point of that object's outer surface, which is all of its
 * closed components but what the object contains itself. So the surface under the intruder counts: a ball that is sunk
 * 0.1 into a slab has depth 0.1. Where a vertex is buried in its own object, the nearest point may lie on the vertex's own
 * limb. The depth is not how far the bodies have to move until they are apart, which may be much more. It never
 * grows. */
typedef struct cscd_depth {
    uint32_t vertex;   /* UINT32_MAX: the point is on an edge */
    uint32_t edge;     /* UINT32_MAX: the point is a vertex */
    uint32_t patch;    /* of the vertex; UINT32_MAX: of an edge, or of a vertex at which curves end */
    uint32_t object;   /* which contains the point */
    uint32_t triangle; /* of that object: has the nearest point; of several the first */
    uint32_t reserved; /* 0 */
    double s;          /* on the edge (e0, e1) the point is (1-s) e0 + s e1 */
    double depth;      /* up to rounding */
    double x[3];       /* the point */

    /* A unit vector: x + depth * direction is the nearest point. Where the depth is 0, the normal there, which is 0 of a
     * triangle without area. */
    double direction[3];
} cscd_depth;

/* The deepest vertex of a patch in one object. It never grows. */
typedef struct cscd_patch_depth {
    uint32_t patch, object;
    size_t deepest; /* in the list of all depths */
} cscd_patch_depth;

/* A triangle of which an object may contain something, and how deep: no point of the triangle that the object contains is
 * deeper than the bound, which is found from the depths of its corners alone and rounded up. It never grows. */
typedef struct cscd_triangle_depth {
    uint32_t triangle, object;
    double bound;
} cscd_triangle_depth;

/* All vertices that an object contains, sorted by (vertex, object), each once for each of these objects; then, sorted by
 * (edge, object), the deepest points of edges that an object contains between two of its curves, so that none of the
 * edge's vertices tells of it. These are the deepest to a millionth of the edge. The lists belong to the detector and
 * live until its next call. */
typedef struct cscd_depths {
    const cscd_depth *items;
    size_t count;
    size_t vertex_count;             /* so many of them are of vertices */
    const cscd_patch_depth *patches; /* sorted by (patch, object) */
    size_t patch_count;

    /* Only where depth_bounds were asked for, else NULL and 0: all triangles with a corner that an object contains, or with a
     * piece of a curve of one of its closed components, sorted by (triangle, object). Objects contain nothing of any other
     * triangle. */
    const cscd_triangle_depth *triangles;
    size_t triangle_count;
} cscd_depths;

#ifdef __cplusplus
}
#endif

#endif
