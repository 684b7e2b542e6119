/* Measures a step of particle sensors by size and by number of objects. */
#include "benchmarks/sensors/cost.h"

#include "benchmarks/sensors/trial.h"
#include "cscd/cscd.h"
#include "cscd/sensors.h"
#include "models/shapes/catalogue.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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
