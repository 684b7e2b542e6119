/* A soft body obeys the laws of motion: momentum, free fall, contacts with ground and balls, energy. */
#include "models/common/vec3.h"
#include "models/softbody/softbody.h"
#include "tests/support/models/bodies.h"
#include "tests/support/models/soft_fixture.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static const material rubber = {.density = 1.0, .young = 150.0, .poisson = 0.4, .damping = 4.0};

static body sphere;

static int make_sphere(void **state) {
    (void)state;
    sphere = body_of(BODY_SPHERE, body_nearest_count(BODY_SPHERE, 500));
    return 0;
}

static int free_sphere(void **state) {
    (void)state;
    body_free(&sphere);
    return 0;
}

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

static void assert_same_vector(const double a[3], const double b[3], double tolerance) {
    for (int k = 0; k < 3; k++) assert_near(a[k], b[k], tolerance);
}

static void advance_body(soft_body *b, obstacles *o, double seconds) {
    simulation_advance(b, o, NULL, seconds, (uint32_t)(seconds * 800.0 + 0.5));
}

/* ---- placing and pushing ---- */

TEST(masses_are_those_of_the_cells) {
    material heavy = rubber;
    heavy.density = 2.5;
    soft_body b = soft_body_of(&sphere, 0.4, &heavy);
    double expected = 2.5 * b.frame.cell_count * 0.4 * 0.4 * 0.4;
    assert_near(soft_momentum_of(&b).mass, expected, 1e-12 * expected);
    for (uint32_t n = 0; n < b.frame.node_count; n++)
        assert_near(b.masses[n] * b.inverse_masses[n], 1.0, 1e-15);
    soft_body_free(&b);
}

TEST(placing_moves_everything) {
    soft_body b = soft_body_of(&sphere, 0.4, &rubber);
    double turn[3][3], *expected = body_allocate(sphere.vertex_count, 3 * sizeof *expected);
    const double offset[3] = {1.0, 2.0, 3.0};
    rotation_matrix((double[3]){1.0, 1.0, 0.2}, 2.0, turn);
    affine_map(turn, offset, b.vertices, sphere.vertex_count, expected);
    soft_body_place(&b, turn, offset);
    assert_true(largest_distance(b.vertices, expected, sphere.vertex_count) < 1e-13);
    assert_near(soft_body_energy(&b, 0.0), 0.0, 1e-11);
    free(expected);
    soft_body_free(&b);
}

/* The body spins about its centre of mass, whichever way it is thrown. */
TEST(throwing_gives_velocity_and_spin) {
    soft_body b = soft_body_of(&sphere, 0.4, &rubber);
    const double velocity[3] = {1.0, -2.0, 0.5}, spin[3] = {0.0, 0.0, 3.0};
    soft_body_throw(&b, velocity, spin);
    soft_momentum m = soft_momentum_of(&b);
    double inertia = 0.0;
    for (uint32_t n = 0; n < b.frame.node_count; n++) {
        double x = b.nodes[n * 3] - m.centre[0], y = b.nodes[n * 3 + 1] - m.centre[1];
        inertia += b.masses[n] * (x * x + y * y);
    }
    for (int k = 0; k < 3; k++) assert_near(m.linear[k], m.mass * velocity[k], 1e-12);
    assert_near(m.angular[2], 3.0 * inertia, 1e-11);
    assert_near(soft_body_energy(&b, 0.0), 0.5 * m.mass * 5.25 + 0.5 * 9.0 * inertia, 1e-10);
    soft_body_free(&b);
}

/* A push moves its vertex exactly, and has the momentum of a point of that mobility. */
TEST(pushes_move_their_vertex) {
    soft_body b = soft_body_of(&sphere, 0.4, &rubber);
    const double change[3] = {0.01, -0.02, 0.005};
    for (uint32_t v = 0; v < sphere.vertex_count; v += 17) {
        double sum[3] = {0.0, 0.0, 0.0}, before[3], after[3], expected[3];
        memcpy(b.previous, b.nodes, b.frame.node_count * 3 * sizeof *b.nodes);
        lattice_place_vertex(&b.frame, b.nodes, v, before);
        soft_body_push(&b, b.nodes, v, change);
        lattice_place_vertex(&b.frame, b.nodes, v, after);
        for (uint32_t n = 0; n < b.frame.node_count; n++) {
            double moved[3];
            vec3_subtract(b.nodes + n * 3, b.previous + n * 3, moved);
            vec3_add_scaled(sum, b.masses[n], moved);
        }
        for (int k = 0; k < 3; k++) expected[k] = change[k] / b.vertex_mobilities[v];
        assert_same_vector(sum, expected, 1e-12);
        vec3_add_scaled(before, 1.0, change);
        assert_same_vector(after, before, 1e-13);
    }
    soft_body_free(&b);
}

/* ---- a free body ---- */

/* Throws a body that spins and swirls inside; returns how much of its angular momentum is lost after two
 * seconds. */
