/* A plan: how a mesh is cut into regions, and the point inside each from which the detector tells which
 * triangles cannot touch. It is made once, from the mesh at rest, and makes steps faster; contacts are the
 * same with any plan and with none.
 * docs/theory/charge.md has the method. */
#ifndef CSCD_PLAN_API_H
#define CSCD_PLAN_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How the equations for the charge of a component are solved. The regions that follow differ by few triangles. Later
 * versions may add values. */
typedef enum cscd_charge_solver {
    CSCD_CHARGE_TREE, /* iterations of a treecode: memory, about 2 kB a triangle, or up to 8 kB where all are long
                         * and thin, as in fans, and time grow about as the number of triangles; densities are off by some 1e-4 of
                         * their mean (root of the mean square), single ones
                         * by some 1e-3. The same bits on every processor */
    CSCD_CHARGE_DENSE, /* a dense matrix, by LAPACK: 8 bytes for each pair of triangles of the largest component, and
                         * time with the cube of their number; densities exact. To compare with */
    CSCD_CHARGE_COARSE, /* as TREE with half the iterations: densities are off by some percent of their mean (root of the
                         * mean square), single ones by more */
    CSCD_CHARGE_MAX_ENUM = 0x7fffffff
} cscd_charge_solver;

/* Options of a plan; start from cscd_plan_defaults. */
typedef struct cscd_plan_options {
    uint32_t struct_size; /* set by cscd_plan_defaults */
    /* CHARGE by default, or KMEANS, or SINGLE; or AUTO: the one of these that leaves the least to a step, as
     * cscd_plan_compared tells, and the plan is then of that method; or PUBLISHED (cscd/research.h). */
    cscd_method method;
    uint32_t k;       /* KMEANS: how many regions all components have together, 4 by default */
    uint32_t seed;    /* KMEANS, AUTO: of the random starts, 1 by default */
    double threshold; /* CHARGE, AUTO, PUBLISHED: the share of the triangles, those of least density, along
                       * which cuts run; in (0,1), 0.1 by default */
    uint64_t ours;    /* PUBLISHED: what is done as CHARGE does it; see cscd/research.h. 0 by default */
    /* CHARGE, AUTO: bytes that the solution may take; 0, the default: what the system has. */
    uint64_t memory_limit;
    cscd_charge_solver charge_solver; /* CHARGE, AUTO: TREE by default */
    uint32_t frame_count;             /* of frames; 0 by default */
    /* CHARGE, AUTO: positions of the mesh in a motion that the plan is made for, each as in cscd_plan_create: what the detector
     * points see in them counts as much as what they see at rest. Of more than 8 frames, 8 count, evenly spaced. NULL by default. */
    const cscd_view *const *frames;
    /* CHARGE, AUTO: how stiff the material is at each triangle, positive and finite, in any unit, since only ratios within a component
     * count: what is softer than the stiffer half of its component's area is soft. Borders of regions run in soft places, and a part
     * beyond a soft place is given a detector point of its own. NULL, the default: as stiff everywhere. INVALID_ARGUMENT names the
     * first triangle whose value is not positive and finite. */
    const double *stiffness;
    /* PUBLISHED: clusters with more than this share of their component's triangles grow; in [0,1], 1/400 by default. */
    double growing;
} cscd_plan_options;

/* The default options. */
CSCD_API void cscd_plan_defaults_sized(cscd_plan_options *out, size_t size);
static inline cscd_plan_options cscd_plan_defaults(void) {
    cscd_plan_options options;
    cscd_plan_defaults_sized(&options, sizeof options);
    return options;
}

/* Cuts a mesh into regions. positions: the mesh at rest. options may be NULL. Obstacles are left whole.
 * OUT_OF_MEMORY: where CHARGE is solved, the sentence gives the amount. SYSTEM_ERROR: CSCD_CHARGE_DENSE alone is in
 * libcscd-baselines.so, which the library opens beside itself, beside the program or where the system looks, and there is
 * none, or one of another version. CANCELLED: see cscd_progress. INVALID_MESH: it has no triangles; wires, points and
 * half-spaces beside them do not matter. */
CSCD_API cscd_status cscd_plan_create(cscd_context *context, const cscd_mesh *mesh,
                                      const cscd_view *positions, const cscd_plan_options *options,
                                      cscd_plan **out);

/* Frees the plan. Detectors made with it keep what they need, so it may go before them. */
CSCD_API void cscd_plan_destroy(cscd_plan *plan);

/* A region: connected triangles of one component, and the detector point from which most of them are seen. */
typedef struct cscd_region {
    uint32_t component, triangle_count;
    double area;              /* of its triangles at rest */
    double visible_share;     /* the share of that area that the detector point sees from inside, in [0,1] */
    double detector_point[3]; /* at rest */
} cscd_region;

/* What a plan consists of, for programs that save and load plans themselves. */
typedef struct cscd_plan_parts {
    cscd_method method; /* CHARGE, KMEANS, SINGLE or PUBLISHED */
    uint32_t region_count;
    const uint32_t *triangle_regions; /* the region of each triangle */
    const double *detector_points;    /* region_count * 3 doubles */
    const double *charges;            /* with CHARGE and PUBLISHED one for each triangle, else NULL */
    const double *capacitances;       /* with these one for each component, else NULL */
    const char
        *origin; /* how it was made, as cscd_plan_describe says: a line of at most 255 characters of printable
                         * ASCII; NULL: that is not known */
} cscd_plan_parts;

