/* What curves cut off of crumpled sheets, by sides that are spread over the vertices, and points that are counted. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static body_rig rig; /* large; one test at a time */
static cscd_intersections found;

static void find_cut_offs(void) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.cut_offs = options.overlaps = true;
    body_rig_create(&rig, NULL, 1);
    expect_ok(cscd_detector_find_intersections(rig.detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count),
                                               &options, &found));
    assert_non_null(found.cut_offs);
}

static const double X4[3] = {4, 0, 0}, Y4[3] = {0, 4, 0}, ORIGIN[3] = {0, 0, 0};

/* The sides of vertices by the parity of one trace's points on edges; 2: not reached. */
static uint8_t sides[SCENE_VERTICES_MAX];

static uint32_t triangle_on(const cscd_curve_piece *piece, uint32_t side) {
    return side == 0 ? piece->a : piece->b;
}

enum { BOTH_TRACES = 2 };

/* So many points of the trace are on the edge. Of a point of the other sheet's edge the triangle is the trace's own. */
static uint32_t passes_over(const cscd_curve *c, uint32_t side, uint32_t edge) {
    uint32_t count = 0;
    for (size_t i = 0; i < c->point_count; i++) {
        const cscd_curve_point *point = &found.curves->points[c->first_point + i];
        size_t piece = i < c->piece_count ? i : i - 1;
        uint32_t own = triangle_on(&found.curves->pieces[c->first_piece + piece], side);
        count += point->edge == edge && (side == BOTH_TRACES || point->triangle != own);
    }
    return count;
}

/* A vertex at which the curve ends lies on the trace, and has no side. */
static bool is_end(const cscd_curve *c, uint32_t vertex) {
    const cscd_curve_point *points = &found.curves->points[c->first_point];
    for (size_t i = 0; i < c->point_count; i += c->point_count - 1) {
        if (points[i].edge == UINT32_MAX && points[i].triangle == vertex) return true;
    }
    return false;
}

/* Spreads sides until nothing changes. False: they contradict each other. */
static bool spread_sides(const cscd_curve *c, uint32_t side) {
    memset(sides, 2, sizeof sides);
    uint32_t first = 0;
    while (is_end(c, first)) first++;
    sides[first] = 0;
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t edge = 0; edge < cscd_mesh_edge_count(rig.mesh); edge++) {
            uint32_t v[2];
            uint8_t odd = passes_over(c, side, edge) % 2;
            cscd_mesh_edge(rig.mesh, edge, v);
            for (int k = 0; k < 2 && !is_end(c, v[0]) && !is_end(c, v[1]); k++) {
                if (sides[v[k]] == 2) continue;
                uint8_t expected = sides[v[k]] ^ odd;
                if (sides[v[1 - k]] != 2 && sides[v[1 - k]] != expected) return false;
                changed |= sides[v[1 - k]] == 2;
                sides[v[1 - k]] = expected;
            }
        }
    }
    return true;
}

/* Has the triangle pieces of the trace, or a corner without a side? */
static bool is_cut(const cscd_curve *c, uint32_t side, uint32_t t) {
    for (size_t i = 0; i < c->piece_count; i++) {
        const cscd_curve_piece *piece = &found.curves->pieces[c->first_piece + i];
        if (triangle_on(piece, side) == t || (side == BOTH_TRACES && piece->a == t)) return true;
    }
    for (int i = 0; i < 3; i++)
        if (sides[rig.all.triangles[t * 3 + (uint32_t)i]] == 2) return true;
    return false;
}

/* Does an open trace begin and end at the border of its own sheet? */
static bool ends_at_own_border(const cscd_curve *c, uint32_t side) {
    for (int end = 0; end < 2 && !c->closed; end++) {
        const cscd_curve_point *point =
            &found.curves->points[c->first_point + (end == 0 ? 0 : c->point_count - 1)];
        const cscd_curve_piece *piece =
            &found.curves->pieces[c->first_piece + (end == 0 ? 0 : c->piece_count - 1)];
        if ((end == 0 ? c->start : c->end) != CSCD_CURVE_END_BORDER) return false;
        if (point->triangle == triangle_on(piece, side)) return false;
    }
    return true;
}

