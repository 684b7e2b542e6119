/* A minimum cut of a graph whose nodes have supplies and drains, by maximum flow. */
#include "preprocess/regions/tiles.h"

enum { NO_LEVEL = UINT32_MAX };

static array_list list_arrays(min_cut *c) {
    const size_t n = c->graph.node_count;
    return (array_list){{ARRAY(c->residuals, c->graph.link_count), ARRAY(c->supplies, n), ARRAY(c->drains, n),
                         ARRAY(c->levels, n), ARRAY(c->current, n), ARRAY(c->queue, n), ARRAY(c->path, n)}};
}

cscd_status min_cut_create(cscd_context *context, const flow_graph *graph, min_cut *out) {
    min_cut c = {.context = context, .graph = *graph};
    if (!context_allocate_all(context, list_arrays(&c))) return context_out_of_memory(context);
    *out = c;
    return CSCD_OK;
}

void min_cut_destroy(min_cut *c) {
    if (c->context != NULL) context_free_all(c->context, list_arrays(c));
}

static int64_t smaller_amount(int64_t a, int64_t b) {
    return a < b ? a : b;
}

/* Settles the flow straight through each node. */
static void settle_nodes(min_cut *c, const uint32_t *nodes, uint32_t node_count) {
    c->cost = 0;
    for (uint32_t i = 0; i < node_count; i++) {
        const int64_t through = smaller_amount(c->supplies[nodes[i]], c->drains[nodes[i]]);
        c->supplies[nodes[i]] -= through;
        c->drains[nodes[i]] -= through;
        c->cost += through;
    }
}

/* Goes breadth first from all supplies along links that can still carry flow. Returns how many nodes are reached; they are at the
 * front of the queue. */
static uint32_t find_levels(min_cut *c, const uint32_t *nodes, uint32_t node_count) {
    const flow_graph *g = &c->graph;
    uint32_t end = 0;
    for (uint32_t i = 0; i < node_count; i++) {
        const uint32_t n = nodes[i];
        c->levels[n] = c->supplies[n] > 0 ? 0 : NO_LEVEL;
        c->current[n] = g->offsets[n];
        if (c->supplies[n] > 0) c->queue[end++] = n;
    }
    for (uint32_t next = 0; next < end; next++) {
        const uint32_t n = c->queue[next];
        for (uint32_t j = g->offsets[n]; j < g->offsets[n + 1]; j++) {
            const uint32_t neighbour = g->neighbours[j];
            if (c->residuals[j] == 0 || c->levels[neighbour] != NO_LEVEL) continue;
            c->levels[neighbour] = c->levels[n] + 1;
            c->queue[end++] = neighbour;
        }
    }
    return end;
}

/* Steps from n to the next level. Returns false when no link is left. */
static bool step_forward(min_cut *c, uint32_t *n, uint32_t *length) {
    const flow_graph *g = &c->graph;
    for (; c->current[*n] < g->offsets[*n + 1]; c->current[*n]++) {
        const uint32_t j = c->current[*n], neighbour = g->neighbours[j];
        if (c->residuals[j] == 0 || c->levels[neighbour] != c->levels[*n] + 1) continue;
        c->path[(*length)++] = j;
        *n = neighbour;
        return true;
    }
    return false;
}

/* Steps back along the last link, which is not tried again. Returns false at the start of the path. */
static bool step_back(min_cut *c, uint32_t *n, uint32_t *length) {
    if (*length == 0) return false;
    *n = c->graph.neighbours[c->graph.twins[c->path[--*length]]];
    c->current[*n]++;
    return true;
}

/* Sends as much as possible from one node along paths of growing level. */
static bool send_from(min_cut *c, uint32_t source) {
    bool sent = false;
    while (c->supplies[source] > 0) {
        uint32_t n = source, length = 0;
        while (c->drains[n] == 0) {
            if (!step_forward(c, &n, &length) && !step_back(c, &n, &length)) return sent;
        }
        int64_t amount = smaller_amount(c->supplies[source], c->drains[n]);
        for (uint32_t i = 0; i < length; i++) amount = smaller_amount(amount, c->residuals[c->path[i]]);
        for (uint32_t i = 0; i < length; i++) {
            c->residuals[c->path[i]] -= amount;
            c->residuals[c->graph.twins[c->path[i]]] += amount;
        }
        c->supplies[source] -= amount;
        c->drains[n] -= amount;
        c->cost += amount;
        sent = true;
    }
    return sent;
}

uint32_t min_cut_run(min_cut *c, const uint32_t *nodes, uint32_t node_count) {
    settle_nodes(c, nodes, node_count);
    for (;;) {
        const uint32_t reached = find_levels(c, nodes, node_count);
        bool sent = false;
        for (uint32_t i = 0; i < reached; i++)
            if (c->supplies[c->queue[i]] > 0 && send_from(c, c->queue[i])) sent = true;
        if (!sent) return reached;
    }
}
