/* Elastic tetrahedra: no energy at rest or turned, the energy of the formula when deformed, and momentum
 * kept. */
#include "models/common/vec3.h"
#include "models/softbody/softbody.h"
#include "tests/support/models/bodies.h"
#include "tests/support/models/soft_fixture.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static const material rubber = {.density = 1.0, .young = 150.0, .poisson = 0.4, .damping = 4.0};
static const double no_offset[3] = {0.0, 0.0, 0.0};

static soft_body soft;
static uint32_t tetrahedron_count;
static double *moved;

static int make_body(void **state) {
    (void)state;
    body sphere = body_of(BODY_SPHERE, body_nearest_count(BODY_SPHERE, 500));
    soft = soft_body_make(sphere.positions, sphere.vertex_count, sphere.triangles, sphere.triangle_count, 0.4,
                          &rubber);
    tetrahedron_count = soft.frame.cell_count * 5;
    moved = body_allocate(soft.frame.node_count, 3 * sizeof *moved);
    body_free(&sphere);
    return 0;
}

static int free_body(void **state) {
    (void)state;
    soft_body_free(&soft);
    free(moved);
    return 0;
}

static double energy_under(double map[3][3]) {
    affine_map(map, no_offset, soft.frame.rest, soft.frame.node_count, moved);
    return tetrahedra_energy(soft.tetrahedra, tetrahedron_count, moved);
}

static double rest_volume(void) {
    return soft.frame.cell_count * pow(soft.frame.spacing, 3.0);
}

static double determinant_of(double f[3][3]) {
    double minors[3];
    vec3_cross(f[1], f[2], minors);
    return vec3_dot(f[0], minors);
}

/* Returns the energy per volume by Macklin and Mueller, relative to the rest shape, from Young's modulus
 * and Poisson's ratio. */
static double energy_density(double f[3][3]) {
    double shear = rubber.young / (2.0 * (1.0 + rubber.poisson));
    double bulk = rubber.young * rubber.poisson / ((1.0 + rubber.poisson) * (1.0 - 2.0 * rubber.poisson));
    double squares = vec3_dot(f[0], f[0]) + vec3_dot(f[1], f[1]) + vec3_dot(f[2], f[2]);
    double growth = determinant_of(f) - 1.0;
    return 0.5 * shear * (squares - 3.0) + 0.5 * bulk * growth * growth - shear * growth;
}

