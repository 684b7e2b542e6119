/* The energies of the IPC solver, compared with finite differences: barrier, mollifier, springs, near
 * pairs. */
#include "models/common/vec3.h"
#include "models/ipc/newton_system.h"
#include "models/shapes/catalogue.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static void assert_close(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

TEST(barrier_has_its_derivatives) {
    const double reach = 0.03, small = 1e-6;
    for (int i = 1; i < 100; i++) {
        double d = reach * i / 100.0, h = small * d;
        ipc_curve at = ipc_barrier(d, reach), below = ipc_barrier(d - h, reach),
                  above = ipc_barrier(d + h, reach);
        assert_true(at.value > 0.0 && at.slope < 0.0 && at.curvature > 0.0);
        assert_close((above.value - below.value) / (2.0 * h), at.slope, 1e-6 * fabs(at.slope) + 1e-10);
        assert_close((above.slope - below.slope) / (2.0 * h), at.curvature, 1e-6 * at.curvature + 1e-7);
    }
}

/* The value and two derivatives go to 0 at the reach; the value exceeds every bound at 0. */
TEST(barrier_begins_smoothly_and_has_no_end) {
    ipc_curve before = ipc_barrier(1.0 - 1e-9, 1.0), at = ipc_barrier(1.0, 1.0), far = ipc_barrier(7.0, 1.0);
    assert_close(before.value, 0.0, 1e-25);
    assert_close(before.slope, 0.0, 1e-16);
    assert_close(before.curvature, 0.0, 1e-8);
    assert_true(at.value == 0.0 && at.slope == 0.0 && at.curvature == 0.0);
    assert_true(far.value == 0.0 && far.slope == 0.0 && far.curvature == 0.0);
    assert_true(ipc_barrier(0.0, 1.0).value == INFINITY);
    for (double d = 0.5, last = 0.0; d > 1e-300; d *= 0.5) {
        double value = ipc_barrier(d, 1.0).value;
        assert_true(value > last);
        last = value;
    }
    assert_true(ipc_barrier(1e-300, 1.0).value > 600.0);
}

