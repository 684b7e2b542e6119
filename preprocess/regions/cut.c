/* The shortest cut through a band of triangles: a minimum cut of the dual graph, by maximum flow. */
#include "preprocess/regions/cut.h"

enum { NO_LEVEL = UINT32_MAX };

static array_list list_arrays(cutter *c) {
    size_t n = c->mesh->triangle_count;
    return (array_list){{ARRAY(c->residuals, c->graph->link_count), ARRAY(c->supplies, n),
                         ARRAY(c->drains, n), ARRAY(c->levels, n), ARRAY(c->current, n), ARRAY(c->queue, n),
                         ARRAY(c->path, n)}};
}

cscd_status cutter_create(const cscd_mesh *mesh, const dual_graph *graph, const int64_t *capacities,
                          cutter *out) {
    cutter c = {.mesh = mesh, .graph = graph, .capacities = capacities};
    if (!context_allocate_all(mesh->context, list_arrays(&c))) return context_out_of_memory(mesh->context);
    *out = c;
    return CSCD_OK;
}

void cutter_destroy(cutter *c) {
    if (c->mesh == NULL) return;
    context_free_all(c->mesh->context, list_arrays(c));
}

static int64_t smaller_amount(int64_t a, int64_t b) {
    return a < b ? a : b;
}

/* Turns capacities to the parts into supplies and drains, and settles the flow straight through each
 * triangle. */
static void set_supplies(cutter *c, const uint32_t *parts, const uint32_t *band, uint32_t band_size,
                         uint32_t part) {
    c->cost = 0;
    for (uint32_t i = 0; i < band_size; i++) {
        uint32_t t = band[i];
        c->supplies[t] = c->drains[t] = 0;
        for (uint32_t j = c->graph->offsets[t]; j < c->graph->offsets[t + 1]; j++) {
            uint32_t other = parts[c->graph->neighbours[j]];
            c->residuals[j] = other == 0 ? c->capacities[j] : 0;
            if (other == part) c->supplies[t] += c->capacities[j];
            if (other != 0 && other != part) c->drains[t] += c->capacities[j];
        }
        int64_t through = smaller_amount(c->supplies[t], c->drains[t]);
        c->supplies[t] -= through;
        c->drains[t] -= through;
        c->cost += through;
    }
}

/* Goes breadth first from all supplies along links that can still carry flow. Returns how many triangles are
 * reached; they are at the front of the queue. */
static uint32_t find_levels(cutter *c, const uint32_t *band, uint32_t band_size) {
    uint32_t end = 0;
    for (uint32_t i = 0; i < band_size; i++) {
        uint32_t t = band[i];
        c->levels[t] = c->supplies[t] > 0 ? 0 : NO_LEVEL;
        c->current[t] = c->graph->offsets[t];
        if (c->supplies[t] > 0) c->queue[end++] = t;
    }
    for (uint32_t next = 0; next < end; next++) {
        uint32_t t = c->queue[next];
        for (uint32_t j = c->graph->offsets[t]; j < c->graph->offsets[t + 1]; j++) {
            uint32_t neighbour = c->graph->neighbours[j];
            if (c->residuals[j] == 0 || c->levels[neighbour] != NO_LEVEL) continue;
            c->levels[neighbour] = c->levels[t] + 1;
            c->queue[end++] = neighbour;
        }
    }
    return end;
}

/* Steps from t to the next level. Returns false when no link is left. */
static bool step_forward(cutter *c, uint32_t *t, uint32_t *length) {
    for (; c->current[*t] < c->graph->offsets[*t + 1]; c->current[*t]++) {
        uint32_t j = c->current[*t], neighbour = c->graph->neighbours[j];
        if (c->residuals[j] == 0 || c->levels[neighbour] != c->levels[*t] + 1) continue;
        c->path[(*length)++] = j;
        *t = neighbour;
        return true;
    }
    return false;
}

/* Steps back along the last link, which is not tried again. Returns false at the start of the path. */
static bool step_back(cutter *c, uint32_t *t, uint32_t *length) {
    if (*length == 0) return false;
    *t = c->graph->neighbours[c->graph->twins[c->path[--*length]]];
    c->current[*t]++;
    return true;
}

/* Sends as much as possible from one triangle along paths of growing level. */
static bool send_from(cutter *c, uint32_t source) {
    bool sent = false;
    while (c->supplies[source] > 0) {
        uint32_t t = source, length = 0;
        while (c->drains[t] == 0) {
            if (!step_forward(c, &t, &length) && !step_back(c, &t, &length)) return sent;
        }
        int64_t amount = smaller_amount(c->supplies[source], c->drains[t]);
        for (uint32_t i = 0; i < length; i++) amount = smaller_amount(amount, c->residuals[c->path[i]]);
        for (uint32_t i = 0; i < length; i++) {
            c->residuals[c->path[i]] -= amount;
            c->residuals[c->graph->twins[c->path[i]]] += amount;
        }
        c->supplies[source] -= amount;
        c->drains[t] -= amount;
        c->cost += amount;
        sent = true;
    }
    return sent;
}

/* Dinic's algorithm. Capacities are integers, so the flow is exact and the same on every machine. */
uint32_t cutter_separate(cutter *c, const uint32_t *parts, const uint32_t *band, uint32_t band_size,
                         uint32_t part, uint32_t *out) {
    set_supplies(c, parts, band, band_size, part);
    for (;;) {
        uint32_t reached = find_levels(c, band, band_size);
        bool sent = false;
        for (uint32_t i = 0; i < reached; i++) {
            if (c->supplies[c->queue[i]] > 0 && send_from(c, c->queue[i])) sent = true;
        }
        if (sent) continue;
        for (uint32_t i = 0; i < reached; i++) out[i] = c->queue[i];
        return reached;
    }
}
