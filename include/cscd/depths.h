/* Depths: how deep what is buried lies below the surface of the body that contains it. Part of cscd/cscd.h, which says
 * what holds for every function. Theory: docs/theory/curves.md. */
#ifndef CSCD_DEPTHS_API_H
#define CSCD_DEPTHS_API_H

#include <cscd/patches.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A point of the mesh that a body (cscd/patches.h) contains, and the nearest point of that body's outer surface, which is
 * all of its closed components but what the body contains itself. So the surface under the intruder counts: a ball that
 * is sunk 0.1 into a slab has depth 0.1. Where a point is buried in its own body, the nearest point may lie on the point's
 * own limb. The depth is not how far the bodies have to move until they are apart, which may be much more.
 *
 * A depth is above 0 exactly where the point lies within the body, not on its surface: where surfaces lie on each other it
 * is 0, however the infinitely small motion of the curves goes. It never grows. */
typedef struct cscd_depth {
    uint32_t vertex; /* UINT32_MAX: the point is on an edge or a face */
    uint32_t edge;   /* UINT32_MAX: the point is a vertex or on a face */
    uint32_t face;   /* a triangle that has the point; of a vertex or an edge its first */
    uint32_t
        patch; /* of the point; UINT32_MAX: of an edge, of a vertex at which curves end, or of a face none of
                        * whose corners the body contains */
    uint32_t body;     /* which contains the point */
    uint32_t triangle; /* of that body: has the nearest point; of several the first */
    double s;          /* on the edge (e0, e1) the point is (1-s) e0 + s e1 */
    double depth;      /* up to rounding */

    /* Of a face: no point of the surface that the item stands for (see cscd_depths) is deeper. Never below the depth, and
     * above it by at most 1 %, or a billionth of the largest coordinate. Else the depth. */
    double bound;
    double x[3]; /* the point */

    /* A unit vector: x + depth * direction is the nearest point. Where the depth is 0, the normal there, which is 0 of a
     * triangle without area. */
    double direction[3];
} cscd_depth;

/* The deepest point of a patch in one body. It never grows. */
typedef struct cscd_patch_depth {
    uint32_t patch, body;
    size_t deepest; /* in the list of all depths: one of a face */
} cscd_patch_depth;

/* Three lists, one behind the other:
 *   vertices  all that a body contains, sorted by (vertex, body), each once for each of these bodies
 *   edges     sorted by (edge, body), the deepest points of edges that a body contains between two of its curves, so that
 *             none of the edge's vertices tells of it. These are the deepest to a millionth of the edge
 *   faces     the deepest points of the surface itself, wherever on it they are: one for each patch, body that contains it
 *             and part (cscd/parts.h) that has triangles of it, sorted by (patch, body, part); then, sorted by (face,
 *             body), one for each triangle of which a body contains something, but none of its corners. So no point of the
 *             surface is deeper than the greatest bound of these
 * The lists belong to the detector and live until its next call. */
typedef struct cscd_depths {
    const cscd_depth *items;
    size_t count;                    /* of all three */
    size_t vertex_count, edge_count; /* so many of them are of vertices, and of edges */
    const cscd_patch_depth *patches; /* sorted by (patch, body) */
    size_t patch_count;
} cscd_depths;

#ifdef __cplusplus
}
#endif

#endif
