/* The gain of a second thread, compared with its gain on this machine for arithmetic that shares nothing. */
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/stages.h"
#include "cscd/research.h"
#include "src/core/timer.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { ROUNDS = 7 };

static const char help[] =
    "usage: threads [options]\n"
    "\n"
    "The same intervals on one thread and on two, in turn, and between them a fixed loop of multiplications\n"
    "and additions on one thread and on two at once, which is what the machine gives. All of it several\n"
    "times over, of which the least counts, interval by interval: other programs only ever cost time.\n"
    "Speedup: one thread's time over that of two. Efficiency: the speedup over the machine's own. --threads\n"
    "means nothing here.\n"
    "The second table is about machines with more processors: a step that is cut up for 2, 8 or 16 threads, run on\n"
    "one. Serial: the part of the step outside of parallel loops, in percent; loops: how many of these a step has; by:\n"
    "the speedup by so many processors if the loops divide evenly and cost nothing to start (Amdahl); KiB: what\n"
    "context, mesh and detector hold then, and with one thread.\n"
    "\n";

/* ---- the share of a step that no further thread takes over --------------------------------------------- */

/* Means per interval. */
typedef struct serial_share {
    double total_ms, loops_ms; /* loops: the time within parallel loops */
    double loops, tasks;       /* how many loops a step hands out, and their tasks */
    size_t held;               /* bytes of context, mesh and detector after the intervals */
} serial_share;

/* The host whose loop takes the time, and whose allocator counts. */
typedef struct loop_host {
    double ms;
    uint64_t loops, tasks;
    size_t held;
} loop_host;

static void run_in_turn(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index),
                        void *data) {
    loop_host *host = user;
    double since = timer_now_ms();
    for (uint32_t i = 0; i < task_count; i++) task(data, i);
    timer_lap(&since, &host->ms);
    host->loops++;
    host->tasks += task_count;
}

static void *count_block(void *user, size_t size, size_t alignment) {
    loop_host *host = user;
    void *block = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (block != NULL) host->held += size;
    return block;
}

static void free_block(void *user, void *block, size_t size) {
    loop_host *host = user;
    host->held -= size;
    free(block);
}

typedef struct lone_detector {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
} lone_detector;

static cscd_status open_detector(const deforming_body *b, cscd_method method, uint32_t thread_count,
                                 loop_host *host, lone_detector *out) {
    cscd_context_options options = cscd_context_defaults();
    cscd_detector_options detector = cscd_detector_defaults();
    const cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    options.thread_count = thread_count;
    options.parallel_for = (cscd_parallel_for){run_in_turn, host};
    options.allocator = (cscd_allocator){count_block, free_block, host};
    detector.method = method;
    cscd_status status = cscd_context_create(&options, &out->context);
    if (status == CSCD_OK) status = cscd_mesh_create(out->context, &desc, 1, &out->mesh);
    if (status == CSCD_OK)
        status = cscd_detector_create(out->context, out->mesh, NULL, &detector, &out->detector);
    return status;
}

static void close_detector(lone_detector *l) {
    cscd_detector_destroy(l->detector);
    cscd_mesh_destroy(l->mesh);
    cscd_context_destroy(l->context);
}

/* One round, in which the first interval does not count. Keeps the least total of each interval in `least`. */
static cscd_status run_round(const deforming_body *b, lone_detector *l, loop_host *host, uint32_t intervals,
                             double *ends, serial_share *least) {
    size_t size = (size_t)b->vertex_count * 3;
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; status == CSCD_OK && i <= intervals; i++) {
        cscd_contacts found;
        deforming_body_interval(b, i, 0.0, ends, ends + size);
        host->ms = 0.0;
        host->loops = host->tasks = 0;
        double since = timer_now_ms();
        status = cscd_detector_step(l->detector, CSCD_DOUBLES(ends, b->vertex_count),
                                    CSCD_DOUBLES(ends + size, b->vertex_count), &found);
        double total = timer_now_ms() - since;
        if (least[i].total_ms == 0.0 || total < least[i].total_ms)
            least[i] = (serial_share){total, host->ms, (double)host->loops, (double)host->tasks, 0};
    }
    return status;
}

/* Steps through the intervals on one thread, cut up for `thread_count` threads: a host's loop runs the tasks one after the other and
 * takes the time. So other programs on the machine disturb both times alike. The step with the least total of `rounds` counts. */
static bool serial_share_measure(const deforming_body *b, cscd_method method, uint32_t thread_count,
                                 uint32_t intervals, uint32_t rounds, serial_share *out, io_error *error) {
    loop_host host = {0.0, 0, 0, 0};
    lone_detector l = {NULL, NULL, NULL};
    double *ends = body_allocate((size_t)b->vertex_count * 6, sizeof *ends);
    serial_share *least = body_allocate((size_t)intervals + 1, sizeof *least);
    cscd_status status = open_detector(b, method, thread_count, &host, &l);
    for (uint32_t i = 0; status == CSCD_OK && i < rounds; i++)
        status = run_round(b, &l, &host, intervals, ends, least);
    *out = (serial_share){.held = host.held};
    for (uint32_t i = 1; i <= intervals; i++) {
        out->total_ms += least[i].total_ms / intervals;
        out->loops_ms += least[i].loops_ms / intervals;
        out->loops += least[i].loops / intervals;
        out->tasks += least[i].tasks / intervals;
    }
    close_detector(&l);
    free(least);
    free(ends);
    return status == CSCD_OK || io_fail(error, "%s", cscd_status_string(status));
}

