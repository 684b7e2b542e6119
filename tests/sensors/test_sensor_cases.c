/* The cases of the thesis's proofs: two and more, convex and concave, of equal and unequal size. */
#include "tests/support/calls.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <string.h>

enum { FRAMES = 24, OBJECTS_MAX = 3, ALL_REGIONS_MAX = 12 };

static scene s; /* large; one test at a time */

/* The objects, and the offset that each travels until it touches another one. */
typedef struct meeting {
    uint32_t count, first_vertices[OBJECTS_MAX + 1];
    double offsets[OBJECTS_MAX][3];
} meeting;

static meeting begin_meeting(void) {
    scene_clear(&s);
    return (meeting){0};
}

/* The object added last to the scene comes in along -offset. */
static void add_object(meeting *m, double x, double y, double z) {
    double offset[3] = {x, y, z};
    memcpy(m->offsets[m->count++], offset, sizeof offset);
    m->first_vertices[m->count] = s.vertex_count;
}

static void add_sphere(meeting *m, double x, double radius, double offset) {
    const double centre[3] = {x, 0.0, 0.0};
    scene_add_sphere(&s, centre, radius, 9, 14);
    add_object(m, offset, 0.0, 0.0);
}

/* Adds a U, 2 wide and 2 high, that opens to +y, or with sign -1 to -y. */
static void add_u(meeting *m, double x, double y, double z, double sign, double way_y) {
    const double corners[4][3] = {
        {x - 1, y + sign, z}, {x - 1, y - sign, z}, {x + 1, y - sign, z}, {x + 1, y + sign, z}};
    scene_add_bent_tube(&s, corners, 4, 0.3, 0.25);
    add_object(m, 0.0, way_y, 0.0);
}

/* Computes the positions at a share of the offsets; at share 1 each object is where it was made. */
static void positions_at(const meeting *m, double share, double *x) {
    memcpy(x, s.x0, s.vertex_count * 3 * sizeof *x);
    for (uint32_t o = 0; o < m->count; o++) {
        double by[3];
        for (int k = 0; k < 3; k++) by[k] = m->offsets[o][k] * (share - 1.0);
        shift_vertices(m->first_vertices[o], m->first_vertices[o + 1], by, x);
    }
}

/* The first frames in which the detector and the sensors find a contact of two objects. All objects move to
 * the end of their offsets and beyond it. */
typedef struct first_frames {
    int truly, sensed;
    double toi, sensed_toi;
} first_frames;

static uint32_t object_of(const cscd_mesh *mesh, uint32_t vertex) {
    uint32_t count, triangle = cscd_mesh_vertex_triangles(mesh, vertex, &count)[0];
    return cscd_mesh_triangle_component(mesh, triangle);
}

static bool contact_between(const cscd_mesh *mesh, const cscd_contact *c, uint32_t a, uint32_t b) {
    uint32_t first[3] = {c->a}, second[3];
    if (c->kind == CSCD_CONTACT_VF) {
        cscd_mesh_triangle(mesh, c->b, second);
    } else {
        cscd_mesh_edge(mesh, c->a, first);
        cscd_mesh_edge(mesh, c->b, second);
    }
    uint32_t o = object_of(mesh, first[0]), p = object_of(mesh, second[0]);
    return (o == a && p == b) || (o == b && p == a);
}

static bool detector_contact(cscd_detector *detector, const cscd_mesh *mesh, const double *x0,
                             const double *x1, uint32_t a, uint32_t b, double *toi) {
    cscd_contacts contacts;
    assert_int_equal(step_packed(detector, x0, x1, &contacts), CSCD_OK);
    bool any = false;
    for (size_t i = 0; i < contacts.count; i++) {
        if (!contact_between(mesh, &contacts.items[i], a, b)) continue;
        *toi = any && *toi < contacts.items[i].toi ? *toi : contacts.items[i].toi;
        any = true;
    }
    return any;
}

