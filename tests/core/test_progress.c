/* Progress and cancellation: a call that was cancelled anywhere gives, when repeated, the result that it
 * would have given. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "src/core/context.h"
#include "src/core/timer.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"
#include "tests/support/workload.h"

#include <math.h>
#include <pthread.h>
#include <string.h>

static sequence q; /* large; one test at a time */

/* ---- a host that watches and cancels ------------------------------------------------------------------- */

typedef struct watcher {
    pthread_t thread;
    uint32_t reports, cancel_at; /* reports of this call; the one that cancels, counted from 1; 0: none */
    uint32_t every;              /* cancels at each of so many first reports, then at ever larger gaps */
    bool cancelled;
    double fraction, last_ms, closest_ms;
    bool fell, elsewhere, nameless;
    uint32_t cancellations, unexplained;
    size_t bytes; /* held by the context after the last cancelled call */
} watcher;

static bool watch_progress(void *user, const char *stage, double fraction) {
    watcher *w = user;
    double now = timer_now_ms();
    if (w->reports > 0) w->closest_ms = fmin(w->closest_ms, now - w->last_ms);
    w->fell |= fraction < w->fraction || fraction < 0.0 || fraction > 1.0;
    w->elsewhere |= !pthread_equal(w->thread, pthread_self());
    w->nameless |= stage == NULL || stage[0] == '\0';
    w->fraction = fraction;
    w->last_ms = now;
    w->cancelled = ++w->reports == w->cancel_at;
    return !w->cancelled;
}

static void next_call(watcher *w, uint32_t cancel_at) {
    w->reports = 0;
    w->cancel_at = cancel_at;
    w->cancelled = false;
    w->fraction = 0.0;
}

/* Cancels a call at its first report, its second and so on, until it has no report of that number. In large
 * calls it skips some. */
static bool cancel_later(void *user, cscd_context *context, cscd_status status) {
    watcher *w = user;
    if (!w->cancelled) {
        if (status == CSCD_CANCELLED) w->unexplained++;
        next_call(w, 1);
        return false;
    }
    if (status != CSCD_CANCELLED || strstr(cscd_context_detail(context), "cancelled") == NULL) {
        w->unexplained++;
        next_call(w, 1);
        return false;
    }
    w->bytes = cscd_context_describe(context).bytes;
    w->cancellations++;
    next_call(w, w->cancel_at + 1 + w->cancel_at / w->every);
    return true;
}

static cscd_context *make_context(uint32_t thread_count, watcher *w, counting_allocator *counter) {
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    *counter = counting_allocator_start();
    options.thread_count = thread_count;
    options.allocator = counting_allocator_interface(counter);
    if (w != NULL) {
        *w = (watcher){.thread = pthread_self(), .cancel_at = 1, .every = UINT32_MAX, .closest_ms = INFINITY};
        options.progress = (cscd_progress){watch_progress, w};
    }
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    return context;
}

static void expect_good(const watcher *w) {
    assert_false(w->fell);
    assert_false(w->elsewhere);
    assert_false(w->nameless);
    assert_int_equal(w->unexplained, 0);
}

/* ---- every call, cancelled everywhere ------------------------------------------------------------------ */

static void expect_equal(const workload_result *found, const workload_result *expected) {
    assert_false(found->failed);
    assert_false(expected->failed);
    assert_int_equal(found->call_count, expected->call_count);
    for (uint32_t i = 0; i < found->call_count; i++) {
        if (found->digests[i] != expected->digests[i]) fail_msg("call %u gave something else", i);
    }
}

/* Compares a workload whose calls are cancelled and repeated with one whose calls run through unwatched. */
static workload_result check_interrupted(uint32_t thread_count, uint32_t every, workload w) {
    static workload_result found, expected;
    counting_allocator counter;
    watcher host;
    cscd_context *context = make_context(1, NULL, &counter);
    w.sequence = &q;
    expected = workload_run(context, &w);
    cscd_context_destroy(context);

    context = make_context(thread_count, &host, &counter);
    context->progress.interval_ms = 0.0;
    host.every = every;
    w.again = cancel_later;
    w.user = &host;
    size_t bytes = cscd_context_describe(context).bytes;
    found = workload_run(context, &w);
    assert_int_equal(cscd_context_describe(context).bytes, bytes);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
    expect_equal(&found, &expected);
    expect_good(&host);
    print_message("%u calls, cancelled %u times\n", found.call_count, host.cancellations);
    assert_true(host.cancellations > found.call_count);
    return expected;
}

static cscd_detector_options of_method(cscd_method method, cscd_mode mode, cscd_start start) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.mode = mode;
    options.start = start;
    return options;
}

