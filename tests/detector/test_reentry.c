/* One call at a time in a context: a second one, from a callback or another thread, is refused and changes nothing. Objects
 * that are destroyed meanwhile live until the call ends. */
#include "src/core/context.h"
#include "tests/support/calls.h"
#include "tests/support/panels.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <semaphore.h>
#include <stdlib.h>
#include <string.h>

/* The callback from which the host comes back, and what it does there. */
typedef struct returning_host {
    panel_scene *p;
    counting_allocator counter;
    host_callback from;
    void (*inside)(struct returning_host *h);
    atomic_uint calls; /* of that callback so far */
    uint32_t at;       /* it does so in this call of the callback, counted from 1; 0: never */
    int what;
    uint32_t done, wrong;
    sem_t came, go_on;
} returning_host;

static void notice_call(returning_host *h, host_callback callback) {
    if (callback == h->from && atomic_fetch_add(&h->calls, 1) + 1 == h->at) h->inside(h);
}

static bool ignore_none(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    notice_call(user, HOST_IGNORE);
    return kind == CSCD_CONTACT_TT && a == b;
}

static bool report_progress(void *user, const char *stage, double fraction) {
    notice_call(user, HOST_PROGRESS);
    return stage != NULL && fraction >= 0.0;
}

static void *allocate_block(void *user, size_t size, size_t alignment) {
    returning_host *h = user;
    cscd_allocator system = counting_allocator_interface(&h->counter);
    notice_call(h, HOST_ALLOCATOR);
    return system.allocate(system.user, size, alignment);
}

static void release_block(void *user, void *block, size_t size) {
    returning_host *h = user;
    cscd_allocator system = counting_allocator_interface(&h->counter);
    system.release(system.user, block, size);
}

static void run_tasks_here(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index),
                           void *data) {
    notice_call(user, HOST_PARALLEL_FOR);
    for (uint32_t i = 0; i < task_count; i++) task(data, i);
}

#ifdef __SANITIZE_THREAD__
enum { SIDE = 24 };
#else
enum { SIDE = 40 };
#endif

/* Eight for each square of a panel. */
enum { CONTACTS = 8 * (SIDE - 1) * (SIDE - 1) };

static panel_scene make_panels(returning_host *h, uint32_t thread_count) {
    cscd_context_options options = cscd_context_defaults();
    cscd_detector_options detector_options = cscd_detector_defaults();
    detector_options.ignore = ignore_none;
    detector_options.ignore_user = h;
    h->counter = counting_allocator_start();
    options.thread_count =
        h->from == HOST_PROGRESS ? 1 : thread_count; /* else helpers may do all that takes long */
    options.allocator = (cscd_allocator){allocate_block, release_block, h};
    options.progress = (cscd_progress){report_progress, h};
    if (h->from == HOST_PARALLEL_FOR) options.parallel_for = (cscd_parallel_for){run_tasks_here, h};
    panel_scene p = panels_create(SIDE, &options, &detector_options);
    p.context->progress.interval_ms = 0.0; /* asks as often as it can */
    h->p = NULL;
    return p;
}

/* ---- calls from callbacks ------------------------------------------------------------------------------ */

enum { CALLS = 17 };

static cscd_status call_again(const panel_scene *p, int what) {
    static union {
        cscd_contacts contacts;
        cscd_proximities proximities;
        cscd_intersections intersections;
        cscd_intersections pairs;
        cscd_contact_part_pairs sums;
        cscd_free_step step;
        cscd_displacement_bounds bounds;
        cscd_truncation truncation;
    } found;
    void *made = NULL;
    switch (what) {
    case 0:
        return panels_step(p, &found.contacts);
    case 1:
        return panels_near(p, &found.proximities);
    case 2:
        return panels_check(p, &found.intersections);
    case 3:
        return panels_max_step(p, &found.step);
    case 4:
        return cscd_detector_set_separation(p->detector, 0.5, 0.0);
    case 5:
        return panels_create_detector(p, NULL, (cscd_detector **)&made);
    case 6:
        return panels_create_mesh(p, p->context, (cscd_mesh **)&made);
    case 7:
        return panels_plan(p, CSCD_METHOD_SINGLE, (cscd_plan **)&made);
    case 8:
        return cscd_line_search_create(p->detector, (cscd_line_search **)&made);
    case 9:
        return displacement_bounds_packed(p->detector, p->x0, 0.1, p->x1, &found.bounds);
    case 10:
        return truncate_packed(p->detector, p->x0, p->x1, 0.1, NULL, &found.truncation);
    case 11:
        return cscd_detector_set_rules(p->detector, NULL, 0, NULL, 0);
    case 12:
        return cscd_detector_set_active(p->detector, NULL, 0);
    case 13:
        return find_intersections_packed(p->detector, p->x0, NULL, &found.pairs);
    case 14:
        return cscd_detector_set_parts(p->detector, NULL, 0);
    case 15:
        return cscd_detector_contact_parts(p->detector, NULL, 0, &found.sums);
    default:
        return cscd_detector_set_bodies(p->detector, NULL, 0);
    }
}

static void come_back(returning_host *h) {
    uint32_t corners[3];
    h->done++;
    h->wrong += call_again(h->p, h->what) != CSCD_BUSY;
    h->wrong += cscd_context_detail(h->p->context)[0] != '\0';
    cscd_mesh_triangle(h->p->mesh, 0, corners); /* meshes may be read */
    h->wrong += corners[0] == corners[1] || cscd_mesh_vertex_count(h->p->mesh) != h->p->vertex_count;
}

