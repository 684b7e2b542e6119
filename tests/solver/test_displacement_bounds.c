/* Displacement bounds: motions into the corners of what they allow keep all pairs apart, by rational numbers. */
#include "tests/support/calls.h"
#include "tests/support/panels.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/solver/exact_distance.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double points[4][3];

static scene interval; /* large; one test at a time */
static double bounds[SCENE_VERTICES_MAX], others[SCENE_VERTICES_MAX], nearest[SCENE_VERTICES_MAX];
static bool explained[SCENE_VERTICES_MAX]; /* the nearest pair shows why the bound is not more */

static cscd_displacement_bounds find_bounds(const rig *r, double radius, cscd_scalar scalar, double *out) {
    static float x0[SCENE_VERTICES_MAX * 3], floats[SCENE_VERTICES_MAX];
    cscd_displacement_bounds found;
    uint32_t count = interval.vertex_count;
    if (scalar == CSCD_SCALAR_DOUBLE) {
        expect_ok(displacement_bounds_packed(r->detector, interval.x0, radius, out, &found));
        return found;
    }
    for (size_t i = 0; i < (size_t)count * 3; i++) x0[i] = (float)interval.x0[i];
    expect_ok(cscd_detector_displacement_bounds(r->detector, CSCD_FLOATS(x0, count), radius, scalar, floats,
                                                count * sizeof *floats, &found));
    for (uint32_t v = 0; v < count; v++) out[v] = (double)floats[v];
    return found;
}

static void load_points(const cscd_stencil *s, const double *x, points out) {
    for (int i = 0; i < 4; i++) memcpy(out[i], x + (size_t)s->vertices[i] * 3, sizeof out[i]);
}

static cscd_stencil stencil_of(const rig *r, const cscd_proximity *p) {
    return stencil_of_item(r->mesh, p);
}

static double in_scalar(double x, cscd_scalar scalar) {
    return scalar == CSCD_SCALAR_FLOAT ? (double)(float)x : x;
}

/* Moves a stored point along a direction as far as its bound lets it go, and not a unit in the last place farther. */
static void go_along(double point[3], const double direction[3], double bound, cscd_scalar scalar) {
    double start[3], length = 0.0;
    memcpy(start, point, sizeof start);
    for (int k = 0; k < 3; k++) length += direction[k] * direction[k];
    if (length == 0.0) return;
    for (int i = 0; i < 60; i++) {
        double step = bound / sqrt(length) * (i == 0 ? 1.0 : 1.0 - ldexp(1.0, i - 58));
        for (int k = 0; k < 3; k++) point[k] = in_scalar(start[k] + step * direction[k], scalar);
        if (points_within(point, start, bound)) return;
    }
    memcpy(point, start, sizeof start);
}

/* Both features go towards each other, along the shortest connection or along an edge of the cube. */
static void check_attack(const cscd_proximity *p, const points x, const cscd_stencil *s, double apart,
                         const double direction[3], cscd_scalar scalar) {
    points moved;
    memcpy(moved, x, sizeof moved);
    int first = p->kind == CSCD_CONTACT_VF ? 1 : 2;
    double back[3] = {-direction[0], -direction[1], -direction[2]};
    for (int i = 0; i < 4; i++)
        go_along(moved[i], i < first ? back : direction, bounds[s->vertices[i]], scalar);
    assert_true(distance_sign_of_sum(p->kind, (const double(*)[3])moved, apart, 0.0, 1.0) > 0);
}

/* Along the shortest connection, into a corner of the cube about it, or anywhere. */
static void attack_pair(const cscd_proximity *p, const cscd_stencil *s, double apart, cscd_scalar scalar,
                        int which) {
    points x;
    double direction[3];
    load_points(s, interval.x0, x);
    for (int k = 0; k < 3; k++) {
        double corner = p->normal[k] > 0.0 ? 1.0 : -1.0;
        direction[k] = which == 0 ? p->normal[k] : which == 1 ? corner : random_unit();
    }
    check_attack(p, (const double(*)[3])x, s, apart, direction, scalar);
}