TEST(culling_goes_on) {
    static const cscd_start starts[] = {CSCD_START_PROVE, CSCD_START_VOUCHED, CSCD_START_UNKNOWN};
    uint64_t contacts = 0, culled = 0;
    for (uint64_t seed = 0; seed < 6; seed++) {
        sequence_make(seed % 3 == 2 ? SEQUENCE_GRID : SEQUENCE_SCENE, seed + 20, 14, &q);
        cscd_mode mode = seed % 2 == 0 ? CSCD_MODE_ALL : CSCD_MODE_EARLIEST;
        workload_result found = check_interrupted(
            seed % 2 == 0 ? 1 : 3, UINT32_MAX,
            (workload){.options = of_method(CSCD_METHOD_SINGLE, mode, starts[seed / 2 % 3])});
        contacts += found.contacts;
        culled += found.culled;
    }
    assert_true(contacts > 0);
    assert_true(culled > 0);
}

/* A pleated sheet that is pulled flat, so that its trees are rebuilt in a call that is cancelled. */
TEST(rebuilding_goes_on) {
    enum { COLUMNS = 140, PLEAT = 6 };
    scene_clear(&q.shape);
    scene_add_sheet(&q.shape, COLUMNS, 6.0, COLUMNS, 6);
    q.frame_count = 16;
    for (uint32_t f = 0; f < q.frame_count; f++) {
        double angle = 0.5 * acos(-1.0) * 0.98 * fmax(0.0, 1.0 - f / 12.0);
        for (uint32_t v = 0; v < q.shape.vertex_count; v++) {
            const double *rest = q.shape.x0 + (size_t)v * 3;
            double along = rest[0] - q.shape.x0[0], fold = fmod(fabs(along), 2.0 * PLEAT);
            double *x = q.frames[f] + (size_t)v * 3;
            x[0] = along * cos(angle);
            x[1] = rest[1];
            x[2] = (fold < PLEAT ? fold : 2.0 * PLEAT - fold) * sin(angle);
        }
    }
    workload_result found = check_interrupted(
        1, UINT32_MAX, (workload){.options = of_method(CSCD_METHOD_NONE, CSCD_MODE_ALL, CSCD_START_PROVE)});
    assert_true(found.rebuilds > 0);
}

/* The tube is large enough that workers share its trees, and it bends until it touches itself. */
TEST(large_meshes_go_on) {
    for (uint32_t threads = 1; threads < 4; threads += 2) {
        workload_tube(&q, 36, 18, 5);
        workload_result found = check_interrupted(
            threads, 4,
            (workload){.options = of_method(CSCD_METHOD_SINGLE, CSCD_MODE_ALL, CSCD_START_PROVE)});
        assert_true(found.contacts > 0);
    }
}

/* ---- plans --------------------------------------------------------------------------------------------- */

enum { PLAN_EVERY = 16 }; /* a plan by charge has hundreds of reports */

/* Reports keep the library's own interval, and the fraction comes near 1. */
TEST(reports_come_now_and_then) {
    counting_allocator counter;
    watcher host;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    scene_clear(&q.shape);
    scene_add_capsule(&q.shape, 5.0, 0.5, 44, 22);
    cscd_object_desc desc =
        cscd_object_of_triangles(q.shape.vertex_count, q.shape.triangle_count, q.shape.triangles);
    cscd_context *context = make_context(1, &host, &counter);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    next_call(&host, 0);
    assert_int_equal(plan_create_packed(mesh, q.shape.x0, NULL, &plan), CSCD_OK);
    expect_good(&host);
    assert_true(host.reports > 1);
    assert_true(host.closest_ms >= context->progress.interval_ms);
    assert_true(host.fraction > 0.5);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

static bool keep_fraction(void *user, const char *stage, double fraction) {
    (void)stage;
    *(double *)user = fraction;
    return true;
}

/* A stage is a share of a part, which is a share of the call; what is reported never falls. */
TEST(shares_of_parts_of_calls) {
    double fraction = -1.0;
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context = NULL;
    options.progress = (cscd_progress){keep_fraction, &fraction};
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    progress *p = &context->progress;
    p->interval_ms = 0.0;
    progress_begin(p);
    progress_part(p, 0.5, 0.75);
    progress_stage(p, "first", 0.25, 0.75);
    assert_true(progress_go_on(p, 0.5) && fraction == 0.625);
    assert_true(progress_go_on(p, 1.0) && fraction == 0.6875);
    progress_part(p, 0.0, 1.0);
    progress_stage(p, "second", 0.0, 0.5);
    assert_true(progress_go_on(p, 1.0) && fraction == 0.6875);
    progress_begin(p);
    assert_true(progress_go_on(p, 0.125) && fraction == 0.125);
    cscd_context_destroy(context);
}
