/* One recording under particle sensors of some rules, and what the detector finds in it. */
#include "benchmarks/sensors/trial.h"

#include "models/shapes/body.h"
#include "sensors/sensors.h"
#include "src/core/timer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool api_failed(const recording_data *r, io_error *error) {
    return io_fail(error, "%s: %s", r->name, cscd_context_detail(r->context));
}

static int compare_values(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double sensor_median(double *values, uint32_t count) {
    if (count == 0) return 0.0;
    qsort(values, count, sizeof *values, compare_values);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

/* ---- the truth ---------------------------------------------------------------------------------------- */

static bool find_intervals(const recording_data *r, cscd_detector *detector, const object_map *map,
                           sensor_truth *truth, double *ms, io_error *error) {
    for (uint32_t k = 0; k < truth->interval_count; k++) {
        cscd_contacts contacts;
        truth->touching[k] = object_pairs_none();
        if (cscd_detector_step(detector,
                               CSCD_DOUBLES(recording_data_frame(r, k), cscd_mesh_vertex_count(r->mesh)),
                               CSCD_DOUBLES(recording_data_frame(r, k + 1), cscd_mesh_vertex_count(r->mesh)),
                               &contacts) != CSCD_OK)
            return api_failed(r, error);
        ms[k] = cscd_detector_timings(detector).total_ms;
        if (!object_pairs_of_contacts(r->mesh, map, &contacts, false, &truth->touching[k]))
            return io_fail(error, "out of memory");
    }
    truth->trees_ms = sensor_median(ms, truth->interval_count);
    return true;
}

bool sensor_truth_find(const recording_data *r, sensor_truth *out, io_error *error) {
    sensor_truth truth = {.interval_count = r->frame_count - 1};
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_NONE;
    options.start = CSCD_START_UNKNOWN;
    cscd_detector *detector = NULL;
    cscd_partition *partition = NULL;
    object_map map = {NULL, NULL};
    double *ms = body_allocate(r->frame_count, sizeof *ms);
    truth.touching = body_allocate(r->frame_count, sizeof *truth.touching);
    bool good = (cscd_detector_create(r->context, r->mesh, NULL, &options, &detector) == CSCD_OK &&
                 cscd_partition_create(r->context, r->mesh, NULL,
                                       CSCD_DOUBLES(r->model.positions, cscd_mesh_vertex_count(r->mesh)),
                                       NULL, &partition) == CSCD_OK) ||
                api_failed(r, error);
    good = good && (object_map_make(r->mesh, partition, &map) || io_fail(error, "out of memory")) &&
           find_intervals(r, detector, &map, &truth, ms, error);
    object_map_free(&map);
    cscd_partition_destroy(partition);
    cscd_detector_destroy(detector);
    free(ms);
    if (good)
        *out = truth;
    else
        sensor_truth_free(&truth);
    return good;
}

void sensor_truth_free(sensor_truth *truth) {
    for (uint32_t k = 0; truth->touching != NULL && k < truth->interval_count; k++)
        object_pairs_free(&truth->touching[k]);
    free(truth->touching);
    *truth = (sensor_truth){0};
}

/* ---- sensors ------------------------------------------------------------------------------------------ */

static double mean_edge(const recording_data *r) {
    const double *x = recording_data_frame(r, 0);
    double sum = 0.0;
    for (uint32_t e = 0; e < cscd_mesh_edge_count(r->mesh); e++) {
        uint32_t v[2];
        cscd_mesh_edge(r->mesh, e, v);
        const double *p = x + (size_t)v[0] * 3, *q = x + (size_t)v[1] * 3;
        sum += sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                    (p[2] - q[2]) * (p[2] - q[2]));
    }
    return sum / cscd_mesh_edge_count(r->mesh);
}

/* With a given mu, particles still feel each other as far as they do by default. */
static bool make_sensors(const recording_data *r, const sensor_rules *rules, cscd_partition **partition,
                         cscd_sensors **sensors, io_error *error) {
    const cscd_plan *plan = rules->plan ? r->charge : NULL;
    cscd_partition_options cutting = cscd_partition_defaults();
    cutting.cells = rules->cells;
    if (cscd_partition_create(r->context, r->mesh, plan,
                              CSCD_DOUBLES(r->model.positions, cscd_mesh_vertex_count(r->mesh)), &cutting,
                              partition) != CSCD_OK)
        return api_failed(r, error);
    cscd_sensor_options options = cscd_sensor_defaults();
    options.method = rules->random ? CSCD_SENSORS_RANDOM : CSCD_SENSORS_CELLS;
    if (rules->mu_edges > 0.0) options.collision_distance = rules->mu_edges * mean_edge(r);
    if (rules->random) {
        uint32_t cells = cscd_partition_cell_count(*partition),
                 objects = cscd_partition_object_count(*partition);
        options.particles = rules->as_cells ? (cells + objects - 1) / objects : rules->particles;
        options.seed = rules->seed;
    }
    if (cscd_sensors_create(r->context, r->mesh, *partition, &options, sensors) != CSCD_OK)
        return api_failed(r, error);
    static const particle_rule forces[] = {PARTICLE_ATTRACTION, PARTICLE_ATTRACTION, PARTICLE_SCALAR,
                                           PARTICLE_STRONGEST};
    if (rules->rule != RULE_DEFAULT) (*sensors)->particles.rule = forces[rules->rule];
    return true;
}

/* New cells would not shorten an edge. */
static bool renew_due(const recording_data *r, cscd_partition *partition, const cscd_sensors *sensors,
                      const cscd_warnings *warnings, uint32_t frame, io_error *error) {
    for (uint32_t p = 0; warnings->renewals_due > 0 && p < cscd_partition_part_count(partition); p++) {
        cscd_renewal why = cscd_sensors_renewal(sensors, p);
        if (why == CSCD_RENEWAL_NONE || why == CSCD_RENEWAL_EDGE) continue;
        if (cscd_partition_renew(
                partition, CSCD_DOUBLES(recording_data_frame(r, frame), cscd_mesh_vertex_count(r->mesh)),
                p) != CSCD_OK)
            return api_failed(r, error);
    }
    return true;
}

/* Returns the largest diameter of a cell in the first frame. */
static double largest_cell(const recording_data *r, const cscd_partition *partition) {
    const double *x = recording_data_frame(r, 0);
    double largest = 0.0;
    for (uint32_t c = 0; c < partition->cell_count; c++)
        for (uint32_t i = partition->cell_offsets[c]; i < partition->cell_offsets[c + 1]; i++)
            for (uint32_t j = partition->cell_offsets[c]; j < i; j++) {
                const double *p = x + (size_t)partition->cell_vertices[i] * 3,
                             *q = x + (size_t)partition->cell_vertices[j] * 3;
                largest = fmax(largest, (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                                            (p[2] - q[2]) * (p[2] - q[2]));
            }
    return sqrt(largest);
}

/* mu is that of the interval before. */
static void set_reach(cscd_sensors *sensors, const sensor_rules *rules, double cell) {
    if (rules->reach_mu > 0.0)
        sensors->options.effective_radius =
            rules->reach_mu * sensors->reach.mu_most + rules->reach_cells * cell;
}

static bool run_intervals(const recording_data *r, const sensor_truth *truth, const sensor_rules *rules,
                          cscd_partition *partition, cscd_sensors *sensors, sensor_trial *t, double *ms,
                          io_error *error) {
    object_pairs warned = object_pairs_none(), confirmed = object_pairs_none();
    double cell = rules->reach_cells > 0.0 ? largest_cell(r, partition) : 0.0;
    bool good = true;
    for (uint32_t k = 0; good && k < truth->interval_count; k++) {
        cscd_warnings warnings;
        set_reach(sensors, rules, cell);
        good = cscd_sensors_step(
                   sensors, CSCD_DOUBLES(recording_data_frame(r, k), cscd_mesh_vertex_count(r->mesh)),
                   CSCD_DOUBLES(recording_data_frame(r, k + 1), cscd_mesh_vertex_count(r->mesh)),
                   &warnings) == CSCD_OK ||
               api_failed(r, error);
        if (!good) break;
        ms[k] = cscd_sensors_timings(sensors).total_ms;
        cscd_sensor_counters counters = cscd_sensors_counters(sensors);
        t->rounds += (double)counters.rounds / (2.0 * truth->interval_count);
        t->cycles += (double)counters.cycles / (2.0 * truth->interval_count);
        t->vertices += (double)counters.vertices;
        t->pairs += (double)counters.particle_pairs;
        good = (object_pairs_of_warnings(&warnings, false, &warned) &&
                object_pairs_of_warnings(&warnings, true, &confirmed)) ||
               io_fail(error, "out of memory");
        if (!good) break;
        t->touching += object_pairs_count(&truth->touching[k]);
        t->warned += object_pairs_count(&warned);
        t->found += object_pairs_common(&warned, &truth->touching[k]);
        t->confirmed += object_pairs_common(&confirmed, &truth->touching[k]);
        good = renew_due(r, partition, sensors, &warnings, k + 1, error);
    }
    object_pairs_free(&warned);
    object_pairs_free(&confirmed);
    return good;
}

bool sensor_trial_run(const recording_data *r, const sensor_truth *truth, const sensor_rules *rules,
                      sensor_trial *out, io_error *error) {
    cscd_partition *partition = NULL;
    cscd_sensors *sensors = NULL;
    sensor_trial t = {.trees_ms = truth->trees_ms};
    double *ms = body_allocate(r->frame_count, sizeof *ms);
    bool good = make_sensors(r, rules, &partition, &sensors, error) &&
                run_intervals(r, truth, rules, partition, sensors, &t, ms, error);
    if (good) {
        t.particles = cscd_sensors_particle_count(sensors);
        t.ms = sensor_median(ms, truth->interval_count);
        *out = t;
    }
    free(ms);
    cscd_sensors_destroy(sensors);
    cscd_partition_destroy(partition);
    return good;
}

void sensor_trial_add(sensor_trial *sum, const sensor_trial *one) {
    sum->particles += one->particles;
    sum->touching += one->touching;
    sum->warned += one->warned;
    sum->found += one->found;
    sum->confirmed += one->confirmed;
    sum->rounds += one->rounds;
    sum->cycles += one->cycles;
    sum->ms += one->ms;
    sum->vertices += one->vertices;
    sum->pairs += one->pairs;
    sum->trees_ms = one->trees_ms;
}

/* ---- the certified mode ------------------------------------------------------------------------------- */

typedef bool (*apart_question)(const cscd_sensors *s, uint32_t a, uint32_t b);

static bool balls_apart(const cscd_sensors *s, uint32_t a, uint32_t b) {
    return sensor_bounds_apart(&s->bounds, s->partition, a, b);
}

static bool boxes_apart(const cscd_sensors *s, uint32_t a, uint32_t b) {
    return sensor_bounds_boxes_apart(&s->bounds, a, b);
}

/* Writes the answers for all watched pairs, in their order, and returns how many there are. */
static uint32_t ask_all(const cscd_sensors *s, apart_question ask, bool *answers) {
    uint32_t count = 0;
    for (uint32_t a = 0; a < s->partition->part_count; a++)
        for (uint32_t b = a + 1; b < s->partition->part_count; b++)
            if (partition_watches(s->partition, a, b)) answers[count++] = ask(s, a, b);
    return count;
}

/* The API asks boxes first, then balls about the middles. */
static void measure_interval(cscd_sensors *s, const double *start, const double *end, bool *answers[3],
                             certified_trial *t, double ms[2]) {
    sensor_bounds_update(&s->bounds, s->partition, start, end, s->particles.vertices);
    uint32_t count = ask_all(s, balls_apart, answers[0]);
    double since = timer_now_ms();
    sensor_bounds_update(&s->bounds, s->partition, start, end, NULL);
    ask_all(s, balls_apart, answers[1]);
    timer_lap(&since, &ms[0]);
    sensor_bounds_update_boxes(&s->bounds, s->partition, start, end);
    ask_all(s, boxes_apart, answers[2]);
    timer_lap(&since, &ms[1]);
    for (uint32_t i = 0; i < count; i++) {
        t->walked += answers[0][i];
        t->middles += answers[1][i];
        t->boxes += answers[2][i];
        t->either += answers[1][i] || answers[2][i];
    }
    t->pairs += count;
}

bool certified_trial_run(const recording_data *r, bool plan, certified_trial *out, io_error *error) {
    const sensor_rules rules = {.plan = plan};
    cscd_partition *partition = NULL;
    cscd_sensors *sensors = NULL;
    certified_trial t = {0};
    uint32_t count = r->frame_count - 1;
    double *ms[2] = {body_allocate(count, sizeof **ms), body_allocate(count, sizeof **ms)};
    bool *answers[3] = {NULL, NULL, NULL};
    bool good = make_sensors(r, &rules, &partition, &sensors, error);
    for (int i = 0; good && i < 3; i++)
        answers[i] = body_allocate((size_t)partition->part_count * partition->part_count, 1);
    for (uint32_t k = 0; good && k < count; k++) {
        const double *start = recording_data_frame(r, k), *end = recording_data_frame(r, k + 1);
        cscd_warnings warnings;
        double taken[2] = {0.0, 0.0};
        good = cscd_sensors_step(sensors, CSCD_DOUBLES(start, cscd_mesh_vertex_count(r->mesh)),
                                 CSCD_DOUBLES(end, cscd_mesh_vertex_count(r->mesh)), &warnings) == CSCD_OK ||
               api_failed(r, error);
        if (!good) break;
        measure_interval(sensors, start, end, answers, &t, taken);
        for (int i = 0; i < 2; i++) ms[i][k] = taken[i];
    }
    if (good) {
        t.middles_ms = sensor_median(ms[0], count);
        t.boxes_ms = sensor_median(ms[1], count);
        *out = t;
    }
    for (int i = 0; i < 2; i++) free(ms[i]);
    for (int i = 0; i < 3; i++) free(answers[i]);
    cscd_sensors_destroy(sensors);
    cscd_partition_destroy(partition);
    return good;
}
