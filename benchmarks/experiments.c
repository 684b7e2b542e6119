/* Chapter 6 of the thesis in numbers (a sphere, the stability of k-means), and long steps. */
#include "benchmarks/lib/scene_files.h"
#include "cscd/research.h"
#include "models/shapes/catalogue.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KMEANS_RUNS = 20, LONG_STEP_INTERVALS = 2, REGIONS_MAX = 64 };

static bool print_failure(const char *text) {
    fprintf(stderr, "experiments: %s\n", text);
    return false;
}

/* Measures one step of a new detector; returns false after a failure that has been reported. */
static bool measure_step(const cscd_mesh *mesh, const cscd_context *context, const cscd_plan *plan,
                         cscd_method method, const double *start, const double *end, cscd_counters *counters,
                         cscd_timings *ms) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    cscd_contacts found;
    options.method = method;
    cscd_status status = cscd_detector_create(cscd_mesh_context(mesh), mesh, plan, &options, &detector);
    if (status == CSCD_OK)
        status =
            cscd_detector_step(detector, CSCD_DOUBLES(start, cscd_mesh_vertex_count(mesh)),
                               CSCD_DOUBLES(end, cscd_mesh_vertex_count(mesh)), &found); /* builds the tree */
    if (status == CSCD_OK)
        status = cscd_detector_step(detector, CSCD_DOUBLES(start, cscd_mesh_vertex_count(mesh)),
                                    CSCD_DOUBLES(end, cscd_mesh_vertex_count(mesh)), &found);
    if (status == CSCD_OK) {
        *counters = cscd_detector_counters(detector);
        *ms = cscd_detector_timings(detector);
    }
    cscd_detector_destroy(detector);
    return status == CSCD_OK || print_failure(cscd_context_detail(context));
}

/* ---- a sphere ---------------------------------------------------------------------------------------- */

static bool measure_sphere(uint32_t triangles) {
    body sphere;
    io_error error;
    if (!body_make(BODY_SPHERE, triangles, &sphere, &error)) return print_failure(error.text);
    recording_data r = {.frame_count = 0};
    const cscd_object_desc desc =
        cscd_object_of_triangles(sphere.vertex_count, sphere.triangle_count, sphere.triangles);
    double *end = malloc((size_t)sphere.vertex_count * 3 * sizeof *end);
    bool good = end != NULL && cscd_context_create(NULL, &r.context) == CSCD_OK &&
                cscd_mesh_create(r.context, &desc, 1, &r.mesh) == CSCD_OK;
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_ICCD};
    for (uint32_t i = 0; good && i < sphere.vertex_count * 3; i++) end[i] = 1.01 * sphere.positions[i];
    for (int i = 0; good && i < 3; i++) {
        cscd_counters n;
        cscd_timings ms;
        good = measure_step(r.mesh, r.context, NULL, methods[i], sphere.positions, end, &n, &ms);
        if (good)
            printf("  %9u %-8s %9llu %9llu %9llu %9.3f\n", triangles, cscd_method_name(methods[i]),
                   (unsigned long long)n.pcp, (unsigned long long)n.contours, (unsigned long long)n.sealed,
                   ms.total_ms);
    }
    free(end);
    body_free(&sphere);
    recording_data_close(&r);
    return good;
}

static bool measure_spheres(void) {
    printf("a sphere that grows by 1 %%: one region, or patches\n  %9s %-8s %9s %9s %9s %9s\n", "triangles",
           "method", "#PCPs", "contours", "patches", "ms");
    return measure_sphere(500) && measure_sphere(2000) && measure_sphere(8000) && measure_sphere(32000);
}

/* ---- k-means ----------------------------------------------------------------------------------------- */

/* Counts the regions that border on one other region only. */
static uint32_t count_enclosed(const cscd_mesh *mesh, const cscd_plan *plan) {
    bool beside[REGIONS_MAX][REGIONS_MAX] = {{false}};
    uint32_t enclosed = 0;
    uint32_t regions = cscd_plan_region_count(plan), vertices = cscd_mesh_vertex_count(mesh);
    uint32_t *of_vertex = malloc(vertices * sizeof *of_vertex);
    if (of_vertex == NULL || regions > REGIONS_MAX) regions = 0;
    for (uint32_t v = 0; regions > 0 && v < vertices; v++) of_vertex[v] = UINT32_MAX;
    for (uint32_t t = 0; regions > 0 && t < cscd_mesh_triangle_count(mesh); t++) {
        uint32_t v[3], own = cscd_plan_triangle_region(plan, t);
        cscd_mesh_triangle(mesh, t, v);
        for (int i = 0; i < 3; i++) {
            uint32_t other = of_vertex[v[i]];
            if (other != UINT32_MAX && other != own) beside[own][other] = beside[other][own] = true;
            of_vertex[v[i]] = own;
        }
    }
    for (uint32_t i = 0; i < regions; i++) {
        uint32_t neighbours = 0;
        for (uint32_t j = 0; j < regions; j++) neighbours += beside[i][j];
        enclosed += neighbours == 1;
    }
    free(of_vertex);
    return enclosed;
}

static double visible_share(const cscd_plan *plan) {
    double area = 0.0, visible = 0.0;
    for (uint32_t i = 0; i < cscd_plan_region_count(plan); i++) {
        cscd_region region = cscd_plan_region(plan, i);
        area += region.area;
        visible += region.area * region.visible_share;
    }
    return visible / area;
}