/* Does the bound allow at least 0.49 of the distance of this pair less the apart? */
static bool allows_enough(const cscd_proximity *p, const cscd_stencil *s, double apart, double bound) {
    points x;
    load_points(s, interval.x0, x);
    return distance_sign_of_sum(p->kind, (const double(*)[3])x, apart, bound > 0.0 ? bound : 0x1p-352,
                                0.49) <= 0;
}

/* The least distances of the pairs of each vertex, rounded; pairs that are as near up to rounding are all asked. */
static void find_nearest(const rig *r, const cscd_proximities *near) {
    for (uint32_t v = 0; v < interval.vertex_count; v++) nearest[v] = INFINITY;
    for (size_t i = 0; i < near->count; i++) {
        cscd_stencil s = stencil_of(r, &near->items[i]);
        for (int j = 0; j < 4; j++)
            nearest[s.vertices[j]] = fmin(nearest[s.vertices[j]], near->items[i].distance);
    }
}

typedef struct tally {
    size_t pairs, blocked, limited;
} tally;

/* Half the radius, as the scalar holds it. */
static double half_of(double radius, cscd_scalar scalar) {
    double half = 0.5 * radius;
    if (scalar == CSCD_SCALAR_DOUBLE) return half;
    float rounded = (float)half;
    return (double)((double)rounded > half ? nextafterf(rounded, 0.0f) : rounded);
}

/* Attacks the pair, and notes the vertices whose bounds it explains. Returns whether it is blocked. */
static bool check_pair(const rig *r, const cscd_proximity *p, double apart, cscd_scalar scalar, int which) {
    cscd_stencil s = stencil_of(r, p);
    points x;
    load_points(&s, interval.x0, x);
    bool closed = distance_sign_of_sum(p->kind, (const double(*)[3])x, apart, 0.0, 1.0) <= 0;
    for (int i = 0; i < 4; i++) {
        uint32_t v = s.vertices[i];
        if (closed) assert_true(bounds[v] == 0.0);
        if (p->distance <= nearest[v] * (1.0 + 1e-9) && !explained[v])
            explained[v] = allows_enough(p, &s, apart, bounds[v]);
    }
    if (!closed) attack_pair(p, &s, apart, scalar, which);
    return closed;
}

/* A bound is half the radius, unless the nearest pair of its vertex explains that it is less. */
static void check_bounds(const rig *r, double radius, double apart, cscd_scalar scalar, tally *sum) {
    cscd_displacement_bounds found = find_bounds(r, radius, scalar, bounds);
    size_t blocked = 0, limited = 0;
    double half = half_of(radius, scalar);
    cscd_proximities near;
    expect_ok(find_near_packed(r->detector, interval.x0, (radius + apart) * (1.0 + 0x1p-16), &near));
    find_nearest(r, &near);
    memset(explained, 0, sizeof explained);
    for (size_t i = 0; i < near.count; i++)
        blocked += check_pair(r, &near.items[i], apart, scalar, (int)(i % 3));
    for (uint32_t v = 0; v < interval.vertex_count; v++) {
        assert_true(bounds[v] == half || explained[v]);
        assert_true(bounds[v] >= 0.0 && bounds[v] <= half && in_scalar(bounds[v], scalar) == bounds[v]);
        assert_true(bounds[v] > found.least || (bounds[v] == found.least && v >= found.vertex));
        limited += bounds[v] < half;
    }
    sum->limited += limited;
    assert_int_equal(found.blocked_count, blocked);
    assert_int_equal(found.limited, limited);
    assert_true(found.least == bounds[found.vertex]);
    sum->pairs += near.count;
    sum->blocked += blocked;
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

static rig rig_with(double apart, uint32_t threads) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = apart;
    return rig_create(&interval, threads, &options);
}

static void make_floats(void) {
    for (size_t i = 0; i < (size_t)interval.vertex_count * 3; i++)
        interval.x0[i] = (double)(float)interval.x0[i];
}

