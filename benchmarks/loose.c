/* The cost of points, wires and a half-space near a cloth: a step with them, without them, and by brute
 * force. */
#include "benchmarks/lib/options.h"
#include "cscd/research.h"
#include "src/core/timer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Brute force looks at cloths of up to this number of triangles: more take minutes. */
enum { REPEATS = 25, OBJECTS = 4, BRUTE_MOST = 10000 };

static const char help[] =
    "usage: loose [options]\n"
    "\n"
    "What wires, points and a half-space cost beside a cloth of the given size: half as many points as triangles,\n"
    "a quarter as many wires in strands of 25, all of them strewn about the cloth, and a half-space that the cloth\n"
    "and some of them touch. All keep a distance of a fifth of the cloth's cells. Milliseconds of a steady step,\n"
    "each the least of some repetitions, beside those of the cloth alone, and, up to 10,000 triangles, once by brute\n"
    "force, which must find as many contacts. Method none.\n"
    "--intervals: the repetitions (default 25, with --quick 9).\n"
    "\n";

/* The cloth comes first, then points, wires and the half-space; a row has some of the last three. */
typedef struct loose_rig {
    uint32_t side, triangle_count, vertex_count, repeats;
    cscd_object_desc objects[OBJECTS];
    uint32_t *triangles, *wires;
    double *x[2]; /* of all objects */
    cscd_context *context;
} loose_rig;

static uint32_t random_state;

/* From 0 to 1 (Numerical Recipes' linear congruence). */
static double random_share(void) {
    random_state = random_state * 1664525u + 1013904223u;
    return random_state * 0x1p-32;
}

static void make_cloth(loose_rig *r) {
    uint32_t *next = r->triangles;
    for (uint32_t i = 0; i + 1 < r->side; i++) {
        for (uint32_t j = 0; j + 1 < r->side; j++) {
            uint32_t v = i * r->side + j;
            const uint32_t cell[6] = {v, v + 1, v + r->side, v + 1, v + r->side + 1, v + r->side};
            memcpy(next, cell, sizeof cell);
            next += 6;
        }
    }
    for (uint32_t v = 0; v < r->side * r->side; v++) {
        double *x0 = r->x[0] + (size_t)v * 3, *x1 = r->x[1] + (size_t)v * 3;
        x0[0] = x1[0] = (double)(v % r->side) / r->side;
        x0[1] = x1[1] = (double)(v / r->side) / r->side;
        x0[2] = 0.05 * sin(20.0 * x0[0]) * sin(20.0 * x0[1]);
        x1[2] = 0.98 * x0[2];
    }
}

/* In a layer about the cloth: points anywhere, the vertices of a strand one after the other. */
static void strew_vertices(loose_rig *r, uint32_t begin, uint32_t end, uint32_t strand) {
    double cell = 1.0 / r->side;
    for (uint32_t v = begin; v < end; v++) {
        double *x0 = r->x[0] + (size_t)v * 3, *x1 = r->x[1] + (size_t)v * 3;
        for (int k = 0; k < 3; k++) {
            bool goes_on = (v - begin) % strand != 0;
            x0[k] =
                goes_on ? x0[k - 3] + cell * (random_share() - 0.5) : random_share() * (k == 2 ? 0.1 : 1.0);
            x1[k] = x0[k] + 0.1 * cell * (random_share() - 0.5);
        }
    }
}

static void make_wires(loose_rig *r, uint32_t wire_count) {
    for (uint32_t i = 0; i < wire_count; i++) {
        r->wires[2 * i] = i / 24 * 25 + i % 24;
        r->wires[2 * i + 1] = r->wires[2 * i] + 1;
    }
}

static bool make_scene(loose_rig *r, uint32_t size) {
    static const double up[3] = {0.0, 0.0, 1.0};
    r->side = (uint32_t)lround(sqrt(size / 2.0)) + 1;
    r->triangle_count = 2 * (r->side - 1) * (r->side - 1);
    uint32_t points = r->triangle_count / 2, strands = r->triangle_count / 96, cloth = r->side * r->side;
    r->vertex_count = cloth + points + strands * 25 + 1;
    r->triangles = malloc((size_t)r->triangle_count * 3 * sizeof *r->triangles);
    r->wires = malloc((size_t)strands * 48 * sizeof *r->wires);
    for (int i = 0; i < 2; i++) r->x[i] = malloc((size_t)r->vertex_count * 3 * sizeof *r->x[i]);
    if (r->triangles == NULL || r->wires == NULL || r->x[0] == NULL || r->x[1] == NULL) return false;
    random_state = 1;
    make_cloth(r);
    make_wires(r, strands * 24);
    strew_vertices(r, cloth, cloth + points, 1);
    strew_vertices(r, cloth + points, r->vertex_count - 1, 25);
    for (int i = 0; i < 2; i++) {
        const double point[3] = {0.0, 0.0, -0.049};
        memcpy(r->x[i] + ((size_t)r->vertex_count - 1) * 3, point, sizeof point);
    }
    r->objects[0] = cscd_object_of_triangles(cloth, r->triangle_count, r->triangles);
    r->objects[1] = cscd_object_of_points(points);
    r->objects[2] = cscd_object_of_wires(strands * 25, strands * 24, r->wires);
    r->objects[3] = cscd_object_half_space(up);
    return true;
}

