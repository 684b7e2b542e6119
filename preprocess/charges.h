/* The charge density of a conductor in the shape of the mesh: collocation at triangle centroids. */
#pragma once

#include "preprocess/charge/charge_solution.h"
#include "src/mesh/mesh.h"

/* What a solution took, and by what. */
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

/* Each component is a conductor of its own, alone in space, at potential 1, in Gaussian units:
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
