/* Compares the contacts that sensors find with those of the detector, on random scenes. Every contact that
 * sensors report must be one. They do not promise to report all; the test prints the share that they reach,
 * and asserts a smaller one. */
#include "tests/support/calls.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { SEEDS = PACED(40, 20), FRAMES = PACED(10, 10) };

static scene s; /* large; one test at a time */
static double x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];

/* The scene's interval is cut into frames, or is one. */
static void positions_at(int frame, int frames, double *x) {
    double t = (double)frame / frames;
    for (uint32_t i = 0; i < s.vertex_count * 3; i++) x[i] = s.x0[i] + t * (s.x1[i] - s.x0[i]);
}

/* Numbers of frames in which two objects touch; of these, those with a warning, with a contact that was
 * found, and with the earliest contact found; and of frames with a warning in which the objects do not touch.
 * */
typedef struct shares {
    uint32_t frames, touching, warned, found, earliest, false_alarms;
} shares;

static uint32_t object_of(const cscd_mesh *mesh, uint32_t vertex) {
    uint32_t count, triangle = cscd_mesh_vertex_triangles(mesh, vertex, &count)[0];
    return cscd_mesh_triangle_component(mesh, triangle);
}

static bool between_objects(const cscd_mesh *mesh, const cscd_contact *c) {
    uint32_t first[3] = {c->a}, second[3];
    if (c->kind == CSCD_CONTACT_VF) {
        cscd_mesh_triangle(mesh, c->b, second);
    } else {
        cscd_mesh_edge(mesh, c->a, first);
        cscd_mesh_edge(mesh, c->b, second);
    }
    return object_of(mesh, first[0]) != object_of(mesh, second[0]);
}

/* INFINITY: the two objects do not touch. */
static double true_toi(const sensor_rig *r, cscd_detector *detector) {
    cscd_contacts contacts;
    double first = INFINITY;
    assert_int_equal(step_packed(detector, x0, x1, &contacts), CSCD_OK);
    for (size_t i = 0; i < contacts.count; i++)
        if (between_objects(r->mesh, &contacts.items[i])) first = fmin(first, contacts.items[i].toi);
    return first;
}

static double nearest_vertices(const sensor_rig *r, const double *x) {
    double least = INFINITY;
    for (uint32_t a = 0; a < s.vertex_count; a++) {
        for (uint32_t b = 0; b < a; b++) {
            double d[3], squared = 0.0;
            for (uint32_t k = 0; k < 3; k++) d[k] = x[a * 3 + k] - x[b * 3 + k];
            for (int k = 0; k < 3; k++) squared += d[k] * d[k];
            if (squared < least && object_of(r->mesh, a) != object_of(r->mesh, b)) least = squared;
        }
    }
    return sqrt(least);
}

static void look_at_frame(const sensor_rig *r, cscd_detector *detector, shares *sum) {
    cscd_warnings warnings = sensor_rig_step(r, x0, x1);
    const cscd_warning *warning = find_warning(&warnings, 0, 1), *found = find_contact(&warnings, 0, 1);
    double toi = true_toi(r, detector);
    bool touching = toi < INFINITY;
    if (found != NULL) assert_true(touching && found->toi >= toi);
    sum->frames++;
    sum->touching += touching;
    sum->warned += touching && warning != NULL;
    sum->found += found != NULL;
    sum->earliest += found != NULL && found->toi == toi;
    sum->false_alarms += !touching && warning != NULL;
}

/* Shares, in percent, that a method reaches on every family. */
typedef struct recall_bound {
    uint32_t warned, found, earliest;
} recall_bound;

static void assert_recall(const shares *sum, recall_bound least) {
    assert_true(100 * sum->warned >= least.warned * sum->touching);
    assert_true(100 * sum->found >= least.found * sum->touching);
    assert_true(100 * sum->earliest >= least.earliest * sum->touching);
}

static void count_family(scene_family family, const sensor_setup *setup, const char *how,
                         recall_bound least) {
    shares sum = {0};
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        cscd_detector *detector;
        scene_make(family, seed, &s);
        sensor_rig r = sensor_rig_create(&s, setup);
        assert_int_equal(detector_create_here(r.mesh, NULL, NULL, &detector), CSCD_OK);
        for (int f = 0; f < FRAMES; f++) {
            positions_at(f, FRAMES, x0);
            positions_at(f + 1, FRAMES, x1);
            look_at_frame(&r, detector, &sum);
        }
        cscd_detector_destroy(detector);
        sensor_rig_destroy(&r);
    }
    assert_true(sum.touching > 10);
    print_message("%-14s %-6s of %u frames %3u touch, of these %3u warned of, %3u found, %3u earliest; %3u "
                  "false alarms\n",
                  scene_family_name(family), how, sum.frames, sum.touching, sum.warned, sum.found,
                  sum.earliest, sum.false_alarms);
    assert_recall(&sum, least);
}

/* When the shares were set, sensors in cells reached 100 % of all three. Random ones reached at least 95, 68
 * and 43 %. */
TEST(most_contacts_are_found_and_all_are_true) {
    static const scene_family families[] = {SCENE_TWO_SPHERES, SCENE_NESTED_SPHERES, SCENE_LINKED_TORI};
    cscd_sensor_options random = cscd_sensor_defaults();
    random.method = CSCD_SENSORS_RANDOM;
    sensor_setup with_plan = {8, NULL}, older = {0, &random};
    for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
        count_family(families[f], NULL, "cells", (recall_bound){98, 95, 90});
        count_family(families[f], &with_plan, "plan", (recall_bound){98, 95, 90});
        count_family(families[f], &older, "random", (recall_bound){85, 55, 30});
    }
}

/* With a particle on every vertex, the default mu misses no contact, however fast objects fly. */
static bool expect_found(const sensor_rig *r) {
    cscd_detector *detector;
    assert_int_equal(detector_create_here(r->mesh, NULL, NULL, &detector), CSCD_OK);
    double toi = true_toi(r, detector);
    cscd_warnings warnings = sensor_rig_step(r, x0, x1);
    const cscd_warning *warning = find_warning(&warnings, 0, 1), *found = find_contact(&warnings, 0, 1);
    if (toi < INFINITY) {
        assert_non_null(found);
        assert_true(found->toi == toi);
    }
    if (warning != NULL) {
        double nearest = fmin(nearest_vertices(r, x0), nearest_vertices(r, x1));
        assert_true(fabs(warning->distance - nearest) <= 1e-12);
    }
    cscd_detector_destroy(detector);
    return toi < INFINITY;
}

TEST(mu_is_sound) {
    static const scene_family families[] = {SCENE_TWO_SPHERES, SCENE_NESTED_SPHERES, SCENE_LINKED_TORI};
    cscd_sensor_options cells = cscd_sensor_defaults();
    uint32_t touching = 0;
    cells.cells = SCENE_VERTICES_MAX;
    sensor_setup setup = {0, &cells};
    for (uint64_t seed = 1; seed <= 60; seed++) {
        scene_make(families[seed % 3], seed, &s);
        sensor_rig r = sensor_rig_create(&s, &setup);
        assert_int_equal(cscd_sensors_cell_count(r.sensors), s.vertex_count);
        int frames = seed % 2 ? 1 : 6, frame = seed % 2 ? 0 : (int)(seed / 2 % 6);
        positions_at(frame, frames, x0);
        positions_at(frame + 1, frames, x1);
        touching += expect_found(&r);
        sensor_rig_destroy(&r);
    }
    assert_true(touching > 10);
}
