/* cscd_context_cancel: a callback, or another thread, ends the call that is running; nothing is written, and the call made
 * again gives what it would have given. */
#include "tests/support/callback_host.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 16, CALLS = 5 };

typedef struct cancelling_host {
    callback_host host; /* the first member */
    bool on_thread;     /* another thread cancels */
    cscd_line_search *line;
    double *reached;
} cancelling_host;

static void *cancel_on_thread(void *context) {
    cscd_context_cancel(context);
    return NULL;
}

static void cancel_call(void *host) {
    cancelling_host *h = host;
    pthread_t thread;
    if (h->on_thread) {
        assert_int_equal(pthread_create(&thread, NULL, cancel_on_thread, h->host.p.context), 0);
        assert_int_equal(pthread_join(thread, NULL), 0);
    } else {
        cscd_context_cancel(h->host.p.context);
    }
}

static void make_host(cancelling_host *h, host_callback from, bool on_thread) {
    *h = (cancelling_host){.host = {.from = from, .stop = cancel_call}, .on_thread = on_thread};
    callback_host_open(&h->host, SIDE, 2);
    h->reached = calloc((size_t)h->host.p.vertex_count * 3, sizeof *h->reached);
    assert_non_null(h->reached);
    assert_int_equal(cscd_line_search_create(h->host.p.detector, &h->line), CSCD_OK);
}

static void free_host(cancelling_host *h) {
    cscd_line_search_destroy(h->line);
    free(h->reached);
    callback_host_close(&h->host);
}

/* One of the calls of a solver; *out is its number of results, and must stay as it was when it fails. */
static cscd_status make_call(cancelling_host *h, int what, size_t *out) {
    cscd_contacts contacts = {.count = *out};
    cscd_intersections intersections = {.count = *out};
    cscd_proximities proximities = {.count = *out};
    cscd_free_step step = {.fraction = (double)*out};
    uint32_t n = h->host.p.vertex_count;
    h->host.calls = 0;
    cscd_status status =
        what == 0   ? panels_step(&h->host.p, &contacts)
        : what == 1 ? panels_check(&h->host.p, &intersections)
        : what == 2 ? cscd_detector_find_near(h->host.p.detector, CSCD_DOUBLES(h->host.p.x0, n), 1.2,
                                              CSCD_NEAR_PAIRS, &proximities)
        : what == 3 ? cscd_detector_max_step(h->host.p.detector, CSCD_DOUBLES(h->host.p.x0, n),
                                             CSCD_DOUBLES(h->host.p.x1, n),
                                             CSCD_MUTABLE_DOUBLES(h->reached, n), &step)
                    : cscd_line_search_begin(h->line, CSCD_DOUBLES(h->host.p.x0, n),
                                             CSCD_DOUBLES(h->host.p.x1, n), 0.0);
    size_t counts[] = {contacts.count, intersections.count, proximities.count, (size_t)(step.fraction * 1e9),
                       status == CSCD_OK ? cscd_line_search_candidate_count(h->line) : *out};
    if (what == 3 && status != CSCD_OK) assert_true(step.fraction == (double)*out);
    if (what != 3 || status == CSCD_OK) *out = counts[what];
    return status;
}

static void expect_untouched(const cancelling_host *h) {
    for (size_t i = 0; i < (size_t)h->host.p.vertex_count * 3; i++) assert_true(h->reached[i] == 0.0);
}

/* Cancels one call at one place; false: there are fewer such places. */
static bool cancel_and_repeat(host_callback from, bool on_thread, int what, uint32_t at, size_t expected) {
    cancelling_host h;
    make_host(&h, from, on_thread);
    h.host.at = at;
    size_t count = 12345;
    cscd_status status = make_call(&h, what, &count);
    bool cancelled = h.host.calls >= at;
    if (cancelled) {
        assert_int_equal(status, CSCD_CANCELLED);
        assert_non_null(strstr(cscd_context_detail(h.host.p.context), "cscd_context_cancel"));
        assert_int_equal(count, 12345);
        expect_untouched(&h);
        h.host.at = 0;
        status = make_call(&h, what, &count);
    }
    assert_int_equal(status, CSCD_OK);
    assert_int_equal(count, expected);
    free_host(&h);
    return cancelled;
}

static size_t expected_of(int what) {
    cancelling_host h;
    size_t count = 0;
    make_host(&h, HOST_IGNORE, false);
    assert_int_equal(make_call(&h, what, &count), CSCD_OK);
    assert_true(count > 0 || what == 1);
    free_host(&h);
    return count;
}

static uint32_t cancel_everywhere(host_callback from, bool on_thread) {
    uint32_t places = 0;
    for (int what = 0; what < CALLS; what++) {
        size_t expected = expected_of(what);
        for (uint32_t at = 1; cancel_and_repeat(from, on_thread, what, at, expected); at += 1 + at / 2)
            places++;
    }
    return places;
}

static void callbacks_cancel(void **state) {
    (void)state;
    assert_true(cancel_everywhere(HOST_IGNORE, false) > 10);
    assert_true(cancel_everywhere(HOST_PROGRESS, false) > 10);
    assert_true(cancel_everywhere(HOST_PARALLEL_FOR, false) > 4);
    assert_true(cancel_everywhere(HOST_ALLOCATOR, false) > 10);
}

static void threads_cancel(void **state) {
    (void)state;
    assert_true(cancel_everywhere(HOST_IGNORE, true) > 10);
}

/* The contacts of a call that comes after are all there. */
static void without_a_call(void **state) {
    cancelling_host h;
    size_t count = 0;
    (void)state;
    cscd_context_cancel(NULL);
    make_host(&h, HOST_IGNORE, false);
    cscd_context_cancel(h.host.p.context);
    assert_int_equal(make_call(&h, 0, &count), CSCD_OK);
    assert_int_equal(count, expected_of(0));
    free_host(&h);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(callbacks_cancel), cmocka_unit_test(threads_cancel),
                                       cmocka_unit_test(without_a_call)};
    return cmocka_run_group_tests_name("cancel", tests, NULL, NULL);
}
