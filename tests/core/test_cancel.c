/* cscd_context_cancel from another thread, and without a call. From callbacks: tests/proofs. */
#include "src/core/context.h"
#include "tests/support/panels.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <string.h>

/* One call of `ignore` cancels, from another thread. Progress is asked as often as can be, and never cancels. */
typedef struct cancelling_host {
    panel_scene p;
    atomic_uint calls; /* of ignore so far */
    uint32_t at;       /* the call that cancels, counted from 1; 0: none */
} cancelling_host;

static void *cancel_on_thread(void *context) {
    cscd_context_cancel(context);
    return NULL;
}

static bool ignore_none(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    cancelling_host *h = user;
    if (atomic_fetch_add(&h->calls, 1) + 1 == h->at) {
        pthread_t thread;
        assert_int_equal(pthread_create(&thread, NULL, cancel_on_thread, h->p.context), 0);
        assert_int_equal(pthread_join(thread, NULL), 0);
    }
    return kind == CSCD_CONTACT_TT && a == b;
}

static bool go_on(void *user, const char *stage, double fraction) {
    return user == NULL && stage != NULL && fraction >= 0.0;
}

static void open_host(cancelling_host *h) {
    cscd_context_options options = cscd_context_defaults();
    cscd_detector_options detector_options = cscd_detector_defaults();
    detector_options.ignore = ignore_none;
    detector_options.ignore_user = h;
    options.thread_count = 2;
    options.progress = (cscd_progress){go_on, NULL};
    h->p = panels_create(16, &options, &detector_options);
    h->p.context->progress.interval_ms = 0.0;
}

TEST(threads_cancel) {
    cancelling_host h = {.at = 3};
    cscd_contacts found = {.count = 12345}, expected;
    open_host(&h);
    assert_int_equal(panels_step(&h.p, &found), CSCD_CANCELLED);
    assert_non_null(strstr(cscd_context_detail(h.p.context), "cscd_context_cancel"));
    assert_int_equal(found.count, 12345);
    h.at = 0;
    assert_int_equal(panels_step(&h.p, &expected), CSCD_OK);
    assert_true(expected.count > 3 && expected.count < 12345);
    panels_destroy(&h.p);
}

/* The contacts of a call that comes after are all there. */
TEST(without_a_call) {
    cscd_contacts found;
    size_t counts[2];
    for (int i = 0; i < 2; i++) {
        cancelling_host h = {.at = 0};
        open_host(&h);
        cscd_context_cancel(i == 0 ? NULL : h.p.context);
        assert_int_equal(panels_step(&h.p, &found), CSCD_OK);
        counts[i] = found.count;
        panels_destroy(&h.p);
    }
    assert_int_equal(counts[0], counts[1]);
}
