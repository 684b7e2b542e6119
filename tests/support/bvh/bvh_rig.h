/* A BVH over a scene's mesh, for tests; anything that fails there fails the test. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "tests/support/bvh/direction_gap.h"
#include "tests/support/scenes.h"

typedef struct bvh_setup {
    cscd_simd simd;
    uint32_t thread_count;
    int axis_count;
    uint32_t region_count; /* of as many triangles each, in their order; 0: a region per component */
} bvh_setup;

typedef struct bvh_rig {
    cscd_context *context;
    cscd_mesh *mesh;
    uint32_t *regions; /* of triangles */
    uint32_t region_count;
    bvh bvh;
} bvh_rig;

/* Built from s->x0, not moved yet. false: this processor has no such vector instructions. */
bool bvh_rig_create(const scene *s, bvh_setup setup, bvh_rig *out);
void bvh_rig_destroy(bvh_rig *r);

/* Adds to positions, three per vertex. */
void translate(double *x, uint32_t vertex_count, const double by[3]);

/* Moves as points in the frame of a tree, or of the first one for NULL, at t in {0, 1/2, 1} = moment / 2;
 * scaled.
 */
void in_frame(const bvh *f, const bvh_tree *p, gap_motion m, uint32_t vertex, int moment, long double out[3]);
