/* How many cells a part gets: kissing numbers, two convex objects, the cap; and which parts are convex. */
#include "sensors/cells.h"
#include "tests/support/calls.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <math.h>

TEST(kissing_numbers) {
    assert_int_equal(kissing_number(1.0, 1.0, 64), 12);
    assert_int_equal(kissing_number(1.0, 0.991, 64), 12);
    assert_int_equal(kissing_number(1.0, 1.009, 64), 12);
    assert_int_equal(kissing_number(1.0, 0.98, 64), 15);
    assert_int_equal(kissing_number(1.02, 1.04, 64), 14); /* the plain ratio gives 14.4 */
    assert_int_equal(kissing_number(2.0, 1.0, 64), 34);   /* 34.97 */
    assert_int_equal(kissing_number(3.0, 1.0, 64), 62);   /* 62.98 */
    assert_int_equal(kissing_number(4.0, 1.0, 64), 64);   /* 98.99 */
    assert_int_equal(kissing_number(4.0, 1.0, UINT32_MAX), 98);
    assert_int_equal(kissing_number(1.0, 2.0, 64), 7); /* 7.85 */
    assert_int_equal(kissing_number(1.0, 1e9, 64), 2);
    assert_int_equal(kissing_number(1.0, 1e9, 1), 1);
    assert_int_equal(kissing_number(1.0, 0.0, 64), 64);
    assert_int_equal(kissing_number(0.0, 1.0, 64), 2);
    assert_int_equal(kissing_number(0x1p-300, 0x1p300, 64), 2);
    assert_int_equal(kissing_number(0x1p300, 0x1p-300, 64), 64);
}

static uint32_t cells_in(const sensor_row *r, uint32_t part) {
    return cscd_sensors_part(r->sensors, part).cell_count;
}

TEST(how_many_cells) {
    const body_kind spheres[3] = {BODY_SPHERE, BODY_SPHERE, BODY_SPHERE};
    const body_kind mixed[3] = {BODY_SPHERE, BODY_TORUS, BODY_SPHERE};
    sensor_row r = row_of(2, spheres, (double[]){1.0, 0.5}, NULL);
    for (uint32_t p = 0; p < 2; p++) {
        assert_true(cscd_sensors_part(r.sensors, p).convex);
        assert_int_equal(cells_in(&r, p), 1);
    }
    assert_true(fabs(cscd_sensors_part(r.sensors, 0).radius - 1.0) < 0.02);
    row_free(&r);
    r = row_of(3, spheres, (double[]){1.0, 1.0, 1.0}, NULL);
    for (uint32_t p = 0; p < 3; p++) assert_int_equal(cells_in(&r, p), 12);
    row_free(&r);
    r = row_of(3, spheres, (double[]){1.0, 1.0, 0.5}, NULL);
    assert_true(cells_in(&r, 0) == 34 && cells_in(&r, 1) == 34 && cells_in(&r, 2) == 7);
    row_free(&r);
    r = row_of(2, mixed, (double[]){1.0, 1.0}, NULL);
    assert_true(cscd_sensors_part(r.sensors, 0).convex && !cscd_sensors_part(r.sensors, 1).convex);
    assert_true(cells_in(&r, 0) > 1 && cells_in(&r, 1) > 1);
    row_free(&r);
    cscd_sensor_options options = cscd_sensor_defaults();
    options.cells_max = 20;
    r = row_of(3, spheres, (double[]){1.0, 1.0, 0.125}, &options);
    assert_true(cells_in(&r, 0) == 20 && cells_in(&r, 1) == 20 && cells_in(&r, 2) == 3);
    row_free(&r);
    options.cells = 33; /* the cap is for counted cells, not for those that the caller asks for */
    r = row_of(2, spheres, (double[]){1.0, 1.0}, &options);
    assert_true(cells_in(&r, 0) == 33 && cells_in(&r, 1) == 33);
    row_free(&r);
}

/* ---- convexity --------------------------------------------------------------------------------------- */

static bool is_convex(const body *b) {
    cscd_mesh *mesh = body_mesh(b, 1);
    cscd_sensors *sensors = sensors_of(mesh, NULL, b->positions, NULL);
    bool convex = cscd_sensors_part(sensors, 0).convex;
    cscd_sensors_destroy(sensors);
    body_mesh_destroy(mesh);
    return convex;
}

