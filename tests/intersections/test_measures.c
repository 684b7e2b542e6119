/* Volumes of overlaps and lengths of curves with their gradients: values and differences of them in long double, what
 * motions of the whole scene leave as it is, and what is unknown. */
#include "cscd/live.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum { SCENES = NIGHTLY(3, 12), CORNERS_MAX = 64, VERTICES_CHECKED = NIGHTLY(40, 200) };

static body_rig rig; /* large; one test at a time */
static long double points[SCENE_VERTICES_MAX][3];
static double dense[SCENE_VERTICES_MAX * 3];

typedef cscd_status ask_function(cscd_detector *detector, const cscd_view *positions,
                                 const cscd_intersection_options *options, cscd_measures *out);

static ask_function *const both[2] = {cscd_detector_overlap_volumes, cscd_detector_curve_lengths};

static cscd_measures ask_for(ask_function *function) {
    cscd_measures found;
    cscd_intersection_options options = cscd_intersection_defaults();
    options.orientation = rig.orientation;
    options.part_bodies = rig.part_bodies;
    expect_ok(function(rig.detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count), &options, &found));
    return found;
}

/* The gradient of one pair of bodies. */
static void spread_gradient(const cscd_measures *found, const cscd_measure *of) {
    memset(dense, 0, sizeof dense);
    for (size_t i = 0; i < of->gradient_count; i++) {
        const cscd_vertex_gradient *g = &found->gradients[of->first_gradient + i];
        assert_true(g->vertex < rig.all.vertex_count && g->reserved == 0);
        assert_true(i == 0 || g[-1].vertex < g->vertex);
        for (int k = 0; k < 3; k++) dense[g->vertex * 3 + (uint32_t)k] = g->gradient[k];
    }
}

static double value_of(const cscd_measures *found, uint32_t a, uint32_t b) {
    for (size_t i = 0; i < found->count; i++)
        if (found->items[i].a == a && found->items[i].b == b) return found->items[i].value;
    return 0.0;
}

/* ---- shapes -------------------------------------------------------------------------------------------- */

/* A ball whose triangles are all in different planes: an icosahedron, divided, with every corner on the sphere. */
static void add_round(double x, double y, double z, double radius, int divisions, uint64_t seed) {
    static const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    const double t = 0.5 * (1.0 + sqrt(5.0)), centre[3] = {x, y, z};
    const double corners[12][3] = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
    random_stream random = stream_start(seed);
    scene *s = &rig.all;
    const uint32_t first = s->vertex_count, n = (uint32_t)divisions;
    for (int f = 0; f < 20; f++) {
        uint32_t grid[CORNERS_MAX];
        for (uint32_t i = 0, at = 0; i <= n; i++) {
            for (uint32_t j = 0; j + i <= n; j++, at++) {
                double p[3], norm = 0.0;
                for (int k = 0; k < 3; k++) {
                    p[k] = ((n - i - j) * corners[faces[f][0]][k] + i * corners[faces[f][1]][k] +
                            j * corners[faces[f][2]][k]) /
                           n;
                    norm += p[k] * p[k];
                }
                for (int k = 0; k < 3; k++) p[k] *= radius / sqrt(norm);
                uint32_t same = first;
                for (; same < s->vertex_count; same++) {
                    double apart = 0.0;
                    for (int k = 0; k < 3; k++) apart += fabs(s->x0[same * 3 + (uint32_t)k] - p[k]);
                    if (apart < 1e-6 * radius) break;
                }
                if (same == s->vertex_count) {
                    memcpy(&s->x0[(size_t)same * 3], p, sizeof p);
                    s->vertex_count++;
                }
                grid[at] = same;
            }
        }
        for (uint32_t i = 0, row = 0; i < n; row += n + 1 - i, i++) {
            const uint32_t next = row + n + 1 - i;
            for (uint32_t j = 0; j + i < n; j++) {
                const uint32_t up[3] = {grid[row + j], grid[next + j], grid[row + j + 1]};
                memcpy(&s->triangles[(size_t)s->triangle_count++ * 3], up, sizeof up);
                if (j + i + 1 >= n) continue;
                const uint32_t down[3] = {grid[next + j], grid[next + j + 1], grid[row + j + 1]};
                memcpy(&s->triangles[(size_t)s->triangle_count++ * 3], down, sizeof down);
            }
        }
    }
    double turn[3][3]; /* of any shape, as long as it stays convex */
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) turn[i][k] = (i == k ? 1.0 : 0.0) + stream_between(&random, -0.2, 0.2);
    for (uint32_t v = first; v < s->vertex_count; v++) {
        double p[3];
        memcpy(p, &s->x0[(size_t)v * 3], sizeof p);
        for (int k = 0; k < 3; k++)
            s->x0[v * 3 + (uint32_t)k] =
                centre[k] + turn[k][0] * p[0] + turn[k][1] * p[1] + turn[k][2] * p[2];
    }
}

