/* The gain of cuts at run time: steps with one region, with those of the charge, and with those for the
 * motion, side by side. */
#include "benchmarks/lib/made_scenes.h"
#include "benchmarks/lib/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: regions [options]\n"
    "\n"
    "Bodies with limbs by the methods single and charge: the regions, the share of the area that their points see at rest,\n"
    "the seconds that the plan takes, and nanoseconds per triangle and interval of a step. 'rest' moves nothing, and 'wave'\n"
    "bends the body by about an edge in an interval. Plans are made at rest (charge) and for the frames of the wave (motion).\n"
    "Methods take turns; the means over all intervals but the first three of the least time of each over the rounds, without\n"
    "and with lists of pairs (coherence). --intervals N are measured, 12 by default.\n"
    "--body NAME, another than pawn: that one alone, in place of figure, hand and octopus.\n"
    "\n";

enum { PLANS = 3, WAYS = 2 * PLANS, LEARNING = 3, INTERVALS = 12, LARGE = 500000 };

static const char *const plan_names[PLANS] = {"single", "charge", "motion"};

/* A body with its plans; the plan of single is NULL. */
typedef struct cut_body {
    deforming_body body;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plans[PLANS];
    double *ends[2];
} cut_body;

/* Logarithms of times of single over those of a plan, at the sizes. */
typedef struct gain_sums {
    double logs[SIZES_MAX][PLANS][2];
    uint32_t counts[SIZES_MAX];
} gain_sums;

/* ---- plans ----------------------------------------------------------------------------------------------- */

static cscd_status make_plans(cut_body *c) {
    enum { FRAMES = 8 };
    const uint32_t vertices = c->body.vertex_count;
    double *frames = body_allocate((size_t)FRAMES * vertices, sizeof(double[3]));
    cscd_view views[FRAMES];
    const cscd_view *items[FRAMES];
    cscd_plan_options options = cscd_plan_defaults();
    for (uint32_t f = 0; f < FRAMES; f++) {
        double *positions = frames + (size_t)f * vertices * 3;
        deforming_body_interval(&c->body, f * INTERVALS / FRAMES, 0.0, c->ends[0], positions);
        views[f] = cscd_view_doubles(positions, vertices);
        items[f] = &views[f];
    }
    cscd_status status =
        cscd_plan_create(c->context, c->mesh, CSCD_DOUBLES(c->body.rest, vertices), &options, &c->plans[1]);
    options.frames = items;
    options.frame_count = FRAMES;
    if (status == CSCD_OK)
        status = cscd_plan_create(c->context, c->mesh, CSCD_DOUBLES(c->body.rest, vertices), &options,
                                  &c->plans[2]);
    free(frames);
    return status;
}

static double seen_share(const cscd_plan *plan) {
    double seen = 0.0, area = 0.0;
    for (uint32_t r = 0; r < cscd_plan_region_count(plan); r++) {
        const cscd_region region = cscd_plan_region(plan, r);
        seen += region.visible_share * region.area;
        area += region.area;
    }
    return seen / area;
}

/* The share that the centroid of all sees. */
static cscd_status seen_by_one(const cut_body *c, double *out) {
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    options.method = CSCD_METHOD_SINGLE;
    const cscd_status status = cscd_plan_create(
        c->context, c->mesh, CSCD_DOUBLES(c->body.rest, c->body.vertex_count), &options, &plan);
    if (status == CSCD_OK) *out = seen_share(plan);
    cscd_plan_destroy(plan);
    return status;
}

/* ---- steps ----------------------------------------------------------------------------------------------- */

static cscd_status make_detectors(const cut_body *c, cscd_detector *detectors[WAYS]) {
    cscd_status status = CSCD_OK;
    for (int way = 0; status == CSCD_OK && way < WAYS; way++) {
        cscd_detector_options options = cscd_detector_defaults();
        options.method = way % PLANS == 0 ? CSCD_METHOD_SINGLE : CSCD_METHOD_CHARGE;
        options.coherence = way < PLANS ? CSCD_COHERENCE_OFF : CSCD_COHERENCE_AUTO;
        status = cscd_detector_create(c->context, c->mesh, c->plans[way % PLANS], &options, &detectors[way]);
    }
    return status;
}

