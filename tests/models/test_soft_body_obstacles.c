/* Ground, stairs and balls: their heights, the shortest ways out of them, and the motion of balls. */
#include "models/common/vec3.h"
#include "models/softbody/softbody.h"
#include "tests/support/test.h"

/* The tops of the stairs are at 1.5, 1 and 0.5, and end at x = 3, 5 and 7. */
static const obstacles stairs = {.step_count = 3, .start = 1.0, .tread = 2.0, .riser = 0.5, .gravity = 10.0};
static const double step = 1.0 / 800.0;

TEST(heights_are_those_of_the_steps) {
    const obstacles ground = {0};
    const double places[][2] = {{-100.0, 1.5}, {0.0, 1.5}, {1.0, 1.5}, {2.9, 1.5}, {3.1, 1.0},
                                {4.9, 1.0},    {5.1, 0.5}, {6.9, 0.5}, {7.1, 0.0}, {100.0, 0.0}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        assert_true(obstacles_height(&stairs, places[i][0]) == places[i][1]);
        assert_true(obstacles_height(&ground, places[i][0]) == 0.0);
    }
}

static void expect_way_out(const obstacles *o, double x, double z, double forwards, double depth) {
    obstacle_hit hit;
    if (!obstacles_hit_terrain(o, (double[3]){x, 0.3, z}, &hit)) fail_msg("(%g, %g) is outside", x, z);
    assert_true(hit.normal[0] == forwards && hit.normal[1] == 0.0 && hit.normal[2] == 1.0 - forwards);
    assert_true(fabs(hit.depth - depth) < 1e-14);
    assert_null(hit.pushed);
}

/* The way out leads upwards, or forwards through a riser when that is nearer. Below the ground it always
 * leads upwards. */
TEST(way_out_is_the_nearer_one) {
    const obstacles ground = {0};
    expect_way_out(&ground, 2.0, -0.25, 0.0, 0.25);
    expect_way_out(&stairs, 2.0, 1.4, 0.0, 0.1);
    expect_way_out(&stairs, 2.95, 1.4, 1.0, 0.05);
    expect_way_out(&stairs, 2.85, 1.4, 0.0, 0.1);
    expect_way_out(&stairs, -3.0, 1.2, 0.0, 0.3);
    expect_way_out(&stairs, 4.99, 0.9, 1.0, 0.01);
    expect_way_out(&stairs, 2.9, 0.9, 0.0, 0.6); /* behind two risers: 2.1 to the second */
    expect_way_out(&stairs, 6.9, 0.1, 1.0, 0.1);
    expect_way_out(&stairs, 6.9, -0.1, 0.0, 0.6);
    expect_way_out(&stairs, 8.0, -0.1, 0.0, 0.1);
}

/* Between walls the way out leads back over the wall, or up where the point is deeper in the ground. */
TEST(trays_have_walls) {
    const obstacles o = {.tray = 2.0};
    static const struct {
        double point[3], normal[3], depth;
    } inside[] = {{{2.25, 0.5, 1.0}, {-1.0, 0.0, 0.0}, 0.25},
                  {{-2.5, 1.0, 9.0}, {1.0, 0.0, 0.0}, 0.5},
                  {{1.0, 2.125, -0.1}, {0.0, -1.0, 0.0}, 0.125},
                  {{2.1, -2.5, 0.5}, {0.0, 1.0, 0.0}, 0.5},
                  {{2.125, 0.0, -0.25}, {0.0, 0.0, 1.0}, 0.25}};
    obstacle_hit hit;
    for (size_t i = 0; i < sizeof inside / sizeof *inside; i++) {
        assert_true(obstacles_hit_terrain(&o, inside[i].point, &hit));
        assert_memory_equal(hit.normal, inside[i].normal, sizeof hit.normal);
        assert_true(hit.depth == inside[i].depth && hit.pushed == NULL);
    }
    assert_false(obstacles_hit_terrain(&o, (double[3]){1.9, -1.9, 0.1}, &hit));
}

