/* The measures of a recording: residuals of rigid motion, softness, speed, contacts and intersections. */
#include "models/common/motion.h"
#include "models/common/vec3.h"
#include "tests/support/io/recordings.h"
#include "tests/support/models/bodies.h"
#include "tests/support/models/soft_fixture.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static const double no_offset[3] = {0.0, 0.0, 0.0};

static body figure;
static double *moved;

static int make_figure(void **state) {
    (void)state;
    figure = body_of(BODY_FIGURE, body_least_count(BODY_FIGURE));
    moved = body_allocate(figure.vertex_count, 3 * sizeof *moved);
    return 0;
}

static int free_figure(void **state) {
    (void)state;
    body_free(&figure);
    free(moved);
    return 0;
}

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

/* Half turns and more are hard for quaternions. The residual is the root of a difference, so half of the
 * digits are lost. */
TEST(rigid_motions_leave_nothing) {
    double turn[3][3];
    const double pi = 3.14159265358979323846;
    for (int i = 0; i <= 24; i++) {
        rotation_matrix((double[3]){1.0 - i % 3, 0.5 * (i % 5) - 1.0, 0.3}, i * pi / 12.0, turn);
        affine_map(turn, (double[3]){3.0, -0.1 * i, 0.2}, figure.positions, figure.vertex_count, moved);
        assert_near(rigid_residual(figure.positions, moved, figure.vertex_count), 0.0, 1e-6);
    }
    for (int k = 0; k < 3; k++) {
        rotation_matrix((double[3]){k == 0, k == 1, k == 2}, pi, turn);
        affine_map(turn, no_offset, figure.positions, figure.vertex_count, moved);
        assert_near(rigid_residual(figure.positions, moved, figure.vertex_count), 0.0, 1e-6);
    }
}

