/* What a change of seams, ignored pairs or rules uncovers while it touches: a seam that opens in mid run, and who is let
 * go, when. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/panels.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* ---- a run --------------------------------------------------------------------------------------------- */

/* The first panel wants to go up, the second one down; a sewn pair goes alike. */
static size_t waiting_of(const cscd_detector *detector) {
    return cscd_detector_waiting(detector).features;
}

static void want_motion(equal_panels *p, random_stream *random, double speed, size_t sewn) {
    for (uint32_t v = 0; v < EQUAL_PANEL; v++) {
        for (uint32_t k = 0; k < 3; k++) {
            double common = stream_between(random, -0.01, 0.01);
            double *a = p->x1 + (size_t)3 * v + k, *b = a + (size_t)3 * EQUAL_PANEL;
            *a = p->x0[3 * v + k] + common;
            *b = p->x0[3 * (EQUAL_PANEL + v) + k] + common;
            if (v < sewn || k < 2) continue;
            *a += speed * stream_between(random, 0.2, 1.0);
            *b -= speed * stream_between(random, 0.2, 1.0);
        }
    }
}

/* Goes as far as the call allows. Sewn pairs stay on each other, as their motions and rounding are the same. */
static cscd_free_step go_there(equal_panels *p, bool by_line) {
    cscd_free_step step;
    if (by_line) {
        expect_ok(line_begin_packed(p->line, p->x0, p->x1, 0.0));
        expect_ok(line_max_step_packed(p->line, 1.0, p->reached, &step));
    } else {
        expect_ok(max_step_packed(p->detector, p->x0, p->x1, p->reached, &step));
    }
    memcpy(p->x0, p->reached, sizeof p->x0);
    return step;
}

static double least_gap(const equal_panels *p) {
    double least = INFINITY;
    for (uint32_t v = 0; v < EQUAL_PANEL; v++)
        least = fmin(least, p->x0[3 * v + 2] - p->x0[3 * (EQUAL_PANEL + v) + 2]);
    return least;
}

/* The panels move on, part, and are pressed together for long: they come near each other, and never pass. */
static void run_panels(double min_separation, uint32_t threads, bool by_line) {
    static equal_panels p;
    random_stream random = stream_start(threads);
    cscd_intersections crossing;
    size_t waited = 0, sewn = EQUAL_PANEL;
    double least = INFINITY;
    equal_panels_begin(&p, min_separation, threads);
    for (int i = 0; i < 5; i++) {
        want_motion(&p, &random, 0.05, sewn);
        cscd_free_step step = go_there(&p, by_line);
        assert_true(!step.limited && waiting_of(p.detector) == 0);
    }
    for (int i = 0; sewn > 0 || waited > 0; i++) { /* the seam opens, row by row */
        assert_true(i < 100);
        sewn = sewn > EQUAL_SIDE ? sewn - EQUAL_SIDE : 0;
        expect_ok(cscd_detector_set_seams(p.detector, &p.seams[0][0], sewn));
        want_motion(&p, &random, 0.05, sewn);
        cscd_free_step step = go_there(&p, by_line);
        assert_true(waiting_of(p.detector) > 0 || sewn == 0);
        assert_true(step.moved);
        waited = waiting_of(p.detector);
    }
    assert_true(least_gap(&p) > min_separation);
    for (int i = 0; i < 150; i++) {
        want_motion(&p, &random, -0.03, 0);
        go_there(&p, by_line);
        assert_int_equal(waiting_of(p.detector), 0);
        least = fmin(least, least_gap(&p));
        expect_ok(check_packed(p.detector, p.x0, &crossing));
        assert_int_equal(crossing.count, 0);
    }
    assert_true(least > 0.0 && least_gap(&p) < 0.1 + min_separation);
    equal_panels_end(&p);
}

TEST(a_seam_opens_in_mid_run) {
    run_panels(0.0, 1, false);
    run_panels(0.0, 2, true);
    run_panels(0.01, 2, false);
    run_panels(0.01, 1, true);
}

/* ---- who waits, and how long --------------------------------------------------------------------------- */

/* Every function leaves out what waits, and says how many pairs do. */
TEST(every_function_leaves_out_what_waits) {
    static equal_panels p;
    cscd_contacts contacts;
    cscd_intersections crossing;
    cscd_proximities near;
    cscd_displacement_bounds bounded;
    cscd_truncation cut;
    static double bounds[EQUAL_VERTICES];
    for (int first = 0; first < 5; first++) {
        equal_panels_begin(&p, 0.0, 1);
        equal_panels_open(&p);
        for (int i = first; i < first + 5; i++) {
            size_t waiting = 0;
            switch (i % 5) {
            case 0:
                expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
                assert_int_equal(contacts.count, 0);
                waiting = waiting_of(p.detector);
                break;
            case 1:
                expect_ok(find_near_packed(p.detector, p.x0, 0.01, &near));
                assert_int_equal(near.count, 0);
                waiting = waiting_of(p.detector);
                break;
            case 2:
                expect_ok(displacement_bounds_packed(p.detector, p.x0, 0.01, bounds, &bounded));
                assert_int_equal(bounded.blocked_count, 0);
                waiting = waiting_of(p.detector);
                break;
            case 3:
                equal_panels_part(&p, 0.004, p.x1);
                expect_ok(truncate_packed(p.detector, p.x0, p.x1, 0.01, p.reached, &cut));
                assert_int_equal(cut.held_count, 0);
                assert_true(cut.fraction == 1.0);
                waiting = waiting_of(p.detector);
                break;
            default:
                expect_ok(check_packed(p.detector, p.x0, &crossing));
                assert_int_equal(crossing.count, 0);
                assert_true(cscd_detector_waiting(p.detector).triangles > EQUAL_TRIANGLES);
                expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
                waiting = waiting_of(p.detector);
            }
            assert_int_equal(waiting, p.touching);
        }
        equal_panels_end(&p);
    }
}

