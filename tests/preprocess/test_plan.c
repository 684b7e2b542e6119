/* Plans through the public API: every method, parts and their errors, the mesh's hash, refusals. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "src/mesh/plan.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static body shape;
static cscd_context *context;
static cscd_mesh *mesh;

static int make_body(void **state) {
    (void)state;
    shape = body_of(BODY_DUMBBELL, 1500);
    cscd_object_desc desc =
        cscd_object_of_triangles(shape.vertex_count, shape.triangle_count, shape.triangles);
    if (cscd_context_create(NULL, &context) != CSCD_OK) return -1;
    return cscd_mesh_create(context, &desc, 1, &mesh) == CSCD_OK ? 0 : -1;
}

static int destroy_body(void **state) {
    (void)state;
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    body_free(&shape);
    return 0;
}

static cscd_plan *plan_by(cscd_method method, uint32_t k) {
    cscd_plan *plan = NULL;
    cscd_plan_options options = cscd_plan_defaults();
    options.method = method;
    options.k = k;
    expect_ok(plan_create_packed(mesh, shape.positions, &options, &plan));
    return plan;
}

static void check_plan_regions(const cscd_plan *plan) {
    uint32_t triangles = 0, count = cscd_plan_region_count(plan);
    for (uint32_t r = 0; r < count; r++) {
        cscd_region region = cscd_plan_region(plan, r);
        assert_true(region.triangle_count > 0 && region.area > 0.0);
        assert_true(region.visible_share >= 0.0 && region.visible_share <= 1.0);
        triangles += region.triangle_count;
    }
    assert_int_equal(triangles, shape.triangle_count);
    for (uint32_t t = 0; t < shape.triangle_count; t++)
        assert_true(cscd_plan_triangle_region(plan, t) < count);
}

TEST(every_method) {
    cscd_plan *single = plan_by(CSCD_METHOD_SINGLE, 0), *kmeans = plan_by(CSCD_METHOD_KMEANS, 3),
              *charge = plan_by(CSCD_METHOD_CHARGE, 0);
    assert_int_equal(cscd_plan_region_count(single), 1);
    assert_int_equal(cscd_plan_region_count(kmeans), 3);
    assert_int_equal(cscd_plan_region_count(charge), 2);
    assert_int_equal(cscd_plan_method(charge), CSCD_METHOD_CHARGE);
    check_plan_regions(single);
    check_plan_regions(kmeans);
    check_plan_regions(charge);
    assert_true(cscd_plan_capacitance(charge, 0) > 0.5 && cscd_plan_capacitance(charge, 0) < 4.6);
    assert_true(cscd_plan_capacitance(single, 0) == 0.0 && cscd_plan_triangle_charge(single, 0) == 0.0);
    double sum = 0.0;
    for (uint32_t t = 0; t < shape.triangle_count; t++) sum += cscd_plan_triangle_charge(charge, t);
    assert_true(sum > 0.0);
    assert_true(cscd_plan_timings(charge).total_ms >= cscd_plan_timings(charge).solve_ms);
    cscd_plan_destroy(single);
    cscd_plan_destroy(kmeans);
    cscd_plan_destroy(charge);
    cscd_plan_destroy(NULL);
}

/* ---- two components ---------------------------------------------------------------------------------- */

/* A ball, and two triangles with one centroid, which have no charges, or none. What is an obstacle needs none. */
static cscd_status charge_two(bool flat_first, uint32_t obstacles, double capacitances[2]) {
    const double corners[18] = {3, 0, 0, 0, 3, 0, -3, -3, 0, -3, 0, 0, 0, -3, 0, 3, 3, 0};
    const uint32_t flat[9] = {0, 1, 2, 3, 4, 5, 0, 3, 5};
    body ball = body_of(BODY_SPHERE, 200);
    double *positions = body_allocate((size_t)ball.vertex_count * 3 + 18, sizeof *positions);
    cscd_object_desc descs[2];
    cscd_mesh *own = NULL;
    cscd_plan *plan = NULL;
    descs[flat_first] = cscd_object_of_triangles(ball.vertex_count, ball.triangle_count, ball.triangles);
    descs[!flat_first] = cscd_object_of_triangles(6, 3, flat);
    memcpy(positions + (flat_first ? 18 : 0), ball.positions, (size_t)ball.vertex_count * sizeof(double[3]));
    memcpy(positions + (flat_first ? 0 : (size_t)ball.vertex_count * 3), corners, sizeof corners);
    for (uint32_t i = 0; i < 2; i++) descs[i].obstacle = (obstacles >> i & 1) != 0;
    assert_int_equal(cscd_mesh_create(context, descs, 2, &own), CSCD_OK);
    const cscd_status status = plan_create_packed(own, positions, NULL, &plan);
    for (uint32_t i = 0; i < 2 && status == CSCD_OK; i++) capacitances[i] = cscd_plan_capacitance(plan, i);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(own);
    free(positions);
    body_free(&ball);
    return status;
}