/* Points come in opposite pairs, so that the best motion is a pure rotation. */
TEST(deformations_leave_what_they_must) {
    const double cross_shape[6][3] = {{3, 0, 0}, {-3, 0, 0}, {0, 2, 0}, {0, -2, 0}, {0, 0, 1}, {0, 0, -1}};
    double stretched[6][3], turn[3][3];
    /* Stretched by s along x, two of six points move by 3 (s - 1), turned or not. */
    rotation_matrix((double[3]){1.0, 2.0, -1.0}, 2.0, turn);
    for (int i = 0; i < 8; i++) {
        double s = 0.8 + 0.1 * i, scale[3][3] = {{s, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        affine_map(scale, no_offset, cross_shape[0], 6, stretched[0]);
        affine_map(turn, (double[3]){5.0, 6.0, 7.0}, stretched[0], 6, stretched[0]);
        assert_near(rigid_residual(cross_shape[0], stretched[0], 6), 3.0 * fabs(s - 1.0) * sqrt(2.0 / 6.0),
                    1e-6);
    }
    /* A shear of y by x with 2 g = amount is, seen after a rotation by g, a pure stretch of the square's
     * diagonals. */
    const double square[4][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    double shear[3][3] = {{1, 0.2, 0}, {0, 1, 0}, {0, 0, 1}}, sheared[4][3];
    affine_map(shear, no_offset, square[0], 4, sheared[0]);
    /* The trace of S = sum of b a^T is 4, its antisymmetric part 0.4: the norm of both is the best
     * rotation's part. */
    double squares = 4.0 + 4.0 + 2.0 * 0.04, best = sqrt(4.0 * 4.0 + 0.4 * 0.4);
    assert_near(rigid_residual(square[0], sheared[0], 4), sqrt((squares - 2.0 * best) / 4.0), 1e-9);
}

/* Except for its arms, the figure is its own mirror image; a screw of points is not. */
TEST(mirror_images_are_no_motions) {
    double screw[40][3], mirrored[40][3], mirror[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    for (int i = 0; i < 40; i++) {
        screw[i][0] = cos(0.5 * i);
        screw[i][1] = sin(0.5 * i);
        screw[i][2] = 0.02 * i;
    }
    affine_map(mirror, no_offset, screw[0], 40, mirrored[0]);
    assert_true(rigid_residual(screw[0], mirrored[0], 40) > 0.1);
    assert_near(rigid_residual(mirrored[0], mirrored[0], 40), 0.0, 1e-6);
    /* Neither is the inversion through the origin, which changes every sign. */
    double inverted[3][3] = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    affine_map(inverted, no_offset, screw[0], 40, mirrored[0]);
    assert_true(rigid_residual(screw[0], mirrored[0], 40) > 0.1);
}

static cscd_mesh *mesh_of(cscd_context *context, uint32_t vertex_count, uint32_t triangle_count,
                          const uint32_t *triangles) {
    const cscd_object_desc desc = cscd_object_of_triangles(vertex_count, triangle_count, triangles);
    cscd_mesh *mesh;
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    return mesh;
}

/* The tip of a tetrahedron flies through another one: contacts in intervals 3 and 5, intersections from
 * frame 4 on. */
TEST(counts_contacts_and_intersections) {
    enum { FRAMES = 8 };
    recorded flight = recorded_tetrahedra(FRAMES);
    cscd_context *context;
    recording_motion m;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    cscd_mesh *mesh = mesh_of(context, flight.vertex_count, flight.triangle_count, flight.triangles);
    assert_int_equal(recording_motion_begin(mesh, recorded_position(&flight, 0, 0), &m), CSCD_OK);
    for (uint32_t k = 1; k < FRAMES; k++) {
        assert_int_equal(recording_motion_add(&m, recorded_position(&flight, k, 0)), CSCD_OK);
        assert_int_equal(m.contact_intervals, k < 4 ? 0 : k < 6 ? 1 : 2);
        assert_int_equal(m.intersecting_frames, k < 4 ? 0 : k - 3);
    }
    assert_int_equal(m.frame_count, FRAMES);
    recording_motion_free(&m);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    recorded_free(&flight);
}

/* A box grows along x: residual and motion are those of its eight corners. */
TEST(measures_softness_and_speed) {
    body box = box_body((double[3]){-1.0, -0.5, -0.5}, (double[3]){1.0, 0.5, 0.5});
    double diagonal = sqrt(6.0), frame[24],
           edge_length = (4.0 * 2.0 + 8.0 + 4.0 * sqrt(5.0) + 2.0 * sqrt(2.0)) / 18.0;
    cscd_context *context;
    recording_motion m;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    cscd_mesh *mesh = mesh_of(context, box.vertex_count, box.triangle_count, box.triangles);
    assert_int_equal(recording_motion_begin(mesh, box.positions, &m), CSCD_OK);
    assert_near(m.diagonal, diagonal, 1e-15);
    assert_near(m.edge_length, edge_length, 1e-14);
    const double factors[] = {1.05, 1.08, 1.2, 1.0};
    for (uint32_t i = 0; i < 4; i++) { /* 3 % of the diagonal are 7.3 % of half of the length */
        double scale[3][3] = {{factors[i], 0, 0}, {0, 1, 0}, {0, 0, 1}};
        affine_map(scale, no_offset, box.positions, 8, frame);
        assert_int_equal(recording_motion_add(&m, frame), CSCD_OK);
        assert_int_equal(m.soft_frames, i == 0 ? 0 : i == 1 ? 1 : 2);
        assert_near(m.largest_residual, (fmin(i, 2) < i ? 0.2 : factors[i] - 1.0) / diagonal, 1e-7);
    }
    assert_near(m.largest_motion, 0.2 / edge_length, 1e-14);
    assert_int_equal(m.intersecting_frames, 0);
    recording_motion_free(&m);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    body_free(&box);
}

/* Nothing is left to free, which the sanitizers check. */
TEST(bad_positions_are_refused) {
    cscd_context *context;
    recording_motion m;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    cscd_mesh *mesh = mesh_of(context, figure.vertex_count, figure.triangle_count, figure.triangles);
    memcpy(moved, figure.positions, figure.vertex_count * 3 * sizeof *moved);
    moved[5] = NAN;
    assert_int_equal(recording_motion_begin(mesh, moved, &m), CSCD_INVALID_ARGUMENT);
    assert_int_equal(recording_motion_begin(mesh, figure.positions, &m), CSCD_OK);
    assert_int_equal(recording_motion_add(&m, moved), CSCD_INVALID_ARGUMENT);
    assert_int_equal(m.frame_count, 1);
    assert_int_equal(recording_motion_add(&m, figure.positions), CSCD_OK);
    recording_motion_free(&m);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

AROUND_ALL(make_figure, free_figure)
