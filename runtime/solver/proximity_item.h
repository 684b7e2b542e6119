/* One item of a list of proximities: vertices, weights and nearest points of a pair. */
#pragma once

#include "runtime/detector/edge_rest.h"

/* What items are described by. */
typedef struct proximity_scene {
    const cscd_mesh *mesh;
    const double *positions;
    const edge_rest *rest;
} proximity_scene;

/* Describes a pair of features as it was found. */
void proximity_describe(const proximity_scene *scene, const cscd_contact *found, cscd_proximity *out);

/* Describes two vertices, or an edge and a vertex, from their positions alone, so that it does not matter which pairs
 * of features they were found by. The numbers of pairs are left 0. */
void proximity_describe_parts(const proximity_scene *scene, cscd_contact_kind kind, uint32_t a, uint32_t b,
                              cscd_proximity *out);

/* Are these two edges so nearly parallel that the mollifier of their energy is below 1? */
bool edges_mollified(const proximity_scene *scene, uint32_t a, uint32_t b);
