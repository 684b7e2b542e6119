/* The cost of a tear: the mesh is changed and the detector moves over, compared with the cost of the torn
 * object alone. */
#include "benchmarks/lib/made_scenes.h"
#include "benchmarks/lib/options.h"
#include "src/core/timer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS = 15, SHARE_COUNT = 3 };

static const uint32_t shares[SHARE_COUNT] = {16, 4, 1};

static const char help[] =
    "usage: tears [options]\n"
    "\n"
    "What a solver pays when a cloth is torn beside a body that is not: cscd_mesh_change_create with the origins\n"
    "of vertices, cscd_detector_change_mesh, and what the next step takes longer than a steady one. Beside it what\n"
    "the cloth costs alone: a mesh, a detector, and what its first step takes longer. The cloth has a 16th of the\n"
    "body's triangles, a quarter, and as many. Milliseconds, each the least of some repetitions. ns: what a change\n"
    "takes beyond 1, and beyond 1.3 times the cost of the cloth alone, per triangle of the body. Then a second\n"
    "detector on the mesh of both: created, and what its first step takes longer, and the same of a clone. Method\n"
    "single.\n"
    "--intervals: the repetitions (default 15, with --quick 5).\n"
    "\n";

typedef enum part { PART_MESH, PART_DETECTOR, PART_NEXT, PART_COUNT } part;

/* A sheet of rows x rows vertices; torn: the vertex in its middle is two. */
typedef struct cloth {
    uint32_t rows, vertex_count, triangle_count;
    uint32_t *triangles[2],
        *origins[2]; /* whole and torn, and where the vertices of each come from in the other */
    double *x[2][2]; /* whole and torn, at the start and at the end, the body's behind it */
} cloth;

/* The least of all repetitions, for one share. */
typedef struct tear_times {
    double alone[PART_COUNT], change[PART_COUNT], created[PART_COUNT], cloned[PART_COUNT];
} tear_times;

typedef struct tear_rig {
    const deforming_body *body;
    cloth sheet;
    cscd_context *context;
    uint32_t repeats;
} tear_rig;

/* ---- the scene ----------------------------------------------------------------------------------------- */

static void fill_triangles(cloth *c) {
    uint32_t rows = c->rows, *next = c->triangles[0], middle = (rows / 2) * rows + rows / 2;
    for (uint32_t i = 0; i + 1 < rows; i++) {
        for (uint32_t j = 0; j + 1 < rows; j++) {
            uint32_t a = i * rows + j, corners[6] = {a, a + 1, a + rows, a + 1, a + rows + 1, a + rows};
            memcpy(next, corners, sizeof corners);
            next += 6;
        }
    }
    memcpy(c->triangles[1], c->triangles[0], (size_t)c->triangle_count * sizeof(uint32_t[3]));
    for (uint32_t k = 0; k < rows / 2 * (rows - 1) * 6; k++) {
        if (c->triangles[1][k] == middle) c->triangles[1][k] = c->vertex_count;
    }
    for (uint32_t v = 0; v <= c->vertex_count; v++) c->origins[0][v] = c->origins[1][v] = v;
    c->origins[1][c->vertex_count] = middle;
}

static void place_vertices(const tear_rig *r, int torn, int end) {
    const cloth *c = &r->sheet;
    double *x = c->x[torn][end];
    for (uint32_t v = 0; v < c->vertex_count; v++) {
        double u = v % c->rows, w = (double)(v / c->rows);
        x[3 * v] = u / c->rows;
        x[3 * v + 1] = w / c->rows;
        x[3 * v + 2] = 20.0 + 0.05 * sin(9.0 * u / c->rows) * cos(7.0 * w / c->rows) + 0.01 * end;
    }
    if (torn == 1) {
        memcpy(x + 3 * c->vertex_count, x + 3 * c->origins[1][c->vertex_count], sizeof(double[3]));
        x[3 * c->vertex_count] -= 0.1 / c->rows;
        x[3 * c->vertex_count + 1] -= 0.1 / c->rows;
    }
}