static double angular_drift(double damping, uint32_t steps_per_second) {
    material m = rubber;
    m.damping = damping;
    soft_body b = soft_body_of(&sphere, 0.4, &m);
    obstacles nothing = {0};
    double lost[3];
    soft_body_throw(&b, (double[3]){1.0, 2.0, -0.5}, (double[3]){1.0, -2.0, 3.0});
    for (uint32_t n = 0; n < b.frame.node_count; n++)
        b.velocities[n * 3] += 0.7 * b.frame.rest[n * 3 + 1] * b.frame.rest[n * 3 + 2];
    soft_momentum before = soft_momentum_of(&b);
    double energy = soft_body_energy(&b, 0.0), last = energy;
    for (int i = 0; i < 20; i++) {
        simulation_advance(&b, &nothing, NULL, 0.1, steps_per_second / 10);
        assert_true(soft_body_energy(&b, 0.0) < last);
        last = soft_body_energy(&b, 0.0);
    }
    soft_momentum after = soft_momentum_of(&b);
    assert_same_vector(after.linear, before.linear, 1e-9);
    vec3_add_scaled(before.centre, 2.0 / before.mass, before.linear);
    assert_same_vector(after.centre, before.centre, 1e-9);
    assert_true(last > 0.9 * energy);
    vec3_subtract(after.angular, before.angular, lost);
    soft_body_free(&b);
    return vec3_norm(lost) / vec3_norm(before.angular);
}

/* Linear momentum is kept up to rounding, angular momentum as far as small steps allow: steps that are
 * implicit in the positions slow a spin by its square times the step. Damping adds nothing to that, since
 * it leaves rigid motion alone. */
TEST(free_bodies_keep_their_momentum) {
    double undamped = angular_drift(0.0, 800), damped = angular_drift(4.0, 800),
           finer = angular_drift(4.0, 1600);
    print_message("angular momentum lost: %.3g undamped, %.3g damped, %.3g with half the step\n", undamped,
                  damped, finer);
    assert_true(undamped < 0.04 && fabs(damped - undamped) < 0.1 * undamped);
    assert_true(finer > 0.4 * damped && finer < 0.6 * damped);
}

TEST(damping_stills_vibrations) {
    double energies[2];
    for (int i = 0; i < 2; i++) {
        material m = rubber;
        m.damping = i == 0 ? 0.0 : 4.0;
        soft_body b = soft_body_of(&sphere, 0.4, &m);
        obstacles nothing = {0};
        for (uint32_t n = 0; n < b.frame.node_count; n++) b.velocities[n * 3] += 0.8 * b.frame.rest[n * 3];
        advance_body(&b, &nothing, 1.0);
        energies[i] = soft_body_energy(&b, 0.0);
        soft_body_free(&b);
    }
    assert_true(energies[1] < 0.1 * energies[0]);
}

/* Free fall is the sum of n small steps of gravity after velocity, and approaches a parabola with finer
 * steps. */
TEST(free_fall_is_a_parabola) {
    soft_body b = soft_body_of(&sphere, 0.4, &rubber);
    obstacles falling = {.gravity = 10.0};
    const double velocity[3] = {1.5, 0.0, 4.0};
    soft_body_throw(&b, velocity, (double[3]){0.5, 0.2, 0.0});
    double start[3], step = 1.0 / 800.0;
    memcpy(start, soft_momentum_of(&b).centre, sizeof start);
    for (int i = 1; i <= 10; i++) {
        double t = 0.1 * i, n = 80.0 * i;
        advance_body(&b, &falling, 0.1);
        soft_momentum m = soft_momentum_of(&b);
        assert_near(m.centre[0], start[0] + 1.5 * t, 1e-10);
        assert_near(m.centre[1], start[1], 1e-10);
        assert_near(m.centre[2], start[2] + 4.0 * t - 10.0 * step * step * n * (n + 1.0) / 2.0, 1e-10);
        assert_near(m.centre[2], start[2] + 4.0 * t - 5.0 * t * t, 5.0 * t * step + 1e-10);
        assert_near(m.linear[2] / m.mass, 4.0 - 10.0 * t, 1e-9);
    }
    soft_body_free(&b);
}

/* ---- contacts ---- */

/* Up to rounding, nothing is ever below the ground, and the energy never rises. */
TEST(dropped_bodies_come_to_rest) {
    material damped = rubber;
    damped.damping = 20.0;
    soft_body b = soft_body_of(&sphere, 0.4, &damped);
    obstacles ground = {.gravity = 10.0, .friction = 0.6};
    soft_body_lift(&b, 0.5 - lowest_vertex(&b));
    double start = soft_body_energy(&b, ground.gravity), last = start, lost = 0.0;
    for (int i = 0; i < 50; i++) {
        advance_body(&b, &ground, 0.1);
        assert_true(lowest_vertex(&b) >= -1e-14);
        lost = last - soft_body_energy(&b, ground.gravity);
        assert_true(lost >= 0.0);
        last -= lost;
    }
    soft_momentum m = soft_momentum_of(&b);
    assert_true(m.centre[2] > 0.6 && m.centre[2] < 0.9);
    assert_true(fabs(m.linear[2]) < 0.02 * m.mass);
    assert_true(lost < 1e-3 * (start - last));
    soft_body_free(&b);
}

