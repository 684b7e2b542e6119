/* The kind of a pair against the intersection of the two triangles as a set, in rational numbers, on many pairs of
 * small integers, where everything degenerates. */
#include "runtime/intersections/static_check.h"
#include "tests/support/intersections/kind_oracle.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>

enum { ROUNDS = NIGHTLY(20000, 130000) };

enum { VERTEX_COUNT = 6, KIND_COUNT = CSCD_INTERSECTION_TOUCHING + 1 };

/* A pair of triangles. */
typedef struct pair_case {
    uint32_t a[3], b[3], names[VERTEX_COUNT];
    bool named; /* else vertices have no names */
    integer_vector points[VERTEX_COUNT];
} pair_case;

static int seed_random(void **state) {
    (void)state;
    random_seed(20261122);
    return 0;
}

/* ---- configurations ------------------------------------------------------------------------------------ */

/* The second triangle begins with vertices of the first, then takes its own; both are turned at random. */
static void share_by_index(pair_case *c, int shared) {
    uint32_t turn = (uint32_t)random_integer(0, 2);
    for (uint32_t i = 0; i < 3; i++) {
        c->a[i] = i;
        c->b[(i + turn) % 3] = (int)i < shared ? (i + 1) % 3 : 3 + i;
    }
}

/* The same with vertices of their own, of which some have common names, at one place or not. */
static void share_by_name(pair_case *c, int shared) {
    share_by_index(c, 0);
    for (uint32_t i = 0; i < VERTEX_COUNT; i++) c->names[i] = i;
    for (uint32_t i = 0; (int)i < shared; i++) {
        c->names[3 + i] = (i + 1) % 3;
        if (random_integer(0, 3) > 0) c->points[3 + i] = c->points[(i + 1) % 3];
    }
}

/* Small ranges make coincident points, zero areas and common planes frequent. A plane is common to all points, or to
 * most of them. */
static void random_points(integer_vector points[VERTEX_COUNT]) {
    int range[3], flat = random_integer(0, 3);
    for (int k = 0; k < 3; k++) range[k] = random_integer(1, 4);
    for (int i = 0; i < VERTEX_COUNT; i++) {
        points[i].x = random_integer(-range[0], range[0]);
        points[i].y = random_integer(-range[1], range[1]);
        points[i].z = flat == 0 || (flat == 1 && i % 3 != 0) ? 0 : random_integer(-range[2], range[2]);
    }
}

/* Shears along x, y and z one after the other, which changes no kind and is never singular, and moves. */
static void shear_points(const integer_vector points[VERTEX_COUNT], integer_vector sheared[VERTEX_COUNT]) {
    int factor[6], offset = random_integer(-1000000, 1000000);
    for (int k = 0; k < 6; k++) factor[k] = random_integer(-2000, 2000);
    for (int i = 0; i < VERTEX_COUNT; i++) {
        integer_vector p = points[i];
        p.x += factor[0] * p.y + factor[1] * p.z;
        p.y += factor[2] * p.x + factor[3] * p.z;
        p.z += factor[4] * p.x + factor[5] * p.y;
        sheared[i] = (integer_vector){p.x + offset, p.y - offset, p.z + 2 * offset};
    }
}

/* ---- comparison ---------------------------------------------------------------------------------------- */

static void store_positions(const integer_vector points[VERTEX_COUNT], double scale, double *positions) {
    for (int i = 0; i < VERTEX_COUNT; i++) {
        positions[3 * i] = scale * (double)points[i].x;
        positions[3 * i + 1] = scale * (double)points[i].y;
        positions[3 * i + 2] = scale * (double)points[i].z;
    }
}

static void expect_kind(const uint32_t a[3], const uint32_t b[3], const pair_case *c, const double *positions,
                        int kind) {
    const uint32_t *names = c->named ? c->names : NULL;
    pair_kind found = {CSCD_INTERSECTION_KIND_MAX_ENUM, 99};
    assert_int_equal(pair_kind_find(a, b, names, positions, &found), kind >= 0);
    assert_int_equal(found.kind, kind >= 0 ? kind : CSCD_INTERSECTION_KIND_MAX_ENUM);
    assert_int_equal(found.shared, kind >= 0 ? oracle_shared(a, b, names) : 99);
}

/* In all orders of the corners, and with the triangles exchanged. */
static void expect_in_all_orders(const pair_case *c, const double *positions, int kind) {
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int i = 0; i < 36; i++) {
        const int *p = orders[i / 6], *q = orders[i % 6];
        const uint32_t a[3] = {c->a[p[0]], c->a[p[1]], c->a[p[2]]},
                       b[3] = {c->b[q[0]], c->b[q[1]], c->b[q[2]]};
        expect_kind(a, b, c, positions, kind);
        expect_kind(b, a, c, positions, kind);
    }
}