static void make_cloth(tear_rig *r, uint32_t triangle_count) {
    cloth *c = &r->sheet;
    c->rows = (uint32_t)sqrt(triangle_count / 2.0) + 1;
    c->vertex_count = c->rows * c->rows;
    c->triangle_count = (c->rows - 1) * (c->rows - 1) * 2;
    for (int torn = 0; torn < 2; torn++) {
        c->triangles[torn] = body_allocate(c->triangle_count, sizeof(uint32_t[3]));
        c->origins[torn] = body_allocate((size_t)c->vertex_count + 1, sizeof(uint32_t));
        for (int end = 0; end < 2; end++)
            c->x[torn][end] =
                body_allocate((size_t)c->vertex_count + 1 + r->body->vertex_count, sizeof(double[3]));
    }
    fill_triangles(c);
    for (int torn = 0; torn < 2; torn++) {
        double *ends[2];
        for (int end = 0; end < 2; end++) {
            place_vertices(r, torn, end);
            ends[end] = c->x[torn][end] + 3 * (c->vertex_count + (size_t)torn);
        }
        deforming_body_interval(r->body, 0, 0.0, ends[0], ends[1]);
    }
}

static void free_cloth(cloth *c) {
    for (int torn = 0; torn < 2; torn++) {
        free(c->triangles[torn]);
        free(c->origins[torn]);
        free(c->x[torn][0]);
        free(c->x[torn][1]);
    }
}

/* ---- what is measured ---------------------------------------------------------------------------------- */

static cscd_object_desc describe_cloth(const tear_rig *r, int torn) {
    const cloth *c = &r->sheet;
    return cscd_object_of_triangles(c->vertex_count + (uint32_t)torn, c->triangle_count, c->triangles[torn]);
}

static cscd_status step_to(const tear_rig *r, cscd_detector *d, int torn, int from, double *ms) {
    uint32_t count = cscd_mesh_vertex_count(cscd_detector_mesh(d));
    double *const *x = r->sheet.x[torn];
    double now = timer_now_ms();
    cscd_contacts found;
    cscd_status status =
        cscd_detector_step(d, CSCD_DOUBLES(x[from], count), CSCD_DOUBLES(x[1 - from], count), &found);
    *ms = timer_now_ms() - now;
    return status;
}

/* The time that the next step takes longer than the ones after it, which go to and fro. */
static cscd_status steps_after(const tear_rig *r, cscd_detector *d, int torn, double *longer) {
    double first = 0.0, ms, steady = HUGE_VAL;
    cscd_status status = step_to(r, d, torn, 0, &first);
    for (int i = 0; status == CSCD_OK && i < 5; i++) {
        status = step_to(r, d, torn, 1 - i % 2, &ms);
        steady = fmin(steady, ms);
    }
    *longer = first - steady;
    return status;
}

static cscd_status create_detector(const tear_rig *r, const cscd_mesh *mesh, cscd_detector **out) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_SINGLE;
    return cscd_detector_create(r->context, mesh, NULL, &options, out);
}

static void keep_least(double least[PART_COUNT], const double ms[PART_COUNT]) {
    for (int i = 0; i < PART_COUNT; i++) least[i] = fmin(least[i], ms[i]);
}

static cscd_status measure_alone(const tear_rig *r, double least[PART_COUNT]) {
    cscd_object_desc desc = describe_cloth(r, 1);
    cscd_mesh *mesh = NULL;
    cscd_detector *d = NULL;
    double ms[PART_COUNT], now = timer_now_ms();
    cscd_status status = cscd_mesh_create(r->context, &desc, 1, &mesh);
    ms[PART_MESH] = timer_now_ms() - now;
    now = timer_now_ms();
    if (status == CSCD_OK) status = create_detector(r, mesh, &d);
    ms[PART_DETECTOR] = timer_now_ms() - now;
    if (status == CSCD_OK) status = steps_after(r, d, 1, &ms[PART_NEXT]);
    if (status == CSCD_OK) keep_least(least, ms);
    cscd_detector_destroy(d);
    cscd_mesh_destroy(mesh);
    return status;
}

