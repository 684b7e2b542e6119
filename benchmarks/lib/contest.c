/* The contacts of method none on a recording, and methods by turns on it, compared with these. */
#include "benchmarks/lib/contest.h"

#include "cscd/research.h"
#include "src/core/names.h"
#include "tool/common/methods.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* A time of impact may be early by less than this. */
static const double toi_early = 1e-9;

static bool explain_failure(const recording_data *r, const char *what, io_error *error) {
    return io_fail(error, "%s, %s: %s", r->name, what, cscd_context_detail(r->context));
}

static bool keep_contacts(truth *t, uint32_t interval, const cscd_contacts *found) {
    size_t count = t->offsets[interval], total = count + found->count;
    cscd_contact *grown = realloc(t->contacts, (total + 1) * sizeof *grown);
    if (grown == NULL) return false;
    if (found->count > 0) memcpy(grown + count, found->items, found->count * sizeof *grown);
    t->contacts = grown;
    t->offsets[interval + 1] = total;
    return true;
}

static bool all_proven(const cscd_detector *detector, const cscd_mesh *mesh) {
    for (uint32_t c = 0; c < cscd_mesh_component_count(mesh); c++) {
        if (!cscd_detector_guarantee(detector, c).start_embedded) return false;
    }
    return true;
}

static bool find_interval(truth *t, cscd_detector *none, cscd_detector *prover, uint32_t i, io_error *error) {
    const recording_data *r = t->recording;
    const double *start = recording_data_frame(r, i), *end = recording_data_frame(r, i + 1);
    cscd_contacts found;
    if (cscd_detector_step(prover, CSCD_DOUBLES(start, cscd_mesh_vertex_count(r->mesh)),
                           CSCD_DOUBLES(end, cscd_mesh_vertex_count(r->mesh)), &found) != CSCD_OK)
        return explain_failure(r, "single", error);
    t->proven[i] = all_proven(prover, r->mesh);
    t->proven_count += t->proven[i];
    if (cscd_detector_step(none, CSCD_DOUBLES(start, cscd_mesh_vertex_count(r->mesh)),
                           CSCD_DOUBLES(end, cscd_mesh_vertex_count(r->mesh)), &found) != CSCD_OK)
        return explain_failure(r, "none", error);
    return keep_contacts(t, i, &found) || io_fail(error, "%s: out of memory", r->name);
}

bool truth_find(const recording_data *r, truth *out, io_error *error) {
    uint32_t intervals = r->frame_count - 1;
    truth t = {.recording = r};
    cscd_detector *none = NULL, *prover = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    t.offsets = calloc((size_t)intervals + 1, sizeof *t.offsets);
    t.proven = calloc((size_t)intervals + 1, sizeof *t.proven);
    t.vertex_components = calloc(r->model.vertex_count, sizeof *t.vertex_components);
    bool good = t.offsets != NULL && t.proven != NULL && t.vertex_components != NULL;
    if (!good) io_fail(error, "%s: out of memory", r->name);
    for (uint32_t i = 0; good && i < r->model.triangle_count * 3; i++)
        t.vertex_components[r->model.triangles[i]] = cscd_mesh_triangle_component(r->mesh, i / 3);
    options.method = CSCD_METHOD_SINGLE;
    if (good && (cscd_detector_create(r->context, r->mesh, NULL, NULL, &none) != CSCD_OK ||
                 cscd_detector_create(r->context, r->mesh, NULL, &options, &prover) != CSCD_OK))
        good = explain_failure(r, "detectors", error);
    for (uint32_t i = 0; good && i < intervals; i++) good = find_interval(&t, none, prover, i, error);
    cscd_detector_destroy(none);
    cscd_detector_destroy(prover);
    if (good)
        *out = t;
    else
        truth_free(&t);
    return good;
}

void truth_free(truth *t) {
    free(t->vertex_components);
    free(t->contacts);
    free(t->offsets);
    free(t->proven);
    *t = (truth){.recording = NULL};
}

/* ---- comparison -------------------------------------------------------------------------------------- */

/* Returns the component of a contact of a component with itself, else UINT32_MAX. */
static uint32_t own_component(const truth *t, const cscd_contact *c) {
    uint32_t a[2] = {c->a, 0}, b[3] = {0, 0, 0};
    if (c->kind == CSCD_CONTACT_EE) {
        cscd_mesh_edge(t->recording->mesh, c->a, a);
        cscd_mesh_edge(t->recording->mesh, c->b, b);
    } else {
        cscd_mesh_triangle(t->recording->mesh, c->b, b);
    }
    uint32_t first = t->vertex_components[a[0]], second = t->vertex_components[b[0]];
    return first == second ? first : UINT32_MAX;
}

