/* Charge densities: repeatability, degenerate triangles, memory, bad input. */
#include "benchmarks/lib/density_ranks.h"
#include "src/core/system.h"
#include "tests/support/preprocess/charge_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__attribute__((weak)) int openblas_get_num_threads(void);
__attribute__((weak)) void openblas_set_num_threads(int count);

static void assert_near(double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.12g, expected %.12g", value, expected);
}

static void assert_says(const charge_rig *r, const char *words) {
    if (strstr(cscd_context_detail(r->context), words) == NULL)
        fail_msg("\"%s\" does not say \"%s\"", cscd_context_detail(r->context), words);
}

static conductor odd_ellipsoid(int level) {
    const double axes[3] = {1.3, 0.8, 0.45}, offset[3] = {0.2, 0.1, -0.3};
    conductor s = conductor_sphere(level);
    conductor_transform(&s, axes, offset);
    return s;
}

/* ---- repeatability ---- */

/* 320 triangles, or 1,280. */
enum { FINE = NIGHTLY(2, 3) };

/* The ranks by density rounded to 24 bits. */
static uint32_t *rounded_ranks(const charge_rig *r, uint32_t count) {
    double *rounded = malloc(count * sizeof *rounded);
    assert_non_null(rounded);
    for (uint32_t t = 0; t < count; t++) rounded[t] = (float)r->density[t];
    uint32_t *ranks = density_ranks(rounded, count);
    free(rounded);
    return ranks;
}

TEST(repeats_to_the_bit) {
    conductor s = odd_ellipsoid(FINE);
    for (uint32_t threads = 1; threads <= 3; threads++) {
        charge_rig a = charge_rig_solve(&s, threads), b = charge_rig_solve(&s, threads);
        assert_memory_equal(a.density, b.density, s.triangle_count * sizeof *a.density);
        assert_true(a.capacitance[0] == b.capacitance[0]);
        charge_rig_destroy(&a);
        charge_rig_destroy(&b);
    }
    conductor_free(&s);
}

TEST(thread_count_changes_no_rank) {
    conductor s = odd_ellipsoid(FINE);
    charge_rig one = charge_rig_solve(&s, 1);
    uint32_t *expected = rounded_ranks(&one, s.triangle_count);
    for (uint32_t threads = 2; threads <= 4; threads++) {
        charge_rig r = charge_rig_solve(&s, threads);
        uint32_t *ranks = rounded_ranks(&r, s.triangle_count);
        for (uint32_t t = 0; t < s.triangle_count; t++) assert_near(r.density[t], one.density[t], 1e-12);
        assert_memory_equal(ranks, expected, s.triangle_count * sizeof *ranks);
        free(ranks);
        charge_rig_destroy(&r);
    }
    free(expected);
    charge_rig_destroy(&one);
    conductor_free(&s);
}

/* Triangles in another order have the same densities, to the bit. */
TEST(numbering_does_not_matter) {
    conductor s = odd_ellipsoid(2), turned = odd_ellipsoid(2);
    uint32_t n = s.triangle_count;
    for (uint32_t t = 0; t < n; t++)
        memcpy(turned.triangles + t * 3, s.triangles + (t * 7 + 5) % n * 3, 3 * sizeof *s.triangles);
    charge_rig a = charge_rig_solve(&s, 2), b = charge_rig_solve(&turned, 2);
    for (uint32_t t = 0; t < n; t++) assert_true(b.density[t] == a.density[(t * 7 + 5) % n]);
    charge_rig_destroy(&a);
    charge_rig_destroy(&b);
    conductor_free(&s);
    conductor_free(&turned);
}

TEST(puts_the_threads_of_blas_back) {
    conductor s = odd_ellipsoid(1);
    if (openblas_set_num_threads != NULL) openblas_set_num_threads(2); /* one is what a solution takes */
    int before = openblas_get_num_threads != NULL ? openblas_get_num_threads() : 0;
    for (uint32_t threads = 1; threads <= 3; threads++) {
        charge_rig r = charge_rig_solve(&s, threads);
        charge_rig_destroy(&r);
        assert_int_equal(openblas_get_num_threads != NULL ? openblas_get_num_threads() : 0, before);
    }
    conductor_free(&s);
}

/* ---- degenerate triangles ---- */

