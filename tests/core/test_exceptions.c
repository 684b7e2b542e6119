/* A callback that throws a C++ exception through the library: it arrives, the context is broken for every thread, nothing
 * waits for ever, and everything is freed. */
#include "src/core/context.h"
#include "tests/core/throwing_host.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/panels.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <string.h>

typedef struct throwing_host {
    panel_scene p;
    counting_allocator counter;
    host_callback from;
    atomic_uint calls;
    uint32_t at; /* throws in this call of the callback, counted from 1; 0: never */
    bool
        from_pool; /* on any thread; else on this one alone, because nobody catches what a thread of ours throws */
    bool pool_is_mute; /* the pool drops what its tasks throw */
    pthread_t thread;
    cscd_status status;
} throwing_host;

static void perhaps_throw(throwing_host *h, host_callback callback) {
    if (callback != h->from || (!h->from_pool && !pthread_equal(h->thread, pthread_self()))) return;
    if (atomic_fetch_add(&h->calls, 1) + 1 == h->at) throw_exception();
}

static bool ignore_none(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    perhaps_throw(user, HOST_IGNORE);
    return kind == CSCD_CONTACT_TT && a == b;
}

static bool report_progress(void *user, const char *stage, double fraction) {
    perhaps_throw(user, HOST_PROGRESS);
    return stage != NULL && fraction >= 0.0;
}

static void *allocate_block(void *user, size_t size, size_t alignment) {
    throwing_host *h = user;
    cscd_allocator system = counting_allocator_interface(&h->counter);
    perhaps_throw(h, HOST_ALLOCATOR);
    return system.allocate(system.user, size, alignment);
}

static void release_block(void *user, void *block, size_t size) {
    throwing_host *h = user;
    cscd_allocator system = counting_allocator_interface(&h->counter);
    system.release(system.user, block, size);
}

static void run_tasks(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index), void *data) {
    throwing_host *h = user;
    if (h->from_pool) {
        run_on_pool(&h->pool_is_mute, task_count, task, data);
        return;
    }
    for (uint32_t i = 0; i < task_count; i++) task(data, i);
    perhaps_throw(h, HOST_PARALLEL_FOR);
}

static void make_panels(throwing_host *h, uint32_t thread_count) {
    cscd_context_options options = cscd_context_defaults();
    cscd_detector_options detector_options = cscd_detector_defaults();
    detector_options.ignore = ignore_none;
    detector_options.ignore_user = h;
    h->counter = counting_allocator_start();
    h->thread = pthread_self();
    options.thread_count = thread_count;
    options.allocator = (cscd_allocator){allocate_block, release_block, h};
    options.progress = (cscd_progress){report_progress, h};
    if (h->from == HOST_PARALLEL_FOR || h->from_pool)
        options.parallel_for = (cscd_parallel_for){run_tasks, h};
    h->p = panels_create(40, &options, &detector_options);
    h->p.context->progress.interval_ms = 0.0;
    atomic_store(&h->calls, 0);
}

static void step_of_host(void *data) {
    throwing_host *h = data;
    cscd_contacts found;
    h->status = panels_step(&h->p, &found);
}

static void *step_on_thread(void *argument) {
    step_of_host(argument);
    return NULL;
}

/* The mark does not depend on frames, as after longjmp. */
static cscd_status step_from_deep(throwing_host *h, int depth) {
    volatile char room[4096] = {0};
    if (depth > 0) return step_from_deep(h, depth - 1);
    step_of_host(h);
    return room[0] == 0 ? h->status : CSCD_OK;
}

static void expect_broken(throwing_host *h, const char *name) {
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, step_on_thread, h), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(h->status, CSCD_BROKEN);
    assert_int_equal(step_from_deep(h, 8), CSCD_BROKEN);
    assert_non_null(strstr(cscd_context_detail(h->p.context), name));
    assert_non_null(strstr(cscd_context_detail(h->p.context), "exception"));
}

static const char *const names[] = {"the allocator", "parallel_for", "the progress function", "ignore"};

/* Returns false when there is no such call any more. */
static bool throw_and_look(host_callback from, uint32_t thread_count, uint32_t at) {
    throwing_host h = {.from = from};
    make_panels(&h, thread_count);
    h.at = at;
    bool caught = call_catching(step_of_host, &h);
    h.at = 0;
    if (caught)
        expect_broken(&h, names[from]);
    else
        assert_int_equal(h.status, CSCD_OK);
    panels_destroy(&h.p);
    assert_int_equal(h.counter.live, 0);
    return caught;
}

static void exceptions_arrive(void **state) {
    (void)state;
    for (host_callback from = HOST_ALLOCATOR; from <= HOST_IGNORE; from++) {
        for (uint32_t threads = 1; threads <= 3; threads += 2) {
            uint32_t at = 1;
            while (throw_and_look(from, threads, at)) at += 1 + at / 2;
            assert_true(at > 1 || (from == HOST_PARALLEL_FOR && threads == 1));
        }
    }
}

/* ---- pools of the host --------------------------------------------------------------------------------- */

/* The allocator throws on a thread of the pool. Even if the pool drops that, the call does not succeed. */
static void pools_pass_exceptions_on(void **state) {
    (void)state;
    for (int mute = 0; mute < 2; mute++) {
        uint32_t in_tasks = 0;
        for (uint32_t at = 1; at < 60; at += 3) {
            throwing_host h = {.from = HOST_ALLOCATOR, .from_pool = true, .pool_is_mute = mute};
            make_panels(&h, 3);
            h.at = at;
            bool caught = call_catching(step_of_host, &h);
            h.at = 0;
            if (caught || h.status == CSCD_BROKEN)
                expect_broken(&h, names[HOST_ALLOCATOR]);
            else
                assert_int_equal(h.status, CSCD_OK);
            in_tasks += mute ? !caught && h.status == CSCD_BROKEN : caught;
            panels_destroy(&h.p);
            assert_int_equal(h.counter.live, 0);
        }
        assert_true(in_tasks > 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(exceptions_arrive),
                                       cmocka_unit_test(pools_pass_exceptions_on)};
    return cmocka_run_group_tests_name("exceptions", tests, NULL, NULL);
}