static void assert_close(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

TEST(rest_and_turned_shapes_have_no_energy) {
    double turn[3][3];
    for (int i = 0; i < 12; i++) {
        rotation_matrix((double[3]){1.0, 0.3 * i - 1.0, 0.5}, 0.6 * i, turn);
        assert_close(energy_under(turn), 0.0, 1e-12 * rubber.young * rest_volume());
    }
}

/* A rotation before or after the deformation changes nothing: the material has no grain. */
TEST(energy_is_that_of_the_formula) {
    double turn[3][3], shapes[4][3][3] = {{{1.0, 0.4, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
                                          {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.5}},
                                          {{1.2, 0.1, 0.3}, {0.0, 0.9, -0.2}, {0.4, 0.0, 1.1}},
                                          {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, -1.0}}};
    rotation_matrix((double[3]){0.2, 1.0, -0.7}, 1.1, turn);
    for (int i = 0; i < 4; i++) {
        double before[3][3], expected = rest_volume() * energy_density(shapes[i]);
        for (int row = 0; row < 3; row++) {
            for (int k = 0; k < 3; k++)
                before[row][k] = shapes[i][row][0] * turn[0][k] + shapes[i][row][1] * turn[1][k] +
                                 shapes[i][row][2] * turn[2][k];
        }
        assert_true(expected > 0.0);
        assert_close(energy_under(shapes[i]), expected, 1e-12 * expected);
        assert_close(energy_under(before), expected, 1e-12 * expected);
        affine_map(turn, (double[3]){3.0, -2.0, 1.0}, moved, soft.frame.node_count, moved);
        assert_close(tetrahedra_energy(soft.tetrahedra, tetrahedron_count, moved), expected,
                     1e-11 * expected);
    }
}

TEST(energy_grows_with_the_deformation) {
    double last[4] = {0.0, 0.0, 0.0, 0.0};
    for (int i = 1; i <= 20; i++) {
        double amount = 0.045 * i;
        double shapes[4][3][3] = {{{1.0, amount, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
                                  {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0 - amount}},
                                  {{1.0 + amount, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
                                  {{1.0, 0.0, 0.0}, {0.0, cos(amount), 0.0}, {0.0, sin(amount), 1.0}}};
        for (int k = 0; k < 4; k++) {
            double energy = energy_under(shapes[k]);
            assert_true(energy > last[k]);
            last[k] = energy;
        }
    }
}

/* Forces would move the nodes by the square of the step. Here they move by the fourth power, since the two
 * constraints, whose forces cancel at rest, are solved one after the other. */
TEST(rest_shape_has_no_forces) {
    double motion[3], step = 1.0 / 200.0;
    for (int i = 0; i < 3; i++, step /= 2.0) {
        memcpy(moved, soft.frame.rest, soft.frame.node_count * 3 * sizeof *moved);
        tetrahedra_solve(soft.tetrahedra, tetrahedron_count, soft.inverse_masses, step, moved);
        motion[i] = largest_distance(moved, soft.frame.rest, soft.frame.node_count) / soft.frame.spacing;
    }
    print_message("one solve at rest: %.2g, %.2g, %.2g of the spacing\n", motion[0], motion[1], motion[2]);
    assert_true(motion[2] < 2e-6);
    assert_true(motion[0] > 12.0 * motion[1] && motion[1] > 12.0 * motion[2]);
}

/* The constraints act as inner forces: the centre of mass stays, and the energy falls. */
TEST(solving_keeps_the_centre_and_relaxes) {
    double squash[3][3] = {{1.2, 0.1, 0.3}, {0.0, 0.9, -0.2}, {0.4, 0.0, 0.7}};
    double energy = energy_under(squash), sum[3] = {0.0, 0.0, 0.0};
    double *before = body_allocate(soft.frame.node_count, 3 * sizeof *before);
    memcpy(before, moved, soft.frame.node_count * 3 * sizeof *before);
    tetrahedra_solve(soft.tetrahedra, tetrahedron_count, soft.inverse_masses, 1.0 / 800.0, moved);
    assert_true(tetrahedra_energy(soft.tetrahedra, tetrahedron_count, moved) < energy);
    for (uint32_t n = 0; n < soft.frame.node_count; n++) {
        vec3_add_scaled(sum, soft.masses[n], moved + n * 3);
        vec3_add_scaled(sum, -soft.masses[n], before + n * 3);
    }
    assert_true(vec3_norm(sum) < 1e-13);
    assert_true(largest_distance(before, moved, soft.frame.node_count) > 1e-5);
    free(before);
}

/* A material of twice the stiffness has twice the energy. */
TEST(stiffness_scales_energy) {
    material stiffer = rubber;
    stiffer.young *= 2.0;
    const lattice *l = &soft.frame;
    tetrahedron *twice = tetrahedra_make(l, &stiffer);
    double stretch[3][3] = {{1.1, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    affine_map(stretch, no_offset, l->rest, l->node_count, moved);
    double plain = tetrahedra_energy(soft.tetrahedra, tetrahedron_count, moved);
    assert_true(plain > 0.0);
    assert_close(tetrahedra_energy(twice, tetrahedron_count, moved), 2.0 * plain, 1e-12 * plain);
    free(twice);
}

/* A corner is pushed through the opposite sides: all cells there are inside out. */
TEST(what_is_turned_inside_out_comes_back) {
    body box = box_body((double[3]){-0.7, -0.7, -0.7}, (double[3]){0.7, 0.7, 0.7});
    soft_body b = soft_body_of(&box, 0.5, &rubber);
    obstacles nothing = {0};
    double wrong = 0.0;
    vec3_add_scaled(b.nodes, 1.5 * soft.frame.spacing / 0.4, (double[3]){1.0, 1.0, 1.0});
    for (uint32_t i = 0; i < b.frame.cell_count * 5; i++) {
        double edges[3][3];
        const uint32_t *n = b.tetrahedra[i].nodes;
        for (int k = 0; k < 3; k++) vec3_subtract(b.nodes + n[k + 1] * 3, b.nodes + n[0] * 3, edges[k]);
        wrong += determinant_of(edges) < 0.0;
    }
    assert_true(wrong > 0.0);
    simulation_advance(&b, &nothing, NULL, 5.0, 4000);
    assert_true(soft_body_energy(&b, 0.0) < 1e-3);
    soft_body_free(&b);
    body_free(&box);
}

AROUND_ALL(make_body, free_body)