/* Moves every vertex by a little. */
static void shake_vertices(uint64_t seed, double by) {
    random_stream random = stream_start(seed);
    for (uint32_t i = 0; i < rig.all.vertex_count * 3; i++) rig.all.x0[i] += stream_between(&random, -by, by);
}

/* ---- truths in long double ----------------------------------------------------------------------------- */

static void take_points(void) {
    for (uint32_t i = 0; i < rig.all.vertex_count * 3; i++) points[i / 3][i % 3] = rig.all.x0[i];
}

static void normal_of(uint32_t triangle, long double out[3]) {
    const uint32_t *v = rig.all.triangles + (size_t)triangle * 3;
    long double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = points[v[1]][k] - points[v[0]][k];
        b[k] = points[v[2]][k] - points[v[0]][k];
    }
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static long double height_of(const long double normal[3], const long double *from, const long double *p) {
    return normal[0] * (p[0] - from[0]) + normal[1] * (p[1] - from[1]) + normal[2] * (p[2] - from[2]);
}

typedef struct face_polygon {
    long double corners[CORNERS_MAX][3];
    int count;
} face_polygon;

/* Keeps what is behind the plane of a triangle. */
static void clip_polygon(face_polygon *p, uint32_t triangle) {
    face_polygon kept = {.count = 0};
    long double normal[3];
    const long double *from = points[rig.all.triangles[(size_t)triangle * 3]];
    normal_of(triangle, normal);
    for (int i = 0; i < p->count; i++) {
        const long double *a = p->corners[i], *b = p->corners[(i + 1) % p->count];
        const long double x = height_of(normal, from, a), y = height_of(normal, from, b);
        if (x <= 0) memcpy(kept.corners[kept.count++], a, sizeof *kept.corners);
        if ((x < 0) == (y < 0)) continue;
        for (int k = 0; k < 3; k++) kept.corners[kept.count][k] = (x * b[k] - y * a[k]) / (x - y);
        kept.count++;
    }
    assert_true(kept.count < CORNERS_MAX - 2);
    *p = kept;
}

/* The volume that two convex bodies have in common, by what each cuts out of the other's faces. */
static long double convex_volume(void) {
    long double sum = 0;
    for (uint32_t t = 0; t < rig.all.triangle_count; t++) {
        const body_part *other = &rig.bodies[t < rig.bodies[1].first_triangle ? 1 : 0];
        face_polygon p = {.count = 3};
        for (int i = 0; i < 3; i++)
            memcpy(p.corners[i], points[rig.all.triangles[t * 3 + (uint32_t)i]], sizeof *p.corners);
        for (uint32_t i = 0; i < other->triangle_count && p.count > 0; i++)
            clip_polygon(&p, other->first_triangle + i);
        for (int i = 1; i + 1 < p.count; i++) {
            const long double *a = p.corners[0], *b = p.corners[i], *c = p.corners[i + 1];
            sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
    }
    return sum / 6;
}

/* Where an edge passes through a triangle, if it does. */
static bool pierce_triangle(uint32_t e0, uint32_t e1, uint32_t triangle, long double out[3]) {
    const uint32_t *v = rig.all.triangles + (size_t)triangle * 3;
    long double normal[3];
    normal_of(triangle, normal);
    const long double x = height_of(normal, points[v[0]], points[e0]),
                      y = height_of(normal, points[v[0]], points[e1]);
    if ((x < 0) == (y < 0)) return false;
    for (int k = 0; k < 3; k++) out[k] = (x * points[e1][k] - y * points[e0][k]) / (x - y);
    for (int i = 0; i < 3; i++) { /* within the sides? */
        const long double *a = points[v[i]], *b = points[v[(i + 1) % 3]];
        long double side = 0;
        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            side += normal[k] * ((b[l] - a[l]) * (out[m] - a[m]) - (b[m] - a[m]) * (out[l] - a[l]));
        }
        if (side < 0) return false;
    }
    return true;
}

