/* The plan: what preprocessing hands to the runtime. */
#pragma once

#include "src/mesh/mesh.h"

/* The plans that CSCD_METHOD_AUTO has compared. */
typedef struct plan_candidates {
    uint32_t count;
    cscd_compared_plan items[8];
    char charge_failure[512]; /* why there is no charge to compare; empty: there is */
} plan_candidates;

enum { PLAN_ORIGIN_SIZE = 256 };

/* It says of its mesh what detectors need, and does not hold it; detectors copy what they need of the plan. */
struct cscd_plan {
    reference_count references; /* the caller alone */
    cscd_context *context;
    uint64_t mesh_hash;
    uint32_t triangle_count, component_count, region_count;
    cscd_method method;
    uint32_t *triangle_regions;
    cscd_region *regions;

    /* The share of each triangle in its region's area at rest, or an equal share in a region without area.
     * The detector point moves with the mean of the triangles' centroids, weighted by these shares. */
    double *triangle_weights;
    double (*detector_offsets)[3]; /* from that mean at rest to the detector point */

    double *charges, *capacitances; /* NULL without charge */
    cscd_preprocess_timings timings;
    cscd_plan_info info;
    char origin[PLAN_ORIGIN_SIZE]; /* how it was made, if info says so */
    plan_candidates candidates;
};

/* Returns the first fault of a plan as a sentence, or NULL. See live_objects_add. */
const char *plan_validate(const cscd_plan *plan);

/* Returns a plan of zeros with room for region_count regions; NULL when out of memory. */
cscd_plan *plan_allocate(const cscd_mesh *mesh, cscd_method method, uint32_t region_count);
