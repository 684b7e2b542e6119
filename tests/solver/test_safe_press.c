/* Motions made safe of a sheet between a floor and a lid: whatever a solver asks for, nothing touches on the way, nothing is
 * changed without need, and what is pressed comes free again. */
#include "models/cloth/cloth_scene.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 9 };

static const double separation = 0.01;

/* A sheet of width 1 at z = 0 above a floor, below a box with its lower side `above` the sheet. */
typedef struct press {
    body sheet, box;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *judge;              /* finds all contacts */
    cscd_detector *detector;           /* with a separation */
    uint32_t vertex_count, floor, lid; /* first vertices of the obstacles */
    double *inverse_masses, *x0, *x1;
    cscd_safe_motion safe;
} press;

static const double box_height = 0.2;

static press make_press(double below, double above) {
    press p = {0};
    garment_add_sheet(&p.sheet, SIDE, 1.0);
    garment_add_box(&p.box, 2.0);
    cscd_object_desc objects[3] = {
        cscd_object_of_triangles(p.sheet.vertex_count, p.sheet.triangle_count, p.sheet.triangles),
        cscd_object_of_triangles(p.box.vertex_count, p.box.triangle_count, p.box.triangles),
        cscd_object_of_triangles(p.box.vertex_count, p.box.triangle_count, p.box.triangles)};
    objects[1].obstacle = objects[2].obstacle = true;
    assert_int_equal(cscd_context_create(NULL, &p.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(p.context, objects, 3, &p.mesh), CSCD_OK);
    assert_int_equal(detector_create_here(p.mesh, NULL, NULL, &p.judge), CSCD_OK);
    p.vertex_count = cscd_mesh_vertex_count(p.mesh);
    p.floor = p.sheet.vertex_count;
    p.lid = p.floor + p.box.vertex_count;
    p.inverse_masses = body_allocate(p.vertex_count, sizeof *p.inverse_masses);
    p.x0 = body_allocate(p.vertex_count * 3, sizeof *p.x0);
    p.x1 = body_allocate(p.vertex_count * 3, sizeof *p.x1);
    for (uint32_t v = 0; v < p.floor; v++) p.inverse_masses[v] = 1.0 + v % 3;
    memcpy(p.x0, p.sheet.positions, p.floor * 3 * sizeof *p.x0);
    memcpy(p.x0 + p.floor * 3, p.box.positions, 24 * sizeof *p.x0);
    memcpy(p.x0 + p.lid * 3, p.box.positions, 24 * sizeof *p.x0);
    for (uint32_t v = p.floor; v < p.lid; v++) p.x0[v * 3 + 2] -= below;
    for (uint32_t v = p.lid; v < p.vertex_count; v++) p.x0[v * 3 + 2] += box_height + above;
    memcpy(p.x1, p.x0, p.vertex_count * 3 * sizeof *p.x1);
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = separation;
    assert_int_equal(detector_create_here(p.mesh, NULL, &options, &p.detector), CSCD_OK);
    return p;
}

static void free_press(press *p) {
    cscd_detector_destroy(p->detector);
    cscd_detector_destroy(p->judge);
    cscd_mesh_destroy(p->mesh);
    cscd_context_destroy(p->context);
    body_free(&p->sheet);
    body_free(&p->box);
    free(p->inverse_masses);
    free(p->x0);
    free(p->x1);
}

/* Makes the motion safe, checks it, and moves to its end. Returns the share of the obstacles. */
static double go_on(press *p) {
    cscd_contacts found;
    cscd_response_options options = cscd_response_defaults();
    options.inverse_masses = p->inverse_masses;
    cscd_intersections intersections;
    assert_int_equal(make_safe_packed(p->detector, p->x0, p->x1, &options, p->x1, &p->safe), CSCD_OK);
    assert_true(p->safe.obstacle_share >= 0.0 && p->safe.obstacle_share <= 1.0);
    assert_int_equal(step_packed(p->judge, p->x0, p->x1, &found), CSCD_OK);
    assert_int_equal(found.count, 0);
    assert_int_equal(check_packed(p->judge, p->x1, &intersections), CSCD_OK);
    assert_int_equal(intersections.count, 0);
    memcpy(p->x0, p->x1, p->vertex_count * 3 * sizeof *p->x0);
    return p->safe.obstacle_share;
}

static void lift_vertices(press *p, uint32_t first, uint32_t last, double by) {
    for (uint32_t v = first; v < last; v++) p->x1[v * 3 + 2] += by;
}

TEST(free_motions_are_left_alone) {
    press p = make_press(0.3, 0.3);
    random_stream random = stream_start(3);
    for (uint32_t i = 0; i < p.floor * 3; i++) p.x1[i] += stream_between(&random, -0.02, 0.02);
    lift_vertices(&p, p.lid, p.vertex_count, -0.1);
    double *wanted = body_allocate(p.vertex_count * 3, sizeof *wanted);
    memcpy(wanted, p.x1, p.vertex_count * 3 * sizeof *wanted);
    assert_true(go_on(&p) == 1.0);
    assert_memory_equal(wanted, p.x1, p.vertex_count * 3 * sizeof *wanted);
    assert_int_equal(p.safe.rounds, 1);
    free(wanted);
    free_press(&p);
}

/* The sheet stops at the floor, not nearer than the separation, and keeps its motion along the floor. */
TEST(what_falls_stops_at_the_floor) {
    press p = make_press(0.1, 1.0);
    lift_vertices(&p, 0, p.floor, -0.5);
    for (uint32_t v = 0; v < p.floor; v++) p.x1[v * 3] += 0.2;
    assert_true(go_on(&p) == 1.0);
    assert_true(p.safe.rounds > 1);
    assert_int_equal(p.safe.response_counts[CSCD_RESPONSE_TRUNCATED], 0);
    for (uint32_t v = 0; v < p.floor; v++) {
        assert_true(p.x0[v * 3 + 2] > -0.1 + separation && p.x0[v * 3 + 2] < -0.04);
        assert_true(fabs(p.x0[v * 3] - p.sheet.positions[v * 3] - 0.2) < 0.03);
    }
    free_press(&p);
}

/* Vertices jump by more than an edge, again and again: the sheet ends in a tangle without intersections. */
TEST(shaken_sheets_never_intersect) {
    for (uint64_t seed = 0; seed < 2; seed++) {
        press p = make_press(0.3, 0.3);
        random_stream random = stream_start(seed);
        int cut = 0;
        for (int motion = 0; motion < 15; motion++) {
            for (uint32_t i = 0; i < p.floor * 3; i++) p.x1[i] += stream_between(&random, -0.3, 0.3);
            go_on(&p);
            cut += p.safe.rounds > 1;
            assert_int_equal(p.safe.truncations,
                             0); /* features stop before the planes between them, all of their vertices */
        }
        assert_true(cut > 10);
        free_press(&p);
    }
}

/* The lid is asked to move through sheet and floor, and waits above the sheet. Then it moves up again, and
 * everything comes free. */
TEST(obstacles_wait_for_what_they_press) {
    press p = make_press(0.05, 0.05);
    double way = 0.0;
    int caught = 0;
    for (int motion = 0; motion < 40; motion++) {
        memcpy(p.x1, p.x0, p.vertex_count * 3 * sizeof *p.x1);
        lift_vertices(&p, p.lid, p.vertex_count, -0.03);
        way += 0.03 * go_on(&p);
        caught += p.safe.response_counts[CSCD_RESPONSE_TRUNCATED] > 0;
    }
    assert_true(way > 0.0799 && way < 0.0801); /* what both separations leave */
    assert_true(caught > 10);
    double lid = p.x0[p.lid * 3 + 2], floor = p.x0[(p.floor + 7) * 3 + 2];
    assert_true(lid > floor && lid < floor + 4.0 * separation);
    for (int motion = 0; motion < 3; motion++) {
        lift_vertices(&p, p.lid, p.vertex_count, 0.03);
        for (uint32_t v = 0; v < p.floor; v++) p.x1[v * 3 + 2] += 0.01;
        assert_true(go_on(&p) == 1.0);
    }
    assert_true(p.x0[p.lid * 3 + 2] > lid + 0.08);
    free_press(&p);
}

/* A sheet that moves as a whole while it folds onto itself keeps its momentum. */
TEST(what_meets_itself_keeps_its_momentum) {
    press p = make_press(5.0, 5.0);
    double wanted[3] = {0.0}, got[3] = {0.0};
    for (uint32_t v = 0; v < p.floor; v++) {
        double *x = p.x1 + v * 3; /* one half folds onto the other, and through it */
        if (x[0] > 0.1) x[2] += 0.4;
        if (x[0] > 0.3) x[0] -= 0.9, x[2] -= 0.8;
        x[1] += 0.5;
        for (int k = 0; k < 3; k++) wanted[k] += (x[k] - p.x0[v * 3 + (uint32_t)k]) / p.inverse_masses[v];
    }
    double length = go_on(&p);
    assert_true(length == 1.0);
    assert_true(p.safe.rounds > 1);
    for (uint32_t i = 0; i < p.floor * 3; i++)
        got[i % 3] += (p.x0[i] - p.sheet.positions[i]) / p.inverse_masses[i / 3];
    for (int k = 0; k < 3; k++) assert_true(fabs(wanted[k] - got[k]) < 1e-12 * SIDE * SIDE);
    free_press(&p);
}

/* ---- integrators --------------------------------------------------------------------------------------- */

typedef enum integrator { POSITION_BASED, EXPLICIT_EULER, VERLET, INTEGRATOR_COUNT } integrator;

/* The free vertices of one simulation: velocities, or where they were a frame ago, and the end that they wanted. */
typedef struct fall {
    double velocity[SIDE * SIDE * 3], before[SIDE * SIDE * 3], wanted[SIDE * SIDE * 3];
} fall;

static const double dt = 1.0 / 60.0, gravity = -9.81;

/* As docs/solver/first-contact.md says it. */
static void move_frame(press *p, integrator by, fall *f) {
    const uint32_t count = p->floor * 3;
    for (uint32_t i = 0; i < count; i++) {
        double pull = i % 3 == 2 ? gravity * dt : 0.0;
        if (by == VERLET) {
            p->x1[i] = 2.0 * p->x0[i] - f->before[i] + pull * dt;
        } else {
            f->velocity[i] += pull;
            p->x1[i] = p->x0[i] + f->velocity[i] * dt;
        }
        f->wanted[i] = p->x1[i];
        f->before[i] = p->x0[i];
    }
    assert_true(go_on(p) == 1.0);
    for (uint32_t i = 0; i < count; i++) {
        if (by == POSITION_BASED) f->velocity[i] = (p->x0[i] - f->before[i]) / dt;
        if (by == EXPLICIT_EULER) f->velocity[i] += (p->x0[i] - f->wanted[i]) / dt;
    }
}

TEST(every_integrator_comes_to_rest) {
    for (int by = 0; by < INTEGRATOR_COUNT; by++) {
        press p = make_press(0.2, 1.0);
        fall f = {.velocity = {0.0}};
        memcpy(f.before, p.x0, sizeof f.before);
        for (int frame = 0; frame < 60; frame++) move_frame(&p, (integrator)by, &f);
        for (uint32_t v = 0; v < p.floor; v++) {
            double height = p.x0[v * 3 + 2] + 0.2;
            assert_true(height > separation && height < 3.0 * separation);
            assert_true(fabs(p.x0[v * 3 + 2] - f.before[v * 3 + 2]) < 0.1 * separation);
        }
        free_press(&p);
    }
}