static double area_of_triangle(uint32_t t) {
    uint32_t v[3];
    double p[2][3], n[3];
    cscd_mesh_triangle(rig.mesh, t, v);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
            p[i][k] = rig.all.x0[v[i + 1] * 3 + (uint32_t)k] - rig.all.x0[v[0] * 3 + (uint32_t)k];
    for (int k = 0; k < 3; k++)
        n[k] = p[0][(k + 1) % 3] * p[1][(k + 2) % 3] - p[0][(k + 2) % 3] * p[1][(k + 1) % 3];
    return 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

/* Twice the area of a triangle in the projection along an axis, with its sign. */
static double turn_along(const double *p, const double *q, const double *r, int axis) {
    int x = (axis + 1) % 3, y = (axis + 2) % 3;
    return (q[x] - p[x]) * (r[y] - p[y]) - (q[y] - p[y]) * (r[x] - p[x]);
}

/* So many pieces of the trace lie in the triangle between two points of it. */
static uint32_t crossings_between(const cscd_curve *c, uint32_t side, uint32_t t, int axis, const double *p,
                                  const double *q) {
    const cscd_curve_point *points = &found.curves->points[c->first_point];
    uint32_t count = 0;
    for (size_t i = 0; i < c->piece_count; i++) {
        const cscd_curve_piece *piece = &found.curves->pieces[c->first_piece + i];
        const double *from = points[i].x, *to = points[(i + 1) % c->point_count].x;
        uint32_t times = triangle_on(piece, side) == t;
        if (side == BOTH_TRACES && piece->a == t) times++;
        if ((turn_along(p, q, from, axis) > 0) != (turn_along(p, q, to, axis) > 0) &&
            (turn_along(from, to, p, axis) > 0) != (turn_along(from, to, q, axis) > 0))
            count += times;
    }
    return count;
}

enum { SAMPLES = 24 };

/* Adds the parts of a triangle to both sides, by points in it whose ways to a corner cross the trace so often. */
static void sample_triangle(const cscd_curve *c, uint32_t side, uint32_t t, double areas[2]) {
    const uint32_t *v = &rig.all.triangles[(size_t)t * 3];
    const double *x[3] = {&rig.all.x0[v[0] * 3], &rig.all.x0[v[1] * 3], &rig.all.x0[v[2] * 3]};
    int known = 0, axis = 0;
    while (sides[v[known]] == 2) known++;
    for (int k = 1; k < 3; k++)
        if (fabs(turn_along(x[0], x[1], x[2], k)) > fabs(turn_along(x[0], x[1], x[2], axis))) axis = k;
    for (int i = 0; i < SAMPLES; i++) {
        for (int j = 0; j < SAMPLES; j++) {
            double a = (i + 0.5) / SAMPLES, b = (j + 0.5) / SAMPLES, point[3];
            if (a + b > 1) {
                a = 1 - a;
                b = 1 - b;
            }
            for (int k = 0; k < 3; k++)
                point[k] = x[0][k] + a * (x[1][k] - x[0][k]) + b * (x[2][k] - x[0][k]);
            uint32_t crossings = crossings_between(c, side, t, axis, point, x[known]);
            areas[(sides[v[known]] + crossings) % 2] += area_of_triangle(t) / (SAMPLES * SAMPLES);
        }
    }
}

static void expect_areas(const cscd_cut_off *item, const cscd_curve *c, uint32_t side) {
    double areas[2] = {0, 0}, cut = 0;
    for (uint32_t t = 0; t < rig.all.triangle_count; t++) {
        if (is_cut(c, side, t)) {
            sample_triangle(c, side, t, areas);
            cut += area_of_triangle(t);
        } else {
            areas[sides[rig.all.triangles[(size_t)t * 3]]] += area_of_triangle(t);
        }
    }
    assert_true(fabs(item->area + item->rest - areas[0] - areas[1]) <= 1e-9);
    assert_true(item->area <= item->rest + 1e-9);
    assert_true(fabs(item->area - fmin(areas[0], areas[1])) <= 0.02 * cut);
}

static bool is_listed(const cscd_cut_off *item, uint32_t patch) {
    const uint32_t *patches = &found.cut_offs->patches[item->first_patch];
    size_t count = 0;
    for (size_t i = 0; i < item->patch_count; i++) {
        assert_true(i == 0 || patches[i] > patches[i - 1]);
        count += patches[i] == patch;
    }
    return count > 0;
}

/* The patches at the corners on one side are listed, and none of the other one. Returns how many corners are. */
static size_t expect_patches(const cscd_cut_off *item) {
    size_t listed[2] = {0, 0}, others[2] = {0, 0};
    for (uint32_t i = 0; i < 3 * rig.all.triangle_count; i++) {
        uint8_t side = sides[rig.all.triangles[i]];
        if (side == 2) continue;
        if (is_listed(item, found.patches->corner_patches[i]))
            listed[side]++;
        else
            others[side]++;
    }
    assert_true(listed[0] == 0 || listed[1] == 0);
    assert_true(others[0] == 0 || others[1] == 0);
    assert_true(listed[0] == 0 || others[0] == 0);
    assert_true(listed[1] == 0 || others[1] == 0);
    return listed[0] + listed[1];
}

/* Crumpled sheets, with a hole or not, whose traces are looked at one by one. */
TEST(sheets_in_themselves) {
    size_t divide = 0, do_not = 0, joined = 0, named = 0;
    random_stream random = stream_start(7);
    for (int i = 0; i < 60; i++) {
        body_rig_begin(&rig);
        body_rig_add_sheet(&rig, ORIGIN, X4, Y4, 7, 7, i % 2 == 1);
        for (uint32_t k = 0; k < rig.all.vertex_count * 3; k++)
            rig.all.x0[k] += stream_between(&random, -1.0, 1.0) * (i % 3 == 0 ? 0.4 : 0.8);
        body_rig_end_body(&rig);
        find_cut_offs();
        size_t next = 0;
        for (size_t curve = 0; curve < found.curves->count; curve++) {
            const cscd_curve *c = &found.curves->items[curve];
            bool both = c->start == CSCD_CURVE_END_VERTEX && c->end == CSCD_CURVE_END_VERTEX;
            for (uint32_t side = both ? BOTH_TRACES : 0; side < (both ? 3 : 2); side++) {
                const cscd_cut_off *item = next < found.cut_offs->count ? &found.cut_offs->items[next] : NULL;
                bool listed = item != NULL && item->curve == curve && (uint32_t)item->trace == side;
                bool divides = (both || ends_at_own_border(c, side)) && spread_sides(c, side);
                assert_int_equal(listed, divides);
                if (listed) expect_areas(item, c, side);
                if (listed) named += expect_patches(item);
                next += listed;
                joined += both && divides;
                divide += divides;
                do_not += !divides;
            }
        }
        assert_int_equal(next, found.cut_offs->count);
    }
    print_message(
        "%zu traces divide their sheet, %zu do not; %zu of them with the other trace; %zu corners\n", divide,
        do_not, joined, named);
    assert_true(divide > 80 && do_not > 100 && joined > 5 && named > 400);
}

AROUND_EACH(NULL, body_rigs_free)
