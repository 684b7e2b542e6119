/* The star test: of disks whose triangles all keep their orientation, those that it calls one-to-one have contours that are simple at
 * every sampled moment, by a reference in long double; plain motions pass at any place and scale; and each condition is needed. */
#include "runtime/baselines/patches.h"
#include "tests/support/baselines/moving_polygon.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { DISKS = PACED(20000, 3000) };

#define PI 3.14159265358979323846

static bool stays_star(const polygon *p) {
    static const uint32_t loop[CORNERS_MAX] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13,
                                               14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27,
                                               28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39};
    static star_vertex vertices[CORNERS_MAX];
    const contour_query query = {
        .loop = loop, .edge_count = p->count, .x0 = p->x0, .x1 = p->x1, .axis = p->axis};
    return contour_stays_star(&query, vertices);
}

/* ---- disks that grow triangle by triangle ---------------------------------------------------------------- */

/* A disk in the plane, laid out by triangles that are all counter-clockwise, so it may lie over itself. */
typedef struct flat_disk {
    double x0[CORNERS_MAX][2], x1[CORNERS_MAX][2];
    uint32_t vertex_count, triangles[2 * CORNERS_MAX][3], triangle_count, loop[CORNERS_MAX], loop_count;
} flat_disk;

static uint32_t add_corner(flat_disk *d, double x, double y) {
    d->x0[d->vertex_count][0] = x;
    d->x0[d->vertex_count][1] = y;
    return d->vertex_count++;
}

static void add_face(flat_disk *d, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t t[3] = {a, b, c};
    memcpy(d->triangles[d->triangle_count++], t, sizeof t);
}

/* Adds a triangle on the outer side of an edge of the loop. */
static void grow_outwards(flat_disk *d, random_stream *random) {
    const uint32_t at = stream_below(random, d->loop_count), next = (at + 1) % d->loop_count;
    const double *a = d->x0[d->loop[at]], *b = d->x0[d->loop[next]];
    const double along = stream_between(random, -0.3, 1.3), away = stream_between(random, 0.3, 1.2);
    const double to[2] = {b[0] - a[0], b[1] - a[1]};
    const uint32_t v =
        add_corner(d, a[0] + along * to[0] + away * to[1], a[1] + along * to[1] - away * to[0]);
    add_face(d, d->loop[at], v, d->loop[next]);
    memmove(d->loop + at + 2, d->loop + at + 1, (d->loop_count - at - 1) * sizeof *d->loop);
    d->loop[at + 1] = v;
    d->loop_count++;
}

