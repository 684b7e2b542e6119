/* What a thread that calls the library needs of its stack: cscd/cscd.h promises that 256 KiB are enough. */
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <pthread.h>

enum { STACK_KIB = PACED(256, 2048) }; /* sanitizers put more on it */

static void plan_and_step(rig *r, const scene *s) {
    cscd_plan_options options = cscd_plan_defaults();
    options.method = CSCD_METHOD_AUTO;
    const cscd_view *x0 = CSCD_DOUBLES(s->x0, s->vertex_count), *x1 = CSCD_DOUBLES(s->x1, s->vertex_count);
    cscd_contacts contacts;
    expect_ok(cscd_plan_create(r->context, r->mesh, x0, &options, &r->plan));
    expect_ok(cscd_detector_create(r->context, r->mesh, r->plan, NULL, &r->detector));
    expect_ok(cscd_detector_step(r->detector, x0, x1, &contacts));
    assert_true(contacts.count > 0);
}

static void ask_of_a_moment(rig *r, const scene *s) {
    const cscd_view *x1 = CSCD_DOUBLES(s->x1, s->vertex_count);
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    cscd_event_tracker *tracker;
    cscd_events events;
    cscd_proximities near_pairs;
    options.curves = options.patches = options.overlaps = options.depths = options.parts = true;
    expect_ok(cscd_detector_find_intersections(r->detector, x1, &options, &found));
    assert_true(found.crossing > 0);
    expect_ok(cscd_event_tracker_create(r->context, r->mesh, NULL, &tracker));
    expect_ok(cscd_event_tracker_add_frame(tracker, 1, &found));
    expect_ok(cscd_event_tracker_finish(tracker, &events));
    expect_ok(cscd_detector_find_near(r->detector, x1, 0.05, CSCD_NEAR_UNIQUE, &near_pairs));
    cscd_event_tracker_destroy(tracker);
}

static void move_safely(rig *r, const scene *s) {
    static double reached[SCENE_VERTICES_MAX * 3];
    const cscd_view *x0 = CSCD_DOUBLES(s->x0, s->vertex_count), *x1 = CSCD_DOUBLES(s->x1, s->vertex_count);
    cscd_free_step step;
    cscd_truncation cut;
    cscd_line_search *search;
    expect_ok(cscd_detector_max_step(r->detector, x0, x1, NULL, &step));
    expect_ok(cscd_detector_truncate(r->detector, x0, x1, 0.05,
                                     CSCD_MUTABLE_DOUBLES(reached, s->vertex_count), &cut));
    cscd_safe_motion safe;
    expect_ok(cscd_detector_make_safe(r->detector, x0, x1, NULL, NULL, &safe));
    expect_ok(cscd_line_search_create(r->detector, &search));
    expect_ok(cscd_line_search_begin(search, x0, x1, 0.05));
    expect_ok(cscd_line_search_max_step(search, 1.0, NULL, &step));
    cscd_line_search_destroy(search);
}

/* A torus is folded, one half into the other. An assertion must not fail in another thread, so scenes that it holds for were tried. */
static void *call_all(void *data) {
    static scene s;
    rig r = {.context = context_of(1, NULL)};
    (void)data;
    scene_clear(&s);
    scene_add_torus(&s, (const double[3]){0, 0, 0}, 1.0, 0.4, 30, 20, false);
    for (uint32_t v = 0; v < s.vertex_count; v++) s.x1[3 * v] = fabs(s.x0[3 * v]) + 0.1 * s.x0[3 * v + 1];
    r.mesh = mesh_of_scene(r.context, &s);
    plan_and_step(&r, &s);
    ask_of_a_moment(&r, &s);
    move_safely(&r, &s);
    rig_destroy(&r);
    return NULL;
}

TEST(calls_fit_a_small_stack) {
    pthread_attr_t small;
    pthread_t thread;
    assert_int_equal(pthread_attr_init(&small), 0);
    assert_int_equal(pthread_attr_setstacksize(&small, (size_t)STACK_KIB * 1024), 0);
    assert_int_equal(pthread_create(&thread, &small, call_all, NULL), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    pthread_attr_destroy(&small);
}
