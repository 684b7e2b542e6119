/* Regions of a mesh, from its charge; or one per component. docs/theory/charge.md explains and justifies. */
#pragma once

#include "src/mesh/mesh.h"

typedef struct region_options {
    double threshold; /* borders run along the triangles of least charge: this is their share; default 0.1 */
    const double *const
        *frames;          /* positions in frames of a motion, in which triangles are seen or not as at rest */
    uint32_t frame_count; /* at most FRAMES_MOST; default 0 */
    const double *stiffness; /* of each triangle, positive and finite; default NULL */
} region_options;

region_options region_options_defaults(void);

/* density: charge per area of each triangle, finite. Regions are connected, lie in one component each, and
 * are numbered from 0 by their first triangles. The same input gives the same regions. All outputs are
 * written on success only; the detector points are to be freed by context_free. */
cscd_status regions_from_charge(const cscd_mesh *mesh, const double *positions, const double *density,
                                const region_options *options, uint32_t *region_of_triangle,
                                uint32_t *region_count, double **detector_points);

/* One region per component, with the component's number. */
cscd_status regions_single(const cscd_mesh *mesh, uint32_t *region_of_triangle, uint32_t *region_count);
