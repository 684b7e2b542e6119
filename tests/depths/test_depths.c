/* Depths: by hand where one sees them, else no less and no more than the distance from a body's outer surface. */
#include "cscd/research.h"
#include "runtime/depths/outer_surface.h"
#include "runtime/detector/detector.h"
#include "src/core/vec3.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

enum { ROUNDS = PACED(20, 3), SAMPLES = PACED(30, 4) };

static body_rig rig; /* large; one test at a time */

static void add_box(double x, double y, double z, double width, double depth, double height) {
    const double low[3] = {x, y, z}, size[3] = {width, depth, height};
    body_rig_box(&rig, low, size);
}

static double deepest_of(uint32_t first, uint32_t end, uint32_t object) {
    double deepest = -1.0;
    for (size_t i = 0; i < rig.found.depths->vertex_count; i++) {
        const cscd_depth *d = &rig.found.depths->items[i];
        if (d->vertex >= first && d->vertex < end && d->body == object) deepest = fmax(deepest, d->depth);
    }
    return deepest;
}

TEST(a_box_sunk_into_a_slab) {
    body_rig_begin(&rig);
    add_box(0, 0, -2, 10, 10, 2);
    add_box(3, 4, -0.125, 1, 1, 1);
    body_rig_find_all(&rig);
    assert_int_equal(rig.found.depths->vertex_count, 4);
    for (size_t i = 0; i < rig.found.depths->vertex_count; i++) {
        const cscd_depth *d = &rig.found.depths->items[i];
        assert_int_equal(d->body, 0);
        assert_true(d->depth == 0.125 && d->direction[0] == 0.0 && d->direction[1] == 0.0 &&
                    d->direction[2] == 1.0);
    }
    assert_int_equal(rig.found.depths->patch_count, 1);
    assert_true(rig.found.depths->items[rig.found.depths->patches[0].deepest].depth == 0.125);
}

/* A corner that is as near to both triangles of a face names the first, whichever the trees show first. */
TEST(the_first_of_equals_is_named) {
    for (int turned = 0; turned < 2; turned++) { /* the numbers of the face's triangles are exchanged */
        size_t found = 0;
        body_rig_begin(&rig);
        add_box(0, 0, 0, 4, 4, 4);
        add_box(1, 1, 0.5, 1, 1, 1);
        for (uint32_t k = 0; k < 3 && turned == 1; k++) {
            uint32_t *first = &rig.bodies[0].triangles[k], *second = first + 3, kept = *first;
            *first = *second;
            *second = kept;
        }
        body_rig_find_all(&rig);
        for (size_t i = 0; i < rig.found.depths->vertex_count; i++) {
            const cscd_depth *d = &rig.found.depths->items[i];
            if (d->x[0] != d->x[1] || d->x[2] != 0.5) continue; /* over the diagonal of the floor */
            assert_true(d->depth == 0.5);
            assert_int_equal(d->triangle, 0);
            found++;
        }
        assert_int_equal(found, 2);
    }
}

/* The edge is deepest a little before its middle, where it comes as near to the ceiling as it has been to the floor. */
TEST(an_edge_is_deepest_beside_its_middle) {
    static const double corners[4][3] = {
        {-1.5, 0, -1.85}, {4.5, 0, 1.95}, {4.5, 0.01, 1.97}, {4.5, -0.02, 1.96}};
    static const uint32_t triangles[12] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    double deepest = 0.0;
    body_rig_begin(&rig);
    add_box(0, -5, -1, 10, 10, 2);
    memcpy(rig.all.x0 + (size_t)rig.all.vertex_count * 3, corners, sizeof corners);
    for (int i = 0; i < 12; i++)
        rig.all.triangles[rig.all.triangle_count * 3 + (uint32_t)i] = rig.all.vertex_count + triangles[i];
    rig.all.vertex_count += 4;
    rig.all.triangle_count += 4;
    body_rig_end_body(&rig);
    body_rig_find_all(&rig);
    for (size_t i = 0; i < rig.found.depths->edge_count; i++)
        deepest = fmax(deepest, rig.found.depths->items[rig.found.depths->vertex_count + i].depth);
    assert_true(deepest > 0.9999 && deepest <= 1.0);
}

/* ---- corners that touch ---------------------------------------------------------------------------------- */

/* A whole number below 2^20 in magnitude, times 8. */
static double whole_number(random_stream *random) {
    return 8.0 * floor(stream_between(random, -0x1p20, 0x1p20));
}

/* A corner that lies on another body's face, or on an edge of it, to the last bit has no depth, whatever rounding makes of the
 * way there; and it lies there by the exact question, too, while its neighbours do not. */
