/* Energies of near pairs: nanoseconds per item for values, gradients and Hessians, plain and projected. */
#include "benchmarks/lib/made_scenes.h"
#include "benchmarks/lib/options.h"
#include "src/core/timer.h"

#include <math.h>
#include <stdlib.h>

enum { REPEATS = 7 };

static const char help[] =
    "usage: energies [options]\n"
    "\n"
    "What cscd_energy_evaluate takes for the unique near pairs of a folded cloth, by its number of triangles, and of cloth\n"
    "on a ball (CSCD_DATA): nanoseconds per item, the least of some repetitions. Law BARRIER_SQUARED, whose reach is half of the\n"
    "mean edge. --body, --volume, --intervals and --shuffled mean nothing here.\n"
    "\n";

static const uint32_t sizes[] = {20000, 200000};

/* ---- a folded cloth -------------------------------------------------------------------------------------- */

enum { LAYERS = 8 };

/* The point at length s of a curve that runs to and fro in layers, over half circles. */
static void place_on_fold(double s, double flat, double gap, double out[2]) {
    const double turn = 0.5 * gap, arc = 3.141592653589793 * turn, period = flat + arc;
    const double layer = fmin(floor(s / period), LAYERS - 1.0), along = s - layer * period;
    const double sign = fmod(layer, 2.0) == 0.0 ? 1.0 : -1.0, angle = (along - flat) / turn;
    const double x = along < flat ? along : flat + turn * sin(angle);
    out[0] = sign > 0.0 ? x : flat - x;
    out[1] = gap * layer + (along < flat ? 0.0 : turn * (1.0 - cos(angle)));
}

/* A square sheet, folded in layers that are a quarter of an edge apart, with small waves across. */
static bool make_folded(uint32_t triangle_count, deforming_body *out) {
    const uint32_t n = (uint32_t)sqrt(triangle_count / 2.0), row = n + 1;
    const double gap = 0.25, arc = 0.5 * 3.141592653589793 * gap, flat = (n - (LAYERS - 1) * arc) / LAYERS;
    *out = (deforming_body){.vertex_count = row * row, .triangle_count = 2 * n * n, .edge = 1.0};
    out->rest = malloc((size_t)out->vertex_count * 3 * sizeof *out->rest);
    out->triangles = malloc((size_t)out->triangle_count * 3 * sizeof *out->triangles);
    if (out->rest == NULL || out->triangles == NULL) return false;
    for (uint32_t v = 0; v < out->vertex_count; v++) {
        double *x = out->rest + (size_t)v * 3, s = v % row, t = v / row, at[2];
        place_on_fold(s, flat, gap, at);
        x[0] = at[0] + 0.02 * sin(3.1 * t);
        x[1] = t + 0.05 * sin(1.7 * s);
        x[2] = at[1] + 0.05 * sin(0.9 * t + 0.3 * at[0]) + 0.02 * sin(2.3 * s + 1.9 * t);
    }
    for (uint32_t i = 0; i < n * n; i++) {
        const uint32_t a = i / n * row + i % n;
        const uint32_t corners[6] = {a, a + 1, a + row + 1, a, a + row + 1, a + row};
        for (uint32_t k = 0; k < 6; k++) out->triangles[6 * (size_t)i + k] = corners[k];
    }
    return true;
}

/* ---- timing ---------------------------------------------------------------------------------------------- */

typedef struct energy_task {
    const char *name;
    bool gradient, blocks, matrix, project;
} energy_task;

static const energy_task tasks[] = {{"value", false, false, false, false},
                                    {"gradient", true, false, false, false},
                                    {"Hessian", true, true, false, false},
                                    {"projected", true, true, false, true},
                                    {"projected, BSR", true, false, true, true}};

enum { TASKS = sizeof tasks / sizeof *tasks };

typedef struct energy_scene {
    const char *name;
    const deforming_body *body;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_energy *energy;
    cscd_proximities near;
    cscd_energy_pattern pattern;
    double *gradient, *blocks, *matrix, reach;
} energy_scene;

static cscd_status open_scene(energy_scene *s, const bench_options *o) {
    cscd_context_options options = cscd_context_defaults();
    const cscd_object_desc object =
        cscd_object_of_triangles(s->body->vertex_count, s->body->triangle_count, s->body->triangles);
    options.thread_count = o->thread_count;
    options.simd = o->simd;
    cscd_status status = cscd_context_create(&options, &s->context);
    if (status == CSCD_OK) status = cscd_mesh_create(s->context, &object, 1, &s->mesh);
    if (status == CSCD_OK) status = cscd_detector_create(s->context, s->mesh, NULL, NULL, &s->detector);
    if (status == CSCD_OK) status = cscd_energy_create(s->context, s->mesh, &s->energy);
    if (status == CSCD_OK)
        status = cscd_detector_set_rest(s->detector, CSCD_DOUBLES(s->body->rest, s->body->vertex_count));
    if (status == CSCD_OK)
        status = cscd_detector_find_near(s->detector, CSCD_DOUBLES(s->body->rest, s->body->vertex_count),
                                         s->reach, CSCD_NEAR_UNIQUE, &s->near);
    if (status == CSCD_OK) status = cscd_energy_make_pattern(s->energy, &s->near, NULL, &s->pattern);
    s->gradient = malloc((size_t)s->body->vertex_count * 3 * sizeof *s->gradient);
    s->blocks = malloc((s->near.count + 1) * 144 * sizeof *s->blocks);
    s->matrix = malloc((s->pattern.block_count + 1) * 9 * sizeof *s->matrix);
    bool all = s->gradient != NULL && s->blocks != NULL && s->matrix != NULL;
    return status == CSCD_OK && !all ? CSCD_OUT_OF_MEMORY : status;
}

