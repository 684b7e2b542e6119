/* Turns near particles into warnings: the nearest two of every pair of parts, and the exact check of their
 * cells. */
#include "sensors/sensors.h"

#include "src/core/timer.h"

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