/* Creates a plan from the parts of an earlier one of the same mesh. positions: the mesh at rest.
 * INVALID_ARGUMENT: the sentence names what does not fit. CANCELLED: see cscd_context_cancel. An example, a plan
 * of one region that was worked out elsewhere: what a plan consists of are regions and a point in each:
 *
 *     const uint32_t regions[4] = {0, 0, 0, 0}; // of the triangles
 *     const double points[3] = {0.2, 0.2, 0.2};
 *     const cscd_plan_parts parts = {CSCD_METHOD_SINGLE, 1, regions, points, NULL, NULL, NULL};
 *     cscd_plan *plan = NULL;
 *     if (cscd_plan_create_from_parts(context, tetrahedron, CSCD_DOUBLES(corners, 4), &parts, &plan) == CSCD_OK)
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

/* The method that made the regions: CHARGE, KMEANS, SINGLE or PUBLISHED. */
CSCD_API cscd_method cscd_plan_method(const cscd_plan *plan);

/* The number of regions of all components together. */
CSCD_API uint32_t cscd_plan_region_count(const cscd_plan *plan);

/* A region. */
CSCD_API cscd_region cscd_plan_region(const cscd_plan *plan, uint32_t region);

/* The region of each triangle: labels for cscd_detector_set_parts. The array belongs to the plan and lives as long. */
CSCD_API const uint32_t *cscd_plan_triangle_regions(const cscd_plan *plan);
static inline uint32_t cscd_plan_triangle_region(const cscd_plan *plan, uint32_t triangle) {
    return cscd_plan_triangle_regions(plan)[triangle];
}

/* The charge density of a triangle, in Gaussian units, when its component is a conductor at potential 1; 0
 * where the method is not by charge. */
CSCD_API double cscd_plan_triangle_charge(const cscd_plan *plan, uint32_t triangle);

/* The capacitance of a component as a conductor, a length in Gaussian units; 0 where the method is not by charge. */
CSCD_API double cscd_plan_capacitance(const cscd_plan *plan, uint32_t component);

/* Milliseconds that making a plan took. */
typedef struct cscd_preprocess_timings {
    double assembly_ms, solve_ms; /* CHARGE: of its equations */
    double regions_ms;            /* cuts or k-means, detector points, visible shares */
    double total_ms;
    double reserved[4]; /* 0 */
} cscd_preprocess_timings;

/* How long each stage of cscd_plan_create took. */
CSCD_API cscd_preprocess_timings cscd_plan_timings(const cscd_plan *plan);

/* How a plan was made. The names of kernels belong to OpenBLAS and the library, and live as long as these are loaded. */
typedef struct cscd_plan_info {
    const char
        *charge_kernels; /* the kernels with which OpenBLAS solved the charge system, by its own name, such
                                 * as "SkylakeX". NULL: the plan is not by cscd_plan_create with CSCD_CHARGE_DENSE,
                                 * or the BLAS is another one */
    const char
        *better_kernels; /* the kernels that this processor deserves, "Haswell" or "SkylakeX": OpenBLAS did
                                 * not know it and took old ones, which take about three times as long. Set the
                                 * environment variable OPENBLAS_CORETYPE to this before the program starts. NULL:
                                 * the kernels will do, or are not known */
    /* Method, solver, thresholds, frames and version, as words: "method=charge solver=tree threshold=0.1 frames=0
     * stiffness=0 version=2.0.0". NULL: the plan is of parts that say nothing. Lives as long as the plan. */
    const char *origin;
} cscd_plan_info;

/* How the plan was made. */
CSCD_API cscd_plan_info cscd_plan_describe(const cscd_plan *plan);

/* What CSCD_METHOD_AUTO has compared. */
typedef struct cscd_compared_plan {
    cscd_method method; /* CHARGE, SINGLE or KMEANS */
    uint32_t k; /* KMEANS: that of the options, 4, 8 or 16 for each component, 1,024 in all at most; else 0 */
    uint32_t region_count; /* 0: there is no plan by charge; see failure */
    bool kept;             /* the plan is this one */
    uint8_t reserved[3];   /* 0 */
    /* Predicted, in [0,1]: the share of the triangles that a step has to look at with others of their component, because
     * they lie at the border of their region, because its detector point does not see them well, or because the component is
     * not closed; the mean of the rest and all frames of the options. What lies beyond soft places counts as hardly seen. The plan has
     * the least, but charge is kept where another has less by no more than 2 %. */
    double tested_share;
    const char
        *failure; /* why there is no plan by charge: a sentence; NULL: there is. Lives as long as the plan */
} cscd_compared_plan;

/* The plans that were compared, in the order in which they were tried; none where the method was not AUTO. */
CSCD_API uint32_t cscd_plan_compared_count(const cscd_plan *plan);
CSCD_API cscd_compared_plan cscd_plan_compared(const cscd_plan *plan, uint32_t place);

#ifdef __cplusplus
}
#endif

#endif