/* Positions at which a motion starts let go of what is apart there; those of find_near, and where a motion ends, do
 * not. */
TEST(a_pair_waits_until_it_is_apart_where_a_motion_starts) {
    static equal_panels p;
    static double apart[EQUAL_VERTICES * 3];
    cscd_contacts contacts;
    cscd_proximities near;
    cscd_intersections crossing;
    const double distance = 0.125;
    equal_panels_begin(&p, distance, 1);
    equal_panels_part(&p, distance, apart);
    equal_panels_open(&p);
    expect_ok(step_packed(p.detector, p.x0, apart, &contacts));
    size_t all = waiting_of(p.detector);
    equal_panels_part(&p, 2.0, p.x1);
    expect_ok(find_near_packed(p.detector, p.x1, 0.01, &near));
    assert_int_equal(waiting_of(p.detector), all);
    expect_ok(step_packed(p.detector, p.x0, p.x1, &contacts));
    assert_true(contacts.count == 0 && waiting_of(p.detector) == all);
    expect_ok(step_packed(p.detector, apart, apart, &contacts));
    assert_true(waiting_of(p.detector) > 0 && waiting_of(p.detector) <= all);
    equal_panels_part(&p, 1.5 * distance, apart);
    expect_ok(step_packed(p.detector, apart, p.x1, &contacts));
    assert_true(waiting_of(p.detector) < all && contacts.count == 0);
    expect_ok(check_packed(p.detector, p.x1, &crossing));
    assert_true(cscd_detector_waiting(p.detector).triangles == 0);
    expect_ok(step_packed(p.detector, p.x1, p.x0, &contacts));
    assert_true(waiting_of(p.detector) == 0 && contacts.count == all);
    equal_panels_end(&p);
}

/* A seam that is sewn anew leaves out its pairs itself. What opens where nothing touches does not wait. */
TEST(what_is_left_out_anew_waits_no_more) {
    static equal_panels p;
    cscd_contacts contacts;
    equal_panels_begin(&p, 0.0, 1);
    equal_panels_open(&p);
    expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
    assert_true(waiting_of(p.detector) > 0 && contacts.count == 0);
    expect_ok(cscd_detector_set_seams(p.detector, &p.seams[0][0], EQUAL_PANEL));
    expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
    assert_true(waiting_of(p.detector) == 0 && contacts.count == 0);
    equal_panels_part(&p, 0.5, p.x1);
    equal_panels_open(&p);
    expect_ok(step_packed(p.detector, p.x1, p.x0, &contacts));
    assert_true(waiting_of(p.detector) == 0 && contacts.count == p.touching);
    equal_panels_end(&p);
}

/* Rules and lists uncover as seams do. */
TEST(rules_and_lists_uncover_too) {
    static equal_panels p;
    cscd_contacts contacts;
    cscd_object_rule rules[] = {cscd_object_rule_default(), cscd_object_rule_default()};
    static uint32_t ignored[EQUAL_TRIANGLES * EQUAL_TRIANGLES][2];
    rules[0].mask = 0;
    for (uint32_t i = 0; i < EQUAL_TRIANGLES * EQUAL_TRIANGLES; i++) {
        ignored[i][0] = i / EQUAL_TRIANGLES;
        ignored[i][1] = EQUAL_TRIANGLES + i % EQUAL_TRIANGLES;
    }
    for (int by_rules = 0; by_rules < 2; by_rules++) {
        equal_panels_begin(&p, 0.0, 1);
        if (by_rules == 1)
            expect_ok(cscd_detector_set_rules(p.detector, rules, 2, NULL, 0));
        else
            expect_ok(
                cscd_detector_set_ignored(p.detector, &ignored[0][0], EQUAL_TRIANGLES * EQUAL_TRIANGLES));
        equal_panels_open(&p);
        expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
        assert_true(waiting_of(p.detector) == 0 && contacts.count == 0);
        expect_ok(by_rules == 1 ? cscd_detector_set_rules(p.detector, NULL, 0, NULL, 0)
                                : cscd_detector_set_ignored(p.detector, NULL, 0));
        expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
        assert_true(waiting_of(p.detector) == p.touching && contacts.count == 0);
        equal_panels_end(&p);
    }
}

static bool ignore_all(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    (void)kind;
    (void)a;
    (void)b;
    return *(const bool *)user;
}

/* The caller's function is asked for each list: what it does not leave out any more is reported at once. */
TEST(what_a_function_uncovers_does_not_wait) {
    static equal_panels p;
    cscd_contacts contacts;
    cscd_detector *other;
    bool ignores = true;
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = ignore_all;
    options.ignore_user = &ignores;
    equal_panels_begin(&p, 0.0, 1);
    expect_ok(detector_create_here(p.mesh, NULL, &options, &other));
    expect_ok(step_packed(other, p.x0, p.x0, &contacts));
    assert_true(contacts.count == 0);
    ignores = false;
    expect_ok(step_packed(other, p.x0, p.x0, &contacts));
    assert_true(waiting_of(other) == 0 && contacts.count == p.touching);
    cscd_detector_destroy(other);
    equal_panels_end(&p);
}
