/* Particle sensors: options, cells, repetition, mu and R_eff, renewal, and what is found on random scenes. */
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene s; /* large; one test at a time */

static void two_spheres(double gap) {
    const double left[3] = {-1.0 - gap / 2, 0, 0}, right[3] = {1.0 + gap / 2, 0, 0};
    scene_clear(&s);
    scene_add_sphere(&s, left, 1.0, 9, 14);
    scene_add_sphere(&s, right, 1.0, 9, 14);
}

static double vertex_distance(const double *x, uint32_t a, uint32_t b) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        double d = x[a * 3 + (uint32_t)k] - x[b * 3 + (uint32_t)k];
        sum += d * d;
    }
    return sqrt(sum);
}

/* ---- options ------------------------------------------------------------------------------------------ */

static void expect_refused(const sensor_rig *r, const cscd_sensor_options *options, const char *name) {
    cscd_sensors *made = NULL;
    assert_int_equal(sensors_create_packed(r->mesh, NULL, s.x0, options, &made), CSCD_INVALID_ARGUMENT);
    assert_null(made);
    assert_non_null(strstr(cscd_context_detail(r->context), name));
}

TEST(bad_options_are_named) {
    two_spheres(1.0);
    sensor_rig r = sensor_rig_create(&s, NULL);
    static const double bad_lengths[] = {-1.0, NAN, INFINITY, 1e-200, 1e200};
    cscd_sensor_options o;
    for (size_t i = 0; i < sizeof bad_lengths / sizeof *bad_lengths; i++) {
        o = cscd_sensor_defaults(), o.collision_distance = bad_lengths[i];
        expect_refused(&r, &o, "collision_distance");
        o = cscd_sensor_defaults(), o.effective_radius = bad_lengths[i];
        expect_refused(&r, &o, "effective_radius");
    }
    o = cscd_sensor_defaults(), o.collision_distance = 0.5, o.effective_radius = 0.4;
    expect_refused(&r, &o, "effective_radius");
    o = cscd_sensor_defaults(), o.struct_size--;
    expect_refused(&r, &o, "cscd_sensor_defaults");
    o = cscd_sensor_defaults(), o.method = (cscd_sensor_method)2;
    expect_refused(&r, &o, "method");
    o = cscd_sensor_defaults(), o.step_limit = 0;
    expect_refused(&r, &o, "step_limit");
    o = cscd_sensor_defaults(), o.particles = 0;
    expect_refused(&r, &o, "particles");
    static const double bad_factors[] = {0.5, -1.0, NAN, INFINITY};
    for (size_t i = 0; i < sizeof bad_factors / sizeof *bad_factors; i++) {
        o = cscd_sensor_defaults(), o.area_factor = bad_factors[i];
        expect_refused(&r, &o, "area_factor");
    }
    sensor_rig_destroy(&r);
}

