/* The cost of new connectivity: a new mesh, plan and detector and the first step, compared with a steady
 * step. */
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/stages.h"
#include "src/core/timer.h"

#include <math.h>
#include <stdlib.h>

enum { REPEATS = 9, STEADY_STEPS = 4, INTERVAL_COUNT = STEADY_STEPS + 1 };

static const char help[] =
    "usage: topology [options]\n"
    "\n"
    "What a solver pays when triangles are torn, cut or remeshed: everything but the context is destroyed and\n"
    "made again. Milliseconds, each the least of some repetitions; in brackets steady steps, of the same row.\n"
    "Methods none and single need no plan; parts: four regions carried over by cscd_plan_create_from_parts;\n"
    "vouched: single, and no proof of the start. Its proof is a part of the first step, and where there is one\n"
    "it builds the trees. Mode all; the body deforms and never touches itself.\n"
    "--intervals: the repetitions (default 9, with --quick 5).\n"
    "\n";

/* The measured parts, in the order of their calls. */
typedef enum part {
    PART_MESH,
    PART_PLAN,
    PART_DETECTOR,
    PART_FIRST,
    PART_PROOF,
    PART_STEADY,
    PART_COUNT
} part;

static const char *const part_names[PART_COUNT] = {"mesh",       "plan",      "detector",
                                                   "first step", "its proof", "steady step"};

/* Regions and detector points of the plan of an earlier mesh, in the numbers of the new one. */
typedef struct carried_plan {
    uint32_t region_count, *regions;
    double *points;
} carried_plan;

typedef struct subject_set {
    const deforming_body *body;
    const carried_plan *carried; /* NULL: not carried over */
    cscd_method method;
    cscd_start start;
    double *ends[INTERVAL_COUNT][2];
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detector;
} subject_set;

/* ---- one repetition ---------------------------------------------------------------------------------- */

static cscd_status make_plan(subject_set *s) {
    if (s->method != CSCD_METHOD_KMEANS) return CSCD_OK;
    if (s->carried != NULL) {
        const cscd_plan_parts parts = {.method = CSCD_METHOD_KMEANS,
                                       .region_count = s->carried->region_count,
                                       .triangle_regions = s->carried->regions,
                                       .detector_points = s->carried->points};
        return cscd_plan_create_from_parts(s->context, s->mesh,
                                           CSCD_DOUBLES(s->body->rest, cscd_mesh_vertex_count(s->mesh)),
                                           &parts, &s->plan);
    }
    cscd_plan_options options = cscd_plan_defaults();
    options.method = s->method;
    return cscd_plan_create(s->context, s->mesh, CSCD_DOUBLES(s->body->rest, cscd_mesh_vertex_count(s->mesh)),
                            &options, &s->plan);
}

static cscd_status make_subjects(subject_set *s, double ms[PART_COUNT]) {
    const deforming_body *b = s->body;
    const cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    cscd_detector_options options = cscd_detector_defaults();
    options.method = s->method;
    options.start = s->start;
    double now = timer_now_ms();
    cscd_status status = cscd_mesh_create(s->context, &desc, 1, &s->mesh);
    timer_lap(&now, &ms[PART_MESH]);
    if (status == CSCD_OK) status = make_plan(s);
    timer_lap(&now, &ms[PART_PLAN]);
    if (status == CSCD_OK)
        status = cscd_detector_create(s->context, s->mesh, s->plan, &options, &s->detector);
    timer_lap(&now, &ms[PART_DETECTOR]);
    return status;
}

static void destroy_subjects(subject_set *s) {
    cscd_detector_destroy(s->detector);
    cscd_plan_destroy(s->plan);
    cscd_mesh_destroy(s->mesh);
    s->detector = NULL;
    s->plan = NULL;
    s->mesh = NULL;
}

static cscd_status step_interval(subject_set *s, uint32_t interval, double ms[PART_COUNT]) {
    cscd_contacts found;
    double now = timer_now_ms(), took = 0.0;
    cscd_status status =
        cscd_detector_step(s->detector, CSCD_DOUBLES(s->ends[interval][0], cscd_mesh_vertex_count(s->mesh)),
                           CSCD_DOUBLES(s->ends[interval][1], cscd_mesh_vertex_count(s->mesh)), &found);
    timer_lap(&now, &took);
    if (interval == 0) {
        ms[PART_FIRST] = took;
        ms[PART_PROOF] = cscd_detector_timings(s->detector).proof_ms;
    } else
        ms[PART_STEADY] = fmin(ms[PART_STEADY], took);
    return status;
}

/* Runs once and lowers least[] to the times of this run. */
static cscd_status repeat_once(subject_set *s, double least[PART_COUNT]) {
    double ms[PART_COUNT] = {[PART_STEADY] = HUGE_VAL};
    cscd_status status = make_subjects(s, ms);
    for (uint32_t i = 0; status == CSCD_OK && i < INTERVAL_COUNT; i++) status = step_interval(s, i, ms);
    destroy_subjects(s);
    for (int i = 0; i < PART_COUNT; i++) least[i] = fmin(least[i], ms[i]);
    return status;
}

/* ---- rows -------------------------------------------------------------------------------------------- */

