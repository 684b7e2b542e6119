/* Plans of bodies that are soft in places: borders run there, and what lies beyond has a point of its own. */
#include "preprocess/regions/tiles.h"
#include "src/mesh/surface.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGLES = 3000 };

/* The soft place of the capsule, which is 3 long about 0: off the middle. */
static const double band[2] = {0.4, 0.8};

static body capsule;
static double *soft; /* the stiffness of its triangles: 1, and 0.1 in the band */

static double height_of(uint32_t t) {
    double sum = 0.0;
    for (uint32_t i = 0; i < 3; i++) sum += capsule.positions[(size_t)capsule.triangles[t * 3 + i] * 3 + 2];
    return sum / 3.0;
}

static int make_capsule(void **state) {
    (void)state;
    capsule = body_of(BODY_CAPSULE, TRIANGLES);
    soft = body_allocate(capsule.triangle_count, sizeof *soft);
    for (uint32_t t = 0; t < capsule.triangle_count; t++)
        soft[t] = height_of(t) > band[0] && height_of(t) < band[1] ? 0.1 : 1.0;
    return 0;
}

static int free_capsule(void **state) {
    (void)state;
    body_free(&capsule);
    free(soft);
    return 0;
}

/* A plan, taken apart. */
typedef struct stiff_division {
    uint32_t count, *regions;
    double points[64][3];
} stiff_division;

static cscd_status try_plan(const cscd_mesh *mesh, const double *stiffness, cscd_plan **out) {
    cscd_plan_options options = cscd_plan_defaults();
    options.stiffness = stiffness;
    return cscd_plan_create(mesh->context, mesh, CSCD_DOUBLES(capsule.positions, capsule.vertex_count),
                            &options, out);
}

static stiff_division divide_capsule(const double *stiffness) {
    cscd_mesh *mesh = body_mesh(&capsule, 1);
    cscd_plan *plan = NULL;
    expect_ok(try_plan(mesh, stiffness, &plan));
    stiff_division d = {.count = cscd_plan_region_count(plan),
                        .regions = body_allocate(capsule.triangle_count, sizeof *d.regions)};
    assert_true(d.count <= 64);
    for (uint32_t t = 0; t < capsule.triangle_count; t++) d.regions[t] = cscd_plan_triangle_region(plan, t);
    for (uint32_t r = 0; r < d.count; r++)
        memcpy(d.points[r], cscd_plan_region(plan, r).detector_point, sizeof d.points[r]);
    check_regions(mesh, d.regions, d.count);
    cscd_plan_destroy(plan);
    body_mesh_destroy(mesh);
    return d;
}

/* Compares bit for bit, and frees both. */
static void expect_same(stiff_division a, stiff_division b) {
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.regions, b.regions, capsule.triangle_count * sizeof *a.regions);
    assert_memory_equal(a.points, b.points, a.count * sizeof *a.points);
    free(a.regions);
    free(b.regions);
}

/* The values times a factor; to be freed. */
static double *scaled_values(const double *values, double factor) {
    double *scaled = body_allocate(capsule.triangle_count, sizeof *scaled);
    for (uint32_t t = 0; t < capsule.triangle_count; t++) scaled[t] = values[t] * factor;
    return scaled;
}

/* The whole of it is seen from one point at rest, and yet it is cut. */
TEST(a_soft_place_parts_a_body) {
    stiff_division plain = divide_capsule(NULL), d = divide_capsule(soft);
    print_message("  capsule with a soft place: %u regions\n", d.count);
    assert_int_equal(plain.count, 1);
    assert_true(d.count >= 2 && d.count <= 3);
    cscd_mesh *mesh = body_mesh(&capsule, 1);
    uint32_t borders = 0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[e];
        if (d.regions[star[0]] == d.regions[star[1]]) continue;
        for (int i = 0; i < 2; i++) {
            assert_true(height_of(star[i]) > band[0] - 0.05 && height_of(star[i]) < band[1] + 0.05);
        }
        borders++;
    }
    assert_true(borders > 20);
    bool above = false, below = false;
    for (uint32_t r = 0; r < d.count; r++) {
        above |= d.points[r][2] > band[1];
        below |= d.points[r][2] < band[0];
    }
    assert_true(above && below);
    body_mesh_destroy(mesh);
    free(plain.regions);
    free(d.regions);
}

