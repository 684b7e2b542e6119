/* Whatever floating-point environment the host has, results are those of the default one, bit for bit; callbacks see the
 * host's, and every call gives it back. */
#include "src/core/context.h"
#include "tests/support/calls.h"
#include "tests/support/panels.h"
#include "tests/support/test.h"
#include "tests/support/workload.h"

#include <fenv.h>
#include <pthread.h>
#include <stdlib.h>

enum { SCENES = PACED(24, 4) };

/* ---- environments -------------------------------------------------------------------------------------- */

#if defined(__SSE2__)
#define ROUNDING(mode) ((uint64_t)(mode) << 13)
#define FLUSHING       ((uint64_t)0x8040) /* FTZ and DAZ */
#define TRAPPING       ((uint64_t)0x1f80) /* taken away: these are masks */
#define PLAIN          ((uint64_t)0x1f80)
#elif defined(__aarch64__)
#define ROUNDING(mode) ((uint64_t)(mode) << 22)
#define FLUSHING       ((uint64_t)1 << 24)
#define TRAPPING       ((uint64_t)0) /* few processors can */
#define PLAIN          ((uint64_t)0)
#endif

enum { ENVIRONMENTS = 12 };

/* The first one is the default. Traps come with four of them; flags, as after arithmetic of the host's, with all. */
static float_environment environment_of(int number) {
#if defined(PLAIN)
    uint64_t bits = PLAIN | ROUNDING(number % 4);
    if (number / 4 == 1) bits |= FLUSHING;
    if (number / 4 == 2) bits ^= TRAPPING;
    return (float_environment){bits};
#else
    static const int modes[] = {FE_TONEAREST, FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO};
    return (float_environment){(uint64_t)modes[number % 4]};
#endif
}

static bool is_environment(float_environment expected) {
    return float_environment_get().bits == expected.bits;
}

/* The flags apart: the host's own arithmetic in a callback may set some. */
static bool is_mode(float_environment expected) {
    return ((float_environment_get().bits ^ expected.bits) & ~FLOAT_FLAGS) == 0;
}

/* ---- a host that watches its environment ---------------------------------------------------------------- */

typedef struct watching_host {
    float_environment own; /* of the thread that calls */
    counting_allocator counter;
    atomic_uint seen[4], wrong[4]; /* by callback */
    uint32_t reports, cancel_at;   /* of this call; the report that cancels, counted from 1; 0: none */
    uint32_t returns, wrong_returns, cancelled;
} watching_host;

static void look_around(watching_host *h, host_callback callback) {
    atomic_fetch_add(&h->seen[callback], 1);
    if (!is_mode(h->own)) atomic_fetch_add(&h->wrong[callback], 1);
}

static void *allocate_block(void *user, size_t size, size_t alignment) {
    watching_host *h = user;
    cscd_allocator system = counting_allocator_interface(&h->counter);
    look_around(h, HOST_ALLOCATOR);
    return system.allocate(system.user, size, alignment);
}

static void release_block(void *user, void *block, size_t size) {
    watching_host *h = user;
    cscd_allocator system = counting_allocator_interface(&h->counter);
    look_around(h, HOST_ALLOCATOR);
    system.release(system.user, block, size);
}

static bool report_progress(void *user, const char *stage, double fraction) {
    watching_host *h = user;
    look_around(h, HOST_PROGRESS);
    (void)fraction;
    return stage != NULL && ++h->reports != h->cancel_at;
}

static bool ignore_none(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    look_around(user, HOST_IGNORE);
    return kind == CSCD_CONTACT_TT && a == b;
}

typedef struct pool_thread {
    pthread_t thread;
    void (*task)(void *data, uint32_t index);
    void *data;
    uint32_t begin, end;
    bool kept; /* it found its own environment after every task */
} pool_thread;

/* A thread whose environment differs from the caller's. */
static void *run_share(void *argument) {
    pool_thread *p = argument;
    float_environment own = environment_of(6);
    p->kept = true;
    float_environment_set(own);
    for (uint32_t i = p->begin; i < p->end; i++) {
        p->task(p->data, i);
        p->kept &= is_environment(own);
    }
    float_environment_set(environment_of(0));
    return NULL;
}

