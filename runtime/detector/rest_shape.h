/* A mesh at rest: lengths of edges, by which a barrier judges whether two of them are nearly parallel, and areas, by which
 * pairs of features weigh. */
#pragma once

#include "src/mesh/mesh_change.h"

typedef struct rest_shape {
    double *squared_lengths; /* per edge; NULL: rest is not known */
    double *triangle_areas;
    /* Per vertex and edge: a third of the areas of its triangles; where there are none, the length of a wire's edge, half of
     * those at a wire's vertex, and 1 of a point. */
    double *vertex_areas, *edge_areas;
} rest_shape;

/* Takes lengths and areas from checked positions, in place of those before. On failure, those before stay: OUT_OF_MEMORY,
 * or INVALID_ARGUMENT for an edge whose length has no fourth power. */
cscd_status rest_shape_set(cscd_context *context, const cscd_mesh *mesh, const double *positions,
                           rest_shape *r);

/* Edges keep the lengths of their origins, and triangles the areas; of those without one nothing is known, so threshold
 * and area are 0. On failure *out holds nothing. */
cscd_status rest_shape_move(const rest_shape *r, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            rest_shape *out);

/* mesh: the same one in the context of the copy. On failure *out is untouched. */
cscd_status rest_shape_copy(const rest_shape *r, const cscd_mesh *mesh, rest_shape *out);
void rest_shape_free(cscd_context *context, rest_shape *r);

/* The threshold of the mollifier (Li et al. 2020, eq. 24); 0 where rest is not known. */
static inline double rest_shape_threshold(const rest_shape *r, uint32_t a, uint32_t b) {
    return r->squared_lengths == NULL ? 0.0 : 1e-3 * r->squared_lengths[a] * r->squared_lengths[b];
}

/* The weight of a pair of features (Li et al. 2023; cscd_detector_set_rest); 1 where rest is not known. */
static inline double rest_shape_weight(const rest_shape *r, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (r->squared_lengths == NULL) return 1.0;
    if (kind == CSCD_CONTACT_VH) return r->vertex_areas[a];
    if (kind == CSCD_CONTACT_VF) return 0.25 * r->vertex_areas[a];
    if (kind == CSCD_CONTACT_EE) return 0.25 * (r->edge_areas[a] + r->edge_areas[b]);
    const double of_a = kind == CSCD_CONTACT_EV ? r->edge_areas[a] : r->vertex_areas[a];
    return 0.25 * (of_a + r->vertex_areas[b]);
}
