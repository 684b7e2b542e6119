/* Finds the shortest ways through soft material, by relaxation: the result does not depend on the order of the steps. */
#include "preprocess/regions/soft_paths.h"

#include "preprocess/regions/stiffness.h"

#include <string.h>

enum { NO_SEAT = UINT32_MAX };

static array_list list_arrays(soft_paths *p) {
    const size_t n = p->g->count;
    return (array_list){{ARRAY(p->steps, p->g->flow.link_count), ARRAY(p->rows, p->row_count * n),
                         ARRAY(p->seats, p->row_count), ARRAY(p->queue, n), ARRAY(p->waiting, n)}};
}

static double find_step(const tile_graph *g, uint32_t a, uint32_t b) {
    const double *p = g->items[a].centroid, *q = g->items[b].centroid;
    const double d[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
    return soft_step(g->stiffness[a], g->stiffness[b],
                     sqrt((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / g->area));
}

cscd_status soft_paths_create(const tile_graph *g, uint32_t row_count, soft_paths *out) {
    *out = (soft_paths){.g = g, .row_count = row_count};
    if (g->stiffness == NULL) return CSCD_OK;
    if (!context_reserve_all(g->context, list_arrays(out))) {
        *out = (soft_paths){0};
        return context_out_of_memory(g->context);
    }
    for (uint32_t t = 0; t < g->count; t++)
        for (uint32_t j = g->offsets[t]; j < g->offsets[t + 1]; j++)
            out->steps[j] = find_step(g, t, g->neighbours[j]);
    for (uint32_t row = 0; row < row_count; row++) out->seats[row] = NO_SEAT;
    memset(out->waiting, 0, g->count * sizeof *out->waiting);
    return CSCD_OK;
}

void soft_paths_destroy(soft_paths *p) {
    if (p->g != NULL) context_free_all(p->g->context, list_arrays(p));
    *p = (soft_paths){0};
}

/* Takes the steps from a tile; returns how many tiles have joined the queue, which begins at first and has so many already. */
static uint32_t relax_links(soft_paths *p, uint32_t t, double *row, uint32_t first, uint32_t queued) {
    const tile_graph *g = p->g;
    uint32_t joined = 0;
    for (uint32_t j = g->offsets[t]; j < g->offsets[t + 1]; j++) {
        const uint32_t other = g->neighbours[j];
        const double way = row[t] + p->steps[j];
        if (way >= row[other]) continue;
        row[other] = way;
        if (p->waiting[other]) continue;
        p->waiting[other] = true;
        p->queue[((size_t)first + queued + joined++) % g->count] = other;
    }
    return joined;
}

void soft_paths_set(soft_paths *p, uint32_t row, uint32_t seat) {
    if (p->rows == NULL || p->seats[row] == seat) return;
    const tile_graph *g = p->g;
    double *ways = p->rows + (size_t)row * g->count;
    p->seats[row] = seat;
    for (uint32_t t = 0; t < g->count; t++) ways[t] = BEYOND_BLINDNESS;
    ways[seat] = 0.0;
    p->queue[0] = seat;
    for (uint32_t first = 0, queued = 1; queued > 0; first = (first + 1) % g->count) {
        const uint32_t t = p->queue[first];
        p->waiting[t] = false;
        queued += relax_links(p, t, ways, first, queued) - 1;
    }
}

double soft_paths_unseen(const soft_paths *p, uint32_t row, const tile_set *set, const sight_point *point) {
    double unseen = 0.0;
    for (uint32_t i = 0; i < set->count && p->rows != NULL; i++) {
        const uint32_t t = set->members[i];
        const double by_sight = tile_blindness(p->g, t, point);
        unseen += p->g->items[t].area * (soft_paths_blindness(p, row, t, by_sight) - by_sight);
    }
    return unseen;
}