static bool has_vertex(uint32_t triangle, uint32_t vertex) {
    const uint32_t *v = rig.all.triangles + (size_t)triangle * 3;
    return v[0] == vertex || v[1] == vertex || v[2] == vertex;
}

static int add_ends(uint32_t from, uint32_t through, long double ends[3][3], int count) {
    const uint32_t *v = rig.all.triangles + (size_t)from * 3;
    for (int i = 0; i < 3 && count < 3; i++) {
        const uint32_t e0 = v[i], e1 = v[(i + 1) % 3];
        if (has_vertex(through, e0) || has_vertex(through, e1)) continue;
        count += pierce_triangle(e0, e1, through, ends[count]);
    }
    return count;
}

static bool boxes_meet(uint32_t a, uint32_t b) {
    const uint32_t *v = rig.all.triangles + (size_t)a * 3, *w = rig.all.triangles + (size_t)b * 3;
    for (int k = 0; k < 3; k++) {
        if (fmaxl(fmaxl(points[v[0]][k], points[v[1]][k]), points[v[2]][k]) <
                fminl(fminl(points[w[0]][k], points[w[1]][k]), points[w[2]][k]) ||
            fminl(fminl(points[v[0]][k], points[v[1]][k]), points[v[2]][k]) >
                fmaxl(fmaxl(points[w[0]][k], points[w[1]][k]), points[w[2]][k]))
            return false;
    }
    return true;
}

/* The length of all pieces, of triangles in generic position. */
static long double all_pieces(void) {
    long double sum = 0;
    for (uint32_t a = 0; a < rig.all.triangle_count; a++) {
        for (uint32_t b = a + 1; b < rig.all.triangle_count; b++) {
            long double ends[3][3], square = 0;
            if (!boxes_meet(a, b)) continue;
            int shared = 0, count = 0;
            for (int i = 0; i < 3; i++) {
                const uint32_t v = rig.all.triangles[a * 3 + (uint32_t)i];
                if (!has_vertex(b, v)) continue;
                shared++;
                memcpy(ends[0], points[v], sizeof ends[0]);
            }
            if (shared > 1) continue;
            count = add_ends(b, a, ends, add_ends(a, b, ends, shared));
            if (count != 2) continue;
            for (int k = 0; k < 3; k++) square += (ends[1][k] - ends[0][k]) * (ends[1][k] - ends[0][k]);
            sum += sqrtl(square);
        }
    }
    return sum;
}

/* ---- differences --------------------------------------------------------------------------------------- */

/* Compares derivatives with central differences of a truth; step: how far the vertex moves. */
static void expect_derivatives(const cscd_measures *found, long double (*truth)(void), double step,
                               double tolerance, uint64_t seed) {
    random_stream random = stream_start(seed);
    assert_int_equal(found->count, 1);
    spread_gradient(found, &found->items[0]);
    take_points();
    assert_true(fabsl(truth() - (long double)found->items[0].value) <= 1e-13L * fabsl(truth()));
    double largest = 0.0;
    for (uint32_t i = 0; i < rig.all.vertex_count * 3; i++) largest = fmax(largest, fabs(dense[i]));
    for (int i = 0; i < VERTICES_CHECKED; i++) {
        const cscd_vertex_gradient *g =
            &found->gradients[stream_below(&random, (uint32_t)found->gradient_count)];
        const uint32_t k = stream_below(&random, 3);
        long double *x = &points[g->vertex][k];
        const long double kept = *x;
        *x = kept + (long double)step;
        const long double above = truth();
        *x = kept - (long double)step;
        const long double difference = (above - truth()) / (2 * (long double)step);
        *x = kept;
        if (!(fabs((double)difference - g->gradient[k]) <= tolerance * largest))
            fail_msg("vertex %u, %u: %.17g, but %.17g", g->vertex, k, g->gradient[k], (double)difference);
    }
}