TEST(only_ratios_count) {
    static const double factors[] = {3.0, 1e-5, 0x1p-900, 7e200};
    for (size_t i = 0; i < sizeof factors / sizeof *factors; i++) {
        double *scaled = scaled_values(soft, factors[i]);
        expect_same(divide_capsule(soft), divide_capsule(scaled));
        free(scaled);
    }
}

/* As stiff everywhere, or stiffer in one small place, is the same as no stiffness. */
TEST(nothing_soft_changes_nothing) {
    double *values = body_allocate(capsule.triangle_count, sizeof *values);
    for (uint32_t t = 0; t < capsule.triangle_count; t++) values[t] = 0.3;
    expect_same(divide_capsule(NULL), divide_capsule(values));
    for (uint32_t t = 0; t < capsule.triangle_count; t++)
        if (height_of(t) > 1.4) values[t] = 1e6;
    expect_same(divide_capsule(NULL), divide_capsule(values));
    free(values);
}

/* An edge weighs its length times the share of the charge or of the stiffness, whichever is less. */
TEST(edges_weigh_less_where_it_is_soft) {
    const region_options options = region_options_defaults();
    cscd_mesh *mesh = body_mesh(&capsule, 1);
    const uint32_t triangle_count = capsule.triangle_count;
    double *ranks = body_allocate(triangle_count, sizeof *ranks),
           *softer = body_allocate(triangle_count, sizeof *softer),
           *plain = body_allocate(mesh->edge_count, sizeof *plain),
           *weights = body_allocate(mesh->edge_count, sizeof *weights);
    for (uint32_t t = 0; t < triangle_count; t++) ranks[t] = (double)t / triangle_count;
    for (uint32_t t = 0; t < triangle_count; t++) softer[t] = soft[t] < 1.0 ? 0.025 : 0.5;
    weigh_edges(mesh, capsule.positions, ranks, NULL, &options, plain);
    weigh_edges(mesh, capsule.positions, ranks, softer, &options, weights);
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const double share = fmax(0.1, stiffness_beside(mesh, softer, e)),
                     length = surface_edge_length(mesh, capsule.positions, e);
        const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[e];
        const double rank = fmin(1.0, (ranks[star[0]] + ranks[star[1]]) / 2.0 / 0.3);
        assert_true(fabs(plain[e] - length * (1.0 - 0.9 * (1.0 - rank))) <= 1e-12 * length);
        assert_true(fabs(weights[e] - fmin(plain[e], length * share)) <= 1e-12 * length);
    }
    body_mesh_destroy(mesh);
    free(ranks);
    free(softer);
    free(plain);
    free(weights);
}

TEST(bad_values_are_refused) {
    static const double bad[] = {0.0, -1.0, -0.0, INFINITY, -INFINITY, NAN};
    cscd_mesh *mesh = body_mesh(&capsule, 1);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        double *values = scaled_values(soft, 1.0);
        values[17] = values[2000] = bad[i];
        cscd_plan *plan = NULL;
        assert_int_equal(try_plan(mesh, values, &plan), CSCD_INVALID_ARGUMENT);
        assert_null(plan);
        assert_non_null(strstr(cscd_context_detail(mesh->context), "the stiffness of triangle 17 is "));
        free(values);
    }
    body_mesh_destroy(mesh);
}

