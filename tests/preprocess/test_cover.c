/* Bodies that no loop alone parts, and those that no crease marks: as many regions as are needed, each of which its point sees. */
#include "preprocess/preprocess.h"
#include "preprocess/regions/regions.h"
#include "tests/support/models/bodies.h"
#include "tests/support/preprocess/tiled_body.h"
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

/* The length of the borders. */
static double border_length(const cscd_mesh *mesh, const double *positions, const uint32_t *regions) {
    double sum = 0.0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[e];
        if (regions[star[0]] != regions[star[1]]) sum += surface_edge_length(mesh, positions, e);
    }
    return sum;
}

/* The regions of a body by its charge, which are connected; *share is what the points see, and *border the length of the borders. */
static uint32_t divide_by_charge(const body *b, double *share, double *border) {
    cscd_mesh *mesh = body_mesh(b, 2);
    uint32_t *regions = body_allocate(b->triangle_count, sizeof *regions), count;
    double *density = body_allocate(b->triangle_count, sizeof *density), *points = NULL;
    double *capacitance = body_allocate(mesh->component_count, sizeof *capacitance);
    expect_ok(
        charge_solve(mesh, b->positions, &(charge_options){CSCD_CHARGE_TREE, 0}, density, capacitance, NULL));
    expect_ok(regions_from_charge(mesh, b->positions, density, NULL, regions, &count, &points));
    check_regions(mesh, regions, count);
    *share = visible_share(mesh, b->positions, regions, points);
    *border = border_length(mesh, b->positions, regions);
    context_free(mesh->context, points);
    free(regions);
    free(density);
    free(capacitance);
    body_mesh_destroy(mesh);
    return count;
}

enum { AROUND = 24 };

/* A tube around a circle of radius R, or around an arc of it, which has round ends. */
typedef struct tube {
    double R, r, angle;
    const double *offset;
    bool closed;
    uint32_t along, caps; /* steps of the arc, and rings of a round end beyond it */
    uint32_t first, rings;
} tube;

/* A point over the arc at the angle u: so far outside of the circle, ahead along it, and up. */
static uint32_t add_point(body *b, const tube *t, double u, double outside, double ahead, double up) {
    const double radius = t->R + outside;
    return body_add_vertex(b, t->offset[0] + radius * cos(u) - ahead * sin(u),
                           t->offset[1] + radius * sin(u) + ahead * cos(u), t->offset[2] + up);
}

static void add_ring(body *b, const tube *t, uint32_t number) {
    const double step = (double)number - t->caps, inside = fmin(fmax(step, 0.0), t->along),
                 u = inside / t->along * t->angle;
    const double lift = (step - inside) * 2.0 * pi / AROUND, radius = t->r * cos(lift);
    for (uint32_t j = 0; j < AROUND; j++) {
        const double v = 2.0 * pi * (j + 0.5 * (number % 2)) / AROUND;
        add_point(b, t, u, radius * cos(v), t->r * sin(lift), radius * sin(v));
    }
}

/* The triangles between a ring and the next, which is turned by half a step. */
static void add_band(body *b, const tube *t, uint32_t number) {
    const uint32_t here = t->first + number * AROUND, there = t->first + (number + 1) % t->rings * AROUND;
    for (uint32_t j = 0; j < AROUND; j++) {
        const uint32_t k = (j + 1) % AROUND;
        const uint32_t a = here + j, c = here + k, e = there + j, f = there + k;
        body_add_triangle(b, a, e, number % 2 == 0 ? c : f);
        if (number % 2 == 0)
            body_add_triangle(b, c, e, f);
        else
            body_add_triangle(b, a, f, c);
    }
}

static void add_tip(body *b, const tube *t, bool end) {
    const uint32_t ring = t->first + (end ? (t->rings - 1) * AROUND : 0);
    const uint32_t tip = add_point(b, t, end ? t->angle : 0.0, 0.0, end ? t->r : -t->r, 0.0);
    for (uint32_t j = 0; j < AROUND; j++) {
        const uint32_t k = (j + 1) % AROUND;
        body_add_triangle(b, tip, ring + (end ? k : j), ring + (end ? j : k));
    }
}

static void add_tube(body *b, double R, double r, double angle, const double offset[3]) {
    tube t = {R,
              r,
              angle,
              offset,
              angle >= 2.0 * pi,
              (uint32_t)(angle * R / (2.0 * pi * r) * AROUND),
              0,
              b->vertex_count,
              0};
    t.caps = t.closed ? 0 : AROUND / 4 - 1;
    t.rings = t.along + (t.closed ? 0 : 1) + 2 * t.caps;
    for (uint32_t i = 0; i < t.rings; i++) add_ring(b, &t, i);
    for (uint32_t i = 0; i + !t.closed < t.rings; i++) add_band(b, &t, i);
    if (t.closed) return;
    add_tip(b, &t, false);
    add_tip(b, &t, true);
}