static double area_of(const double a[2], const double b[2], const double c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Fills a corner at which the loop turns inwards, if the one that is chosen does. */
static void fill_corner(flat_disk *d, random_stream *random) {
    const uint32_t at = stream_below(random, d->loop_count), n = d->loop_count;
    const uint32_t a = d->loop[(at + n - 1) % n], b = d->loop[at], c = d->loop[(at + 1) % n];
    if (n <= 3 || area_of(d->x0[a], d->x0[b], d->x0[c]) >= -0.05) return;
    add_face(d, a, c, b);
    memmove(d->loop + at, d->loop + at + 1, (n - at - 1) * sizeof *d->loop);
    d->loop_count--;
}

/* Begins with a triangle, or with a fan that goes around its vertex twice. */
static flat_disk grow_disk(random_stream *random, bool twice, uint32_t steps) {
    flat_disk d = {.vertex_count = 0};
    const uint32_t blades = 5 + stream_below(random, 6);
    if (twice) add_corner(&d, 0.0, 0.0);
    for (uint32_t i = 0; i < (twice ? blades : 3); i++) {
        const double angle = (twice ? 4.0 * PI / blades : 2.0 * PI / 3.0) * i,
                     reach = stream_between(random, 0.7, 1.3);
        const uint32_t v = add_corner(&d, reach * cos(angle), reach * sin(angle));
        d.loop[d.loop_count++] = v;
        if (twice) add_face(&d, 0, v, v == blades ? 1 : v + 1);
    }
    if (!twice) add_face(&d, 0, 1, 2);
    for (uint32_t i = 0; i < steps; i++) {
        if (stream_below(random, 3) > 0)
            grow_outwards(&d, random);
        else
            fill_corner(&d, random);
    }
    return d;
}

/* Does a triangle keep its orientation? */
static bool keeps_orientation(const flat_disk *d, const uint32_t t[3]) {
    long double p[2][2], q[2][2];
    for (int k = 0; k < 2; k++) {
        p[0][k] = (long double)d->x0[t[1]][k] - d->x0[t[0]][k];
        q[0][k] = (long double)d->x0[t[2]][k] - d->x0[t[0]][k];
        p[1][k] = (long double)d->x1[t[1]][k] - d->x1[t[0]][k];
        q[1][k] = (long double)d->x1[t[2]][k] - d->x1[t[0]][k];
    }
    long double b[3] = {p[0][0] * q[0][1] - p[0][1] * q[0][0], 0.0L, p[1][0] * q[1][1] - p[1][1] * q[1][0]};
    b[1] = 0.5L * (p[0][0] * q[1][1] - p[0][1] * q[1][0] + p[1][0] * q[0][1] - p[1][1] * q[0][0]);
    return b[0] > 0.0L && b[2] > 0.0L && (b[1] >= 0.0L || b[1] * b[1] < b[0] * b[2]);
}

/* Turns it, and moves each vertex. Returns whether all triangles keep their orientation. */
static bool move_disk(flat_disk *d, random_stream *random, double turn, double change) {
    for (uint32_t i = 0; i < d->vertex_count; i++) {
        const double *x = d->x0[i];
        d->x1[i][0] = cos(turn) * x[0] - sin(turn) * x[1] + change * stream_between(random, -1.0, 1.0);
        d->x1[i][1] = sin(turn) * x[0] + cos(turn) * x[1] + change * stream_between(random, -1.0, 1.0);
    }
    for (uint32_t i = 0; i < d->triangle_count; i++) {
        if (!keeps_orientation(d, d->triangles[i])) return false;
    }
    return true;
}

/* The loop in a plane across a random axis, with random heights. */
static polygon outline_of(const flat_disk *d, random_stream *random) {
    polygon p = {.count = d->loop_count};
    polygon_choose_axis(&p, random);
    for (uint32_t i = 0; i < p.count; i++) {
        const uint32_t v = d->loop[i];
        polygon_place(&p, p.x0, i, d->x0[v][0], d->x0[v][1], stream_between(random, -2.0, 2.0));
        polygon_place(&p, p.x1, i, d->x1[v][0], d->x1[v][1], stream_between(random, -2.0, 2.0));
    }
    return p;
}

typedef enum growth {
    GROWTH_SMALL,
    GROWTH_STILL,
    GROWTH_MOVED,
    GROWTH_TURNED,
    GROWTH_TWICE,
    GROWTH_COUNT
} growth;

static bool grow_and_move(random_stream *random, growth kind, polygon *out) {
    const uint32_t least = kind == GROWTH_SMALL ? 1 : kind == GROWTH_TWICE ? 0 : 4;
    const uint32_t steps = least + stream_below(random, kind == GROWTH_SMALL ? 5 : 22);
    flat_disk d = grow_disk(random, kind == GROWTH_TWICE, steps);
    const double turn = kind == GROWTH_TURNED ? stream_between(random, -PI, PI) : 0.0;
    const double change =
        kind == GROWTH_STILL ? 0.0 : stream_between(random, 0.0, kind == GROWTH_SMALL ? 1.0 : 0.3);
    if (!move_disk(&d, random, turn, change)) return false;
    *out = outline_of(&d, random);
    return true;
}

TEST(disks_are_one_to_one_throughout) {
    static const char *const names[GROWTH_COUNT] = {"small", "still", "moved", "turned", "twice"};
    for (int kind = 0; kind < GROWTH_COUNT; kind++) {
        uint32_t made = 0, simple = 0, said = 0;
        random_stream random = stream_start((uint64_t)kind + 50);
        for (int i = 0; i < DISKS / GROWTH_COUNT; i++) {
            polygon p;
            if (!grow_and_move(&random, (growth)kind, &p)) continue;
            const bool says = stays_star(&p), is = polygon_stays_simple(&p);
            if (says && !is) fail_msg("%s %d: said to be one-to-one, and is not", names[kind], i);
            made++;
            simple += is;
            said += says;
        }
        print_message("  %-6s of %4u disks %4u are one-to-one at the sampled moments, %4u are said to\n",
                      names[kind], made, simple, said);
        if (kind == GROWTH_TWICE) {
            assert_true(made > 0 && simple == 0);
            continue;
        }
        assert_true(said > 0 && simple < made && 100 * said >= 80 * simple);
    }
}

/* ---- motions that must pass ------------------------------------------------------------------------------ */

/* Polygons with long rays, which turn, move far, and are scaled and moved together. */
TEST(stars_pass) {
    static const double scales[] = {1.0, 0x1p-240, 0x1p240, 1e-6, 1e6};
    random_stream random = stream_start(77);
    for (int i = 0; i < 1000; i++) {
        polygon p = {.count = 5 + stream_below(&random, CORNERS_MAX - 5)};
        polygon_choose_axis(&p, &random);
        const double turn = stream_between(&random, -3.0, 3.0), scale = scales[i % 5];
        const double far = i % 3 == 0 ? 1e5 : 0.0;
        double move[3], start[3];
        for (int k = 0; k < 3; k++) move[k] = stream_between(&random, -100.0, 100.0);
        for (int k = 0; k < 3; k++) start[k] = far * stream_between(&random, -1.0, 1.0);
        for (uint32_t j = 0; j < p.count; j++) {
            const double angle = 2.0 * PI * j / p.count, r = i % 2 == 0 && j % 2 == 0 ? 1.5 : 1.0;
            const double z = stream_between(&random, -2.0, 2.0);
            polygon_place(&p, p.x0, j, r * cos(angle), r * sin(angle), z);
            polygon_place(&p, p.x1, j, r * cos(angle + turn), r * sin(angle + turn), z);
            for (uint32_t k = 0; k < 3; k++) {
                p.x0[j * 3 + k] = scale * (p.x0[j * 3 + k] + start[k]);
                p.x1[j * 3 + k] = scale * (p.x1[j * 3 + k] + start[k] + move[k]);
            }
        }
        if (!stays_star(&p)) fail_msg("%d: %u corners, scale %g, turned by %g", i, p.count, scale, turn);
    }
}

/* Ears fill what is seen from behind. */
TEST(ears_fill_notches) {
    static const double letter_u[8][2] = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const double letter_l[6][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 9}, {0, 9}};
    polygon p = polygon_at_rest(letter_u, 8);
    assert_true(stays_star(&p));
    p = polygon_at_rest(letter_l, 6);
    assert_true(stays_star(&p));
}

