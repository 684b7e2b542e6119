/* Lists of near pairs of a sheet, and truncations of a cloth on a ball: nanoseconds and bytes for each pair, and milliseconds for
 * each call. */
#include "benchmarks/lib/made_scenes.h"
#include "benchmarks/lib/options.h"
#include "src/core/timer.h"

#include <math.h>
#include <stdlib.h>

enum { REPEATS = 7 };

static const char help[] =
    "usage: near_pairs [options]\n"
    "\n"
    "What cscd_detector_find_near takes within three edges of a wavy sheet, by its number of triangles, in both forms; and\n"
    "cscd_detector_truncate for a sheet that lies on a ball at rest and is pushed onto it, with a radius of 0.3 and 1 edges.\n"
    "The least of some repetitions. --body, --volume, --intervals and --shuffled mean nothing here.\n"
    "\n";

static const uint32_t sizes[] = {5000, 20000};

/* ---- scenes ---------------------------------------------------------------------------------------------- */

typedef struct draped_sheet {
    double *x;
    uint32_t *triangles, vertex_count, triangle_count;
} draped_sheet;

static void free_surface(draped_sheet *s) {
    free(s->x);
    free(s->triangles);
}

/* A sheet of squares of length 1, bent over a ball of this radius, or wavy in a plane. False: no memory. */
static bool make_sheet(uint32_t triangle_count, double radius, draped_sheet *out) {
    const uint32_t n = (uint32_t)sqrt(triangle_count / 2.0), row = n + 1;
    *out = (draped_sheet){.vertex_count = row * row, .triangle_count = 2 * n * n};
    out->x = malloc((size_t)out->vertex_count * 3 * sizeof *out->x);
    out->triangles = malloc((size_t)out->triangle_count * 3 * sizeof *out->triangles);
    if (out->x == NULL || out->triangles == NULL) return false;
    for (uint32_t v = 0; v < out->vertex_count; v++) {
        double *x = out->x + (size_t)v * 3, s = v % row - 0.5 * n, t = v / row - 0.5 * n, r = hypot(s, t);
        const double flat = r > 0.0 ? radius * sin(r / radius) / r : 1.0;
        x[0] = radius > 0.0 ? flat * s : s;
        x[1] = radius > 0.0 ? flat * t : t;
        x[2] = radius > 0.0 ? radius * cos(r / radius) : 0.2 * sin(0.3 * s) * cos(0.2 * t);
    }
    for (uint32_t i = 0; i < n * n; i++) {
        const uint32_t a = i / n * row + i % n, corners[6] = {a, a + 1, a + row + 1, a, a + row + 1, a + row};
        for (uint32_t k = 0; k < 6; k++) out->triangles[6 * (size_t)i + k] = corners[k];
    }
    return true;
}

/* ---- timing ---------------------------------------------------------------------------------------------- */

static void write_row(json *out, const char *task, uint32_t triangles, size_t pairs, double bytes,
                      double ms) {
    const double nanoseconds = pairs > 0 ? 1e6 * ms / (double)pairs : 0.0;
    printf("  %-14s %8u triangles %9zu pairs %8.1f ns and %5.0f bytes a pair %9.2f ms\n", task, triangles,
           pairs, nanoseconds, bytes, ms);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "task", task);
    json_integer(out, "triangles", triangles);
    json_integer(out, "pairs", pairs);
    json_number(out, "ns_per_pair", nanoseconds);
    json_number(out, "bytes_per_pair", bytes);
    json_number(out, "ms", ms);
    json_end_object(out);
}

static cscd_status time_near(cscd_detector *d, const draped_sheet *s, cscd_near_form form, uint32_t repeats,
                             json *out) {
    double least = HUGE_VAL;
    cscd_proximities found = {.count = 0};
    const cscd_context *context = cscd_mesh_context(cscd_detector_mesh(d));
    const size_t before = cscd_context_describe(context).bytes;
    for (uint32_t i = 0; i < repeats; i++) {
        double now = timer_now_ms(), took = 0.0;
        cscd_status status =
            cscd_detector_find_near(d, CSCD_DOUBLES(s->x, s->vertex_count), 3.0, form, &found);
        timer_lap(&now, &took);
        if (status != CSCD_OK) return status;
        least = fmin(least, took);
    }
    const double bytes = (double)(cscd_context_describe(context).bytes - before) / (double)found.count;
    write_row(out, form == CSCD_NEAR_PAIRS ? "find_near" : "unique", s->triangle_count, found.count, bytes,
              least);
    return CSCD_OK;
}

