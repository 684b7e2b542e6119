/* The contour test: a contour that it calls simple is simple at every sampled moment, by a reference in
 * long double, and plain motions of plain polygons pass at any place and scale. */
#include "runtime/baselines/patches.h"
#include "tests/support/baselines/moving_polygon.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { POLYGONS = PACED(12000, 2000) };

#define PI 3.14159265358979323846

static bool stays_simple(const polygon *p, uint32_t skipped, bool published) {
    uint32_t edges[CORNERS_MAX][2], numbers[CORNERS_MAX];
    static contour_edge projected[CORNERS_MAX];
    static contour_key keys[CORNERS_MAX];
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t next = (i + 1) % p->count;
        edges[i][0] = i < next ? i : next;
        edges[i][1] = i < next ? next : i;
        numbers[i] = i;
    }
    const cscd_mesh mesh = {.vertex_count = p->count, .edge_count = p->count, .edges = edges};
    const contour_query query = {.mesh = &mesh,
                                 .edges = numbers,
                                 .edge_count = p->count,
                                 .x0 = p->x0,
                                 .x1 = p->x1,
                                 .axis = p->axis,
                                 .skipped = skipped,
                                 .published = published};
    return contour_stays_simple(&query, projected, keys);
}

/* ---- random motions -------------------------------------------------------------------------------- */

typedef enum motion { MOTION_SMALL, MOTION_TURN, MOTION_MORPH, MOTION_ANY, MOTION_GRID, MOTION_COUNT } motion;

static double random_radius(random_stream *random) {
    return 1.0 + stream_between(random, -0.6, 0.6);
}

static double random_height(random_stream *random) {
    return stream_between(random, -2.0, 2.0);
}

static polygon random_polygon(random_stream *random, motion kind) {
    polygon p = {.count = 4 + stream_below(random, 13)};
    polygon_choose_axis(&p, random);
    double turn = kind == MOTION_TURN ? stream_between(random, -PI, PI) : 0.0;
    double change = stream_between(random, 0.0, 0.5);
    for (uint32_t i = 0; i < p.count; i++) {
        double angle = 2.0 * PI * i / p.count, r = random_radius(random);
        double x = r * cos(angle), y = r * sin(angle), x1 = cos(turn) * x - sin(turn) * y,
               y1 = sin(turn) * x + cos(turn) * y;
        if (kind == MOTION_SMALL) {
            x1 += change * stream_between(random, -1.0, 1.0);
            y1 += change * stream_between(random, -1.0, 1.0);
        } else if (kind == MOTION_MORPH) {
            r = random_radius(random);
            angle += 2.0 * change * stream_between(random, -1.0, 1.0);
            x1 = r * cos(angle);
            y1 = r * sin(angle);
        } else if (kind == MOTION_ANY) {
            x = stream_between(random, -1.0, 1.0);
            y = stream_between(random, -1.0, 1.0);
            x1 = x + change * stream_between(random, -1.0, 1.0);
            y1 = y + change * stream_between(random, -1.0, 1.0);
        }
        polygon_place(&p, p.x0, i, x, y, random_height(random));
        polygon_place(&p, p.x1, i, x1, y1, random_height(random));
    }
    return p;
}

/* Small integers, projected along z: vertices on edges, folds and equal vertices are common, and exact. */
static polygon grid_polygon(random_stream *random) {
    polygon p = {.count = 4 + stream_below(random, 4),
                 .frame = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
                 .axis = {0.0f, 0.0f, 1.0f}};
    for (uint32_t i = 0; i < p.count; i++) {
        uint32_t x = stream_below(random, 5), y = stream_below(random, 5);
        bool moves = stream_below(random, 3) == 0;
        polygon_place(&p, p.x0, i, x, y, 0.0);
        polygon_place(&p, p.x1, i, moves ? stream_below(random, 5) : x, moves ? stream_below(random, 5) : y,
                      0.0);
    }
    return p;
}

TEST(simple_is_simple_throughout) {
    static const char *const names[MOTION_COUNT] = {"small", "turn", "morph", "any", "grid"};
    for (int kind = 0; kind < MOTION_COUNT; kind++) {
        uint32_t simple = 0, said = 0;
        random_stream random = stream_start((uint64_t)kind);
        for (int i = 0; i < POLYGONS / MOTION_COUNT; i++) {
            polygon p = kind == MOTION_GRID ? grid_polygon(&random) : random_polygon(&random, (motion)kind);
            bool says = stays_simple(&p, 0, false), is = polygon_stays_simple(&p);
            if (says && !is) fail_msg("%s %d: said to stay simple, and is not", names[kind], i);
            simple += is;
            said += says;
        }
        print_message("  %-6s %4u of %d stay simple at the sampled moments, %4u are said to\n", names[kind],
                      simple, POLYGONS / MOTION_COUNT, said);
        assert_true(said > 0 && (kind == MOTION_TURN || simple < POLYGONS / MOTION_COUNT));
        if (kind != MOTION_GRID) assert_true(100 * said >= 90 * simple);
    }
}

/* ---- motions that must pass ------------------------------------------------------------------------ */

/* The polygons are convex or have long rays, turn by a little, move far, and are scaled and moved
 * together. */