TEST(volumes_of_round_bodies) {
    for (uint64_t seed = 0; seed < SCENES; seed++) {
        body_rig_begin(&rig);
        add_round(0.1, 0.2, 0.3, 1.0, 3, 2 * seed);
        body_rig_end_body(&rig);
        add_round(0.9, 0.7, -0.2, 0.8, 2, 2 * seed + 1);
        body_rig_end_body(&rig);
        body_rig_create(&rig, NULL, 1 + (uint32_t)seed % 2);
        const cscd_measures found = ask_for(cscd_detector_overlap_volumes);
        assert_int_equal(found.unknown, 0);
        assert_true(found.sum == found.items[0].value && found.sum > 0.1);
        expect_derivatives(&found, convex_volume, 1e-6, 1e-9, seed);
    }
}

/* Half of a small ball's corners lie within a large one, the others far outside. */
TEST(volumes_of_which_little_is_common) {
    body_rig_begin(&rig);
    add_round(0.0, 0.0, 0.0, 1.0, 2, 1);
    body_rig_end_body(&rig);
    add_round(0.5, 0.9, 0.4, 0.3, 1, 2);
    body_rig_end_body(&rig);
    body_rig_create(&rig, NULL, 1);
    const cscd_measures found = ask_for(cscd_detector_overlap_volumes);
    expect_derivatives(&found, convex_volume, 1e-6, 1e-9, 3);
}

TEST(lengths_around_round_bodies) {
    for (uint64_t seed = 0; seed < SCENES; seed++) {
        body_rig_begin(&rig);
        add_round(0.1, 0.2, 0.3, 1.0, 3, 2 * seed);
        body_rig_end_body(&rig);
        add_round(0.9, 0.7, -0.2, 0.8, 2, 2 * seed + 1);
        body_rig_end_body(&rig);
        body_rig_create(&rig, NULL, 2);
        const cscd_measures found = ask_for(cscd_detector_curve_lengths);
        expect_derivatives(&found, all_pieces, 1e-7, 1e-8, seed);
    }
}

/* A tube that folds through itself: curves that end at vertices, or where it meets its own border. */
TEST(lengths_of_a_tube_with_itself) {
    body_rig_begin(&rig);
    body_rig_add_snake(&rig);
    shake_vertices(7, 1e-3);
    body_rig_end_body(&rig);
    body_rig_create(&rig, NULL, 2);
    const cscd_measures found = ask_for(cscd_detector_curve_lengths);
    expect_derivatives(&found, all_pieces, 1e-8, 1e-7, 5);
}

static void make_pierced_sheet(void) {
    static const double corner[3] = {-2, -2, 0.05}, along[3] = {4, 0.1, 0.2}, up[3] = {-0.1, 4, 0.1};
    const double low[3] = {-0.3, -0.4, -1.0}, size[3] = {0.7, 0.9, 2.5};
    body_rig_begin(&rig);
    body_rig_add_sheet(&rig, corner, along, up, 8, 9, false);
    body_rig_end_body(&rig);
    body_rig_box(&rig, low, size);
    shake_vertices(3, 0.02);
}

TEST(lengths_in_a_pierced_sheet) {
    make_pierced_sheet();
    body_rig_create(&rig, NULL, 2);
    const cscd_measures found = ask_for(cscd_detector_curve_lengths);
    assert_true(found.items[0].a == 0 && found.items[0].b == 1);
    expect_derivatives(&found, all_pieces, 1e-7, 1e-8, 6);
}

/* ---- near switches ------------------------------------------------------------------------------------- */

/* An edge of one tetrahedron passes an edge of the other at a distance, so that a piece is about as short. Far from the
 * origin, where points are rounded to more than the direction of such a piece may be off. */
static void make_crossing_edges(double gap) {
    static const double first[4][3] = {{-1, 0, 0}, {1, 0, 0}, {0.1, 0.9, -0.8}, {0.2, -0.8, -0.9}},
                        second[4][3] = {{0.1, -1, 0}, {0.2, 1, 0.0}, {1.0, 0.1, 0.9}, {-0.9, 0.2, 0.8}};
    static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    scene *s = &rig.all;
    body_rig_begin(&rig);
    for (uint32_t b = 0; b < 2; b++) {
        for (uint32_t v = 0; v < 4; v++)
            for (uint32_t k = 0; k < 3; k++)
                s->x0[(b * 4 + v) * 3 + k] =
                    64.0 + (b == 0 ? first[v][k] : second[v][k] - (k == 2 ? gap : 0.0));
        for (uint32_t i = 0; i < 12; i++) s->triangles[b * 12 + i] = b * 4 + faces[i];
        s->vertex_count += 4;
        s->triangle_count += 4;
        body_rig_end_body(&rig);
    }
}