/* Tears the cloth, or mends it. */
static cscd_status measure_change(const tear_rig *r, cscd_detector *d, int torn, cscd_mesh_change **last,
                                  double least[PART_COUNT]) {
    cscd_object_desc desc = describe_cloth(r, torn);
    const cscd_object_change changes[1] = {
        {.object = 0, .desc = &desc, .vertex_origins = r->sheet.origins[torn]}};
    cscd_mesh_change *change = NULL;
    double ms[PART_COUNT], now = timer_now_ms();
    cscd_status status = cscd_mesh_change_create(r->context, cscd_detector_mesh(d), changes, 1, &change);
    if (status == CSCD_OK) cscd_mesh_change_to_old(change, CSCD_VERTICES, NULL);
    ms[PART_MESH] = timer_now_ms() - now;
    now = timer_now_ms();
    if (status == CSCD_OK) status = cscd_detector_change_mesh(d, change);
    ms[PART_DETECTOR] = timer_now_ms() - now;
    if (status == CSCD_OK) status = steps_after(r, d, torn, &ms[PART_NEXT]);
    if (status == CSCD_OK) status = step_to(r, d, torn, 0, &now);
    if (status == CSCD_OK) status = step_to(r, d, torn, 1, &now);
    if (status == CSCD_OK && torn == 1) keep_least(least, ms);
    cscd_mesh_change_destroy(*last);
    *last = change;
    return status;
}

static cscd_status create_scene(const tear_rig *r, cscd_mesh **out) {
    const deforming_body *b = r->body;
    cscd_object_desc descs[2] = {describe_cloth(r, 0),
                                 cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles)};
    return cscd_mesh_create(r->context, descs, 2, out);
}

static cscd_status measure_changes(const tear_rig *r, double least[PART_COUNT]) {
    cscd_mesh *mesh = NULL;
    cscd_detector *d = NULL;
    cscd_mesh_change *last = NULL;
    double unused;
    cscd_status status = create_scene(r, &mesh);
    if (status == CSCD_OK) status = create_detector(r, mesh, &d);
    if (status == CSCD_OK) status = step_to(r, d, 0, 0, &unused);
    if (status == CSCD_OK) status = step_to(r, d, 0, 1, &unused);
    for (uint32_t i = 0; status == CSCD_OK && i < 2 * r->repeats; i++)
        status = measure_change(r, d, i % 2 == 0, &last, least);
    cscd_detector_destroy(d);
    cscd_mesh_change_destroy(last);
    cscd_mesh_destroy(mesh);
    return status;
}

/* A detector on the mesh, created, or a clone of one that has made a step. */
static cscd_status measure_second(const tear_rig *r, const cscd_mesh *mesh, const cscd_detector *first,
                                  double least[PART_COUNT]) {
    cscd_detector *d = NULL;
    double ms[PART_COUNT] = {0.0}, now = timer_now_ms();
    cscd_status status =
        first == NULL ? create_detector(r, mesh, &d) : cscd_detector_clone(r->context, first, &d);
    ms[PART_DETECTOR] = timer_now_ms() - now;
    if (status == CSCD_OK) status = steps_after(r, d, 0, &ms[PART_NEXT]);
    if (status == CSCD_OK) keep_least(least, ms);
    cscd_detector_destroy(d);
    return status;
}

static cscd_status measure_clones(const tear_rig *r, double created[PART_COUNT], double cloned[PART_COUNT]) {
    cscd_mesh *mesh = NULL;
    cscd_detector *first = NULL;
    double unused;
    cscd_status status = create_scene(r, &mesh);
    if (status == CSCD_OK) status = create_detector(r, mesh, &first);
    if (status == CSCD_OK) status = step_to(r, first, 0, 1, &unused);
    for (uint32_t i = 0; status == CSCD_OK && i < r->repeats; i++) {
        status = measure_second(r, mesh, NULL, created);
        if (status == CSCD_OK) status = measure_second(r, mesh, first, cloned);
    }
    cscd_detector_destroy(first);
    cscd_mesh_destroy(mesh);
    return status;
}

/* ---- rows ---------------------------------------------------------------------------------------------- */

static double sum_of(const double ms[PART_COUNT]) {
    return ms[PART_MESH] + ms[PART_DETECTOR] + ms[PART_NEXT];
}

static void print_row(const tear_rig *r, const double alone[PART_COUNT], const double change[PART_COUNT]) {
    uint32_t others = r->body->triangle_count;
    double a = sum_of(alone), c = sum_of(change);
    printf("  %9u %9u", others, r->sheet.triangle_count);
    for (int i = 0; i < PART_COUNT; i++) printf(" %9.3f", alone[i]);
    for (int i = 0; i < PART_COUNT; i++) printf(" %9.3f", change[i]);
    printf(" %8.2f %8.1f %8.1f\n", c / a, (c - a) * 1e6 / others, (c - 1.3 * a) * 1e6 / others);
    fflush(stdout);
}

