/* The bodies of models/shapes have exact counts, are closed, oriented and embedded, have triangles of
 * similar size, and have the intended shape. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* The expected result; a volume of 0 has no formula. */
static const struct expectation {
    uint32_t components;
    int64_t euler; /* of each component */
    double volume, least_angle;
} expected[BODY_KIND_COUNT] = {
    [BODY_PAWN] = {1, 2, 0.0, 30.0},
    [BODY_DUMBBELL] = {1, 2, 0.0, 30.0},
    [BODY_FIGURE] = {1, 2, 0.0, 20.0},
    [BODY_SPHERE] = {1, 2, 4.0 / 3.0 * 3.14159265358979, 30.0},
    [BODY_ELLIPSOID] = {1, 2, 4.0 / 3.0 * 3.14159265358979 * 1.5 * 0.7, 20.0},
    [BODY_CUBE] = {1, 2, 8.0, 44.9},
    [BODY_TORUS] = {1, 0, 2.0 * 9.8696044 * 0.35 * 0.35, 30.0},
    [BODY_GENUS2] = {1, -2, 0.0, 20.0},
    [BODY_CAPSULE] = {1, 2, 3.14159265358979 * (0.25 * 2.0 + 4.0 / 3.0 * 0.125), 30.0},
    [BODY_COIL] = {1, 2, 0.0, 30.0},
    [BODY_SLAB] = {1, 2, 0.0, 15.0},
    [BODY_CHAIN] = {5, 0, 5.0 * 2.0 * 9.8696044 * 0.22 * 0.22, 30.0},
    [BODY_HAND] = {1, 2, 0.0, 20.0},
    [BODY_OCTOPUS] = {1, 2, 0.0, 20.0},
    [BODY_LETTER_T] = {1, 2, 0.0, 30.0},
    [BODY_LETTER_U] = {1, 2, 0.0, 30.0},
    [BODY_LETTER_V] = {1, 2, 0.0, 30.0},
    [BODY_LETTER_W] = {1, 2, 0.0, 30.0},
};

static cscd_context *context;

static int make_context(void **state) {
    (void)state;
    return cscd_context_create(NULL, &context) == CSCD_OK ? 0 : -1;
}

static int destroy_context(void **state) {
    (void)state;
    cscd_context_destroy(context);
    return 0;
}

/* Returns the volume that one component encloses, above 0 where it is counter-clockwise from outside. */
static double component_volume(const body *b, const cscd_mesh *mesh, uint32_t component) {
    body part = {b->vertex_count, 0, b->vertex_count, 0, b->positions, NULL};
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const uint32_t *v = b->triangles + (size_t)t * 3;
        if (cscd_mesh_triangle_component(mesh, t) == component) body_add_triangle(&part, v[0], v[1], v[2]);
    }
    double volume = body_volume(&part);
    free(part.triangles);
    return volume;
}

static void check_embedded(const body *b, const cscd_mesh *mesh) {
    cscd_detector *detector;
    cscd_intersections found;
    assert_int_equal(detector_create_here(mesh, NULL, NULL, &detector), CSCD_OK);
    assert_int_equal(check_packed(detector, b->positions, &found), CSCD_OK);
    assert_int_equal(found.count, 0);
    assert_int_equal(found.zero_area_triangles, 0);
    cscd_detector_destroy(detector);
}

static void check_body(body_kind kind, const body *b) {
    const struct expectation *e = &expected[kind];
    cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    cscd_mesh *mesh;
    uint32_t vertices = 0;
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(cscd_mesh_component_count(mesh), e->components);
    for (uint32_t c = 0; c < e->components; c++) {
        cscd_component component = cscd_mesh_component(mesh, c);
        assert_true(component.closed_manifold);
        assert_int_equal(component.euler_characteristic, e->euler);
        assert_true(component_volume(b, mesh, c) > 0.0);
        vertices += component.vertex_count;
    }
    assert_int_equal(vertices, b->vertex_count);
    check_embedded(b, mesh);
    cscd_mesh_destroy(mesh);
    for (size_t i = 0; i < (size_t)b->vertex_count * 3; i++) {
        volatile float single = (float)b->positions[i];
        assert_true((double)single == b->positions[i]);
    }
}

/* Computes the largest area over the mean, and the longest edge over the shortest. */
static void find_unevenness(const body *b, double *areas, double *lengths) {
    double sum = 0.0, most = 0.0, longest = 0.0, shortest = INFINITY;
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const uint32_t *v = b->triangles + (size_t)t * 3;
        double edge[3], half = 0.0;
        for (uint32_t k = 0; k < 3; k++) {
            const double *p = b->positions + (size_t)v[k] * 3, *q = b->positions + (size_t)v[(k + 1) % 3] * 3;
            edge[k] = hypot(hypot(q[0] - p[0], q[1] - p[1]), q[2] - p[2]);
            half += 0.5 * edge[k];
            longest = fmax(longest, edge[k]);
            shortest = fmin(shortest, edge[k]);
        }
        double area = sqrt(half * (half - edge[0]) * (half - edge[1]) * (half - edge[2]));
        sum += area;
        most = fmax(most, area);
    }
    *areas = most / (sum / b->triangle_count);
    *lengths = longest / shortest;
}

