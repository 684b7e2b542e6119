/* The steps of preprocessing: frames of a motion, the charge, and drafts of a plan. */
#pragma once

#include "preprocess/charge/charge.h"
#include "preprocess/regions/regions.h"
#include "src/mesh/plan.h"

/* ---- charge -------------------------------------------------------------------------------------------- */

/* The time of a solution, and the kernels that made it. */
typedef struct charge_report {
    charge_timings timings;
    charge_kernels kernels; /* of the BLAS, if a dense system was solved */
} charge_report;

typedef struct charge_options {
    cscd_charge_solver solver;
    size_t memory_limit; /* in bytes; 0: what the system has available */
} charge_options;

/* Bytes that the dense solution takes at its peak through the context's allocator; the largest component's matrix,
 * 8 bytes per pair of its triangles, is nearly all of it. SIZE_MAX when they cannot be counted, or when there is
 * no libcscd-baselines. External for the tests of memory limits. */
size_t charge_memory(const cscd_mesh *mesh);

/* Finds the charge density of conductors in the shape of the mesh, by collocation at triangle centroids. Each component is a
 * conductor of its own, alone in space, at potential 1, in Gaussian units:
 * density[triangle] is charge per area, capacitance[component] is the sum of density times area, that is, the
 * charge. density of another total charge is proportional. Zero-area triangles have density 0 and take no
 * part; triangles that coincide share their charge evenly. report may be NULL. Outputs are written on
 * success only.
 *
 * OUT_OF_MEMORY: it takes more than what the system has available (the sentence gives both), or an
 * allocation failed. INVALID_ARGUMENT: positions; two triangles with one centroid, or so near to each other
 * that their charges cannot be told apart. CANCELLED: the context's progress function said so.
 * SYSTEM_ERROR: DENSE, and there is no libcscd-baselines. The same
 * inputs give the same bits, for any thread count and whoever runs the tasks. */
cscd_status charge_solve(const cscd_mesh *mesh, const double *positions, const charge_options *options,
                         double *density, double *capacitance, charge_report *report);

/* ---- frames -------------------------------------------------------------------------------------------- */

/* The frames of a motion that a plan is made for. */
typedef struct plan_frames {
    uint32_t count;
    const double *items[FRAMES_MOST]; /* packed positions */
    double *buffers[FRAMES_MOST];     /* those that had to be copied */
} plan_frames;

/* Reads and checks the frames of the options, or FRAMES_MOST of them, evenly spaced. Free them also after a failure. */
cscd_status plan_frames_read(cscd_context *context, const cscd_mesh *mesh, const cscd_plan_options *options,
                             plan_frames *out);
void plan_frames_free(cscd_context *context, plan_frames *frames);

/* ---- drafts -------------------------------------------------------------------------------------------- */

/* The results of the steps of preprocessing, before they become a plan. */
typedef struct plan_draft {
    const cscd_mesh *mesh;
    const double *positions; /* at rest */
    const plan_frames *frames;
    cscd_plan_options options; /* of a method other than AUTO */
    uint32_t *regions;         /* of each triangle */
    uint32_t region_count;
    double *detector_points;        /* 3 * region_count */
    double *charges, *capacitances; /* NULL without charge */
    cscd_preprocess_timings timings;
    charge_kernels kernels;
} plan_draft;

/* Takes the steps of the method: charge, regions, detector points. Free the draft also after a failure. */
cscd_status plan_draft_make(const cscd_mesh *mesh, const double *positions, const plan_frames *frames,
                            const cscd_plan_options *options, plan_draft *out);
void plan_draft_free(plan_draft *d);

/* Returns the solver for the charge, if the method needs it. */
cscd_charge_solver plan_draft_solver(const plan_draft *d);

/* Makes drafts by charge, by K-means with several numbers of regions and by single ones, and keeps the one
 * that leaves the least to test. options: of method AUTO. If the charge fails, the others are compared, and
 * the list says why. Free the draft also after a failure. */
cscd_status best_draft_make(const cscd_mesh *mesh, const double *positions, const plan_frames *frames,
                            const cscd_plan_options *options, plan_candidates *candidates, plan_draft *out);
