/* The charge density of a conductor in the shape of the mesh: collocation at triangle centroids. */
#pragma once

#include "preprocess/charge/charge_interface.h"
#include "src/mesh/mesh.h"

/* Bytes that charge_solve takes at its peak through the context's allocator; the largest component's matrix,
 * 4 bytes per pair of its triangles, is nearly all of it. SIZE_MAX when they cannot be counted, or when there is
 * no charge library. External for the tests of memory limits. */
size_t charge_memory(const cscd_mesh *mesh);

/* Each component is a conductor of its own, alone in space, at potential 1, in Gaussian units:
 * density[triangle] is charge per area, capacitance[component] is the sum of density times area, that is, the
 * charge. density of another total charge is proportional. Zero-area triangles have density 0 and take no
 * part; triangles that coincide share their charge evenly. timings may be NULL. Outputs are written on
 * success only.
 *
 * OUT_OF_MEMORY: charge_memory exceeds what the system has available (the sentence gives both), or an
 * allocation failed. INVALID_ARGUMENT: positions; two triangles with one centroid, or so near to each other
 * that their charges cannot be told apart. CANCELLED: the context's progress function said so.
 * SYSTEM_ERROR: there is no charge library. The same
 * inputs give the same bits, for any thread count and whoever runs the tasks. */
cscd_status charge_solve(const cscd_mesh *mesh, const double *positions, double *density, double *capacitance,
                         charge_timings *timings);

/* The same with a limit in bytes of the caller's in place of the system's. */
cscd_status charge_solve_within(const cscd_mesh *mesh, const double *positions, size_t memory_limit,
                                double *density, double *capacitance, charge_timings *timings);

/* The kernels of the BLAS that charge_solve runs; without a charge library nothing is known. */
charge_kernels charge_kernels_here(cscd_context *context);

/* Writes the functions of the charge library, which is linked or opened (charge_library.c). Without
 * it, fails with SYSTEM_ERROR and a sentence that says how to get it. */
cscd_status charge_library_find(cscd_context *context, const charge_functions **out);
