/* The cost of detection in three solvers: its share of a simulation step, its latency, its allocations. */
#include "benchmarks/lib/options.h"
#include "models/cloth/cloth.h"
#include "models/common/scene_program.h"
#include "models/ipc/ipc.h"
#include "models/softbody/softbody.h"
#include "src/core/timer.h"

#include <stdlib.h>
#include <string.h>

enum { FRAMES_MAX = 1024, QUICK_FRAMES = 24, PARTS = 3 };

static const char help[] =
    "usage: callers [options]\n"
    "\n"
    "The solvers of models/ simulate their scenes, nothing is written. Per frame: the time within cscd and all\n"
    "of it, the median and the 99th percentile over the frames, and the share of cscd in the sum. Calls of the\n"
    "allocator by cscd: in the first frame, which builds trees, in the rest of the first third of the frames,\n"
    "in the second and in the last third. --sizes and the other options on bodies mean nothing here.\n"
    "\n";

/* ---- callers ------------------------------------------------------------------------------------------- */

/* A running simulation; detect_ms is the time in cscd so far. */
typedef struct caller {
    recorder soft;
    cloth_simulation cloth;
    ipc_solver ipc;
    cscd_context *context;
    double detect_ms;
    uint32_t triangle_count;
} caller;

typedef struct caller_kind {
    const char *name, *scene_name;
    bool (*open)(const char *name, cscd_context *context, caller *out, io_error *error);
    bool (*advance)(caller *c, io_error *error);
    void (*close)(caller *c);
    uint32_t (*frame_count)(const char *name);
} caller_kind;

static bool open_soft(const char *name, cscd_context *context, caller *out, io_error *error) {
    if (!recorder_open(soft_scene_find(name), context, &out->soft, error)) return false;
    out->triangle_count = out->soft.shape.triangle_count;
    return true;
}

static bool advance_soft(caller *c, io_error *error) {
    bool good = recorder_advance(&c->soft, error);
    c->detect_ms = c->soft.detect_ms;
    return good;
}

static void close_soft(caller *c) {
    recorder_close(&c->soft);
}

static uint32_t frames_soft(const char *name) {
    return soft_scene_find(name)->frame_count - 1;
}

static bool open_cloth(const char *name, cscd_context *context, caller *out, io_error *error) {
    if (!cloth_open(cloth_scene_find(name), 0, context, &out->cloth, error)) return false;
    out->triangle_count = cscd_mesh_triangle_count(out->cloth.mesh);
    return true;
}

static bool advance_cloth(caller *c, io_error *error) {
    bool good = cloth_advance(&c->cloth, error);
    c->detect_ms = c->cloth.statistics.safe_ms;
    return good;
}

static void close_cloth(caller *c) {
    cloth_close(&c->cloth);
}

static uint32_t frames_cloth(const char *name) {
    return cloth_scene_find(name)->frame_count - 1;
}

static bool open_ipc(const char *name, cscd_context *context, caller *out, io_error *error) {
    if (ipc_solver_make(ipc_scene_find(name), 0, context, &out->ipc) != CSCD_OK)
        return io_fail(error, "%s: %s", name, cscd_context_detail(context));
    out->triangle_count = out->ipc.shape.triangle_count;
    return true;
}

static bool advance_ipc(caller *c, io_error *error) {
    const ipc_scene *of = c->ipc.scene;
    for (uint32_t i = 0; i < of->steps; i++) {
        if (ipc_solver_advance(&c->ipc) != CSCD_OK)
            return io_fail(error, "%s: %s", of->name, cscd_context_detail(c->context));
    }
    c->detect_ms = c->ipc.statistics.detect_ms;
    return true;
}

static void close_ipc(caller *c) {
    ipc_solver_free(&c->ipc);
}

static uint32_t frames_ipc(const char *name) {
    return ipc_scene_find(name)->frame_count - 1;
}

static const caller_kind kinds[] = {
    {"soft body", "pawn-drop", open_soft, advance_soft, close_soft, frames_soft},
    {"cloth", "cloth-drape", open_cloth, advance_cloth, close_cloth, frames_cloth},
    {"cloth", "sleeve", open_cloth, advance_cloth, close_cloth, frames_cloth},
    {"cloth", "bag", open_cloth, advance_cloth, close_cloth, frames_cloth},
    {"ipc", "rings", open_ipc, advance_ipc, close_ipc, frames_ipc},
    {"ipc", "press", open_ipc, advance_ipc, close_ipc, frames_ipc},
};

/* ---- measuring ----------------------------------------------------------------------------------------- */

typedef struct samples {
    uint32_t count;
    double detect[FRAMES_MAX], total[FRAMES_MAX];
    uint64_t first_calls,
        calls[PARTS]; /* calls of the allocator: in the first frame; in each part of the rest */
} samples;

