/* Methods iccd and cones in cases that are easily wrong: each scene breaks one condition of the theorems in
 * docs/theory/iccd.md, and has contacts that a test without that condition would lose. */
#include "cscd/research.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static scene s; /* large; one test at a time */

static uint32_t add_vertex(double x, double y, double z) {
    const double p[3] = {x, y, z};
    memcpy(s.x0 + (size_t)s.vertex_count * 3, p, sizeof p);
    memcpy(s.x1 + (size_t)s.vertex_count * 3, p, sizeof p);
    return s.vertex_count++;
}

static void move_to(uint32_t vertex, double x, double y, double z) {
    const double p[3] = {x, y, z};
    memcpy(s.x1 + (size_t)vertex * 3, p, sizeof p);
}

static void add_triangle(uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t t[3] = {a, b, c};
    memcpy(s.triangles + (size_t)s.triangle_count++ * 3, t, sizeof t);
}

static void add_quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    add_triangle(a, b, c);
    add_triangle(a, c, d);
}

/* Contacts and counters of a method; the scene s stays. */
typedef struct trap_outcome {
    rig objects;
    cscd_contacts contacts;
    cscd_counters counters;
} trap_outcome;

static trap_outcome run_method(cscd_method method) {
    trap_outcome out;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.ours = ours_of_method(method);
    out.objects = rig_create(&s, 1, &options);
    out.contacts = rig_step(&out.objects, &s);
    out.counters = cscd_detector_counters(out.objects.detector);
    return out;
}

/* Methods iccd and cones must find all contacts; as published, iccd loses some of them, or all. */
typedef enum loss { LOSES_SOME, LOSES_ALL } loss;

static cscd_counters expect_complete(loss lost) {
    trap_outcome none = run_method(CSCD_METHOD_NONE), brute = run_method(CSCD_METHOD_BRUTE),
                 iccd = run_method(CSCD_METHOD_ICCD), cones = run_method(CSCD_METHOD_CONES);
    trap_outcome published = run_method(CSCD_METHOD_ICCD_PUBLISHED);
    size_t count = none.contacts.count;
    assert_true(count > 0);
    assert_int_equal(brute.contacts.count, count);
    assert_int_equal(iccd.contacts.count, count);
    assert_int_equal(cones.contacts.count, count);
    assert_memory_equal(brute.contacts.items, none.contacts.items, count * sizeof(cscd_contact));
    assert_memory_equal(iccd.contacts.items, none.contacts.items, count * sizeof(cscd_contact));
    assert_memory_equal(cones.contacts.items, none.contacts.items, count * sizeof(cscd_contact));
    print_message("  %zu contacts, as published %zu; sealed %llu, by cones %llu, as published %llu\n", count,
                  published.contacts.count, (unsigned long long)iccd.counters.sealed,
                  (unsigned long long)cones.counters.sealed, (unsigned long long)published.counters.sealed);
    if (lost == LOSES_ALL) assert_int_equal(published.contacts.count, 0);
    if (lost == LOSES_SOME) assert_true(published.contacts.count < count);
    cscd_counters counters = iccd.counters;
    trap_outcome *all[5] = {&none, &brute, &iccd, &cones, &published};
    for (int i = 0; i < 5; i++) rig_destroy(&all[i]->objects);
    return counters;
}

/* ---- the contour is not simple at the start --------------------------------------------------------- */

/* Makes a strip along a spiral that climbs to 1 and ends at -1 times its heights. reach: the radius of its
 * middle line at an angle. */
static void make_ramp(double turns, int steps, double climb, double half_width, double (*reach)(double)) {
    scene_clear(&s);
    for (int i = 0; i <= steps; i++) {
        double angle = 2.0 * PI * turns * i / steps, height = climb * angle;
        for (int side = -1; side <= 1; side++) {
            double radius = reach(angle) + side * half_width;
            double x = radius * cos(angle), y = radius * sin(angle);
            uint32_t v = add_vertex(x, y, height);
            move_to(v, x, y, -height);
            if (i == 0 || side == -1) continue;
            add_quad(v - 4, v - 3, v, v - 1);
        }
    }
}

static double steady_motion(double angle) {
    (void)angle;
    return 1.0;
}

/* After a turn the strip is on the other side of 1, and lies over itself at two places only. */
static double wandering_motion(double angle) {
    return 1.0 + 0.4 * cos(0.5 * angle + 0.3);
}

/* The turns of a ramp overlap in the projection, and pass through each other when the ramp turns over. */
TEST(spiral_ramps) {
    make_ramp(2.4, 97, 0.01, 0.3, steady_motion);
    assert_true(expect_complete(LOSES_ALL).sealed > 0);
    make_ramp(2.0, 80, 0.01, 0.1, wandering_motion);
    assert_true(expect_complete(LOSES_SOME).sealed > 0);
    make_ramp(5.3, 230, 0.02, 0.5, steady_motion);
    assert_true(expect_complete(LOSES_ALL).sealed > 0);
}

