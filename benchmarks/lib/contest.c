/* Methods on one recording, by turns, compared with the method that leaves out no pair. */
#include "benchmarks/lib/contest.h"

#include "cscd/research.h"
#include "tool/common/methods.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

static bool explain_failure(const recording_data *r, const char *what, io_error *error) {
    return io_fail(error, "%s, %s: %s", r->name, what, cscd_context_detail(r->context));
}

/* ---- runs -------------------------------------------------------------------------------------------- */

/* The least that an interval took in any round: milliseconds of processor time, and its stages in the same proportion. */
typedef struct interval_sample {
    cscd_timings ms;
} interval_sample;

/* One plan of an entrant. */
typedef struct contest_lane {
    const entrant *entrant;
    cscd_plan *plan; /* NULL: that of the recording, or none */
    interval_sample *samples;
    score classes[CLASS_COUNT]; /* counts and losses of the first round, times of the least */
} contest_lane;

static double processor_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static bool make_plan(const truth *t, const entrant *e, uint32_t run, contest_lane *lane, io_error *error) {
    const recording_data *r = t->recording;
    cscd_plan_options options = cscd_plan_defaults();
    if (e->plan != CSCD_METHOD_KMEANS && e->plan != CSCD_METHOD_PUBLISHED) return true;
    options.method = e->plan;
    options.ours = e->plan == CSCD_METHOD_PUBLISHED ? e->plan_ours : 0;
    if (e->threshold > 0.0) options.threshold = e->threshold;
    if (e->growing > 0.0) options.growing = e->growing;
    options.k = e->k;
    options.seed = 1 + run;
    const cscd_view *rest = CSCD_DOUBLES(r->model.positions, cscd_mesh_vertex_count(r->mesh));
    return cscd_plan_create(r->context, r->mesh, rest, &options, &lane->plan) == CSCD_OK ||
           explain_failure(r, e->name, error);
}

static bool make_detector(const truth *t, const contest_lane *lane, cscd_detector **out, io_error *error) {
    const recording_data *r = t->recording;
    const entrant *e = lane->entrant;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = e->method;
    options.mode = e->mode;
    options.volume = e->volume;
    options.ours = e->ours;
    const cscd_plan *plan = e->plan == CSCD_METHOD_CHARGE ? r->charge : lane->plan;
    return cscd_detector_create(r->context, r->mesh, plan, &options, out) == CSCD_OK ||
           explain_failure(r, e->name, error);
}

/* Keeps the stages of this round, if it was the quickest so far, so that they add up to the processor time. */
static void keep_quickest(interval_sample *sample, const cscd_detector *detector, double spent) {
    cscd_timings ms = cscd_detector_timings(detector);
    if (sample->ms.total_ms > 0.0 && sample->ms.total_ms <= spent) return;
    timings_divide(&ms, ms.total_ms > 0.0 ? ms.total_ms / spent : 1.0);
    ms.total_ms = spent;
    sample->ms = ms;
}

static void add_counts(score *s, const cscd_detector *detector, size_t contacts) {
    const cscd_counters n = cscd_detector_counters(detector);
    s->intervals++;
    s->pcp += (double)n.pcp;
    s->apart += (double)(n.pcp - n.adjacent);
    s->tests += (double)n.tests;
    s->contacts += (double)contacts;
}

static bool replay_once(const truth *t, contest_lane *lane, uint32_t round, io_error *error) {
    const recording_data *r = t->recording;
    const entrant *e = lane->entrant;
    const uint32_t vertices = cscd_mesh_vertex_count(r->mesh);
    cscd_detector *detector = NULL;
    bool good = make_detector(t, lane, &detector, error);
    for (uint32_t i = 0; good && i + 1 < r->frame_count; i++) {
        cscd_contacts found;
        score *s = &lane->classes[t->proven[i] ? CLASS_PROVEN : CLASS_OTHER];
        const double begin = processor_ms();
        const cscd_status status =
            cscd_detector_step(detector, CSCD_DOUBLES(recording_data_frame(r, i), vertices),
                               CSCD_DOUBLES(recording_data_frame(r, i + 1), vertices), &found);
        const double spent = processor_ms() - begin;
        if (status != CSCD_OK) {
            good = explain_failure(r, e->name, error);
            break;
        }
        keep_quickest(&lane->samples[i], detector, spent);
        if (round > 0) continue;
        add_counts(s, detector, found.count);
        if (!truth_compare(t, i, detector, e->method, e->mode, &found, &s->losses))
            good = io_fail(
                error, "%s, %s, interval %u: %zu contacts, method none has %zu: this breaks the guarantee",
                r->name, e->name, i, found.count, t->offsets[i + 1] - t->offsets[i]);
    }
    cscd_detector_destroy(detector);
    return good;
}

/* ---- results ----------------------------------------------------------------------------------------- */

