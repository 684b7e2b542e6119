/* Detectors under measurement: one method on one mesh, its stages interval by interval, its memory; and how fast
 * the machine is at the moment. */
#include "benchmarks/lib/stages.h"

#include "src/core/timer.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

const char *stage_name(int stage) {
    if (stage < TIMING_STAGES) return timing_rows[stage].label;
    return stage == STAGE_OTHER ? "other" : "total";
}

int stage_named(const char *name) {
    int stage = 0;
    while (strcmp(stage_name(stage), name) != 0) {
        stage++;
        assert(stage < STAGE_COUNT);
    }
    return stage;
}

static int compare_values(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double median(const double *values, uint32_t count) {
    double sorted[SAMPLES_MAX];
    if (count == 0) return 0.0;
    memcpy(sorted, values, count * sizeof *values);
    qsort(sorted, count, sizeof *sorted, compare_values);
    return 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
}

double stage_median(const stage_samples *s, int stage) {
    return median(s->ms[stage], s->count);
}

/* ---- memory ------------------------------------------------------------------------------------------ */

static void *count_allocate(void *user, size_t size, size_t alignment) {
    subject *s = user;
    void *block = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (block == NULL) return NULL;
    s->held += size;
    if (s->held > s->peak) s->peak = s->held;
    return block;
}

static void count_release(void *user, void *block, size_t size) {
    subject *s = user;
    s->held -= size;
    free(block);
}

/* ---- subjects ---------------------------------------------------------------------------------------- */

static cscd_status make_parts(const deforming_body *b, subject *s) {
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = s->options.thread_count;
    options.simd = s->options.simd;
    options.allocator = (cscd_allocator){count_allocate, count_release, s};
    cscd_status status = cscd_context_create(&options, &s->context);
    if (status != CSCD_OK) return status;
    const cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    status = cscd_mesh_create(s->context, &desc, 1, &s->mesh);
    size_t peak = s->peak;
    cscd_plan_options plan = cscd_plan_defaults();
    plan.method = s->options.method;
    if (status == CSCD_OK && (plan.method == CSCD_METHOD_CHARGE || plan.method == CSCD_METHOD_KMEANS))
        status = cscd_plan_create(s->context, s->mesh, CSCD_DOUBLES(b->rest, cscd_mesh_vertex_count(s->mesh)),
                                  &plan, &s->plan);
    s->peak = peak > s->held ? peak : s->held;
    cscd_detector_options detector = cscd_detector_defaults();
    detector.method = s->options.method;
    detector.mode = s->options.mode;
    detector.volume = s->options.volume;
    return status == CSCD_OK ? cscd_detector_create(s->context, s->mesh, s->plan, &detector, &s->detector)
                             : status;
}

static bool explain_status(const subject *s, cscd_status status, io_error *error) {
    const char *detail = s->context != NULL ? cscd_context_detail(s->context) : "";
    return io_fail(error, "method %s, mode %s: %s", cscd_method_name(s->options.method),
                   cscd_name(CSCD_MODES, s->options.mode),
                   detail[0] != '\0' ? detail : cscd_status_string(status));
}

subject *subject_make(const deforming_body *b, const subject_options *options, io_error *error) {
    subject *s = body_allocate(1, sizeof *s);
    s->options = *options;
    cscd_status status = make_parts(b, s);
    if (status == CSCD_OK) return s;
    explain_status(s, status, error);
    subject_destroy(s);
    return NULL;
}

void subject_destroy(subject *s) {
    if (s == NULL) return;
    cscd_detector_destroy(s->detector);
    cscd_plan_destroy(s->plan);
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
    free(s);
}

static void add_sample(stage_samples *s, const cscd_detector *detector, size_t contacts) {
    cscd_timings ms = cscd_detector_timings(detector);
    cscd_counters n = cscd_detector_counters(detector);
    if (s->count == SAMPLES_MAX) return;
    double known = 0.0;
    for (int i = 0; i < TIMING_STAGES; i++) {
        s->ms[i][s->count] = timing_ms(&ms, &timing_rows[i]);
        known += s->ms[i][s->count];
    }
    s->ms[STAGE_OTHER][s->count] = ms.total_ms - known;
    s->ms[STAGE_TOTAL][s->count] = ms.total_ms;
    s->count++;
    s->boxes += (double)n.boxes_tested;
    s->pcp += (double)n.pcp;
    s->features += (double)n.feature_pairs;
    s->tests += (double)n.tests;
    s->contacts += (double)contacts;
}

bool subject_step(subject *s, const double *start, const double *end, bool counts, cscd_contacts *found,
                  io_error *error) {
    cscd_status status = cscd_detector_step(s->detector, CSCD_DOUBLES(start, cscd_mesh_vertex_count(s->mesh)),
                                            CSCD_DOUBLES(end, cscd_mesh_vertex_count(s->mesh)), found);
    if (status != CSCD_OK) return explain_status(s, status, error);
    if (counts) add_sample(&s->samples, s->detector, found->count);
    return true;
}

/* ---- the machine --------------------------------------------------------------------------------------- */

enum { STEPS = 100000, CHAINS = 24 };

/* This many chains keep all units busy, so that the time also shows when another processor shares them.
 * With few chains it would wait for results and take the same time whatever the neighbour does. */
double fixed_arithmetic(void) {
    double x[CHAINS], sum = 0.0;
    for (int k = 0; k < CHAINS; k++) x[k] = k;
    for (int i = 0; i < STEPS; i++) {
        for (int k = 0; k < CHAINS; k++) x[k] = x[k] * 0.999 + 0.001;
    }
    for (int k = 0; k < CHAINS; k++) sum += x[k];
    return sum;
}

static volatile double result; /* keeps the compiler from dropping the loop */

double fixed_arithmetic_ms(void) {
    double since = timer_now_ms(), spent = 0.0;
    result = fixed_arithmetic();
    timer_lap(&since, &spent);
    return spent;
}
