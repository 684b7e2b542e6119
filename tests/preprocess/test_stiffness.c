/* Plans of bodies that are soft in places: borders run there, and what lies beyond has a point of its own. */
#include "preprocess/regions/edge_weights.h"
#include "preprocess/regions/stiffness.h"
#include "src/mesh/surface.h"
#include "tests/support/preprocess/region_check.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    capsule = body_of(BODY_CAPSULE, 6000);
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

static stiff_division divide_by_threads(const double *stiffness, uint32_t thread_count) {
    cscd_mesh *mesh = body_mesh(&capsule, thread_count);
    cscd_plan *plan = NULL;
    assert_int_equal(try_plan(mesh, stiffness, &plan), CSCD_OK);
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

static stiff_division divide_capsule(const double *stiffness) {
    return divide_by_threads(stiffness, 1);
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
static void a_soft_place_parts_a_body(void **state) {
    (void)state;
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

static void only_ratios_count(void **state) {
    (void)state;
    static const double factors[] = {3.0, 1e-5, 0x1p-900, 7e200};
    for (size_t i = 0; i < sizeof factors / sizeof *factors; i++) {
        double *scaled = scaled_values(soft, factors[i]);
        expect_same(divide_capsule(soft), divide_capsule(scaled));
        free(scaled);
    }
}

/* As stiff everywhere, or stiffer in one small place, is the same as no stiffness. */
static void nothing_soft_changes_nothing(void **state) {
    (void)state;
    double *values = body_allocate(capsule.triangle_count, sizeof *values);
    for (uint32_t t = 0; t < capsule.triangle_count; t++) values[t] = 0.3;
    expect_same(divide_capsule(NULL), divide_capsule(values));
    for (uint32_t t = 0; t < capsule.triangle_count; t++)
        if (height_of(t) > 1.4) values[t] = 1e6;
    expect_same(divide_capsule(NULL), divide_capsule(values));
    free(values);
}

static void threads_change_nothing(void **state) {
    (void)state;
    for (uint32_t threads = 2; threads <= 3; threads++)
        expect_same(divide_capsule(soft), divide_by_threads(soft, threads));
}

/* An edge weighs its length times the share of the charge or of the stiffness, whichever is less. */
static void edges_weigh_less_where_it_is_soft(void **state) {
    (void)state;
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
        assert_true(fabs(weights[e] - fmin(plain[e], length * share)) <= 1e-12 * length);
    }
    body_mesh_destroy(mesh);
    free(ranks);
    free(softer);
    free(plain);
    free(weights);
}

static void bad_values_are_refused(void **state) {
    (void)state;
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
static void shares_are_of_the_component(void **state) {
    (void)state;
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
    assert_int_equal(stiffness_shares(mesh, two.positions, given, shares), CSCD_OK);
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_soft_place_parts_a_body),         cmocka_unit_test(only_ratios_count),
        cmocka_unit_test(nothing_soft_changes_nothing),      cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(edges_weigh_less_where_it_is_soft), cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(shares_are_of_the_component),
    };
    return cmocka_run_group_tests_name("stiffness", tests, make_capsule, free_capsule);
}
