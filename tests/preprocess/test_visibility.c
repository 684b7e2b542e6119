/* Detector points are centroids of the surface; the visible share is what faces them from inside. */
#include "preprocess/regions/regions.h"
#include "tests/support/models/bodies.h"
#include "tests/support/preprocess/tiled_body.h"
#include "tests/support/test.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static uint32_t no_regions[100000]; /* all in region 0 */

static void add_torus(body *b, double major, double minor, uint32_t rings, uint32_t segments) {
    for (uint32_t i = 0; i < rings; i++) {
        for (uint32_t j = 0; j < segments; j++) {
            double around = 2.0 * pi * i / rings, across = 2.0 * pi * j / segments;
            double reach = major + minor * cos(across);
            body_add_vertex(b, reach * cos(around), reach * sin(around), minor * sin(across));
        }
    }
    for (uint32_t i = 0; i < rings; i++) {
        for (uint32_t j = 0; j < segments; j++) {
            uint32_t row = i * segments, next = (i + 1) % rings * segments, k = (j + 1) % segments;
            body_add_triangle(b, row + j, next + j, next + k);
            body_add_triangle(b, row + j, next + k, row + k);
        }
    }
}

/* The centre sees the outer side, where cos(across) > -minor / major. */
TEST(share_in_torus) {
    const double minor[3] = {0.2, 0.5, 0.8};
    for (int i = 0; i < 3; i++) {
        body b = {0};
        add_torus(&b, 1.0, minor[i], 128, 128);
        cscd_mesh *mesh = body_mesh(&b, 1);
        double point[3], share[1], angle = acos(-minor[i]);
        double expected = (angle + minor[i] * sin(angle)) / pi;
        expect_ok(detector_points_from_regions(mesh, b.positions, no_regions, 1, point));
        for (int k = 0; k < 3; k++) assert_true(fabs(point[k]) < 1e-12);
        expect_ok(visible_shares(mesh, b.positions, no_regions, 1, point, share));
        assert_true(fabs(share[0] - expected) < 0.02);
        assert_true(share[0] == visible_share(mesh, b.positions, no_regions, point));
        for (uint32_t t = 0; t < b.triangle_count; t++) { /* inside out: the inner side's share */
            uint32_t swap = mesh->triangles[t][0];
            mesh->triangles[t][0] = mesh->triangles[t][1];
            mesh->triangles[t][1] = swap;
        }
        assert_true(fabs(visible_share(mesh, b.positions, no_regions, point) - (1.0 - expected)) < 0.02);
        body_mesh_destroy(mesh);
        body_free(&b);
    }
}

/* Areas count and not triangles, which a box with one finely divided side shows. */
TEST(weighted_by_area) {
    body b = {0};
    for (uint32_t i = 0; i < 8; i++) body_add_vertex(&b, i & 1, i >> 1 & 1, i >> 2);
    const uint32_t quads[5][4] = {{0, 2, 3, 1}, {0, 1, 5, 4}, {0, 4, 6, 2}, {1, 3, 7, 5}, {2, 6, 7, 3}};
    for (int i = 0; i < 5; i++) {
        body_add_triangle(&b, quads[i][0], quads[i][1], quads[i][2]);
        body_add_triangle(&b, quads[i][0], quads[i][2], quads[i][3]);
    }
    uint32_t last = 4;
    for (uint32_t i = 1; i <= 50; i++) { /* the top, as a fan that gets finer */
        uint32_t next = i == 50 ? 5 : body_add_vertex(&b, i / 50.0, 0.0, 1.0);
        body_add_triangle(&b, last, next, 7);
        last = next;
    }
    body_add_triangle(&b, 4, 7, 6);
    cscd_mesh *mesh = body_mesh(&b, 1);
    double point[3], share[1];
    expect_ok(detector_points_from_regions(mesh, b.positions, no_regions, 1, point));
    for (int k = 0; k < 3; k++) assert_true(fabs(point[k] - 0.5) < 1e-14);
    expect_ok(visible_shares(mesh, b.positions, no_regions, 1, point, share));
    assert_true(share[0] == 1.0);
    const double above[3] = {0.5, 0.5, 1.5};
    expect_ok(visible_shares(mesh, b.positions, no_regions, 1, above, share));
    assert_true(fabs(share[0] - 5.0 / 6.0) < 1e-14);
    body_mesh_destroy(mesh);
    body_free(&b);
}

/* Two tetrahedra, one seen whole and one from outside; then without any area. */
TEST(regions_on_their_own) {
    body b = {0}, other = {0};
    for (uint32_t i = 0; i < 4; i++) body_add_vertex(&other, i == 1, i == 2, i == 3);
    const uint32_t corners[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (int i = 0; i < 4; i++) body_add_triangle(&other, corners[i][0], corners[i][1], corners[i][2]);
    body_append(&b, &other, (double[3]){0, 0, 0});
    body_append(&b, &other, (double[3]){9, 0, 0});
    cscd_mesh *mesh = body_mesh(&b, 1);
    const uint32_t regions[8] = {0, 0, 0, 0, 1, 1, 1, 1};
    double points[6], shares[2], large = sqrt(0.75) / (1.5 + sqrt(0.75));
    expect_ok(detector_points_from_regions(mesh, b.positions, regions, 2, points));
    assert_true(points[0] > 0.0 && points[0] < 0.5 && fabs(points[3] - 9.0 - points[0]) < 1e-14);
    for (int k = 0; k < 3; k++) points[3 + k] = k == 0 ? 19.0 : 10.0; /* beyond the large face */
    expect_ok(visible_shares(mesh, b.positions, regions, 2, points, shares));
    assert_true(shares[0] == 1.0 && fabs(shares[1] - (1.0 - large)) < 1e-14);
    points[0] = points[1] = 0.25; /* in the plane of a face, which is seen edge-on */
    points[2] = 0.0;
    assert_int_equal(visible_shares(mesh, b.positions, regions, 2, points, shares), CSCD_OK);
    assert_true(fabs(shares[0] - (1.0 - 0.5 / (1.5 + sqrt(0.75)))) < 1e-14);
    for (uint32_t i = 0; i < 24; i++) b.positions[i] = i % 3 == 0 ? 4.0 : 5.0;
    expect_ok(detector_points_from_regions(mesh, b.positions, regions, 2, points));
    expect_ok(visible_shares(mesh, b.positions, regions, 2, points, shares));
    assert_true(points[0] == 4.0 && points[4] == 5.0 && shares[0] == 0.0 && shares[1] == 0.0);
    assert_true(visible_share(mesh, b.positions, regions, points) == 0.0);
    body_mesh_destroy(mesh);
    body_free(&other);
    body_free(&b);
}
