/* Starts nearer than min_separation: pressed together they lose no more than a rung, torn apart they go on. */
#include "runtime/solver/solver.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { MOST_STEPS = NIGHTLY(1000, 10000) };

enum { SIDE = 3, PANEL = SIDE * SIDE, VERTICES = 2 * PANEL, TRIANGLES = 4 * (SIDE - 1) * (SIDE - 1) };

/* Two square panels of side 1, one above the other. */
typedef struct panels {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    double x0[VERTICES * 3], x1[VERTICES * 3];
} panels;

static void fill_triangles(uint32_t *out) {
    for (uint32_t panel = 0; panel < 2; panel++) {
        for (uint32_t i = 0; i < (SIDE - 1) * (SIDE - 1); i++, out += 6) {
            uint32_t corner = panel * PANEL + i / (SIDE - 1) * SIDE + i % (SIDE - 1);
            const uint32_t two[6] = {corner,     corner + SIDE, corner + 1,
                                     corner + 1, corner + SIDE, corner + SIDE + 1};
            memcpy(out, two, sizeof two);
        }
    }
}

/* The upper panel is a height above the lower one, turned a little, so that edges cross. */
static void place_panels(panels *p, double height) {
    for (int i = 0; i < VERTICES; i++) {
        double u = i % PANEL / SIDE / (SIDE - 1.0), v = i % SIDE / (SIDE - 1.0), *x = p->x0 + 3 * (size_t)i;
        bool upper = i >= PANEL;
        x[0] = upper ? 0.03 + 0.99 * u - 0.08 * v : u;
        x[1] = upper ? 0.01 + 0.08 * u + 0.99 * v : v;
        x[2] = upper ? height : 0.0;
    }
}

static void open_panels_by(panels *p, cscd_method method, double min_separation, double height) {
    uint32_t triangles[TRIANGLES * 3];
    cscd_object_desc desc = cscd_object_of_triangles(VERTICES, TRIANGLES, triangles);
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.min_separation = min_separation;
    fill_triangles(triangles);
    place_panels(p, height);
    expect_ok(cscd_context_create(NULL, &p->context));
    expect_ok(cscd_mesh_create(p->context, &desc, 1, &p->mesh));
    expect_ok(detector_create_here(p->mesh, NULL, &options, &p->detector));
}

static void open_panels(panels *p, double min_separation, double height) {
    open_panels_by(p, CSCD_METHOD_AUTO, min_separation, height);
}

static void close_panels(panels *p) {
    cscd_detector_destroy(p->detector);
    cscd_mesh_destroy(p->mesh);
    cscd_context_destroy(p->context);
}

/* The distance of the nearest pair of the two panels. */
static double distance_of(const panels *p) {
    cscd_proximities near;
    double least = INFINITY;
    expect_ok(find_near_packed(p->detector, p->x0, 0.3, &near));
    for (size_t i = 0; i < near.count; i++) {
        cscd_stencil s =
            cscd_mesh_stencil(p->mesh, near.items[i].kind, near.items[i].a, near.items[i].b, 0.5, 0.5);
        bool other = (s.vertices[0] < PANEL) != (s.vertices[3] < PANEL);
        if (other) least = fmin(least, near.items[i].distance);
    }
    return least;
}

/* One certified step towards x1, and on to where it ends. */
static cscd_free_step go_on(panels *p) {
    cscd_free_step step;
    straight_motion m = {.mesh = p->mesh, .x0 = p->x0, .x1 = p->x1};
    expect_ok(max_step_find(p->detector, &m, &step));
    memcpy(p->x0, p->detector->reached, sizeof p->x0);
    return step;
}

/* The upper panel falls on the lower one, or leaves it, and both tremble. */
static void aim_panels(panels *p, double fall, double tremble, random_stream *random) {
    for (int i = 0; i < VERTICES * 3; i++) {
        bool upper = i >= PANEL * 3;
        p->x1[i] =
            p->x0[i] + tremble * stream_between(random, -1.0, 1.0) - (upper && i % 3 == 2 ? fall : 0.0);
    }
}

/* ---- pressed together --------------------------------------------------------------------------------- */

static void press_panels(double distance, double height, int steps, double tremble) {
    panels p;
    random_stream random = stream_start((uint64_t)steps);
    open_panels(&p, distance, height);
    double start = distance_of(&p);
    for (int i = 0; i < steps; i++) {
        aim_panels(&p, 0.05, tremble, &random);
        go_on(&p);
        if (i % 100 != 99 && i >= 20) continue;
        assert_true(distance_of(&p) > (start > distance * 1.0001 ? distance : 0.9 * start * (1 - 2e-6)));
    }
    print_message("  d %g: from %.9g d to %.9g d in %d steps\n", distance, start / distance,
                  distance_of(&p) / distance, steps);
    close_panels(&p);
}

