/* The seams that a detector was given, until it has seen that their vertices belong together. */
#include "runtime/narrow_phase/seam_list.h"

#include "src/mesh/surface.h"

#include <string.h>

cscd_status seam_list_create(const cscd_mesh *mesh, const uint32_t *pairs, size_t count, double reach,
                             seam_list *out) {
    cscd_context *context = mesh->context;
    for (size_t i = 0; i < count; i++) {
        if (pairs[2 * i] == pairs[2 * i + 1])
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "pair %zu of seams has vertex %u twice, expected two vertices; leave it out",
                                i, pairs[2 * i]);
    }
    *out = (seam_list){.count = count, .reach = reach};
    if (count == 0) return CSCD_OK;
    out->vertices = context_allocate(context, count, sizeof(uint32_t[2]));
    if (out->vertices == NULL) return context_out_of_memory(context);
    memcpy(out->vertices, pairs, count * sizeof(uint32_t[2]));
    return CSCD_OK;
}

void seam_list_free(cscd_context *context, seam_list *s) {
    context_free(context, s->vertices);
    s->vertices = NULL;
}

static double longest_edge_at(const cscd_mesh *mesh, const double *positions, uint32_t vertex) {
    double longest = 0.0;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        const uint32_t *edges = mesh->triangle_edges[mesh->vertex_stars[i]];
        for (int k = 0; k < 3; k++) {
            const uint32_t *ends = mesh->edges[edges[k]];
            if (ends[0] == vertex || ends[1] == vertex)
                longest = fmax(longest, surface_edge_length(mesh, positions, edges[k]));
        }
    }
    const loose_objects *loose = &mesh->loose;
    for (uint32_t i = 0; i < wires_at_vertex(mesh, vertex); i++) {
        uint32_t wire = loose->wire_stars[loose->wire_star_offsets[vertex] + i];
        longest = fmax(longest, surface_edge_length(mesh, positions, wire));
    }
    return longest;
}

/* A mistake in the indices joins vertices from anywhere, mostly much farther apart than neighbours are. */
static double usual_reach(const cscd_mesh *mesh, const double *positions, const uint32_t pair[2]) {
    return fmax(longest_edge_at(mesh, positions, pair[0]), longest_edge_at(mesh, positions, pair[1]));
}

static double distance_of(const double *positions, const uint32_t pair[2]) {
    double between[3];
    vec3_subtract(positions + (size_t)pair[0] * 3, positions + (size_t)pair[1] * 3, between);
    return surface_norm(between);
}

cscd_status seam_list_check(const cscd_mesh *mesh, seam_list *s, const double *positions) {
    if (s->vertices == NULL) return CSCD_OK;
    for (size_t i = 0; i < s->count; i++) {
        const uint32_t *pair = s->vertices + 2 * i;
        double distance = distance_of(positions, pair);
        double reach = s->reach > 0.0 ? s->reach : usual_reach(mesh, positions, pair);
        if (distance <= reach) continue;
        return context_fail(
            mesh->context, CSCD_INVALID_ARGUMENT,
            "pair %zu of seams joins the vertices %u and %u, which are %g apart at the first "
            "positions, farther than %s, %g: check the indices, or set seam_reach if they are "
            "to be that far apart",
            i, pair[0], pair[1], distance, s->reach > 0.0 ? "seam_reach" : "the longest edge at them", reach);
    }
    seam_list_free(mesh->context, s);
    return CSCD_OK;
}