TEST(corners_on_a_surface_have_no_depth) {
    static const uint32_t triangles[12] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    random_stream random = stream_start(12);
    size_t asked = 0;
    for (int round = 0; round < 40 * ROUNDS; round++) {
        const double weights[2][3] = {{0.375, 0.625, 0.0}, {0.25, 0.375, 0.375}};
        body_rig_begin(&rig);
        double *x = rig.all.x0, volume, sides[3][3], normal[3];
        for (int k = 0; k < 12; k++) x[k] = whole_number(&random);
        for (int i = 0; i < 3; i++) vec3_subtract(x + 3 * i + 3, x, sides[i]);
        vec3_cross(sides[0], sides[1], normal);
        volume = vec3_dot(normal, sides[2]);
        for (uint32_t k = 0; k < 24; k++) /* both face outwards */
            rig.all.triangles[k] =
                triangles[k % 12 / 3 * 3 + (volume > 0.0 ? 2 - k % 3 : k % 3)] + k / 12 * 4;
        for (int k = 0; k < 3; k++) {
            double *own = x + 12 + k, middle = 0.25 * (x[k] + x[3 + k] + x[6 + k] + x[9 + k]);
            own[0] = 0.0;
            for (int i = 0; i < 3; i++) own[0] += weights[round % 2][i] * x[3 * i + k];
            for (int i = 1; i < 4; i++) own[3 * i] = middle + 0.0625 * (x[3 * i + k] - x[k]);
        }
        rig.all.vertex_count = rig.all.triangle_count = 4;
        body_rig_end_body(&rig);
        rig.all.vertex_count = rig.all.triangle_count = 8;
        body_rig_end_body(&rig);
        body_rig_find_all(&rig);
        const named_surface surface = {.mesh = rig.mesh, .positions = x};
        for (uint32_t v = 4; v < 8; v++)
            assert_int_equal(body_has_point(&surface, &rig.detector->space.bvh, 0, x + 3 * v), v == 4);
        for (size_t i = 0; i < rig.found.depths->vertex_count; i++) {
            const cscd_depth *d = &rig.found.depths->items[i];
            if (d->vertex != 4) continue;
            assert_true(d->depth == 0.0);
            asked++;
        }
    }
    print_message("  %zu corners\n", asked);
    assert_true(asked > 10 * ROUNDS);
}

/* The long bar goes through the wall; its lower edges are near to the bottom of the wall. */
TEST(a_bar_through_a_wall) {
    body_rig_begin(&rig);
    add_box(-3, 0.1, 0.2, 6, 0.5, 0.25);
    add_box(0.3, -2, 0.1, 0.5, 5, 2);
    body_rig_find_all(&rig);
    double deepest = 0.0;
    assert_int_equal(rig.found.depths->vertex_count, 0);
    assert_true(rig.found.depths->edge_count >= 4);
    for (size_t i = 0; i < rig.found.depths->edge_count; i++) {
        const cscd_depth *d = &rig.found.depths->items[i];
        bool low = fabs(d->x[2] - 0.2) < 1e-12, high = fabs(d->x[2] - 0.45) < 1e-12;
        double truth = low ? 0.1 : 0.25;
        assert_int_equal(d->body, 1);
        assert_int_equal(d->vertex, UINT32_MAX);
        if (low || high) assert_true(fabs(d->depth - truth) < 6e-6);
        deepest = fmax(deepest, d->depth);
    }
    assert_true(fabs(deepest - 0.25) < 6e-6);
}

/* All that is buried under the infinitely small motion has depth 0. */
TEST(a_box_on_a_table) {
    body_rig_begin(&rig);
    add_box(0, 0, -2, 10, 10, 2);
    add_box(3, 4, 0, 1, 1, 1);
    add_box(6, 4, 0, 1, 1, 1);
    body_rig_find_all(&rig);
    assert_true(rig.found.curves->count > 0);
    for (size_t i = 0; i < rig.found.curves->count; i++) assert_true(rig.found.curves->items[i].touching);
    for (size_t i = 0; i < rig.found.depths->count; i++) assert_true(rig.found.depths->items[i].depth == 0.0);
}

/* The octahedron's equator lies in the face of a box: no two triangles cross, but half of it is buried. */
TEST(an_equator_in_a_face) {
    static const double corners[6][3] = {{1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0}, {2, 2, 1}, {2, 2, -1}};
    body_rig_begin(&rig);
    add_box(0, 0, -2, 4, 4, 2);
    uint32_t first = rig.all.vertex_count;
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t up[3] = {first + i, first + (i + 1) % 4, first + 4};
        const uint32_t down[3] = {first + (i + 1) % 4, first + i, first + 5};
        memcpy(rig.all.triangles + (size_t)rig.all.triangle_count++ * 3, up, sizeof up);
        memcpy(rig.all.triangles + (size_t)rig.all.triangle_count++ * 3, down, sizeof down);
    }
    memcpy(rig.all.x0 + (size_t)first * 3, corners, sizeof corners);
    rig.all.vertex_count += 6;
    body_rig_end_body(&rig);
    body_rig_find_all(&rig);
    assert_int_equal(rig.found.curves->count, 1);
    assert_true(rig.found.curves->items[0].closed && !rig.found.curves->items[0].touching);
    assert_int_equal(rig.found.crossing, 0);
    assert_true(fabs(deepest_of(first + 5, first + 6, 0) - 1.0) < 1e-12);
    assert_true(fabs(body_rig_overlap(&rig, 0, 1).volume - 4.0 / 3.0) < 1e-12);
}