static first_frames run_meeting(const meeting *m, const sensor_setup *setup, uint32_t a, uint32_t b) {
    static double x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];
    first_frames first = {-1, -1, 0.0, 0.0};
    sensor_rig r = sensor_rig_create(&s, setup);
    cscd_detector *detector;
    assert_int_equal(detector_create_here(r.mesh, NULL, NULL, &detector), CSCD_OK);
    for (int f = 0; f < FRAMES && first.truly < 0; f++) {
        positions_at(m, 1.1 * f / FRAMES, x0);
        positions_at(m, 1.1 * (f + 1) / FRAMES, x1);
        cscd_warnings warnings = sensor_rig_step(&r, x0, x1);
        if (detector_contact(detector, r.mesh, x0, x1, a, b, &first.toi)) first.truly = f;
        const cscd_warning *w = find_contact(&warnings, a, b);
        if (w == NULL) continue;
        assert_int_equal(first.truly, f); /* the detector finds the contact of the exact check as well */
        assert_true(w->toi >= first.toi);
        first.sensed = f;
        first.sensed_toi = w->toi;
    }
    cscd_detector_destroy(detector);
    sensor_rig_destroy(&r);
    return first;
}

static void expect_found(const meeting *m, const sensor_setup *setup, uint32_t a, uint32_t b) {
    first_frames first = run_meeting(m, setup, a, b);
    assert_true(first.truly > 3);
    assert_int_equal(first.sensed, first.truly);
    print_message("objects %u and %u: frame %d, at %.4f, sensed %.4f\n", a, b, first.truly, first.toi,
                  first.sensed_toi);
}

/* ---- spheres ------------------------------------------------------------------------------------------ */

TEST(case_1_two_equal_spheres) {
    meeting m = begin_meeting();
    add_sphere(&m, -1.0, 1.0, 3.0);
    add_sphere(&m, 1.0, 1.0, -3.0);
    expect_found(&m, NULL, 0, 1);
}

TEST(case_2_three_equal_spheres) {
    meeting m = begin_meeting();
    add_sphere(&m, -2.0, 1.0, 2.0);
    add_sphere(&m, 0.0, 1.0, 0.0);
    add_sphere(&m, 2.0, 1.0, -2.0);
    expect_found(&m, NULL, 0, 1);
    expect_found(&m, NULL, 1, 2);
}

TEST(case_3_unequal_spheres) {
    meeting m = begin_meeting();
    add_sphere(&m, -1.5, 1.0, 2.0);
    add_sphere(&m, 0.0, 0.5, 0.0);
    add_sphere(&m, 1.5, 1.0, -2.0);
    expect_found(&m, NULL, 0, 1);
    expect_found(&m, NULL, 1, 2);
}

/* ---- concave ones ------------------------------------------------------------------------------------- */

/* A U is divided into three parts, as in figure 4-10. */
static const sensor_setup in_parts = {ALL_REGIONS_MAX, NULL};

TEST(case_4_two_concave) {
    meeting m = begin_meeting(); /* an arm of each goes into the other one */
    add_u(&m, 0.0, 0.0, 0.0, 1.0, 0.0);
    add_u(&m, 1.0, 0.3, 0.0, -1.0, -2.0);
    expect_found(&m, &in_parts, 0, 1);
    expect_found(&m, NULL, 0, 1);
}

TEST(case_5_three_concave) {
    meeting m = begin_meeting();
    add_u(&m, 0.0, 0.0, 0.0, 1.0, 0.0);
    add_u(&m, 1.0, 0.3, 0.0, -1.0, -2.0);
    add_u(&m, 0.3, -2.3, 0.0, 1.0, 2.0);
    expect_found(&m, &in_parts, 0, 1);
    expect_found(&m, &in_parts, 0, 2);
}

TEST(case_6_convex_and_concave) {
    meeting m = begin_meeting();
    add_u(&m, 0.0, 0.0, 0.0, 1.0, 0.0);
    const double inside[3] = {0.0, -0.2, 0.0};
    scene_add_sphere(&s, inside, 0.5, 7, 12);
    add_object(&m, 0.0, -3.0, 0.0);
    add_u(&m, 0.3, -2.3, 0.0, 1.0, 2.0);
    expect_found(&m, &in_parts, 0, 1);
    expect_found(&m, &in_parts, 0, 2);
}
