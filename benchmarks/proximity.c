/* Proximity queries, minimum separation, certified steps and line searches, each compared with a plain
 * step. */
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/scene_files.h"
#include "benchmarks/lib/stages.h"
#include "src/core/timer.h"

#include <math.h>
#include <stdlib.h>

enum { REPEATS = 5, INTERVALS = 10, FIRST_FRAME = 80 };

static const double budget_ms = 2000.0, crowded = 10.0; /* pairs per triangle */

static const char models[] = "build/models";

static const char help[] =
    "usage: proximity [options]\n"
    "\n"
    "What cscd_detector_find_near, a step with min_separation, cscd_detector_max_step and a cscd_line_search take, in plain\n"
    "steps of method none, mode all: intervals of recordings (build/models, recorded if missing) and of cloth.\n"
    "Each interval's least of some repetitions, fewer of what takes seconds; an interval that max_step refuses\n"
    "for its start counts in no ratio of max_step and line. Lengths are in mean edges of the first frame, up to\n"
    "the first at which ten pairs per triangle are near. --intervals: of each recording (default 10, behind\n"
    "frame 80). --sizes, --body, --volume and --shuffled mean nothing here.\n"
    "\n";

/* Consecutive frames, all in memory. Intervals before first_timed are only stepped over, so that a
 * detector that culls has proven the start of the first timed one. */
typedef struct frames {
    const char *name;
    cscd_mesh *mesh;
    cscd_plan *plan; /* NULL: detectors do not cull */
    double edge;     /* mean length in the first frame */
    uint32_t first_timed, interval_count;
    const double *ends[INTERVALS_MAX + 2];
} frames;

typedef struct task_rig {
    const frames *f;
    cscd_detector *detector;
    cscd_line_search *line;
    double distance;
    size_t found; /* length of the list of the last call */
} task_rig;

typedef struct task {
    cscd_method method;
    double separation, distance, reach;                     /* in edges */
    cscd_status (*prepare)(task_rig *r, uint32_t interval); /* not timed; may be NULL */
    cscd_status (*act)(task_rig *r, uint32_t interval);
} task;

/* Times per interval, NAN for a refused one; found: mean per call. */
typedef struct task_result {
    double ms[INTERVALS_MAX + 1], found;
    uint32_t refused;
} task_result;

/* ---- what is timed ----------------------------------------------------------------------------------- */

static cscd_status act_step(task_rig *r, uint32_t i) {
    cscd_contacts found = {.count = 0};
    cscd_status status =
        cscd_detector_step(r->detector, CSCD_DOUBLES(r->f->ends[i], cscd_mesh_vertex_count(r->f->mesh)),
                           CSCD_DOUBLES(r->f->ends[i + 1], cscd_mesh_vertex_count(r->f->mesh)), &found);
    r->found = found.count;
    return status;
}

static cscd_status act_near(task_rig *r, uint32_t i) {
    cscd_proximities found = {.count = 0};
    cscd_status status =
        cscd_detector_find_near(r->detector, CSCD_DOUBLES(r->f->ends[i], cscd_mesh_vertex_count(r->f->mesh)),
                                r->distance, CSCD_NEAR_PAIRS, &found);
    r->found = found.count;
    return status;
}

static cscd_status act_max_step(task_rig *r, uint32_t i) {
    cscd_free_step unused;
    return cscd_detector_max_step(
        r->detector, CSCD_DOUBLES(r->f->ends[i], cscd_mesh_vertex_count(r->f->mesh)),
        CSCD_DOUBLES(r->f->ends[i + 1], cscd_mesh_vertex_count(r->f->mesh)), NULL, &unused);
}

static cscd_status act_begin(task_rig *r, uint32_t i) {
    cscd_status status = cscd_line_search_begin(
        r->line, CSCD_DOUBLES(r->f->ends[i], cscd_mesh_vertex_count(r->f->mesh)),
        CSCD_DOUBLES(r->f->ends[i + 1], cscd_mesh_vertex_count(r->f->mesh)), r->distance);
    r->found = cscd_line_search_candidate_count(r->line);
    return status;
}

static cscd_status act_line_step(task_rig *r, uint32_t i) {
    cscd_free_step unused;
    (void)i;
    return cscd_line_search_max_step(r->line, 1.0, NULL, &unused);
}

static cscd_status act_line_near(task_rig *r, uint32_t i) {
    cscd_proximities found = {.count = 0};
    (void)i;
    cscd_status status = cscd_line_search_find_near(r->line, 0.5, r->distance, CSCD_NEAR_PAIRS, &found);
    r->found = found.count;
    return status;
}

/* ---- timing ------------------------------------------------------------------------------------------ */

