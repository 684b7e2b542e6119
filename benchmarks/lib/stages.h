/* Detectors under measurement: one method on one mesh, its stages interval by interval, its memory; and how fast
 * the machine is at the moment. */
#pragma once

#include "benchmarks/lib/made_scenes.h"
#include "cscd/cscd.h"
#include "tool/common/methods.h"

/* The columns of the tables: the stages of a step, in the order of timing_rows; then the part of the total that
 * belongs to no stage, such as checks of the input; then the total. */
enum { STAGE_OTHER = TIMING_STAGES, STAGE_TOTAL, STAGE_COUNT };

/* "update", "travers", ..., "other", "total". */
const char *stage_name(int stage);

/* Returns the column of that name, which must exist. */
int stage_named(const char *name);

enum { SAMPLES_MAX = 64 };

/* Counters are sums over the intervals. */
typedef struct stage_samples {
    uint32_t count;
    double ms[STAGE_COUNT][SAMPLES_MAX];
    double boxes, pcp, features, tests, contacts;
} stage_samples;

double stage_median(const stage_samples *s, int stage);
double median(const double *values, uint32_t count);

typedef struct subject_options {
    cscd_method method; /* CHARGE and KMEANS make their plan */
    cscd_mode mode;
    uint32_t thread_count;
    cscd_simd simd;
    cscd_volume volume;
} subject_options;

/* Must not move: the context has its address and counts bytes there. */
typedef struct subject {
    subject_options options;
    size_t held, peak; /* bytes of this context; the peak leaves out memory that only preprocessing used */
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detector;
    stage_samples samples;
} subject;

/* Returns NULL after a failure, which *error explains. */
subject *subject_make(const deforming_body *b, const subject_options *options, io_error *error);
void subject_destroy(subject *s);

/* Steps over one interval. It is a sample when `counts` is true; a first interval, which builds trees,
 * should not be. */
bool subject_step(subject *s, const double *start, const double *end, bool counts, cscd_contacts *found,
                  io_error *error);

/* ---- the machine --------------------------------------------------------------------------------------- */

/* Computes for a millisecond or two; use the result, or the loop is optimised away. */
double fixed_arithmetic(void);

/* Returns the milliseconds that it takes now. */
double fixed_arithmetic_ms(void);