static void close_scene(energy_scene *s) {
    free(s->gradient);
    free(s->blocks);
    free(s->matrix);
    cscd_energy_destroy(s->energy);
    cscd_detector_destroy(s->detector);
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
}

static cscd_status time_task(const energy_scene *s, const energy_task *t, double *least_ms) {
    cscd_energy_options options = cscd_energy_defaults();
    options.law = CSCD_ENERGY_BARRIER_SQUARED;
    options.reach = s->reach;
    const cscd_energy_targets targets = {.gradient = t->gradient ? s->gradient : NULL,
                                         .blocks = t->blocks ? s->blocks : NULL,
                                         .matrix = t->matrix ? s->matrix : NULL,
                                         .pattern = t->matrix ? &s->pattern : NULL,
                                         .project = t->project};
    cscd_energy_sum sum;
    double now = timer_now_ms(), took = 0.0;
    cscd_status status = cscd_energy_evaluate(
        s->energy, &s->near, CSCD_DOUBLES(s->body->rest, s->body->vertex_count), &options, &targets, &sum);
    timer_lap(&now, &took);
    *least_ms = fmin(*least_ms, took);
    return status;
}

static cscd_status time_scene(const energy_scene *s, uint32_t repeats, json *out) {
    double least[TASKS];
    cscd_status status = CSCD_OK;
    for (int t = 0; t < TASKS; t++) least[t] = HUGE_VAL;
    for (uint32_t i = 0; i < repeats; i++) {
        for (int t = 0; t < TASKS && status == CSCD_OK; t++) status = time_task(s, &tasks[t], &least[t]);
    }
    if (status != CSCD_OK) return status;
    size_t kinds[6] = {0};
    for (size_t i = 0; i < s->near.count; i++) kinds[s->near.items[i].kind]++;
    printf("%s: %u triangles, %zu items (%zu vf, %zu ee, %zu ev, %zu vv)\n", s->name, s->body->triangle_count,
           s->near.count, kinds[CSCD_CONTACT_VF], kinds[CSCD_CONTACT_EE], kinds[CSCD_CONTACT_EV],
           kinds[CSCD_CONTACT_VV]);
    for (int t = 0; t < TASKS; t++) {
        double nanoseconds = 1e6 * least[t] / (double)s->near.count;
        printf("  %-16s %8.1f ns per item\n", tasks[t].name, nanoseconds);
        if (out->file == NULL) continue;
        json_break_line(out);
        json_begin_object(out, NULL);
        json_string(out, "scene", s->name);
        json_integer(out, "triangles", s->body->triangle_count);
        json_integer(out, "items", s->near.count);
        json_string(out, "task", tasks[t].name);
        json_number(out, "ns_per_item", nanoseconds);
        json_end_object(out);
    }
    return CSCD_OK;
}

static bool run_scene(const char *name, const deforming_body *cloth, const bench_options *o, json *out,
                      io_error *error) {
    energy_scene s = {.name = name, .body = cloth, .reach = 0.5 * cloth->edge};
    cscd_status status = open_scene(&s, o);
    if (status == CSCD_OK) status = time_scene(&s, o->quick ? 2 : REPEATS, out);
    close_scene(&s);
    return status == CSCD_OK || io_fail(error, "%s: %s", name, cscd_status_string(status));
}

static bool run_folded(uint32_t triangle_count, const bench_options *o, json *out, io_error *error) {
    deforming_body b;
    bool good = make_folded(triangle_count, &b) || io_fail(error, "folded: out of memory");
    good = good && run_scene("folded", &b, o, out, error);
    free(b.rest);
    free(b.triangles);
    return good;
}

static bool run_energies(const bench_options *o, json *out, io_error *error) {
    deforming_body b;
    for (uint32_t i = 0; i < o->size_count; i++) {
        if (!run_folded(o->sizes[i], o, out, error)) return false;
    }
    if (o->quick || !bench_has_data(o, "cloth_ball")) return true;
    if (!deforming_body_read(o->data, "cloth_ball", 92, &b, error)) return false;
    bool good = run_scene("cloth_ball", &b, o, out, error);
    deforming_body_free(&b);
    return good;
}

int main(int argument_count, char **arguments) {
    static const bench_program program = {"energies", help, sizes, 2, 1, run_energies};
    return bench_main(&program, argument_count, arguments);
}
