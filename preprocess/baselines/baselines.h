/* The baselines of preprocessing: cuts and regions as published (Yeh 2012, section 3.3; docs/theory/thesis.md
 * says where the text leaves a choice), and the dense solution for the charge. */
#pragma once

#include "preprocess/charge/charge.h"
#include "src/mesh/mesh.h"

typedef struct published_thresholds {
    double cluster; /* triangles of a lower equalized density form clusters; 0.1 in the thesis */
    double
        growing; /* clusters of more than this share of their component's triangles grow; 1/400 in the thesis (5.3) */
} published_thresholds;

/* The intermediate results of the steps, for tests and benchmarks; members may be NULL. */
typedef struct published_trace {
    uint32_t *clusters; /* per triangle: its cluster; UINT32_MAX: none */
    bool *cutting;      /* per triangle: it is a cutting triangle of a cluster that cuts */
    bool *contours;     /* per edge: a smoothed contour runs along it, chosen or not */
} published_trace;

/* equalized: as published_equalize. Each cluster of a closed component that has two contours, by itself or grown, cuts along the
 * shorter one. Regions are what the cuts leave connected, numbered from 0 by their first triangles; components that are not
 * closed, and obstacles, are left whole. Outputs are written on success only. */
cscd_status published_cuts(const cscd_mesh *mesh, const double *positions, const double *equalized,
                           published_thresholds thresholds, const published_trace *trace,
                           uint32_t *region_of_triangle, uint32_t *region_count);

/* Histogram equalization by 256 bins of equal width from a component's lowest density to its highest (equation 3.18): the share of
 * the component's triangles in the triangle's bin and those below. INVALID_ARGUMENT names a triangle whose density is not finite. */
cscd_status published_equalize(const cscd_mesh *mesh, const double *density, double *equalized);

/* The equations of the charge by a dense system, which libcscd-baselines solves. SYSTEM_ERROR: there is no libcscd-baselines, or one of another version. */
cscd_status dense_charges_find(cscd_context *context, charge_solution *out);