static bool run_frames(const caller_kind *kind, caller *c, const uint64_t *calls, samples *s,
                       io_error *error) {
    terminal_progress shown;
    terminal_progress_begin(&shown, false);
    for (uint32_t i = 0; i < s->count; i++) {
        uint64_t calls_before = *calls;
        double detect_before = c->detect_ms, begin = timer_now_ms();
        terminal_progress_update(&shown, i, s->count, kind->scene_name);
        if (!kind->advance(c, error)) return false;
        s->total[i] = timer_now_ms() - begin;
        s->detect[i] = c->detect_ms - detect_before;
        if (i == 0)
            s->first_calls += *calls - calls_before;
        else
            s->calls[(uint64_t)i * PARTS / s->count] += *calls - calls_before;
    }
    terminal_progress_end(&shown);
    return true;
}

static bool measure_caller(const caller_kind *kind, const bench_options *o, samples *s,
                           uint32_t *triangle_count, io_error *error) {
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context = NULL;
    uint64_t calls = 0;
    options.thread_count = o->thread_count;
    options.simd = o->simd;
    options.allocator = allocation_count_interface(&calls);
    if (cscd_context_create(&options, &context) != CSCD_OK) return io_fail(error, "no context");
    caller *c = calloc(1, sizeof *c);
    if (c == NULL) exit(1);
    c->context = context;
    bool good = kind->open(kind->scene_name, context, c, error);
    if (good) {
        *triangle_count = c->triangle_count;
        good = run_frames(kind, c, &calls, s, error);
        kind->close(c);
    }
    free(c);
    cscd_context_destroy(context);
    return good;
}

/* ---- the table ----------------------------------------------------------------------------------------- */

static int compare_doubles(const void *left, const void *right) {
    double l = *(const double *)left, r = *(const double *)right;
    return l < r ? -1 : l > r;
}

static double sum_of(const double *values, uint32_t count) {
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) sum += values[i];
    return sum;
}

/* Returns the value of a sorted list below which `share` of the values lie. */
static double percentile_of(const double *values, uint32_t count, double share) {
    uint32_t place = (uint32_t)(share * count);
    return values[place < count ? place : count - 1];
}

static void print_row(const caller_kind *kind, uint32_t triangle_count, samples *s, json *out) {
    double share = sum_of(s->detect, s->count) / sum_of(s->total, s->count);
    qsort(s->detect, s->count, sizeof *s->detect, compare_doubles);
    qsort(s->total, s->count, sizeof *s->total, compare_doubles);
    double values[4] = {percentile_of(s->detect, s->count, 0.5), percentile_of(s->detect, s->count, 0.99),
                        percentile_of(s->total, s->count, 0.5), percentile_of(s->total, s->count, 0.99)};
    printf("  %-9s %-12s %9u %6u %6.0f %% %8.2f %8.2f %9.2f %9.2f %6u %6u %6u %6u\n", kind->name,
           kind->scene_name, triangle_count, s->count, 100.0 * share, values[0], values[1], values[2],
           values[3], (uint32_t)s->first_calls, (uint32_t)s->calls[0], (uint32_t)s->calls[1],
           (uint32_t)s->calls[2]);
    fflush(stdout);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "caller", kind->name);
    json_string(out, "scene", kind->scene_name);
    json_integer(out, "triangles", triangle_count);
    json_integer(out, "frames", s->count);
    json_number(out, "detection_share", share);
    json_number(out, "detection_p50_ms", values[0]);
    json_number(out, "detection_p99_ms", values[1]);
    json_number(out, "frame_p50_ms", values[2]);
    json_number(out, "frame_p99_ms", values[3]);
    json_integer(out, "allocations_in_last_third", s->calls[PARTS - 1]);
    json_end_object(out);
}

static bool run_callers(const bench_options *o, json *out, io_error *error) {
    printf("%u thread%s; ms of a frame\n", o->thread_count, o->thread_count == 1 ? "" : "s");
    printf("  %-9s %-12s %9s %6s %8s %17s %19s %27s\n", "", "", "", "", "share of", "in cscd", "all of it",
           "allocations by cscd");
    printf("  %-9s %-12s %9s %6s %8s %8s %8s %9s %9s %6s %6s %6s %6s\n", "caller", "scene", "triangles",
           "frames", "cscd", "p50", "p99", "p50", "p99", "frame1", "1st", "2nd", "3rd");
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        uint32_t frames = kinds[i].frame_count(kinds[i].scene_name), triangle_count = 0;
        static samples s;
        memset(&s, 0, sizeof s);
        s.count = o->quick && frames > QUICK_FRAMES ? QUICK_FRAMES : frames;
        if (!measure_caller(&kinds[i], o, &s, &triangle_count, error)) return false;
        print_row(&kinds[i], triangle_count, &s, out);
    }
    return true;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {5000};
    static const bench_program program = {"callers", help, sizes, 1, 1, run_callers};
    return bench_main(&program, argument_count, arguments);
}