TEST(lengths_of_short_pieces) {
    const double gaps[] = {1e-3, 1e-6, 1e-9};
    for (int i = 0; i < 3; i++) {
        make_crossing_edges(gaps[i]);
        body_rig_create(&rig, NULL, 1);
        const cscd_measures found = ask_for(cscd_detector_curve_lengths);
        take_points();
        spread_gradient(&found, &found.items[0]);
        const long double step = 0.1L * (long double)gaps[i];
        for (uint32_t v = 0; v < 24; v++) {
            long double *x = &points[v / 3][v % 3];
            const long double kept = *x;
            *x = kept + step;
            const long double above = all_pieces();
            *x = kept - step;
            const double difference = (double)((above - all_pieces()) / (2 * step));
            *x = kept;
            assert_true(fabs(difference - dense[v]) <= 1e-6 * (1.0 + fabs(difference)));
        }
    }
}

/* A piece of two units in the last place has the derivatives of a longer one. */
TEST(lengths_of_the_shortest_pieces) {
    double longer[24];
    for (int i = 0; i < 2; i++) {
        make_crossing_edges(i == 0 ? 0x1p-30 : 0x1p-45);
        body_rig_create(&rig, NULL, 1);
        const cscd_measures found = ask_for(cscd_detector_curve_lengths);
        assert_int_equal(found.count, 1);
        spread_gradient(&found, &found.items[0]);
        if (i == 0) memcpy(longer, dense, sizeof longer);
    }
    for (uint32_t v = 0; v < 24; v++) assert_true(fabs(longer[v] - dense[v]) <= 1e-6);
}

/* A ball is pushed through another one. Between two places a value changes by the mean of the derivatives there, however
 * many switches lie between: there is no jump. */
static void expect_no_jump(ask_function *function, double bound) {
    enum { PLACES = 160 };
    const double step = 0.005;
    double value = 0.0, slope = 0.0;
    for (int i = 0; i <= PLACES; i++) {
        const cscd_measures found = ask_for(function);
        double along = 0.0;
        memset(dense, 0, sizeof dense);
        cscd_measures_add(&found, 1.0, dense);
        for (uint32_t v = rig.bodies[1].first_vertex; v < rig.all.vertex_count; v++) along += dense[v * 3];
        if (i > 0) assert_true(fabs(found.sum - value - 0.5 * (along + slope) * step) <= bound * step);
        value = found.sum;
        slope = along;
        for (uint32_t v = rig.bodies[1].first_vertex; v < rig.all.vertex_count; v++)
            rig.all.x0[v * 3] += step;
    }
}

TEST(no_jump_where_curves_pass_edges) {
    for (int i = 0; i < 2; i++) {
        body_rig_begin(&rig);
        add_round(0.1, 0.2, 0.3, 1.0, 2, 1);
        body_rig_end_body(&rig);
        add_round(i == 0 ? -0.3 : 0.4, i == 0 ? 0.3 : 1.1, 0.2, i == 0 ? 0.9 : 0.7, 2, 2);
        body_rig_end_body(&rig);
        body_rig_create(&rig, NULL, 1);
        expect_no_jump(both[i], i == 0 ? 4e-3 : 0.2);
    }
}

/* ---- what motions of the whole scene leave as it is ---------------------------------------------------- */

/* The same for each pair: a translation or a turn changes nothing, and a scale what its degree says. */
static void expect_invariance(const cscd_measures *found, double degree) {
    for (size_t i = 0; i < found->count; i++) {
        const cscd_measure *of = &found->items[i];
        double force[3] = {0}, torque[3] = {0}, power = 0.0, size = 0.0;
        if (isnan(of->value)) continue;
        spread_gradient(found, of);
        for (uint32_t v = 0; v < rig.all.vertex_count; v++) {
            const double *x = &rig.all.x0[(size_t)v * 3], *g = &dense[(size_t)v * 3];
            for (int k = 0; k < 3; k++) {
                const int l = (k + 1) % 3, m = (k + 2) % 3;
                force[k] += g[k];
                torque[k] += x[l] * g[m] - x[m] * g[l];
                power += x[k] * g[k];
                size += fabs(g[k]);
            }
        }
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(force[k]) <= 1e-12 * size);
            assert_true(fabs(torque[k]) <= 1e-10 * size);
        }
        assert_true(fabs(power - degree * of->value) <= 1e-10 * size);
    }
}

