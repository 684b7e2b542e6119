/* The springs of the IPC solver, compared with finite differences. */
#include "models/common/vec3.h"
#include "models/ipc/newton_system.h"
#include "models/shapes/catalogue.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static void assert_close(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

static const ipc_stuff stuff = {.density = 1.0, .membrane = 100.0, .solid = 500.0};

static body make_body(body_kind kind, uint32_t triangles) {
    body b;
    io_error error;
    if (!body_make(kind, triangles, &b, &error)) fail_msg("%s", error.text);
    return b;
}

static double *moved_copy(const body *b, double scale, double noise, uint64_t seed) {
    random_stream random = stream_start(seed);
    double *out = body_allocate(b->vertex_count, 3 * sizeof *out);
    for (uint32_t i = 0; i < b->vertex_count * 3; i++)
        out[i] = scale * b->positions[i] + stream_between(&random, -noise, noise);
    return out;
}

/* Each edge has one spring, each vertex one strut or more, and all are sorted. There is no energy at rest,
 * wherever the body is. */
TEST(springs_hold_the_body) {
    static const body_kind kinds[] = {BODY_SPHERE, BODY_TORUS, BODY_PAWN};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        body b = make_body(kinds[k], 600);
        ipc_springs springs = {0};
        ipc_springs_add_body(&springs, &b, 0, &stuff);
        uint32_t edges = b.triangle_count / 2 * 3;
        assert_true(springs.count >= edges + b.vertex_count && springs.count <= edges + 5 * b.vertex_count);
        for (uint32_t i = 0; i < springs.count; i++) {
            const ipc_spring *s = &springs.items[i], *last = i > 0 ? s - 1 : NULL;
            assert_true(s->a < s->b && s->b < b.vertex_count && s->rest > 0.0 && s->stiffness > 0.0);
            assert_true(last == NULL || last->a < s->a || (last->a == s->a && last->b < s->b));
        }
        assert_true(ipc_springs_energy(&springs, b.positions) == 0.0);
        double *wide = moved_copy(&b, 1.1, 0.0, 1), expected = 0.0;
        for (uint32_t i = 0; i < springs.count; i++)
            expected +=
                0.5 * springs.items[i].stiffness * 0.01 * springs.items[i].rest * springs.items[i].rest;
        assert_close(ipc_springs_energy(&springs, wide), expected, 1e-9 * expected);
        free(wide);
        ipc_springs_free(&springs);
        body_free(&b);
    }
}

static double directional_derivative(const double *gradient, const double *direction, uint32_t count) {
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) sum += gradient[i] * direction[i];
    return sum;
}

TEST(springs_have_their_gradient) {
    body b = make_body(BODY_TORUS, 400);
    ipc_springs springs = {0};
    uint32_t count = b.vertex_count * 3;
    ipc_springs_add_body(&springs, &b, 0, &stuff);
    for (uint64_t seed = 0; seed < 20; seed++) {
        double *x = moved_copy(&b, 1.0, 0.05, seed), *direction = moved_copy(&b, 0.0, 1.0, 100 + seed);
        double *gradient = body_allocate(count, sizeof *gradient), energies[2];
        for (int side = 0; side < 2; side++) {
            double *there = body_allocate(count, sizeof *there), h = side == 0 ? -1e-6 : 1e-6;
            for (uint32_t i = 0; i < count; i++) there[i] = x[i] + h * direction[i];
            energies[side] = ipc_springs_energy(&springs, there);
            free(there);
        }
        ipc_springs_add_gradient(&springs, x, gradient);
        double slope = directional_derivative(gradient, direction, count);
        assert_close((energies[1] - energies[0]) / 2e-6, slope, 1e-6 * fabs(slope) + 1e-4);
        free(x);
        free(direction);
        free(gradient);
    }
    ipc_springs_free(&springs);
    body_free(&b);
}

/* When a spring is stretched, its Hessian is the derivative of the force; when it is compressed, only the
 * part along it is kept. */
TEST(spring_hessians_are_semidefinite) {
    ipc_spring spring = {0, 1, 1.0, 3.0};
    const ipc_springs springs = {&spring, 1, 1};
    for (int stretched = 0; stretched < 2; stretched++) {
        const double along[6] = {0.6, 0.0, 0.8}, aside[6] = {0.0, 1.0, 0.0}, length = stretched ? 1.7 : 0.6;
        double x[6] = {0.1, 0.2, 0.3}, force[6] = {0.0}, other[6] = {0.0}, turned[6] = {0.0};
        ipc_spring_hessian hessian;
        for (int k = 0; k < 3; k++) x[3 + k] = x[k] + length * along[k];
        ipc_springs_hessians(&springs, x, &hessian);
        ipc_springs_add_product(&springs, &hessian, along, force);
        ipc_springs_add_product(&springs, &hessian, aside, other);
        for (int k = 0; k < 3; k++) {
            double expected = (stretched ? 3.0 * (1.0 - 1.0 / length) : 0.0) * aside[k];
            assert_close(force[k], 3.0 * along[k], 1e-12);
            assert_close(force[3 + k], -3.0 * along[k], 1e-12);
            assert_close(other[k], expected, 1e-12);
            assert_close(other[3 + k], -expected, 1e-12);
        }
        if (!stretched) continue;
        double gradient[2][6] = {{0.0}};
        for (int side = 0; side < 2; side++) {
            double there[6];
            memcpy(there, x, sizeof there);
            there[0] += side == 0 ? -1e-6 : 1e-6;
            ipc_springs_add_gradient(&springs, there, gradient[side]);
        }
        ipc_springs_add_product(&springs, &hessian, (const double[6]){1.0}, turned);
        for (int k = 0; k < 6; k++) assert_close((gradient[1][k] - gradient[0][k]) / 2e-6, turned[k], 1e-8);
    }
}