/* ---- against all triangles ----------------------------------------------------------------------------- */

static const double *corner_of(uint32_t triangle, uint32_t i) {
    return rig.all.x0 + (size_t)rig.all.triangles[triangle * 3 + i] * 3;
}

TEST(balls_in_rings) {
    static const double origin[3] = {0, 0, 0};
    random_stream random = stream_start(8);
    size_t compared = 0;
    for (int round = 0; round < ROUNDS; round++) {
        double centre[3];
        for (int k = 0; k < 3; k++) centre[k] = stream_between(&random, -1.2, 1.2);
        body_rig_begin(&rig);
        scene_add_torus(&rig.all, origin, 1.0, 0.35, 24, 12, false);
        body_rig_end_body(&rig);
        scene_add_sphere(&rig.all, centre, 0.6, 9, 14);
        body_rig_end_body(&rig);
        body_rig_find_all(&rig);
        for (size_t i = 0; i < rig.found.depths->count; i++) {
            const cscd_depth *d = &rig.found.depths->items[i];
            double there[3];
            for (int k = 0; k < 3; k++) there[k] = d->x[k] + d->depth * d->direction[k];
            assert_true(fabs(d->depth - body_distance(&rig, d->body, d->x)) < 1e-12);
            assert_true(body_distance(&rig, d->body, there) < 1e-12);
            compared++;
        }
    }
    print_message("  %zu depths\n", compared);
    assert_true(compared > 20 * ROUNDS);
}

/* ---- a body in itself ---------------------------------------------------------------------------------- */

/* No sample of the outer surface is nearer than the depth says. */
static void sample_outer_surface(random_stream *random, const cscd_depth *depth) {
    for (uint32_t t = 0; t < rig.bodies[0].triangle_count; t++) {
        double u = stream_between(random, 0, 1), v = stream_between(random, 0, 1), x[3], normal[3];
        const double *a = corner_of(t, 0), *b = corner_of(t, 1), *c = corner_of(t, 2);
        double ab[3], ac[3];
        if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
        vec3_subtract(b, a, ab);
        vec3_subtract(c, a, ac);
        vec3_cross(ab, ac, normal);
        for (int k = 0; k < 3; k++) x[k] = a[k] + u * ab[k] + v * ac[k];
        if (vec3_squared_distance(x, depth->x) >= depth->depth * depth->depth - 1e-9) continue;
        vec3_add_scaled(x, 1e-7 / sqrt(vec3_dot(normal, normal)), normal, x);
        assert_true(body_number(&rig, 0, x) >= 1);
    }
}

TEST(a_snake_in_its_own_tail) {
    random_stream random = stream_start(9);
    body_rig_begin(&rig);
    body_rig_add_snake(&rig);
    body_rig_end_body(&rig);
    body_rig_find_all(&rig);
    assert_true(rig.found.depths->vertex_count > 20);
    for (size_t i = 0; i < rig.found.depths->count; i++) {
        const cscd_depth *d = &rig.found.depths->items[i];
        double beyond[3];
        vec3_add_scaled(d->x, d->depth + 1e-6, d->direction, beyond);
        assert_int_equal(body_number(&rig, 0, beyond), 0);
        for (int k = 0; k < SAMPLES; k++) sample_outer_surface(&random, d);
    }
}

/* Two tips over a ring that goes around twice, the second time nearer: around a tip some triangles are within the body and others
 * are not, so the tip itself is not, whichever of them is the first. */
TEST(tips_of_a_star_that_goes_around_twice) {
    enum { RING = 10 };
    size_t buried = 0;
    for (uint32_t first = 0; first < RING; first++) {
        scene *all = &rig.all;
        body_rig_begin(&rig);
        for (uint32_t i = 0; i < RING + 2; i++, all->vertex_count++) {
            const double angle = 4 * 3.141592653589793 * i / RING, radius = i < RING / 2 ? 1.0 : 0.5;
            const double place[3] = {radius * cos(angle), radius * sin(angle), 0.01 * i};
            const double tip[3] = {0, 0, i == RING ? 1 : -1};
            memcpy(all->x0 + 3 * (size_t)i, i < RING ? place : tip, sizeof place);
        }
        for (uint32_t i = 0; i < RING; i++) {
            const uint32_t a = (first + i) % RING, b = (a + 1) % RING;
            const uint32_t corners[6] = {a, b, RING, b, a, RING + 1};
            memcpy(all->triangles + 6 * (size_t)i, corners, sizeof corners);
            all->triangle_count += 2;
        }
        body_rig_end_body(&rig);
        body_rig_find_all(&rig);
        for (size_t i = 0; i < rig.found.depths->vertex_count; i++)
            assert_true(rig.found.depths->items[i].vertex < RING);
        for (uint32_t k = 2; k < 6; k += 3) {
            const cscd_patch *at = &rig.found.patches->items[rig.found.patches->corner_patches[k]];
            for (uint32_t i = 0; i < at->winding_count; i++)
                buried += rig.found.patches->windings[at->first_winding + i].number >= 1;
        }
    }
    assert_true(buried > 0);
}

AROUND_EACH(NULL, body_rigs_free)