TEST(tangles_are_invariant) {
    for (uint64_t seed = 0; seed < 2 * SCENES; seed++) {
        body_rig_begin(&rig);
        for (uint64_t i = 0; i < 3; i++) {
            const double place = 0.5 * (double)i;
            add_round(place, 0.2 * place, 0.1, 1.0, 2, 3 * seed + i);
            if (i == 1) add_round(place, 0.9, 0.3, 0.7, 2, seed); /* of one object with the one before */
            body_rig_end_body(&rig);
        }
        shake_vertices(seed, 0.15); /* no longer convex */
        rig.part_bodies = seed % 2 == 1;
        body_rig_create(&rig, NULL, 2);
        const cscd_measures volumes = ask_for(cscd_detector_overlap_volumes);
        assert_int_equal(volumes.unknown, 0);
        assert_true(volumes.count >= 4);
        expect_invariance(&volumes, 3.0);
        const cscd_measures lengths = ask_for(cscd_detector_curve_lengths);
        assert_true(lengths.count >= 4);
        expect_invariance(&lengths, 1.0);
    }
}

/* ---- volumes of all kinds ------------------------------------------------------------------------------ */

/* Wherever nothing is contained three times the volumes are those of overlaps. */
static void expect_volumes_of_overlaps(void) {
    const cscd_measures found = ask_for(cscd_detector_overlap_volumes);
    double values[16], sum = 0.0;
    assert_true(found.count <= 16);
    cscd_measure items[16];
    memcpy(items, found.items, found.count * sizeof *items);
    const size_t count = found.count;
    body_rig_find(&rig);
    for (size_t i = 0; i < count; i++) {
        values[i] = body_rig_overlap(&rig, items[i].a, items[i].b).volume;
        assert_true(fabs(values[i] - items[i].value) <= 1e-12 * (1.0 + values[i]));
        sum += values[i];
    }
    for (size_t i = 0; i < rig.found.overlaps->count; i++) sum -= rig.found.overlaps->items[i].volume;
    assert_true(fabs(sum) <= 1e-12);
}

TEST(volumes_are_those_of_overlaps) {
    const double low[3] = {0, 0, 0}, size[3] = {2, 2, 2}, second[3] = {1.2, 1.1, 1.3},
                 bar[3] = {-1, 1.6, 1.2}, long_one[3] = {6, 0.25, 0.5}, inner[3] = {0.1, 0.2, 0.3},
                 little[3] = {0.2, 0.3, 0.4};
    body_rig_begin(&rig);
    body_rig_add_box(&rig, low, size);
    body_rig_box(&rig, second, size);
    body_rig_box(&rig, bar, long_one);
    body_rig_box(&rig, inner, little);
    body_rig_create(&rig, NULL, 2);
    expect_volumes_of_overlaps();
    body_rig_turn(&rig, 24, 12); /* the bar is inside out */
    body_rig_create(&rig, NULL, 2);
    expect_volumes_of_overlaps();
    rig.orientation = CSCD_ORIENTATION_AS_GIVEN;
    expect_volumes_of_overlaps();
}

TEST(a_tube_that_bites_its_tail) {
    body_rig_begin(&rig);
    body_rig_add_snake(&rig);
    body_rig_end_body(&rig);
    body_rig_create(&rig, NULL, 2);
    expect_volumes_of_overlaps();
    const cscd_measures found = ask_for(cscd_detector_overlap_volumes);
    assert_true(found.count == 1 && found.items[0].value > 0.01);
    expect_invariance(&found, 3.0);
}

/* Three boxes of one object: where all three are counts twice. */
TEST(what_is_there_three_times_counts_twice) {
    const double size[3] = {2, 2, 2}, lows[3][3] = {{0, 0, 0}, {0.7, 0.9, 0.8}, {0.5, 0.3, 1.1}};
    body_rig_begin(&rig);
    for (int i = 0; i < 3; i++) body_rig_add_box(&rig, lows[i], size);
    body_rig_end_body(&rig);
    body_rig_create(&rig, NULL, 2);
    double expected = 0.0, all = 1.0;
    for (int i = 0; i < 3; i++) {
        double common = 1.0;
        for (int k = 0; k < 3; k++) common *= 2.0 - fabs(lows[i][k] - lows[(i + 1) % 3][k]);
        expected += common;
    }
    for (int k = 0; k < 3; k++)
        all *= 2.0 + fmin(lows[0][k], fmin(lows[1][k], lows[2][k])) -
               fmax(lows[0][k], fmax(lows[1][k], lows[2][k]));
    const cscd_measures found = ask_for(cscd_detector_overlap_volumes);
    assert_int_equal(found.count, 1);
    assert_true(fabs(found.sum - (expected - all)) <= 1e-12);
    expect_invariance(&found, 3.0);
}

