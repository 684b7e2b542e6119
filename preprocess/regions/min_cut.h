/* A minimum cut of a graph whose nodes have supplies and drains, by maximum flow (Dinic 1970). */
#pragma once

#include "src/core/context.h"

/* Link i of node n lies in [offsets[n], offsets[n + 1]); twins[i] is the same link from its other end. */
typedef struct flow_graph {
    uint32_t node_count, link_count;
    const uint32_t *offsets, *neighbours, *twins;
} flow_graph;

/* Room for many cuts. Before each the caller sets residuals, supplies and drains: of the nodes of the cut and of their links. Links
 * out of these nodes have a residual of 0. */
typedef struct min_cut {
    cscd_context *context;
    flow_graph graph;
    int64_t *residuals;         /* of a link: what it carries from here to its neighbour */
    int64_t *supplies, *drains; /* of a node */
    uint32_t *levels, *current; /* steps from the supplies; the next link to try */
    uint32_t *queue, *path;     /* nodes; links */
    int64_t cost;               /* of the last cut */
} min_cut;

cscd_status min_cut_create(cscd_context *context, const flow_graph *graph, min_cut *out);
void min_cut_destroy(min_cut *c);

/* Separates all supplies from all drains of the nodes at the least cost. The first nodes of the queue, as many as the result
 * says, stay with the supplies: of all such cuts this is the one with the fewest of them. Capacities are integers, so the flow is
 * exact and the same on every machine. */
uint32_t min_cut_run(min_cut *c, const uint32_t *nodes, uint32_t node_count);