static cscd_status run_once(task_rig *r, const task *t, bool counts, task_result *out) {
    for (uint32_t i = 0; i < r->f->interval_count; i++) {
        double took = 0.0;
        cscd_status status = t->prepare != NULL ? t->prepare(r, i) : CSCD_OK;
        if (status != CSCD_OK) return status;
        double now = timer_now_ms();
        status = t->act(r, i);
        timer_lap(&now, &took);
        if (status != CSCD_OK && status != CSCD_IN_CONTACT) return status;
        if (!counts || i < r->f->first_timed) continue;
        out->ms[i] = status == CSCD_OK ? fmin(out->ms[i], took) : NAN;
        out->found += (double)r->found;
    }
    return CSCD_OK;
}

/* Measures a task. The first run, which builds trees and grows buffers, is left out. */
static bool measure_task(const frames *f, const task *t, uint32_t repeats, task_result *out,
                         io_error *error) {
    task_rig r = {.f = f, .distance = t->distance * f->edge};
    cscd_detector_options options = cscd_detector_defaults();
    options.method = t->method;
    options.min_separation = t->separation * f->edge;
    *out = (task_result){.found = 0.0};
    for (uint32_t i = 0; i < f->interval_count; i++) out->ms[i] = HUGE_VAL;
    cscd_status status =
        cscd_detector_create(cscd_mesh_context(f->mesh), f->mesh, f->plan, &options, &r.detector);
    if (status == CSCD_OK) status = cscd_line_search_create(r.detector, &r.line);
    double begin = timer_now_ms();
    uint32_t runs = 0;
    for (; status == CSCD_OK && runs <= repeats && (runs < 2 || timer_now_ms() - begin < budget_ms); runs++)
        status = run_once(&r, t, runs > 0, out);
    cscd_line_search_destroy(r.line);
    cscd_detector_destroy(r.detector);
    out->found /= fmax(runs - 1.0, 1.0) * (f->interval_count - f->first_timed);
    for (uint32_t i = f->first_timed; i < f->interval_count; i++) out->refused += isnan(out->ms[i]) ? 1 : 0;
    return status == CSCD_OK || io_fail(error, "%s: %s", f->name, cscd_status_string(status));
}

/* Returns the ratio of times over the intervals that both have. */
static double time_ratio(const frames *f, const task_result *a, const task_result *b) {
    double sums[2] = {0.0, 0.0};
    for (uint32_t i = f->first_timed; i < f->interval_count; i++) {
        if (isnan(a->ms[i]) || isnan(b->ms[i])) continue;
        sums[0] += a->ms[i];
        sums[1] += b->ms[i];
    }
    return sums[0] / sums[1];
}

/* ---- tables ------------------------------------------------------------------------------------------ */

/* Prints proximity and separation by length. */
static bool run_lengths(const frames *f, const task_result *plain, uint32_t repeats, json *out,
                        io_error *error) {
    static const double lengths[] = {0.01, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0};
    double triangles = cscd_mesh_triangle_count(f->mesh), found = 0.0;
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths && found < crowded * triangles; i++) {
        const task near = {.method = CSCD_METHOD_NONE, .distance = lengths[i], .act = act_near};
        const task apart = {.method = CSCD_METHOD_NONE, .separation = lengths[i], .act = act_step};
        task_result a, b;
        if (!measure_task(f, &near, repeats, &a, error) || !measure_task(f, &apart, repeats, &b, error))
            return false;
        found = a.found;
        double rows[4] = {time_ratio(f, &a, plain), a.found / triangles, time_ratio(f, &b, plain),
                          b.found / triangles};
        printf("  %-18s %6.2f %10.2f %12.3f %10.2f %12.3f\n", f->name, lengths[i], rows[0], rows[1], rows[2],
               rows[3]);
        fflush(stdout);
        if (out->file == NULL) continue;
        json_break_line(out);
        json_begin_object(out, NULL);
        json_string(out, "frames", f->name);
        json_number(out, "edges", lengths[i]);
        json_number(out, "near", rows[0]);
        json_number(out, "near_per_triangle", rows[1]);
        json_number(out, "separated_step", rows[2]);
        json_number(out, "separated_contacts_per_triangle", rows[3]);
        json_end_object(out);
    }
    return true;
}

typedef struct named_task {
    const char *name;
    task task;
} named_task;