/* Pulling a face of the inner box outwards adds its area times the way. */
TEST(a_box_within_another) {
    const double low[3] = {0, 0, 0}, size[3] = {4, 4, 4}, inner[3] = {1, 1, 1}, small[3] = {1, 2, 1.5};
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    body_rig_box(&rig, inner, small);
    body_rig_create(&rig, NULL, 1);
    const cscd_measures found = ask_for(cscd_detector_overlap_volumes);
    assert_true(found.count == 1 && fabs(found.sum - 3.0) <= 1e-13);
    spread_gradient(&found, &found.items[0]);
    double pull = 0.0;
    for (uint32_t v = 8; v < 16; v++) pull += (v & 1) != 0 ? dense[v * 3] : 0.0;
    assert_true(fabs(pull - 3.0) <= 1e-13);
    assert_int_equal(found.gradient_count, 8);
    body_rig_turn(&rig, 12, 12); /* the inner one is inside out */
    body_rig_create(&rig, NULL, 1);
    const cscd_measures turned = ask_for(cscd_detector_overlap_volumes);
    assert_true(turned.count == 1 && fabs(turned.sum - 3.0) <= 1e-13);
}

TEST(bodies_apart_have_nothing) {
    const double low[3] = {0, 0, 0}, size[3] = {1, 1, 1}, far[3] = {3, 0, 0};
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    body_rig_box(&rig, far, size);
    body_rig_create(&rig, NULL, 1);
    for (int i = 0; i < 2; i++) {
        const cscd_measures found = ask_for(both[i]);
        assert_true(found.count == 0 && found.gradient_count == 0 && found.sum == 0.0 && found.unknown == 0);
    }
}

/* ---- what is unknown ----------------------------------------------------------------------------------- */

TEST(open_surfaces_have_no_volume) {
    const double low[3] = {0.2, 0.3, -0.5}, size[3] = {0.5, 0.5, 1}, other[3] = {0.5, 0.6, 0.1};
    static const double corner[3] = {0, 0, 0}, along[3] = {2, 0, 0}, up[3] = {0, 2, 0};
    body_rig_begin(&rig);
    body_rig_add_sheet(&rig, corner, along, up, 3, 3, false);
    body_rig_end_body(&rig);
    body_rig_box(&rig, low, size);
    body_rig_box(&rig, other, size);
    body_rig_create(&rig, NULL, 1);
    cscd_measures found = ask_for(cscd_detector_overlap_volumes);
    assert_int_equal(found.unknown, 1);
    assert_true(isnan(value_of(&found, 0, 1)) && value_of(&found, 0, 2) == 0.0);
    assert_true(fabs(value_of(&found, 1, 2) - 0.2 * 0.2 * 0.4) <= 1e-13);
    assert_true(fabs(found.sum - 0.2 * 0.2 * 0.4) <= 1e-13);
    for (size_t i = 0; i < found.count; i++)
        assert_true(isnan(found.items[i].value) == (found.items[i].gradient_count == 0));
    found = ask_for(cscd_detector_curve_lengths);
    assert_true(fabs(value_of(&found, 0, 1) - 4 * 0.5) <= 1e-13);
}

/* No curve says that the sheet is within the box. */
TEST(an_open_surface_within_a_body) {
    const double low[3] = {-1, -1, -1}, size[3] = {4, 4, 2};
    static const double corner[3] = {0, 0, 0}, along[3] = {2, 0, 0}, up[3] = {0, 2, 0};
    body_rig_begin(&rig);
    body_rig_add_sheet(&rig, corner, along, up, 3, 3, false);
    body_rig_end_body(&rig);
    body_rig_box(&rig, low, size);
    body_rig_create(&rig, NULL, 1);
    const cscd_measures found = ask_for(cscd_detector_overlap_volumes);
    assert_true(found.count == 1 && found.unknown == 1 && found.sum == 0.0 && isnan(found.items[0].value));
}