TEST(bad_arguments_are_named) {
    two_spheres(1.0);
    sensor_rig r = sensor_rig_create(&s, NULL);
    cscd_sensors *made = NULL;
    cscd_warnings found;
    assert_int_equal(sensors_create_packed(NULL, NULL, s.x0, NULL, &made), CSCD_NULL_OBJECT);
    assert_int_equal(sensors_create_packed(r.mesh, NULL, s.x0, NULL, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(sensors_create_packed(r.mesh, NULL, NULL, NULL, &made), CSCD_INVALID_ARGUMENT);
    assert_null(made);
    assert_int_equal(sensors_step_packed(NULL, s.x0, s.x0, &found), CSCD_NULL_OBJECT);
    assert_int_equal(sensors_step_packed(r.sensors, s.x0, s.x0, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(sensors_step_packed(r.sensors, NULL, s.x0, &found), CSCD_INVALID_ARGUMENT);
    s.x1[7] = NAN;
    assert_int_equal(sensors_step_packed(r.sensors, s.x0, s.x1, &found), CSCD_INVALID_ARGUMENT);
    assert_non_null(strstr(cscd_context_detail(r.context), "x1"));
    sensor_rig_destroy(&r);
}

/* ---- particles ---------------------------------------------------------------------------------------- */

static void expect_in_cells(const sensor_rig *r) {
    uint32_t count = cscd_sensors_particle_count(r->sensors);
    assert_int_equal(count, cscd_sensors_cell_count(r->sensors));
    for (uint32_t i = 0; i < count; i++) {
        uint32_t vertex = cscd_sensors_particle(r->sensors, i);
        assert_int_equal(cscd_sensors_vertex_cell(r->sensors, vertex), i);
    }
}

TEST(particles_stay_in_their_cells) {
    for (uint64_t seed = 1; seed < 30; seed++) {
        scene_make(seed % 2 ? SCENE_LINKED_TORI : SCENE_NESTED_SPHERES, seed, &s);
        cscd_sensor_options cells = cscd_sensor_defaults();
        cells.within = seed % 3 == 0;
        sensor_setup setup = {seed % 4 ? 6 : 0, &cells};
        sensor_rig r = sensor_rig_create(&s, &setup);
        sensor_rig_step(&r, s.x0, s.x1);
        expect_in_cells(&r);
        sensor_rig_step(&r, s.x1, s.x0);
        expect_in_cells(&r);
        sensor_rig_destroy(&r);
    }
}

static void same_warnings(const cscd_warnings *a, const cscd_warning *items, size_t count) {
    assert_int_equal(a->count, count);
    for (size_t i = 0; i < count; i++) {
        const cscd_warning *v = &a->items[i], *w = &items[i];
        assert_int_equal(v->part_a, w->part_a);
        assert_int_equal(v->part_b, w->part_b);
        assert_int_equal(v->vertex_a, w->vertex_a);
        assert_int_equal(v->vertex_b, w->vertex_b);
        assert_true(v->distance == w->distance && v->time == w->time && v->toi == w->toi);
        assert_int_equal(v->contact, w->contact);
    }
}

/* Two creations give the same bits, in every frame. */
TEST(results_are_repeated) {
    for (int method = 0; method < 2; method++) {
        cscd_sensor_options options = cscd_sensor_defaults();
        options.method = (cscd_sensor_method)method;
        sensor_setup setup = {6, &options};
        scene_make(SCENE_LINKED_TORI, 3, &s);
        sensor_rig r = sensor_rig_create(&s, &setup), other = sensor_rig_create(&s, &setup);
        for (int frame = 0; frame < 6; frame++) {
            const double *start = frame % 2 ? s.x1 : s.x0, *end = frame % 2 ? s.x0 : s.x1;
            cscd_warnings found = sensor_rig_step(&r, start, end);
            cscd_warnings again = sensor_rig_step(&other, start, end);
            same_warnings(&again, found.items, found.count);
            cscd_sensor_counters a = cscd_sensors_counters(r.sensors);
            cscd_sensor_counters b = cscd_sensors_counters(other.sensors);
            assert_memory_equal(&a, &b, sizeof a);
        }
        sensor_rig_destroy(&other);
        sensor_rig_destroy(&r);
    }
}

/* A step that fails leaves the particles where they were, and in a second step at rest they walk nowhere. */
TEST(walks_begin_where_they_ended) {
    two_spheres(0.05);
    sensor_rig r = sensor_rig_create(&s, NULL);
    cscd_warnings found = sensor_rig_step(&r, s.x0, s.x0);
    assert_int_equal(found.count, 1);
    cscd_sensor_counters first = cscd_sensors_counters(r.sensors);
    double nearest = found.items[0].distance;
    found = sensor_rig_step(&r, s.x0, s.x0);
    cscd_sensor_counters second = cscd_sensors_counters(r.sensors);
    assert_true(first.rounds > 2 * 2);
    assert_int_equal(second.rounds, 2 + 2 * second.cycles);
    assert_true(found.items[0].distance <= nearest);
    sensor_rig_destroy(&r);
}

/* ---- mu and R_eff ------------------------------------------------------------------------------------- */

/* The distance at which particles come to rest does not depend on mu, where R_eff is given. */
static cscd_warnings step_with(double mu, sensor_rig *r) {
    cscd_sensor_options options = cscd_sensor_defaults();
    options.collision_distance = mu;
    options.effective_radius = 6.0;
    sensor_setup setup = {0, &options};
    *r = sensor_rig_create(&s, &setup);
    return sensor_rig_step(r, s.x0, s.x0);
}

TEST(a_given_mu_is_taken) {
    sensor_rig r;
    two_spheres(0.2);
    cscd_warnings found = step_with(1.0, &r);
    assert_int_equal(found.count, 1);
    double resting = found.items[0].distance;
    assert_true(fabs(resting - vertex_distance(s.x0, found.items[0].vertex_a, found.items[0].vertex_b)) <
                1e-12);
    assert_false(found.items[0].contact);
    sensor_rig_destroy(&r);
    found = step_with(resting * 1.001, &r);
    assert_int_equal(found.count, 1);
    assert_true(found.items[0].distance == resting);
    sensor_rig_destroy(&r);
    found = step_with(resting * 0.999, &r);
    assert_int_equal(found.count, 0);
    sensor_rig_destroy(&r);
}

/* One sphere comes nearer, or goes: the warning is of the moment at which the particles were nearer. */
TEST(the_nearer_moment_is_told) {
    for (uint32_t end = 0; end < 2; end++) {
        two_spheres(0.2);
        double *apart = end == 0 ? s.x1 : s.x0;
        for (uint32_t v = s.vertex_count / 2; v < s.vertex_count; v++) apart[v * 3] += 0.5;
        cscd_sensor_options options = cscd_sensor_defaults();
        options.collision_distance = 1.0;
        sensor_setup setup = {0, &options};
        sensor_rig r = sensor_rig_create(&s, &setup);
        cscd_warnings found = sensor_rig_step(&r, s.x0, s.x1);
        assert_int_equal(found.count, 1);
        const cscd_warning *w = found.items;
        assert_true(w->time == end && w->part_a < w->part_b);
        assert_true(fabs(w->distance - vertex_distance(end == 0 ? s.x0 : s.x1, w->vertex_a, w->vertex_b)) <
                    1e-12);
        sensor_rig_destroy(&r);
    }
}

/* Particles walk when R_eff reaches the other object, and rest when it does not. */
TEST(a_given_radius_is_taken) {
    two_spheres(1.0);
    for (int wider = 0; wider < 2; wider++) {
        cscd_sensor_options options = cscd_sensor_defaults();
        options.collision_distance = 0.1;
        options.effective_radius = wider ? 6.0 : 0.9;
        sensor_setup setup = {0, &options};
        sensor_rig r = sensor_rig_create(&s, &setup);
        sensor_rig_step(&r, s.x0, s.x0);
        cscd_sensor_counters counters = cscd_sensors_counters(r.sensors);
        assert_int_equal(counters.particle_pairs > 0, wider);
        assert_int_equal(counters.rounds > 2, wider);
        sensor_rig_destroy(&r);
    }
}

/* ---- V: particles that all begin on one arm (figure 2-20) ---------------------------------------------- */

enum { V_FRAMES = 12 };

static uint32_t make_v(void) {
    static const double corners[3][3] = {{-2, 3, 0}, {0, 0, 0}, {2, 3, 0}};
    static const double ball[3] = {-4.0, 2.4, 0};
    scene_clear(&s);
    scene_add_bent_tube(&s, corners, 3, 0.3, 0.2);
    uint32_t first = s.vertex_count;
    scene_add_sphere(&s, ball, 0.5, 7, 12);
    return first;
}

/* Moves the ball into the left arm, and tells whether the sensors find the contact. */
static bool sensed_on_the_left(const sensor_rig *r, uint32_t first) {
    static double x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];
    static const double by[3] = {0.15, 0, 0};
    bool sensed = false;
    memcpy(x1, s.x0, sizeof x1);
    for (int f = 0; f < V_FRAMES; f++) {
        memcpy(x0, x1, sizeof x0);
        shift_vertices(first, s.vertex_count, by, x1);
        cscd_warnings found = sensor_rig_step(r, x0, x1);
        sensed |= find_contact(&found, 0, 1) != NULL;
    }
    return sensed;
}

static bool all_on_the_right(const sensor_rig *r, uint32_t first) {
    uint32_t own = 0, right = 0;
    for (uint32_t i = 0; i < cscd_sensors_particle_count(r->sensors); i++) {
        uint32_t vertex = cscd_sensors_particle(r->sensors, i);
        own += vertex < first;
        right += vertex < first && s.x0[vertex * 3] > 0.5;
    }
    return right == own;
}

TEST(cells_do_not_miss_an_arm) {
    uint32_t first = make_v(), one_sided = 0, missed = 0;
    sensor_rig r = sensor_rig_create(&s, NULL);
    assert_true(sensed_on_the_left(&r, first));
    sensor_rig_destroy(&r);
    for (uint32_t seed = 1; seed <= 60; seed++) {
        cscd_sensor_options options = cscd_sensor_defaults();
        options.method = CSCD_SENSORS_RANDOM;
        options.particles = 3;
        options.seed = seed;
        options.effective_radius = 1.2;
        sensor_setup setup = {0, &options};
        r = sensor_rig_create(&s, &setup);
        if (all_on_the_right(&r, first)) {
            one_sided++;
            missed += !sensed_on_the_left(&r, first);
        }
        sensor_rig_destroy(&r);
    }
    print_message("%u of 60 begin on the right arm only, %u of these miss\n", one_sided, missed);
    assert_true(one_sided > 0);
    assert_true(missed > 0);
}

/* With repulsion all over the object, particles do not stay on one arm. */
TEST(repulsion_spreads_them) {
    uint32_t first = make_v(), one_sided = 0;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        cscd_sensor_options options = cscd_sensor_defaults();
        options.method = CSCD_SENSORS_RANDOM;
        options.particles = 3;
        options.seed = seed;
        sensor_setup setup = {0, &options};
        sensor_rig r = sensor_rig_create(&s, &setup);
        sensor_rig_step(&r, s.x0, s.x0);
        double least = INFINITY;
        for (uint32_t i = 0; i < 3; i++)
            for (uint32_t j = 0; j < i; j++)
                least = fmin(least, vertex_distance(s.x0, cscd_sensors_particle(r.sensors, i),
                                                    cscd_sensors_particle(r.sensors, j)));
        assert_true(least > 0.6);
        one_sided += all_on_the_right(&r, first);
        sensor_rig_destroy(&r);
    }
    assert_int_equal(one_sided, 0);
}

/* ---- renewed cells ------------------------------------------------------------------------------------ */

TEST(new_cells_are_taken_up) {
    scene_make(SCENE_LINKED_TORI, 1, &s);
    sensor_rig r = sensor_rig_create(&s, NULL);
    sensor_rig_step(&r, s.x0, s.x0);
    for (uint32_t v = 0; v < s.vertex_count; v++) { /* it grows along x */
        memcpy(s.x1 + v * 3, s.x0 + v * 3, sizeof(double[3]));
        s.x1[v * 3] *= 4.0;
    }
    cscd_warnings found = sensor_rig_step(&r, s.x0, s.x1);
    assert_true(found.renewals_due > 0);
    uint32_t due = 0;
    for (uint32_t p = 0; p < cscd_sensors_part_count(r.sensors); p++) {
        if (cscd_sensors_renewal(r.sensors, p) == CSCD_RENEWAL_NONE) continue;
        due++;
        assert_int_equal(sensors_renew_packed(r.sensors, s.x1, p), CSCD_OK);
    }
    assert_int_equal(due, found.renewals_due);
    found = sensor_rig_step(&r, s.x1, s.x1);
    assert_int_equal(found.renewals_due, 0);
    expect_in_cells(&r);
    sensor_rig_destroy(&r);
}

/* ---- obstacles ---------------------------------------------------------------------------------------- */

/* Returns how many pairs of particles feel each other, if the objects of the mask are obstacles. */
static uint64_t pairs_with(uint32_t mask) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_sensors *sensors = NULL;
    cscd_object_desc objects[2];
    cscd_warnings found;
    two_spheres(0.05); /* the second has the same triangles, with numbers of its own */
    for (uint32_t i = 0; i < 2; i++) {
        objects[i] = cscd_object_of_triangles(s.vertex_count / 2, s.triangle_count / 2, s.triangles);
        objects[i].obstacle = (mask >> i & 1) != 0;
    }
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, objects, 2, &mesh), CSCD_OK);
    assert_int_equal(sensors_create_packed(mesh, NULL, s.x0, NULL, &sensors), CSCD_OK);
    assert_int_equal(sensors_step_packed(sensors, s.x0, s.x0, &found), CSCD_OK);
    const uint64_t pairs = cscd_sensors_counters(sensors).particle_pairs;
    assert_int_equal(found.count > 0, pairs > 0);
    cscd_sensors_destroy(sensors);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return pairs;
}

TEST(obstacles_do_not_feel_each_other) {
    for (uint32_t mask = 0; mask < 3; mask++) assert_true(pairs_with(mask) > 0);
    assert_int_equal(pairs_with(3), 0);
}