/* The fan of one vertex goes around twice: it is a disk, all normals point up, and the projection is not
 * one-to-one. */
TEST(fan_of_two_turns) {
    enum { BLADES = 17 };
    scene_clear(&s);
    add_vertex(0.0, 0.0, 0.0);
    for (int i = 0; i < BLADES; i++) {
        double angle = 4.0 * PI * i / BLADES, reach = 1.0 + 0.2 * cos(0.5 * angle);
        double height = 0.1 * sin(0.5 * angle + 0.2);
        uint32_t v = add_vertex(reach * cos(angle), reach * sin(angle), height);
        move_to(v, reach * cos(angle), reach * sin(angle), -height);
        add_triangle(0, v, v == BLADES ? 1 : v + 1);
    }
    expect_complete(LOSES_ALL);
}

/* ---- normals between the ends ---------------------------------------------------------------------- */

/* All vertices are in the centre half way. The normals at both ends point up, the middle Bernstein vectors
 * down. */
TEST(sheet_after_half_a_turn) {
    scene_clear(&s);
    scene_add_sheet(&s, 2.0, 1.5, 6, 5);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        const double *p = s.x0 + (size_t)v * 3;
        move_to(v, -p[0], -p[1], p[2]);
    }
    assert_int_equal(expect_complete(LOSES_SOME).sealed, 0);
}

/* Adds a smaller ring of the frame's vertices. At the start it is stretched along x and turned back, at
 * the end it is stretched along y and turned on. */
static void add_ring(uint32_t corners, double size, double turn, double stretch) {
    for (uint32_t i = 0; i < corners; i++) {
        double x = size * cos(2.0 * PI * i / corners), y = size * sin(2.0 * PI * i / corners);
        const double before[2] = {stretch * x, y / stretch}, after[2] = {x / stretch, stretch * y};
        double c = cos(turn), d = sin(turn);
        uint32_t v = add_vertex(c * before[0] + d * before[1], c * before[1] - d * before[0], 0.0);
        move_to(v, c * after[0] - d * after[1], c * after[1] + d * after[0], 0.0);
    }
}

/* The innermost triangles turn by half a turn, and half way their map has a negative determinant: they are
 * upside down, though all triangles face up at both ends and the contour never moves. */
TEST(middle_turns_inside_a_frame) {
    enum { CORNERS = 12 };
    scene_clear(&s);
    add_vertex(0.0, 0.0, 0.0);
    add_ring(CORNERS, 1.0, 0.0, 1.0);
    add_ring(CORNERS, 0.3, 0.25 * PI, 1.0);
    add_ring(CORNERS, 0.05, 0.5 * PI, 1.3);
    for (uint32_t i = 0; i < CORNERS; i++) {
        uint32_t next = (i + 1) % CORNERS, outer = 1, middle = 1 + CORNERS, inner = 1 + 2 * CORNERS;
        add_triangle(0, inner + i, inner + next);
        add_quad(inner + i, middle + i, middle + next, inner + next);
        add_quad(middle + i, outer + i, outer + next, middle + next);
    }
    const double *ends[2] = {s.x0, s.x1};
    for (uint32_t t = 0; t < s.triangle_count * 2; t++) { /* all triangles face up at both ends */
        const uint32_t *c = s.triangles + (size_t)(t / 2) * 3;
        const double *x = ends[t % 2], *p = x + c[0] * 3, *q = x + c[1] * 3, *r = x + c[2] * 3;
        assert_true((q[0] - p[0]) * (r[1] - p[1]) > (q[1] - p[1]) * (r[0] - p[0]));
    }
    expect_complete(LOSES_ALL);
}

/* ---- patches that are no disks --------------------------------------------------------------------- */

/* The contours of the squares never touch in the projection. */
TEST(square_falls_through_another) {
    scene_clear(&s);
    scene_add_sheet(&s, 4.0, 4.0, 1, 1);
    scene_add_sheet(&s, 1.0, 1.0, 1, 1);
    for (uint32_t v = 4; v < 8; v++) {
        s.x0[v * 3 + 2] = 1.0;
        s.x1[v * 3 + 2] = -1.0;
    }
    expect_complete(LOSES_ALL);
}

/* Adds one ring above another with common outer and inner rims: a closed torus whose lower half is turned
 * over, so that all normals point up. The halves pass through each other. */
