/* Untangles random tangles, and judges each result by whole numbers and by the promises of cscd/untangle.h; prints what was clean,
 * by class, and the seeds of tangles of which a promise was broken. Usage: fuzz_untangle SECONDS TANGLES SEED, 0 for no limit. The
 * tangles have the seeds SEED, SEED + 1 and so on, so `fuzz_untangle 0 1 SEED` repeats one. */
#include "tests/support/untangle/random_tangle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { THREADS = 3, FRAMES = 2, WORDS = 200 };

/* A tangle that takes longer than this, in seconds, is told. */
static const double long_time = 5.0;

typedef struct class_totals {
    unsigned long tangles, calls, tangled, cleaned, fewer, given, refused, stopped;
} class_totals;

typedef struct call_answer {
    cscd_status status;
    cscd_untangled found;
    double x[TANGLE_VERTICES * 3]; /* as stored */
    char detail[WORDS];
} call_answer;

typedef struct tangle_fuzzer {
    random_tangle tangle;
    whole_oracle oracle;
    cscd_context *contexts[THREADS];
    cscd_mesh *meshes[THREADS];
    cscd_detector *detectors[THREADS];
    double start[TANGLE_VERTICES * 3], start_input[TANGLE_VERTICES * 3];
    bool has_start, has_start_input;
    double steady;
    size_t before; /* pairs in the positions */
    call_answer answer, other;
    long reports, cancel_at; /* 0: never */
    uint64_t seed;
    unsigned long broken;
    class_totals totals[TANGLE_CLASSES];
} tangle_fuzzer;

static tangle_fuzzer fuzzer; /* large */

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void say_broken(tangle_fuzzer *f, const char *what) {
    f->broken++;
    printf("seed %llu (%s): %s\n", (unsigned long long)f->seed, random_tangle_name(f->tangle.of), what);
    fflush(stdout);
}

static void expect_promise(tangle_fuzzer *f, bool holds, const char *what) {
    if (!holds) say_broken(f, what);
}

/* ---- calls --------------------------------------------------------------------------------------------- */

/* Positions as they are stored: floats or doubles, per object. */
typedef struct stored_positions {
    float floats[TANGLE_VERTICES * 3];
    double doubles[TANGLE_VERTICES * 3];
    cscd_view views[TANGLE_OBJECTS];
    cscd_mutable_view targets[TANGLE_OBJECTS];
} stored_positions;

static void store_positions(const random_tangle *t, const double *x, stored_positions *out) {
    for (size_t k = 0; k < 3 * (size_t)t->vertex_count; k++) {
        out->doubles[k] = x[k];
        out->floats[k] = fabs(x[k]) > 1e38 ? 0.0F : (float)x[k];
    }
    for (uint32_t o = 0; o < t->object_count; o++) {
        const size_t first = 3 * (size_t)t->first_vertex[o], n = t->first_vertex[o + 1] - t->first_vertex[o];
        out->views[o] = t->is_float[o] ? cscd_view_floats(out->floats + first, n)
                                       : cscd_view_doubles(out->doubles + first, n);
        out->targets[o] = t->is_float[o] ? cscd_mutable_view_floats(out->floats + first, n)
                                         : cscd_mutable_view_doubles(out->doubles + first, n);
        out->views[o].object_count = out->targets[o].object_count = 1;
    }
}

static void read_positions(const random_tangle *t, const stored_positions *stored, double *x) {
    for (uint32_t o = 0; o < t->object_count; o++) {
        for (size_t k = 3 * (size_t)t->first_vertex[o]; k < 3 * (size_t)t->first_vertex[o + 1]; k++)
            x[k] = t->is_float[o] ? (double)stored->floats[k] : stored->doubles[k];
    }
}