/* No vertex is outside of a triangle's plane. */
static bool is_hull(const body *b) {
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const double *p[3];
        for (uint32_t i = 0; i < 3; i++) p[i] = b->positions + (size_t)b->triangles[t * 3 + i] * 3;
        double n[3];
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            n[k] = (p[1][i] - p[0][i]) * (p[2][j] - p[0][j]) - (p[1][j] - p[0][j]) * (p[2][i] - p[0][i]);
        }
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (uint32_t v = 0; v < b->vertex_count; v++) {
            double distance = 0.0;
            for (int k = 0; k < 3; k++)
                distance += n[k] / length * (b->positions[v * 3 + (uint32_t)k] - p[0][k]);
            if (distance > 4e-6) return false;
        }
    }
    return true;
}

TEST(convex_bodies) {
    uint32_t convex_count = 0;
    for (int kind = 0; kind < BODY_KIND_COUNT; kind++) {
        if (kind == BODY_CHAIN) continue; /* five components */
        body b = body_of((body_kind)kind, body_nearest_count((body_kind)kind, 800));
        convex_count += is_hull(&b);
        if (is_convex(&b) != is_hull(&b)) fail_msg("%s: convex is wrong", body_kind_name((body_kind)kind));
        b.triangle_count--; /* open */
        assert_false(is_convex(&b));
        b.triangle_count++;
        body_free(&b);
    }
    assert_true(convex_count >= 2);
    body b = body_of(BODY_SPHERE, 800);
    for (uint32_t v = 0; v < 3; v++) b.positions[v] *= 0.9; /* a dent */
    assert_false(is_convex(&b));
    for (uint32_t v = 0; v < 3; v++) b.positions[v] /= 0.9;
    for (uint32_t t = 0; t < b.triangle_count; t++) { /* inside out */
        uint32_t kept = b.triangles[t * 3];
        b.triangles[t * 3] = b.triangles[t * 3 + 1];
        b.triangles[t * 3 + 1] = kept;
    }
    assert_false(is_convex(&b));
    body_free(&b);
}

/* Two tetrahedra with a face in common, whose tips lean over one edge of it: nothing else is concave. It is seen from either
 * triangle, wherever their corners begin. A third triangle on an edge of a tetrahedron, without area, makes it no surface. */
TEST(one_concave_edge) {
    static const double leaning[15] = {0, 0, 0, 2, 0, 0, 1, 2, 0, 1, -1, 1, 1, -1, -1};
    static const double upright[15] = {0, 0, 0, 2, 0, 0, 1, 2, 0, 1, 0.5, 1, 1, 0.5, -1};
    static const uint32_t sides[18] = {0, 1, 3, 1, 2, 3, 2, 0, 3, 1, 0, 4, 2, 1, 4, 0, 2, 4};
    static const double flat[15] = {0, 0, 0, 2, 0, 0, 1, 2, 0, 1, 0.5, 1, 1, 0, 0};
    static const uint32_t with_flap[15] = {0, 1, 3, 1, 2, 3, 2, 0, 3, 1, 0, 2, 0, 1, 4};
    for (uint32_t turn = 0; turn < 3; turn++) {
        uint32_t turned[18];
        for (uint32_t i = 0; i < 18; i++) turned[i] = sides[i / 3 * 3 + (i + turn) % 3];
        body b = {
            .vertex_count = 5, .triangle_count = 6, .triangles = turned, .positions = (double *)leaning};
        assert_false(is_convex(&b));
        b.positions = (double *)upright;
        assert_true(is_convex(&b));
    }
    body b = {.vertex_count = 5,
              .triangle_count = 4,
              .triangles = (uint32_t *)with_flap,
              .positions = (double *)flat};
    assert_true(is_convex(&b));
    b.triangle_count = 5;
    assert_false(is_convex(&b));
}

TEST(a_part_of_a_ball_is_not_convex) {
    body b = body_of(BODY_SPHERE, 800);
    cscd_mesh *mesh = body_mesh(&b, 1);
    cscd_plan_options options = cscd_plan_defaults();
    options.method = CSCD_METHOD_KMEANS;
    for (options.k = 1; options.k < 3; options.k++) {
        cscd_plan *plan = NULL;
        assert_int_equal(plan_create_packed(mesh, b.positions, &options, &plan), CSCD_OK);
        cscd_sensors *sensors = sensors_of(mesh, plan, b.positions, NULL);
        for (uint32_t p = 0; p < options.k; p++)
            assert_int_equal(cscd_sensors_part(sensors, p).convex, options.k == 1);
        cscd_sensors_destroy(sensors);
        cscd_plan_destroy(plan);
    }
    body_mesh_destroy(mesh);
    body_free(&b);
}
