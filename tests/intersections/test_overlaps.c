/* Areas and volumes of overlaps: boxes by hand, bodies of all kinds by columns, and what is inside out; curves that touch. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum { LINES = NIGHTLY(60, 200), ROUNDS = NIGHTLY(3, 8) };

/* ---- volumes by columns -------------------------------------------------------------------------------- */

/* Along many lines, the parts on which a body has a number: an estimate, whose error falls with the distance of the lines. */
/* A closed surface of one object. */
typedef struct column_body {
    const double *positions;
    const uint32_t *triangles;
    uint32_t triangle_count;
} column_body;

enum { PASSES_MAX = 256 };

/* Where a line along z passes through a surface. */
typedef struct column_pass {
    double z;
    int of_a, of_b; /* what the numbers change by, going up */
} column_pass;

typedef struct counted_column {
    double x, y;
    column_pass passes[PASSES_MAX];
    int count;
} counted_column;

static double turn_of(const double *a, const double *b, double x, double y) {
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static void pass_triangle(counted_column *c, const double *p, const double *q, const double *r, bool is_b) {
    double u = turn_of(q, r, c->x, c->y), v = turn_of(r, p, c->x, c->y), w = turn_of(p, q, c->x, c->y);
    bool up = u > 0 && v > 0 && w > 0, down = u < 0 && v < 0 && w < 0;
    if ((!up && !down) || c->count == PASSES_MAX) return;
    double z = (u * p[2] + v * q[2] + w * r[2]) / (u + v + w);
    int change = up ? -1 : 1, i = c->count++;
    for (; i > 0 && c->passes[i - 1].z > z; i--) c->passes[i] = c->passes[i - 1];
    c->passes[i] = (column_pass){z, is_b ? 0 : change, is_b ? change : 0};
}

static void pass_body(counted_column *c, const column_body *body, bool is_b) {
    for (uint32_t t = 0; t < body->triangle_count; t++) {
        const double *p[3];
        for (int i = 0; i < 3; i++) p[i] = body->positions + (size_t)body->triangles[t * 3 + (uint32_t)i] * 3;
        pass_triangle(c, p[0], p[1], p[2], is_b);
    }
}

static double measure_column(const counted_column *c, bool with_b, int least_a) {
    int a = 0, b = 0;
    double length = 0.0;
    for (int i = 0; i + 1 < c->count; i++) {
        a += c->passes[i].of_a;
        b += c->passes[i].of_b;
        if (a >= least_a && (!with_b || b >= 1)) length += c->passes[i + 1].z - c->passes[i].z;
    }
    return length;
}

/* Narrows low and high to the box of a body in x and y. */
static void narrow_to_body(const column_body *body, double low[2], double high[2]) {
    for (int k = 0; k < 2; k++) {
        double least = INFINITY, greatest = -INFINITY;
        for (uint32_t i = 0; i < body->triangle_count * 3; i++) {
            double x = body->positions[(size_t)body->triangles[i] * 3 + (size_t)k];
            least = fmin(least, x);
            greatest = fmax(greatest, x);
        }
        low[k] = fmax(low[k], least);
        high[k] = fmin(high[k], greatest);
    }
}

/* The volume of what has a winding number of at least least_a in a, and of at least 1 in b; b NULL: everywhere. lines:
 * along x, and along y. */
static double column_volume(const column_body *a, const column_body *b, int least_a, int lines) {
    double low[2] = {-INFINITY, -INFINITY}, high[2] = {INFINITY, INFINITY}, sum = 0.0;
    narrow_to_body(a, low, high);
    if (b != NULL) narrow_to_body(b, low, high);
    double step[2] = {(high[0] - low[0]) / lines, (high[1] - low[1]) / lines};
    for (int i = 0; i < lines * lines; i++) {
        counted_column c = {.x = low[0] + (i % lines + 0.5) * step[0],
                            .y = low[1] + (i / lines + 0.5) * step[1]};
        pass_body(&c, a, false);
        if (b != NULL) pass_body(&c, b, true);
        sum += measure_column(&c, b != NULL, least_a);
    }
    return sum * step[0] * step[1];
}

/* ---- overlaps ------------------------------------------------------------------------------------------ */

static body_rig rig; /* large; one test at a time */

static void add_cube(double x, double y, double z, double size) {
    const double low[3] = {x, y, z}, sizes[3] = {size, size, size};
    body_rig_box(&rig, low, sizes);
}

static void expect_overlap(uint32_t a, uint32_t b, double area_a, double area_b, double volume) {
    cscd_overlap found = body_rig_overlap(&rig, a, b);
    assert_true(fabs(found.area_a - area_a) <= 1e-12);
    assert_true(fabs(found.area_b - area_b) <= 1e-12);
    assert_true(fabs(found.volume - volume) <= 1e-12);
}

TEST(corners_of_two_boxes) {
    body_rig_begin(&rig);
    add_cube(0, 0, 0, 2);
    add_cube(1.25, 1.5, 1.125, 2);
    body_rig_find_all(&rig);
    double x = 0.75, y = 0.5, z = 0.875, faces = x * y + y * z + z * x;
    expect_overlap(0, 1, faces, faces, x * y * z);
    assert_int_equal(rig.found.overlaps->count, 1);
}

/* No vertex of the one is in the other. */
TEST(bars_across_each_other) {
    const double low[3] = {-3, 0.1, 0.2}, size[3] = {6, 0.5, 0.25}, across[3] = {0.3, -2, 0.1},
                 other[3] = {0.5, 5, 2};
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    body_rig_box(&rig, across, other);
    body_rig_find_all(&rig);
    expect_overlap(0, 1, 0.5 * 2 * (0.5 + 0.25), 2 * 0.5 * 0.25, 0.5 * 0.5 * 0.25);
}

/* A box within a box within a ball of wax: nothing crosses, and everything is buried. */
TEST(boxes_within_each_other) {
    body_rig_begin(&rig);
    add_cube(0, 0, 0, 4);
    add_cube(1, 1, 1, 2);
    add_cube(1.5, 1.5, 1.5, 1);
    body_rig_find_all(&rig);
    expect_overlap(0, 1, 0.0, 24.0, 8.0);
    expect_overlap(0, 2, 0.0, 6.0, 1.0);
    expect_overlap(1, 2, 0.0, 6.0, 1.0);
    assert_int_equal(rig.found.overlaps->count, 3);
    assert_int_equal(rig.found.curves->count, 0);
}

static void turn_inside_out(uint32_t first, uint32_t end) {
    for (uint32_t t = first; t < end; t++) {
        uint32_t *triangle = rig.all.triangles + (size_t)t * 3, kept = triangle[1];
        triangle[1] = triangle[2];
        triangle[2] = kept;
    }
}

/* A box with a cavity has normals into the cavity, in which a third box is not buried. */
TEST(a_cavity_is_outside) {
    const double low[3] = {1, 1, 1}, size[3] = {2, 2, 2}, outer[3] = {0, 0, 0}, all[3] = {4, 4, 4};
    body_rig_begin(&rig);
    body_rig_add_box(&rig, outer, all);
    body_rig_add_box(&rig, low, size);
    turn_inside_out(12, 24);
    body_rig_end_body(&rig);
    add_cube(1.5, 1.5, 1.5, 1);
    add_cube(0.5, 1.5, 1.5, 1); /* half of it in the wall */
    body_rig_find_all(&rig);
    expect_overlap(0, 1, 0.0, 0.0, 0.0);
    expect_overlap(0, 2, 1.0, 1.0 + 4 * 0.5, 0.5);
    expect_overlap(0, 0, 0.0, 0.0, 0.0);
}

TEST(a_body_that_is_inside_out) {
    const double low[3] = {0, 0, 0}, size[3] = {2, 2, 2};
    body_rig_begin(&rig);
    body_rig_add_box(&rig, low, size);
    turn_inside_out(0, 12);
    body_rig_end_body(&rig);
    add_cube(0.5, 0.5, 0.5, 1);
    body_rig_find_all(&rig);
    expect_overlap(0, 0, 0.0, 0.0, 0.0);
    expect_overlap(0, 1, 0.0, 6.0, 1.0);
    rig.orientation = CSCD_ORIENTATION_AS_GIVEN;
    body_rig_find(&rig);
    expect_overlap(0, 0, 0.0, 24.0, 0.0);
    expect_overlap(0, 1, 0.0, 0.0, 0.0);
}

/* A box and one that is inside out, of one object, cross: the faces of the first that the second holds are inverted, and all of
 * the second that the first does not hold. */
TEST(a_cut_body_that_is_inside_out) {
    const double low[3] = {0, 0, 0}, size[3] = {2, 2, 2}, second[3] = {1, 1, 1};
    body_rig_begin(&rig);
    body_rig_add_box(&rig, low, size);
    body_rig_add_box(&rig, second, size);
    turn_inside_out(12, 24);
    body_rig_end_body(&rig);
    rig.orientation = CSCD_ORIENTATION_AS_GIVEN;
    body_rig_find_all(&rig);
    expect_overlap(0, 0, 0.0, 3.0 + 21.0, 0.0);
}

/* Of three boxes that overlap the last two, one in the other, are obstacles: nobody asks what they have of each other. */
TEST(obstacles_have_nothing_in_each_other) {
    body_rig_begin(&rig);
    add_cube(0, 0, 0, 2);
    add_cube(1.25, 1.5, 1.125, 1);
    add_cube(1.0, 1.25, 0.875, 3);
    body_rig_create(&rig, NULL, 1);
    body_rig_find(&rig);
    assert_int_equal(rig.found.overlaps->count, 3);
    cscd_object_desc descs[3];
    for (uint32_t i = 0; i < 3; i++) {
        descs[i] = cscd_object_of_triangles(8, 12, rig.bodies[i].triangles);
        descs[i].obstacle = i > 0;
    }
    body_rig_free(&rig);
    assert_int_equal(cscd_context_create(NULL, &rig.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(rig.context, descs, 3, &rig.mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(rig.context, rig.mesh, NULL, NULL, &rig.detector), CSCD_OK);
    body_rig_find(&rig);
    assert_int_equal(rig.found.overlaps->count, 2);
    assert_int_equal(rig.found.overlaps->items[1].a, 0);
}

/* Two bodies of one object: what is in both is contained twice. */
TEST(two_bodies_of_one_object) {
    const double low[3] = {0, 0, 0}, size[3] = {2, 2, 2}, second[3] = {1, 1, 1};
    body_rig_begin(&rig);
    body_rig_add_box(&rig, low, size);
    body_rig_box(&rig, second, size);
    add_cube(0.5, 0.5, 0.5, 1);
    body_rig_find_all(&rig);
    expect_overlap(0, 0, 6.0, 0.0, 1.0);
    expect_overlap(0, 1, 3 * 0.25, 6.0, 1.0);
}

/* Two bars of one object cross each other where they pass through a face of a box: their outlines cross within one
 * triangle. */
TEST(bars_that_cross_in_a_face) {
    const double low[3] = {-20, -11, -5}, size[3] = {40, 33, 5};
    const double bars[2][2][3] = {{{-3, -0.2, -1}, {6, 0.4, 2}}, {{-3, -0.3, -1.5}, {6, 0.6, 2}}};
    const double pi = acos(-1.0), angle = 40.0 * pi / 180.0, turn = 0.3;
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    for (int i = 0; i < 2; i++) {
        uint32_t first = rig.all.vertex_count;
        body_rig_add_box(&rig, bars[i][0], bars[i][1]);
        for (uint32_t v = first; v < rig.all.vertex_count; v++) {
            double *x = rig.all.x0 + (size_t)v * 3, by = turn + i * angle, before = x[0];
            x[0] = before * cos(by) - x[1] * sin(by);
            x[1] = before * sin(by) + x[1] * cos(by);
        }
    }
    body_rig_end_body(&rig);
    body_rig_find_all(&rig);
    double area = 6 * 0.4 + 6 * 0.6 - 0.4 * 0.6 / sin(angle);
    assert_true(fabs(body_rig_overlap(&rig, 0, 1).area_a - area) < 1e-9);
}

/* Digits are lost where volumes are measured from far away: the first triangle of the first object is 10^6 away, and the faces
 * of the slab reach as far, but nothing of the overlap does. */
TEST(far_from_everything_else) {
    const double origin[3] = {-1e6, -1e6, -1e6}, one[3] = {1, 1, 1}, low[3] = {-1e6, -1e6, -1},
                 slab[3] = {2e6, 2e6, 1};
    body_rig_begin(&rig);
    body_rig_add_box(&rig, origin, one);
    body_rig_box(&rig, low, slab);
    add_cube(0.3, 0.7, -0.0011, 0.0037);
    add_cube(0.3, 0.7, -0.7, 0.0037);
    body_rig_find_all(&rig);
    double within = body_rig_overlap(&rig, 0, 2).volume, edge = 0.0037;
    assert_true(fabs(body_rig_overlap(&rig, 0, 1).volume / (edge * edge * 0.0011) - 1.0) < 1e-12);
    assert_true(fabs(within / (edge * edge * edge) - 1.0) < 1e-12);
}

/* Two boxes of one object that is not looked at with itself. Nobody knows where the one is in the other, so what they share
 * of a third box counts twice. */
TEST(an_object_that_is_not_looked_at_with_itself) {
    const double low[3] = {0, 0, 0}, size[3] = {2, 2, 2}, second[3] = {1, 0.5, 0.5};
    cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
    cscd_detector_options options = cscd_detector_defaults();
    options.rules = rules;
    options.rule_count = 2;
    for (int both = 0; both < 2; both++) {
        for (int i = 0; i <= both; i++) rules[i].self = false;
        body_rig_begin(&rig);
        body_rig_add_box(&rig, low, size);
        body_rig_box(&rig, second, size);
        add_cube(0.5, 0.75, 0.25, 1);
        body_rig_create(&rig, &options, 1);
        body_rig_find(&rig);
        cscd_overlap found = body_rig_overlap(&rig, 0, 1);
        assert_int_equal(rig.found.overlaps->count, 1);
        assert_true(fabs(found.volume - (1.0 + 0.5 * 1.0 * 0.75)) <= 1e-12);
        assert_true(fabs(found.area_b - 6.0) <= 1e-12);
    }
}

/* Open sheets have no depth, so only their pairs tell. Of two pairs of sheets each crosses or does not. */
TEST(open_sheets_that_cross_do_not_touch) {
    static const double up[3] = {0, 0, 1}, along[3] = {1, 0.25, 0}, across[3] = {0.125, 1, 0};
    for (int crossing = 0; crossing < 4; crossing++) {
        body_rig_begin(&rig);
        for (int i = 0; i < 2; i++) { /* the second sheet of each begins at the first, or behind it */
            const double back = (crossing >> i & 1) != 0 ? 0.5 : 0.0, corner[3] = {4.0 * i, 0, 0};
            const double other[3] = {4.0 * i + 0.5 - 0.125 * back, 0.125 - back, 0.375};
            body_rig_add_sheet(&rig, corner, along, up, 1, 1, false);
            body_rig_end_body(&rig);
            body_rig_add_sheet(&rig, other, across, up, 1, 1, false);
            body_rig_end_body(&rig);
        }
        body_rig_find_all(&rig);
        for (size_t i = 0; i < rig.found.curves->count; i++) {
            const cscd_curve *c = &rig.found.curves->items[i];
            assert_int_equal(c->touching, (crossing >> c->objects[0] / 2 & 1) == 0);
        }
        assert_int_equal(rig.found.curves->count, (crossing & 1) + (crossing >> 1));
    }
}

/* ---- against columns ----------------------------------------------------------------------------------- */

static column_body column_of(uint32_t body) {
    const body_part *b = &rig.bodies[body];
    return (column_body){rig.all.x0, rig.all.triangles + (size_t)b->first_triangle * 3, b->triangle_count};
}

static void compare_volume(const char *what, double found, double truth, double whole) {
    print_message("  %s: %.6f, by columns %.6f\n", what, found, truth);
    assert_true(truth > 0.0);
    assert_true(fabs(found - truth) <= 2e-3 * truth + 2e-5 * whole);
}

TEST(balls_and_rings) {
    random_stream random = stream_start(5);
    for (int round = 0; round < ROUNDS; round++) {
        double centre[3] = {stream_between(&random, 0.5, 1.1), stream_between(&random, -0.3, 0.3),
                            stream_between(&random, -0.2, 0.2)};
        static const double origin[3] = {0, 0, 0};
        body_rig_begin(&rig);
        scene_add_torus(&rig.all, origin, 1.0, 0.35, 24, 12, false);
        body_rig_end_body(&rig);
        scene_add_sphere(&rig.all, centre, 0.6, 9, 14);
        body_rig_end_body(&rig);
        body_rig_find_all(&rig);
        column_body a = column_of(1), b = column_of(0);
        compare_volume("ball in ring", body_rig_overlap(&rig, 0, 1).volume, column_volume(&a, &b, 1, LINES),
                       0.9);
    }
}

/* A snake that bends into a ring and swallows its tail. */
TEST(a_body_in_itself) {
    body_rig_begin(&rig);
    body_rig_add_snake(&rig);
    body_rig_end_body(&rig);
    body_rig_find_all(&rig);
    column_body a = column_of(0);
    double truth = column_volume(&a, NULL, 2, 2 * LINES);
    compare_volume("snake in itself", body_rig_overlap(&rig, 0, 0).volume, truth, 1.0);
}

/* Edge against edge: no vertex is within the other ball. */
TEST(balls_that_overlap_by_less_than_an_edge) {
    static const double left[3] = {0, 0, 0}, right[3] = {1.84, 0.011, 0.007};
    body_rig_begin(&rig);
    scene_add_sphere(&rig.all, left, 1.0, 7, 8);
    body_rig_end_body(&rig);
    scene_add_sphere(&rig.all, right, 1.0, 7, 8);
    body_rig_end_body(&rig);
    for (uint32_t v = rig.bodies[1].first_vertex; v < rig.all.vertex_count; v++) {
        double *x = rig.all.x0 + (size_t)v * 3, y = x[1];
        x[1] = y * cos(0.7) - x[2] * sin(0.7);
        x[2] = y * sin(0.7) + x[2] * cos(0.7);
    }
    body_rig_find_all(&rig);
    column_body a = column_of(0), b = column_of(1);
    double truth = column_volume(&a, &b, 1, 3 * LINES);
    compare_volume("two balls", body_rig_overlap(&rig, 0, 1).volume, truth, 0.0);
    assert_true(rig.found.curves->count > 0);
    for (size_t i = 0; i < rig.found.curves->count; i++) assert_true(rig.found.curves->items[i].closed);
    for (size_t i = 0; i < rig.all.vertex_count; i++)
        assert_int_equal(rig.found.patches->items[rig.found.patches->vertex_patches[i]].winding_count, 0);
}

AROUND_EACH(NULL, body_rigs_free)