TEST(the_three_bodies) {
    const uint32_t counts[] = {5130, 1710, 4014};
    for (int i = 0; i < 3; i++) {
        body b = body_of((body_kind)i, 0);
        double areas, lengths;
        assert_int_equal(b.triangle_count, counts[i]);
        assert_int_equal(b.vertex_count, counts[i] / 2 + 2);
        check_body((body_kind)i, &b);
        find_unevenness(&b, &areas, &lengths);
        print_message(
            "  %s: least angle %.1f degrees, largest area %.2f of the mean, longest edge %.2f of the "
            "shortest\n",
            body_kind_name((body_kind)i), body_least_angle(&b), areas, lengths);
        assert_true(body_least_angle(&b) >= 30.0 && areas <= 2.1 && lengths <= 2.8);
        body_free(&b);
    }
}

static void check_repeatable(body_kind kind, const body *b) {
    body again = body_of(kind, b->triangle_count);
    assert_int_equal(again.vertex_count, b->vertex_count);
    assert_memory_equal(again.positions, b->positions, (size_t)b->vertex_count * 3 * sizeof(double));
    assert_memory_equal(again.triangles, b->triangles, (size_t)b->triangle_count * 3 * sizeof(uint32_t));
    body_free(&again);
}

TEST(all_bodies_at_several_counts) {
    const uint32_t wanted[] = {0, 700, 1498};
    for (int kind = 0; kind < BODY_KIND_COUNT; kind++) {
        uint32_t last = 0;
        for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
            uint32_t count = body_nearest_count((body_kind)kind, wanted[i]);
            if (count == last) continue;
            body b = body_of((body_kind)kind, count);
            assert_int_equal(b.triangle_count, count);
            assert_true(body_least_angle(&b) >= expected[kind].least_angle);
            check_body((body_kind)kind, &b);
            if (i == 1) check_repeatable((body_kind)kind, &b);
            body_free(&b);
            last = count;
        }
    }
}

static void find_extent(const body *b, double low[3], double high[3]) {
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
    for (size_t i = 0; i < (size_t)b->vertex_count * 3; i++) {
        low[i % 3] = fmin(low[i % 3], b->positions[i]);
        high[i % 3] = fmax(high[i % 3], b->positions[i]);
    }
}

/* When the count grows to four times as many, the volume is near the intended one, the body stays in place, and no triangle is thin. */
TEST(refinement_keeps_the_shape) {
    for (int i = 0; i < BODY_KIND_COUNT; i++) {
        body_kind kind = (body_kind)i;
        const bool fine =
            kind == BODY_COIL || kind == BODY_CHAIN || kind == BODY_HAND || kind == BODY_OCTOPUS;
        double volumes[2], low[2][3], high[2][3];
        for (uint32_t level = 0; level < 2; level++) {
            body b = body_of(kind, body_nearest_count(kind, (fine ? 4000u : 1000u) << (2 * level)));
            volumes[level] = body_volume(&b);
            find_extent(&b, low[level], high[level]);
            assert_true(body_least_angle(&b) >= expected[i].least_angle);
            body_free(&b);
        }
        assert_true(fabs(volumes[1] - volumes[0]) < 0.08 * volumes[1]);
        if (expected[i].volume > 0.0)
            assert_true(fabs(volumes[1] - expected[i].volume) < 0.02 * expected[i].volume);
        for (int k = 0; k < 3; k++) {
            double tolerance = 0.04 * (high[1][k] - low[1][k]);
            assert_true(fabs(low[0][k] - low[1][k]) < tolerance);
            assert_true(fabs(high[0][k] - high[1][k]) < tolerance);
        }
    }
}

static void unit_normal(const body *b, uint32_t triangle, double normal[3]) {
    const uint32_t *v = b->triangles + (size_t)triangle * 3;
    const double *p = b->positions + (size_t)v[0] * 3, *q = b->positions + (size_t)v[1] * 3;
    const double *r = b->positions + (size_t)v[2] * 3;
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3, m = (k + 2) % 3;
        normal[k] = (q[l] - p[l]) * (r[m] - p[m]) - (q[m] - p[m]) * (r[l] - p[l]);
    }
    double length = hypot(hypot(normal[0], normal[1]), normal[2]);
    for (int k = 0; k < 3; k++) normal[k] /= length;
}

