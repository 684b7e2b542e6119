/* Regions, k-means and detector points: every allocation fails once, nothing leaks or is half written. */
#include "preprocess/regions/kmeans.h"
#include "preprocess/regions/regions.h"
#include "preprocess/regions/visibility.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/models/body_of.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { K = 5 };

typedef enum job { JOB_CHARGE, JOB_SOFT, JOB_KMEANS, JOB_POINTS, JOB_SHARES, JOB_COUNT } job;

static body shape;
static double *density, *stiffness;
static uint32_t *regions;

/* Makes a dumbbell whose density is low at its rod, and which is soft there. */
static int make_shape(void **state) {
    (void)state;
    shape = body_of(BODY_DUMBBELL, 1500);
    density = calloc(shape.triangle_count, sizeof *density);
    regions = calloc(shape.triangle_count, sizeof *regions);
    stiffness = calloc(shape.triangle_count, sizeof *stiffness);
    if (density == NULL || regions == NULL || stiffness == NULL) return -1;
    for (uint32_t t = 0; t < shape.triangle_count; t++) {
        density[t] = fabs(shape.positions[shape.triangles[t * 3] * 3 + 2]);
        stiffness[t] = fmin(1.0, 0.1 + density[t]);
    }
    return 0;
}

static int free_shape(void **state) {
    (void)state;
    body_free(&shape);
    free(density);
    free(stiffness);
    free(regions);
    return 0;
}

static cscd_status divide_shape(const cscd_mesh *mesh, bool is_soft, uint32_t *count) {
    double *points = NULL;
    region_options options = region_options_defaults();
    options.stiffness = is_soft ? stiffness : NULL;
    const cscd_status status =
        regions_from_charge(mesh, shape.positions, density, &options, regions, count, &points);
    assert_true((status == CSCD_OK) == (points != NULL));
    context_free(mesh->context, points);
    return status;
}

static cscd_status run_job(job j, const cscd_mesh *mesh, uint32_t *count, double *out) {
    switch (j) {
    case JOB_CHARGE:
    case JOB_SOFT:
        return divide_shape(mesh, j == JOB_SOFT, count);
    case JOB_KMEANS:
        return regions_kmeans(mesh, shape.positions, K, 1, regions, count, out);
    case JOB_POINTS:
        return detector_points_from_regions(mesh, shape.positions, regions, 1, out);
    default:
        return visible_shares(mesh, shape.positions, regions, 1, out + 3, out);
    }
}

static bool is_untouched(uint32_t count, const double *out) {
    for (uint32_t t = 0; t < shape.triangle_count; t++) {
        if (regions[t] != 0) return false;
    }
    for (int i = 0; i < K * 3; i++) {
        if (out[i] != 7.0) return false;
    }
    return count == 77;
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    for (int j = 0; j < JOB_COUNT; j++) {
        counting_allocator counter = counting_allocator_start();
        cscd_context *context = NULL;
        cscd_mesh *mesh = NULL;
        cscd_context_options options = cscd_context_defaults();
        options.allocator = counting_allocator_interface(&counter);
        cscd_object_desc desc =
            cscd_object_of_triangles(shape.vertex_count, shape.triangle_count, shape.triangles);
        assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
        assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
        size_t bytes = cscd_context_bytes(context), failures = 0;
        cscd_status status = CSCD_OUT_OF_MEMORY;
        for (size_t n = 0; status != CSCD_OK; n++) {
            uint32_t count = 77;
            double out[K * 3];
            for (int i = 0; i < K * 3; i++) out[i] = 7.0;
            memset(regions, 0, shape.triangle_count * sizeof *regions);
            counter.fail_at = counter.calls + n;
            status = run_job((job)j, mesh, &count, out);
            assert_int_equal(cscd_context_bytes(context), bytes);
            if (status == CSCD_OK) break;
            failures++;
            assert_int_equal(status, CSCD_OUT_OF_MEMORY);
            assert_non_null(strstr(cscd_context_detail(context), "out of memory"));
            assert_true(is_untouched(count, out));
        }
        assert_true(failures >= (j < JOB_POINTS ? 15 : 1));
        cscd_mesh_destroy(mesh);
        cscd_context_destroy(context);
        assert_int_equal(counter.live, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_allocation_may_fail)};
    return cmocka_run_group_tests_name("region memory", tests, make_shape, free_shape);
}