TEST(motions_within_bounds_keep_pairs_apart) {
    static const double radii[] = {0.01, 0.05, 0.1};
    tally sum = {0, 0, 0};
    random_seed(2);
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < 6; seed++) {
            scene_make((scene_family)family, seed, &interval);
            cscd_scalar scalar = seed % 2 == 0 ? CSCD_SCALAR_DOUBLE : CSCD_SCALAR_FLOAT;
            if (scalar == CSCD_SCALAR_FLOAT) make_floats();
            double radius = radii[seed / 2], apart = seed % 3 == 0 ? 0.0 : 0.3 * radius;
            rig r = rig_with(apart, 1);
            check_bounds(&r, radius, apart, scalar, &sum);
            rig_destroy(&r);
        }
    }
    assert_true(sum.pairs > 2000 && sum.blocked > 100 && sum.limited > 500);
}

/* ---- which pairs count --------------------------------------------------------------------------------- */

static bool ignore_all(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return user == NULL && (kind == CSCD_CONTACT_VF || a < b);
}

TEST(pairs_left_out_give_no_bounds) {
    static const uint32_t ignored[] = {1, 0}, seams[] = {0, 3, 1, 4, 2, 5};
    scene_two_triangles(&interval, 0.25);
    for (int i = 0; i < 4; i++) {
        cscd_detector_options options = cscd_detector_defaults();
        if (i == 1) options.ignore = ignore_all;
        if (i == 2) options.ignored = ignored, options.ignored_count = 1;
        if (i == 3) options.seams = seams, options.seam_count = 3;
        rig r = rig_create(&interval, 1, &options);
        assert_int_equal(find_bounds(&r, 1.0, CSCD_SCALAR_DOUBLE, bounds).blocked_count, 0);
        for (int v = 0; v < 6; v++) {
            if (i == 0) assert_true(bounds[v] < 0.125 && bounds[v] > 0.124);
            if (i == 1 || i == 2) assert_true(bounds[v] == 0.5);
            if (i == 3)
                assert_true(bounds[v] > 0.3 &&
                            bounds[v] ==
                                bounds[(v + 3) % 6]); /* a corner and the other triangle's opposite side */
        }
        rig_destroy(&r);
    }
}

/* Of two triangles that are sewn at a corner one, which is the first or the second, has a third one 0.1 above another. */
TEST(a_seam_has_one_bound) {
    static const double sewn[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {3, 0, 0}, {3, 1, 0}};
    static const double third[2][3][3] = {{{0, 0, 0.1}, {-1, 0, 0.1}, {-1, -1, 0.1}},
                                          {{3, 0, 0.1}, {4, 0, 0.1}, {4, 1, 0.1}}};
    static const uint32_t seam[] = {1, 3};
    interval.vertex_count = 9;
    interval.triangle_count = 3;
    for (uint32_t i = 0; i < 9; i++) interval.triangles[i] = i;
    for (int near = 0; near < 2; near++) {
        memcpy(interval.x0, sewn, sizeof sewn);
        memcpy(interval.x0 + 18, third[near], sizeof third[near]);
        memcpy(interval.x1, interval.x0, sizeof interval.x1);
        cscd_detector_options options = cscd_detector_defaults();
        options.seams = seam, options.seam_count = 1;
        rig r = rig_create(&interval, 1, &options);
        cscd_displacement_bounds found = find_bounds(&r, 0.5, CSCD_SCALAR_DOUBLE, bounds);
        assert_true(bounds[1] > 0.049 && bounds[1] < 0.05 && bounds[3] == bounds[1]);
        for (int v = 0; v < 6; v++)
            assert_true(v == 1 || v == 3 || bounds[v] == (v / 3 == near ? bounds[1] : 0.25));
        assert_true(found.vertex == (uint32_t)near && found.least == bounds[1]);
        rig_destroy(&r);
    }
}

/* Obstacles that nothing else is near may go half the radius; where cloth is near, both sides have bounds. */
TEST(obstacles_have_bounds_for_what_they_may_touch) {
    scene_two_triangles(&interval, 0.25);
    static const uint32_t triangle[] = {0, 1, 2};
    for (int obstacles = 1; obstacles < 3; obstacles++) {
        cscd_object_desc objects[2] = {cscd_object_of_triangles(3, 1, triangle),
                                       cscd_object_of_triangles(3, 1, triangle)};
        objects[0].obstacle = obstacles == 2;
        objects[1].obstacle = true;
        rig r = rig_of_objects(context_of(0, NULL), objects, 2, NULL, NULL);
        find_bounds(&r, 1.0, CSCD_SCALAR_DOUBLE, bounds);
        for (int v = 0; v < 6; v++) assert_true(obstacles == 2 ? bounds[v] == 0.5 : bounds[v] < 0.125);
        rig_destroy(&r);
    }
}

