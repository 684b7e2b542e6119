/* A plan: what is found out about a mesh once, at rest. Part of cscd/cscd.h, which says what holds for every
 * function. */
#ifndef CSCD_PLAN_API_H
#define CSCD_PLAN_API_H

#include <cscd/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How pairs are left out that need no test. Methods differ in time only: in one mode every method keeps the
 * same guarantee, but for those as published. */
typedef enum cscd_method {
    CSCD_METHOD_AUTO,      /* the plan's, or NONE without a plan */
    CSCD_METHOD_NONE,      /* bounding volumes, no culling */
    CSCD_METHOD_BRUTE,     /* every pair of features: the reference, O(n^2) */
    CSCD_METHOD_SINGLE,    /* one region per component */
    CSCD_METHOD_KMEANS,    /* regions by k-means */
    CSCD_METHOD_CHARGE,    /* regions by charge density */
    CSCD_METHOD_PUBLISHED, /* the thesis's culling as published; loses contacts, for comparison only */
    CSCD_METHOD_ICCD,      /* normal cones and contour tests (Tang et al. 2009), corrected: to compare with */
    CSCD_METHOD_ICCD_PUBLISHED /* the same as published; loses contacts, for comparison only */
} cscd_method;

/* "auto", "none", "brute", "single", "kmeans", "charge", "published", "iccd", "iccd-published"; static
 * storage, never NULL. from_name leaves *out untouched when it returns false. */
CSCD_API const char *cscd_method_name(cscd_method method);
CSCD_API bool cscd_method_from_name(const char *name, cscd_method *out);

typedef struct cscd_plan cscd_plan;

typedef struct cscd_plan_options {
    uint32_t struct_size; /* set by cscd_plan_defaults */
    cscd_method method;   /* CHARGE (default), KMEANS or SINGLE */
    uint32_t k;           /* KMEANS: how many regions, shared out over the components; default 4 */
    uint32_t seed;        /* KMEANS; default 1 */
    double threshold;     /* CHARGE: share of the triangles, by density, that cuts start from; default 0.1 */
    bool published;       /* CHARGE: equalize with 256 bins as published; default false */
    size_t memory_limit;  /* CHARGE: in bytes, for the dense system; 0 (default): what the system has */
} cscd_plan_options;

CSCD_API cscd_plan_options cscd_plan_defaults(void);

/* Cuts the mesh, at rest in positions, into regions. CHARGE solves a dense system: 4 bytes per pair of
 * triangles of a component, and time with the cube. OUT_OF_MEMORY: the sentence gives the amount. Obstacles
 * are neither charged nor cut. */
CSCD_API cscd_status cscd_plan_create(const cscd_mesh *mesh, const double *positions,
                                      const cscd_plan_options *options, cscd_plan **out);

/* A detector keeps nothing of its plan, so this may be before or after the detector's end. */
CSCD_API void cscd_plan_destroy(cscd_plan *plan);

/* A region: connected triangles of one component, and the point that they are seen from. */
typedef struct cscd_region {
    uint32_t component, triangle_count;
    double area;          /* of its triangles at rest */
    double visible_share; /* of that area, what faces the detector point, in [0,1] */
    double detector_point[3];
} cscd_region;

/* A plan from what an earlier one held, for the same mesh: triangle_regions per triangle, region_count
 * detector points of 3 doubles, and with CHARGE also charges per triangle and capacitances per component
 * (else both NULL). INVALID_ARGUMENT names what does not fit. */
typedef struct cscd_plan_parts {
    cscd_method method; /* CHARGE, KMEANS or SINGLE */
    uint32_t region_count;
    const uint32_t *triangle_regions;
    const double *detector_points, *charges, *capacitances;
} cscd_plan_parts;

CSCD_API cscd_status cscd_plan_create_from_parts(const cscd_mesh *mesh, const double *positions,
                                                 const cscd_plan_parts *parts, cscd_plan **out);

/* The method that its regions are of. */
CSCD_API cscd_method cscd_plan_method(const cscd_plan *plan);

/* Regions of all components together; region < region_count. */
CSCD_API uint32_t cscd_plan_region_count(const cscd_plan *plan);
CSCD_API cscd_region cscd_plan_region(const cscd_plan *plan, uint32_t region);

/* The region of a triangle. */
CSCD_API uint32_t cscd_plan_triangle_region(const cscd_plan *plan, uint32_t triangle);

/* Charge per area at potential 1 of the triangle's component, in Gaussian units; 0 without CHARGE. */
CSCD_API double cscd_plan_triangle_charge(const cscd_plan *plan, uint32_t triangle);

/* Of a component, in units of length (Gaussian); 0 without CHARGE. */
CSCD_API double cscd_plan_capacitance(const cscd_plan *plan, uint32_t component);

typedef struct cscd_preprocess_timings {
    double assembly_ms, solve_ms; /* CHARGE */
    double regions_ms;            /* cuts or k-means, detector points, visible shares */
    double total_ms;
} cscd_preprocess_timings;

CSCD_API cscd_preprocess_timings cscd_plan_timings(const cscd_plan *plan);

#ifdef __cplusplus
}
#endif

#endif