/* After moving along the way out, a point is outside of all obstacles, or on a surface. */
TEST(way_out_leads_out) {
    uint32_t inside = 0, forwards = 0;
    for (int i = 0; i < 2000; i++) {
        double point[3] = {0.005 * i - 1.003, 0.0, 0.0};
        for (point[2] = -0.317; point[2] < 1.7; point[2] += 0.0931) {
            obstacle_hit hit;
            double out[3] = {point[0], point[1], point[2]};
            bool hits = obstacles_hit_terrain(&stairs, point, &hit);
            assert_true(hits == (point[2] < obstacles_height(&stairs, point[0])));
            if (!hits) continue;
            vec3_add_scaled(out, hit.depth + 1e-12, hit.normal);
            assert_false(obstacles_hit_terrain(&stairs, out, &hit));
            inside++;
            forwards += out[0] > point[0];
        }
    }
    assert_true(inside > 1000 && forwards > 100 && forwards < inside);
}

TEST(balls_push_from_their_centres) {
    obstacles o = {.ball_count = 2, .balls = {{.radius = 1.0, .mass = 1.0}, {.radius = 0.5, .mass = 1.0}}};
    obstacle_hit hit;
    o.balls[1].centre[0] = 5.0;
    assert_false(obstacles_hit_ball(&o, 0, (double[3]){0.0, 1.01, 0.0}, &hit));
    assert_false(obstacles_hit_ball(&o, 1, (double[3]){0.0, 0.3, 0.4}, &hit));
    assert_false(obstacles_hit_ball(&o, 0, (double[3]){0.0, 0.0, 0.0}, &hit)); /* all ways are equally long */
    assert_true(obstacles_hit_ball(&o, 0, (double[3]){0.0, 0.3, 0.4}, &hit));
    assert_true(fabs(hit.depth - 0.5) < 1e-15 && hit.pushed == &o.balls[0]);
    assert_true(hit.normal[0] == 0.0 && fabs(hit.normal[1] - 0.6) < 1e-15 &&
                fabs(hit.normal[2] - 0.8) < 1e-15);
    assert_true(obstacles_hit_ball(&o, 1, (double[3]){5.4, 0.0, 0.0}, &hit));
    assert_true(fabs(hit.depth - 0.1) < 1e-15 && hit.pushed == &o.balls[1] && hit.normal[0] == 1.0);
}

static void run_steps(obstacles *o, int steps) {
    for (int i = 0; i < steps; i++) {
        obstacles_begin(o, step);
        obstacles_end(o, step);
    }
}

/* The centre falls by n steps of gravity after velocity, and stays on the ground. */
TEST(balls_fall_and_come_to_rest) {
    const ball high = {.centre = {0.0, 0.0, 5.0}, .velocity = {1.0, 0.0, 0.0}, .radius = 0.5, .mass = 2.0};
    obstacles o = {.ball_count = 1, .gravity = 10.0, .balls = {high}};
    run_steps(&o, 400);
    assert_true(fabs(o.balls[0].centre[2] - (5.0 - 10.0 * step * step * 0.5 * 400.0 * 401.0)) < 1e-10);
    assert_true(fabs(o.balls[0].centre[0] - 0.5) < 1e-10 && o.balls[0].centre[1] == 0.0);
    double energy = obstacles_energy(&o);
    assert_true(fabs(energy - 2.0 * (0.5 + 10.0 * 5.0)) < 0.1);
    run_steps(&o, 1200);
    assert_true(fabs(o.balls[0].centre[2] - 0.5) < 1e-12 && fabs(o.balls[0].velocity[2]) < 1e-9);
    assert_true(fabs(o.balls[0].centre[0] - 2.0) < 1e-10); /* it slides */
    assert_true(obstacles_energy(&o) < energy);
}