static void call_untangle(tangle_fuzzer *f, int context, double max_seconds, call_answer *out) {
    static stored_positions given, reached, start, start_input;
    const random_tangle *t = &f->tangle;
    cscd_untangle_options options = cscd_untangle_defaults();
    memset(out, 0, sizeof *out);
    store_positions(t, t->x, &given);
    memset(&reached, 0, sizeof reached);
    store_positions(t, reached.doubles, &reached);
    options.max_rounds = t->max_rounds;
    options.max_steps = t->max_steps;
    options.spread = t->spread;
    options.steady = f->steady;
    options.max_seconds = max_seconds;
    if (t->has_weights) options.weights = t->weights;
    if (f->has_start) {
        store_positions(t, f->start, &start);
        options.start = start.views;
    }
    if (f->has_start && f->has_start_input) {
        store_positions(t, f->start_input, &start_input);
        options.start_input = start_input.views;
    }
    stored_positions *to = t->in_place ? &given : &reached;
    out->status =
        cscd_detector_untangle(f->detectors[context], given.views, &options, to->targets, &out->found);
    read_positions(t, to, out->x);
    snprintf(out->detail, sizeof out->detail, "%s", cscd_context_detail(f->contexts[context]));
}

/* ---- promises ------------------------------------------------------------------------------------------ */

static bool same_place(const double *x, const uint32_t pair[2]) {
    return memcmp(x + 3 * (size_t)pair[0], x + 3 * (size_t)pair[1], sizeof(double[3])) == 0;
}

static void judge_vertices(tangle_fuzzer *f, const call_answer *a) {
    const random_tangle *t = &f->tangle;
    uint32_t moved = 0;
    bool finite = true, pins = true, seams = true;
    for (uint32_t v = 0; v < t->vertex_count; v++) {
        const size_t at = 3 * (size_t)v;
        const bool moves = memcmp(a->x + at, t->x + at, sizeof(double[3])) != 0;
        moved += moves;
        pins &= !moves || !random_tangle_held(t, v);
        for (size_t k = at; k < at + 3; k++) finite &= isfinite(a->x[k]);
    }
    for (size_t i = 0; i < t->seam_count; i++) {
        if (!same_place(t->x, t->seams[i]) || (f->has_start && !same_place(f->start, t->seams[i]))) continue;
        for (size_t k = 0; k < 3; k++)
            seams &= a->x[3 * (size_t)t->seams[i][0] + k] == a->x[3 * (size_t)t->seams[i][1] + k];
    }
    expect_promise(f, finite, "a coordinate of the result is not finite");
    expect_promise(f, pins, "a pinned vertex has moved");
    expect_promise(f, seams, "the vertices of a seam have parted");
    expect_promise(f, a->found.moved == (moved > 0) && a->found.moved_vertices == moved, "moved is wrong");
    expect_promise(f,
                   a->found.displacement >= 0.0 && isfinite(a->found.displacement) &&
                       (moved > 0) == (a->found.farthest != UINT32_MAX),
                   "the displacement is wrong");
}

/* Is the start one from which the result is always clean? It is, since it is a result that was clean, but for pins that have moved. */
static bool start_must_do(const tangle_fuzzer *f) {
    const random_tangle *t = &f->tangle;
    for (uint32_t v = 0; f->has_start && v < t->vertex_count; v++) {
        if (random_tangle_held(t, v) &&
            memcmp(f->start + 3 * (size_t)v, t->x + 3 * (size_t)v, sizeof(double[3])) != 0)
            return false;
    }
    return f->has_start;
}

/* whole: neither cancelled nor out of time. */
static void judge_result(tangle_fuzzer *f, const call_answer *a, bool whole) {
    const random_tangle *t = &f->tangle;
    const cscd_untangled *found = &a->found;
    const size_t after = random_tangle_pairs(t, &f->oracle, a->x);
    const bool same = memcmp(a->x, t->x, 3 * (size_t)t->vertex_count * sizeof *a->x) == 0;
    expect_promise(f, found->pairs_before == f->before, "pairs_before is not what whole numbers say");
    expect_promise(f, found->pairs_after == after, "pairs_after is not what whole numbers say");
    expect_promise(
        f, same || after < f->before || (after == f->before && found->near_after < found->near_before),
        "the result is worse");
    expect_promise(f, found->clean == (after == 0 && found->near_after == 0), "clean is wrong");
    expect_promise(f, !found->clean || !random_tangle_too_near(t, a->x), "clean, and pairs are too near");
    expect_promise(
        f, !same || (found->start == CSCD_UNTANGLE_NO_START && found->near_after == found->near_before),
        "nothing moved, and something has changed");
    expect_promise(f, !whole || !found->stopped, "stopped by nobody");
    expect_promise(f, !whole || found->clean || !start_must_do(f), "a clean start, and no clean result");
    judge_vertices(f, a);
}

