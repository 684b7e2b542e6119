/* Lenses: which points are on the wrong side, and where they belong; boxes and sheets of which that is known, and what holds for
 * every scene. */
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Two shapes, each an object, or one of both; and what was found. */
typedef struct lens_rig {
    scene shape;
    uint32_t first_vertices, first_triangles; /* of the first object */
    bool obstacle;                            /* the first object is one */
    rig r;
    cscd_lenses found;
} lens_rig;

static lens_rig the;

/* ---- shapes ------------------------------------------------------------------------------------------------ */

/* The number of a place on the surface of a box of n by n by n cells. */
static uint32_t box_vertex(uint32_t first, const uint32_t at[3], uint32_t n) {
    uint32_t count = 0;
    for (uint32_t i = 0; i <= n; i++) {
        for (uint32_t j = 0; j <= n; j++) {
            for (uint32_t k = 0; k <= n; k++) {
                const bool inside = i > 0 && i < n && j > 0 && j < n && k > 0 && k < n;
                if (i == at[0] && j == at[1] && k == at[2]) return first + count;
                count += !inside;
            }
        }
    }
    return UINT32_MAX;
}

static void add_triangle(uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *corners = the.shape.triangles + 3 * (size_t)the.shape.triangle_count++;
    corners[0] = a;
    corners[1] = b;
    corners[2] = c;
}

static void add_square(const uint32_t v[4], bool turned) {
    add_triangle(v[0], v[turned ? 3 : 1], v[turned ? 1 : 3]);
    add_triangle(v[1], v[turned ? 3 : 2], v[turned ? 2 : 3]);
}

