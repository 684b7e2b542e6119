/* One recording under particle sensors of some rules, and what the detector finds in it; and steps of sensors by
 * size and by number of objects. */
#include "benchmarks/sensors/trial.h"

#include "cscd/cscd.h"
#include "cscd/sensors.h"
#include "models/shapes/body.h"
#include "models/shapes/catalogue.h"
#include "sensors/sensors.h"
#include "src/core/timer.h"

#include <math.h>
#include <stdio.h>
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
    cscd_sensors *sensors = NULL;
    object_map map = {NULL, NULL};
    double *ms = body_allocate(r->frame_count, sizeof *ms);
    truth.touching = body_allocate(r->frame_count, sizeof *truth.touching);
    bool good = (cscd_detector_create(r->context, r->mesh, NULL, &options, &detector) == CSCD_OK &&
                 cscd_sensors_create(r->context, r->mesh, NULL,
                                     CSCD_DOUBLES(r->model.positions, cscd_mesh_vertex_count(r->mesh)), NULL,
                                     &sensors) == CSCD_OK) ||
                api_failed(r, error);
    good = good && (object_map_make(r->mesh, sensors, &map) || io_fail(error, "out of memory")) &&
           find_intervals(r, detector, &map, &truth, ms, error);
    object_map_free(&map);
    cscd_sensors_destroy(sensors);
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

static bool create_sensors(const recording_data *r, const sensor_rules *rules,
                           const cscd_sensor_options *options, cscd_sensors **out, io_error *error) {
    return cscd_sensors_create(r->context, r->mesh, rules->plan ? r->charge : NULL,
                               CSCD_DOUBLES(r->model.positions, cscd_mesh_vertex_count(r->mesh)), options,
                               out) == CSCD_OK ||
           api_failed(r, error);
}

/* As many random particles on each object as an object has cells, rounded up. */
static bool take_particles_as_cells(const recording_data *r, const sensor_rules *rules,
                                    cscd_sensor_options *options, io_error *error) {
    cscd_sensors *sensors = NULL;
    if (!create_sensors(r, rules, options, &sensors, error)) return false;
    uint32_t cells = cscd_sensors_cell_count(sensors), objects = sensors->partition.object_count;
    options->particles = (cells + objects - 1) / objects;
    cscd_sensors_destroy(sensors);
    return true;
}

/* With a given mu, particles still feel each other as far as they do by default. */
static bool make_sensors(const recording_data *r, const sensor_rules *rules, cscd_sensors **sensors,
                         io_error *error) {
    cscd_sensor_options options = cscd_sensor_defaults();
    options.cells = rules->cells;
    options.method = rules->random ? CSCD_SENSORS_RANDOM : CSCD_SENSORS_CELLS;
    if (rules->mu_edges > 0.0) options.collision_distance = rules->mu_edges * mean_edge(r);
    if (rules->random) {
        options.particles = rules->particles > 0 ? rules->particles : 1;
        options.seed = rules->seed;
        if (rules->as_cells && !take_particles_as_cells(r, rules, &options, error)) return false;
    }
    if (!create_sensors(r, rules, &options, sensors, error)) return false;
    static const particle_rule forces[] = {PARTICLE_ATTRACTION, PARTICLE_ATTRACTION, PARTICLE_SCALAR,
                                           PARTICLE_STRONGEST};
    if (rules->rule != RULE_DEFAULT) (*sensors)->particles.rule = forces[rules->rule];
    return true;
}

/* New cells would not shorten an edge. */
static bool renew_due(const recording_data *r, cscd_sensors *sensors, const cscd_warnings *warnings,
                      uint32_t frame, io_error *error) {
    for (uint32_t p = 0; warnings->renewals_due > 0 && p < cscd_sensors_part_count(sensors); p++) {
        cscd_renewal why = cscd_sensors_renewal(sensors, p);
        if (why == CSCD_RENEWAL_NONE || why == CSCD_RENEWAL_EDGE) continue;
        if (cscd_sensors_renew(sensors,
                               CSCD_DOUBLES(recording_data_frame(r, frame), cscd_mesh_vertex_count(r->mesh)),
                               p) != CSCD_OK)
            return api_failed(r, error);
    }
    return true;
}

/* Returns the largest diameter of a cell in the first frame. */
static double largest_cell(const recording_data *r, const sensor_partition *partition) {
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
                          cscd_sensors *sensors, sensor_trial *t, double *ms, io_error *error) {
    object_pairs warned = object_pairs_none(), confirmed = object_pairs_none();
    double cell = rules->reach_cells > 0.0 ? largest_cell(r, &sensors->partition) : 0.0;
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
        good = renew_due(r, sensors, &warnings, k + 1, error);
    }
    object_pairs_free(&warned);
    object_pairs_free(&confirmed);
    return good;
}

