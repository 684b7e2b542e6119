/* triangles_intersect against the definition, feature pair by feature pair, on integers from -3 to 3. */
#include <math.h>
#include <stdio.h>

#include "src/mesh/predicates.h"
#include "tests/support/intersections/kind_oracle.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

enum { ROUND_COUNT = PACED(100000, 20000) };

static int seed_random(void **state) {
    (void)state;
    random_seed(19690720);
    return 0;
}

/* The second triangle begins with vertices of the first, then takes its own. */
static void share_vertices(int shared_count, uint32_t a[3], uint32_t b[3]) {
    for (uint32_t i = 0; i < 3; i++) {
        a[i] = i;
        b[i] = (int)i < shared_count ? (i + 1) % 3 : 3 + i;
    }
}

/* Small ranges make coincident points, zero areas and common planes frequent. */
static void random_points(integer_vector points[6]) {
    int range[3];

    for (int k = 0; k < 3; k++) range[k] = random_integer(0, 3);
    for (int i = 0; i < 6; i++) {
        points[i].x = random_integer(-range[0], range[0]);
        points[i].y = random_integer(-range[1], range[1]);
        points[i].z = random_integer(-range[2], range[2]);
    }
}

static void store_positions(const integer_vector points[6], double scale, double positions[18]) {
    for (int i = 0; i < 6; i++) {
        positions[3 * i] = scale * (double)points[i].x;
        positions[3 * i + 1] = scale * (double)points[i].y;
        positions[3 * i + 2] = scale * (double)points[i].z;
    }
}

/* Checks both arguments in all orders of their corners, and the arguments exchanged. */
static void check_all_orders(const uint32_t a[3], const uint32_t b[3], const double *positions,
                             bool expected) {
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};

    for (int i = 0; i < 36; i++) {
        const int *p = orders[i / 6], *q = orders[i % 6];
        uint32_t a_turned[3] = {a[p[0]], a[p[1]], a[p[2]]}, b_turned[3] = {b[q[0]], b[q[1]], b[q[2]]};

        assert_true(triangles_intersect(a_turned, b_turned, positions) == expected);
        assert_true(triangles_intersect(b_turned, a_turned, positions) == expected);
    }
}

/* Shears along x, y and z one after the other, which is never singular. The images intersect where the
 * originals do, and no plane stays along the axes. */
static integer_vector shear_point(integer_vector p, const int factor[6]) {
    p.x += factor[0] * p.y + factor[1] * p.z;
    p.y += factor[2] * p.x + factor[3] * p.z;
    p.z += factor[4] * p.x + factor[5] * p.y;
    return p;
}

static void random_shear(const integer_vector points[6], integer_vector sheared[6]) {
    int offset[3];
    int factor[6];

    for (int k = 0; k < 3; k++) offset[k] = random_integer(-1000000, 1000000);
    for (int k = 0; k < 6; k++) factor[k] = random_integer(-2000, 2000);
    for (int i = 0; i < 6; i++) {
        sheared[i] = shear_point(points[i], factor);
        sheared[i].x += offset[0];
        sheared[i].y += offset[1];
        sheared[i].z += offset[2];
    }
}

/* Compares one pair with the oracle, as it is, scaled, and sheared. */
static bool check_pair(const uint32_t a[3], const uint32_t b[3], const integer_vector points[6],
                       bool every_order) {
    bool expected = oracle_intersects(a, b, NULL, points);
    integer_vector sheared[6];
    double positions[18];

    store_positions(points, 1.0, positions);
    assert_true(triangles_intersect(a, b, positions) == expected);
    assert_true(triangles_intersect(b, a, positions) == expected);
    if (every_order) check_all_orders(a, b, positions, expected);
    store_positions(points, ldexp(1.0, random_integer(-300, 298)), positions);
    assert_true(triangles_intersect(a, b, positions) == expected);
    random_shear(points, sheared);
    store_positions(sheared, ldexp(1.0, random_integer(-300, 250)), positions);
    assert_true(triangles_intersect(a, b, positions) == expected);
    if (every_order) check_all_orders(a, b, positions, expected);
    return expected;
}

static void check_class(int shared_count) {
    int meeting = 0, apart = 0;

    for (int round = 0; round < ROUND_COUNT; round++) {
        uint32_t a[3], b[3];
        integer_vector points[6];

        share_vertices(shared_count, a, b);
        random_points(points);
        if (check_pair(a, b, points, round % 16 == 0)) {
            meeting++;
        } else {
            apart++;
        }
    }
    printf("%d shared: %7d meet %7d apart\n", shared_count, meeting, apart);
    assert_true(apart >= 500);
    if (shared_count == 3) assert_int_equal(meeting, 0);
    if (shared_count < 3) assert_true(meeting >= 500);
}

TEST(no_shared_vertex) {
    check_class(0);
}

TEST(one_shared_vertex) {
    check_class(1);
}

TEST(two_shared_vertices) {
    check_class(2);
}

TEST(three_shared_vertices) {
    check_class(3);
}

TEST(known_pairs) {
    /* A triangle in z = 0, then points above, below, within and beside it. */
    const double positions[] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, 1, 1, -1, 9, 9, 1,
                                1, 1, 0, 2, 2, 0, 5, 5, 0, 1, 2, 0, 4, 4, 0,  0, 0, 0};
    const uint32_t base[3] = {0, 1, 2};

    assert_true(triangles_intersect(base, (uint32_t[]){3, 4, 5}, positions));   /* pierced */
    assert_true(triangles_intersect(base, (uint32_t[]){3, 5, 6}, positions));   /* touched by a vertex */
    assert_true(triangles_intersect(base, (uint32_t[]){7, 8, 5}, positions));   /* touched on an edge */
    assert_false(triangles_intersect(base, (uint32_t[]){3, 5, 8}, positions));  /* beside */
    assert_true(triangles_intersect(base, (uint32_t[]){6, 9, 7}, positions));   /* one plane, inside */
    assert_false(triangles_intersect(base, (uint32_t[]){0, 3, 5}, positions));  /* only the shared vertex */
    assert_true(triangles_intersect(base, (uint32_t[]){0, 3, 4}, positions));   /* pierced beside it */
    assert_true(triangles_intersect(base, (uint32_t[]){11, 3, 5}, positions));  /* same place, other vertex */
    assert_false(triangles_intersect(base, (uint32_t[]){1, 2, 3}, positions));  /* hinge */
    assert_false(triangles_intersect(base, (uint32_t[]){1, 2, 10}, positions)); /* flat hinge */
    assert_true(triangles_intersect(base, (uint32_t[]){1, 2, 6}, positions));   /* folded hinge */
    assert_false(triangles_intersect(base, (uint32_t[]){2, 1, 0}, positions));  /* the same three */
}

AROUND_EACH(seed_random, NULL)
