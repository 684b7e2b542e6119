/* Steps that shorten intersection curves (P. Volino, N. Magnenat-Thalmann, Resolving Surface Collisions through Intersection Contour
 * Minimization, ACM Transactions on Graphics 25, 2006). They lead out where no side is wrong: a curve that begins at the border of one
 * sheet and ends at that of the other divides neither. */
#include "runtime/untangle/untangle.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* Writes the direction against the gradient with the least elastic energy, and returns by how much a unit of it shortens. */
static cscd_status find_direction(untangle_work *w, const cscd_measures *lengths, double spread,
                                  double *shortens) {
    const vertex_graph *g = &w->graph;
    vertex_region *r = &w->region;
    vertex_region_clear(r);
    for (size_t i = 0; i < lengths->gradient_count; i++)
        vertex_region_add(r, g, lengths->gradients[i].vertex);
    vertex_region_grow(r, g, elastic_rings(w, 4.0 * spread));
    if (!block_system_begin(&w->system, r->count) || !elastic_add(w, spread)) return CSCD_OUT_OF_MEMORY;
    memset(w->right_side, 0, 3 * (size_t)r->count * sizeof *w->right_side);
    for (size_t i = 0; i < lengths->gradient_count; i++) {
        const uint32_t row = vertex_region_row(r, g, lengths->gradients[i].vertex);
        double *side = w->right_side + 3 * (size_t)row;
        if (row != NO_ROW) vec3_add_scaled(side, -1.0, lengths->gradients[i].gradient, side);
    }
    cscd_status status = block_system_factor(&w->system);
    if (status != CSCD_OK) return status;
    block_system_solve(&w->system, w->right_side);
    *shortens = 0.0;
    for (size_t i = 0; i < lengths->gradient_count; i++) {
        const uint32_t row = vertex_region_row(r, g, lengths->gradients[i].vertex);
        if (row != NO_ROW)
            *shortens -= vec3_dot(w->right_side + 3 * (size_t)row, lengths->gradients[i].gradient);
    }
    return CSCD_OK;
}

/* The share of the direction that brings the sum to 0, if it went on so; but no vertex goes farther than that. */
static double step_share(const untangle_work *w, double sum, double shortens, double farthest) {
    double longest = 0.0;
    for (size_t row = 0; row < w->region.count; row++)
        longest = max_of(longest, vec3_dot(w->right_side + 3 * row, w->right_side + 3 * row));
    if (!(shortens > 0.0) || !(longest > 0.0)) return 0.0;
    return min_of(sum / shortens, farthest / sqrt(longest));
}

cscd_status shorten_curves(untangle_work *w, double spread, double farthest, double *x) {
    cscd_measures lengths;
    double shortens;
    cscd_status status = detector_curve_lengths(w->detector, WORK_VIEW(w, x), NULL, &lengths);
    if (status != CSCD_OK || lengths.gradient_count == 0) return status;
    status = find_direction(w, &lengths, spread, &shortens);
    if (status != CSCD_OK) return status;
    const double share = step_share(w, lengths.sum, shortens, farthest);
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        const uint32_t row = vertex_region_row(&w->region, &w->graph, v);
        double *at = x + 3 * (size_t)v;
        if (row != NO_ROW) vec3_add_scaled(at, share, w->right_side + 3 * (size_t)row, at);
    }
    return CSCD_OK;
}