bool sensor_trial_run(const recording_data *r, const sensor_truth *truth, const sensor_rules *rules,
                      sensor_trial *out, io_error *error) {
    cscd_sensors *sensors = NULL;
    sensor_trial t = {.trees_ms = truth->trees_ms};
    double *ms = body_allocate(r->frame_count, sizeof *ms);
    bool good =
        make_sensors(r, rules, &sensors, error) && run_intervals(r, truth, rules, sensors, &t, ms, error);
    if (good) {
        t.particles = cscd_sensors_particle_count(sensors);
        t.ms = sensor_median(ms, truth->interval_count);
        *out = t;
    }
    free(ms);
    cscd_sensors_destroy(sensors);
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

/* ---- cost of steps ------------------------------------------------------------------------------------- */

enum { INTERVALS = 21, SIDE_MAX = 7 };

/* Places spheres in a row or in a cube. Each swings about its place, so that neighbours nearly touch. */
static void place_spheres(const body *ball, uint32_t side[3], body *out) {
    for (uint32_t i = 0; i < side[0]; i++)
        for (uint32_t j = 0; j < side[1]; j++)
            for (uint32_t k = 0; k < side[2]; k++)
                body_append(out, ball, (const double[3]){2.2 * i, 2.2 * j, 2.2 * k});
}

static void move_spheres(const body *b, uint32_t vertices_each, double time, double *out) {
    for (size_t i = 0; i < (size_t)b->vertex_count * 3; i++) {
        double phase = 2.4 * (double)(i / 3 / vertices_each) + 2.0 * (double)(i % 3);
        out[i] = b->positions[i] + 0.08 * sin(0.7 * time + phase);
    }
}

typedef struct cost {
    double particles, vertices, pairs, rounds, sense_ms, trees_ms;
} cost;

typedef struct contestants {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_sensors *sensors;
    cscd_detector *detector;
} contestants;

static bool create_contestants(const body *b, contestants *c, io_error *error) {
    const cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_NONE;
    options.start = CSCD_START_UNKNOWN;
    return (cscd_context_create(NULL, &c->context) == CSCD_OK &&
            cscd_mesh_create(c->context, &desc, 1, &c->mesh) == CSCD_OK &&
            cscd_sensors_create(c->context, c->mesh, NULL,
                                CSCD_DOUBLES(b->positions, cscd_mesh_vertex_count(c->mesh)), NULL,
                                &c->sensors) == CSCD_OK &&
            cscd_detector_create(c->context, c->mesh, NULL, &options, &c->detector) == CSCD_OK) ||
           io_fail(error, "%s", cscd_context_detail(c->context));
}

static void destroy_contestants(contestants *c) {
    cscd_detector_destroy(c->detector);
    cscd_sensors_destroy(c->sensors);
    cscd_mesh_destroy(c->mesh);
    cscd_context_destroy(c->context);
}

/* The first interval, which places particles and builds trees, is not counted. */
static bool measure_cost(const body *b, uint32_t vertices_each, cost *out, io_error *error) {
    contestants c = {.context = NULL};
    double sense[INTERVALS], trees[INTERVALS];
    size_t size = (size_t)b->vertex_count * 3;
    double *x = body_allocate(size * 2, sizeof *x);
    bool good = create_contestants(b, &c, error);
    *out = (cost){0};
    for (uint32_t i = 0; good && i <= INTERVALS; i++) {
        cscd_warnings warnings;
        cscd_contacts contacts;
        move_spheres(b, vertices_each, i, x);
        move_spheres(b, vertices_each, i + 1, x + size);
        good = (cscd_sensors_step(c.sensors, CSCD_DOUBLES(x, cscd_mesh_vertex_count(c.mesh)),
                                  CSCD_DOUBLES(x + size, cscd_mesh_vertex_count(c.mesh)),
                                  &warnings) == CSCD_OK &&
                cscd_detector_step(c.detector, CSCD_DOUBLES(x, cscd_mesh_vertex_count(c.mesh)),
                                   CSCD_DOUBLES(x + size, cscd_mesh_vertex_count(c.mesh)),
                                   &contacts) == CSCD_OK) ||
               io_fail(error, "%s", cscd_context_detail(c.context));
        if (!good || i == 0) continue;
        cscd_sensor_counters counters = cscd_sensors_counters(c.sensors);
        out->vertices += (double)counters.vertices / INTERVALS;
        out->pairs += (double)counters.particle_pairs / INTERVALS;
        out->rounds += (double)counters.rounds / INTERVALS;
        sense[i - 1] = cscd_sensors_timings(c.sensors).total_ms;
        trees[i - 1] = cscd_detector_timings(c.detector).total_ms;
    }
    if (good) {
        out->particles = cscd_sensors_particle_count(c.sensors);
        out->sense_ms = sensor_median(sense, INTERVALS);
        out->trees_ms = sensor_median(trees, INTERVALS);
    }
    destroy_contestants(&c);
    free(x);
    return good;
}

static bool print_row(uint32_t triangles_each, uint32_t side[3], io_error *error) {
    body ball = {0}, all = {0};
    cost c;
    if (!body_make(BODY_SPHERE, triangles_each, &ball, error)) return false;
    place_spheres(&ball, side, &all);
    bool good = measure_cost(&all, ball.vertex_count, &c, error);
    if (good)
        printf("  %7u %9u %9.0f %7.1f %10.0f %11.0f %8.1f %8.3f %8.2f %8.3f\n", side[0] * side[1] * side[2],
               all.triangle_count, c.particles, c.rounds, c.vertices, c.pairs,
               1e6 * c.sense_ms / (c.vertices + c.pairs), c.sense_ms, 1e6 * c.sense_ms / all.triangle_count,
               c.trees_ms);
    fflush(stdout);
    body_free(&ball);
    body_free(&all);
    return good;
}

static void print_head(const char *title) {
    printf("\n%s\n  %7s %9s %9s %7s %10s %11s %8s %8s %8s %8s\n", title, "objects", "triangles", "particles",
           "rounds", "vertices", "pairs", "ns each", "ms", "ns/tri", "trees ms");
}

bool sensor_cost_print(io_error *error) {
    static const uint32_t sizes[] = {320, 1280, 5120, 20480, 81920};
    print_head("cost by size: three spheres in a row");
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        if (!print_row(sizes[i], (uint32_t[3]){3, 1, 1}, error)) return false;
    print_head("cost by number of objects: a cube of spheres");
    for (uint32_t n = 2; n <= SIDE_MAX; n++)
        if (!print_row(320, (uint32_t[3]){n, n, n}, error)) return false;
    return true;
}