static void free_scene(loose_rig *r) {
    free(r->triangles);
    free(r->wires);
    for (int i = 0; i < 2; i++) free(r->x[i]);
}

/* ---- rows ---------------------------------------------------------------------------------------------- */

typedef struct row_result {
    double ms;
    size_t contacts;
} row_result;

/* The positions of some of the objects: a view of each. */
static void view_objects(const loose_rig *r, const bool in[OBJECTS], int end, cscd_view out[OBJECTS]) {
    size_t first = 0;
    int count = 0;
    for (int i = 0; i < OBJECTS; i++) {
        if (in[i]) out[count] = cscd_view_doubles(r->x[end] + first * 3, r->objects[i].vertex_count);
        if (in[i]) out[count++].object_count = 1;
        first += r->objects[i].vertex_count;
    }
}

static cscd_status run_steps(const loose_rig *r, const bool in[OBJECTS], cscd_detector *detector,
                             uint32_t repeats, row_result *out) {
    cscd_view x0[OBJECTS], x1[OBJECTS];
    cscd_contacts found = {.count = 0};
    cscd_status status = CSCD_OK;
    view_objects(r, in, 0, x0);
    view_objects(r, in, 1, x1);
    out->ms = HUGE_VAL;
    for (uint32_t i = 0; status == CSCD_OK && i < repeats; i++) {
        double now = timer_now_ms(), took = 0.0;
        status = cscd_detector_step(detector, x0, x1, &found);
        timer_lap(&now, &took);
        out->ms = fmin(out->ms, took);
    }
    out->contacts = found.count;
    return status;
}

static cscd_status measure_row(const loose_rig *r, const bool in[OBJECTS], cscd_method method,
                               uint32_t repeats, row_result *out) {
    cscd_object_desc objects[OBJECTS];
    uint32_t count = 0;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.min_separation = 0.2 / r->side;
    for (int i = 0; i < OBJECTS; i++) {
        if (in[i]) objects[count++] = r->objects[i];
    }
    cscd_status status = cscd_mesh_create(r->context, objects, count, &mesh);
    if (status == CSCD_OK) status = cscd_detector_create(r->context, mesh, NULL, &options, &detector);
    if (status == CSCD_OK) status = run_steps(r, in, detector, repeats, out);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    return status;
}

static void report_row(const loose_rig *r, const char *name, const row_result *fast, const row_result *brute,
                       double alone, json *out) {
    printf("  %9u %-22s %9.3f %7.2f %10zu", r->triangle_count, name, fast->ms, fast->ms / alone,
           fast->contacts);
    if (brute->ms > 0.0) printf(" %12.1f %9.0f", brute->ms, brute->ms / fast->ms);
    printf("\n");
    fflush(stdout);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_integer(out, "triangles", r->triangle_count);
    json_string(out, "objects", name);
    json_number(out, "step", fast->ms);
    json_integer(out, "contacts", fast->contacts);
    if (brute->ms > 0.0) json_number(out, "brute force", brute->ms);
    json_end_object(out);
}

static bool run_rows(const loose_rig *r, json *out, io_error *error) {
    static const char *const names[] = {"cloth", "+ points", "+ wires", "+ half-space", "+ all"};
    double alone = 1.0;
    for (int row = 0; row < 5; row++) {
        const bool in[OBJECTS] = {true, row == 1 || row == 4, row == 2 || row == 4, row >= 3};
        row_result fast, brute = {.ms = 0.0};
        bool compared = r->triangle_count <= BRUTE_MOST;
        cscd_status status = measure_row(r, in, CSCD_METHOD_NONE, r->repeats, &fast);
        if (status == CSCD_OK && compared) status = measure_row(r, in, CSCD_METHOD_BRUTE, 1, &brute);
        if (status != CSCD_OK) return io_fail(error, "%s", cscd_context_detail(r->context));
        if (compared && fast.contacts != brute.contacts)
            return io_fail(error, "%s: %zu contacts, by brute force %zu", names[row], fast.contacts,
                           brute.contacts);
        if (row == 0) alone = fast.ms;
        report_row(r, names[row], &fast, &brute, alone, out);
    }
    return true;
}

static bool run_sizes(const bench_options *o, json *out, io_error *error) {
    bool good = true;
    printf("%u thread%s, simd %s; ms a step\n  %9s %-22s %9s %7s %10s %12s %9s\n", o->thread_count,
           o->thread_count == 1 ? "" : "s", cscd_name(CSCD_SIMDS, o->simd), "triangles", "objects", "step",
           "ratio", "contacts", "brute force", "times");
    for (uint32_t i = 0; good && i < o->size_count; i++) {
        loose_rig r = {.repeats = o->interval_count > 0 ? o->interval_count : o->quick ? 9 : REPEATS};
        cscd_context_options options = cscd_context_defaults();
        options.thread_count = o->thread_count;
        options.simd = o->simd;
        cscd_status status = cscd_context_create(&options, &r.context);
        good = status == CSCD_OK || io_fail(error, "context: %s", cscd_status_string(status));
        if (good) good = make_scene(&r, o->sizes[i]) || io_fail(error, "memory ran out");
        if (good) good = run_rows(&r, out, error);
        free_scene(&r);
        cscd_context_destroy(r.context);
    }
    return good;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {5000, 20000};
    static const bench_program program = {"loose", help, sizes, 2, 1, run_sizes};
    return bench_main(&program, argument_count, arguments);
}