static void print_clones(const tear_rig *r, const double created[PART_COUNT],
                         const double cloned[PART_COUNT]) {
    printf("  %9u %9u   a second detector: created %.3f, first step %.3f; cloned %.3f, first step %.3f\n",
           r->body->triangle_count, r->sheet.triangle_count, created[PART_DETECTOR], created[PART_NEXT],
           cloned[PART_DETECTOR], cloned[PART_NEXT]);
    fflush(stdout);
}

static void write_parts(json *out, const char *name, const double ms[PART_COUNT], part begin) {
    static const char *const names[PART_COUNT] = {"mesh", "detector", "next step"};
    json_begin_object(out, name);
    for (int i = (int)begin; i < PART_COUNT; i++) json_number(out, names[i], ms[i]);
    json_end_object(out);
}

static void write_row(json *out, const tear_rig *r, const tear_times *m) {
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_integer(out, "triangles", r->body->triangle_count);
    json_integer(out, "torn", r->sheet.triangle_count);
    write_parts(out, "alone", m->alone, PART_MESH);
    write_parts(out, "change", m->change, PART_MESH);
    write_parts(out, "created", m->created, PART_DETECTOR);
    write_parts(out, "cloned", m->cloned, PART_DETECTOR);
    json_end_object(out);
}

static bool run_share(tear_rig *r, uint32_t triangle_count, json *out, io_error *error) {
    tear_times m;
    for (int i = 0; i < PART_COUNT; i++) m.alone[i] = m.change[i] = m.created[i] = m.cloned[i] = HUGE_VAL;
    make_cloth(r, triangle_count);
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; status == CSCD_OK && i < r->repeats; i++) status = measure_alone(r, m.alone);
    if (status == CSCD_OK) status = measure_changes(r, m.change);
    if (status == CSCD_OK) status = measure_clones(r, m.created, m.cloned);
    bool good = status == CSCD_OK || io_fail(error, "%s", cscd_context_detail(r->context));
    if (good) print_row(r, m.alone, m.change);
    if (good) print_clones(r, m.created, m.cloned);
    if (good) write_row(out, r, &m);
    free_cloth(&r->sheet);
    return good;
}

static bool run_size(const bench_options *o, uint32_t size, json *out, io_error *error) {
    deforming_body b;
    if (!deforming_body_make(o->kind, size, DEFORM_WAVE, o->shuffled, &b, error)) return false;
    tear_rig r = {.body = &b, .repeats = o->interval_count > 0 ? o->interval_count : o->quick ? 5 : REPEATS};
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = o->thread_count;
    options.simd = o->simd;
    cscd_status status = cscd_context_create(&options, &r.context);
    bool good = status == CSCD_OK || io_fail(error, "context: %s", cscd_status_string(status));
    for (int i = 0; good && i < SHARE_COUNT; i++)
        good = run_share(&r, b.triangle_count / shares[i], out, error);
    cscd_context_destroy(r.context);
    deforming_body_free(&b);
    return good;
}

static bool run_sizes(const bench_options *o, json *out, io_error *error) {
    printf("%s, %u thread%s, simd %s; ms\n  %9s %9s %29s %29s\n", body_kind_name(o->kind), o->thread_count,
           o->thread_count == 1 ? "" : "s", cscd_name(CSCD_SIMDS, o->simd), "", "", "the cloth alone",
           "the change");
    printf("  %9s %9s %9s %9s %9s %9s %9s %9s %8s %8s %8s\n", "triangles", "torn", "mesh", "detector",
           "first", "mesh", "detector", "next", "ratio", "ns > 1", "ns > 1.3");
    bool good = true;
    for (uint32_t i = 0; good && i < o->size_count; i++) good = run_size(o, o->sizes[i], out, error);
    return good;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {5000, 20000, 100000};
    static const bench_program program = {"tears", help, sizes, 3, 2, run_sizes};
    return bench_main(&program, argument_count, arguments);
}