static bool same_answers(const random_tangle *t, const call_answer *a, const call_answer *b) {
    if (a->status != b->status) return false;
    return a->status != CSCD_OK || (memcmp(&a->found, &b->found, sizeof a->found) == 0 &&
                                    memcmp(a->x, b->x, 3 * (size_t)t->vertex_count * sizeof *a->x) == 0);
}

/* ---- one tangle ---------------------------------------------------------------------------------------- */

/* Is the result what stood there before, the input or zeros? */
static bool is_unwritten(const tangle_fuzzer *f, const call_answer *a) {
    for (size_t k = 0; k < 3 * (size_t)f->tangle.vertex_count; k++) {
        const double before = f->tangle.in_place ? f->tangle.x[k] : 0.0;
        if (memcmp(&a->x[k], &before, sizeof before) != 0) return false;
    }
    return true;
}

/* The host ends the call at a random report, or no time is left at a random moment. */
static void stop_somewhere(tangle_fuzzer *f, random_stream *random) {
    double max_seconds = (double)INFINITY;
    f->reports = 0;
    if (stream_below(random, 2) == 0)
        f->cancel_at = 1 + (long)stream_below(random, 12);
    else
        max_seconds = stream_below(random, 4) == 0 ? 0.0 : stream_between(random, 0.0, 0.01);
    call_untangle(f, 0, max_seconds, &f->other);
    f->cancel_at = 0;
    if (f->other.status == CSCD_OK) {
        judge_result(f, &f->other, false);
        f->totals[f->tangle.of].stopped += f->other.found.stopped;
    } else if (f->other.status == CSCD_CANCELLED) /* before the pairs were counted */
        expect_promise(f, is_unwritten(f, &f->other),
                       "a call that was cancelled at first has written something");
    else
        expect_promise(f, f->other.status == CSCD_INVALID_ARGUMENT, f->other.detail);
}

static bool can_be_refused(const tangle_fuzzer *f) {
    const random_tangle *t = &f->tangle;
    for (size_t k = 0; k < 3 * (size_t)t->vertex_count; k++) {
        const double x = fabs(t->x[k]);
        if (x != 0.0 && !(x >= 0x1p-300 && x <= 0x1p300)) return true;
    }
    return false;
}

/* Returns whether a frame after may follow. */
static bool run_frame(tangle_fuzzer *f, random_stream *random) {
    random_tangle *t = &f->tangle;
    class_totals *sum = &f->totals[t->of];
    if (!can_be_refused(f)) f->before = random_tangle_pairs(t, &f->oracle, t->x);
    if (stream_below(random, 5) == 0) stop_somewhere(f, random);
    call_untangle(f, 0, (double)INFINITY, &f->answer);
    call_untangle(f, 1 + (int)stream_below(random, THREADS - 1), (double)INFINITY, &f->other);
    expect_promise(f, same_answers(t, &f->answer, &f->other), "other bits for another number of threads");
    sum->calls++;
    if (f->answer.status != CSCD_OK) {
        sum->refused++;
        if (!can_be_refused(f)) say_broken(f, f->answer.detail);
        return false;
    }
    judge_result(f, &f->answer, true);
    sum->tangled += f->answer.found.pairs_before > 0;
    sum->cleaned += f->answer.found.pairs_before > 0 && f->answer.found.clean;
    sum->fewer += !f->answer.found.clean && f->answer.found.moved;
    sum->given += f->answer.found.start == CSCD_UNTANGLE_GIVEN;
    return f->answer.found.clean;
}