/* Shares are those of the stiffer half of the area, in each component, and never above 1. */
TEST(shares_are_of_the_component) {
    body two = {0};
    body_append(&two, &capsule, (const double[3]){0.0, 0.0, 0.0});
    body_append(&two, &capsule, (const double[3]){5.0, 0.0, 0.0});
    const uint32_t half = capsule.triangle_count;
    cscd_mesh *mesh = body_mesh(&two, 1);
    double *given = body_allocate(two.triangle_count, sizeof *given),
           *shares = body_allocate(two.triangle_count, sizeof *shares);
    for (uint32_t t = 0; t < two.triangle_count; t++) given[t] = soft[t % half] * (t < half ? 1.0 : 50.0);
    given[0] = 1000.0;
    given[half] = 1e-30;
    expect_ok(stiffness_shares(mesh, two.positions, given, shares));
    assert_true(shares[0] == 1.0 && shares[half] == 1e-6);
    for (uint32_t t = 1; t < half; t++) {
        assert_true(shares[t] == (double)(float)soft[t]);
        assert_true(shares[half + t] == shares[t]);
    }
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[e];
        assert_true(stiffness_beside(mesh, shares, e) == (shares[star[0]] + shares[star[1]]) / 2.0);
    }
    body_mesh_destroy(mesh);
    body_free(&two);
    free(given);
    free(shares);
}

/* A large stiff triangle and three small soft ones: half of the area is stiff. */
TEST(medians_are_of_areas) {
    double positions[15] = {0, 0, 0, 10, 0, 0, 0, 10, 0, 5, -0.1, 0, 5, -0.2, 0};
    uint32_t triangles[12] = {0, 1, 2, 1, 0, 3, 1, 3, 4, 0, 4, 3};
    const double given[4] = {1.0, 0.125, 0.125, 0.125};
    double shares[4];
    const body b = {.vertex_count = 5, .triangle_count = 4, .positions = positions, .triangles = triangles};
    cscd_mesh *mesh = body_mesh(&b, 1);
    assert_int_equal(stiffness_shares(mesh, positions, given, shares), CSCD_OK);
    for (int t = 0; t < 4; t++) assert_true(shares[t] == given[t]);
    body_mesh_destroy(mesh);
}

/* ---- what method auto compares --------------------------------------------------------------------------- */

static void find_centroid(const body *b, uint32_t t, double out[3]) {
    for (uint32_t k = 0; k < 3; k++) {
        out[k] = 0.0;
        for (uint32_t i = 0; i < 3; i++)
            out[k] += b->positions[(size_t)b->triangles[t * 3 + i] * 3 + k] / 3.0;
    }
}