/* Returns the speedup by that many processors if loops divide evenly and cost nothing to start (Amdahl's law). */
static double serial_share_speedup(const serial_share *s, double processors) {
    return s->total_ms / (s->total_ms - s->loops_ms + s->loops_ms / processors);
}

/* ---- the machine's own factor ------------------------------------------------------------------------ */

static atomic_uint waiting;

typedef struct loop_worker {
    double begin, end, result;
} loop_worker;

/* Runs the loop as soon as all workers have arrived. */
static void *run_worker(void *data) {
    loop_worker *w = data;
    atomic_fetch_sub(&waiting, 1);
    while (atomic_load(&waiting) > 0) {
    }
    w->begin = timer_now_ms();
    w->result = fixed_arithmetic();
    w->end = timer_now_ms();
    return NULL;
}

static double lesser_time(double a, double b) {
    return a > 0.0 && a < b ? a : b;
}

/* Times of the loop: the least on one thread, and of two loops on two threads until both are done; 0: none
 * yet. */
typedef struct loop_times {
    double one, two;
} loop_times;

static void time_loops(loop_times *least) {
    loop_worker w[3] = {{0.0, 0.0, 0.0}};
    pthread_t other;
    atomic_store(&waiting, 1);
    run_worker(&w[0]);
    atomic_store(&waiting, 2);
    if (pthread_create(&other, NULL, run_worker, &w[1]) != 0) exit(1);
    run_worker(&w[2]);
    pthread_join(other, NULL);
    double begin = w[1].begin < w[2].begin ? w[1].begin : w[2].begin;
    double end = w[1].end > w[2].end ? w[1].end : w[2].end;
    least->one = lesser_time(least->one, w[0].end - w[0].begin);
    least->two = lesser_time(least->two, end - begin);
}

/* ---- measuring --------------------------------------------------------------------------------------- */

typedef struct duel {
    subject *subjects[2];                            /* on one thread and on two */
    double least[2][STAGE_COUNT][INTERVALS_MAX + 1]; /* per interval; 0: none yet */
    uint32_t intervals;
    loop_times loops;
} duel;

/* Runs one interval; the first of a round only moves the subjects to its end. */
static bool run_interval(const deforming_body *b, duel *d, uint32_t i, double *ends, io_error *error) {
    size_t size = (size_t)b->vertex_count * 3;
    bool good = true;
    deforming_body_interval(b, i, 0.0, ends, ends + size);
    for (uint32_t k = 0; good && k < 2; k++) {
        uint32_t which = (k + i) % 2;
        stage_samples *samples = &d->subjects[which]->samples;
        cscd_contacts found;
        good = subject_step(d->subjects[which], ends, ends + size, i > 0, &found, error);
        for (int j = 0; good && i > 0 && j < STAGE_COUNT; j++)
            d->least[which][j][i] = lesser_time(d->least[which][j][i], samples->ms[j][0]);
        samples->count = 0;
    }
    if (i > 0) time_loops(&d->loops);
    return good;
}

static double mean_time(const duel *d, int which, int stage) {
    double sum = 0.0;
    for (uint32_t i = 1; i <= d->intervals; i++) sum += d->least[which][stage][i];
    return sum / d->intervals;
}

static void print_row(const deforming_body *b, const subject_options *options, const duel *d, json *out) {
    double machine = 2.0 * d->loops.one / d->loops.two;
    double speedup = mean_time(d, 0, STAGE_TOTAL) / mean_time(d, 1, STAGE_TOTAL);
    printf("  %9u %-7s", b->triangle_count, cscd_method_name(options->method));
    for (int i = 0; i < STAGE_COUNT; i++) {
        double ms = mean_time(d, 0, i);
        if (i == stage_named("proof")) continue;
        if (ms >= 0.001)
            printf(" %8.2f", ms / mean_time(d, 1, i));
        else
            printf(" %8s", "-");
    }
    printf(" %9.3f %9.3f %8.2f %10.2f\n", mean_time(d, 0, STAGE_TOTAL), mean_time(d, 1, STAGE_TOTAL), machine,
           speedup / machine);
    fflush(stdout);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_integer(out, "triangles", b->triangle_count);
    json_string(out, "method", cscd_method_name(options->method));
    for (int k = 0; k < 2; k++) {
        json_begin_object(out, k == 0 ? "one_ms" : "two_ms");
        for (int i = 0; i < STAGE_COUNT; i++) json_number(out, stage_name(i), mean_time(d, k, i));
        json_end_object(out);
    }
    json_number(out, "machine", machine);
    json_number(out, "efficiency", speedup / machine);
    json_end_object(out);
}

