/* Gathers the near particles of watched parts over several moments and sorts them by pairs of parts, without
 * a table of all pairs of parts. */
#include "sensors/particle_pairs.h"

#include "src/core/sort.h"
#include "src/core/vec3.h"

enum { CAPACITY_LEAST = 64 };

void particle_pairs_free(cscd_context *context, particle_pairs *pairs) {
    context_free(context, pairs->items);
    context_free(context, pairs->scratch);
    *pairs = (particle_pairs){0};
}

static cscd_status reserve_pairs(cscd_context *context, particle_pairs *pairs) {
    if (pairs->count < pairs->capacity) return CSCD_OK;
    size_t capacity = pairs->capacity > 0 ? 2 * pairs->capacity : CAPACITY_LEAST;
    near_particles *scratch = context_allocate(context, capacity, sizeof *scratch);
    if (scratch == NULL) return CSCD_OUT_OF_MEMORY;
    near_particles *items = context_grow(context, pairs->items, pairs->count, capacity, sizeof *items);
    if (items == NULL) {
        context_free(context, scratch);
        return CSCD_OUT_OF_MEMORY;
    }
    context_free(context, pairs->scratch);
    *pairs = (particle_pairs){items, scratch, pairs->count, capacity};
    return CSCD_OK;
}

static near_particles pair_of(const sensor_partition *partition, uint32_t a, uint32_t b) {
    bool ordered = partition->vertex_parts[a] < partition->vertex_parts[b];
    uint32_t first = ordered ? a : b, second = ordered ? b : a;
    return (near_particles){.part_a = partition->vertex_parts[first],
                            .part_b = partition->vertex_parts[second],
                            .cell_a = partition->vertex_cells[first],
                            .cell_b = partition->vertex_cells[second],
                            .vertex_a = first,
                            .vertex_b = second};
}

cscd_status particle_pairs_gather(particle_pairs *pairs, particles *p, const sensor_partition *partition,
                                  const sensor_reach *reach, const double *x, uint32_t moment,
                                  double *closest) {
    double limit = reach->mu_most, nearest = INFINITY;
    particle_grid_build(&p->grid, x, p->vertices, p->groups, p->count, limit);
    for (uint32_t i = 0; i < p->count; i++) {
        const double *at = x + (size_t)p->vertices[i] * 3;
        grid_search search = particle_grid_around(&p->grid, at);
        for (const grid_entry *e; (e = grid_search_next(&search)) != NULL;) {
            if (e->particle <= i || e->group == p->groups[i]) continue;
            double d[3];
            vec3_subtract(e->x, at, d);
            double distance = sqrt(vec3_dot(d, d));
            p->counters.distances++;
            if (!(distance < limit)) continue;
            nearest = min_of(nearest, distance);
            near_particles pair = pair_of(partition, p->vertices[i], p->vertices[e->particle]);
            if (!(distance < sensor_reach_mu(reach, pair.part_a, pair.part_b))) continue;
            if (reserve_pairs(p->context, pairs) != CSCD_OK) return CSCD_OUT_OF_MEMORY;
            pair.distance = distance;
            pair.moment = moment;
            pairs->items[pairs->count++] = pair;
        }
    }
    *closest = nearest;
    return CSCD_OK;
}

static int order_of(uint32_t a, uint32_t b) {
    return (a > b) - (a < b);
}

static int compare_pairs(const void *first, const void *second) {
    const near_particles *a = first, *b = second;
    int by_parts = order_of(a->part_a, b->part_a);
    if (by_parts == 0) by_parts = order_of(a->part_b, b->part_b);
    if (by_parts != 0) return by_parts;
    if (a->distance != b->distance) return a->distance < b->distance ? -1 : 1;
    if (a->moment != b->moment) return order_of(a->moment, b->moment);
    int by_vertex = order_of(a->vertex_a, b->vertex_a);
    return by_vertex != 0 ? by_vertex : order_of(a->vertex_b, b->vertex_b);
}

void particle_pairs_sort(particle_pairs *pairs) {
    sort_items(pairs->items, pairs->scratch, pairs->count, sizeof *pairs->items, compare_pairs);
}