TEST(balls_stay_on_the_stairs) {
    obstacles o = stairs;
    o.ball_count = 1;
    o.balls[0] = (ball){.centre = {0.0, 0.0, 2.0}, .velocity = {3.0, 0.0, 0.0}, .radius = 0.25, .mass = 1.0};
    double last = obstacles_energy(&o);
    for (int i = 0; i < 2400; i++) {
        run_steps(&o, 1);
        const ball *b = &o.balls[0];
        assert_true(b->centre[2] >= obstacles_height(&o, b->centre[0]) + b->radius);
        assert_true(obstacles_energy(&o) <= last + 1e-10);
        last = obstacles_energy(&o);
    }
    assert_true(o.balls[0].centre[0] > 8.0 && fabs(o.balls[0].centre[2] - 0.25) < 1e-12);
}

/* Balls of unequal mass touch off centre: momentum stays, energy does not rise, and they part. */
TEST(colliding_balls_keep_their_momentum) {
    obstacles o = {.ball_count = 2};
    o.balls[0] = (ball){.centre = {-2.0, 0.0, 9.0}, .velocity = {4.0, 0.0, 0.0}, .radius = 0.5, .mass = 3.0};
    o.balls[1] = (ball){.centre = {1.0, 0.4, 9.1}, .velocity = {-1.0, 0.0, 0.5}, .radius = 0.7, .mass = 1.0};
    double energy = obstacles_energy(&o), apart[3], nearest = INFINITY;
    for (int i = 0; i < 1600; i++) {
        run_steps(&o, 1);
        vec3_subtract(o.balls[0].centre, o.balls[1].centre, apart);
        nearest = fmin(nearest, vec3_norm(apart));
        assert_true(obstacles_energy(&o) <= energy + 1e-12);
    }
    double expected[3] = {11.0, 0.0, 0.5};
    for (int k = 0; k < 3; k++) {
        double momentum = 3.0 * o.balls[0].velocity[k] + o.balls[1].velocity[k];
        assert_true(fabs(momentum - expected[k]) < 1e-10);
    }
    assert_true(nearest > 1.2 - 1e-12 && nearest < 1.21);
    double leaving[3];
    vec3_subtract(o.balls[0].velocity, o.balls[1].velocity, leaving);
    assert_true(vec3_dot(leaving, apart) > -1e-10 && vec3_norm(apart) > 1.2 - 1e-12);
    assert_true(obstacles_energy(&o) < 0.99 * energy);
}

/* The scenery has boxes for the ground and for each step, as high as they are, followed by the balls. */
TEST(scenery_shows_them) {
    obstacles o = stairs;
    body scenery;
    io_error error;
    o.ball_count = 2;
    o.balls[0] = (ball){.centre = {0.0, 0.0, 2.0}, .radius = 0.5};
    o.balls[1] = (ball){.centre = {4.0, 1.0, 2.0}, .radius = 0.25};
    assert_true(scenery_make(&o, &scenery, &error));
    for (uint32_t i = 0; i < 3; i++) {
        const double *top = scenery.positions + ((i + 1) * 8 + 7) * 3; /* the corner at the largest x, y, z */
        assert_true(top[0] == o.start + (i + 1) * o.tread && top[2] == obstacles_height(&o, top[0] - 0.1));
    }
    for (int turn = 0; turn < 2; turn++) {
        uint32_t first = 4 * 8, each = (scenery.vertex_count - first) / 2;
        assert_true(each > 100);
        for (uint32_t v = first; v < scenery.vertex_count; v++) {
            const ball *b = &o.balls[(v - first) / each];
            double arm[3];
            vec3_subtract(scenery.positions + v * 3, b->centre, arm);
            assert_true(fabs(vec3_norm(arm) - b->radius) < 1e-6);
        }
        o.balls[turn].centre[0] += 1.5;
        assert_true(scenery_follow(&o, &scenery, &error));
    }
    assert_true(body_volume(&scenery) > 24.0 * 24.0 * 0.5);
    body_free(&scenery);
}