static void run_on_threads(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index),
                           void *data) {
    watching_host *h = user;
    pool_thread other = {.task = task, .data = data, .begin = task_count / 2, .end = task_count};
    look_around(h, HOST_PARALLEL_FOR);
    bool started = pthread_create(&other.thread, NULL, run_share, &other) == 0;
    for (uint32_t i = 0; i < other.begin; i++) task(data, i);
    if (!is_mode(h->own) || !started) atomic_fetch_add(&h->wrong[HOST_PARALLEL_FOR], 1);
    if (started) pthread_join(other.thread, NULL);
    if (!other.kept) atomic_fetch_add(&h->wrong[HOST_PARALLEL_FOR], 1);
}

/* After each call of the workload, which may have succeeded, failed or been cancelled; cancelled ones are repeated. */
static bool look_after_call(void *user, cscd_context *context, cscd_status status) {
    watching_host *h = user;
    (void)context;
    h->returns++;
    h->wrong_returns += !is_environment(h->own);
    float_environment_set(h->own);
    h->cancelled += status == CSCD_CANCELLED;
    h->reports = 0;
    h->cancel_at = status == CSCD_CANCELLED ? 0 : 1 + h->returns % 17;
    return status == CSCD_CANCELLED;
}

static cscd_context *make_context(watching_host *h, uint32_t thread_count, bool pool) {
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    h->counter = counting_allocator_start();
    options.thread_count = thread_count;
    options.allocator = (cscd_allocator){allocate_block, release_block, h};
    options.progress = (cscd_progress){report_progress, h};
    if (pool) options.parallel_for = (cscd_parallel_for){run_on_threads, h};
    if (cscd_context_create(&options, &context) != CSCD_OK) return NULL;
    context->progress.interval_ms = 0.0;
    return context;
}

/* ---- the same bits ------------------------------------------------------------------------------------- */

static sequence q; /* large; one test at a time */

/* Nothing is asserted in strange environments. */
static workload_result run_in(float_environment own, workload w, uint32_t thread_count, bool pool,
                              watching_host *h) {
    *h = (watching_host){.own = own, .cancel_at = 1};
    w.options.ignore = ignore_none;
    w.options.ignore_user = w.user = h;
    w.again = look_after_call;
    float_environment before = float_environment_get();
    float_environment_set(own);
    cscd_context *context = make_context(h, thread_count, pool);
    workload_result result = {.failed = true};
    if (context != NULL) result = workload_run(context, &w);
    cscd_context_destroy(context);
    bool kept = is_environment(own);
    float_environment_set(before);
    assert_true(kept);
    return result;
}

static void check_host(const watching_host *h, bool pool) {
    assert_true(h->returns > 0);
    assert_int_equal(h->wrong_returns, 0);
    for (host_callback c = HOST_ALLOCATOR; c <= HOST_IGNORE; c++) assert_int_equal(h->wrong[c], 0);
    assert_true(h->seen[HOST_ALLOCATOR] > 0);
    assert_true(h->seen[HOST_PARALLEL_FOR] > 0 || !pool);
    assert_int_equal(h->counter.live, 0);
}

static uint32_t ignored_pairs, reports, cancelled;

static void compare_environments(const workload *w) {
    static workload_result expected, found;
    watching_host h;
    expected = run_in(environment_of(0), *w, 1, false, &h);
    assert_false(expected.failed);
    for (int number = 0; number < ENVIRONMENTS; number++) {
        uint32_t thread_count = 1 + (uint32_t)number % 3;
        bool pool = number % 2 == 1 && thread_count > 1;
        found = run_in(environment_of(number), *w, thread_count, pool, &h);
        assert_false(found.failed);
        assert_int_equal(found.call_count, expected.call_count);
        assert_memory_equal(found.digests, expected.digests, found.call_count * sizeof *found.digests);
        check_host(&h, false);
        ignored_pairs += h.seen[HOST_IGNORE];
        reports += h.seen[HOST_PROGRESS];
        cancelled += h.cancelled;
    }
}