static conductor with_extra(const conductor *s, const double *positions, uint32_t vertex_count,
                            const uint32_t *triangles, uint32_t triangle_count) {
    conductor r = {s->vertex_count + vertex_count, s->triangle_count + triangle_count, NULL, NULL};
    r.positions = malloc(r.vertex_count * 3 * sizeof *r.positions);
    r.triangles = malloc(r.triangle_count * 3 * sizeof *r.triangles);
    assert_non_null(r.positions);
    assert_non_null(r.triangles);
    memcpy(r.positions, s->positions, s->vertex_count * 3 * sizeof *r.positions);
    memcpy(r.triangles, s->triangles, s->triangle_count * 3 * sizeof *r.triangles);
    if (vertex_count > 0)
        memcpy(r.positions + s->vertex_count * 3, positions, vertex_count * 3 * sizeof *r.positions);
    memcpy(r.triangles + s->triangle_count * 3, triangles, triangle_count * 3 * sizeof *r.triangles);
    return r;
}

TEST(zero_area_triangles_take_no_part) {
    const double middle[3] = {0.25, 0.0, 0.0};
    const uint32_t extra[3] = {0, 4, 1};
    conductor s = conductor_tetrahedron(), more = with_extra(&s, middle, 1, extra, 1);
    charge_rig a = charge_rig_solve(&s, 2), b = charge_rig_solve(&more, 2);
    assert_memory_equal(a.density, b.density, 4 * sizeof *a.density);
    assert_true(b.density[4] == 0.0 && b.capacitance[0] == a.capacitance[0]);
    charge_rig_destroy(&a);
    charge_rig_destroy(&b);
    conductor_free(&s);
    conductor_free(&more);
}

TEST(component_without_area) {
    double positions[12] = {1, 1, 1, 2, 2, 2, 3, 3, 3, 1, 1, 1};
    uint32_t triangles[6] = {0, 1, 2, 3, 0, 1};
    conductor s = {4, 2, positions, triangles};
    charge_rig r = charge_rig_solve(&s, 1);
    assert_true(r.density[0] == 0.0 && r.density[1] == 0.0 && r.capacitance[0] == 0.0);
    charge_rig_destroy(&r);
}

/* A face that is there three times, once inside out: its charge is shared. */
TEST(coincident_triangles_share) {
    const uint32_t extra[6] = {3, 1, 0, 1, 3, 0};
    conductor s = conductor_tetrahedron(), more = with_extra(&s, NULL, 0, extra, 2);
    charge_rig a = charge_rig_solve(&s, 2), b = charge_rig_solve(&more, 2);
    for (int t = 0; t < 6; t++) {
        bool shared = t == 1 || t > 3;
        assert_near(b.density[t], shared ? a.density[1] / 3.0 : a.density[t], 1e-15);
    }
    assert_true(b.capacitance[0] == a.capacitance[0]);
    charge_rig_destroy(&a);
    charge_rig_destroy(&b);
    conductor_free(&s);
    conductor_free(&more);
}

static void assert_refused(const conductor *s, const char *words) {
    charge_rig r = charge_rig_create(s, 2, NULL);
    size_t bytes = cscd_context_describe(r.context).bytes;
    assert_int_equal(charge_solve(r.mesh, s->positions, &by_dense_system, r.density, r.capacitance, NULL),
                     CSCD_INVALID_ARGUMENT);
    assert_says(&r, words);
    assert_true(charge_rig_untouched(&r));
    assert_int_equal(cscd_context_describe(r.context).bytes, bytes);
    charge_rig_destroy(&r);
}

/* Two triangles with one centroid give two equal equations. */
TEST(one_centroid_for_two) {
    double positions[18] = {3, 0, 0, 0, 3, 0, -3, -3, 0, -3, 0, 0, 0, -3, 0, 3, 3, 0};
    uint32_t triangles[9] = {0, 1, 2, 3, 4, 5, 0, 3, 5};
    conductor s = {6, 3, positions, triangles};
    assert_refused(&s, "triangles 0 and 1 of component 0 have the same centroid");
}

/* A face of a tetrahedron and one that almost lies on it: one of the two is named, and none of the others. */
TEST(what_lies_on_another_is_named) {
    const double beside[3] = {0.0, -1e-13, 0.0};
    const uint32_t extra[3] = {4, 1, 3};
    conductor s = conductor_tetrahedron(), more = with_extra(&s, beside, 1, extra, 1);
    charge_rig r = charge_rig_create(&more, 2, NULL);
    assert_int_equal(charge_solve(r.mesh, more.positions, &by_dense_system, r.density, r.capacitance, NULL),
                     CSCD_INVALID_ARGUMENT);
    assert_true(strstr(cscd_context_detail(r.context), "triangle 1:") != NULL ||
                strstr(cscd_context_detail(r.context), "triangle 4:") != NULL);
    charge_rig_destroy(&r);
    conductor_free(&s);
    conductor_free(&more);
}

