/* Triangles near a point: none within the distance is left out, on any level, and few others come with them. */
#include "runtime/bvh/bvh.h"
#include "runtime/ccd/ccd.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { TRIANGLES = 400, QUERIES = 400, SHAPES = 12 };

static scene shape; /* large; one test at a time */

/* Triangles of one shape, one after another thin or tiny, in a cloud or nearly in one plane, small or large, and far from the
 * origin or at it. */
static void make_cloud(uint32_t number, random_stream *random) {
    const bool flat = number % 2 == 1;
    const double scale = pow(10.0, stream_between(random, -9.0, 9.0)), far = number % 3 == 0 ? 1e5 : 0.0;
    const double turn = stream_between(random, 0.0, 6.3);
    scene_clear(&shape);
    shape.vertex_count = 3 * TRIANGLES;
    shape.triangle_count = TRIANGLES;
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        const double size = 0.2 * pow(10.0, t % 5 == 0 ? stream_between(random, -7.0, 0.0) : 0.0);
        const double thin = t % 4 == 0 ? pow(10.0, stream_between(random, -7.0, 0.0)) : 1.0;
        double centre[3], sides[3][3];
        for (int k = 0; k < 3; k++) {
            centre[k] = stream_between(random, -1.0, 1.0) * (flat && k == 2 ? 1e-3 : 1.0);
            for (int i = 0; i < 2; i++)
                sides[i][k] = stream_between(random, -1.0, 1.0) * (flat && k == 2 ? 1e-4 : 1.0);
            sides[1][k] = (1.0 - thin) * sides[0][k] + thin * sides[1][k];
        }
        memset(sides[2], 0, sizeof sides[2]);
        for (uint32_t i = 0; i < 3; i++) {
            double p[3];
            for (int k = 0; k < 3; k++) p[k] = centre[k] + size * sides[i][k];
            const double at[3] = {p[0], cos(turn) * p[1] - sin(turn) * p[2],
                                  sin(turn) * p[1] + cos(turn) * p[2]};
            for (int k = 0; k < 3; k++) shape.x0[(t * 3 + i) * 3 + (uint32_t)k] = (at[k] + far) * scale;
            shape.triangles[t * 3 + i] = t * 3 + i;
        }
    }
}

typedef struct visited {
    bool triangles[TRIANGLES];
    size_t count;
} visited;

static void visit_triangle(void *data, uint32_t triangle) {
    visited *v = data;
    v->count += !v->triangles[triangle];
    v->triangles[triangle] = true;
}

static double distance_from(const double x[3], uint32_t t) {
    const double *p = shape.x0 + (size_t)t * 9;
    double u, v;
    return sqrt(closest_point_triangle(x, p, p + 3, p + 6, &u, &v));
}

/* Returns how many were visited and farther away than the distance by more than one part in 200 and the rounding of floats. */
static size_t compare_query(const bvh *hierarchy, const double x[3], double distance, size_t *within) {
    visited v = {.count = 0};
    size_t beyond = 0;
    double squared = distance * distance * hierarchy->scale * hierarchy->scale;
    const near_quest quest = {0, 0, NULL};
    bvh_visit_near(hierarchy, &quest, x, &squared, visit_triangle, &v);
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        const double at = distance_from(x, t);
        if (at <= distance) assert_true(v.triangles[t]);
        *within += at <= distance;
        beyond += v.triangles[t] && at > distance * 1.005 + 1e-5 / hierarchy->scale;
    }
    return beyond;
}

/* A search for the nearest triangle, which looks no farther than the nearest so far. */
typedef struct narrowing_search {
    const double *x;
    double scale, least, squared;
} narrowing_search;

static void come_nearer(void *data, uint32_t triangle) {
    narrowing_search *s = data;
    s->least = fmin(s->least, distance_from(s->x, triangle));
    s->squared = s->least * s->least * s->scale * s->scale * (1.0 + 1e-9);
}

static void compare_nearest(const bvh *hierarchy, const double x[3]) {
    narrowing_search s = {x, hierarchy->scale, (double)INFINITY, (double)INFINITY};
    const near_quest quest = {0, 0, NULL};
    double least = (double)INFINITY;
    bvh_visit_near(hierarchy, &quest, x, &s.squared, come_nearer, &s);
    for (uint32_t t = 0; t < TRIANGLES; t++) least = fmin(least, distance_from(x, t));
    assert_true(s.least == least);
}

/* Somewhere near a triangle: how near, goes down to what floats round. */
static void point_near(random_stream *random, uint32_t t, double extent, double out[3]) {
    const double *p = shape.x0 + (size_t)t * 9;
    const double away = 0.3 * extent * pow(10.0, stream_between(random, -9.0, 0.0));
    const double u = stream_between(random, 0.0, 1.0), v = stream_between(random, 0.0, 1.0 - u);
    for (int k = 0; k < 3; k++)
        out[k] = p[k] + u * (p[3 + k] - p[k]) + v * (p[6 + k] - p[k]) + stream_between(random, -away, away);
}

/* One of the triangles is just within the distance. */
static void compare_cloud(const bvh *hierarchy, random_stream *random, size_t *within, size_t *beyond) {
    for (int i = 0; i < QUERIES; i++) {
        const uint32_t near = stream_below(random, TRIANGLES);
        double x[3];
        point_near(random, near, 1.0 / hierarchy->scale, x);
        const double distance = distance_from(x, i % 4 == 0 ? stream_below(random, TRIANGLES) : near);
        *beyond += compare_query(hierarchy, x, distance, within);
        compare_nearest(hierarchy, x);
    }
}

TEST(none_is_left_out) {
    for (int level = 1; level <= SIMD_LAST; level++) {
        size_t within = 0, beyond = 0;
        for (uint32_t number = 0; number < SHAPES; number++) {
            random_stream random = stream_start(number);
            bvh_rig r;
            make_cloud(number, &random);
            const uint32_t trees = number / 2 % 2 == 0 ? 1 : 20; /* each with a frame of its own */
            if (!bvh_rig_create(&shape, (bvh_setup){(cscd_simd)level, 1, BOX_AXES, trees}, &r)) continue;
            bvh_refit(&r.bvh, shape.x0, shape.x0, uniform_growth(0.0));
            compare_cloud(&r.bvh, &random, &within, &beyond);
            bvh_rig_destroy(&r);
        }
        print_message("  level %d: %zu within, %zu beyond\n", level, within, beyond);
        assert_true(within == 0 || beyond < within); /* 0: not on this processor */
    }
}