static cscd_status run_round(cut_body *c, cscd_detector *detectors[WAYS], bool moves, uint32_t intervals,
                             double least[WAYS][INTERVALS_MAX]) {
    const uint32_t vertices = c->body.vertex_count;
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; status == CSCD_OK && i < intervals + LEARNING; i++) {
        deforming_body_interval(&c->body, moves ? i : 0, 0.0, c->ends[0], c->ends[1]);
        const double *end = c->ends[moves ? 1 : 0];
        for (int way = 0; status == CSCD_OK && way < WAYS; way++) {
            cscd_contacts found;
            status = cscd_detector_step(detectors[way], CSCD_DOUBLES(c->ends[0], vertices),
                                        CSCD_DOUBLES(end, vertices), &found);
            if (status != CSCD_OK || i < LEARNING) continue;
            double *time = &least[way][i - LEARNING];
            *time = fmin(*time, cscd_detector_timings(detectors[way]).total_ms);
        }
    }
    return status;
}

/* ns: per triangle and interval. */
static cscd_status time_steps(cut_body *c, bool moves, uint32_t intervals, double ns[WAYS]) {
    const int rounds = c->body.triangle_count < LARGE ? 5 : 3;
    double least[WAYS][INTERVALS_MAX];
    cscd_status status = CSCD_OK;
    for (int way = 0; way < WAYS; way++)
        for (uint32_t i = 0; i < intervals; i++) least[way][i] = HUGE_VAL;
    for (int round = 0; status == CSCD_OK && round < rounds; round++) {
        cscd_detector *detectors[WAYS] = {NULL};
        status = make_detectors(c, detectors);
        if (status == CSCD_OK) status = run_round(c, detectors, moves, intervals, least);
        for (int way = 0; way < WAYS; way++) cscd_detector_destroy(detectors[way]);
    }
    for (int way = 0; way < WAYS; way++) {
        ns[way] = 0.0;
        for (uint32_t i = 0; i < intervals; i++)
            ns[way] += 1e6 * least[way][i] / ((double)intervals * c->body.triangle_count);
    }
    return status;
}

/* ---- rows ------------------------------------------------------------------------------------------------ */

typedef struct region_row {
    const char *body;
    uint32_t triangles, regions;
    const char *plan;
    double seen, seconds, ns[2][2]; /* at rest and in the wave; without and with lists */
} region_row;

static void report_row(const region_row *r, json *out) {
    printf("  %-8s %9u %-7s %8u %7.1f %% %9.2f %9.2f %9.2f %9.2f %9.2f\n", r->body, r->triangles, r->plan,
           r->regions, 100.0 * r->seen, r->seconds, r->ns[0][0], r->ns[0][1], r->ns[1][0], r->ns[1][1]);
    fflush(stdout);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "body", r->body);
    json_integer(out, "triangles", r->triangles);
    json_string(out, "plan", r->plan);
    json_integer(out, "regions", r->regions);
    json_number(out, "seen", r->seen);
    json_number(out, "seconds", r->seconds);
    json_number(out, "rest_ns", r->ns[0][0]);
    json_number(out, "rest_lists_ns", r->ns[0][1]);
    json_number(out, "wave_ns", r->ns[1][0]);
    json_number(out, "wave_lists_ns", r->ns[1][1]);
    json_end_object(out);
}