static bool run_method(const deforming_body *b, const bench_options *o, cscd_method method, json *out,
                       io_error *error) {
    duel d = {.intervals = bench_intervals(o, b->triangle_count)};
    subject_options options[2] = {{method, CSCD_MODE_ALL, 1, o->simd, o->volume},
                                  {method, CSCD_MODE_ALL, 2, o->simd, o->volume}};
    double *ends = body_allocate((size_t)b->vertex_count * 6, sizeof *ends);
    bool good = true;
    for (int k = 0; good && k < 2; k++) {
        d.subjects[k] = subject_make(b, &options[k], error);
        good = d.subjects[k] != NULL;
    }
    uint32_t count = d.intervals + 1, rounds = o->quick ? 3 : ROUNDS;
    for (uint32_t i = 0; good && i < rounds * count; i++) good = run_interval(b, &d, i % count, ends, error);
    if (good) print_row(b, &options[0], &d, out);
    subject_destroy(d.subjects[0]);
    subject_destroy(d.subjects[1]);
    free(ends);
    return good;
}

/* ---- more threads than processors ---------------------------------------------------------------------- */

static bool print_serial_share(const deforming_body *b, const bench_options *o, cscd_method method, json *out,
                               io_error *error) {
    enum { COUNTS = 4 };
    static const uint32_t counts[COUNTS] = {1, 2, 8, 16};
    serial_share shares[COUNTS];
    for (int k = 0; k < COUNTS; k++) {
        if (!serial_share_measure(b, method, counts[k], bench_intervals(o, b->triangle_count),
                                  o->quick ? 3 : ROUNDS, &shares[k], error))
            return false;
    }
    printf("  %9u %-7s", b->triangle_count, cscd_method_name(method));
    for (int k = 1; k < COUNTS; k++)
        printf(" %8.1f %5.1f %6.2f", 100.0 * (1.0 - shares[k].loops_ms / shares[k].total_ms), shares[k].loops,
               serial_share_speedup(&shares[k], counts[k]));
    for (int k = 0; k < COUNTS; k++) printf(" %7.0f", (double)shares[k].held / 1024.0);
    puts("");
    fflush(stdout);
    if (out->file == NULL) return true;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_integer(out, "triangles", b->triangle_count);
    json_string(out, "method", cscd_method_name(method));
    json_begin_array(out, "cut_up");
    for (int k = 0; k < COUNTS; k++) {
        json_begin_object(out, NULL);
        json_integer(out, "threads", counts[k]);
        json_number(out, "total_ms", shares[k].total_ms);
        json_number(out, "loops_ms", shares[k].loops_ms);
        json_number(out, "loops", shares[k].loops);
        json_number(out, "tasks", shares[k].tasks);
        json_integer(out, "held", shares[k].held);
        json_end_object(out);
    }
    json_end_array(out);
    json_end_object(out);
    return true;
}

static bool run_serial_shares(const bench_options *o, json *out, io_error *error) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE};
    bool good = true;
    printf("\ncut up for 2, 8 and 16 threads, run on one\n  %9s %-7s", "triangles", "method");
    for (int k = 0; k < 3; k++)
        printf(" %8s %5s %6s", "serial %", "loops", k == 0 ? "by 2" : k == 1 ? "by 8" : "by 16");
    printf(" %7s %7s %7s %7s\n", "KiB, 1", "2", "8", "16");
    for (uint32_t i = 0; good && i < o->size_count; i++) {
        deforming_body b;
        if (!deforming_body_make(o->kind, o->sizes[i], DEFORM_WAVE, o->shuffled, &b, error)) return false;
        for (int k = 0; good && k < 2; k++) good = print_serial_share(&b, o, methods[k], out, error);
        deforming_body_free(&b);
    }
    return good;
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool run_duels(const bench_options *o, json *out, io_error *error) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_ICCD, CSCD_METHOD_SINGLE};
    printf("%s, mode all, simd %s; speedup by a second thread\n  %9s %-7s", body_kind_name(o->kind),
           cscd_name(CSCD_SIMDS, o->simd), "triangles", "method");
    for (int i = 0; i < STAGE_COUNT; i++) {
        if (i != stage_named("proof")) printf(" %8s", stage_name(i));
    }
    printf(" %9s %9s %8s %10s\n", "ms on 1", "ms on 2", "machine", "efficiency");
    bool good = true;
    for (uint32_t i = 0; good && i < o->size_count; i++) {
        deforming_body b;
        if (!deforming_body_make(o->kind, o->sizes[i], DEFORM_WAVE, o->shuffled, &b, error)) return false;
        for (int k = 0; good && k < 3; k++) good = run_method(&b, o, methods[k], out, error);
        deforming_body_free(&b);
    }
    return good && run_serial_shares(o, out, error);
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {2000, 5000, 20000, 100000};
    static const bench_program program = {"threads", help, sizes, 4, 3, run_duels};
    return bench_main(&program, argument_count, arguments);
}
