/* The saving by lists of pairs when little moves from one interval to the next: coherence on and off, side by
 * side. */
#include "benchmarks/lib/made_scenes.h"
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/stages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: coherence [options]\n"
    "\n"
    "Closed bodies that touch nothing, with method single: nanoseconds per triangle and interval without and with\n"
    "lists of pairs (coherence), by turns; means over all intervals but the first three of the least time of each over\n"
    "five rounds, and with lists also the median, and the most, which is an interval that makes a list. Speed: mean motion of a vertex in an interval, in edges. 'wave' bends and\n"
    "stretches the body, 'shake' moves each vertex about its place at random. From list: the share of the intervals\n"
    "that were answered from a list. --intervals N are measured, 60 by default.\n"
    "\n";

enum { ROUNDS = 5, LEARNING = 3, INTERVALS = 60, WAYS = 2 };

static const double speeds[] = {0.001, 0.01, 0.03, 0.1, 0.3, 1.0};

/* ---- motions --------------------------------------------------------------------------------------------- */

typedef struct slow_motion {
    const deforming_body *body;
    bool shakes;
    double speed;    /* in edges */
    double of_frame; /* in edges, of the body's own frames */
    double *frames[2];
} slow_motion;

static void place_wave(const slow_motion *m, uint32_t i, double *out) {
    double at = i * m->speed / m->of_frame, share = at - floor(at);
    deforming_body_interval(m->body, (uint32_t)at, 0.0, m->frames[0], m->frames[1]);
    for (size_t k = 0; k < (size_t)m->body->vertex_count * 3; k++)
        out[k] = m->frames[0][k] + share * (m->frames[1][k] - m->frames[0][k]);
}

/* Coordinates are off by up to s, so by s / sqrt 3 in the mean; three of them and two ends make s sqrt 2. */
static void place_shake(const slow_motion *m, uint32_t i, double *out) {
    uint32_t random = i + 1;
    double size = m->speed * m->body->edge / sqrt(2.0);
    for (size_t k = 0; k < (size_t)m->body->vertex_count * 3; k++) {
        random = random * 1664525u + 1013904223u;
        out[k] = m->body->rest[k] + size * (random * 0x1p-31 - 1.0);
    }
}

static void place_positions(const slow_motion *m, uint32_t i, double *out) {
    if (m->shakes)
        place_shake(m, i, out);
    else
        place_wave(m, i, out);
}

/* ---- rounds ---------------------------------------------------------------------------------------------- */

typedef struct coherence_times {
    double least[WAYS][INTERVALS_MAX]; /* ms */
    uint32_t answered;                 /* intervals from lists */
    size_t contacts;                   /* of all intervals, both ways */
} coherence_times;

static cscd_status run_round(cscd_detector *detectors[WAYS], const slow_motion *m, uint32_t intervals,
                             double *ends[2], coherence_times *t) {
    uint32_t vertices = m->body->vertex_count;
    cscd_status status = CSCD_OK;
    t->answered = 0;
    t->contacts = 0;
    place_positions(m, 0, ends[1]);
    for (uint32_t i = 0; status == CSCD_OK && i < intervals + LEARNING; i++) {
        memcpy(ends[0], ends[1], vertices * sizeof(double[3]));
        place_positions(m, i + 1, ends[1]);
        for (int way = 0; status == CSCD_OK && way < WAYS; way++) {
            cscd_contacts found = {.count = 0};
            status = cscd_detector_step(detectors[way], CSCD_DOUBLES(ends[0], vertices),
                                        CSCD_DOUBLES(ends[1], vertices), &found);
            if (status != CSCD_OK || i < LEARNING) continue;
            double *least = &t->least[way][i - LEARNING];
            *least = fmin(*least, cscd_detector_timings(detectors[way]).total_ms);
            t->answered += (uint32_t)cscd_detector_counters(detectors[way]).coherent;
            t->contacts += found.count;
        }
    }
    return status;
}

static cscd_status run_rounds(cscd_context *context, const cscd_mesh *mesh, const slow_motion *m,
                              uint32_t intervals, coherence_times *out) {
    double *ends[2];
    cscd_status status = CSCD_OK;
    for (int i = 0; i < 2; i++) ends[i] = body_allocate(m->body->vertex_count, sizeof(double[3]));
    for (int way = 0; way < WAYS; way++)
        for (uint32_t i = 0; i < intervals; i++) out->least[way][i] = HUGE_VAL;
    for (int round = 0; status == CSCD_OK && round < ROUNDS; round++) {
        cscd_detector *detectors[WAYS] = {NULL, NULL};
        for (int way = 0; status == CSCD_OK && way < WAYS; way++) {
            cscd_detector_options options = cscd_detector_defaults();
            options.method = CSCD_METHOD_SINGLE;
            options.coherence = way == 0 ? CSCD_COHERENCE_OFF : CSCD_COHERENCE_AUTO;
            status = cscd_detector_create(context, mesh, NULL, &options, &detectors[way]);
        }
        if (status == CSCD_OK) status = run_round(detectors, m, intervals, ends, out);
        for (int way = 0; way < WAYS; way++) cscd_detector_destroy(detectors[way]);
    }
    for (int i = 0; i < 2; i++) free(ends[i]);
    return status;
}