/* As it is, and sheared and scaled; returns the kind. */
static int compare_pair(const pair_case *c, bool every_order) {
    double positions[VERTEX_COUNT * 3];
    integer_vector sheared[VERTEX_COUNT];
    int kind = oracle_kind(c->a, c->b, c->named ? c->names : NULL, true, c->points);
    store_positions(c->points, 1.0, positions);
    expect_kind(c->a, c->b, c, positions, kind);
    if (every_order) expect_in_all_orders(c, positions, kind);
    shear_points(c->points, sheared);
    store_positions(sheared, ldexp(1.0, random_integer(-300, 250)), positions);
    expect_kind(c->b, c->a, c, positions, kind);
    if (every_order) expect_in_all_orders(c, positions, kind);
    return kind;
}

static void compare_class(int shared, bool named) {
    int of_kind[KIND_COUNT + 1] = {0};
    for (int round = 0; round < ROUNDS; round++) {
        pair_case c = {.named = named};
        random_points(c.points);
        if (named)
            share_by_name(&c, shared);
        else
            share_by_index(&c, shared);
        of_kind[1 + compare_pair(&c, round % 32 == 0)]++;
    }
    printf("%d shared %s:", shared, named ? "by name" : "by index");
    for (int kind = -1; kind < KIND_COUNT; kind++)
        printf(" %d %s", of_kind[1 + kind],
               kind < 0 ? "apart" : cscd_intersection_kind_name((cscd_intersection_kind)kind));
    puts("");
    const int *of = of_kind + 1, some = ROUNDS / 200;
    assert_true(of_kind[0] > some || (named && shared == 3));
    assert_int_equal(of[CSCD_INTERSECTION_COPLANAR] > some, shared == 0);
    assert_true(of[CSCD_INTERSECTION_FOLDED] > some || shared == 0 || shared == 3);
    assert_int_equal(of[CSCD_INTERSECTION_DUPLICATE] > some, shared == 3);
    assert_true(of[CSCD_INTERSECTION_CROSSING] > some || shared >= 2);
    assert_true(of[CSCD_INTERSECTION_TOUCHING] > some || shared == 3);
    if (!named && shared >= 2) assert_int_equal(of[CSCD_INTERSECTION_CROSSING], 0);
}

TEST(shared_by_index) {
    for (int shared = 0; shared < 4; shared++) compare_class(shared, false);
}

TEST(shared_by_name) {
    for (int shared = 0; shared < 4; shared++) compare_class(shared, true);
}

/* ---- known pairs --------------------------------------------------------------------------------------- */

/* A triangle in z = 0, then points above, below, within and beside it. */
static const double places[] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1,  1, 1, 1, 1, -1, 9, 9, 1,
                                1, 1, 0, 2, 2, 0, 5, 5, 0, -1, 1, 0, 1, 2, 0,  0, 0, 0};

static void expect_known(uint32_t p, uint32_t q, uint32_t r, int kind, uint32_t shared) {
    const uint32_t base[3] = {0, 1, 2}, other[3] = {p, q, r};
    pair_kind found = {CSCD_INTERSECTION_CROSSING, 9};
    assert_int_equal(pair_kind_find(base, other, NULL, places, &found), kind >= 0);
    if (kind < 0) return;
    assert_int_equal(found.kind, kind);
    assert_int_equal(found.shared, shared);
}

TEST(known_pairs) {
    expect_known(3, 4, 5, CSCD_INTERSECTION_CROSSING, 0);
    expect_known(3, 5, 6, CSCD_INTERSECTION_TOUCHING, 0);  /* a corner on the face */
    expect_known(3, 5, 7, CSCD_INTERSECTION_TOUCHING, 0);  /* a corner on an edge */
    expect_known(3, 5, 11, CSCD_INTERSECTION_TOUCHING, 0); /* two corners at one place */
    expect_known(6, 10, 3, CSCD_INTERSECTION_TOUCHING, 0); /* an edge in the face */
    expect_known(3, 4, 6, CSCD_INTERSECTION_TOUCHING, 0);  /* no area, through the face */
    expect_known(6, 7, 8, CSCD_INTERSECTION_TOUCHING, 0);  /* no area, in the plane */
    expect_known(6, 7, 10, CSCD_INTERSECTION_COPLANAR, 0);
    expect_known(7, 8, 10, CSCD_INTERSECTION_COPLANAR, 0);
    expect_known(0, 3, 4, CSCD_INTERSECTION_CROSSING, 1);
    expect_known(0, 3, 5, -1, 0);                         /* the shared vertex alone */
    expect_known(0, 6, 3, CSCD_INTERSECTION_TOUCHING, 1); /* an edge from the shared vertex in the face */
    expect_known(0, 6, 8, CSCD_INTERSECTION_TOUCHING, 1); /* no area */
    expect_known(0, 7, 10, CSCD_INTERSECTION_FOLDED, 1);
    expect_known(1, 2, 6, CSCD_INTERSECTION_FOLDED, 2);
    expect_known(1, 2, 3, -1, 0);                         /* a hinge */
    expect_known(1, 2, 8, -1, 0);                         /* a flat hinge */
    expect_known(1, 2, 7, CSCD_INTERSECTION_TOUCHING, 2); /* no area, on the shared edge */
    expect_known(2, 1, 0, CSCD_INTERSECTION_DUPLICATE, 3);
}

AROUND_EACH(seed_random, NULL)