TEST(pressed_pairs_lose_no_more_than_a_rung) {
    press_panels(0.01, 0.05, MOST_STEPS, 0.0); /* above d: stays above d */
    press_panels(0.01, 0.05, MOST_STEPS / 5, 1e-3);
    press_panels(0.01, 0.0095, MOST_STEPS, 0.0); /* below: one rung at most, 0.9 d here */
    press_panels(0.01, 0.005, MOST_STEPS / 5, 1e-4);
    press_panels(0.01, 1e-9, MOST_STEPS / 5, 1e-10);
    press_panels(1e-6, 1e-4, MOST_STEPS / 5, 0.0);
}

/* An end that lies between d and what is surely above d is not reached, though volumes part the panels by more than d
 * on the whole way: the next start would find a rung below. */
TEST(ends_are_surely_above) {
    static const double beyond[] = {1e-9, 5e-7, 9e-7, 2e-6};
    for (size_t i = 0; i < 2 * sizeof beyond / sizeof *beyond; i++) {
        panels p;
        random_stream random = stream_start(i);
        open_panels_by(&p, i % 2 == 0 ? CSCD_METHOD_NONE : CSCD_METHOD_BRUTE, 0.01, 0.05);
        aim_panels(&p, 0.05 - 0.01 * (1.0 + beyond[i / 2]), 0.0, &random);
        cscd_free_step step = go_on(&p);
        assert_int_equal(step.limited, beyond[i / 2] < 1e-6);
        assert_true(distance_of(&p) > 0.01 * (1.0 + 1e-6));
        close_panels(&p);
    }
}

/* ---- torn apart ---------------------------------------------------------------------------------------- */

/* Panels much nearer than they should be leave each other at once. */
TEST(torn_panels_part) {
    static const double shares[] = {0.999, 0.5, 1e-3, 1e-7, 1e-9};
    for (size_t i = 0; i < sizeof shares / sizeof *shares; i++) {
        panels p;
        random_stream random = stream_start(i);
        open_panels(&p, 0.01, 0.01 * shares[i]);
        aim_panels(&p, -0.001, 0.0, &random);
        cscd_free_step step = go_on(&p);
        assert_true(step.fraction == 1.0 && !step.limited && step.moved);
        while (p.x0[VERTICES * 3 - 1] < 0.02) {
            aim_panels(&p, -0.001, 0.0, &random);
            assert_true(go_on(&p).fraction == 1.0);
        }
        assert_true(distance_of(&p) > 0.01);
        close_panels(&p);
    }
}

/* A panel at 1e-7 d above another one shivers while both fly and the wound opens slowly: no step is lost. */
TEST(torn_panels_move_on) {
    panels p;
    random_stream random = stream_start(5);
    uint32_t lost = 0;
    open_panels(&p, 0.01, 1e-9);
    for (int i = 0; i < 300; i++) {
        double flight[3];
        aim_panels(&p, 0.0, 0.0, &random);
        for (int k = 0; k < 3; k++) flight[k] = stream_between(&random, -0.1, 0.1);
        for (int c = 0; c < VERTICES * 3; c++) p.x1[c] += flight[c % 3];
        for (int v = PANEL; v < VERTICES; v++) p.x1[3 * v + 2] += 1e-4 * stream_between(&random, 0.0, 1.0);
        cscd_free_step step = go_on(&p);
        lost += !step.moved || step.fraction < 1.0;
    }
    assert_int_equal(lost, 0);
    assert_true(distance_of(&p) > 0.01);
    close_panels(&p);
}

/* ---- touching ------------------------------------------------------------------------------------------ */

/* Only what truly touches is in contact, and the result says what. */
TEST(only_touching_is_in_contact) {
    panels p;
    cscd_free_step step = {.fraction = -1.0};
    open_panels(&p, 0.01, 1e-80);
    memcpy(p.x1, p.x0, sizeof p.x1);
    expect_ok(max_step_packed(p.detector, p.x0, p.x1, NULL, &step));
    assert_true(step.fraction == 1.0 && !step.limited);
    for (int v = PANEL; v < VERTICES; v++) p.x1[3 * v + 2] = 1e-3;
    expect_ok(max_step_packed(p.detector, p.x0, p.x1, NULL, &step));
    assert_true(step.fraction == 1.0 && !step.limited);
    p.x0[3 * PANEL + 2] = 0.0; /* a corner on the lower panel */
    assert_int_equal(max_step_packed(p.detector, p.x0, p.x1, NULL, &step), CSCD_IN_CONTACT);
    assert_true(step.limited && step.fraction == 0.0 && step.limit.toi == 0.0);
    assert_int_equal(step.limit.kind, CSCD_CONTACT_VF);
    assert_int_equal(step.limit.a, PANEL);
    assert_non_null(strstr(cscd_context_detail(p.context), "vertex 9 and triangle"));
    close_panels(&p);
}
