/* Weighs edges by their charge, and by how stiff the material is. */
#include "preprocess/regions/edge_weights.h"

#include "preprocess/regions/stiffness.h"
#include "src/mesh/surface.h"

/* An edge costs its length where the charge is high, and this share of it where the charge is lowest. The cost falls from three times
 * the threshold on: cuts run along creases, and elsewhere they are short. */
static const double crease = 0.1, crease_ranks = 3.0;

/* The mean of the ranks beside an edge. */
static double rank_beside(const cscd_mesh *mesh, const double *ranks, uint32_t edge) {
    double sum = 0.0;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++)
        sum += ranks[mesh->edge_stars[i]] / edge_star_size(mesh, edge);
    return sum;
}

void weigh_edges(const cscd_mesh *mesh, const double *positions, const double *equalized,
                 const double *stiffness_shares, const region_options *options, double *weights) {
    const double high = fmin(1.0, crease_ranks * options->threshold);
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const double rank = fmin(1.0, rank_beside(mesh, equalized, e) / high);
        double share = 1.0 - (1.0 - crease) * (1.0 - rank);
        if (stiffness_shares != NULL)
            share = fmin(share, fmax(crease, stiffness_beside(mesh, stiffness_shares, e)));
        weights[e] = surface_edge_length(mesh, positions, e) * share;
    }
}
