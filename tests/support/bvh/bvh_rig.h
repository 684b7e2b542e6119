/* A BVH over a scene's mesh; any failure to make it fails the test. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "src/core/system.h"
#include "tests/support/bvh/direction_gap.h"
#include "tests/support/scenes.h"

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

/* Builds a BVH from s->x0, not refitted yet. Returns false when this processor lacks the instruction set. */
bool bvh_rig_create(const scene *s, bvh_setup setup, bvh_rig *out);
void bvh_rig_destroy(bvh_rig *r);

/* Adds `by` to all positions. */
void translate(double *x, uint32_t vertex_count, const double by[3]);

/* Computes where a vertex is at t = moment / 2, in the frame of tree p (of the first tree when p is NULL),
 * scaled as the BVH scales. */
void in_frame(const bvh *hierarchy, const bvh_tree *p, gap_motion m, uint32_t vertex, int moment,
              long double out[3]);