/* A sheet that lies close to another one is told apart from it while ten digits of its charge are left. */
TEST(sheets_near_each_other) {
    for (int digits = 2; digits <= 14; digits += 4) {
        double h = pow(10.0, -digits);
        double positions[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, h, 1, 0, h, 0, 1, h};
        uint32_t triangles[9] = {0, 1, 2, 3, 4, 5, 0, 1, 4};
        conductor s = {6, 3, positions, triangles};
        if (digits > 8) {
            assert_refused(
                &s, ": some triangles there lie (almost) on each other"); /* which one, rounding decides */
        } else {
            charge_rig r = charge_rig_solve(&s, 1);
            assert_true(r.capacitance[0] > 0.2 && r.capacitance[0] < 0.4);
            charge_rig_destroy(&r);
        }
    }
}

/* The charges of a flat double pyramid are the same above and below. Where rounding hardly tells its sides apart, what is not found to
 * many digits is refused. */
TEST(charges_are_exact_or_refused) {
    uint32_t refused = 0, solved = 0;
    uint32_t triangles[24] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5};
    for (double h = 1e-8; h < 1e-4; h *= 1.1) {
        double positions[18] = {1.1, 0.1,  0, 0.2,  0.9,  0, -1.3, 0.05, 0,
                                0,   -0.8, 0, 0.03, 0.07, h, 0.03, 0.07, -h};
        conductor s = {6, 8, positions, triangles};
        charge_rig r = charge_rig_create(&s, 1, NULL);
        const cscd_status status =
            charge_solve(r.mesh, s.positions, &by_dense_system, r.density, r.capacitance, NULL);
        if (status == CSCD_OK)
            for (int t = 0; t < 4; t++) assert_near(r.density[t + 4], r.density[t], 1e-8 * r.density[t]);
        else
            assert_says(&r, "lie (almost) on each other");
        *(status == CSCD_OK ? &solved : &refused) += 1;
        charge_rig_destroy(&r);
    }
    print_message("%u are solved, %u refused\n", solved, refused);
    assert_true(solved > 40 && refused > 10);
}

/* ---- memory ---- */

/* The default allocator, which remembers the most that was held at a time, and refuses all when told to. */
typedef struct watching_allocator {
    size_t held, most;
    bool refuse;
} watching_allocator;

static void *watching_allocate(void *user, size_t size, size_t alignment) {
    watching_allocator *watcher = user;
    if (watcher->refuse) return NULL;
    watcher->held += size;
    watcher->most = watcher->held > watcher->most ? watcher->held : watcher->most;
    return system_memory(size, alignment);
}

static void watching_free(void *user, void *block, size_t size) {
    ((watching_allocator *)user)->held -= size;
    system_memory_free(block);
}

TEST(takes_what_it_estimates) {
    watching_allocator watcher = {0, 0, false};
    const cscd_allocator allocator = {watching_allocate, watching_free, &watcher};
    conductor s = conductor_cube(2);
    charge_rig r = charge_rig_create(&s, 2, &allocator);
    size_t needed = charge_memory(r.mesh), held = cscd_context_describe(r.context).bytes;
    assert_true(needed > 192 * 192 * 8 && needed < 192 * 192 * 8 + 192 * 1000);
    watcher.held = watcher.most = 0;
    expect_ok(charge_solve(r.mesh, s.positions, &by_dense_system, r.density, r.capacitance, NULL));
    const size_t lists =
        192 * (2 * sizeof(uint32_t) + 2 * sizeof(double)) + 8 * 128; /* with the blocks' headers */
    assert_true(watcher.most >= needed && watcher.most <= needed + lists);
    assert_int_equal(cscd_context_describe(r.context).bytes, held);

    double density = r.density[7];
    for (uint32_t t = 0; t < s.triangle_count; t++) r.density[t] = -1.0;
    r.capacitance[0] = -1.0;
    watcher.refuse = true;
    assert_int_equal(charge_solve(r.mesh, s.positions, &by_dense_system, r.density, r.capacitance, NULL),
                     CSCD_OUT_OF_MEMORY);
    assert_says(&r, "out of memory");
    assert_true(charge_rig_untouched(&r));
    assert_int_equal(cscd_context_describe(r.context).bytes, held);
    watcher.refuse = false;
    expect_ok(charge_solve(r.mesh, s.positions, &by_dense_system, r.density, r.capacitance, NULL));
    assert_true(r.density[7] == density);
    charge_rig_destroy(&r);
    conductor_free(&s);
}

