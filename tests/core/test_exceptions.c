/* A callback that throws a C++ exception through the library: it arrives, the context is broken for every thread, nothing
 * waits for ever, and everything is freed. */
#include "src/core/context.h"
#include "tests/core/throwing_host.h"
#include "tests/support/callback_host.h"
#include "tests/support/test.h"

#include <string.h>

typedef struct throwing_host {
    callback_host host; /* the first member */
    bool pool_is_mute;  /* the pool drops what its tasks throw */
    cscd_status status;
} throwing_host;

static void throw_it(void *host) {
    (void)host;
    throw_exception();
}

static void run_on_threads(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index),
                           void *data) {
    throwing_host *h = user;
    run_on_pool(&h->pool_is_mute, task_count, task, data);
}

static void step_of_host(void *data) {
    throwing_host *h = data;
    cscd_contacts found;
    h->status = panels_step(&h->host.p, &found);
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
    assert_non_null(strstr(cscd_context_detail(h->host.p.context), name));
    assert_non_null(strstr(cscd_context_detail(h->host.p.context), "exception"));
}

/* Returns false when there is no such call any more. */
static bool throw_and_look(host_callback from, uint32_t thread_count, uint32_t at) {
    throwing_host h = {.host = {.from = from, .stop = throw_it}};
    uint32_t size = from == HOST_PROGRESS ? 64 : 40; /* progress is reported every 4 ms */
    callback_host_open(&h.host, size, thread_count);
    h.host.at = at;
    bool caught = call_catching(step_of_host, &h);
    h.host.at = 0;
    if (caught)
        expect_broken(&h, callback_host_name(from));
    else
        assert_int_equal(h.status, CSCD_OK);
    callback_host_close(&h.host);
    return caught;
}

TEST(exceptions_arrive) {
    for (host_callback from = HOST_ALLOCATOR; from <= HOST_IGNORE; from++) {
        for (uint32_t threads = 1; threads <= 3; threads += 2) {
            uint32_t at = 1;
            while (throw_and_look(from, threads, at)) at += 1 + PACED(at / 2, at);
            assert_true(at > 1 || (from == HOST_PARALLEL_FOR && threads == 1));
        }
    }
}

/* ---- pools of the host --------------------------------------------------------------------------------- */

/* The allocator throws on a thread of the pool. Even if the pool drops that, the call does not succeed. */
TEST(pools_pass_exceptions_on) {
    for (int mute = 0; mute < 2; mute++) {
        uint32_t in_tasks = 0;
        for (uint32_t at = 1; at < 60; at += PACED(3, 9)) {
            throwing_host h = {
                {.from = HOST_ALLOCATOR, .stop = throw_it, .run = run_on_threads, .on_any_thread = true},
                .pool_is_mute = mute};
            callback_host_open(&h.host, 40, 3);
            h.host.at = at;
            bool caught = call_catching(step_of_host, &h);
            h.host.at = 0;
            if (caught || h.status == CSCD_BROKEN)
                expect_broken(&h, callback_host_name(HOST_ALLOCATOR));
            else
                assert_int_equal(h.status, CSCD_OK);
            in_tasks += mute ? !caught && h.status == CSCD_BROKEN : caught;
            callback_host_close(&h.host);
        }
        assert_true(in_tasks > 0);
    }
}