/* ---- rows ------------------------------------------------------------------------------------------------ */

static void report_row(const char *name, const slow_motion *m, uint32_t intervals, const coherence_times *t,
                       json *out) {
    double ns[WAYS] = {0.0, 0.0}, share = 1e6 / m->body->triangle_count;
    for (int way = 0; way < WAYS; way++)
        for (uint32_t i = 0; i < intervals; i++) ns[way] += share * t->least[way][i] / intervals;
    double middle = share * median(t->least[1], intervals), most = 0.0,
           answered = (double)t->answered / intervals;
    const char *motion = m->shakes ? "shake" : "wave";
    for (uint32_t i = 0; i < intervals; i++) most = fmax(most, share * t->least[1][i]);
    printf("  %-8s %9u %-6s %7.3f %9.2f %9.2f %9.2f %9.2f %8.2f %10.0f %% %9zu\n", name,
           m->body->triangle_count, motion, m->speed, ns[0], ns[1], middle, most, ns[1] / ns[0],
           100.0 * answered, t->contacts);
    fflush(stdout);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "scene", name);
    json_integer(out, "triangles", m->body->triangle_count);
    json_string(out, "motion", motion);
    json_number(out, "speed", m->speed);
    json_number(out, "off_ns", ns[0]);
    json_number(out, "on_ns", ns[1]);
    json_number(out, "on_median_ns", middle);
    json_number(out, "on_most_ns", most);
    json_number(out, "answered", answered);
    json_end_object(out);
}

static bool measure_body(cscd_context *context, body_kind kind, uint32_t size, const bench_options *o,
                         json *out, io_error *error) {
    uint32_t intervals = o->interval_count > 0 ? o->interval_count : INTERVALS;
    deforming_body b;
    cscd_mesh *mesh = NULL;
    if (!deforming_body_make(kind, size, DEFORM_WAVE, o->shuffled, &b, error)) return false;
    cscd_object_desc object = cscd_object_of_triangles(b.vertex_count, b.triangle_count, b.triangles);
    cscd_status status = cscd_mesh_create(context, &object, 1, &mesh);
    slow_motion m = {.body = &b, .of_frame = deforming_body_speed(&b)};
    for (int i = 0; i < 2; i++) m.frames[i] = body_allocate(b.vertex_count, sizeof(double[3]));
    for (size_t i = 0; status == CSCD_OK && i < 2 * sizeof speeds / sizeof *speeds; i++) {
        coherence_times times;
        m.shakes = i % 2 != 0;
        m.speed = speeds[i / 2];
        if (m.shakes && m.speed > 0.1) continue; /* it would fold */
        status = run_rounds(context, mesh, &m, intervals, &times);
        if (status == CSCD_OK) report_row(body_kind_name(kind), &m, intervals, &times, out);
    }
    for (int i = 0; i < 2; i++) free(m.frames[i]);
    cscd_mesh_destroy(mesh);
    deforming_body_free(&b);
    return status == CSCD_OK || io_fail(error, "%s", cscd_context_detail(context));
}

static bool run_bodies(const bench_options *o, json *out, io_error *error) {
    static const body_kind kinds[] = {BODY_TORUS, BODY_FIGURE};
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = o->thread_count;
    options.simd = o->simd;
    if (cscd_context_create(&options, &context) != CSCD_OK) return io_fail(error, "out of memory");
    printf("  %-8s %9s %-6s %7s %9s %9s %9s %9s %8s %12s %9s\n", "scene", "triangles", "motion", "speed",
           "off ns", "on ns", "median", "most", "on/off", "from list", "contacts");
    bool good = true;
    for (size_t k = 0; good && k < sizeof kinds / sizeof *kinds; k++) {
        for (uint32_t i = 0; good && i < o->size_count; i++)
            good = measure_body(context, kinds[k], o->sizes[i], o, out, error);
    }
    cscd_context_destroy(context);
    return good;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {20000, 100000};
    static const bench_program program = {"coherence", help, sizes, 2, 1, run_bodies};
    return bench_main(&program, argument_count, arguments);
}
