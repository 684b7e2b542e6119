/* Bounding volume hierarchies of scenes, and gaps between moving features along the directions of 14-DOPs, in long double. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "src/core/system.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <stdint.h>

enum { DIRECTION_COUNT = 7 };

/* The directions are x, y, z, x+y+z, x+y-z, x-y+z, -x+y+z. */
extern const int directions[DIRECTION_COUNT][3];

/* The vertices of a point, an edge or a face. */
typedef struct point_set {
    const uint32_t *vertices;
    int count;
} point_set;

/* Positions, three per vertex, at both ends of an interval. */
typedef struct gap_motion {
    const double *x0, *x1;
} gap_motion;

long double along_direction(const long double p[3], int direction);

/* Returns a length: the largest, over all directions and their opposites, of the smaller of the gaps at
 * both ends. When it is positive, all points of a and b stay farther apart than that throughout. The
 * search ends early with any length above `enough`. */
long double direction_gap(gap_motion m, point_set a, point_set b, long double enough);

/* Returns the same length for x, y and z alone. */
long double axis_gap(gap_motion m, point_set a, point_set b, long double enough);

/* Returns the largest magnitude of a coordinate relative to that of vertex 0 at the start. */
double motion_extent(gap_motion m, uint32_t vertex_count);

/* ---- a scene with its hierarchy ------------------------------------------------------------------------ */

typedef struct bvh_setup {
    cscd_simd simd;
    uint32_t thread_count;
    int axis_count;
    uint32_t region_count; /* regions of equally many consecutive triangles; 0: one per component */
} bvh_setup;

typedef struct bvh_rig {
    cscd_context *context;
    cscd_mesh *mesh;
    uint32_t *regions; /* a region per triangle */
    uint32_t region_count;
    bvh bvh;
} bvh_rig;

/* Any failure to make one fails the test. */

/* Builds a BVH from s->x0, not refitted yet. Returns false when this processor lacks the instruction set. */
bool bvh_rig_create(const scene *s, bvh_setup setup, bvh_rig *out);
void bvh_rig_destroy(bvh_rig *r);

/* Adds `by` to all positions. */
void translate(double *x, uint32_t vertex_count, const double by[3]);

/* Computes where a vertex is at t = moment / 2, in the frame of tree p (of the first tree when p is NULL),
 * scaled as the BVH scales. */
void in_frame(const bvh *hierarchy, const bvh_tree *p, gap_motion m, uint32_t vertex, int moment,
              long double out[3]);

/* ---- trees at one moment ------------------------------------------------------------------------------- */

/* As method SINGLE has them: builds one tree per component, and refits them to the positions. */
void mesh_trees_build(const cscd_mesh *mesh, const double *positions, int axis_count, bvh *out);

/* ---- triangles that touch ------------------------------------------------------------------------------ */

/* Makes pairs of triangles 2 i and 2 i + 1 with vertices of their own. At both ends the least of one is
 * the greatest of the other along a direction; when that is no double, it is a few units in the last place
 * less. */
void make_touching_pairs(random_stream *random, uint32_t pair_count, double spread, scene *out);