static const double nowhere[3] = {0.0, 0.0, 0.0};

/* An arc that a point at its outer side sees spans 2 acos((R - r) / (R + r)). */
TEST(tori_fall_into_arcs) {
    static const double radii[] = {1.5, 2.5, 4.0};
    for (int i = 0; i < 3; i++) {
        body b = {0};
        double share, border;
        add_tube(&b, radii[i], 1.0, 2.0 * pi, nowhere);
        assert_true(body_volume(&b) > 0.0);
        const uint32_t least = (uint32_t)ceil(pi / acos((radii[i] - 1.0) / (radii[i] + 1.0)));
        const uint32_t count = divide_by_charge(&b, &share, &border);
        print_message("  torus %g : 1, %u triangles: %u regions, at least %u; visible %.4f\n", radii[i],
                      b.triangle_count, count, least, share);
        assert_true(count >= least && count <= least + 1);
        assert_true(share >= 0.99);
        body_free(&b);
    }
}

TEST(each_link_of_a_chain) {
    body b = {0};
    double share, alone, border;
    add_tube(&b, 3.0, 1.0, 2.0 * pi, nowhere);
    const uint32_t one = divide_by_charge(&b, &alone, &border);
    add_tube(&b, 3.0, 1.0, 2.0 * pi, (double[3]){20.0, 0.0, 0.0});
    assert_int_equal(divide_by_charge(&b, &share, &border), 2 * one);
    assert_true(share >= 0.99);
    body_free(&b);
}

/* A straight capsule stays whole, and a bent one is cut, also where nothing but its bend tells where. */
TEST(bent_capsules_are_cut) {
    static const double angles[] = {0.02, 2.0, 3.0, 4.5};
    static const uint32_t least[] = {1, 2, 2, 2}, most[] = {1, 2, 3, 4};
    for (int i = 0; i < 4; i++) {
        body b = {0};
        double share, border;
        add_tube(&b, 5.0 / angles[i], 1.0, angles[i], nowhere);
        assert_true(body_volume(&b) > 0.0);
        const uint32_t count = divide_by_charge(&b, &share, &border);
        print_message("  capsule bent by %g, %u triangles: %u regions; visible %.4f\n", angles[i],
                      b.triangle_count, count, share);
        assert_true(count >= least[i] && count <= most[i]);
        assert_true(share >= 0.98);
        body_free(&b);
    }
}

/* border: what the borders measure today, and about 3 % more. Where they follow large tiles, because nothing halves these, they are 4 to
 * 50 % longer. */
typedef struct expectation {
    body_kind kind;
    uint32_t triangle_count, least, most;
    double share, border;
} expectation;

TEST(bodies_of_the_catalogue) {
    static const expectation expected[] = {
        {BODY_SPHERE, 2000, 1, 1, 1.0, 0.0},    {BODY_ELLIPSOID, 2000, 1, 1, 1.0, 0.0},
        {BODY_CUBE, 1200, 1, 1, 1.0, 0.0},      {BODY_CAPSULE, 2000, 1, 1, 1.0, 0.0},
        {BODY_PAWN, 5130, 2, 3, 0.99, 2.13},    {BODY_DUMBBELL, 4000, 2, 2, 0.99, 1.93},
        {BODY_FIGURE, 4014, 6, 9, 0.99, 4.85},  {BODY_GENUS2, 3000, 5, 8, 0.99, 14.1},
        {BODY_COIL, 6000, 15, 25, 0.97, 26.1},  {BODY_HAND, 6000, 6, 6, 0.99, 3.6},
        {BODY_FIGURE, 20000, 6, 9, 0.99, 3.95},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const expectation *e = &expected[i];
        if (e->triangle_count > TRIANGLES_MOST) continue;
        body b = body_of(e->kind, e->triangle_count);
        double share, border;
        const uint32_t count = divide_by_charge(&b, &share, &border);
        print_message("  %s, %u triangles: %u regions; visible %.4f; borders %.3f\n", body_kind_name(e->kind),
                      b.triangle_count, count, share, border);
        assert_true(count >= e->least && count <= e->most);
        assert_true(share >= e->share);
        assert_true(border <= e->border);
        body_free(&b);
    }
}
