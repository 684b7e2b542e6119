/* Cloth driven by displacement bounds and by planes: each round is a straight motion without contact. */
#include "models/cloth/cloth.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = PACED(90, 60) };

enum { RESOLUTION = 13 };

typedef struct driver_trial {
    cscd_context *context;
    cloth_simulation run;
    cscd_detector *judge; /* finds all contacts */
    double *before;
    uint32_t vertex_count;
} driver_trial;

static driver_trial begin_trial(const char *name, motion_driver driver) {
    driver_trial t = {0};
    io_error error;
    cscd_detector_options options = cscd_detector_defaults();
    assert_int_equal(cscd_context_create(NULL, &t.context), CSCD_OK);
    if (!cloth_open(cloth_scene_find(name), RESOLUTION, driver, t.context, &t.run, &error))
        fail_msg("%s", error.text);
    options.seams = t.run.seams;
    options.seam_count = t.run.seam_count;
    assert_int_equal(detector_create_here(t.run.mesh, NULL, &options, &t.judge), CSCD_OK);
    t.vertex_count = cscd_mesh_vertex_count(t.run.mesh);
    t.before = body_allocate((size_t)t.vertex_count * 3, sizeof *t.before);
    return t;
}

static void end_trial(driver_trial *t) {
    cscd_detector_destroy(t->judge);
    cloth_close(&t->run);
    cscd_context_destroy(t->context);
    free(t->before);
}

static void advance_trial(driver_trial *t) {
    io_error error;
    memcpy(t->before, t->run.positions, (size_t)t->vertex_count * 3 * sizeof *t->before);
    if (!cloth_advance(&t->run, &error)) fail_msg("%s", error.text);
    for (uint32_t i = 0; i < t->run.seam_count; i++)
        assert_memory_equal(t->run.positions + (size_t)t->run.seams[2 * i] * 3,
                            t->run.positions + (size_t)t->run.seams[2 * i + 1] * 3, sizeof(double[3]));
}

static void expect_apart(const driver_trial *t) {
    cscd_intersections crossing;
    cscd_proximities near;
    assert_int_equal(check_packed(t->judge, t->run.positions, &crossing), CSCD_OK);
    assert_int_equal(crossing.count, 0);
    assert_int_equal(
        find_near_packed(t->judge, t->run.positions, cloth_separation(&t->run) * (1.0 - 1e-5), &near),
        CSCD_OK);
    assert_int_equal(near.count, 0);
}

/* No vertex goes farther than its bound; those of obstacles go all their way, or less together. */
static void expect_within_bounds(const driver_trial *t) {
    for (uint32_t v = 0; v < t->vertex_count; v++) {
        double squared = 0.0, bound = t->run.bounded.bounds[v];
        for (size_t i = (size_t)v * 3; i < (size_t)v * 3 + 3; i++)
            squared += (t->run.positions[i] - t->before[i]) * (t->run.positions[i] - t->before[i]);
        assert_true(sqrt(squared) <= bound);
    }
}

/* With one round a frame, the straight motion of the frame is what was certified. */
TEST(single_rounds_have_no_contact) {
    static const char *const scenes[] = {"cloth-drape", "sleeve", "bag"};
    uint32_t shortened = 0;
    for (int i = 0; i < 6; i++) {
        driver_trial t = begin_trial(scenes[i / 2], i % 2 == 0 ? DRIVER_BOUNDS : DRIVER_PLANES);
        t.run.bounded.most_rounds = 1;
        for (int frame = 0; frame < FRAMES; frame++) {
            cscd_contacts found;
            advance_trial(&t);
            if (i % 2 == 0) expect_within_bounds(&t);
            assert_int_equal(step_packed(t.judge, t.before, t.run.positions, &found), CSCD_OK);
            assert_int_equal(found.count, 0);
        }
        expect_apart(&t);
        shortened += t.run.statistics.lost > 0.0;
        end_trial(&t);
    }
    assert_true(shortened >= 4);
}

/* With more rounds most of the motion is left, obstacles hardly wait, and planes need fewer rounds than balls. */
TEST(rounds_leave_most_of_the_motion) {
    uint64_t rounds[DRIVER_COUNT] = {0};
    for (motion_driver driver = DRIVER_BOUNDS; driver < DRIVER_COUNT; driver++) {
        driver_trial t = begin_trial("cloth-drape", driver);
        for (int frame = 0; frame < 2 * FRAMES; frame++) {
            advance_trial(&t);
            if (frame % 10 == 0) expect_apart(&t);
        }
        assert_true(t.run.statistics.lost < 0.02 * t.run.statistics.wanted);
        assert_true(t.run.statistics.waited < 1.0);
        rounds[driver] = t.run.statistics.rounds;
        end_trial(&t);
    }
    assert_true(rounds[DRIVER_PLANES] < rounds[DRIVER_BOUNDS]);
}

/* An obstacle that falls onto a triangle at rest stops before it, as a whole, though only one of its corners is in the
 * way. */
TEST(obstacles_stop_as_a_whole) {
    static const uint32_t triangle[] = {0, 1, 2};
    static const double x0[18] = {-1.0, -1.0, 0.0,  1.0, -1.0, 0.0, 0.0, 1.0, 0.0,
                                  0.0,  0.0,  0.25, 4.0, 0.0,  2.0, 0.0, 4.0, 2.0};
    static const double share_of_gap[DRIVER_COUNT] = {[DRIVER_BOUNDS] = 0.5, [DRIVER_PLANES] = 1.0};
    cscd_object_desc objects[2] = {cscd_object_of_triangles(3, 1, triangle),
                                   cscd_object_of_triangles(3, 1, triangle)};
    objects[1].obstacle = true;
    for (motion_driver driver = DRIVER_BOUNDS; driver < DRIVER_COUNT; driver++) {
        cscd_context *context;
        cscd_mesh *mesh;
        cscd_detector *detector;
        bounded_motion b;
        double x1[18], length;
        assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
        assert_int_equal(cscd_mesh_create(context, objects, 2, &mesh), CSCD_OK);
        assert_int_equal(detector_create_here(mesh, NULL, NULL, &detector), CSCD_OK);
        bounded_motion_open(detector, mesh, driver, 1.0, 3, &b);
        b.most_rounds = 1;
        for (int i = 0; i < 18; i++) x1[i] = x0[i] - (i >= 9 && i % 3 == 2 ? 1.0 : 0.0);
        assert_int_equal(bounded_motion_find(&b, x0, x1, &length), CSCD_OK);
        double way = share_of_gap[driver] * 0.25;
        assert_true(fabs(length - way) < 1e-5);
        assert_memory_equal(x1, x0, 9 * sizeof *x1);
        for (int i = 9; i < 18; i++) assert_true(fabs(x1[i] - x0[i] + (i % 3 == 2 ? way : 0.0)) < 1e-5);
        bounded_motion_close(&b);
        cscd_detector_destroy(detector);
        cscd_mesh_destroy(mesh);
        cscd_context_destroy(context);
    }
}
