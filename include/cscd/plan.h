/* A plan: the regions of a mesh, and the detector point in each. It is made once, at rest, and makes steps
 * faster; contacts are the same with any plan and with none. docs/theory/charge.md has the method. */
#ifndef CSCD_PLAN_API_H
#define CSCD_PLAN_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The solver of the equations for the charge. The regions that follow differ by few triangles. */
typedef enum cscd_charge_solver {
    /* A treecode, with the same bits on every processor: 2 kB for each triangle, or up to 8 kB where all are
     * long and thin, and time about in proportion. Densities are off by some 1e-4 of their mean (root of the
     * mean square), single ones by some 1e-3. */
    CSCD_CHARGE_TREE,
    /* A dense matrix, to compare with, of libcscd-baselines.so: exact densities, 8 bytes for each pair of
     * triangles of the largest component, cubic time. */
    CSCD_CHARGE_DENSE,
    /* TREE with half the iterations: densities are off by some percent of their mean, single ones by more. */
    CSCD_CHARGE_COARSE,
    CSCD_CHARGE_MAX_ENUM = 0x7fffffff
} cscd_charge_solver;

/* Options of a plan; start from cscd_plan_defaults. */
typedef struct cscd_plan_options {
    uint32_t struct_size; /* set by cscd_plan_defaults */
    /* CHARGE by default; KMEANS, SINGLE, or AUTO, which keeps the best of these (cscd_plan_compared); or
     * PUBLISHED (cscd/research.h). */
    cscd_method method;
    uint32_t k;    /* KMEANS: how many regions all components have together, 4 by default */
    uint32_t seed; /* KMEANS, AUTO: of the random starts, 1 by default */
    /* CHARGE, AUTO, PUBLISHED: the share of the triangles, those of least density, along which cuts run; in
     * (0,1), 0.1 by default. */
    double threshold;
    uint64_t ours;                    /* PUBLISHED: see cscd/research.h; 0 by default */
    uint64_t memory_limit;            /* CHARGE, AUTO: in bytes; 0, the default: what the system has */
    cscd_charge_solver charge_solver; /* CHARGE, AUTO: TREE by default */
    uint32_t frame_count;             /* of frames; 0 by default */
    /* CHARGE, AUTO: positions in a motion that the plan is made for, each as in cscd_plan_create. Of more
     * than 8 frames, 8 count, evenly spaced. NULL by default. */
    const cscd_view *const *frames;
    /* CHARGE, AUTO: the stiffness at each triangle, in any unit: borders of regions run in soft places of a
     * component (docs/theory/charge.md). INVALID_ARGUMENT names the first that is not positive and finite.
     * NULL, the default: as stiff everywhere. */
    const double *stiffness;
    /* PUBLISHED: clusters with more than this share of their component's triangles grow; in [0,1], 1/400 by
     * default. */
    double growing;
} cscd_plan_options;

/* Returns the default options of a plan. */
CSCD_API void cscd_plan_defaults_sized(cscd_plan_options *out, size_t size);
static inline cscd_plan_options cscd_plan_defaults(void) {
    cscd_plan_options options;
    cscd_plan_defaults_sized(&options, sizeof options);
    return options;
}

/* Cuts a mesh into regions. positions: the mesh at rest. Obstacles are left whole. INVALID_MESH: it has no
 * triangles. OUT_OF_MEMORY: with CHARGE the sentence gives the amount. SYSTEM_ERROR: CSCD_CHARGE_DENSE finds
 * no libcscd-baselines.so of this version beside the library, beside the program or in the system. CANCELLED:
 * see cscd_progress. */
CSCD_API cscd_status cscd_plan_create(cscd_context *context, const cscd_mesh *mesh,
                                      const cscd_view *positions, const cscd_plan_options *options,
                                      cscd_plan **out);

/* Frees the plan. */
CSCD_API void cscd_plan_destroy(cscd_plan *plan);

/* A region: connected triangles of one component, and the detector point from which most of them are seen. */
typedef struct cscd_region {
    uint32_t component, triangle_count;
    double area;              /* of its triangles at rest */
    double visible_share;     /* the share of the area that the detector point sees from inside, in [0,1] */
    double detector_point[3]; /* at rest */
} cscd_region;

/* The parts of a plan, for programs that save and load plans. */
typedef struct cscd_plan_parts {
    cscd_method method; /* CHARGE, KMEANS, SINGLE or PUBLISHED */
    uint32_t region_count;
    const uint32_t *triangle_regions; /* the region of each triangle */
    const double *detector_points;    /* region_count * 3 doubles */
    const double *charges;            /* with CHARGE and PUBLISHED one for each triangle, else NULL */
    const double *capacitances;       /* with these one for each component, else NULL */
    /* That of cscd_plan_info: at most 255 characters of printable ASCII, or NULL. */
    const char *origin;
} cscd_plan_parts;

