/* Sensors and memory: every allocation fails once, nothing leaks, steady steps allocate nothing; and work
 * grows with the scene, not with its square. */
#include "tests/support/calls.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <string.h>

static scene s; /* large; one test at a time */

typedef struct sensed {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_sensors *sensors;
} sensed;

static cscd_status create_sensed(counting_allocator *counter, cscd_sensor_method method, sensed *out) {
    cscd_context_options options = cscd_context_defaults();
    options.allocator = counting_allocator_interface(counter);
    options.thread_count = 1;
    cscd_sensor_options sensor_options = cscd_sensor_defaults();
    sensor_options.method = method;
    cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    cscd_status status = cscd_context_create(&options, &out->context);
    if (status == CSCD_OK) status = cscd_mesh_create(out->context, &desc, 1, &out->mesh);
    if (status == CSCD_OK)
        status = sensors_create_packed(out->mesh, NULL, s.x0, &sensor_options, &out->sensors);
    return status;
}

static void destroy_sensed(sensed *r) {
    cscd_sensors_destroy(r->sensors);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    *r = (sensed){0};
}

TEST(steady_steps_allocate_nothing) {
    for (int method = 0; method < 2; method++) {
        sensed r = {0};
        counting_allocator counter = counting_allocator_start();
        cscd_warnings found;
        scene_make(SCENE_LINKED_TORI, 2, &s);
        assert_int_equal(create_sensed(&counter, (cscd_sensor_method)method, &r), CSCD_OK);
        for (int frame = 0; frame < 40; frame++) {
            size_t before = counter.calls;
            const double *start = frame % 2 ? s.x1 : s.x0, *end = frame % 2 ? s.x0 : s.x1;
            assert_int_equal(sensors_step_packed(r.sensors, start, end, &found), CSCD_OK);
            if (frame > 20) assert_int_equal(counter.calls, before);
        }
        destroy_sensed(&r);
    }
}

/* ---- what the work grows with ------------------------------------------------------------------------- */

/* Pairs of spheres that come to touch, far from other pairs. */
static cscd_sensor_counters work_of(int pairs) {
    sensed r = {0};
    counting_allocator counter = counting_allocator_start();
    cscd_warnings found;
    scene_clear(&s);
    for (int i = 0; i < 2 * pairs; i++) {
        const double centre[3] = {i % 2 ? 2.05 : 0.0, 40.0 * (i / 2 % 3), 40.0 * (i / 6)};
        uint32_t first = s.vertex_count;
        scene_add_sphere(&s, centre, 1.0, 4, 8);
        for (uint32_t v = first; v < s.vertex_count; v++) s.x1[v * 3] -= i % 2 ? 0.2 : 0.0;
    }
    assert_int_equal(create_sensed(&counter, CSCD_SENSORS_CELLS, &r), CSCD_OK);
    assert_int_equal(sensors_step_packed(r.sensors, s.x0, s.x1, &found), CSCD_OK);
    assert_int_equal(found.count, pairs);
    cscd_sensor_counters counters = cscd_sensors_counters(r.sensors);
    destroy_sensed(&r);
    return counters;
}

static void expect_twice(uint64_t few, uint64_t many) {
    assert_true(few > 0);
    assert_true(many > 3 * few / 2 && many < 5 * few / 2);
}

TEST(work_grows_with_the_scene) {
    cscd_sensor_counters few = work_of(7), many = work_of(14);
    expect_twice(few.vertices, many.vertices);
    expect_twice(few.particle_pairs, many.particle_pairs);
    expect_twice(few.tests, many.tests);
}
