/* Lengths of edges at rest, by which a barrier judges whether two of them are nearly parallel. */
#include "runtime/detector/edge_rest.h"

#include "src/core/vec3.h"

#include <string.h>

/* Between these, 1e-3 times a fourth power neither over- nor underflows. */
static const double shortest = 0x1p-250, longest = 0x1p250;

static double squared_length_of(const cscd_mesh *mesh, const double *x, uint32_t edge) {
    const uint32_t *ends = mesh->edges[edge];
    return vec3_squared_distance(x + (size_t)ends[0] * 3, x + (size_t)ends[1] * 3);
}

static cscd_status check_lengths(cscd_context *context, const cscd_mesh *mesh, const double *squared) {
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        double length = sqrt(squared[e]);
        if (length == 0.0 || (length >= shortest && length <= longest)) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "edge %u is %g long at rest, expected 0 or a length from 2^-250 to 2^250", e,
                            length);
    }
    return CSCD_OK;
}

cscd_status edge_rest_set(cscd_context *context, const cscd_mesh *mesh, const double *positions,
                          edge_rest *r) {
    double *squared = context_allocate(context, mesh->edge_count, sizeof *squared);
    if (squared == NULL) return context_out_of_memory(context);
    for (uint32_t e = 0; e < mesh->edge_count; e++) squared[e] = squared_length_of(mesh, positions, e);
    cscd_status status = check_lengths(context, mesh, squared);
    if (status != CSCD_OK) {
        context_free(context, squared);
        return status;
    }
    context_free(context, r->squared_lengths);
    r->squared_lengths = squared;
    return CSCD_OK;
}

/* Vertices of one origin are at one place at rest, so an edge is as long as its origin. */
cscd_status edge_rest_move(cscd_context *context, const edge_rest *r, const cscd_mesh_change *change,
                           edge_rest *out) {
    *out = (edge_rest){NULL};
    if (r->squared_lengths == NULL) return CSCD_OK;
    double *moved = context_reserve(context, change->edges.new_count, sizeof *moved);
    if (moved == NULL) return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < change->run_count; i++) {
        const object_run *run = &change->runs[i];
        memcpy(moved + run->to.edge, r->squared_lengths + run->from.edge,
               run->from.edge_count * sizeof *moved);
    }
    for (uint32_t i = 0; i < change->described_count; i++) {
        const object_range *range = &change->described[i];
        for (uint32_t e = range->edge; e < range->edge + range->edge_count; e++) {
            uint32_t origin = change->edges.to_old[e];
            moved[e] = origin != UINT32_MAX ? r->squared_lengths[origin] : 0.0;
        }
    }
    out->squared_lengths = moved;
    return CSCD_OK;
}

cscd_status edge_rest_copy(const edge_rest *r, const cscd_mesh *mesh, edge_rest *out) {
    edge_rest copy = *r;
    array_list list = {{ARRAY(copy.squared_lengths, mesh->edge_count)}};
    if (!context_copy_all(mesh->context, list)) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

void edge_rest_free(cscd_context *context, edge_rest *r) {
    context_free(context, r->squared_lengths);
    *r = (edge_rest){NULL};
}