static void run_frames(tangle_fuzzer *f, random_stream *random) {
    f->has_start = f->has_start_input = false;
    f->steady = 0.0;
    for (int frame = 0; frame < FRAMES && run_frame(f, random); frame++) {
        memcpy(f->start, f->answer.x, sizeof f->start);
        memcpy(f->start_input, f->tangle.x, sizeof f->start_input);
        f->has_start = true;
        f->has_start_input = stream_below(random, 2) == 0;
        f->steady = stream_below(random, 2) == 0 ? 0.0 : stream_between(random, 0.0, 0.99);
        random_tangle_move(&f->tangle, random);
    }
}

static void run_tangle(tangle_fuzzer *f, uint64_t seed) {
    random_stream random = stream_start(~seed);
    const double began = seconds_now();
    bool made = true;
    f->seed = seed;
    random_tangle_make(seed, &f->tangle);
    for (int i = 0; i < THREADS; i++) {
        f->meshes[i] = random_tangle_mesh(&f->tangle, f->contexts[i]);
        f->detectors[i] =
            f->meshes[i] != NULL ? random_tangle_detector(&f->tangle, f->meshes[i], f->contexts[i]) : NULL;
        made &= f->detectors[i] != NULL;
    }
    f->totals[f->tangle.of].tangles++;
    if (made)
        run_frames(f, &random);
    else
        say_broken(f, cscd_context_detail(f->contexts[0]));
    for (int i = 0; i < THREADS; i++) {
        cscd_detector_destroy(f->detectors[i]);
        cscd_mesh_destroy(f->meshes[i]);
    }
    const double took = seconds_now() - began;
    if (took > long_time)
        printf("seed %llu (%s) took %.1f seconds\n", (unsigned long long)seed,
               random_tangle_name(f->tangle.of), took);
}

/* ---- all of them --------------------------------------------------------------------------------------- */

static bool report_progress(void *user, const char *stage, double fraction) {
    tangle_fuzzer *f = user;
    (void)stage, (void)fraction;
    return ++f->reports != f->cancel_at;
}

static void print_totals(const tangle_fuzzer *f, uint64_t tangles) {
    printf("%-10s %8s %8s %8s %8s %8s %8s %8s %8s\n", "class", "tangles", "calls", "crossing", "clean",
           "fewer", "followed", "stopped", "refused");
    for (int i = 0; i < TANGLE_CLASSES; i++) {
        const class_totals *s = &f->totals[i];
        printf("%-10s %8lu %8lu %8lu %8lu %8lu %8lu %8lu %8lu\n", random_tangle_name((random_tangle_class)i),
               s->tangles, s->calls, s->tangled, s->cleaned, s->fewer, s->given, s->stopped, s->refused);
    }
    printf("%llu tangles, %lu broken promises\n", (unsigned long long)tangles, f->broken);
}

int main(int argument_count, char **arguments) {
    if (argument_count != 4) {
        fprintf(stderr, "usage: %s SECONDS TANGLES SEED\n", arguments[0]);
        return 2;
    }
    const double until = seconds_now() + strtod(arguments[1], NULL);
    const bool has_end = strtod(arguments[1], NULL) > 0.0;
    const uint64_t most = strtoull(arguments[2], NULL, 0), seed = strtoull(arguments[3], NULL, 0);
    uint64_t tangles = 0;
    for (int i = 0; i < THREADS; i++) {
        cscd_context_options host = cscd_context_defaults();
        host.thread_count = (uint32_t)i + 1;
        if (i == 0) host.progress = (cscd_progress){.user = &fuzzer, .report = report_progress};
        if (cscd_context_create(&host, &fuzzer.contexts[i]) != CSCD_OK) return 2;
    }
    whole_oracle_begin(&fuzzer.oracle);
    for (; (most == 0 || tangles < most) && (!has_end || seconds_now() < until); tangles++)
        run_tangle(&fuzzer, seed + tangles);
    whole_oracle_end(&fuzzer.oracle);
    for (int i = 0; i < THREADS; i++) cscd_context_destroy(fuzzer.contexts[i]);
    print_totals(&fuzzer, tangles);
    return fuzzer.broken > 0 ? 1 : 0;
}