static uint32_t add_double_ring(double x, uint32_t corners) {
    uint32_t first = s.vertex_count;
    for (uint32_t i = 0; i < corners; i++) {
        double angle = 2.0 * PI * i / corners, c = cos(angle), d = sin(angle);
        add_vertex(x + c, d, 0.0);
        add_vertex(x + 2.0 * c, 2.0 * d, 0.0);
        for (int half = 1; half >= -1; half -= 2) {
            double reach = 1.5 + 0.03 * half;
            move_to(add_vertex(x + reach * c, reach * d, 0.05 * half), x + reach * c, reach * d,
                    -0.05 * half);
        }
    }
    for (uint32_t i = 0; i < corners; i++) {
        uint32_t here = first + 4 * i, next = first + 4 * ((i + 1) % corners);
        for (uint32_t middle = 2; middle < 4; middle++) {
            add_quad(here, here + middle, next + middle, next);
            add_quad(here + middle, here + 1, next + 1, next + middle);
        }
    }
    return first;
}

/* There is a flat disk beside the torus. Together they have V - E + F = 1, and the edges of one triangle
 * form one loop. */
TEST(disk_beside_a_closed_part) {
    for (int side = -1; side <= 1; side += 2) {
        scene_clear(&s);
        scene_add_sheet(&s, 1.0, 1.0, 2, 2);
        add_double_ring(10.0 * side, 16);
        expect_complete(LOSES_ALL);
    }
}

/* Two sheets, one above the other, change places across a slit. They form a ring with two simple loops
 * that never touch in the projection, and all normals point up, but the ring lies twice above itself. */
TEST(sheets_joined_through_a_slit) {
    enum { CELLS = 6, ROW = CELLS + 1, FIRST = 3 * ROW + 2, LAST = 3 * ROW + 4, MIDDLE = 3 * ROW + 3 };
    const uint32_t other = ROW * ROW; /* the first vertex of the second sheet */
    scene_clear(&s);
    scene_add_sheet(&s, 2.0, 2.0, CELLS, CELLS);
    scene_add_sheet(&s, 3.0, 3.0, CELLS, CELLS);
    for (uint32_t i = 0; i < s.triangle_count * 3; i++) {
        uint32_t *v = &s.triangles[i], sheet = i / (CELLS * CELLS * 6);
        bool below = i % (CELLS * CELLS * 6) < CELLS * 3 * 6;
        if (*v == FIRST + other || *v == LAST + other) *v -= other;
        if (*v % other == MIDDLE) *v = MIDDLE + (below == (sheet == 0) ? other : 0);
    }
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        double height = v == FIRST || v == LAST ? 0.0 : v < other ? 0.1 : -0.1;
        s.x0[v * 3 + 2] = height;
        move_to(v, s.x0[v * 3], s.x0[v * 3 + 1], -height);
    }
    rig r = rig_create(&s, 1, NULL);
    cscd_component c = cscd_mesh_component(r.mesh, 0);
    assert_int_equal(cscd_mesh_component_count(r.mesh), 1);
    assert_int_equal(c.euler_characteristic, 0);
    assert_int_equal(c.non_manifold_edges + c.non_manifold_vertices + c.inconsistent_edges, 0);
    rig_destroy(&r);
    assert_true(expect_complete(LOSES_ALL).sealed > 0);
}

/* Two fans that share one vertex slide over and through each other. */
TEST(fans_joined_in_a_vertex) {
    scene_clear(&s);
    add_vertex(0.0, 0.0, 0.0);
    for (int fan = 0; fan < 2; fan++) {
        uint32_t before = 0;
        for (int i = 0; i <= 6; i++) {
            double angle = PI * (fan + 0.1 + 0.8 * i / 6.0), height = fan == 0 ? 0.03 : 0.0;
            uint32_t v = add_vertex(cos(angle), sin(angle), height);
            if (fan == 0) move_to(v, cos(angle + 1.6), sin(angle + 1.6), -0.03);
            if (i > 0) add_triangle(0, before, v);
            before = v;
        }
    }
    expect_complete(LOSES_SOME);
}

/* The surfaces are closed and quite flat: the upper side falls through the lower one. */
TEST(flat_closed_surfaces) {
    for (int torus = 0; torus < 2; torus++) {
        scene_clear(&s);
        if (torus == 1)
            scene_add_torus(&s, (double[3]){0.0, 0.0, 0.0}, 1.0, 0.3, 12, 6, false);
        else
            scene_add_sphere(&s, (double[3]){0.0, 0.0, 0.0}, 1.0, 6, 9);
        for (uint32_t v = 0; v < s.vertex_count; v++) {
            const double *p = s.x0 + (size_t)v * 3;
            move_to(v, p[0], p[1], -p[2]);
            if (p[2] > 0.0) move_to(v, 1.01 * p[0], p[1], -p[2]);
        }
        expect_complete(LOSES_SOME);
    }
}
