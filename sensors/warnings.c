/* Turns near particles into warnings: gathers them, sorts them by pairs of parts, and finds the nearest two of each pair, and
 * the exact check of their cells. */
#include "sensors/sensors.h"

#include "src/core/sort.h"
#include "src/core/timer.h"
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

/* ---- warnings ------------------------------------------------------------------------------------------ */

static bool same_parts(const near_particles *a, const near_particles *b) {
    return a->part_a == b->part_a && a->part_b == b->part_b;
}

/* Returns the end of the pairs of the same two parts that begin at `begin`. */
static size_t end_of_parts(const particle_pairs *pairs, size_t begin) {
    size_t end = begin + 1;
    while (end < pairs->count && same_parts(&pairs->items[end], &pairs->items[begin])) end++;
    return end;
}

static cscd_status reserve_warnings(cscd_sensors *s, size_t count) {
    if (count <= s->warning_capacity) return CSCD_OK;
    size_t capacity = count + count / 2;
    cscd_warning *warnings = context_allocate(s->context, capacity, sizeof *warnings);
    if (warnings == NULL) return CSCD_OUT_OF_MEMORY;
    context_free(s->context, s->warnings);
    s->warnings = warnings;
    s->warning_capacity = capacity;
    return CSCD_OK;
}

static cscd_warning warning_of(const cscd_sensors *s, const near_particles *nearest) {
    const cscd_sensor_part *parts = s->partition.parts;
    return (cscd_warning){.part_a = nearest->part_a,
                          .part_b = nearest->part_b,
                          .object_a = parts[nearest->part_a].object,
                          .object_b = parts[nearest->part_b].object,
                          .vertex_a = nearest->vertex_a,
                          .vertex_b = nearest->vertex_b,
                          .distance = nearest->distance,
                          .time = nearest->moment};
}

static void add_cell(cscd_sensors *s, uint32_t cell, uint32_t *cells, uint32_t *count) {
    if (s->cell_checks[cell] == s->checks) return;
    s->cell_checks[cell] = s->checks;
    cells[(*count)++] = cell;
}

/* Checks the cells of the pairs from begin to end, each cell once. */
static cscd_status check_cells(cscd_sensors *s, size_t begin, size_t end, const double *x0, const double *x1,
                               area_verdict *verdict) {
    area_query query = {x0, x1, s->cells_a, s->cells_b, 0, 0};
    s->checks++;
    for (size_t i = begin; i < end; i++) {
        add_cell(s, s->pairs.items[i].cell_a, s->cells_a, &query.count_a);
        add_cell(s, s->pairs.items[i].cell_b, s->cells_b, &query.count_b);
    }
    return exact_check_run(&s->exact, &s->partition, &query, verdict);
}

cscd_status sensor_verdict(cscd_sensors *s, const double *start, const double *end, size_t *count,
                           cscd_sensor_timings *timings, cscd_sensor_counters *counters) {
    double since = timer_now_ms();
    const particle_pairs *pairs = &s->pairs;
    particle_pairs_sort(&s->pairs);
    size_t warnings = 0;
    for (size_t i = 0; i < pairs->count; i = end_of_parts(pairs, i)) warnings++;
    if (reserve_warnings(s, warnings) != CSCD_OK) return CSCD_OUT_OF_MEMORY;
    *count = 0;
    for (size_t i = 0; i < pairs->count; i = end_of_parts(pairs, i))
        s->warnings[(*count)++] = warning_of(s, &pairs->items[i]);
    timer_lap(&since, &timings->verdict_ms);
    if (!s->options.exact) return CSCD_OK;

    cscd_warning *warning = s->warnings;
    for (size_t i = 0; i < pairs->count; i = end_of_parts(pairs, i), warning++) {
        area_verdict verdict = {false, 0.0, 0};
        cscd_status status = check_cells(s, i, end_of_parts(pairs, i), start, end, &verdict);
        if (status != CSCD_OK) return status;
        warning->contact = verdict.contact;
        warning->toi = verdict.toi;
        counters->tests += verdict.tests;
    }
    timer_lap(&since, &timings->exact_ms);
    return CSCD_OK;
}
