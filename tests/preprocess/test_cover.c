/* Bodies that no loop alone parts, and those that no crease marks: as many regions as are needed, each of which its point sees. */
#include "preprocess/charges.h"
#include "preprocess/regions/regions.h"
#include "preprocess/regions/visibility.h"
#include "tests/support/preprocess/region_check.h"
#include "tests/support/preprocess/visible_share.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Larger bodies take too long where the code is not optimised. */
#if defined(NDEBUG) && !defined(SLOW_MACHINE)
enum { TRIANGLES_MOST = 20000 };
#else
enum { TRIANGLES_MOST = 5000 };
#endif

static const double pi = 3.14159265358979323846;

/* The regions of a body by its charge, which are connected; *share is what the points see. */
static uint32_t divide_by_charge(const body *b, double *share) {
    cscd_mesh *mesh = body_mesh(b, 2);
    uint32_t *regions = body_allocate(b->triangle_count, sizeof *regions), count;
    double *density = body_allocate(b->triangle_count, sizeof *density), *points = NULL;
    double *capacitance = body_allocate(mesh->component_count, sizeof *capacitance);
    assert_int_equal(
        charge_solve(mesh, b->positions, &(charge_options){CSCD_CHARGE_TREE, 0}, density, capacitance, NULL),
        CSCD_OK);
    assert_int_equal(regions_from_charge(mesh, b->positions, density, NULL, regions, &count, &points),
                     CSCD_OK);
    check_regions(mesh, regions, count);
    *share = visible_share(mesh, b->positions, regions, points);
    context_free(mesh->context, points);
    free(regions);
    free(density);
    free(capacitance);
    body_mesh_destroy(mesh);
    return count;
}

/* A tube around a closed curve or an arc of a circle of radius R; an arc has round ends. */
static void add_tube(body *b, double R, double r, double angle, const double offset[3]) {
    enum { AROUND = 24 };
    const bool closed = angle >= 2.0 * pi;
    const uint32_t along = (uint32_t)(angle * R / (2.0 * pi * r) * AROUND), first = b->vertex_count;
    const uint32_t caps = closed ? 0 : AROUND / 4 - 1, rings = along + (closed ? 0 : 1) + 2 * caps;
    for (uint32_t i = 0; i < rings; i++) {
        const double step = (double)i - caps, inside = fmin(fmax(step, 0.0), along),
                     u = inside / along * angle;
        const double lift = (step - inside) * 2.0 * pi / AROUND, radius = r * cos(lift),
                     ahead = r * sin(lift);
        for (uint32_t j = 0; j < AROUND; j++) {
            const double v = 2.0 * pi * (j + 0.5 * (i % 2)) / AROUND, out = R + radius * cos(v);
            body_add_vertex(b, offset[0] + out * cos(u) - ahead * sin(u),
                            offset[1] + out * sin(u) + ahead * cos(u), offset[2] + radius * sin(v));
        }
    }
    for (uint32_t i = 0; i < rings - !closed; i++) {
        for (uint32_t j = 0; j < AROUND; j++) {
            const uint32_t k = (j + 1) % AROUND, next = (i + 1) % rings;
            const uint32_t a = first + i * AROUND + j, c = first + i * AROUND + k,
                           e = first + next * AROUND + j, f = first + next * AROUND + k;
            if (i % 2 == 0) {
                body_add_triangle(b, a, e, c);
                body_add_triangle(b, c, e, f);
            } else {
                body_add_triangle(b, a, e, f);
                body_add_triangle(b, a, f, c);
            }
        }
    }
    for (int end = 0; end < 2 && !closed; end++) {
        const uint32_t ring = first + (end ? (rings - 1) * AROUND : 0);
        const double u = end ? angle : 0.0, ahead = end ? r : -r;
        const uint32_t tip = body_add_vertex(b, offset[0] + R * cos(u) - ahead * sin(u),
                                             offset[1] + R * sin(u) + ahead * cos(u), offset[2]);
        for (uint32_t j = 0; j < AROUND; j++) {
            const uint32_t k = (j + 1) % AROUND;
            body_add_triangle(b, tip, ring + (end ? k : j), ring + (end ? j : k));
        }
    }
}

static const double nowhere[3] = {0.0, 0.0, 0.0};