/* The first interval builds the trees, which the thesis does beforehand, so it is not timed. */
static void sum_times(const truth *t, contest_lane *lane) {
    cscd_timings most = {0};
    for (uint32_t i = 1; i + 1 < t->recording->frame_count; i++) {
        score *s = &lane->classes[t->proven[i] ? CLASS_PROVEN : CLASS_OTHER];
        s->timed++;
        timings_add(&s->ms, &most, &lane->samples[i].ms);
    }
}

static void add_score(score *sum, const score *s) {
    cscd_timings most = {0};
    sum->intervals += s->intervals;
    sum->timed += s->timed;
    timings_add(&sum->ms, &most, &s->ms);
    sum->pcp += s->pcp;
    sum->apart += s->apart;
    sum->tests += s->tests;
    sum->contacts += s->contacts;
    sum->losses.lost += s->losses.lost;
    sum->losses.earliest_lost += s->losses.earliest_lost;
    sum->losses.invented += s->losses.invented;
}

score score_mean(const score classes[CLASS_COUNT], int only) {
    score sum = {.intervals = 0};
    for (int i = 0; i < CLASS_COUNT; i++)
        if (only == CLASS_COUNT || i == only) add_score(&sum, &classes[i]);
    const double n = sum.intervals > 0 ? sum.intervals : 1.0;
    timings_divide(&sum.ms, sum.timed > 0 ? sum.timed : 1.0);
    sum.pcp /= n;
    sum.apart /= n;
    sum.tests /= n;
    sum.contacts /= n;
    return sum;
}

static void take_lane(contest_result *result, const truth *t, const contest_lane *lane, uint32_t runs) {
    const score mean = score_mean(lane->classes, CLASS_COUNT);
    const cscd_plan *plan = lane->entrant->plan == CSCD_METHOD_CHARGE ? t->recording->charge : lane->plan;
    for (int i = 0; i < CLASS_COUNT; i++) {
        score part = lane->classes[i];
        part.losses.lost /= runs;
        part.losses.earliest_lost /= runs;
        part.losses.invented /= runs;
        add_score(&result->classes[i], &part);
    }
    result->least_ms = fmin(result->least_ms, mean.ms.total_ms);
    result->most_ms = fmax(result->most_ms, mean.ms.total_ms);
    result->least_apart = fmin(result->least_apart, mean.apart);
    result->most_apart = fmax(result->most_apart, mean.apart);
    if (plan != NULL) result->regions = cscd_plan_region_count(plan);
}

typedef struct contest_rounds {
    const truth *truth;
    contest_lane *lanes;
    uint32_t count, capacity;
} contest_rounds;

static bool open_lanes(contest_rounds *c, const entrant *e, io_error *error) {
    const uint32_t runs = e->runs > 0 ? e->runs : 1;
    for (uint32_t run = 0; run < runs; run++) {
        contest_lane *lane = &c->lanes[c->count++];
        lane->entrant = e;
        lane->samples = calloc(c->truth->recording->frame_count, sizeof *lane->samples);
        if (lane->samples == NULL) return io_fail(error, "out of memory");
        if (!make_plan(c->truth, e, run, lane, error)) return false;
    }
    return true;
}

static bool run_rounds(contest_rounds *c, uint32_t rounds, io_error *error) {
    bool good = true;
    for (uint32_t round = 0; good && round < rounds; round++)
        for (uint32_t i = 0; good && i < c->count; i++)
            good = replay_once(c->truth, &c->lanes[i], round, error);
    return good;
}

bool contest_run(const truth *t, const entrant *entrants, uint32_t count, uint32_t rounds,
                 contest_result *out, io_error *error) {
    contest_rounds c = {.truth = t};
    for (uint32_t i = 0; i < count; i++) c.capacity += entrants[i].runs > 0 ? entrants[i].runs : 1;
    c.lanes = calloc(c.capacity + 1, sizeof *c.lanes);
    bool good = c.lanes != NULL || io_fail(error, "out of memory");
    for (uint32_t i = 0; good && i < count; i++) good = open_lanes(&c, &entrants[i], error);
    good = good && run_rounds(&c, rounds, error);
    for (uint32_t i = 0; good && i < count; i++)
        out[i] = (contest_result){.entrant = entrants[i], .least_ms = INFINITY, .least_apart = INFINITY};
    for (uint32_t i = 0; good && i < c.count; i++) {
        contest_lane *lane = &c.lanes[i];
        sum_times(t, lane);
        take_lane(&out[lane->entrant - entrants], t, lane, lane->entrant->runs > 0 ? lane->entrant->runs : 1);
    }
    for (uint32_t i = 0; c.lanes != NULL && i < c.count; i++) {
        cscd_plan_destroy(c.lanes[i].plan);
        free(c.lanes[i].samples);
    }
    free(c.lanes);
    return good;
}
