/* The tools that make bodies: flips, splits and collapses of edges of closed meshes; rings; remeshing. */
#include "models/shapes/implicit.h"
#include "models/shapes/rings.h"
#include "models/shapes/surface.h"
#include "tests/support/models/bodies.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static void check_closed(const body *b, int64_t euler) {
    cscd_mesh *mesh = body_mesh(b, 1);
    cscd_component component = cscd_mesh_component(mesh, 0);
    assert_int_equal(cscd_mesh_component_count(mesh), 1);
    assert_true(component.closed_manifold);
    assert_int_equal(component.vertex_count, b->vertex_count);
    assert_int_equal(component.euler_characteristic, euler);
    body_mesh_destroy(mesh);
}

/* Twins name each other and the same two vertices; a vertex's half-edge starts there. */
static void check_surface(const surface *s) {
    uint32_t live = 0;
    for (uint32_t h = 0; h < s->mesh.triangle_count * 3; h++) {
        if (triangle_is_dead(s, h / 3)) continue;
        live += h % 3 == 0;
        uint32_t twin = s->twins[h];
        assert_true(!triangle_is_dead(s, twin / 3) && s->twins[twin] == h);
        assert_int_equal(half_edge_from(s, h), half_edge_to(s, twin));
        assert_int_equal(half_edge_to(s, h), half_edge_from(s, twin));
        assert_int_equal(half_edge_from(s, s->out[half_edge_from(s, h)]), half_edge_from(s, h));
    }
    assert_int_equal(live, s->live_triangles);
}

/* The torus stays a torus over thousands of random operations. */
TEST(operations_keep_a_manifold) {
    body b = body_of(BODY_TORUS, 400);
    surface s;
    uint32_t done[3] = {0, 0, 0};
    surface_open(&s, &b);
    assert_true(b.positions == NULL && b.vertex_count == 0);
    check_surface(&s);
    random_seed(7);
    for (uint32_t round = 0; round < 6000; round++) {
        uint32_t h =
            (uint32_t)(fabs(random_unit()) * s.mesh.triangle_count * 3.0) % (s.mesh.triangle_count * 3);
        if (triangle_is_dead(&s, h / 3)) continue;
        const double *p = s.mesh.positions + (size_t)half_edge_from(&s, h) * 3;
        const double *q = s.mesh.positions + (size_t)half_edge_to(&s, h) * 3;
        double middle[3] = {0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])};
        uint32_t before = s.live_triangles, kind = round % 3;
        bool changed = true;
        if (kind == 0) changed = surface_flip(&s, h);
        if (kind == 1) changed = surface_collapse(&s, h, middle);
        if (kind == 2) surface_split(&s, h, middle);
        assert_int_equal(s.live_triangles, before + (kind == 2 ? 2u : 0u) - (kind == 1 && changed ? 2u : 0u));
        done[kind] += changed;
        if (round % 500 == 0) check_surface(&s);
    }
    check_surface(&s);
    for (int kind = 0; kind < 3; kind++) assert_true(done[kind] > 100);
    surface_quarter(&s);
    check_surface(&s);
    surface_close(&s, &b);
    assert_int_equal(b.vertex_count * 2, b.triangle_count);
    check_closed(&b, 0);
    body_free(&b);
}

/* No edge of a tetrahedron can be collapsed or flipped. */
TEST(a_tetrahedron_stays) {
    body b = {0};
    surface s;
    for (int i = 0; i < 4; i++) body_add_vertex(&b, i == 1, i == 2, i == 3);
    const uint32_t corners[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (int i = 0; i < 4; i++) body_add_triangle(&b, corners[i][0], corners[i][1], corners[i][2]);
    surface_open(&s, &b);
    for (uint32_t h = 0; h < 12; h++) {
        assert_false(surface_flip(&s, h));
        assert_false(surface_collapse(&s, h, (double[3]){0.2, 0.2, 0.2}));
        assert_int_equal(surface_valence(&s, half_edge_from(&s, h)), 3);
    }
    assert_false(surface_move(&s, 3, (double[3]){0, 0, -1}));
    assert_true(surface_move(&s, 3, (double[3]){0, 0, 2}));
    surface_close(&s, &b);
    assert_true(b.vertex_count == 4 && b.triangle_count == 4 && b.positions[11] == 2.0);
    body_free(&b);
}

/* Rings reach every even count, with open and with closed outlines. */
TEST(rings_add_up) {
    outline half = {.end = {0.0, -1.0}}, whole = {.closed = true, .end = {1.4, 0.0}};
    outline_arc(&half, 0.0, 0.0, 1.0, -90.0, 90.0);
    outline_arc(&whole, 1.0, 0.0, 0.4, 0.0, 360.0);
    for (uint32_t count = 20; count < 1000; count += count < 200 ? 2 : 34) {
        for (int i = 0; i < 2; i++) {
            body b = {0};
            if (i == 1 && count < 60) continue;
            body_add_rings(&b, i == 0 ? &half : &whole, count, NULL);
            assert_int_equal(b.triangle_count, count);
            check_closed(&b, i == 0 ? 2 : 0);
            assert_true(body_least_angle(&b) > 15.0);
            body_free(&b);
        }
    }
}

/* A square with a rounded corner: corners are kept, and lengths add up. */
TEST(outlines_follow_their_pieces) {
    outline o = {.end = {0.0, 0.0}};
    double point[2];
    uint32_t piece = 0;
    outline_line(&o, 2.0, 0.0);
    outline_line(&o, 2.0, 1.0);
    outline_turn(&o, 1.0, 90.0);
    outline_line(&o, 0.0, 2.0);
    assert_true(fabs(outline_section(&o, &piece) - 2.0) < 1e-9);
    assert_true(fabs(outline_section(&o, &piece) - (2.0 + 1.5707963268)) < 1e-9);
    assert_true(piece == o.piece_count && fabs(o.length - 5.5707963268) < 1e-9);
    outline_at(&o, 2.5, point);
    assert_true(fabs(point[0] - 2.0) < 1e-12 && fabs(point[1] - 0.5) < 1e-12);
    outline_at(&o, 3.0 + 0.7853981634, point);
    assert_true(fabs(point[0] - 1.0 - sqrt(0.5)) < 1e-9 && fabs(point[1] - 1.0 - sqrt(0.5)) < 1e-9);
    outline_at(&o, 99.0, point);
    assert_true(fabs(point[0]) < 1e-12 && fabs(point[1] - 2.0) < 1e-12);
}

static double to_ball(const double p[3]) {
    return hypot(hypot(p[0], p[1]), p[2]) - 1.0;
}

static const implicit ball = {to_ball, {-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}, false};

/* Remeshing goes up and down from any count, always on the surface; impossible counts are refused. */
TEST(remeshing_reaches_counts) {
    const uint32_t counts[] = {1000, 998, 3002, 400, 5000, 60};
    body b = body_of(BODY_SPHERE, 500);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        assert_true(body_remesh(&b, &ball, counts[i]));
        assert_int_equal(b.triangle_count, counts[i]);
        check_closed(&b, 2);
        assert_true(body_least_angle(&b) > 25.0);
        for (uint32_t v = 0; v < b.vertex_count; v++) assert_true(fabs(to_ball(b.positions + v * 3)) < 1e-4);
    }
    assert_false(body_remesh(&b, &ball, 61));
    assert_false(body_remesh(&b, &ball, 2));
    check_closed(&b, 2);
    body_free(&b);
}