TEST(each_component_needs_charges_but_obstacles) {
    double capacitances[2];
    for (uint32_t flat = 0; flat < 2; flat++) {
        for (uint32_t obstacles = 0; obstacles < 4; obstacles++) {
            const bool left_out = (obstacles >> flat & 1) != 0;
            assert_int_equal(charge_two(flat == 0, obstacles, capacitances),
                             left_out ? CSCD_OK : CSCD_INVALID_ARGUMENT);
            if (!left_out) assert_non_null(strstr(cscd_context_detail(context), "have the same centroid"));
            if (!left_out) continue;
            assert_true(capacitances[flat] == 0.0);
            assert_int_equal(capacitances[1 - flat] > 0.0, obstacles != 3);
        }
    }
}

/* ---- parts ----------------------------------------------------------------------------------------- */

static uint32_t *regions_of(const cscd_plan *plan) {
    uint32_t *regions = malloc(shape.triangle_count * sizeof *regions);
    assert_non_null(regions);
    for (uint32_t t = 0; t < shape.triangle_count; t++) regions[t] = cscd_plan_triangle_region(plan, t);
    return regions;
}

static double *points_of(const cscd_plan *plan) {
    double *points = malloc(cscd_plan_region_count(plan) * sizeof(double[3]));
    assert_non_null(points);
    for (uint32_t r = 0; r < cscd_plan_region_count(plan); r++)
        memcpy(points + r * 3, cscd_plan_region(plan, r).detector_point, sizeof(double[3]));
    return points;
}

TEST(from_parts) {
    cscd_plan *plan = plan_by(CSCD_METHOD_KMEANS, 4), *again = NULL;
    uint32_t *regions = regions_of(plan);
    double *points = points_of(plan);
    cscd_plan_parts parts = {
        CSCD_METHOD_KMEANS, cscd_plan_region_count(plan), regions, points, NULL, NULL, NULL};
    expect_ok(plan_from_parts_packed(mesh, shape.positions, &parts, &again));
    for (uint32_t r = 0; r < cscd_plan_region_count(plan); r++) {
        cscd_region a = cscd_plan_region(plan, r), b = cscd_plan_region(again, r);
        assert_true(a.component == b.component && a.triangle_count == b.triangle_count && a.area == b.area &&
                    a.visible_share == b.visible_share);
        assert_memory_equal(a.detector_point, b.detector_point, sizeof a.detector_point);
    }
    cscd_plan_destroy(again);
    cscd_plan_destroy(plan);
    free(regions);
    free(points);
}

/* How a plan was made is said in one line of a file. */
TEST(origins_are_one_line) {
    uint32_t *one = calloc(shape.triangle_count, sizeof *one);
    const double point[3] = {0, 0, 0};
    cscd_plan_parts parts = {CSCD_METHOD_SINGLE, 1, one, point, NULL, NULL, "by hand, 2 ~ 3"};
    char longest[257];
    cscd_plan *plan = NULL;
    memset(longest, 'x', sizeof longest);
    longest[256] = '\0';
    expect_ok(plan_from_parts_packed(mesh, shape.positions, &parts, &plan));
    assert_string_equal(cscd_plan_describe(plan).origin, parts.origin);
    cscd_plan_destroy(plan);
    const char *const bad[] = {"two\nlines", "caf\xc3\xa9", longest};
    for (int i = 0; i < 3; i++) {
        parts.origin = bad[i];
        expect_invalid(context, plan_from_parts_packed(mesh, shape.positions, &parts, &plan), "origin");
    }
    longest[255] = '\0';
    parts.origin = longest;
    expect_ok(plan_from_parts_packed(mesh, shape.positions, &parts, &plan));
    cscd_plan_destroy(plan);
    parts.origin = NULL;
    expect_ok(plan_from_parts_packed(mesh, shape.positions, &parts, &plan));
    assert_null(cscd_plan_describe(plan).origin);
    cscd_plan_destroy(plan);
    plan = plan_by(CSCD_METHOD_KMEANS, 4);
    assert_non_null(strstr(cscd_plan_describe(plan).origin, "method=kmeans k=4 seed=1 version="));
    cscd_plan_destroy(plan);
    free(one);
}

static void expect_refusal(const cscd_plan_parts *parts, const char *word) {
    cscd_plan *plan = NULL;
    assert_int_equal(plan_from_parts_packed(mesh, shape.positions, parts, &plan), CSCD_INVALID_ARGUMENT);
    assert_null(plan);
    assert_non_null(strstr(cscd_context_detail(context), word));
}

