/* Regions of a mesh and their detector points: from its charge, by k-means, or one per component. docs/theory/charge.md explains
 * and justifies. */
#pragma once

#include "src/mesh/mesh.h"

/* Frames of a motion that are looked at besides the rest. */
enum { FRAMES_MOST = 8 };

/* ---- from charge --------------------------------------------------------------------------------------- */

typedef struct region_options {
    double threshold; /* borders run along the triangles of least charge: this is their share; default 0.1 */
    /* Positions in frames of a motion, in which triangles are seen or not as at rest. */
    const double *const *frames;
    uint32_t frame_count;    /* at most FRAMES_MOST; default 0 */
    const double *stiffness; /* of each triangle, positive and finite; default NULL */
} region_options;

region_options region_options_defaults(void);

/* density: charge per area of each triangle, finite. Regions are connected, lie in one component each, and
 * are numbered from 0 by their first triangles. The same input gives the same regions. All outputs are
 * written on success only; the detector points are to be freed by context_free. */
cscd_status regions_from_charge(const cscd_mesh *mesh, const double *positions, const double *density,
                                const region_options *options, uint32_t *region_of_triangle,
                                uint32_t *region_count, double **detector_points);

/* equalized[t], in (0, 1]: the rank of the triangle's density in its component, from 1, divided by the component's triangle
 * count. Densities are first rounded to 24 bits; then ties are broken by index. Any finite densities.
 * INVALID_ARGUMENT names the triangle whose density is not finite. */
cscd_status equalize(const cscd_mesh *mesh, const double *density, double *equalized);

/* ---- without charge ------------------------------------------------------------------------------------ */

/* One region per component, with the component's number. */
cscd_status regions_single(const cscd_mesh *mesh, uint32_t *region_of_triangle, uint32_t *region_count);

/* Lloyd's iteration over the vertices of each component from random vertices, at most 200 rounds; a centroid
 * is free and need not be a vertex. Then each triangle goes to the centroid whose anchor, the nearest vertex
 * of its cluster, is fewest edges away; ties go to the first. Parts that this leaves apart join a neighbour.
 *
 * k is shared out over the components by their vertices, at least one each, at most one per vertex: so
 * *region_count may be more than k (as many components) or less (few vertices; a centroid whose triangles
 * are all nearer to others has no region). detector_points has room for 3 * kmeans_capacity(mesh, k).
 * Regions are connected, lie in one component each and are numbered by their first triangles. The same seed
 * gives the same regions. INVALID_ARGUMENT: k is 0. Outputs are written on success only. */
cscd_status regions_kmeans(const cscd_mesh *mesh, const double *positions, uint32_t k, uint32_t seed,
                           uint32_t *region_of_triangle, uint32_t *region_count, double *detector_points);

/* The most regions that there can be: k, but not more than vertices, and one per component at least. */
uint32_t kmeans_capacity(const cscd_mesh *mesh, uint32_t k);

/* ---- Lloyd's iteration, external for its tests --------------------------------------------------------- */

enum { LLOYD_ROUNDS_MAX = 200 };

/* A set of points among positions, and where the result goes. */
typedef struct lloyd {
    cscd_context *context;
    const double *positions;
    const uint32_t *points; /* indices into positions */
    uint32_t point_count, k;
    double *centroids;  /* 3 * k */
    uint32_t *clusters; /* of each position; those of other sets stay */
    uint64_t *counts;   /* k, for its own use */
    uint32_t *scratch;  /* point_count, for its own use */
} lloyd;

/* Begins with k different points, 1 <= k <= point_count, and runs until no point changes its cluster, or for
 * LLOYD_ROUNDS_MAX rounds. A point goes to the first of its nearest centroids; an empty cluster keeps its
 * centroid. CANCELLED: the clusters mean nothing. */
cscd_status lloyd_run(const lloyd *l, uint64_t seed);

/* ---- detector points ----------------------------------------------------------------------------------- */

/* The centroid of each region's surface: of its triangles' centroids, weighted by area (equally in a region
 * without area). 3 doubles per region. */
cscd_status detector_points_from_regions(const cscd_mesh *mesh, const double *positions,
                                         const uint32_t *region_of_triangle, uint32_t region_count,
                                         double *points);

/* Writes for each region the share of its area whose triangles face the region's point: S+, (p0 - d) . n > 0.
 * It is 0 in a region without area. */
cscd_status visible_shares(const cscd_mesh *mesh, const double *positions, const uint32_t *region_of_triangle,
                           uint32_t region_count, const double *points, double *shares);

/* Regions with their points, and the motion and the material for which they are judged. */
typedef struct judged_regions {
    const cscd_mesh *mesh;
    const double *positions; /* at rest */
    const double *const *frames;
    uint32_t frame_count;
    const double *stiffness;     /* of each triangle; NULL: as stiff everywhere */
    const uint32_t *of_triangle; /* the region of each triangle */
    uint32_t region_count;
    const double (*points)[3]; /* detector points at rest */
} judged_regions;

/* Predicts the work that regions leave to a step: the share of the triangles, obstacles aside, that it has to
 * look at with others of their component. These are the triangles of components that are not closed, which
 * are not culled; those at the border of their region; and those that its detector point does not see, with
 * those that it hardly sees in part. The share is the mean of the rest and all frames. Triangles beyond soft
 * material count as hardly seen. */
cscd_status regions_tested_share(const judged_regions *regions, double *out);
