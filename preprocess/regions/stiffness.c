/* Compares the stiffness of triangles with the greatest of their component. */
#include "preprocess/regions/stiffness.h"

#include <math.h>

static const double least_share = 1e-6;

cscd_status stiffness_shares(const cscd_mesh *mesh, const double *given, double *shares) {
    double *greatest = context_allocate(mesh->context, mesh->component_count, sizeof *greatest);
    if (greatest == NULL) return context_out_of_memory(mesh->context);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        double *most = &greatest[mesh->triangle_components[t]];
        *most = fmax(*most, given[t]);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const float share = (float)(given[t] / greatest[mesh->triangle_components[t]]);
        shares[t] = fmax((double)share, least_share);
    }
    context_free(mesh->context, greatest);
    return CSCD_OK;
}

double stiffness_beside(const cscd_mesh *mesh, const double *shares, uint32_t edge) {
    double sum = 0.0;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++)
        sum += shares[mesh->edge_stars[i]];
    return sum / edge_star_size(mesh, edge);
}
