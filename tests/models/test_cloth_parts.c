/* The parts of the cloth simulator: garments, springs and hinges, contact with friction. */
#include "models/cloth/cloth.h"
#include "models/cloth/cloth_scene.h"
#include "models/common/vec3.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static const fabric_material cotton = {
    .density = 0.15, .stretch = 400.0, .bending = 2e-4, .damping = 2e-3, .drag = 0.0};

static cscd_component only_component(const body *b) {
    cscd_context *context;
    cscd_mesh *mesh;
    const cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(cscd_mesh_component_count(mesh), 1);
    cscd_component component = cscd_mesh_component(mesh, 0);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return component;
}

TEST(sheets_are_open) {
    for (uint32_t side = 2; side < 30; side += 9) {
        body b = {0};
        garment_add_sheet(&b, side, 1.5);
        cscd_component c = only_component(&b);
        assert_int_equal(b.vertex_count, side * side);
        assert_int_equal(b.triangle_count, 2 * (side - 1) * (side - 1));
        assert_int_equal(c.open_edges, 4 * (side - 1));
        assert_int_equal(c.euler_characteristic, 1);
        assert_int_equal(c.non_manifold_edges + c.non_manifold_vertices + c.inconsistent_edges, 0);
        assert_true(body_least_angle(&b) > 44.9);
        body_free(&b);
    }
}

/* The seams join the two panels into one disc with an open edge as long as both lower edges. */
TEST(bags_are_sewn_from_two_panels) {
    enum { COLUMNS = 7, ROWS = 9 };
    body b = {0};
    uint32_t seam_count, *seams = garment_bag_seams(COLUMNS, ROWS, &seam_count);
    garment_add_bag(&b, COLUMNS, ROWS, 1.0, 1.2, 0.3);
    assert_int_equal(b.vertex_count, 2 * COLUMNS * ROWS);
    assert_int_equal(seam_count, 2 * (ROWS - 1) + COLUMNS);
    for (uint32_t i = 0; i < seam_count; i++) {
        const uint32_t *pair = seams + 2 * i;
        assert_memory_equal(b.positions + pair[0] * 3, b.positions + pair[1] * 3, 3 * sizeof(double));
        for (uint32_t k = 0; k < b.triangle_count * 3; k++)
            if (b.triangles[k] == pair[1]) b.triangles[k] = pair[0];
    }
    cscd_component c = only_component(&b);
    assert_int_equal(c.open_edges, 2 * (COLUMNS - 1));
    assert_int_equal(c.inconsistent_edges + c.non_manifold_edges, 0);
    assert_true(body_volume(&b) > 0.1); /* counter-clockwise from outside */
    free(seams);
    body_free(&b);
}

static void check_closed(body *b, double volume) {
    cscd_component c = only_component(b);
    assert_true(c.closed_manifold);
    assert_int_equal(c.euler_characteristic, 2);
    assert_true(fabs(body_volume(b) - volume) < 0.05 * volume);
    body_free(b);
}

TEST(tubes_balls_and_boxes_are_closed) {
    body tube = {0}, ball = {0}, box = {0};
    io_error error;
    garment_add_tube(&tube, 3000, 0.25, 1.3);
    assert_int_equal(tube.triangle_count, 3000);
    assert_true(body_least_angle(&tube) > 20.0);
    check_closed(&tube, 3.1416 * 0.25 * 0.25 * 1.3);
    assert_true(garment_add_ball(&ball, 1280, 0.35, &error));
    check_closed(&ball, 4.0 / 3.0 * 3.1416 * 0.35 * 0.35 * 0.35);
    garment_add_box(&box, 3.0);
    check_closed(&box, 6.0 * 6.0 * 0.3);
}

static body make_sheet(uint32_t side) {
    body b = {0};
    garment_add_sheet(&b, side, 1.0);
    return b;
}

static double *copy_of(const double *values, size_t count) {
    double *copy = body_allocate(count, sizeof *copy);
    memcpy(copy, values, count * sizeof *copy);
    return copy;
}

static void shake_vertices(uint64_t seed, double by, double *positions, uint32_t count) {
    random_stream random = stream_start(seed);
    for (uint32_t i = 0; i < count; i++) positions[i] += by * stream_between(&random, -1.0, 1.0);
}

static void check_rest(const body *b) {
    fabric f = fabric_make(b, &cotton);
    double *x = copy_of(b->positions, b->vertex_count * 3), *still = body_allocate(b->vertex_count * 3, 8);
    for (int i = 0; i < 100; i++) fabric_solve(&f, 1e-3, b->positions, x);
    for (uint32_t i = 0; i < b->vertex_count * 3; i++) assert_true(fabs(x[i] - b->positions[i]) < 1e-12);
    assert_true(fabric_energy(&f, x, still) < 1e-20);
    free(x);
    free(still);
    fabric_free(&f);
}

TEST(what_rests_stays) {
    body sheet = make_sheet(12), tube = {0};
    garment_add_tube(&tube, 1500, 0.25, 1.0);
    check_rest(&sheet);
    check_rest(&tube);
    body_free(&sheet);
    body_free(&tube);
}

