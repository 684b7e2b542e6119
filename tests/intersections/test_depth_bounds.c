/* How deep triangles may be: against the points of dense grids, with depths that are looked up or computed from all
 * triangles of a body. */
#include "runtime/intersections/depth_bounds.h"
#include "src/core/vec3.h"
#include "tests/support/intersections/body_measures.h"
#include "tests/support/random_stream.h"
#include "tests/support/test.h"

#include <math.h>

#ifdef SLOW_MACHINE
enum { TRIANGLES = 200, SCENES = 3 };
#else
enum { TRIANGLES = 2000, SCENES = 12 };
#endif

static body_rig rig; /* large; one test at a time */

/* ---- one triangle ---------------------------------------------------------------------------------------- */

static double longest_side_of(const double *const c[3]) {
    double longest = 0.0;
    for (int i = 0; i < 3; i++) longest = fmax(longest, sqrt(vec3_squared_distance(c[i], c[(i + 1) % 3])));
    return longest;
}

static void point_of_grid(const double *const c[3], int i, int k, int n, double out[3]) {
    double u = (double)i / n, v = (double)k / n;
    for (int j = 0; j < 3; j++) out[j] = (1.0 - u - v) * c[0][j] + u * c[1][j] + v * c[2][j];
}

/* The greatest over a grid of the least of depth + distance. */
static double sample_reach(const double *const c[3], const double depths[3], int n) {
    double greatest = 0.0, x[3];
    for (int i = 0; i <= n; i++) {
        for (int k = 0; i + k <= n; k++) {
            double least = INFINITY;
            point_of_grid(c, i, k, n, x);
            for (int j = 0; j < 3; j++) least = fmin(least, depths[j] + sqrt(vec3_squared_distance(x, c[j])));
            greatest = fmax(greatest, least);
        }
    }
    return greatest;
}

static void bounds_by_hand(void **state) {
    (void)state;
    static const double origin[3] = {0, 0, 0}, x3[3] = {3, 0, 0}, y4[3] = {0, 4, 0}, x8[3] = {8, 0, 0},
                        high[3] = {4, 1, 0};
    const double x2[3] = {2, 0, 0}, top[3] = {1, sqrt(3.0), 0};
    const double *const right[3] = {origin, x3, y4}, *const flat[3] = {origin, x8, high},
                        *const point[3] = {x3, x3, x3}, *const even[3] = {origin, x2, top};
    static const double none[3] = {0, 0, 0}, one[3] = {1, 1, 1}, steep[3] = {0, 9, 9};
    struct {
        const double *const *corners;
        const double *depths;
        double truth;
    } cases[6] = {
        {right, none, 2.5},       /* the middle of the longest side */
        {right, one, 3.5},        /* 1 more */
        {right, steep, 4.0},      /* the first corner alone matters */
        {flat, none, 17.0 / 8.0}, /* x = sqrt((x - 4)^2 + 1) on the long side */
        {point, one, 1.0},        {even, none, 2.0 / sqrt(3.0)}, /* the middle of the triangle */
    };
    for (int i = 0; i < 6; i++) {
        double bound = triangle_depth_bound(cases[i].corners, cases[i].depths);
        assert_true(bound >= cases[i].truth && bound <= cases[i].truth + 9e-6);
    }
}

/* Long and short triangles, near to the origin and far from it, depths that agree with each other and others. */
static void bounds_are_those_of_grids(void **state) {
    (void)state;
    random_stream random = stream_start(4);
    for (int round = 0; round < TRIANGLES; round++) {
        double x[3][3], depths[3], width = pow(10.0, stream_between(&random, -4, 0)),
                                   far = round % 3 == 0 ? 1000.0 : 0.0;
        const double *const corners[3] = {x[0], x[1], x[2]};
        for (int i = 0; i < 3; i++) {
            depths[i] = round % 4 == 0 ? 0.0 : stream_between(&random, 0, round % 4 == 1 ? 0.2 : 2);
            for (int k = 0; k < 3; k++)
                x[i][k] = far + stream_between(&random, -1, 1) * (k > 0 ? width : 1.0);
        }
        double bound = triangle_depth_bound(corners, depths), size = longest_side_of(corners);
        double sampled = sample_reach(corners, depths, 61);
        assert_true(bound >= sampled);
        assert_true(bound <= sampled + size / 61);
    }
}

/* ---- scenes ----------------------------------------------------------------------------------------------- */

static double listed_depth(uint32_t vertex, uint32_t object) {
    for (size_t i = 0; i < rig.found.depths->vertex_count; i++) {
        const cscd_depth *d = &rig.found.depths->items[i];
        if (d->vertex == vertex && d->object == object) return d->depth;
    }
    return 0.0;
}

static const cscd_triangle_depth *listed_bound(uint32_t triangle, uint32_t object) {
    for (size_t i = 0; i < rig.found.depths->triangle_count; i++) {
        const cscd_triangle_depth *t = &rig.found.depths->triangles[i];
        if (t->triangle == triangle && t->object == object) return t;
    }
    return NULL;
}

static void corners_of(uint32_t triangle, const double *out[3]) {
    for (uint32_t i = 0; i < 3; i++) out[i] = rig.all.x0 + (size_t)rig.all.triangles[triangle * 3 + i] * 3;
}