/* Returns when a component first touches itself, or INFINITY. Lists are sorted by time. */
static double first_time(const truth *t, const cscd_contact *items, size_t count, uint32_t component) {
    for (size_t i = 0; i < count; i++) {
        if (own_component(t, &items[i]) == component) return items[i].toi;
    }
    return INFINITY;
}

/* Whether two contacts are equal bit for bit, as they must be: every method computes a contact from the
 * same two features by the same code. */
static bool same_contact(const cscd_contact *a, const cscd_contact *b) {
    return a->kind == b->kind && a->a == b->a && a->b == b->b && a->bounded == b->bounded &&
           memcmp(&a->toi, &b->toi, sizeof a->toi) == 0 && memcmp(&a->u, &b->u, sizeof a->u) == 0 &&
           memcmp(&a->v, &b->v, sizeof a->v) == 0 && memcmp(a->point, b->point, sizeof a->point) == 0 &&
           memcmp(a->normal, b->normal, sizeof a->normal) == 0;
}

static int compare_features(const void *a, const void *b) {
    const cscd_contact *x = a, *y = b;
    if (x->kind != y->kind) return x->kind < y->kind ? -1 : 1;
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    return x->b < y->b ? -1 : x->b > y->b;
}

/* A copy of contacts in the order of their features; NULL: no memory. To be freed. */
static cscd_contact *by_features(const cscd_contact *items, size_t count) {
    cscd_contact *sorted = malloc((count + 1) * sizeof *sorted);
    if (sorted == NULL) return NULL;
    if (count > 0) memcpy(sorted, items, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, compare_features);
    return sorted;
}

/* Counts the contacts that a published method loses, and those that it invents: its elementary test rounds as it likes. */
static bool count_differences(const cscd_contact *expected, size_t count, const cscd_contacts *found,
                              contact_losses *s) {
    cscd_contact *wanted = by_features(expected, count), *given = by_features(found->items, found->count);
    size_t i = 0, j = 0, both = 0;
    const bool good = wanted != NULL && given != NULL;
    while (good && i < count && j < found->count) {
        const int order = compare_features(&wanted[i], &given[j]);
        both += order == 0;
        i += order <= 0;
        j += order >= 0;
    }
    s->lost += (double)(count - both);
    s->invented += (double)(found->count - both);
    free(wanted);
    free(given);
    return good;
}

/* Counts the components whose first contact is not reported in time. */
static uint32_t count_late(const truth *t, const cscd_contact *expected, size_t count,
                           const cscd_contacts *found) {
    uint32_t late = 0;
    for (uint32_t c = 0; c < cscd_mesh_component_count(t->recording->mesh); c++) {
        const double wanted = first_time(t, expected, count, c);
        late += !isinf(wanted) && first_time(t, found->items, found->count, c) > wanted + toi_early;
    }
    return late;
}

/* Counts the missing contacts; returns false when the lists differ in a way that is not allowed. No method
 * may report what method none does not. A published method may do anything, mode earliest what its
 * guarantee leaves out. */
bool truth_compare(const truth *t, uint32_t interval, const cscd_detector *detector, cscd_method method,
                   cscd_mode mode, const cscd_contacts *found, contact_losses *s) {
    const cscd_contact *expected = t->contacts + t->offsets[interval];
    size_t count = t->offsets[interval + 1] - t->offsets[interval], next = 0;
    bool kept = true;
    if (method_traits_of(method)->loses_contacts) {
        s->earliest_lost += count_late(t, expected, count, found);
        return count_differences(expected, count, found, s);
    }
    for (size_t i = 0; i < count; i++) {
        if (next < found->count && same_contact(&found->items[next], &expected[i])) {
            next++;
            continue;
        }
        uint32_t component = own_component(t, &expected[i]);
        s->lost += 1.0;
        kept = kept && mode == CSCD_MODE_EARLIEST && component != UINT32_MAX &&
               !cscd_detector_guarantee(detector, component).complete;
    }
    const uint32_t late = count > found->count ? count_late(t, expected, count, found) : 0;
    s->earliest_lost += late;
    return next == found->count && kept && late == 0;
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