static bool measure_kmeans(const recording_data *r) {
    uint32_t n = cscd_plan_region_count(r->charge);
    printf("  %-16s charge   %2u regions, %u of them with one neighbour; visible %.3f, every time\n", r->name,
           n, count_enclosed(r->mesh, r->charge), visible_share(r->charge));
    double least = 1.0, most = 0.0, sum = 0.0;
    uint32_t enclosed_least = UINT32_MAX, enclosed_most = 0;
    for (uint32_t seed = 1; seed <= KMEANS_RUNS; seed++) {
        cscd_plan_options options = cscd_plan_defaults();
        cscd_plan *plan = NULL;
        options.method = CSCD_METHOD_KMEANS;
        options.k = n;
        options.seed = seed;
        if (cscd_plan_create(r->context, r->mesh,
                             CSCD_DOUBLES(r->model.positions, cscd_mesh_vertex_count(r->mesh)), &options,
                             &plan) != CSCD_OK)
            return print_failure(cscd_context_detail(r->context));
        double share = visible_share(plan);
        uint32_t enclosed = count_enclosed(r->mesh, plan);
        cscd_plan_destroy(plan);
        sum += share;
        least = share < least ? share : least;
        most = share > most ? share : most;
        enclosed_least = enclosed < enclosed_least ? enclosed : enclosed_least;
        enclosed_most = enclosed > enclosed_most ? enclosed : enclosed_most;
    }
    printf("  %-16s kmeans:%u %d seeds: %u to %u regions with one neighbour; visible %.3f, %.3f to %.3f\n",
           "", n, KMEANS_RUNS, enclosed_least, enclosed_most, sum / KMEANS_RUNS, least, most);
    return true;
}

/* ---- long steps -------------------------------------------------------------------------------------- */

/* Returns the greatest extent at rest, rounded down to a power of two, so that translations by multiples
 * of it are exact. */
static double body_length(const recording_data *r) {
    double extent = 0.0, power = 1.0;
    for (uint32_t i = 0; i < r->model.vertex_count * 3; i++) {
        double distance = r->model.positions[i] - r->model.positions[i % 3];
        extent = distance > extent ? distance : -distance > extent ? -distance : extent;
    }
    while (power > extent) power *= 0.5;
    while (2.0 * power <= extent) power *= 2.0;
    return power;
}

static bool measure_long_step(const recording_data *r, const cscd_plan *plan, cscd_method method,
                              double lengths) {
    size_t size = (size_t)r->model.vertex_count * 3;
    double *end = malloc(size * sizeof *end), pcp = 0.0, tests = 0.0, total = 0.0,
           step = lengths * body_length(r);
    bool good = end != NULL;
    for (uint32_t i = 0; good && i < LONG_STEP_INTERVALS; i++) {
        cscd_counters n;
        cscd_timings ms;
        const double *start = recording_data_frame(r, 20 + 10 * i),
                     *last = recording_data_frame(r, 21 + 10 * i);
        for (size_t j = 0; j < size; j++) end[j] = last[j] + (j % 3 == 0 ? step : 0.0);
        good = measure_step(r->mesh, r->context, plan, method, start, end, &n, &ms);
        pcp += (double)n.pcp / LONG_STEP_INTERVALS;
        tests += (double)n.tests / LONG_STEP_INTERVALS;
        total += ms.total_ms / LONG_STEP_INTERVALS;
    }
    if (good)
        printf("  %-16s %-8s %6.0f %12.0f %12.0f %10.2f\n", r->name, cscd_method_name(method), lengths, pcp,
               tests, total);
    fflush(stdout);
    free(end);
    return good;
}

static bool measure_long_steps(const recording_data *r) {
    static const double lengths[] = {0.0, 1.0, 10.0, 100.0};
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_ICCD, CSCD_METHOD_SINGLE,
                                          CSCD_METHOD_CHARGE};
    for (int m = 0; m < 4; m++) {
        for (int i = 0; i < 4; i++) {
            const cscd_plan *plan = methods[m] == CSCD_METHOD_CHARGE ? r->charge : NULL;
            if (!measure_long_step(r, plan, methods[m], lengths[i])) return false;
        }
    }
    return true;
}

/* ---- the program ------------------------------------------------------------------------------------- */

int main(int argument_count, char **arguments) {
    static const char *const names[] = {"pawn-drop-free", "dumbbell-stairs-free", "figure-balls-free"};
    recording_data recordings[3];
    io_error error;
    if (argument_count > 1) {
        fprintf(stderr,
                "usage: experiments\n\nThe thesis's chapter 6 in numbers, and long steps: %s takes no "
                "arguments. Wants the recordings of `make models`.\n",
                arguments[0]);
        return 2;
    }
    for (int i = 0; i < 3; i++) {
        if (recording_data_open("build/models", names[i], 1, &recordings[i], &error)) continue;
        fprintf(stderr, "experiments: %s\n", error.text);
        return 1;
    }
    bool good = measure_spheres();
    printf("\nregions by charge, and by k-means with as many\n");
    for (int i = 0; good && i < 3; i++) good = measure_kmeans(&recordings[i]);
    printf(
        "\nlong steps: all moved by so many body lengths (rounded down to a power of two) in the interval\n"
        "  %-16s %-8s %6s %12s %12s %10s\n",
        "recording", "method", "steps", "#PCPs", "tests", "ms");
    for (int i = 0; good && i < 3; i++) good = measure_long_steps(&recordings[i]);
    for (int i = 0; i < 3; i++) recording_data_close(&recordings[i]);
    return good ? 0 : 1;
}