static void print_row(const subject_set *s, const char *plan, const double ms[PART_COUNT]) {
    double change = ms[PART_MESH] + ms[PART_PLAN] + ms[PART_DETECTOR] + ms[PART_FIRST];
    printf("  %9u %-7s", s->body->triangle_count, plan);
    for (int i = 0; i < PART_COUNT; i++) {
        if (i == PART_STEADY)
            printf(" %12.3f", ms[i]);
        else
            printf(" %9.3f (%5.1f)", ms[i], ms[i] / ms[PART_STEADY]);
    }
    printf(" %9.1f\n", change / ms[PART_STEADY]);
    fflush(stdout);
}

static void write_row(json *out, const subject_set *s, const char *plan, const double ms[PART_COUNT]) {
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_integer(out, "triangles", s->body->triangle_count);
    json_string(out, "plan", plan);
    json_begin_object(out, "ms");
    for (int i = 0; i < PART_COUNT; i++) json_number(out, part_names[i], ms[i]);
    json_end_object(out);
    json_end_object(out);
}

static bool measure_set(subject_set *s, const bench_options *o, const char *plan, json *out,
                        io_error *error) {
    double least[PART_COUNT];
    uint32_t repeats = o->interval_count > 0 ? o->interval_count : o->quick ? 5 : REPEATS;
    cscd_status status = CSCD_OK;
    for (int i = 0; i < PART_COUNT; i++) least[i] = HUGE_VAL;
    for (uint32_t i = 0; status == CSCD_OK && i < repeats; i++) status = repeat_once(s, least);
    if (status != CSCD_OK) return io_fail(error, "%s: %s", plan, cscd_context_detail(s->context));
    print_row(s, plan, least);
    write_row(out, s, plan, least);
    return true;
}

/* ---- what is carried over ---------------------------------------------------------------------------- */

static bool find_regions(subject_set *s, carried_plan *out, io_error *error) {
    double unused[PART_COUNT];
    s->method = CSCD_METHOD_KMEANS;
    cscd_status status = make_subjects(s, unused);
    if (status != CSCD_OK) {
        destroy_subjects(s);
        return io_fail(error, "kmeans: %s", cscd_context_detail(s->context));
    }
    out->region_count = cscd_plan_region_count(s->plan);
    out->regions = body_allocate(s->body->triangle_count, sizeof *out->regions);
    out->points = body_allocate(out->region_count, sizeof(double[3]));
    for (uint32_t t = 0; t < s->body->triangle_count; t++)
        out->regions[t] = cscd_plan_triangle_region(s->plan, t);
    for (uint32_t r = 0; r < out->region_count; r++) {
        cscd_region region = cscd_plan_region(s->plan, r);
        for (uint32_t k = 0; k < 3; k++) out->points[3 * r + k] = region.detector_point[k];
    }
    destroy_subjects(s);
    return true;
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool run_rows(subject_set *s, const bench_options *o, json *out, io_error *error) {
    carried_plan kept = {0};
    s->method = CSCD_METHOD_NONE;
    bool good = measure_set(s, o, "none", out, error);
    s->method = CSCD_METHOD_SINGLE;
    good = good && measure_set(s, o, "single", out, error) && find_regions(s, &kept, error);
    s->carried = &kept;
    s->method = CSCD_METHOD_KMEANS;
    good = good && measure_set(s, o, "parts", out, error);
    s->carried = NULL;
    s->method = CSCD_METHOD_SINGLE;
    s->start = CSCD_START_VOUCHED;
    good = good && measure_set(s, o, "vouched", out, error);
    free(kept.regions);
    free(kept.points);
    return good;
}

static bool run_size(const bench_options *o, uint32_t size, json *out, io_error *error) {
    deforming_body b;
    if (!deforming_body_make(o->kind, size, DEFORM_WAVE, o->shuffled, &b, error)) return false;
    subject_set s = {.body = &b};
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = o->thread_count;
    options.simd = o->simd;
    double *ends = body_allocate((size_t)b.vertex_count * INTERVAL_COUNT, sizeof(double[6]));
    for (uint32_t i = 0; i < INTERVAL_COUNT; i++) {
        s.ends[i][0] = ends + (size_t)b.vertex_count * 6 * i;
        s.ends[i][1] = s.ends[i][0] + (size_t)b.vertex_count * 3;
        deforming_body_interval(&b, i, 0.0, s.ends[i][0], s.ends[i][1]);
    }
    cscd_status status = cscd_context_create(&options, &s.context);
    bool good = status == CSCD_OK ? run_rows(&s, o, out, error)
                                  : io_fail(error, "context: %s", cscd_status_string(status));
    cscd_context_destroy(s.context);
    free(ends);
    deforming_body_free(&b);
    return good;
}

static bool run_sizes(const bench_options *o, json *out, io_error *error) {
    printf("%s, %u thread%s, simd %s; ms, in brackets steady steps\n  %9s %-7s", body_kind_name(o->kind),
           o->thread_count, o->thread_count == 1 ? "" : "s", cscd_name(CSCD_SIMDS, o->simd), "triangles",
           "method");
    for (int i = 0; i < PART_COUNT; i++) printf(i == PART_STEADY ? " %12s" : " %17s", part_names[i]);
    printf(" %9s\n", "change");
    bool good = true;
    for (uint32_t i = 0; good && i < o->size_count; i++) good = run_size(o, o->sizes[i], out, error);
    if (good) printf("  change: mesh, plan, detector and first step together, in steady steps\n");
    return good;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {5000, 20000, 100000};
    static const bench_program program = {"topology", help, sizes, 3, 2, run_sizes};
    return bench_main(&program, argument_count, arguments);
}
