/* Culling by orientation: regions, their detector points, the triangles' flags of an interval. */
#ifndef CSCD_CULLING_H
#define CSCD_CULLING_H

#include "runtime/orientation.h"
#include "src/plan.h"

typedef struct culling {
    cscd_context *context;
    const cscd_mesh *mesh;
    uint32_t region_count;
    uint32_t *triangle_regions;
    double *triangle_weights;      /* as in the plan */
    double (*detector_offsets)[3]; /* as in the plan */
    uint8_t *orientations;         /* of the interval at hand; ZERO in components that are not culled */
    uint64_t plus, minus;          /* how many of these are PLUS and MINUS */
} culling;

/* What the detector needs of a plan, copied; without one, a region per component and the mean of its
 * triangles for a detector point. Nothing is culled yet. */
cscd_status culling_create(const cscd_mesh *mesh, const cscd_plan *plan, culling *out);
void culling_destroy(culling *c);

/* Counts what the orientations are. */
void culling_count(culling *c);

/* All triangles ZERO: nothing is culled. */
void culling_clear(culling *c);

/* Do the flags leave this pair of triangles to be tested? */
static inline bool culling_keeps(const culling *c, uint32_t a, uint32_t b) {
    return c->triangle_regions[a] != c->triangle_regions[b] ||
           orientations_may_touch(c->orientations[a], c->orientations[b]);
}

#endif