/* An arc that a point at its outer side sees spans 2 acos((R - r) / (R + r)). */
static void tori_fall_into_arcs(void **state) {
    (void)state;
    static const double radii[] = {1.5, 2.5, 4.0, 10.0};
    for (int i = 0; i < 4; i++) {
        body b = {0};
        double share;
        add_tube(&b, radii[i], 1.0, 2.0 * pi, nowhere);
        assert_true(body_volume(&b) > 0.0);
        const uint32_t least = (uint32_t)ceil(pi / acos((radii[i] - 1.0) / (radii[i] + 1.0)));
        const uint32_t count = divide_by_charge(&b, &share);
        print_message("  torus %g : 1, %u triangles: %u regions, at least %u; visible %.4f\n", radii[i],
                      b.triangle_count, count, least, share);
        assert_true(count >= least && count <= least + 1);
        assert_true(share >= 0.99);
        body_free(&b);
    }
}

static void each_link_of_a_chain(void **state) {
    (void)state;
    body b = {0};
    double share, alone;
    add_tube(&b, 3.0, 1.0, 2.0 * pi, nowhere);
    const uint32_t one = divide_by_charge(&b, &alone);
    add_tube(&b, 3.0, 1.0, 2.0 * pi, (double[3]){20.0, 0.0, 0.0});
    assert_int_equal(divide_by_charge(&b, &share), 2 * one);
    assert_true(share >= 0.99);
    body_free(&b);
}

/* A straight capsule stays whole, and a bent one is cut, also where nothing but its bend tells where. */
static void bent_capsules_are_cut(void **state) {
    (void)state;
    static const double angles[] = {0.02, 2.0, 3.0, 4.5};
    static const uint32_t least[] = {1, 2, 2, 2}, most[] = {1, 2, 3, 4};
    for (int i = 0; i < 4; i++) {
        body b = {0};
        double share;
        add_tube(&b, 5.0 / angles[i], 1.0, angles[i], nowhere);
        assert_true(body_volume(&b) > 0.0);
        const uint32_t count = divide_by_charge(&b, &share);
        print_message("  capsule bent by %g, %u triangles: %u regions; visible %.4f\n", angles[i],
                      b.triangle_count, count, share);
        assert_true(count >= least[i] && count <= most[i]);
        assert_true(share >= 0.98);
        body_free(&b);
    }
}

typedef struct expectation {
    body_kind kind;
    uint32_t triangle_count, least, most;
    double share;
} expectation;

static void bodies_of_the_catalogue(void **state) {
    (void)state;
    static const expectation expected[] = {
        {BODY_SPHERE, 2000, 1, 1, 1.0},  {BODY_ELLIPSOID, 2000, 1, 1, 1.0},
        {BODY_CUBE, 1200, 1, 1, 1.0},    {BODY_CAPSULE, 2000, 1, 1, 1.0},
        {BODY_PAWN, 5130, 2, 3, 0.99},   {BODY_DUMBBELL, 4000, 2, 2, 0.99},
        {BODY_FIGURE, 4014, 6, 9, 0.99}, {BODY_FIGURE, 20000, 6, 9, 0.99},
        {BODY_GENUS2, 3000, 5, 8, 0.99}, {BODY_COIL, 6000, 15, 25, 0.97},
        {BODY_HAND, 6000, 6, 6, 0.99},   {BODY_OCTOPUS, 12000, 9, 17, 0.94},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const expectation *e = &expected[i];
        if (e->triangle_count > TRIANGLES_MOST) continue;
        body b = body_of(e->kind, e->triangle_count);
        double share;
        const uint32_t count = divide_by_charge(&b, &share);
        print_message("  %s, %u triangles: %u regions; visible %.4f\n", body_kind_name(e->kind),
                      b.triangle_count, count, share);
        assert_true(count >= e->least && count <= e->most);
        assert_true(share >= e->share);
        body_free(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tori_fall_into_arcs),
        cmocka_unit_test(each_link_of_a_chain),
        cmocka_unit_test(bent_capsules_are_cut),
        cmocka_unit_test(bodies_of_the_catalogue),
    };
    return cmocka_run_group_tests_name("cover", tests, NULL, NULL);
}
