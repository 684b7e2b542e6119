/* What sensors have in common with every object: they hold what they were made from, are refused within a call of their context,
 * fit a small stack, take triangles alone, and are checked for planted faults. */
#include "sensors/sensors.h"
#include "tests/support/calls.h"
#include "tests/support/panels.h"
#include "tests/support/rig.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <string.h>

static scene s; /* large; one test at a time */

/* ---- lifetimes ----------------------------------------------------------------------------------------- */

/* The mesh is of another context, and all that the sensors were made from goes before them. */
TEST(they_outlive_mesh_and_plan) {
    counting_allocator of_home = counting_allocator_start(), of_guest = counting_allocator_start();
    cscd_context *home = context_of(1, &of_home), *guest = context_of(3, &of_guest);
    cscd_plan_options by_kmeans = cscd_plan_defaults();
    by_kmeans.method = CSCD_METHOD_KMEANS;
    cscd_plan *plan;
    cscd_sensors *sensors;
    cscd_warnings warnings;
    scene_make(SCENE_LINKED_TORI, 1, &s);
    cscd_mesh *mesh = mesh_of_scene(home, &s);
    const size_t home_calls = of_home.calls;
    const cscd_view *x0 = CSCD_DOUBLES(s.x0, s.vertex_count), *x1 = CSCD_DOUBLES(s.x1, s.vertex_count);
    expect_ok(cscd_plan_create(guest, mesh, x0, &by_kmeans, &plan));
    expect_ok(cscd_sensors_create(guest, mesh, plan, x0, NULL, &sensors));
    assert_int_equal(of_home.calls, home_calls);
    cscd_context_destroy(home);
    cscd_mesh_destroy(mesh);
    cscd_plan_destroy(plan);
    cscd_context_destroy(guest);
    for (int i = 0; i < 3; i++) {
        expect_ok(cscd_sensors_step(sensors, x0, x1, &warnings));
        assert_true(warnings.count > 0);
        expect_ok(cscd_sensors_renew(sensors, x1, UINT32_MAX));
    }
    assert_true(of_home.live > 0);
    cscd_sensors_destroy(sensors);
    assert_int_equal(of_home.live, 0);
    assert_int_equal(of_guest.live, 0);
}

/* ---- within a call ------------------------------------------------------------------------------------- */

typedef struct calling_host {
    panel_scene p;
    cscd_sensors *sensors;
    uint32_t calls, wrong;
} calling_host;

static bool ignore_none(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    calling_host *h = user;
    const cscd_view *x = CSCD_DOUBLES(h->p.x0, h->p.vertex_count);
    cscd_sensors *made = NULL;
    cscd_warnings warnings;
    if (h->calls++ == 2) {
        h->wrong += cscd_sensors_create(h->p.context, h->p.mesh, NULL, x, NULL, &made) != CSCD_BUSY;
        h->wrong += cscd_sensors_step(h->sensors, x, x, &warnings) != CSCD_BUSY;
        h->wrong += cscd_sensors_renew(h->sensors, x, 0) != CSCD_BUSY;
    }
    return kind == CSCD_CONTACT_TT && a == b;
}

TEST(calls_from_callbacks_are_busy) {
    static calling_host h;
    cscd_detector_options options = cscd_detector_defaults();
    cscd_contacts found;
    options.ignore = ignore_none;
    options.ignore_user = &h;
    h.p = panels_create(12, NULL, &options);
    expect_ok(cscd_sensors_create(h.p.context, h.p.mesh, NULL, CSCD_DOUBLES(h.p.x0, h.p.vertex_count), NULL,
                                  &h.sensors));
    h.calls = 0;
    expect_ok(panels_step(&h.p, &found));
    assert_true(h.calls > 3);
    assert_int_equal(h.wrong, 0);
    cscd_sensors_destroy(h.sensors);
    panels_destroy(&h.p);
}

/* ---- a small stack ------------------------------------------------------------------------------------- */

enum { STACK_KIB = PACED(256, 2048) }; /* sanitizers put more on it */

static void *walk_particles(void *data) {
    sensor_rig r = sensor_rig_create(data, NULL);
    sensor_rig_step(&r, s.x0, s.x1);
    sensor_rig_destroy(&r);
    return NULL;
}

TEST(calls_fit_a_small_stack) {
    pthread_attr_t small;
    pthread_t thread;
    scene_make(SCENE_LINKED_TORI, 1, &s);
    assert_int_equal(pthread_attr_init(&small), 0);
    assert_int_equal(pthread_attr_setstacksize(&small, (size_t)STACK_KIB * 1024), 0);
    assert_int_equal(pthread_create(&thread, &small, walk_particles, &s), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    pthread_attr_destroy(&small);
}

/* ---- triangles alone ----------------------------------------------------------------------------------- */

TEST(wires_are_refused) {
    static const uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}, wires[4] = {0, 1, 1, 2};
    static const double x[21] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 5, 5, 6, 6, 6, 7, 7, 7};
    cscd_context *context = context_of(1, NULL);
    cscd_object_desc descs[2] = {cscd_object_of_triangles(4, 4, triangles),
                                 cscd_object_of_wires(3, 2, wires)};
    cscd_mesh *mesh = NULL;
    cscd_sensors *sensors = NULL;
    expect_ok(cscd_mesh_create(context, descs, 2, &mesh));
    assert_int_equal(cscd_sensors_create(context, mesh, NULL, CSCD_DOUBLES(x, 7), NULL, &sensors),
                     CSCD_INVALID_MESH);
    assert_null(sensors);
    assert_non_null(strstr(cscd_context_detail(context), "of triangles alone"));
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* ---- faults -------------------------------------------------------------------------------------------- */

static void expect_fault(const sensor_partition *p, const char *expected) {
    const char *fault = partition_validate(p);
    assert_non_null(fault);
    assert_string_equal(fault, expected);
}

#define PLANT(place, value, sentence)                                                                        \
    do {                                                                                                     \
        uint32_t kept = place;                                                                               \
        (place) = (value);                                                                                   \
        expect_fault(p, sentence);                                                                           \
        (place) = kept;                                                                                      \
        assert_null(partition_validate(p));                                                                  \
    } while (0)

TEST(faults_are_found) {
    scene_clear(&s);
    for (int i = 0; i < 2; i++) scene_add_sphere(&s, (double[3]){2.5 * i, 0, 0}, 1.0, 8, 8);
    cscd_sensor_options options = cscd_sensor_defaults();
    options.cells = 4;
    sensor_rig r = sensor_rig_create(&s, &(sensor_setup){0, &options});
    sensor_partition *p = &r.sensors->partition;
    assert_null(partition_validate(p));
    PLANT(p->triangle_parts[2], 99, "a triangle is in a part that there is not");
    PLANT(p->vertex_cells[2], p->cell_count, "a vertex is in a cell that there is not");
    PLANT(p->parts[1].object, 2, "a part is of an object that there is not");
    PLANT(p->cell_parts[0], 2, "a cell is of a part that there is not");
    PLANT(p->cell_offsets[0], 1, "the cells of a partition do not follow each other");
    PLANT(p->cell_vertices[0], p->cell_vertices[p->cell_offsets[1]], "a cell holds a vertex of another one");
    sensor_rig_destroy(&r);
}