/* Returns the largest angle in degrees between the normals of two triangles with a common edge. */
static double sharpest_fold(const body *b) {
    cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    double least = 1.0;
    cscd_mesh *mesh;
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    for (uint32_t e = 0; e < cscd_mesh_edge_count(mesh); e++) {
        uint32_t count;
        const uint32_t *sides = cscd_mesh_edge_triangles(mesh, e, &count);
        double m[3], n[3];
        unit_normal(b, sides[0], m);
        unit_normal(b, sides[1], n);
        least = fmin(least, m[0] * n[0] + m[1] * n[1] + m[2] * n[2]);
    }
    cscd_mesh_destroy(mesh);
    return acos(fmax(least, -1.0)) * 180.0 / pi;
}

/* Where fingers nearly touch, coarse nets are refined, and the surface is round, without an edge that would fold its triangles. */
TEST(fine_limbs_are_round_where_they_meet) {
    body b = body_of(BODY_HAND, 64002);
    assert_true(body_least_angle(&b) >= 30.0 && sharpest_fold(&b) < 80.0);
    check_body(BODY_HAND, &b);
    body_free(&b);
}

/* Volumes by the theorem of Pappus: the axis of the tube and the middle of the slab run through the
 * centres of their sections. */
TEST(bent_bodies_have_the_volume_of_straight_ones) {
    double length = 5.0 * hypot(2.0 * pi, 0.7), tube = pi * 0.04 * length + 4.0 / 3.0 * pi * 0.008;
    double sheet = 1.6 * 0.16 * (6.0 + 2.0 * pi * 0.2);
    body coil = body_of(BODY_COIL, 40000), slab = body_of(BODY_SLAB, body_nearest_count(BODY_SLAB, 40000));
    assert_true(fabs(body_volume(&coil) - tube) < 0.01 * tube);
    assert_true(fabs(body_volume(&slab) - sheet) < 0.01 * sheet);
    body_free(&coil);
    body_free(&slab);
}

/* Each ring of the chain lies across its neighbours, and its tube passes through their holes. */
TEST(links_are_linked) {
    body b = body_of(BODY_CHAIN, 1000);
    double middles[5];
    for (uint32_t i = 0; i < 5; i++) {
        body link = {100, 0, 0, 0, b.positions + (size_t)i * 300, NULL};
        double low[3], high[3];
        find_extent(&link, low, high);
        middles[i] = 0.5 * (low[0] + high[0]);
        uint32_t across = i % 2 == 0 ? 2 : 1;
        assert_true(high[across] - low[across] < 0.45 && high[0] - low[0] > 2.3);
        double apart = i > 0 ? middles[i] - middles[i - 1] : 1.35;
        assert_true(apart > 0.44 && apart < 1.56);
    }
    body_free(&b);
}

TEST(refusals_name_the_nearest) {
    static const struct refusal {
        body_kind kind;
        uint32_t count;
        const char *text;
    } refused[] = {
        {BODY_PAWN, 5131, "5130 or 5132"},       {BODY_PAWN, 10, "from 300 to"},
        {BODY_FIGURE, 4015, "4014 or 4016"},     {BODY_FIGURE, 998, "from 1000 to"},
        {BODY_CUBE, 1300, "1200 or 1452"},       {BODY_CUBE, 4, "from 12 to"},
        {BODY_SPHERE, 4000002, "to 4000000"},    {BODY_SPHERE, UINT32_MAX, "to 4000000"},
        {BODY_CUBE, 4000000, "3995148 at most"}, {BODY_SLAB, 1001, "988 or 1020"},
    };
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        body b = {.vertex_count = 77};
        io_error error;
        assert_false(body_make(refused[i].kind, refused[i].count, &b, &error));
        if (strstr(error.text, refused[i].text) == NULL) fail_msg("%s", error.text);
        assert_non_null(strstr(error.text, body_kind_name(refused[i].kind)));
        assert_true(b.vertex_count == 77 && b.positions == NULL);
    }
}

TEST(names_lead_to_their_bodies) {
    body_kind kind = BODY_TORUS;
    for (int i = 0; i < BODY_KIND_COUNT; i++) {
        assert_true(body_kind_from_name(body_kind_name((body_kind)i), &kind) && kind == (body_kind)i);
        assert_true(strlen(body_kind_description((body_kind)i)) > 0);
        uint32_t standard = body_default_count((body_kind)i), least = body_least_count((body_kind)i);
        assert_true(standard == body_nearest_count((body_kind)i, standard) && least <= standard);
        assert_true(least == body_nearest_count((body_kind)i, least));
    }
    kind = BODY_TORUS;
    assert_false(body_kind_from_name("knight", &kind));
    assert_true(kind == BODY_TORUS);
}

AROUND_ALL(make_context, destroy_context)