TEST(calls_from_callbacks_are_busy) {
    for (host_callback from = HOST_ALLOCATOR; from <= HOST_IGNORE; from++) {
        for (int what = (int)from % PACED(1, 3); what < CALLS; what += PACED(1, 3)) {
            returning_host h = {.from = from, .inside = come_back, .what = what};
            panel_scene p = make_panels(&h, 3);
            cscd_contacts found;
            h.p = &p;
            h.calls = 0;
            h.at = 1 + (uint32_t)what % 3;
            expect_ok(panels_step(&p, &found));
            assert_int_equal(found.count, CONTACTS);
            assert_int_equal(h.done, 1);
            assert_int_equal(h.wrong, 0);
            expect_ok(panels_step(&p, &found));
            assert_int_equal(found.count, CONTACTS);
            panels_destroy(&p);
            assert_int_equal(h.counter.live, 0);
        }
    }
    assert_non_null(strstr(cscd_status_string(CSCD_BUSY), "busy"));
}

/* ---- calls from another thread ------------------------------------------------------------------------- */

static void wait_inside(returning_host *h) {
    sem_post(&h->came);
    sem_wait(&h->go_on);
}

static void *step_on_thread(void *argument) {
    returning_host *h = argument;
    cscd_contacts found = {.count = 0};
    h->done = panels_step(h->p, &found) == CSCD_OK && found.count == CONTACTS;
    return NULL;
}

TEST(other_threads_are_refused) {
    for (host_callback from = HOST_ALLOCATOR; from <= HOST_IGNORE; from++) {
        returning_host h = {.from = from, .inside = wait_inside};
        panel_scene p = make_panels(&h, 2);
        pthread_t thread;
        h.p = &p;
        h.calls = 0;
        h.at = 1;
        assert_int_equal(sem_init(&h.came, 0, 0) + sem_init(&h.go_on, 0, 0), 0);
        assert_int_equal(pthread_create(&thread, NULL, step_on_thread, &h), 0);
        sem_wait(&h.came);
        for (int what = 0; what < CALLS; what++) assert_int_equal(call_again(&p, what), CSCD_BUSY);
        sem_post(&h.go_on);
        pthread_join(thread, NULL);
        assert_int_equal(h.done, 1);
        cscd_contacts found;
        expect_ok(panels_step(&p, &found));
        assert_int_equal(found.count, CONTACTS);
        panels_destroy(&p);
        assert_int_equal(h.counter.live, 0);
    }
}

/* Two threads that both try all the time: each call either works or is refused. */
static void *step_often(void *argument) {
    returning_host *h = argument;
    for (int i = 0; i < 20; i++) {
        cscd_detector *own = NULL;
        cscd_status status = panels_create_detector(h->p, NULL, &own);
        if (status == CSCD_BUSY) continue;
        cscd_contacts found = {.count = 0};
        if (status == CSCD_OK)
            status = cscd_detector_step(own, CSCD_DOUBLES(h->p->x0, h->p->vertex_count),
                                        CSCD_DOUBLES(h->p->x1, h->p->vertex_count), &found);
        cscd_detector_destroy(own);
        if (status != CSCD_OK && status != CSCD_BUSY) h->wrong++;
        if (status == CSCD_OK) h->done++;
    }
    return NULL;
}

TEST(threads_at_once) {
    returning_host h = {.from = HOST_PROGRESS}, first, second;
    panel_scene p = make_panels(&h, 1);
    h.p = &p;
    first = second = h;
    pthread_t threads[2];
    assert_int_equal(pthread_create(&threads[0], NULL, step_often, &first), 0);
    assert_int_equal(pthread_create(&threads[1], NULL, step_often, &second), 0);
    for (int i = 0; i < 2; i++) pthread_join(threads[i], NULL);
    assert_int_equal(first.wrong + second.wrong, 0);
    assert_true(first.done + second.done > 0);
    panels_destroy(&p);
    assert_int_equal(h.counter.live, 0);
}

/* ---- destruction --------------------------------------------------------------------------------------- */

/* Everything that the call works with. */
static void destroy_all(returning_host *h) {
    h->done++;
    cscd_context_destroy(h->p->context);
    cscd_mesh_destroy(h->p->mesh);
    cscd_detector_destroy(h->p->detector);
    h->p->context = NULL;
    h->p->mesh = NULL;
    h->p->detector = NULL;
}

TEST(destroyed_objects_live_on) {
    for (host_callback from = HOST_ALLOCATOR; from <= HOST_IGNORE; from++) {
        returning_host h = {.from = from, .inside = destroy_all};
        panel_scene p = make_panels(&h, 2);
        cscd_contacts found;
        h.p = &p;
        h.calls = 0;
        h.at = 2;
        expect_ok(panels_step(&p, &found));
        assert_int_equal(found.count, CONTACTS);
        assert_int_equal(h.done, 1);
        assert_int_equal(h.counter.live, 0);
        panels_destroy(&p);
    }
}

static void *destroy_on_thread(void *argument) {
    destroy_all(argument);
    return NULL;
}

static void destroy_elsewhere(returning_host *h) {
    pthread_t thread;
    h->wrong += pthread_create(&thread, NULL, destroy_on_thread, h) != 0 || pthread_join(thread, NULL) != 0;
}

TEST(another_thread_destroys) {
    returning_host h = {.from = HOST_IGNORE, .inside = destroy_elsewhere};
    panel_scene p = make_panels(&h, 2);
    cscd_contacts found;
    h.p = &p;
    h.at = 1;
    expect_ok(panels_step(&p, &found));
    assert_int_equal(found.count, CONTACTS);
    assert_int_equal(h.done, 1);
    assert_int_equal(h.wrong, 0);
    assert_int_equal(h.counter.live, 0);
    panels_destroy(&p);
}