/* Returns how many points of the triangle the other body contains. */
static size_t compare_points(uint32_t triangle, uint32_t other, const cscd_triangle_depth *listed) {
    enum { GRID = 7 };
    const double *c[3];
    double x[3];
    size_t inside = 0;
    corners_of(triangle, c);
    for (int i = 0; i <= GRID; i++) {
        for (int k = 0; i + k <= GRID; k++) {
            point_of_grid(c, i, k, GRID, x);
            if (body_number(&rig, other, x) < 1) continue;
            inside++;
            assert_non_null(listed);
            assert_true(body_distance(&rig, other, x) <= listed->bound);
        }
    }
    return inside;
}

static void compare_listed(const cscd_triangle_depth *listed) {
    const double *c[3];
    double depths[3];
    corners_of(listed->triangle, c);
    for (uint32_t i = 0; i < 3; i++)
        depths[i] = listed_depth(rig.all.triangles[listed->triangle * 3 + i], listed->object);
    double sampled = sample_reach(c, depths, 32);
    assert_true(listed->bound >= sampled);
    assert_true(listed->bound <= sampled + longest_side_of(c) / 32);
}

static void no_point_is_deeper(void **state) {
    (void)state;
    static const double origin[3] = {0, 0, 0};
    random_stream random = stream_start(8);
    size_t inside = 0, listed = 0, cut_alone = 0;
    for (int round = 0; round < SCENES; round++) {
        double centre[3];
        for (int k = 0; k < 3; k++) centre[k] = stream_between(&random, -1.1, 1.1);
        body_rig_begin(&rig);
        scene_add_torus(&rig.all, origin, 1.0, 0.35, 12, 7, false);
        body_rig_end_body(&rig);
        scene_add_sphere(&rig.all, centre, 0.6, 5, 7);
        body_rig_end_body(&rig);
        body_rig_create(&rig, NULL, 2);
        body_rig_find(&rig);
        for (uint32_t t = 0; t < rig.all.triangle_count; t++) {
            uint32_t other = t < rig.bodies[1].first_triangle ? 1 : 0;
            inside += compare_points(t, other, listed_bound(t, other));
        }
        for (size_t i = 0; i < rig.found.depths->triangle_count; i++) {
            const cscd_triangle_depth *t = &rig.found.depths->triangles[i];
            compare_listed(t);
            assert_true(i == 0 || t[-1].triangle < t->triangle ||
                        (t[-1].triangle == t->triangle && t[-1].object < t->object));
            const uint32_t *v = rig.all.triangles + (size_t)t->triangle * 3;
            cut_alone += listed_depth(v[0], t->object) == 0.0 && listed_depth(v[1], t->object) == 0.0 &&
                         listed_depth(v[2], t->object) == 0.0;
        }
        listed += rig.found.depths->triangle_count;
        body_rig_free(&rig);
    }
    print_message("  %zu bounds, %zu of them without a corner inside, %zu points inside\n", listed, cut_alone,
                  inside);
    assert_true(listed > 20 * SCENES && cut_alone > 0 && inside > 200 * SCENES);
}

/* The outer surface of a body that goes through itself is where its number is 0 outside. */
static void a_snake_in_itself(void **state) {
    (void)state;
    body_rig_begin(&rig);
    body_rig_add_snake(&rig);
    body_rig_end_body(&rig);
    body_rig_create(&rig, NULL, 2);
    body_rig_find(&rig);
    assert_true(rig.found.depths->triangle_count > 40);
    for (size_t i = 0; i < rig.found.depths->triangle_count; i++)
        compare_listed(&rig.found.depths->triangles[i]);
    body_rig_free(&rig);
}

/* A sheet has no inside, so the ball that it goes through is not in it. */
static void an_open_sheet_contains_nothing(void **state) {
    (void)state;
    static const double origin[3] = {0, 0, 0},
                        sheet[4][3] = {{-1, -1, .1}, {2, -1, .1}, {-1, 2, .1}, {2, 2, .1}};
    static const uint32_t halves[2][3] = {{0, 1, 2}, {1, 3, 2}};
    body_rig_begin(&rig);
    scene_add_sphere(&rig.all, origin, 0.6, 5, 7);
    body_rig_end_body(&rig);
    const uint32_t first = rig.all.vertex_count;
    for (uint32_t i = 0; i < 12; i++) rig.all.x0[first * 3 + i] = sheet[i / 3][i % 3];
    for (uint32_t i = 0; i < 6; i++)
        rig.all.triangles[rig.all.triangle_count * 3 + i] = first + halves[i / 3][i % 3];
    rig.all.vertex_count += 4;
    rig.all.triangle_count += 2;
    body_rig_end_body(&rig);
    body_rig_create(&rig, NULL, 1);
    body_rig_find(&rig);
    assert_true(rig.found.curves->count == 1 && rig.found.depths->vertex_count == 0);
    /* The other half of the sheet passes the ball by. */
    uint32_t t = rig.bodies[1].first_triangle;
    assert_int_equal(rig.found.depths->triangle_count, 1);
    assert_int_equal(rig.found.depths->triangles[0].object, 0);
    assert_true(compare_points(t, 0, listed_bound(t, 0)) > 0);
    body_rig_free(&rig);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_by_hand),
        cmocka_unit_test(bounds_are_those_of_grids),
        cmocka_unit_test(no_point_is_deeper),
        cmocka_unit_test(a_snake_in_itself),
        cmocka_unit_test(an_open_sheet_contains_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
