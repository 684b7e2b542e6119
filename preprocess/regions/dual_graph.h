/* The mesh's dual graph: triangles, joined across their common edges. */
#pragma once

#include "src/mesh/mesh.h"

#define DUAL_NO_EDGE UINT32_MAX

/* Link i of triangle t lies in [offsets[t], offsets[t + 1]). The triangles of one edge are joined in a chain,
 * in their order. Where patches of one component meet at a vertex only, one link without an edge joins them,
 * so that each component is connected. */
typedef struct dual_graph {
    uint32_t triangle_count, link_count; /* each link counts twice, once from either end */
    uint32_t *offsets, *neighbours;
    uint32_t *edges; /* of the mesh; DUAL_NO_EDGE */
} dual_graph;

cscd_status dual_graph_build(const cscd_mesh *mesh, dual_graph *out);
void dual_graph_free(const cscd_mesh *mesh, dual_graph *graph);

/* Numbers the connected pieces of equal label from 0, in the order of the list, which is ascending and
 * holds whole components.
 * labels may be the same array as pieces; scratch has room for every triangle of the mesh. */
uint32_t dual_graph_pieces(const dual_graph *graph, const uint32_t *list, uint32_t count,
                           const uint32_t *labels, uint32_t *pieces, uint32_t *scratch);