TEST(pairs_left_out_hide_a_volume) {
    const double low[3] = {0, 0, 0}, size[3] = {2, 2, 2}, second[3] = {1.25, 1.5, 1.125};
    cscd_detector_options options = cscd_detector_defaults();
    uint32_t pairs[12 * 12][2];
    for (uint32_t i = 0; i < 144; i++) {
        pairs[i][0] = i / 12;
        pairs[i][1] = 12 + i % 12;
    }
    options.ignored = pairs[0];
    options.ignored_count = 144;
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    body_rig_box(&rig, second, size);
    body_rig_create(&rig, &options, 1);
    const cscd_measures found = ask_for(cscd_detector_overlap_volumes);
    assert_true(found.count == 1 && found.unknown == 1 && isnan(found.items[0].value));
}

/* ---- calls --------------------------------------------------------------------------------------------- */

TEST(bad_calls_change_nothing) {
    make_pierced_sheet();
    body_rig_create(&rig, NULL, 1);
    const cscd_view *x = CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count);
    cscd_measures found, before;
    memset(&found, 0x5a, sizeof found);
    before = found;
    for (int i = 0; i < 2; i++) {
        cscd_intersection_options options = cscd_intersection_defaults();
        assert_int_equal(both[i](NULL, x, NULL, &found), CSCD_NULL_OBJECT);
        assert_int_equal(both[i](rig.detector, x, NULL, NULL), CSCD_INVALID_ARGUMENT);
        assert_int_equal(both[i](rig.detector, NULL, NULL, &found), CSCD_INVALID_ARGUMENT);
        options.answer = CSCD_ANSWER_COUNT;
        assert_int_equal(both[i](rig.detector, x, &options, &found), CSCD_INVALID_ARGUMENT);
        options = cscd_intersection_defaults();
        options.stop_after = 3;
        assert_int_equal(both[i](rig.detector, x, &options, &found), CSCD_INVALID_ARGUMENT);
        options = cscd_intersection_defaults();
        options.kinds = cscd_intersection_set(CSCD_INTERSECTION_CROSSING);
        assert_int_equal(both[i](rig.detector, x, &options, &found), CSCD_INVALID_ARGUMENT);
        options = cscd_intersection_defaults();
        options.max_memory = 8192;
        assert_int_equal(both[i](rig.detector, x, &options, &found), CSCD_LIST_TOO_LONG);
        assert_memory_equal(&found, &before, sizeof found);
    }
}

TEST(inactive_triangles_have_no_volume) {
    const double low[3] = {0, 0, 0}, size[3] = {2, 2, 2}, second[3] = {1.25, 1.5, 1.125};
    const uint32_t active = 0;
    cscd_measures found;
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    body_rig_box(&rig, second, size);
    body_rig_create(&rig, NULL, 1);
    const cscd_view *x = CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count);
    expect_ok(cscd_detector_set_active(rig.detector, &active, 1));
    assert_int_equal(cscd_detector_overlap_volumes(rig.detector, x, NULL, &found), CSCD_INVALID_ARGUMENT);
    expect_ok(cscd_detector_curve_lengths(rig.detector, x, NULL, &found));
    expect_ok(cscd_detector_set_active(rig.detector, NULL, 0));
    expect_ok(cscd_detector_overlap_volumes(rig.detector, x, NULL, &found));
    assert_true(fabs(found.sum - 0.75 * 0.5 * 0.875) <= 1e-13);
}

/* All budgets, from nothing to enough: a call either fails or answers as without. */
TEST(any_memory) {
    make_pierced_sheet();
    body_rig_create(&rig, NULL, 1);
    for (int i = 0; i < 2; i++) {
        const double expected = ask_for(both[i]).sum;
        bool fits = false;
        for (size_t most = 64; most < (size_t)1 << 24; most += most / 4) {
            cscd_intersection_options options = cscd_intersection_defaults();
            cscd_measures found;
            options.max_memory = most;
            const cscd_status status =
                both[i](rig.detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count), &options, &found);
            if (status == CSCD_OK) assert_true(found.sum == expected);
            assert_true(status == CSCD_OK ? true : status == CSCD_LIST_TOO_LONG && !fits);
            fits = status == CSCD_OK;
        }
        assert_true(fits);
    }
}

AROUND_EACH(NULL, body_rigs_free)
