/* Culling by orientation: regions, their detector points, and the orientations of triangles in an interval. */
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
    double (*detector_points)[2][3]; /* per region, at the start and at the end of the interval */
    uint8_t *facing;       /* orientations in the interval; ZERO for triangles that were not clean */
    uint8_t *orientations; /* the same, but also ZERO for triangles that contacts have tainted since */
    uint8_t *earlier;      /* the orientations of the last pass */
    uint64_t plus, minus;  /* how many triangles face PLUS, and MINUS */
} culling;

/* Its arrays, for those who copy them; mesh and region_count say their sizes. */
array_list culling_arrays(culling *c);

/* Copies what the detector needs from a plan. Without a plan, each component is one region, and the mean of its
 * triangles is its detector point. Nothing is culled yet. */
cscd_status culling_create(const cscd_mesh *mesh, const cscd_plan *plan, culling *out);
void culling_destroy(culling *c);

/* Takes the orientations over from facing, which has been filled in, and counts them. */
void culling_begin(culling *c);

/* Ends a pass, after all pairs of triangles that the orientations keep have been tested. */
void culling_pass_done(culling *c);

/* Keeps all pairs of this triangle from now on. False: they were kept already. */
static inline bool culling_taint(culling *c, uint32_t triangle) {
    bool newly_kept = c->orientations[triangle] != ORIENTATION_ZERO;
    c->orientations[triangle] = ORIENTATION_ZERO;
    return newly_kept;
}

/* Sets all orientations to ZERO, so that nothing is culled. */
void culling_clear(culling *c);

/* Do the orientations keep this pair of triangles, so that it is tested? */
static inline bool culling_keeps(const culling *c, uint32_t a, uint32_t b) {
    return c->triangle_regions[a] != c->triangle_regions[b] ||
           orientations_may_touch(c->orientations[a], c->orientations[b]);
}

/* Did the orientations of the last pass keep this pair? */
static inline bool culling_kept(const culling *c, uint32_t a, uint32_t b) {
    return c->triangle_regions[a] != c->triangle_regions[b] ||
           orientations_may_touch(c->earlier[a], c->earlier[b]);
}