static bool run_steps(const frames *f, const task_result *plain, uint32_t repeats, json *out,
                      io_error *error) {
    static const named_task tasks[] = {
        {"step, with the plan", {.method = CSCD_METHOD_AUTO, .act = act_step}},
        {"max_step, none", {.method = CSCD_METHOD_NONE, .act = act_max_step}},
        {"max_step, with the plan", {.method = CSCD_METHOD_AUTO, .act = act_max_step}},
        {"line_begin, reach 0", {.method = CSCD_METHOD_NONE, .act = act_begin}},
        {"line_max_step", {.method = CSCD_METHOD_NONE, .prepare = act_begin, .act = act_line_step}},
        {"line_begin, reach 1/4", {.method = CSCD_METHOD_NONE, .distance = 0.25, .act = act_begin}},
        {"line_near, 1/4",
         {.method = CSCD_METHOD_NONE, .distance = 0.25, .prepare = act_begin, .act = act_line_near}}};
    for (size_t i = 0; i < sizeof tasks / sizeof *tasks; i++) {
        task_result r;
        if (!measure_task(f, &tasks[i].task, repeats, &r, error)) return false;
        printf("  %-18s %-24s %8.2f %12.0f %8u\n", f->name, tasks[i].name, time_ratio(f, &r, plain), r.found,
               r.refused);
        fflush(stdout);
        if (out->file == NULL) continue;
        json_break_line(out);
        json_begin_object(out, NULL);
        json_string(out, "frames", f->name);
        json_string(out, "call", tasks[i].name);
        json_number(out, "steps", time_ratio(f, &r, plain));
        json_integer(out, "refused", r.refused);
        json_end_object(out);
    }
    return true;
}

static bool run_tables(const frames *f, const bench_options *o, json *out, io_error *error) {
    const task step = {.method = CSCD_METHOD_NONE, .act = act_step};
    uint32_t repeats = o->quick ? 2 : REPEATS, count = f->interval_count - f->first_timed;
    task_result plain;
    double sum = 0.0;
    if (!measure_task(f, &step, repeats, &plain, error)) return false;
    for (uint32_t i = f->first_timed; i < f->interval_count; i++) sum += plain.ms[i];
    printf("\n%s: %u triangles, %u interval%s; a plain step takes %.3f ms and finds %.0f contacts\n", f->name,
           cscd_mesh_triangle_count(f->mesh), count, count == 1 ? "" : "s", sum / count, plain.found);
    printf("  %-18s %6s %10s %12s %10s %12s\n", "", "edges", "near/step", "near/tri", "apart/step",
           "found/tri");
    if (!run_lengths(f, &plain, repeats, out, error)) return false;
    printf("  %-18s %-24s %8s %12s %8s\n", "", "call", "steps", "found", "refused");
    return run_steps(f, &plain, repeats, out, error);
}

/* ---- scenes ------------------------------------------------------------------------------------------ */

static double mean_edge(const cscd_mesh *mesh, const double *x) {
    double sum = 0.0;
    uint32_t count = cscd_mesh_edge_count(mesh);
    for (uint32_t e = 0; e < count; e++) {
        uint32_t v[2];
        cscd_mesh_edge(mesh, e, v);
        const double *p = x + (size_t)v[0] * 3, *q = x + (size_t)v[1] * 3;
        sum += sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                    (p[2] - q[2]) * (p[2] - q[2]));
    }
    return sum / count;
}

static bool run_recording(const char *name, const bench_options *o, json *out, io_error *error) {
    recording_data r;
    if (!recording_data_open(models, name, o->thread_count, &r, error)) return false;
    frames f = {.name = name, .mesh = r.mesh, .plan = r.charge};
    f.first_timed = 1;
    f.interval_count = 1 + (o->interval_count > 0 ? o->interval_count : o->quick ? 4 : INTERVALS);
    for (uint32_t i = 0; i <= f.interval_count; i++) f.ends[i] = recording_data_frame(&r, FIRST_FRAME + i);
    f.edge = mean_edge(f.mesh, f.ends[0]);
    bool good = run_tables(&f, o, out, error);
    recording_data_close(&r);
    return good;
}

static bool run_cloth(const char *name, int first, const bench_options *o, json *out, io_error *error) {
    deforming_body b;
    if (!bench_has_data(o, name)) return true;
    if (!deforming_body_read(o->data, name, first, &b, error)) return false;
    subject_options options = {CSCD_METHOD_NONE, CSCD_MODE_ALL, o->thread_count, o->simd, o->volume};
    subject *s = subject_make(&b, &options, error);
    if (s == NULL) {
        deforming_body_free(&b);
        return false;
    }
    const frames f = {name, s->mesh, NULL, mean_edge(s->mesh, b.rest), 0, 1, {b.rest, b.last}};
    bool good = run_tables(&f, o, out, error);
    subject_destroy(s);
    deforming_body_free(&b);
    return good;
}

static bool run_frames(const bench_options *o, json *out, io_error *error) {
    printf("%u thread%s; ratios to a plain step\n", o->thread_count, o->thread_count == 1 ? "" : "s");
    return run_recording("pawn-drop-free", o, out, error) &&
           run_recording("figure-balls-free", o, out, error) && run_recording("pawn-drop", o, out, error) &&
           run_cloth("cloth_funnel", 227, o, out, error) &&
           (o->quick || run_cloth("cloth_ball", 92, o, out, error));
}

int main(int argument_count, char **arguments) {
    static const bench_program program = {"proximity", help, NULL, 0, 0, run_frames};
    return bench_main(&program, argument_count, arguments);
}