static void add_box(const double corner[3], const double size[3], uint32_t n) {
    const uint32_t first = the.shape.vertex_count;
    for (uint32_t i = 0; i <= n; i++) {
        for (uint32_t j = 0; j <= n; j++) {
            for (uint32_t k = 0; k <= n; k++) {
                const uint32_t at[3] = {i, j, k};
                if (i > 0 && i < n && j > 0 && j < n && k > 0 && k < n) continue;
                double *x = the.shape.x0 + 3 * (size_t)the.shape.vertex_count++;
                for (int c = 0; c < 3; c++) x[c] = corner[c] + size[c] * at[c] / n;
            }
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        for (uint32_t side = 0; side < 2; side++) {
            for (uint32_t a = 0; a < n * n; a++) {
                uint32_t v[4];
                for (uint32_t q = 0; q < 4; q++) {
                    uint32_t at[3];
                    at[axis] = side * n;
                    at[(axis + 1) % 3] = a / n + (q == 1 || q == 2);
                    at[(axis + 2) % 3] = a % n + (q >= 2);
                    v[q] = box_vertex(first, at, n);
                }
                add_square(v, side == 0);
            }
        }
    }
}

/* A sheet of n by n squares from a corner along two sides. */
static void add_plate(const double corner[3], const double u[3], const double v[3], uint32_t n) {
    const uint32_t first = the.shape.vertex_count;
    for (uint32_t i = 0; i <= n; i++) {
        for (uint32_t j = 0; j <= n; j++) {
            double *x = the.shape.x0 + 3 * (size_t)the.shape.vertex_count++;
            for (int c = 0; c < 3; c++) x[c] = corner[c] + u[c] * i / n + v[c] * j / n;
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j < n; j++) {
            const uint32_t a = first + i * (n + 1) + j, square[4] = {a, a + n + 1, a + n + 2, a + 1};
            add_square(square, false);
        }
    }
}

static void begin_shapes(void) {
    scene_clear(&the.shape);
    the.first_vertices = the.first_triangles = 0;
}

/* What comes now is the second object. */
static void next_shape(void) {
    the.first_vertices = the.shape.vertex_count;
    the.first_triangles = the.shape.triangle_count;
}

/* ---- calls --------------------------------------------------------------------------------------------------- */

static void open_with(uint32_t threads, const cscd_detector_options *options) {
    static uint32_t second[SCENE_TRIANGLES_MAX * 3];
    const uint32_t n = the.first_vertices, t = the.first_triangles;
    const scene *s = &the.shape;
    for (size_t i = 0; i < 3 * (size_t)(s->triangle_count - t); i++)
        second[i] = s->triangles[3 * (size_t)t + i] - n;
    cscd_object_desc objects[2] = {
        cscd_object_of_triangles(n > 0 ? n : s->vertex_count, n > 0 ? t : s->triangle_count, s->triangles),
        cscd_object_of_triangles(s->vertex_count - n, s->triangle_count - t, second)};
    objects[0].obstacle = the.obstacle;
    the.r = rig_of_objects(context_of(threads, NULL), objects, n > 0 ? 2 : 1, s->x0, options);
}

static void close_rig(void) {
    rig_destroy(&the.r);
}

static void find_at(const double *x) {
    expect_ok(
        cscd_detector_find_lenses(the.r.detector, CSCD_DOUBLES(x, the.shape.vertex_count), NULL, &the.found));
}

static void find_now(void) {
    find_at(the.shape.x0);
}

static double dot_of(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void place_of(const double *x, const cscd_lens_point *p, double out[3]) {
    const uint32_t *corners = the.shape.triangles + 3 * (size_t)p->triangle;
    for (size_t k = 0; k < 3; k++)
        out[k] = (1.0 - p->u - p->v) * x[3 * (size_t)corners[0] + k] + p->u * x[3 * (size_t)corners[1] + k] +
                 p->v * x[3 * (size_t)corners[2] + k];
}

static double largest_coordinate(const double *x) {
    double largest = 0.0;
    for (size_t i = 0; i < 3 * (size_t)the.shape.vertex_count; i++) largest = fmax(largest, fabs(x[i]));
    return largest;
}

/* What holds for all lenses. Returns how many points go along a normal. */
static size_t expect_promises(const double *x) {
    const cscd_lenses *f = &the.found;
    const double rounding = 1e-12 * largest_coordinate(x);
    size_t points = 0, along_normals = 0;
    for (size_t i = 0; i < f->count; i++) {
        const cscd_lens *lens = &f->items[i];
        const bool of_patch = lens->reason < CSCD_LENS_EDGE;
        const double length = dot_of(lens->axis, lens->axis);
        assert_true(lens->first_point == points && lens->point_count > 0);
        assert_true(i == 0 || lens->thickness <= lens[-1].thickness);
        assert_true(lens->thickest >= points && lens->thickest < points + lens->point_count);
        assert_true(f->points[lens->thickest].thickness == lens->thickness);
        assert_true(length == 0.0 || fabs(length - 1.0) < 1e-12);
        assert_true(of_patch || (lens->patch == UINT32_MAX && !lens->fold));
        points += lens->point_count;
        for (const cscd_lens_point *p = f->points + lens->first_point; p < f->points + points; p++) {
            double place[3];
            const double *c = x + 3 * (size_t)(p->vertex != UINT32_MAX ? p->vertex : 0);
            assert_true((p->vertex == UINT32_MAX) == (lens->reason == CSCD_LENS_EDGE));
            assert_true((p->edge == UINT32_MAX) == (lens->reason != CSCD_LENS_EDGE));
            assert_true(p->vertex == UINT32_MAX || memcmp(p->x, c, sizeof p->x) == 0);
            assert_true(p->thickness >= 0.0 && p->thickness <= lens->thickness);
            assert_true(p->u >= -1e-12 && p->v >= -1e-12 && p->u + p->v <= 1.0 + 1e-12);
            place_of(x, p, place);
            along_normals += p->along_normal;
            for (int k = 0; k < 3 && !p->along_normal; k++)
                assert_true(fabs(p->x[k] + p->thickness * p->direction[k] - place[k]) <= rounding);
            if (!p->along_normal) assert_true(fabs(dot_of(p->direction, p->direction) - 1.0) < 1e-12);
        }
    }
    assert_int_equal(points, f->point_count);
    assert_true(f->thickness == (f->count > 0 ? f->items[0].thickness : 0.0));
    return along_normals;
}

/* ---- two boxes ----------------------------------------------------------------------------------------------- */

static const double unit_corner[3] = {0.0, 0.0, 0.0}, unit_size[3] = {1.0, 1.0, 1.0};

/* The tip of the second box is 0.2 in the first one, through its face at x = 1, of which it buries four vertices, and pieces of
 * edges at its own edges. */
static void make_boxes(void) {
    begin_shapes();
    add_box(unit_corner, unit_size, 5);
    next_shape();
    add_box((const double[]){0.8, 0.27, 0.23}, (const double[]){0.5, 0.5, 0.5}, 4);
}

/* How deep a point is in the second box, and in which direction the nearest face is. */
static double depth_in_second(const double *x, double out[3]) {
    static const double low[3] = {0.8, 0.27, 0.23}, high[3] = {1.3, 0.77, 0.73};
    double depth = (double)INFINITY;
    for (int k = 0; k < 6; k++) {
        const double way = k < 3 ? x[k] - low[k] : high[k - 3] - x[k - 3];
        if (way >= depth) continue;
        depth = way;
        for (int c = 0; c < 3; c++) out[c] = c != k % 3 ? 0.0 : k < 3 ? -1.0 : 1.0;
    }
    return depth;
}

TEST(boxes_have_the_thickness_of_their_tip) {
    make_boxes();
    open_with(1, NULL);
    find_now();
    assert_int_equal(expect_promises(the.shape.x0), 0);
    assert_true(the.found.count >= 2 && the.found.items[0].objects[0] == 1);
    assert_int_equal(the.found.undecided, 0);
    assert_true(fabs(the.found.thickness - 0.2) < 1e-12);
    for (size_t i = 2; i < the.found.count; i++) assert_int_equal(the.found.items[i].reason, CSCD_LENS_EDGE);
    for (size_t i = 0; i < 2; i++) {
        const cscd_lens *lens = &the.found.items[i];
        const bool tip = lens->objects[0] == 1;
        const double axis[3] = {tip ? 1.0 : -1.0, 0.0, 0.0};
        assert_int_equal(lens->reason, CSCD_LENS_BURIED);
        assert_true(lens->objects[1] == 1 - lens->objects[0] && lens->parts[0] == lens->objects[0] &&
                    lens->parts[1] == lens->objects[1] && lens->components[0] == lens->objects[0]);
        assert_true(!lens->fold && lens->patch != UINT32_MAX);
        assert_true(dot_of(lens->axis, axis) > 1.0 - 1e-12);
        assert_int_equal(lens->point_count, tip ? 25 + 16 : 4);
        for (size_t k = 0; k < lens->point_count; k++) {
            const cscd_lens_point *p = &the.found.points[lens->first_point + k];
            double way[3] = {1.0, 0.0, 0.0}, place[3];
            const double depth = tip ? 1.0 - p->x[0] : depth_in_second(p->x, way);
            assert_true(fabs(p->thickness - depth) < 1e-12 && dot_of(p->direction, way) > 1.0 - 1e-12);
            place_of(the.shape.x0, p, place);
            assert_true((p->vertex < the.first_vertices) != tip);
            assert_true((p->triangle < the.first_triangles) == tip);
            assert_true(!tip || fabs(place[0] - 1.0) < 1e-12);
        }
    }
    close_rig();
}

/* The numbers of patches are those that cscd_detector_find_intersections gives. */
TEST(patches_are_those_of_the_same_moment) {
    uint32_t patches[2];
    make_boxes();
    open_with(1, NULL);
    find_now();
    for (int i = 0; i < 2; i++) patches[the.found.items[i].objects[0]] = the.found.items[i].patch;
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.patches = true;
    expect_ok(find_intersections_packed(the.r.detector, the.shape.x0, &options, &found));
    for (uint32_t i = 0; i < 2; i++) {
        const cscd_patch *patch = &found.patches->items[patches[i]];
        assert_true(patch->object == i && patch->winding_count == 1);
        assert_true(found.patches->windings[patch->first_winding].body == 1 - i);
    }
    close_rig();
}

/* One that is inside out is taken as turned around, and what is in it leaves it all the same. */
TEST(turned_bodies_are_left_as_others_are) {
    static cscd_lens_point points[SCENE_VERTICES_MAX];
    for (int turned = 0; turned < 4; turned++) {
        make_boxes();
        for (uint32_t t = 0; t < the.shape.triangle_count; t++) {
            uint32_t *corners = the.shape.triangles + 3 * (size_t)t, last = corners[2];
            if ((turned >> (t < the.first_triangles ? 0 : 1) & 1) == 0) continue;
            corners[2] = corners[1];
            corners[1] = last;
        }
        open_with(1, NULL);
        find_now();
        assert_int_equal(expect_promises(the.shape.x0), 0);
        assert_true(the.found.count >= 2 && the.found.items[0].axis[0] > 1.0 - 1e-12);
        for (size_t i = 0; i < the.found.point_count; i++) {
            if (turned == 0) points[i] = the.found.points[i];
            assert_int_equal(the.found.points[i].vertex, points[i].vertex);
            assert_true(fabs(the.found.points[i].thickness - points[i].thickness) < 1e-12);
            assert_true(dot_of(the.found.points[i].direction, points[i].direction) > 1.0 - 1e-12);
        }
        close_rig();
    }
    cscd_intersection_options options = cscd_intersection_defaults();
    options.orientation =
        CSCD_ORIENTATION_AS_GIVEN; /* then both contain nothing: each is -1 times in the other */
    open_with(1, NULL);
    expect_ok(cscd_detector_find_lenses(the.r.detector, CSCD_DOUBLES(the.shape.x0, the.shape.vertex_count),
                                        &options, &the.found));
    for (size_t i = 0; i < the.found.count; i++) assert_true(the.found.items[i].reason != CSCD_LENS_BURIED);
    close_rig();
}

/* A box that goes in so far that all ways lead to the sides: its axis says nevertheless where it came from. */
TEST(axes_of_thick_lenses_lead_out) {
    begin_shapes();
    add_box(unit_corner, unit_size, 1);
    next_shape();
    add_box((const double[]){0.25, 0.25, -0.1}, (const double[]){0.5, 0.5, 0.5}, 1);
    open_with(1, NULL);
    find_now();
    const cscd_lens *lens = &the.found.items[0];
    assert_true(lens->objects[0] == 1 && fabs(lens->thickness - 0.25) < 1e-12);
    assert_true(lens->axis[2] < -1.0 + 1e-12);
    close_rig();
}

/* Only its lower edge passes through, and no vertex. */
TEST(edges_have_points_of_their_own) {
    begin_shapes();
    add_box(unit_corner, unit_size, 1);
    next_shape();
    add_box((const double[]){0.9, -0.6, 0.3}, (const double[]){2.0, 2.0, 0.4}, 1);
    open_with(1, NULL);
    find_now();
    expect_promises(the.shape.x0);
    assert_int_equal(the.found.undecided, 0);
    size_t edges = 0;
    for (size_t i = 0; i < the.found.count; i++) {
        const cscd_lens *lens = &the.found.items[i];
        if (lens->reason != CSCD_LENS_EDGE || lens->objects[0] != 1) continue;
        for (size_t k = 0; k < lens->point_count; k++) {
            const cscd_lens_point *p = &the.found.points[lens->first_point + k];
            assert_true(fabs(p->x[0] - 0.9) < 1e-12 && fabs(p->thickness - 0.1) < 1e-12);
            assert_true(p->direction[0] > 1.0 - 1e-12 && p->s > 0.2 && p->s < 0.8);
            edges++;
        }
    }
    assert_true(edges >= 2);
    close_rig();
}

/* More than half of the second sphere is in the first one, so the rest of it is wrong, and goes in. */
TEST(what_is_mostly_buried_goes_in) {
    begin_shapes();
    scene_add_sphere(&the.shape, unit_corner, 1.0, 12, 16);
    next_shape();
    scene_add_sphere(&the.shape, (const double[]){0.75, 0.02, 0.03}, 0.5, 12, 16);
    open_with(1, NULL);
    find_now();
    expect_promises(the.shape.x0);
    assert_true(the.found.count >= 2);
    for (size_t i = 0; i < 2; i++) {
        const cscd_lens *lens = &the.found.items[i];
        const bool second = lens->objects[0] == 1;
        assert_int_equal(lens->reason, second ? CSCD_LENS_LOOKS_OUT : CSCD_LENS_BURIED);
        assert_true(second ? lens->axis[0] < -0.9 : lens->axis[0] > 0.9);
        assert_true(lens->thickness > 0.2 && lens->thickness < 0.3);
    }
    close_rig();
}

/* The pole of a sphere is pushed in so far that it comes out on the other side. */
TEST(what_is_inside_out_goes_back) {
    begin_shapes();
    scene_add_sphere(&the.shape, unit_corner, 1.0, 16, 20);
    for (uint32_t v = 0; v < the.shape.vertex_count; v++) {
        double *x = the.shape.x0 + 3 * (size_t)v;
        if (x[2] > 0.6) x[2] -= 6.5 * (x[2] - 0.6);
    }
    open_with(1, NULL);
    find_now();
    expect_promises(the.shape.x0);
    assert_int_equal(the.found.count, 2);
    for (size_t i = 0; i < 2; i++) {
        const cscd_lens *lens = &the.found.items[i];
        const cscd_lens_point *thickest = &the.found.points[lens->thickest];
        assert_int_equal(lens->reason, CSCD_LENS_INSIDE_OUT);
        const double out = thickest->x[2] < -1.2 ? 1.0 : -1.0; /* the pole goes up, the bottom down */
        assert_true(out * lens->axis[2] > 0.99 && out * thickest->direction[2] > 0.3);
    }
    close_rig();
}

/* ---- open sheets ------------------------------------------------------------------------------------------- */

/* A sheet that stands in a plate: what is below it is the smaller side. */
TEST(the_smaller_side_of_a_sheet_is_wrong) {
    begin_shapes();
    add_plate(unit_corner, (const double[]){2.0, 0.0, 0.0}, (const double[]){0.0, 2.0, 0.0}, 10);
    next_shape();
    add_plate((const double[]){0.53, 1.07, -0.3}, (const double[]){0.9, 0.0, 0.0},
              (const double[]){0.0, 0.0, 1.0}, 8);
    open_with(1, NULL);
    find_now();
    expect_promises(the.shape.x0);
    assert_int_equal(the.found.count, 1);
    const cscd_lens *lens = &the.found.items[0];
    assert_int_equal(lens->reason, CSCD_LENS_SMALLER);
    assert_true(lens->objects[0] == 1 && lens->point_count == 27);
    assert_true(fabs(lens->thickness - 0.3) < 1e-12 && lens->axis[2] > 1.0 - 1e-12);
    for (size_t i = 0; i < lens->point_count; i++) {
        const cscd_lens_point *p = &the.found.points[i];
        assert_true(p->x[2] < 0.0 && fabs(p->thickness + p->x[2]) < 1e-12 && p->direction[2] > 1.0 - 1e-12);
    }
    close_rig();
}

/* The curve of two crossed strips leads from the border of one to that of the other. */
TEST(what_no_curve_decides_is_counted) {
    begin_shapes();
    add_plate((const double[]){0.0, 0.0, 0.0}, (const double[]){2.0, 0.0, 0.0},
              (const double[]){0.0, 1.0, 0.0}, 9);
    next_shape();
    add_plate((const double[]){1.03, 0.31, -0.51}, (const double[]){2.0, 0.0, 0.0},
              (const double[]){0.0, 0.0, 1.0}, 9);
    open_with(1, NULL);
    find_now();
    expect_promises(the.shape.x0);
    assert_true(the.found.pairs > 0 && the.found.count == 0);
    assert_int_equal(the.found.undecided, 1);
    close_rig();
}

/* A sheet with a crease that passes through itself: the curve ends where the crease begins, so both of its traces bound the one
 * patch within, which is halved. */
TEST(folds_are_halved) {
    enum { N = 24 };
    begin_shapes();
    add_plate((const double[]){-1.6, -1.5, 0.0}, (const double[]){3.2, 0.0, 0.0},
              (const double[]){0.0, 3.0, 0.0}, N - 1);
    static double sides[SCENE_VERTICES_MAX];
    for (uint32_t v = 0; v < the.shape.vertex_count; v++) {
        double *x = the.shape.x0 + 3 * (size_t)v;
        const double t = sides[v] = x[0], s = x[1];
        x[0] = t * t * t - (1.0 - s * s) * t;
        x[1] = t * t;
        x[2] = s + 0.07 * t;
    }
    open_with(1, NULL);
    find_now();
    expect_promises(the.shape.x0);
    assert_true(the.found.count >= 2);
    size_t halves[2] = {0, 0};
    static size_t lens_of[SCENE_VERTICES_MAX];
    memset(lens_of, 0xff, sizeof lens_of);
    for (size_t i = 0; i < 2; i++) {
        const cscd_lens *lens = &the.found.items[i];
        for (size_t k = 0; k < lens->point_count; k++)
            lens_of[the.found.points[lens->first_point + k].vertex] = i;
    }
    for (size_t i = 0; i < 2; i++) {
        const cscd_lens *lens = &the.found.items[i];
        size_t own = 0;
        const double side = lens->axis[0] > 0.0 ? 1.0 : -1.0;
        assert_true(lens->fold && lens->reason == CSCD_LENS_SMALLER);
        assert_int_equal(lens->patch, the.found.items[0].patch);
        assert_true(side * lens->axis[0] > 0.9);
        assert_true(lens->thickness > 0.3 && lens->thickness < 0.77);
        for (size_t k = 0; k < lens->point_count; k++) {
            const cscd_lens_point *p = &the.found.points[lens->first_point + k];
            const uint32_t *corners = the.shape.triangles + 3 * (size_t)p->triangle;
            for (int c = 0; c < 3; c++) assert_true(lens_of[corners[c]] != i);
            own += side * sides[p->vertex] > 0.0;
        }
        assert_true(5 * own > 4 * lens->point_count); /* halves are by distances along edges */
        halves[side > 0.0] = own;
    }
    assert_true(halves[0] > 60 && halves[1] > 60);
    close_rig();
}

/* ---- flush ------------------------------------------------------------------------------------------------- */

/* Two boxes stand on each other. No body winds around the corners, but they have to part. */
TEST(flush_boxes_part_along_normals) {
    size_t flush = 0;
    begin_shapes();
    add_box(unit_corner, unit_size, 2);
    next_shape();
    add_box((const double[]){0.25, 0.25, 1.0}, (const double[]){0.5, 0.5, 0.5}, 1);
    open_with(1, NULL);
    find_now();
    assert_int_equal(expect_promises(the.shape.x0), the.found.point_count);
    assert_true(the.found.thickness == 0.0 && the.found.pairs > 0);
    for (size_t i = 0; i < the.found.count; i++) {
        const cscd_lens *lens = &the.found.items[i];
        const double up = lens->objects[0] == 1 ? 1.0 : -1.0;
        if (lens->reason != CSCD_LENS_FLUSH) continue;
        flush += lens->point_count;
        assert_true(up * lens->axis[2] > 1.0 - 1e-12);
        for (size_t k = 0; k < lens->point_count; k++) {
            const cscd_lens_point *p = &the.found.points[lens->first_point + k];
            assert_true(p->along_normal && p->thickness == 0.0 && up * p->direction[2] > 1.0 - 1e-12);
            assert_true(k == 0 || p->vertex > p[-1].vertex); /* each once */
        }
    }
    assert_true(flush >= 4);
    close_rig();
}

/* ---- the same when it is moved, scaled and renumbered --------------------------------------------------------- */

typedef struct known_lens {
    cscd_lens_reason reason;
    size_t points;
    double thickness;
} known_lens;

static known_lens known[400];
static size_t known_count;

static void keep_lenses(void) {
    known_count = the.found.count;
    for (size_t i = 0; i < known_count; i++)
        known[i] = (known_lens){the.found.items[i].reason, the.found.items[i].point_count,
                                the.found.items[i].thickness};
}

static void expect_known(double scale) {
    assert_int_equal(the.found.count, known_count);
    for (size_t i = 0; i < known_count; i++) {
        const cscd_lens *lens = &the.found.items[i];
        assert_true(fabs(lens->thickness - scale * known[i].thickness) <= 1e-10 * scale);
        assert_int_equal(lens->point_count, known[i].points);
        assert_int_equal(lens->reason, known[i].reason);
    }
}

static void make_spheres(void) {
    begin_shapes();
    scene_add_sphere(&the.shape, unit_corner, 1.0, 12, 16);
    next_shape();
    scene_add_sphere(&the.shape, (const double[]){1.3, 0.4, 0.7}, 0.8, 10, 14);
}

TEST(lenses_move_and_grow_with_the_scene) {
    static double x[SCENE_VERTICES_MAX * 3];
    const double c = cos(0.7), s = sin(0.7);
    make_spheres();
    open_with(1, NULL);
    find_now();
    expect_promises(the.shape.x0);
    keep_lenses();
    assert_true(known_count >= 2 && known[0].thickness > 0.1);
    for (size_t i = 0; i < 3 * (size_t)the.shape.vertex_count; i++) x[i] = 0x1p-40 * the.shape.x0[i];
    find_at(x);
    expect_promises(x);
    expect_known(0x1p-40);
    for (size_t v = 0; v < the.shape.vertex_count; v++) {
        const double *from = the.shape.x0 + 3 * v;
        x[3 * v] = c * from[0] - s * from[1] + 0.3;
        x[3 * v + 1] = s * from[0] + c * from[1] - 1.1;
        x[3 * v + 2] = from[2] + 0.7;
    }
    find_at(x);
    expect_promises(x);
    expect_known(1.0);
    close_rig();
}

/* Vertices and triangles in the other order, and the objects, too. */
TEST(lenses_do_not_depend_on_numbers) {
    make_spheres();
    open_with(1, NULL);
    find_now();
    keep_lenses();
    close_rig();
    const scene before = the.shape;
    const uint32_t n = before.vertex_count, t = before.triangle_count;
    for (uint32_t v = 0; v < n; v++)
        memcpy(the.shape.x0 + 3 * (size_t)(n - 1 - v), before.x0 + 3 * (size_t)v, sizeof(double[3]));
    for (size_t i = 0; i < t; i++) {
        for (size_t k = 0; k < 3; k++) /* rotated, which keeps the normal */
            the.shape.triangles[3 * i + k] = n - 1 - before.triangles[3 * (t - 1 - i) + (k + i) % 3];
    }
    the.first_vertices = n - the.first_vertices;
    the.first_triangles = t - the.first_triangles;
    open_with(1, NULL);
    find_now();
    expect_promises(the.shape.x0);
    expect_known(1.0);
    close_rig();
}

/* ---- which pairs count ------------------------------------------------------------------------------------- */

TEST(parts_divide_lenses) {
    static uint32_t labels[SCENE_TRIANGLES_MAX];
    make_boxes();
    open_with(1, NULL);
    for (uint32_t t = 0; t < the.shape.triangle_count; t++) {
        const double *x = the.shape.x0 + 3 * (size_t)the.shape.triangles[3 * (size_t)t];
        labels[t] = t < the.first_triangles ? 2 : x[1] > 0.5 ? 1 : 0;
    }
    expect_ok(cscd_detector_set_parts(the.r.detector, labels, 3));
    find_now();
    expect_promises(the.shape.x0);
    size_t of_part[3] = {0, 0, 0}, of_vertices = 0;
    for (size_t i = 0; i < the.found.count; i++) {
        const cscd_lens *lens = &the.found.items[i];
        of_part[lens->parts[0]] += lens->point_count;
        of_vertices += lens->reason != CSCD_LENS_EDGE ? lens->point_count : 0;
        for (size_t k = 0; k < lens->point_count; k++)
            assert_int_equal(labels[the.found.points[lens->first_point + k].triangle], lens->parts[1]);
        for (size_t k = 0; k < i; k++)
            assert_true(lens->reason != the.found.items[k].reason ||
                        memcmp(lens->parts, the.found.items[k].parts, sizeof lens->parts) != 0);
        assert_true(lens->axis[0] > 0.9 || lens->parts[0] == 2);
    }
    assert_true(of_part[0] > 0 && of_part[1] > 0 && of_part[0] + of_part[1] == 41 && of_vertices == 45);
    close_rig();
}

/* What is not looked at is in nothing. */
TEST(what_is_left_out_has_no_lenses) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
    rules[0].mask = 0;
    options.rules = rules;
    options.rule_count = 2;
    make_boxes();
    open_with(1, &options);
    find_now();
    assert_true(the.found.count == 0 && the.found.pairs == 0 && the.found.thickness == 0.0);
    close_rig();
    static uint32_t ignored[2 * SCENE_TRIANGLES_MAX];
    cscd_intersections pairs;
    options = cscd_detector_defaults();
    open_with(1, NULL);
    expect_ok(find_intersections_packed(the.r.detector, the.shape.x0, NULL, &pairs));
    for (size_t i = 0; i < pairs.count; i++) {
        ignored[2 * i] = pairs.items[i].a;
        ignored[2 * i + 1] = pairs.items[i].b;
    }
    options.ignored = ignored;
    options.ignored_count = pairs.count;
    close_rig();
    open_with(1, &options);
    find_now();
    assert_true(the.found.count == 0 && the.found.pairs == 0 && the.found.undecided == 0);
    close_rig();
}

/* Its points cannot move, but they say how deep the other object is in it. */
TEST(obstacles_have_lenses) {
    make_boxes();
    the.obstacle = true;
    open_with(1, NULL);
    find_now();
    expect_promises(the.shape.x0);
    assert_true(the.found.count >= 2 && fabs(the.found.thickness - 0.2) < 1e-12);
    assert_true(the.found.items[0].objects[1] == 0 && the.found.items[1].objects[0] == 0);
    close_rig();
    the.obstacle = false;
}

TEST(seams_join_what_touches) {
    cscd_detector_options options;
    begin_shapes(); /* a seam: the two halves of a plate are one there, and neither is in the other */
    add_plate(unit_corner, (const double[]){1.0, 0.0, 0.0}, (const double[]){0.0, 1.0, 0.0}, 3);
    add_plate((const double[]){1.0, 0.0, 0.0}, (const double[]){1.0, 0.0, 0.0},
              (const double[]){0.0, 1.0, 0.0}, 3);
    uint32_t seams[8];
    for (uint32_t i = 0; i < 4; i++) {
        seams[2 * i] = 12 + i;
        seams[2 * i + 1] = 16 + i;
    }
    open_with(1, NULL);
    find_now();
    assert_true(the.found.count > 0 && the.found.items[0].reason == CSCD_LENS_FLUSH);
    close_rig();
    options = cscd_detector_defaults();
    options.seams = seams;
    options.seam_count = 4;
    open_with(1, &options);
    find_now();
    assert_int_equal(the.found.count, 0);
    close_rig();
}

TEST(wrong_options_are_refused) {
    make_boxes();
    open_with(1, NULL);
    const cscd_view *x = CSCD_DOUBLES(the.shape.x0, the.shape.vertex_count);
    cscd_intersection_options options = cscd_intersection_defaults();
    expect_invalid(the.r.context, cscd_detector_find_lenses(the.r.detector, x, NULL, NULL), "out is NULL");
    options.answer = CSCD_ANSWER_COUNT;
    expect_invalid(the.r.context, cscd_detector_find_lenses(the.r.detector, x, &options, &the.found),
                   "all pairs");
    options = cscd_intersection_defaults();
    options.stop_after = 5;
    expect_invalid(the.r.context, cscd_detector_find_lenses(the.r.detector, x, &options, &the.found),
                   "all pairs");
    options = cscd_intersection_defaults();
    options.max_memory = 1000;
    assert_int_equal(cscd_detector_find_lenses(the.r.detector, x, &options, &the.found), CSCD_LIST_TOO_LONG);
    assert_int_equal(cscd_detector_find_lenses(NULL, x, NULL, &the.found), CSCD_NULL_OBJECT);
    assert_string_equal(cscd_lens_reason_name(CSCD_LENS_SMALLER), "smaller side");
    assert_string_equal(cscd_lens_reason_name((cscd_lens_reason)9), "unknown");
    close_rig();
}

/* ---- all scenes -------------------------------------------------------------------------------------------- */

/* The thickness that untangling tells; no time is left for more. */
static double untangled_thickness(const double *x) {
    cscd_untangle_options options = cscd_untangle_defaults();
    cscd_untangled found;
    options.max_seconds = 0.0;
    expect_ok(cscd_detector_untangle(the.r.detector, CSCD_DOUBLES(x, the.shape.vertex_count), &options, NULL,
                                     &found));
    return found.thickness;
}

/* Each vertex is at most in one lens of a patch. Returns the number of halves of folds. */
static size_t expect_vertices_once(void) {
    static bool met[SCENE_VERTICES_MAX];
    size_t folds = 0;
    memset(met, 0, sizeof met);
    for (size_t i = 0; i < the.found.count; i++) {
        const cscd_lens *lens = &the.found.items[i];
        folds += lens->fold;
        for (size_t k = 0; k < lens->point_count && lens->reason < CSCD_LENS_EDGE; k++) {
            const uint32_t v = the.found.points[lens->first_point + k].vertex;
            assert_true(!met[v]);
            met[v] = true;
        }
    }
    return folds;
}

TEST(lenses_keep_their_promises_in_all_scenes) {
    size_t folds = 0, points = 0, normals = 0, of_reasons[CSCD_LENS_FLUSH + 1] = {0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 1; seed <= NIGHTLY(12, 400); seed++) {
            begin_shapes();
            scene_make((scene_family)family, seed, &the.shape);
            open_with(seed % 2 == 0 ? 3 : 1, NULL);
            for (int end = 0; end < 2; end++) {
                const double *x = end == 0 ? the.shape.x0 : the.shape.x1;
                find_at(x);
                normals += expect_promises(x);
                folds += expect_vertices_once();
                points += the.found.point_count;
                for (size_t i = 0; i < the.found.count; i++) of_reasons[the.found.items[i].reason]++;
                const double thickness = the.found.thickness;
                assert_true(untangled_thickness(x) == thickness);
            }
            close_rig();
        }
    }
    for (int i = 0; i <= CSCD_LENS_FLUSH; i++) assert_true(of_reasons[i] > 0);
    assert_true(folds > 0 && normals < points / 2);
}