/* ---- the same for everyone ----------------------------------------------------------------------------- */

TEST(bounds_are_the_same_for_all_threads_and_methods) {
    for (uint64_t seed = 0; seed < 4; seed++) {
        scene_make(seed % 2 == 0 ? SCENE_BENT_CAPSULE : SCENE_GRID, seed, &interval);
        rig one = rig_with(0.01, 1), many = rig_with(0.01, 4);
        cscd_detector_options options = cscd_detector_defaults();
        options.method = CSCD_METHOD_BRUTE;
        options.min_separation = 0.01;
        rig brute = rig_create(&interval, 1, &options);
        size_t size = interval.vertex_count * sizeof *bounds;
        size_t blocked = find_bounds(&one, 0.2, CSCD_SCALAR_DOUBLE, bounds).blocked_count;
        assert_int_equal(find_bounds(&many, 0.2, CSCD_SCALAR_DOUBLE, others).blocked_count, blocked);
        assert_memory_equal(bounds, others, size);
        assert_int_equal(find_bounds(&brute, 0.2, CSCD_SCALAR_DOUBLE, others).blocked_count, blocked);
        assert_memory_equal(bounds, others, size);
        rig_destroy(&one);
        rig_destroy(&many);
        rig_destroy(&brute);
    }
}

/* Finds the bounds of two panels whose distances by classes are these; the number of pairs that have none is returned. */
static size_t bounds_of_panels(const panel_scene *p, double radius, const double matrix[4], double separation,
                               double *out) {
    cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
    cscd_displacement_bounds found;
    rules[1].thickness_class = matrix != NULL;
    expect_ok(cscd_detector_set_separation(p->detector, 0.0, 0.0));
    expect_ok(cscd_detector_set_rules(p->detector, rules, 2, matrix, matrix != NULL ? 2 : 0));
    expect_ok(cscd_detector_set_separation(p->detector, separation, 0.0));
    expect_ok(displacement_bounds_packed(p->detector, p->x0, radius, out, &found));
    for (size_t i = 0; matrix != NULL && i < found.blocked_count; i++) {
        const cscd_proximity *pair = &found.blocked[i];
        uint32_t a = cscd_mesh_vertex_object(p->mesh, pair->vertices[0]),
                 b = cscd_mesh_vertex_object(p->mesh, pair->vertices[3]);
        assert_true(pair->distance <= matrix[2 * a + b]);
    }
    return found.blocked_count;
}

/* Every pair keeps the distance of its own objects: as with that distance for all, or with none, or in between. */
TEST(distances_of_objects_count) {
    static const double each = 1.5, all[] = {1.5, 1.5, 1.5, 1.5}, cross[] = {0.0, 1.5, 1.5, 0.0};
    static double with_none[200], with_all[200], with_cross[200];
    panel_scene p = panels_create(10, NULL, NULL);
    for (double radius = 3.0; radius > 0.1; radius *= 0.1) { /* also one that is less than the distances */
        size_t wider = 0, narrower = 0;
        size_t blocked = bounds_of_panels(&p, radius, NULL, each, with_all);
        assert_int_equal(bounds_of_panels(&p, radius, all, 0.0, with_none), blocked);
        assert_memory_equal(with_none, with_all, sizeof with_all);
        bounds_of_panels(&p, radius, NULL, 0.0, with_none);
        assert_true(bounds_of_panels(&p, radius, cross, 0.0, with_cross) < blocked);
        for (int v = 0; v < 200; v++) {
            assert_true(with_all[v] <= with_cross[v] && with_cross[v] <= with_none[v]);
            wider += with_cross[v] > with_all[v];
            narrower += with_cross[v] < with_none[v];
        }
        assert_true(wider > 20 && narrower > 20);
    }
    panels_destroy(&p);
}