/* ---- the conditions one by one --------------------------------------------------------------------------- */

/* Eight corners around the middle, of any reach. */
static polygon octagon_of(const double reach[8], double turns) {
    double corners[8][2];
    for (int i = 0; i < 8; i++) {
        const double angle = 2.0 * PI * turns * i / 8.0 + 0.1;
        corners[i][0] = reach[i] * cos(angle);
        corners[i][1] = reach[i] * sin(angle);
    }
    return polygon_at_rest((const double(*)[2])corners, 8);
}

TEST(once_around_and_forward) {
    static const double even[8] = {1, 1, 1, 1, 1, 1, 1, 1}, uneven[8] = {1, 1.2, 1, 1.3, 1, 1.2, 1, 1.3};
    polygon p = octagon_of(uneven, 1.0);
    assert_true(stays_star(&p));
    p = octagon_of(uneven, -1.0); /* the other way around */
    assert_false(stays_star(&p));
    p = octagon_of(uneven, 3.0); /* a star of eight points: every edge goes forward, three times around */
    assert_false(stays_star(&p));
    p = octagon_of(even, 1.0);
    for (uint32_t i = 0; i < 24; i++) p.x1[i] = -p.x0[i]; /* all vertices pass one point half way */
    assert_false(stays_star(&p));
}