TEST(random_scenes) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE};
    ignored_pairs = reports = cancelled = 0;
    for (uint64_t seed = 0; seed < SCENES; seed++) {
        sequence_make(seed % 2 ? SEQUENCE_GRID : SEQUENCE_SCENE, seed, 9, &q);
        workload w = {.sequence = &q, .options = cscd_detector_defaults()};
        w.options.method = methods[seed / 2 % 2];
        if (seed % 5 == 4) w.options.min_separation = 0.01;
        compare_environments(&w);
    }
    assert_true(ignored_pairs > PACED(1000, 300) && reports > PACED(1000, 300) && cancelled > PACED(100, 30));
}

TEST(plans_of_each_kind) {
    static const cscd_method methods[] = {CSCD_METHOD_SINGLE, CSCD_METHOD_KMEANS, CSCD_METHOD_CHARGE};
    for (uint32_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        workload_tube(&q, 28, 16, 3);
        workload w = {.sequence = &q, .plan = methods[i], .options = cscd_detector_defaults()};
        compare_environments(&w);
    }
}

/* ---- loops of the host, and threads of the context ------------------------------------------------------- */

TEST(many_threads) {
    static workload_result expected, found;
    watching_host h;
    workload_tube(&q, 40, 20, 6);
    workload w = {.sequence = &q, .options = cscd_detector_defaults()};
    expected = run_in(environment_of(0), w, 1, false, &h);
    for (int number = 0; number < ENVIRONMENTS; number += PACED(1, 5)) {
        for (int pool = 0; pool < 2; pool++) {
            found = run_in(environment_of(number), w, 3, pool, &h);
            assert_false(found.failed);
            assert_memory_equal(found.digests, expected.digests, found.call_count * sizeof *found.digests);
            check_host(&h, pool);
        }
    }
}

/* ---- what callbacks do to it ----------------------------------------------------------------------------- */

static bool raise_and_turn(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    feraiseexcept(FE_DIVBYZERO);
    fesetround(*(int *)user);
    return kind == CSCD_CONTACT_TT && a == b;
}

/* What a callback changes is the host's affair: it stays, and the library does not notice. */
TEST(callbacks_may_change_it) {
    int mode = FE_UPWARD;
    cscd_detector_options options = cscd_detector_defaults();
    cscd_contacts found;
    options.ignore = raise_and_turn;
    options.ignore_user = &mode;
    panel_scene p = panels_create(12, NULL, &options);
    feclearexcept(FE_ALL_EXCEPT);
    cscd_status status = panels_step(&p, &found);
    int rounding = fegetround(), raised = fetestexcept(FE_ALL_EXCEPT);
    fesetround(FE_TONEAREST);
    feclearexcept(FE_ALL_EXCEPT);
    assert_int_equal(status, CSCD_OK);
    assert_int_equal(found.count, 968);
    assert_int_equal(rounding, FE_UPWARD);
    assert_int_equal(raised, FE_DIVBYZERO);
    panels_destroy(&p);
}

/* ---- functions without a status -------------------------------------------------------------------------- */

TEST(stencils_are_the_same) {
    panel_scene p = panels_create(4, NULL, NULL);
    for (int kind = CSCD_CONTACT_VF; kind <= CSCD_CONTACT_EE; kind++) {
        cscd_stencil expected = cscd_mesh_stencil(p.mesh, (cscd_contact_kind)kind, 1, 2, 0.1, 0.3);
        for (int number = 0; number < ENVIRONMENTS; number++) {
            float_environment before = float_environment_get();
            float_environment_set(environment_of(number));
            cscd_stencil found = cscd_mesh_stencil(p.mesh, (cscd_contact_kind)kind, 1, 2, 0.1, 0.3);
            bool kept = is_environment(environment_of(number));
            float_environment_set(before);
            assert_true(kept);
            assert_memory_equal(found.weights, expected.weights, sizeof found.weights);
        }
    }
    panels_destroy(&p);
}