TEST(plain_motions_pass) {
    static const double scales[] = {1.0, 0x1p-240, 0x1p240, 1e-6, 1e6};
    random_stream random = stream_start(77);
    for (int i = 0; i < 1000; i++) {
        polygon p = {.count = 4 + stream_below(&random, CORNERS_MAX - 4)};
        polygon_choose_axis(&p, &random);
        bool star = i % 2 == 0;
        double turn = stream_between(&random, -0.5, 0.5), scale = scales[i % 5];
        double far = i % 3 == 0 ? 1e6 : 0.0, move[3], start[3];
        for (int k = 0; k < 3; k++) move[k] = stream_between(&random, -100.0, 100.0);
        for (int k = 0; k < 3; k++) start[k] = far * stream_between(&random, -1.0, 1.0);
        for (uint32_t j = 0; j < p.count; j++) {
            double angle = 2.0 * PI * j / p.count, r = star && j % 2 == 0 ? 2.0 : 1.0,
                   z = random_height(&random);
            polygon_place(&p, p.x0, j, r * cos(angle), r * sin(angle), z);
            polygon_place(&p, p.x1, j, r * cos(angle + turn), r * sin(angle + turn), z);
            for (uint32_t k = 0; k < 3; k++) {
                p.x0[j * 3 + k] = scale * (p.x0[j * 3 + k] + start[k]);
                p.x1[j * 3 + k] = scale * (p.x1[j * 3 + k] + start[k] + move[k]);
            }
        }
        if (!stays_simple(&p, 0, false))
            fail_msg("%d: %u corners, scale %g, turned by %g", i, p.count, scale, turn);
    }
}

/* A corner lies on another edge exactly, in the middle between its ends, and stays there: rounding of the projection does not part
 * them. */
TEST(rounding_parts_no_corner_from_its_edge) {
    static const double corners[5][2] = {{0, 4}, {0, 0}, {4, 0}, {4, 4}, {2, 0}};
    random_stream random = stream_start(78);
    for (int i = 0; i < 1000; i++) {
        polygon p = {.count = 5};
        polygon_choose_axis(&p, &random);
        for (uint32_t j = 0; j < p.count; j++) {
            polygon_place(&p, p.x0, j, corners[j][0], corners[j][1], random_height(&random));
            polygon_place(&p, p.x1, j, corners[j][0] + 1.0, corners[j][1], random_height(&random));
        }
        double *const ends[2] = {p.x0, p.x1};
        for (int end = 0; end < 2; end++) {
            double *x = ends[end];
            for (uint32_t k = 3; k < 9; k++) x[k] = floor(x[k] * 0x1p20) * 0x1p-20;
            for (uint32_t k = 0; k < 3; k++) x[12 + k] = 0.5 * (x[3 + k] + x[6 + k]);
        }
        if (stays_simple(&p, 0, i % 2 == 0))
            fail_msg("%d: said to stay simple, and touches itself throughout", i);
    }
}

/* ---- the conditions one by one --------------------------------------------------------------------- */

TEST(degenerate_contours_fail) {
    static const double crossed[4][2] = {{0, 0}, {2, 2}, {2, 0}, {0, 2}};
    static const double square[4][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    static const double folded[4][2] = {{0, 0}, {2, 0}, {1, 0}, {0, 2}};
    static const double equal[4][2] = {{0, 0}, {2, 0}, {2, 0}, {0, 2}};
    static const double touching[5][2] = {{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}};
    static const double one_point[4][2] = {{1, 1}, {1, 1}, {1, 1}, {1, 1}};
    polygon p = polygon_at_rest(square, 4);
    assert_true(stays_simple(&p, 0, false));
    p = polygon_at_rest(crossed, 4); /* not simple at the start, which as published is not tested */
    assert_false(stays_simple(&p, 0, false));
    assert_true(stays_simple(&p, 0, true));
    p = polygon_at_rest(folded, 4);
    assert_false(stays_simple(&p, 0, false));
    p = polygon_at_rest(equal, 4);
    assert_false(stays_simple(&p, 0, false));
    p = polygon_at_rest(touching, 5);
    assert_false(stays_simple(&p, 0, false));
    assert_false(stays_simple(&p, 0, true));
    assert_true(stays_simple(&p, 5, true)); /* as published, when all of it is inherited */
    p = polygon_at_rest(one_point, 4);
    assert_false(stays_simple(&p, 0, false));
    p = polygon_at_rest(square, 4); /* touches itself at the very end, or just before */
    polygon_place(&p, p.x1, 2, 1.0, 0.0, 0.0);
    assert_false(stays_simple(&p, 0, false));
    polygon_place(&p, p.x1, 2, 0.0, 0.0, 0.0);
    assert_false(stays_simple(&p, 0, false));
    polygon_place(&p, p.x1, 2, 1.0, 1e-9, 0.0);
    assert_true(stays_simple(&p, 0, false));
    p = polygon_at_rest(square, 4); /* all vertices pass one point in between */
    for (uint32_t i = 0; i < 4; i++) polygon_place(&p, p.x1, i, -square[i][0], -square[i][1], 0.0);
    assert_false(stays_simple(&p, 0, false));
}