/* At both ends every edge goes forward. In between a map that turns and stretches is upside down; one that only
 * turns by less is not. */
TEST(edges_between_the_ends) {
    static const double even[8] = {1, 1, 1, 1, 1, 1, 1, 1};
    for (int stretched = 0; stretched < 2; stretched++) {
        polygon p = octagon_of(even, 1.0);
        const double s = stretched == 1 ? 1.5 : 1.0, c = cos(2.9), d = sin(2.9);
        for (uint32_t i = 0; i < 8; i++) {
            double *x0 = p.x0 + 3 * i, *x1 = p.x1 + 3 * i, x = x0[0], y = x0[1];
            x0[0] = s * x;
            x0[1] = y / s;
            x1[0] = c * x / s - d * s * y;
            x1[1] = d * x / s + c * s * y;
        }
        assert_true(stays_star(&p) == (stretched == 0));
    }
}

/* A ramp of less than a turn is filled by ears; one of more lies over itself, and every triangle of it faces up. */
TEST(ramps_that_lie_over_themselves) {
    static const double turns[] = {0.4, 0.6, 1.2, 1.7, 2.5};
    for (int i = 0; i < 5; i++) {
        double corners[CORNERS_MAX][2];
        for (int j = 0; j < 20; j++) {
            const double angle = 2.0 * PI * turns[i] * j / 19.0;
            corners[j][0] = 1.5 * cos(angle);
            corners[j][1] = 1.5 * sin(angle);
            corners[39 - j][0] = cos(angle);
            corners[39 - j][1] = sin(angle);
        }
        polygon p = polygon_at_rest((const double(*)[2])corners, 40);
        assert_true(polygon_stays_simple(&p) == (i < 2));
        assert_true(stays_star(&p) == (i < 2));
    }
}

/* A vertex lies exactly on the first of the lines at which turns are counted, seen from the middle. */
TEST(vertices_on_the_line_of_counting) {
    static const double corners[8][2] = {{0.7, 0.7},   {0.1, 1.1},   {-0.5736, 0.8191}, {-1.1, 0.1},
                                         {-0.7, -0.7}, {-0.1, -1.1}, {0.5736, -0.8191}, {1.1, -0.1}};
    polygon p = polygon_at_rest(corners, 8);
    assert_true(stays_star(&p));
}

/* Three or four vertices leave no other way to bound a disk. */
TEST(short_loops_pass) {
    static const double arrow[4][2] = {{0, 0}, {2, -1}, {0.1, 0.05}, {-1, 2}};
    polygon p = polygon_at_rest(arrow, 4);
    assert_true(stays_star(&p));
    p.count = 3;
    assert_true(stays_star(&p));
}

/* A slit goes inwards and comes back on itself, and the disk is on both sides of it: rounding of the projection makes no ear of that. */
TEST(rounding_fills_no_slit) {
    static const double corners[8][2] = {{4, 0}, {1, 0},    {2.5, 0},   {3.5, 2},
                                         {0, 3}, {-3, 0.5}, {-2.5, -2}, {3.5, -2}};
    random_stream random = stream_start(79);
    for (int i = 0; i < 2000; i++) {
        polygon p = {.count = 8};
        polygon_choose_axis(&p, &random);
        for (uint32_t j = 0; j < p.count; j++) {
            const double z = stream_between(&random, -2.0, 2.0);
            polygon_place(&p, p.x0, j, corners[j][0], corners[j][1], z);
            polygon_place(&p, p.x1, j, corners[j][0], corners[j][1], z);
        }
        double *const ends[2] = {p.x0, p.x1};
        for (int end = 0; end < 2; end++) {
            double *x = ends[end];
            for (uint32_t k = 0; k < 6; k++) x[k] = floor(x[k] * 0x1p20) * 0x1p-20;
            for (uint32_t k = 0; k < 3; k++) x[6 + k] = 0.5 * (x[k] + x[3 + k]);
        }
        if (stays_star(&p)) fail_msg("%d: said to be one-to-one, and touches itself throughout", i);
    }
}
