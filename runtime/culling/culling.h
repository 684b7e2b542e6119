/* Culling by orientation: regions, their detector points, the triangles' flags of an interval. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "src/mesh/plan.h"

typedef struct culling {
    cscd_context *context;
    const cscd_mesh *mesh;
    uint32_t region_count;
    uint32_t *triangle_regions;
    double *triangle_weights;        /* as in the plan */
    double (*detector_offsets)[3];   /* as in the plan */
    double (*detector_points)[2][3]; /* per region, at the start and at the end of the interval at hand */
    uint8_t *facing;                 /* of the interval at hand; ZERO where a triangle was not clean */
    uint8_t *orientations; /* the same, but ZERO also where contacts have tainted a triangle since */
    uint8_t *earlier;      /* the orientations of the passes before the one at hand */
    uint64_t plus, minus;  /* how many are facing PLUS and MINUS */
} culling;

/* What the detector needs of a plan, copied; without one, a region per component and the mean of its
 * triangles for a detector point. Nothing is culled yet. */
cscd_status culling_create(const cscd_mesh *mesh, const cscd_plan *plan, culling *out);
void culling_destroy(culling *c);

/* Makes one region of all components, and another one of all obstacles; triangles keep their weights. */
void culling_join_components(culling *c);

/* What is facing has been filled in: the orientations are these, and counted. */
void culling_begin(culling *c);

/* All pairs of triangles that the flags keep have been tested. */
void culling_pass_done(culling *c);

/* From now on all pairs of this triangle are kept. False: they were already. */
static inline bool culling_taint(culling *c, uint32_t triangle) {
    bool fresh = c->orientations[triangle] != ORIENTATION_ZERO;
    c->orientations[triangle] = ORIENTATION_ZERO;
    return fresh;
}

/* All triangles ZERO: nothing is culled. */
void culling_clear(culling *c);

/* Do the flags leave this pair of triangles to be tested? */
static inline bool culling_keeps(const culling *c, uint32_t a, uint32_t b) {
    return c->triangle_regions[a] != c->triangle_regions[b] ||
           orientations_may_touch(c->orientations[a], c->orientations[b]);
}

/* Did they in the passes before? */
static inline bool culling_kept(const culling *c, uint32_t a, uint32_t b) {
    return c->triangle_regions[a] != c->triangle_regions[b] ||
           orientations_may_touch(c->earlier[a], c->earlier[b]);
}