TEST(mollifier_goes_from_none_to_all) {
    const double threshold = 0.7, h = 1e-6;
    assert_true(ipc_mollifier(0.0, threshold).value == 0.0);
    assert_true(ipc_mollifier(threshold, threshold).value == 1.0);
    assert_true(ipc_mollifier(2.0, threshold).slope == 0.0);
    assert_close(ipc_mollifier(threshold * (1.0 - 1e-9), threshold).slope, 0.0, 1e-8);
    for (int i = 1; i < 20; i++) {
        double c = threshold * i / 20.0;
        ipc_curve at = ipc_mollifier(c, threshold);
        double below = ipc_mollifier(c - h, threshold).value, above = ipc_mollifier(c + h, threshold).value;
        assert_close((above - below) / (2.0 * h), at.slope, 1e-8);
        assert_close((above - 2.0 * at.value + below) / (h * h), at.curvature, 1e-3);
    }
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

/* ---- pairs that are near ------------------------------------------------------------------------------ */

/* Two tetrahedra, edge over edge or vertex over face, turned a little at random. */
static const uint32_t tetrahedra[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7};

typedef struct near_fixture {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    double x[24];
} near_fixture;

static const ipc_barrier_options barrier = {.reach = 0.3, .stiffness = 2.0};

static near_fixture proximity_make(uint64_t seed, bool edges, double lean) {
    static const double shape[12] = {-1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, -1.0, -1.0};
    random_stream random = stream_start(seed);
    const cscd_object_desc desc = cscd_object_of_triangles(8, 8, tetrahedra);
    near_fixture f;
    assert_int_equal(cscd_context_create(NULL, &f.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(f.context, &desc, 1, &f.mesh), CSCD_OK);
    assert_int_equal(detector_create_here(f.mesh, NULL, NULL, &f.detector), CSCD_OK);
    for (int i = 0; i < 12; i++) f.x[i] = shape[i];
    for (int v = 0; v < 4; v++) { /* turned over; the upper edge lies along (cos, sin) of the lean */
        const double *p = shape + v * 3;
        double *q = f.x + 12 + v * 3;
        q[0] = p[0] * cos(lean) - p[1] * sin(lean) + (edges ? 0.1 : 0.6);
        q[1] = p[0] * sin(lean) + p[1] * cos(lean) + 0.15;
        q[2] = 0.12 - p[2];
    }
    for (int i = 0; i < 24; i++) f.x[i] += stream_between(&random, -0.01, 0.01);
    return f;
}

static void proximity_free(near_fixture *f) {
    cscd_detector_destroy(f->detector);
    cscd_mesh_destroy(f->mesh);
    cscd_context_destroy(f->context);
}

static void find_contacts(near_fixture *f, const double *x, ipc_contacts *contacts) {
    cscd_proximities near;
    assert_int_equal(set_rest_packed(f->detector, f->x), CSCD_OK);
    assert_int_equal(find_unique_packed(f->detector, x, barrier.reach, &near), CSCD_OK);
    ipc_contacts_find(contacts, x, &near, &barrier);
}

/* Checks the gradient along each coordinate; the pairs are found again at each point. */
static void check_gradient(near_fixture *f, double tolerance) {
    ipc_contacts contacts = {0}, moved = {0};
    double gradient[24] = {0.0}, sum[3] = {0.0, 0.0, 0.0};
    find_contacts(f, f->x, &contacts);
    assert_true(contacts.count > 0 && contacts.energy > 0.0 && contacts.least_distance < barrier.reach);
    ipc_contacts_add_gradient(&contacts, gradient);
    for (int i = 0; i < 24; i++) {
        double there[24], energies[2], h = 1e-7;
        for (int side = 0; side < 2; side++) {
            memcpy(there, f->x, sizeof there);
            there[i] += side == 0 ? -h : h;
            find_contacts(f, there, &moved);
            energies[side] = moved.energy;
        }
        assert_close((energies[1] - energies[0]) / (2.0 * h), gradient[i], tolerance);
        sum[i % 3] += gradient[i];
    }
    for (int k = 0; k < 3; k++) assert_close(sum[k], 0.0, 1e-12); /* they are inner forces */
    ipc_contacts_free(&contacts);
    ipc_contacts_free(&moved);
}

TEST(near_pairs_have_their_gradient) {
    for (uint64_t seed = 0; seed < 40; seed++) {
        near_fixture f = proximity_make(seed, seed % 2 == 0, 0.3 + 0.03 * (double)seed);
        check_gradient(&f, 1e-5);
        proximity_free(&f);
    }
}

/* The edges are so nearly parallel that they fade: the mollifier's part of the gradient counts. */
TEST(nearly_parallel_edges_have_their_gradient) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        near_fixture f = proximity_make(seed, true, 0.012);
        for (int v = 0; v < 8; v++) {
            if (v % 4 >= 2) continue;
            f.x[v * 3 + 1] = v < 4 ? 0.0 : 0.1 + (v == 4 ? -0.01 : 0.012);
            f.x[v * 3 + 2] = v < 4 ? 0.0 : 0.1;
        }
        check_gradient(&f, 1e-5);
        proximity_free(&f);
    }
}

/* x . Hessian x is the sum of curvature * (change of distance)^2; differences give the change of each
 * distance. */
TEST(near_pairs_have_their_curvature) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        near_fixture f = proximity_make(seed, seed % 2 == 0, 0.9);
        random_stream random = stream_start(1000 + seed);
        ipc_contacts contacts = {0};
        double direction[24], product[24] = {0.0}, expected = 0.0, there[24], h = 1e-6;
        cscd_proximities near;
        for (int i = 0; i < 24; i++) direction[i] = stream_between(&random, -1.0, 1.0);
        find_contacts(&f, f.x, &contacts);
        ipc_contacts_add_product(&contacts, direction, product);
        for (size_t c = 0; c < contacts.count; c++) {
            double distance[2] = {-1.0, -1.0};
            for (int side = 0; side < 2; side++) {
                for (int i = 0; i < 24; i++) there[i] = f.x[i] + (side == 0 ? -h : h) * direction[i];
                assert_int_equal(find_unique_packed(f.detector, there, 2.0 * barrier.reach, &near), CSCD_OK);
                for (size_t n = 0; n < near.count; n++) {
                    const cscd_proximity *p = &near.items[n];
                    if (memcmp(p->vertices, contacts.items[c].vertices, sizeof p->vertices) == 0)
                        distance[side] = p->distance;
                }
            }
            double change = (distance[1] - distance[0]) / (2.0 * h);
            assert_true(contacts.items[c].curvature >= 0.0);
            expected += contacts.items[c].curvature * change * change;
        }
        assert_close(directional_derivative(product, direction, 24), expected, 1e-5 * (1.0 + expected));
        ipc_contacts_free(&contacts);
        proximity_free(&f);
    }
}
