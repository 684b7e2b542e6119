/* cscd_context_cancel from another thread, and without a call. From callbacks: tests/proofs. */
#include "tests/support/callback_host.h"
#include "tests/support/test.h"

#include <string.h>

enum { SIDE = 16 };

static void *cancel_on_thread(void *context) {
    cscd_context_cancel(context);
    return NULL;
}

static void cancel_call(void *host) {
    callback_host *h = host;
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, cancel_on_thread, h->p.context), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
}

TEST(threads_cancel) {
    callback_host h = {.from = HOST_IGNORE, .stop = cancel_call};
    cscd_contacts found = {.count = 12345}, expected;
    callback_host_open(&h, SIDE, 2);
    h.at = 3;
    assert_int_equal(panels_step(&h.p, &found), CSCD_CANCELLED);
    assert_non_null(strstr(cscd_context_detail(h.p.context), "cscd_context_cancel"));
    assert_int_equal(found.count, 12345);
    h.at = 0;
    assert_int_equal(panels_step(&h.p, &expected), CSCD_OK);
    assert_true(expected.count > 3 && expected.count < 12345);
    callback_host_close(&h);
}

/* The contacts of a call that comes after are all there. */
TEST(without_a_call) {
    callback_host h = {.from = HOST_IGNORE};
    cscd_contacts found;
    size_t counts[2];
    for (int i = 0; i < 2; i++) {
        callback_host_open(&h, SIDE, 2);
        cscd_context_cancel(i == 0 ? NULL : h.p.context);
        assert_int_equal(panels_step(&h.p, &found), CSCD_OK);
        counts[i] = found.count;
        callback_host_close(&h);
    }
    assert_int_equal(counts[0], counts[1]);
}