/* The ground pushes upwards only, unless there is friction. */
TEST(friction_alone_brakes) {
    double speeds[3];
    const double frictions[3] = {0.0, 0.2, 0.8};
    for (int i = 0; i < 3; i++) {
        soft_body b = soft_body_of(&sphere, 0.4, &rubber);
        obstacles ground = {.gravity = 10.0, .friction = frictions[i]};
        soft_body_lift(&b, 0.01 - lowest_vertex(&b));
        soft_body_throw(&b, (double[3]){2.0, 0.0, 0.0}, (double[3]){0.0, 0.0, 0.0});
        advance_body(&b, &ground, 0.25);
        soft_momentum m = soft_momentum_of(&b);
        speeds[i] = m.linear[0] / m.mass;
        assert_near(m.linear[1], 0.0, i == 0 ? 1e-10 : 0.01 * m.mass);
        soft_body_free(&b);
    }
    assert_near(speeds[0], 2.0, 1e-10);
    assert_true(speeds[1] < 1.9 && speeds[2] < speeds[1] && speeds[2] > 0.0);
}

/* A box that slides is braked by mu g, as by Coulomb's law, and not more. */
TEST(friction_is_coulombs) {
    body box = box_body((double[3]){-1.0, -1.0, -0.25}, (double[3]){1.0, 1.0, 0.25});
    material stiff = {.density = 1.0, .young = 2000.0, .poisson = 0.3, .damping = 10.0};
    soft_body b = soft_body_of(&box, 0.5, &stiff);
    obstacles ground = {.gravity = 10.0, .friction = 0.2};
    soft_body_lift(&b, -lowest_vertex(&b));
    advance_body(&b, &ground, 1.0);
    soft_body_throw(&b, (double[3]){3.0, 0.0, 0.0}, (double[3]){0.0, 0.0, 0.0});
    double before = soft_momentum_of(&b).linear[0];
    advance_body(&b, &ground, 0.5);
    soft_momentum m = soft_momentum_of(&b);
    print_message("braked by %.4g of mu g\n", (before - m.linear[0]) / m.mass / (0.2 * 10.0 * 0.5));
    assert_near((before - m.linear[0]) / m.mass, 0.2 * 10.0 * 0.5, 0.1);
    soft_body_free(&b);
    body_free(&box);
}

/* The contact is off centre and has friction: the ball gains what the body loses. */
TEST(balls_and_bodies_share_their_momentum) {
    soft_body b = soft_body_of(&sphere, 0.4, &rubber);
    obstacles o = {.friction = 0.6, .ball_count = 1};
    o.balls[0] = (ball){.centre = {2.2, 0.4, soft_fixture_height + 0.3},
                        .velocity = {-1.0, 0.0, 0.0},
                        .radius = 0.6,
                        .mass = 3.0};
    soft_body_throw(&b, (double[3]){2.0, 0.0, 0.0}, (double[3]){0.0, 0.0, 2.0});
    soft_momentum before = soft_momentum_of(&b);
    double energy = soft_body_energy(&b, 0.0) + obstacles_energy(&o), last = energy;
    for (int i = 0; i < 40; i++) {
        advance_body(&b, &o, 0.05);
        soft_momentum now = soft_momentum_of(&b);
        const double *v = o.balls[0].velocity;
        for (int k = 0; k < 3; k++)
            assert_near(now.linear[k] + 3.0 * v[k], before.linear[k] + (k == 0 ? -3.0 : 0.0), 1e-9);
        assert_true(soft_body_energy(&b, 0.0) + obstacles_energy(&o) <= last * (1.0 + 1e-9));
        last = soft_body_energy(&b, 0.0) + obstacles_energy(&o);
    }
    soft_momentum after = soft_momentum_of(&b);
    assert_true(o.balls[0].velocity[0] > after.linear[0] / after.mass); /* they came apart */
    assert_true(after.linear[0] < before.linear[0] - 1.0 && last < energy);
    soft_body_free(&b);
}

TEST(motion_is_repeatable) {
    soft_body bodies[2];
    for (int i = 0; i < 2; i++) {
        obstacles ground = {.gravity = 10.0, .friction = 0.6, .ball_count = 1};
        ground.balls[0] = (ball){.centre = {0.5, 0.0, 0.5}, .radius = 0.5, .mass = 0.5};
        bodies[i] = soft_body_of(&sphere, 0.4, &rubber);
        soft_body_lift(&bodies[i], 1.5 - soft_fixture_height);
        advance_body(&bodies[i], &ground, 1.0);
    }
    size_t bytes = (size_t)bodies[0].frame.node_count * 3 * sizeof(double);
    assert_memory_equal(bodies[0].nodes, bodies[1].nodes, bytes);
    assert_memory_equal(bodies[0].velocities, bodies[1].velocities, bytes);
    for (int i = 0; i < 2; i++) soft_body_free(&bodies[i]);
}

AROUND_ALL(make_sphere, free_sphere)