/* There is one spring for each edge and one hinge for each inner edge; masses add up to that of the area. */
TEST(fabric_counts) {
    body b = make_sheet(10);
    fabric f = fabric_make(&b, &cotton);
    double mass = 0.0;
    for (uint32_t v = 0; v < b.vertex_count; v++) mass += 1.0 / f.inverse_masses[v];
    assert_int_equal(f.spring_count, b.vertex_count + b.triangle_count - 1);
    assert_int_equal(f.hinge_count, f.spring_count - 4 * 9);
    assert_true(fabs(mass - cotton.density) < 1e-6);
    fabric_free(&f);
    body_free(&b);
}

/* Checks the sums of mass * change and of its moment. Each constraint keeps both where it is solved; since
 * vertices move during the pass, this holds for small changes. */
TEST(springs_and_hinges_keep_momentum) {
    body b = make_sheet(10);
    fabric f = fabric_make(&b, &cotton);
    double *before = copy_of(b.positions, b.vertex_count * 3), *x, linear[3] = {0}, angular[3] = {0},
           most = 0.0;
    shake_vertices(7, 1e-6, before, b.vertex_count * 3);
    x = copy_of(before, b.vertex_count * 3);
    fabric_solve(&f, 1e-3, b.positions, x);
    for (uint32_t v = 0; v < b.vertex_count; v++) {
        double change[3], moment[3], mass = 1.0 / f.inverse_masses[v];
        vec3_subtract(x + v * 3, before + v * 3, change);
        vec3_cross(before + v * 3, x + v * 3, moment);
        vec3_add_scaled(linear, mass, change);
        vec3_add_scaled(angular, mass, moment);
        most = fmax(most, mass * vec3_norm(change));
    }
    assert_true(most > 1e-10);
    assert_true(vec3_norm(linear) < 1e-10 * most * b.vertex_count);
    assert_true(vec3_norm(angular) < 1e-4 * most * b.vertex_count);
    free(before);
    free(x);
    fabric_free(&f);
    body_free(&b);
}

/* A sheet is held at its upper edge for three seconds: no edge is more than 3 % longer, and it hangs
 * still. */
TEST(a_hanging_sheet_stretches_little) {
    enum { SIDE = 12, STEPS = 3000 };
    body b = make_sheet(SIDE);
    fabric_material stuff = cotton;
    stuff.damping = 5e-3;
    fabric f = fabric_make(&b, &stuff);
    double *x = copy_of(b.positions, b.vertex_count * 3), *previous = copy_of(x, b.vertex_count * 3);
    double *velocities = body_allocate(b.vertex_count * 3, sizeof *velocities), step = 1e-3;
    for (uint32_t v = b.vertex_count - SIDE; v < b.vertex_count; v++) f.inverse_masses[v] = 0.0;
    for (int i = 0; i < STEPS; i++) {
        memcpy(previous, x, b.vertex_count * 3 * sizeof *x);
        for (uint32_t v = 0; v < b.vertex_count - SIDE; v++) {
            velocities[v * 3 + 1] -= 10.0 * step;
            for (uint32_t k = v * 3; k < v * 3 + 3; k++) x[k] += step * (velocities[k] *= 0.999);
        }
        fabric_solve(&f, step, previous, x);
        for (uint32_t k = 0; k < b.vertex_count * 3; k++) velocities[k] = (x[k] - previous[k]) / step;
    }
    for (uint32_t i = 0; i < f.spring_count; i++) {
        double between[3];
        vec3_subtract(x + f.springs[i].vertices[0] * 3, x + f.springs[i].vertices[1] * 3, between);
        assert_true(vec3_norm(between) < 1.03 * f.springs[i].rest);
    }
    for (uint32_t k = 0; k < b.vertex_count * 3; k++) assert_true(fabs(velocities[k]) < 1e-4);
    free(x);
    free(previous);
    free(velocities);
    fabric_free(&f);
    body_free(&b);
}

TEST(obstacles_move_as_told) {
    const cloth_obstacle o = {.kind = CLOTH_BALL,
                              .size = 0.5,
                              .centre = {1.0, 2.0, 3.0},
                              .begin = 1.0,
                              .seconds = 2.0,
                              .rise = 0.4,
                              .turn = 1.0};
    body shape;
    io_error error;
    assert_true(cloth_obstacle_make(&o, &shape, &error));
    double *x = body_allocate(shape.vertex_count * 3, sizeof *x);
    for (uint32_t v = 0; v < shape.vertex_count; v++) {
        const double *p = shape.positions + v * 3, *q = x + v * 3;
        cloth_obstacle_place(&o, &shape, 0.9, x);
        for (int k = 0; k < 3; k++) assert_true(fabs(q[k] - (p[k] + o.centre[k])) < 1e-15);
        cloth_obstacle_place(&o, &shape, 5.0, x); /* turned by a right angle */
        assert_true(fabs(q[0] - (1.0 - p[1])) < 1e-12 && fabs(q[1] - (2.0 + p[0])) < 1e-12);
        assert_true(fabs(q[2] - (3.4 + p[2])) < 1e-12);
    }
    free(x);
    body_free(&shape);
}