/* Pushes the sheet, the first object, down and aside, and writes what the call has to say. */
static cscd_status time_truncate(cscd_detector *d, const draped_sheet *both, uint32_t moving, double radius,
                                 uint32_t repeats, json *out) {
    double least = HUGE_VAL;
    cscd_truncation found = {.near_count = 0};
    double *x1 = malloc((size_t)both->vertex_count * 3 * sizeof *x1);
    if (x1 == NULL) return CSCD_OUT_OF_MEMORY;
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; i < repeats && status == CSCD_OK; i++) {
        for (uint32_t v = 0; v < both->vertex_count * 3; v++) x1[v] = both->x[v];
        for (uint32_t v = 0; v < moving; v++) {
            x1[3 * v] += 0.25 * radius * sin(0.11 * v + i);
            x1[3 * v + 2] -= 0.35 * radius;
        }
        double now = timer_now_ms(), took = 0.0;
        status = cscd_detector_truncate(d, CSCD_DOUBLES(both->x, both->vertex_count),
                                        CSCD_DOUBLES(x1, both->vertex_count), radius,
                                        CSCD_MUTABLE_DOUBLES(x1, both->vertex_count), &found);
        timer_lap(&now, &took);
        least = fmin(least, took);
    }
    free(x1);
    if (status == CSCD_OK)
        write_row(out, radius < 0.5 ? "truncate 0.3" : "truncate 1", both->triangle_count, found.near_count,
                  0.0, least);
    return status;
}

/* ---- all of it ------------------------------------------------------------------------------------------- */

static cscd_status open_detector(const draped_sheet *s, uint32_t first, uint32_t first_triangles,
                                 uint32_t threads, cscd_detector **out) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = threads;
    cscd_object_desc objects[2] = {cscd_object_of_triangles(first, first_triangles, s->triangles),
                                   cscd_object_of_triangles(s->vertex_count - first,
                                                            s->triangle_count - first_triangles,
                                                            s->triangles + (size_t)first_triangles * 3)};
    objects[1].obstacle = true;
    cscd_status status = cscd_context_create(&options, &context);
    if (status == CSCD_OK)
        status = cscd_mesh_create(context, objects, first < s->vertex_count ? 2 : 1, &mesh);
    if (status == CSCD_OK) status = cscd_detector_create(context, mesh, NULL, NULL, out);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return status;
}

static cscd_status run_sheet(uint32_t triangle_count, const bench_options *o, json *out) {
    draped_sheet s;
    cscd_detector *detector = NULL;
    const uint32_t repeats = o->quick ? 2 : REPEATS;
    cscd_status status = make_sheet(triangle_count, 0.0, &s) ? CSCD_OK : CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK)
        status = open_detector(&s, s.vertex_count, s.triangle_count, o->thread_count, &detector);
    for (int form = CSCD_NEAR_PAIRS; status == CSCD_OK && form <= CSCD_NEAR_UNIQUE; form++)
        status = time_near(detector, &s, (cscd_near_form)form, repeats, out);
    cscd_detector_destroy(detector);
    free_surface(&s);
    return status;
}

/* Both sheets in one array, the ball's behind the other's. */
static bool join_sheets(const draped_sheet *a, const draped_sheet *b, draped_sheet *out) {
    *out =
        (draped_sheet){NULL, NULL, a->vertex_count + b->vertex_count, a->triangle_count + b->triangle_count};
    out->x = malloc((size_t)out->vertex_count * 3 * sizeof *out->x);
    out->triangles = malloc((size_t)out->triangle_count * 3 * sizeof *out->triangles);
    if (out->x == NULL || out->triangles == NULL) return false;
    for (size_t i = 0; i < (size_t)out->vertex_count * 3; i++) {
        const size_t of_a = (size_t)a->vertex_count * 3;
        out->x[i] = i < of_a ? a->x[i] : b->x[i - of_a];
    }
    for (size_t i = 0; i < (size_t)out->triangle_count * 3; i++) {
        const size_t of_a = (size_t)a->triangle_count * 3;
        out->triangles[i] = i < of_a ? a->triangles[i] : b->triangles[i - of_a];
    }
    return true;
}

static cscd_status run_draped(uint32_t triangle_count, const bench_options *o, json *out) {
    draped_sheet cloth = {NULL, NULL, 0, 0}, ball = {NULL, NULL, 0, 0}, both = {NULL, NULL, 0, 0};
    cscd_detector *detector = NULL;
    const double radius = 0.5 * sqrt(triangle_count / 2.0);
    bool made = make_sheet(triangle_count, radius + 0.1, &cloth) &&
                make_sheet(triangle_count, radius, &ball) && join_sheets(&cloth, &ball, &both);
    cscd_status status = made ? CSCD_OK : CSCD_OUT_OF_MEMORY;
    if (made)
        status = open_detector(&both, cloth.vertex_count, cloth.triangle_count, o->thread_count, &detector);
    for (int i = 0; status == CSCD_OK && i < 2; i++)
        status = time_truncate(detector, &both, cloth.vertex_count, i == 0 ? 0.3 : 1.0,
                               o->quick ? 2 : REPEATS, out);
    cscd_detector_destroy(detector);
    free_surface(&cloth);
    free_surface(&ball);
    free_surface(&both);
    return status;
}

static bool run_near_pairs(const bench_options *o, json *out, io_error *error) {
    for (uint32_t i = 0; i < o->size_count; i++) {
        cscd_status status = run_sheet(o->sizes[i], o, out);
        if (status == CSCD_OK) status = run_draped(o->sizes[i], o, out);
        if (status != CSCD_OK)
            return io_fail(error, "%u triangles: %s", o->sizes[i], cscd_status_string(status));
    }
    return true;
}

int main(int argument_count, char **arguments) {
    static const bench_program program = {"near_pairs", help, sizes, 2, 1, run_near_pairs};
    return bench_main(&program, argument_count, arguments);
}