TEST(bad_parts) {
    cscd_plan *plan = plan_by(CSCD_METHOD_KMEANS, 4);
    uint32_t *regions = regions_of(plan);
    double *points = points_of(plan);
    const cscd_plan_parts good = {
        CSCD_METHOD_KMEANS, cscd_plan_region_count(plan), regions, points, NULL, NULL, NULL};
    cscd_plan_parts parts = good;
    parts.method = CSCD_METHOD_BRUTE;
    expect_refusal(&parts, "brute");
    parts = good;
    parts.region_count = 0;
    expect_refusal(&parts, "0 regions");
    parts = good;
    parts.region_count++;
    double *more = calloc(parts.region_count, sizeof(double[3]));
    assert_non_null(more);
    parts.detector_points = more;
    expect_refusal(&parts, "no triangle");
    free(more);
    parts = good;
    parts.triangle_regions = NULL;
    expect_refusal(&parts, "NULL");
    parts = good;
    parts.charges = points;
    expect_refusal(&parts, "charge");
    parts = good;
    regions[7] = good.region_count;
    expect_refusal(&parts, "triangle 7");
    regions[7] = 0;
    points[4] = NAN;
    expect_refusal(&parts, "detector point of region 1");
    cscd_plan_destroy(plan);
    free(regions);
    free(points);
}

/* ---- errors ---------------------------------------------------------------------------------------- */

/* Triangles that touch nowhere: the regions are by the number in each place. Without an area they weigh the same. */
TEST(regions_lie_in_one_component) {
    static const uint32_t triangles[9] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    static const uint32_t wrong[][3] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}, right[3] = {0, 1, 2};
    static const double points[9] = {0};
    double positions[27] = {0};
    const cscd_object_desc desc = cscd_object_of_triangles(9, 3, triangles);
    cscd_plan_parts parts = {CSCD_METHOD_KMEANS, 2, wrong[0], points, NULL, NULL, NULL};
    cscd_mesh *own = NULL;
    cscd_plan *plan = NULL;
    for (int i = 0; i < 27; i++) positions[i] = i / 3;
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &own), CSCD_OK);
    for (int i = 0; i < 3; i++) {
        parts.triangle_regions = wrong[i];
        assert_int_equal(plan_from_parts_packed(own, positions, &parts, &plan), CSCD_INVALID_ARGUMENT);
        assert_non_null(strstr(cscd_context_detail(context), "spans the components "));
    }
    parts.triangle_regions = right;
    parts.region_count = 3;
    assert_int_equal(plan_from_parts_packed(own, positions, &parts, &plan), CSCD_OK);
    for (int t = 0; t < 3; t++) assert_true(plan->triangle_weights[t] == 1.0);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(own);
}

TEST(bad_options) {
    cscd_plan *plan = NULL;
    cscd_plan_options options = {0};
    assert_int_equal(plan_create_packed(NULL, shape.positions, NULL, &plan), CSCD_NULL_OBJECT);
    assert_int_equal(plan_create_packed(mesh, shape.positions, NULL, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(plan_create_packed(mesh, NULL, NULL, &plan), CSCD_INVALID_ARGUMENT);
    expect_invalid(context, plan_create_packed(mesh, shape.positions, &options, &plan), "cscd_plan_defaults");
    options = cscd_plan_defaults();
    options.method = CSCD_METHOD_NONE;
    assert_int_equal(plan_create_packed(mesh, shape.positions, &options, &plan), CSCD_INVALID_ARGUMENT);
    static const double thresholds[] = {0.0, 1.0, -0.1, 1.5, (double)INFINITY, (double)NAN};
    for (size_t i = 0; i < sizeof thresholds / sizeof *thresholds; i++) {
        options = cscd_plan_defaults();
        options.threshold = thresholds[i];
        expect_invalid(context, plan_create_packed(mesh, shape.positions, &options, &plan), "threshold is");
    }
    options = cscd_plan_defaults();
    options.method = CSCD_METHOD_KMEANS;
    options.k = 0;
    assert_int_equal(plan_create_packed(mesh, shape.positions, &options, &plan), CSCD_INVALID_ARGUMENT);
    options = cscd_plan_defaults();
    options.memory_limit = 1000;
    assert_int_equal(plan_create_packed(mesh, shape.positions, &options, &plan), CSCD_OUT_OF_MEMORY);
    assert_non_null(strstr(cscd_context_detail(context), "GiB"));
    assert_null(plan);
}

TEST(plans_fit_their_mesh) {
    static const uint32_t tetrahedron[12] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    cscd_object_desc desc = cscd_object_of_triangles(4, 4, tetrahedron);
    cscd_mesh *other = NULL;
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    cscd_plan *plan = plan_by(CSCD_METHOD_SINGLE, 0);
    expect_ok(cscd_mesh_create(context, &desc, 1, &other));
    assert_true(cscd_mesh_hash(other) != cscd_mesh_hash(mesh));
    expect_invalid(context, detector_create_here(other, plan, NULL, &detector), "another mesh");
    options.method = CSCD_METHOD_CHARGE;
    assert_int_equal(detector_create_here(mesh, plan, &options, &detector), CSCD_INVALID_ARGUMENT);
    assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_INVALID_ARGUMENT);
    assert_null(detector);
    options.method = CSCD_METHOD_NONE;
    expect_ok(detector_create_here(mesh, plan, &options, &detector));
    cscd_detector_destroy(detector);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(other);
}

AROUND_ALL(make_body, destroy_body)