static double distance_between(const double a[3], const double b[3]) {
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* Takes all steps again and again until none is shorter. */
static void walk_slowly(const region_scene *s, const body *b, const double *shares, double *ways) {
    double area = 0.0, centroids[2][3];
    for (uint32_t t = 0; t < s->count; t++) area += surface_area(s->mesh, s->positions, t);
    for (uint32_t t = 0; t < s->count; t++) ways[t] = 0.3;
    for (uint32_t r = 0; r < s->region_count; r++) {
        uint32_t seat = 0;
        double nearest = INFINITY;
        for (uint32_t t = 0; t < s->count; t++) {
            find_centroid(b, t, centroids[0]);
            const double distance = distance_between(centroids[0], s->points[r]);
            if (s->of_triangle[t] != r || distance >= nearest) continue;
            seat = t;
            nearest = distance;
        }
        ways[seat] = 0.0;
    }
    for (bool shorter = true; shorter;) {
        shorter = false;
        for (uint32_t e = 0; e < s->mesh->edge_count; e++) {
            const uint32_t *star = s->mesh->edge_stars + s->mesh->edge_star_offsets[e];
            if (s->of_triangle[star[0]] != s->of_triangle[star[1]]) continue;
            for (int i = 0; i < 2; i++) find_centroid(b, star[i], centroids[i]);
            const double springs = 0.5 / shares[star[0]] + 0.5 / shares[star[1]],
                         step = (springs - 1.0) * distance_between(centroids[0], centroids[1]) / sqrt(area);
            for (int i = 0; i < 2; i++) {
                if (ways[star[i]] + step >= ways[star[1 - i]] - 1e-12) continue;
                ways[star[1 - i]] = ways[star[i]] + step;
                shorter = true;
            }
        }
    }
}

/* Two regions, one of them with a soft place on the way from its point and a piece that no way leads to: the second, or the first. */
static void check_ways(uint32_t softer) {
    static const double places[2][3] = {{0.1, 0.0, -0.6}, {0.0, 0.2, 1.2}};
    double points[2][3];
    memcpy(points[1 - softer], places[0], sizeof places[0]);
    memcpy(points[softer], places[1], sizeof places[1]);
    body b = body_of(BODY_CAPSULE, 500);
    cscd_mesh *mesh = body_mesh(&b, 1);
    uint32_t *regions = body_allocate(b.triangle_count, sizeof *regions), beyond = 0, between = 0;
    double *shares = body_allocate(b.triangle_count, sizeof *shares),
           *ways = body_allocate(b.triangle_count, sizeof *ways),
           *expected = body_allocate(b.triangle_count, sizeof *expected);
    for (uint32_t t = 0; t < b.triangle_count; t++) {
        double middle[3];
        find_centroid(&b, t, middle);
        regions[t] = middle[2] > 0.0 || middle[2] < -1.3 ? softer : 1 - softer;
        shares[t] = middle[2] > 0.4 && middle[2] < 0.8 ? 0.25 + 0.5 * (t % 2) : 1.0;
    }
    const region_scene scene = {.mesh = mesh,
                                .positions = b.positions,
                                .count = b.triangle_count,
                                .of_triangle = regions,
                                .region_count = 2,
                                .points = (const double(*)[3])points};
    expect_ok(soft_ways_find(&scene, shares, ways));
    walk_slowly(&scene, &b, shares, expected);
    for (uint32_t t = 0; t < b.triangle_count; t++) {
        assert_true(fabs(ways[t] - expected[t]) < 1e-9);
        beyond += ways[t] == 0.3;
        between += ways[t] > 0.0 && ways[t] < 0.3;
    }
    print_message("  %u triangles lie beyond, and %u between\n", beyond, between);
    assert_true(beyond > 10 && between > 10);
    body_mesh_destroy(mesh);
    body_free(&b);
    free(regions);
    free(shares);
    free(ways);
    free(expected);
}

TEST(ways_are_the_shortest) {
    for (uint32_t softer = 0; softer < 2; softer++) check_ways(softer);
}

static double compared_share(const cscd_plan *plan, cscd_method method) {
    for (uint32_t i = 0; i < cscd_plan_describe(plan).compared_count; i++)
        if (cscd_plan_compared(plan, i).method == method) return cscd_plan_compared(plan, i).tested_share;
    fail_msg("not compared");
    return 0.0;
}

/* The capsule is seen whole from one point at rest, and a cut has borders to test: only what lies beyond the soft place pays for it. */
TEST(auto_knows_what_is_soft) {
    cscd_mesh *mesh = body_mesh(&capsule, 1);
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plans[2] = {NULL};
    options.method = CSCD_METHOD_AUTO;
    for (int i = 0; i < 2; i++) {
        options.stiffness = i == 0 ? NULL : soft;
        expect_ok(cscd_plan_create(mesh->context, mesh, CSCD_DOUBLES(capsule.positions, capsule.vertex_count),
                                   &options, &plans[i]));
        assert_int_equal(cscd_plan_method(plans[i]), CSCD_METHOD_CHARGE);
    }
    assert_true(compared_share(plans[1], CSCD_METHOD_SINGLE) >
                compared_share(plans[0], CSCD_METHOD_SINGLE) + 0.05);
    assert_true(cscd_plan_region_count(plans[1]) >= 2);
    for (int i = 0; i < 2; i++) cscd_plan_destroy(plans[i]);
    body_mesh_destroy(mesh);
}

AROUND_ALL(make_capsule, free_capsule)