/* Creates a plan from the parts of an earlier one of the same mesh. positions: the mesh at rest.
 * INVALID_ARGUMENT: the sentence names what does not fit. CANCELLED: see cscd_context_cancel. An example, a
 * plan of one region that was worked out elsewhere:
 *
 *     const uint32_t regions[4] = {0, 0, 0, 0}; // of the triangles
 *     const double points[3] = {0.2, 0.2, 0.2};
 *     const cscd_plan_parts parts = {CSCD_METHOD_SINGLE, 1, regions, points, NULL, NULL, NULL};
 *     cscd_plan *plan = NULL;
 *     const cscd_view *rest = CSCD_DOUBLES(corners, 4);
 *     if (cscd_plan_create_from_parts(context, tetrahedron, rest, &parts, &plan) == CSCD_OK)
 *         printf("%.1f of the region is seen\n", cscd_plan_region(plan, 0).visible_share);
 *     cscd_plan_destroy(plan);
 */
CSCD_API cscd_status cscd_plan_create_from_parts_sized(cscd_context *context, const cscd_mesh *mesh,
                                                       const cscd_view *positions,
                                                       const cscd_plan_parts *parts, size_t parts_size,
                                                       cscd_plan **out);
static inline cscd_status cscd_plan_create_from_parts(cscd_context *context, const cscd_mesh *mesh,
                                                      const cscd_view *positions,
                                                      const cscd_plan_parts *parts, cscd_plan **out) {
    return cscd_plan_create_from_parts_sized(context, mesh, positions, parts, sizeof *parts, out);
}

/* Returns a region of the plan. */
CSCD_API cscd_region cscd_plan_region(const cscd_plan *plan, uint32_t region);

/* Returns the region of each triangle: labels for cscd_detector_set_parts. The array lives as long as the
 * plan. */
CSCD_API const uint32_t *cscd_plan_triangle_regions(const cscd_plan *plan);
static inline uint32_t cscd_plan_triangle_region(const cscd_plan *plan, uint32_t triangle) {
    return cscd_plan_triangle_regions(plan)[triangle];
}

/* Returns the charge density of a triangle, in Gaussian units, with its component at potential 1; 0 if the
 * method is not by charge. */
CSCD_API double cscd_plan_triangle_charge(const cscd_plan *plan, uint32_t triangle);

/* Returns the capacitance of a component, a length in Gaussian units; 0 if the method is not by charge. */
CSCD_API double cscd_plan_capacitance(const cscd_plan *plan, uint32_t component);

/* Milliseconds that making a plan took. */
typedef struct cscd_preprocess_timings {
    double assembly_ms, solve_ms; /* CHARGE: of its equations */
    double regions_ms;            /* cuts or k-means, detector points, visible shares */
    double total_ms;
    double reserved[4]; /* 0 */
} cscd_preprocess_timings;

/* Returns how long each stage of cscd_plan_create took. */
CSCD_API cscd_preprocess_timings cscd_plan_timings(const cscd_plan *plan);

/* Facts about a plan, and how it was made. The names of kernels live as long as OpenBLAS and the library are
 * loaded. */
typedef struct cscd_plan_info {
    cscd_method method;      /* that made the regions: CHARGE, KMEANS, SINGLE or PUBLISHED */
    uint32_t region_count;   /* of all components together */
    uint32_t compared_count; /* of cscd_plan_compared; 0 if the method was not AUTO */
    uint32_t reserved;       /* 0 */
    /* The kernels by which OpenBLAS solved the charge system, such as "SkylakeX". NULL: CSCD_CHARGE_DENSE did
     * not solve it in cscd_plan_create, or the BLAS is another one. */
    const char *charge_kernels;
    /* "Haswell" or "SkylakeX" if OpenBLAS took slow old kernels: the value that OPENBLAS_CORETYPE should have
     * (docs/solver/tuning.md). Else NULL. */
    const char *better_kernels;
    /* As "method=charge solver=tree threshold=0.1 frames=0 stiffness=0 version=2.0.0". NULL: the plan is of
     * parts that say nothing. It lives as long as the plan. */
    const char *origin;
} cscd_plan_info;

/* Tells what the plan is, and how it was made. */
CSCD_API cscd_plan_info cscd_plan_describe(const cscd_plan *plan);
static inline cscd_method cscd_plan_method(const cscd_plan *plan) {
    return cscd_plan_describe(plan).method;
}
static inline uint32_t cscd_plan_region_count(const cscd_plan *plan) {
    return cscd_plan_describe(plan).region_count;
}

/* A plan that CSCD_METHOD_AUTO has compared. */
typedef struct cscd_compared_plan {
    cscd_method method; /* CHARGE, SINGLE or KMEANS */
    uint32_t k; /* KMEANS: that of the options; 4, 8 or 16 for each component, at most 1,024 in all; else 0 */
    uint32_t region_count; /* 0: there is no plan by charge; see failure */
    bool kept;             /* the plan is this one */
    uint8_t reserved[3];   /* 0 */
    /* The predicted share of the triangles that a step has to look at, in [0,1] (docs/theory/charge.md). The
     * plan has the least, but charge is kept up to 2 % above that. */
    double tested_share;
    /* The reason why there is no plan by charge, in a sentence; else NULL. It lives as long as the plan. */
    const char *failure;
} cscd_compared_plan;

/* Returns one of the compared_count plans that were compared, in the order in which they were tried. */
CSCD_API cscd_compared_plan cscd_plan_compared(const cscd_plan *plan, uint32_t place);

#ifdef __cplusplus
}
#endif

#endif