TEST(keeps_to_the_limit) {
    conductor s = conductor_cube(3);
    charge_rig r = charge_rig_create(&s, 2, NULL);
    size_t needed = charge_memory(r.mesh);
    assert_int_equal(charge_solve(r.mesh, s.positions, &(charge_options){CSCD_CHARGE_DENSE, needed - 1},
                                  r.density, r.capacitance, NULL),
                     CSCD_OUT_OF_MEMORY);
    char words[128];
    snprintf(words, sizeof words, "a component of 768 triangles takes %.4g GiB of memory",
             (double)needed / 0x1p30);
    assert_says(&r, words);
    assert_true(charge_rig_untouched(&r));
    expect_ok(charge_solve(r.mesh, s.positions, &(charge_options){CSCD_CHARGE_DENSE, needed}, r.density,
                           r.capacitance, NULL));
    charge_rig_destroy(&r);
    conductor_free(&s);
}

/* A fan of 500,000 triangles: 2 TB. */
TEST(what_does_not_fit_is_refused) {
    enum { COUNT = 500000 };
    conductor s = {COUNT + 2, COUNT, calloc((COUNT + 2) * 3, sizeof(double)),
                   malloc(COUNT * 3 * sizeof(uint32_t))};
    assert_non_null(s.positions);
    assert_non_null(s.triangles);
    for (uint32_t t = 0; t < COUNT; t++) {
        const uint32_t triangle[3] = {0, t + 1, t + 2};
        memcpy(s.triangles + t * 3, triangle, sizeof triangle);
    }
    charge_rig r = charge_rig_create(&s, 1, NULL);
    assert_int_equal(charge_solve(r.mesh, s.positions, &by_dense_system, r.density, r.capacitance, NULL),
                     CSCD_OUT_OF_MEMORY);
    assert_says(&r, "a component of 500000 triangles takes 1863 GiB");
    assert_true(charge_rig_untouched(&r));
    charge_rig_destroy(&r);
    conductor_free(&s);
}

/* ---- bad input ---- */

TEST(bad_arguments) {
    conductor s = conductor_tetrahedron();
    charge_rig r = charge_rig_create(&s, 1, NULL);
    charge_report report = {.timings = {-1.0, -1.0, -1.0, -1.0}};
    assert_int_equal(charge_solve(NULL, s.positions, &by_dense_system, r.density, r.capacitance, NULL),
                     CSCD_INVALID_ARGUMENT);
    assert_int_equal(charge_solve(r.mesh, NULL, &by_dense_system, r.density, r.capacitance, NULL),
                     CSCD_INVALID_ARGUMENT);
    assert_says(&r, "NULL");
    assert_int_equal(charge_solve(r.mesh, s.positions, &by_dense_system, NULL, r.capacitance, NULL),
                     CSCD_INVALID_ARGUMENT);
    assert_int_equal(charge_solve(r.mesh, s.positions, &by_dense_system, r.density, NULL, NULL),
                     CSCD_INVALID_ARGUMENT);
    s.positions[7] = NAN;
    assert_int_equal(charge_solve(r.mesh, s.positions, &by_dense_system, r.density, r.capacitance, &report),
                     CSCD_INVALID_ARGUMENT);
    assert_says(&r, "vertex 2");
    assert_true(charge_rig_untouched(&r) && report.timings.total_ms == -1.0);
    s.positions[7] = 1.0;
    expect_ok(charge_solve(r.mesh, s.positions, &by_dense_system, r.density, r.capacitance, &report));
    const charge_timings timings = report.timings;
    assert_true(timings.assembly_ms >= 0.0 && timings.factor_ms >= 0.0 && timings.refine_ms >= 0.0);
    assert_true(timings.total_ms >= timings.assembly_ms + timings.factor_ms + timings.refine_ms);
    charge_rig_destroy(&r);
    conductor_free(&s);
}