static cscd_status report_body(cut_body *c, const char *name, uint32_t intervals, uint32_t size,
                               gain_sums *gains, json *out) {
    double ns[2][WAYS], seen = 0.0;
    cscd_status status = seen_by_one(c, &seen);
    for (int moves = 0; status == CSCD_OK && moves < 2; moves++)
        status = time_steps(c, moves, intervals, ns[moves]);
    for (int p = 0; status == CSCD_OK && p < PLANS; p++) {
        const cscd_plan *plan = c->plans[p];
        region_row row = {.body = name, .triangles = c->body.triangle_count, .plan = plan_names[p]};
        row.regions = plan != NULL ? cscd_plan_region_count(plan) : cscd_mesh_component_count(c->mesh);
        row.seen = plan != NULL ? seen_share(plan) : seen;
        row.seconds = plan != NULL ? cscd_plan_timings(plan).total_ms * 1e-3 : 0.0;
        for (int moves = 0; moves < 2; moves++)
            for (int lists = 0; lists < 2; lists++) row.ns[moves][lists] = ns[moves][lists * PLANS + p];
        for (int lists = 0; lists < 2; lists++)
            gains->logs[size][p][lists] += log(ns[1][lists * PLANS] / ns[1][lists * PLANS + p]);
        report_row(&row, out);
    }
    gains->counts[size]++;
    return status;
}

static bool measure_body(cscd_context *context, body_kind kind, uint32_t size, const bench_options *o,
                         gain_sums *gains, json *out, io_error *error) {
    const uint32_t intervals = o->interval_count > 0 ? o->interval_count : INTERVALS;
    cut_body c = {.context = context};
    if (!deforming_body_make(kind, o->sizes[size], DEFORM_WAVE, o->shuffled, &c.body, error)) return false;
    const cscd_object_desc object =
        cscd_object_of_triangles(c.body.vertex_count, c.body.triangle_count, c.body.triangles);
    for (int i = 0; i < 2; i++) c.ends[i] = body_allocate(c.body.vertex_count, sizeof(double[3]));
    cscd_status status = cscd_mesh_create(context, &object, 1, &c.mesh);
    if (status == CSCD_OK) status = make_plans(&c);
    if (status == CSCD_OK) status = report_body(&c, body_kind_name(kind), intervals, size, gains, out);
    for (int p = 0; p < PLANS; p++) cscd_plan_destroy(c.plans[p]);
    for (int i = 0; i < 2; i++) free(c.ends[i]);
    cscd_mesh_destroy(c.mesh);
    deforming_body_free(&c.body);
    return status == CSCD_OK || io_fail(error, "%s", cscd_context_detail(context));
}

static void print_gains(const bench_options *o, const gain_sums *gains) {
    printf("\nwave: how many times as fast as single, geometric means of the bodies\n");
    printf("  %9s %16s %16s %16s %16s\n", "triangles", "charge", "with lists", "motion", "with lists");
    for (uint32_t i = 0; i < o->size_count && gains->counts[i] > 0; i++) {
        printf("  %9u", o->sizes[i]);
        for (int p = 1; p < PLANS; p++)
            for (int lists = 0; lists < 2; lists++)
                printf(" %16.2f", exp(gains->logs[i][p][lists] / gains->counts[i]));
        printf("\n");
    }
}

static bool run_bodies(const bench_options *o, json *out, io_error *error) {
    static const body_kind kinds[] = {BODY_FIGURE, BODY_HAND, BODY_OCTOPUS};
    gain_sums gains = {0};
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = o->thread_count;
    options.simd = o->simd;
    if (cscd_context_create(&options, &context) != CSCD_OK) return io_fail(error, "out of memory");
    printf("  %-8s %9s %-7s %8s %9s %9s %9s %9s %9s %9s\n", "body", "triangles", "plan", "regions", "seen",
           "plan s", "rest ns", "and lists", "wave ns", "and lists");
    const bool alone = o->kind != BODY_PAWN;
    bool good = true;
    for (uint32_t i = 0; good && i < o->size_count; i++)
        for (size_t k = 0; good && k < (alone ? 1 : sizeof kinds / sizeof *kinds); k++)
            good = measure_body(context, alone ? o->kind : kinds[k], i, o, &gains, out, error);
    if (good) print_gains(o, &gains);
    cscd_context_destroy(context);
    return good;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {5000, 20000, 100000, 1000000};
    static const bench_program program = {"regions", help, sizes, 4, 1, run_bodies};
    return bench_main(&program, argument_count, arguments);
}
