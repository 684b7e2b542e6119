/* Regions of a mesh, from its charge; or one per component. docs/theory/charge.md explains and justifies. */
#pragma once

#include "src/mesh/mesh.h"

typedef struct region_options {
    bool published;       /* equalize with the seed's 256 bins instead of by rank; default false */
    double threshold;     /* equalized densities up to this form the clusters; default 0.1 */
    double growing_share; /* larger clusters, by triangles of their component, grow; default 1/400 */
    double part_share;    /* no part that is cut off has less of its component's area; default 0.02 */
    double gain;          /* a cut raises the share that is firmly visible by this much, or is not made: see
                           * select_cuts; default 0.015; -1: every cut is made */
    const double *const
        *frames;          /* positions in frames of a motion, in which triangles are seen or not as at rest */
    uint32_t frame_count; /* at most FRAMES_MOST; default 0 */
    const double *
        stiffness; /* of each triangle, positive and finite, unless the rules are the published ones; default NULL */
} region_options;

region_options region_options_defaults(void);

/* density: charge per area of each triangle, finite. Regions are connected, lie in one component each, and
 * are numbered from 0 by their first triangles. The same input gives the same regions. Both outputs are
 * written on success only; so are the detector points, to be freed by context_free, which are left alone where the rules are the
 * published ones: there they are the centroids. */
cscd_status regions_from_charge(const cscd_mesh *mesh, const double *positions, const double *density,
                                const region_options *options, uint32_t *region_of_triangle,
                                uint32_t *region_count, double **detector_points);

/* One region per component, with the component's number. */
cscd_status regions_single(const cscd_mesh *mesh, uint32_t *region_of_triangle, uint32_t *region_count);
