/* A callback that leaves the library by longjmp: later calls say so, nothing waits for ever, and everything is freed. */
#include "src/core/context.h"
#include "tests/support/callback_host.h"
#include "tests/support/test.h"

#include <string.h>

/* It leaves on its own thread only, where it has set out. */
typedef struct leaving_host {
    callback_host host; /* the first member */
    jmp_buf back;
} leaving_host;

static void leave_library(void *host) {
    longjmp(((leaving_host *)host)->back, 1);
}

enum { SIDE = 40 };

static void make_host(leaving_host *h, host_callback from, uint32_t thread_count) {
    *h = (leaving_host){.host = {.from = from, .stop = leave_library}};
    callback_host_open(&h->host, SIDE, thread_count);
}

/* ---- what is left in its midst ------------------------------------------------------------------------- */

enum { CALLS = 8 };

/* What a call makes is destroyed at once. */
static cscd_status make_call(const panel_scene *p, int what) {
    cscd_contacts contacts;
    cscd_intersections intersections;
    cscd_proximities proximities;
    cscd_free_step step;
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    cscd_mesh *mesh = NULL;
    cscd_status status = what == 0   ? panels_step(p, &contacts)
                         : what == 1 ? panels_check(p, &intersections)
                         : what == 2 ? panels_near(p, &proximities)
                         : what == 3 ? panels_max_step(p, &step)
                         : what == 4 ? panels_plan(p, CSCD_METHOD_SINGLE, &plan)
                         : what == 5 ? panels_plan(p, CSCD_METHOD_KMEANS, &plan)
                         : what == 6 ? panels_create_detector(p, NULL, &detector)
                                     : panels_create_mesh(p, p->context, &mesh);
    cscd_plan_destroy(plan);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    return status;
}

/* True: the host has left the call. */
static bool leave_call(leaving_host *h, int what, uint32_t at) {
    h->host.calls = 0;
    h->host.at = at;
    if (setjmp(h->back) != 0) {
        h->host.at = 0;
        return true;
    }
    assert_int_equal(make_call(&h->host.p, what), CSCD_OK);
    h->host.at = 0;
    return false;
}

/* Leaves one call of one kind at one place; false: there are fewer such places. */
static bool leave_and_look(host_callback from, uint32_t thread_count, int what, uint32_t at) {
    leaving_host h;
    make_host(&h, from, thread_count);
    bool left = leave_call(&h, what, at);
    for (int next = 0; left && next < CALLS; next++) {
        assert_int_equal(make_call(&h.host.p, next), CSCD_BROKEN);
        assert_non_null(strstr(cscd_context_detail(h.host.p.context), callback_host_name(from)));
    }
    callback_host_close(&h.host);
    return left;
}

enum { SPARSENESS = PACED(4, 1) };

static void leave_everywhere(host_callback from, uint32_t thread_count) {
    uint32_t left = 0;
    for (int what = 0; what < CALLS; what++) {
        for (uint32_t at = 1; leave_and_look(from, thread_count, what, at); at += 1 + at / SPARSENESS) left++;
    }
    assert_true(left > 4);
}

TEST(contexts_are_broken) {
    for (host_callback from = HOST_ALLOCATOR; from <= HOST_IGNORE; from++)
        leave_everywhere(from, 1 + (from == HOST_PARALLEL_FOR));
}

/* The helpers rest when the host leaves, and end with the context. */
TEST(own_threads_end) {
    leave_everywhere(HOST_ALLOCATOR, 3);
    leave_everywhere(HOST_PROGRESS, 3);
}

/* ---- in doubt ------------------------------------------------------------------------------------------ */

static cscd_status call_from_deep(const panel_scene *p, int depth) {
    volatile char room[4096] = {0};
    cscd_status status = depth > 0 ? call_from_deep(p, depth - 1) : make_call(p, 2);
    return room[0] == 0 ? status : CSCD_OK;
}

static void *call_from_thread(void *argument) {
    static cscd_status status;
    status = make_call(argument, 2);
    return &status;
}

/* Where frames tell nothing the context is busy; the first call that can tell marks it for all. */
TEST(doubtful_calls_are_busy) {
    leaving_host h;
    panel_scene *p = &h.host.p;
    pthread_t thread;
    void *status;
    make_host(&h, HOST_IGNORE, 2);
    assert_true(leave_call(&h, 0, 3));
    for (int marked = 0; marked < 2; marked++) {
        cscd_status expected = marked ? CSCD_BROKEN : CSCD_BUSY;
        assert_int_equal(call_from_deep(p, 8), expected);
        assert_int_equal(pthread_create(&thread, NULL, call_from_thread, p), 0);
        assert_int_equal(pthread_join(thread, &status), 0);
        assert_int_equal(*(cscd_status *)status, expected);
        assert_int_equal(make_call(p, 0), CSCD_BROKEN);
    }
    callback_host_close(&h.host);
}

/* Nothing but destruction follows, which notices by itself. */
TEST(destruction_alone) {
    for (uint32_t threads = 1; threads < 4; threads++) {
        leaving_host h;
        make_host(&h, HOST_ALLOCATOR, threads);
        assert_true(leave_call(&h, 0, 4));
        callback_host_close(&h.host);
    }
}

/* A mesh that another context uses outlives its own context, although that is broken. */
TEST(shared_meshes_live_on) {
    leaving_host h;
    cscd_contacts found;
    make_host(&h, HOST_IGNORE, 2);
    panel_scene *p = &h.host.p, other = {.vertex_count = p->vertex_count};
    assert_int_equal(cscd_context_create(NULL, &other.context), CSCD_OK);
    assert_int_equal(cscd_detector_create(other.context, p->mesh, NULL, NULL, &other.detector), CSCD_OK);
    assert_true(leave_call(&h, 0, 3));
    cscd_detector_destroy(p->detector);
    cscd_mesh_destroy(p->mesh);
    cscd_context_destroy(p->context);
    other.x0 = p->x0;
    other.x1 = p->x1;
    assert_int_equal(panels_step(&other, &found), CSCD_OK);
    assert_int_equal(found.count, 12168);
    assert_true(h.host.counter.live > 0);
    panels_destroy(&other);
    assert_int_equal(h.host.counter.live, 0);
}
