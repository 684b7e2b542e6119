/* A host whose callbacks stop at one chosen call. */
#include "tests/support/callback_host.h"

#include "src/core/context.h"
#include "tests/support/test.h"

static void perhaps_stop(callback_host *h, host_callback callback) {
    if (callback != h->from || (!h->on_any_thread && !pthread_equal(h->thread, pthread_self()))) return;
    if (atomic_fetch_add(&h->calls, 1) + 1 == h->at) h->stop(h);
}

static bool ignore_none(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    perhaps_stop(user, HOST_IGNORE);
    return kind == CSCD_CONTACT_TT && a == b;
}

static bool report_progress(void *user, const char *stage, double fraction) {
    perhaps_stop(user, HOST_PROGRESS);
    return stage != NULL && fraction >= 0.0;
}

static void *allocate_block(void *user, size_t size, size_t alignment) {
    callback_host *h = user;
    cscd_allocator system = counting_allocator_interface(&h->counter);
    perhaps_stop(h, HOST_ALLOCATOR);
    return system.allocate(system.user, size, alignment);
}

static void release_block(void *user, void *block, size_t size) {
    callback_host *h = user;
    cscd_allocator system = counting_allocator_interface(&h->counter);
    system.release(system.user, block, size);
}

static void run_tasks_here(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index),
                           void *data) {
    for (uint32_t i = 0; i < task_count; i++) {
        task(data, i);
        perhaps_stop(user, HOST_PARALLEL_FOR);
    }
}

void callback_host_open(callback_host *h, uint32_t side, uint32_t thread_count) {
    cscd_context_options options = cscd_context_defaults();
    cscd_detector_options detector_options = cscd_detector_defaults();
    detector_options.ignore = ignore_none;
    detector_options.ignore_user = h;
    h->counter = counting_allocator_start();
    h->thread = pthread_self();
    options.thread_count = thread_count;
    options.allocator = (cscd_allocator){allocate_block, release_block, h};
    options.progress = (cscd_progress){report_progress, h};
    if (h->run != NULL || h->from == HOST_PARALLEL_FOR)
        options.parallel_for = (cscd_parallel_for){h->run != NULL ? h->run : run_tasks_here, h};
    h->p = panels_create(side, &options, &detector_options);
    h->p.context->progress.interval_ms = 0.0;
    atomic_store(&h->calls, 0);
}

void callback_host_close(callback_host *h) {
    panels_destroy(&h->p);
    assert_int_equal(h->counter.live, 0);
}

const char *callback_host_name(host_callback callback) {
    static const char *const names[] = {"the allocator", "parallel_for", "the progress function", "ignore"};
    return names[callback];
}
