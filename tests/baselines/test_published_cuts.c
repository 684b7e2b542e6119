/* The cuts of the thesis, step by step, on cans: bins, clusters, a ring that splits, a cluster that shrinks to cutting triangles, two
 * contours of unequal length. */
#include "preprocess/baselines/baselines.h"
#include "preprocess/baselines/published_cuts.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 8, COLUMNS = 12, ROW_TRIANGLES = 2 * COLUMNS, TRIANGLES = (ROWS + 1) * ROW_TRIANGLES };

/* A closed can about z: rows of quads, a fan at either end, radius[i] at the height i. */
typedef struct can {
    body shape;
    cscd_mesh *mesh;
    double equalized[TRIANGLES];
    bool cutting[TRIANGLES];
    uint32_t regions[TRIANGLES], region_count;
} can;

static can c;

static void open_can(const double radius[ROWS + 1]) {
    memset(&c, 0, sizeof c);
    for (int i = 0; i <= ROWS; i++) {
        for (int j = 0; j < COLUMNS; j++) {
            const double angle = 2.0 * 3.14159265358979 * j / COLUMNS;
            body_add_vertex(&c.shape, radius[i] * cos(angle), radius[i] * sin(angle), i);
        }
    }
    body_add_vertex(&c.shape, 0, 0, 0);
    body_add_vertex(&c.shape, 0, 0, ROWS);
    const uint32_t low = (ROWS + 1) * COLUMNS, high = low + 1;
    for (uint32_t i = 0; i < ROWS; i++) {
        for (uint32_t j = 0; j < COLUMNS; j++) {
            const uint32_t a = i * COLUMNS + j, b = i * COLUMNS + (j + 1) % COLUMNS;
            body_add_triangle(&c.shape, a, b, b + COLUMNS);
            body_add_triangle(&c.shape, a, b + COLUMNS, a + COLUMNS);
        }
    }
    for (uint32_t j = 0; j < COLUMNS; j++) body_add_triangle(&c.shape, low, (j + 1) % COLUMNS, j);
    for (uint32_t j = 0; j < COLUMNS; j++)
        body_add_triangle(&c.shape, high, ROWS * COLUMNS + j, ROWS * COLUMNS + (j + 1) % COLUMNS);
    c.mesh = body_mesh(&c.shape, 1);
    assert_true(c.mesh->triangle_count == TRIANGLES && c.mesh->components[0].closed_manifold);
    for (int t = 0; t < TRIANGLES; t++) c.equalized[t] = 1.0;
}

static void open_plain_can(void) {
    double radius[ROWS + 1];
    for (int i = 0; i <= ROWS; i++) radius[i] = 2.0;
    open_can(radius);
}

static void close_can(void) {
    body_mesh_destroy(c.mesh);
    body_free(&c.shape);
}

/* Makes triangles of the columns [from, to) of a row low. */
static void lower_row(uint32_t row, uint32_t from, uint32_t to) {
    for (uint32_t j = 2 * from; j < 2 * to; j++) c.equalized[row * ROW_TRIANGLES + j] = 0.05;
}

static void cut_can(double growing) {
    const published_trace trace = {.cutting = c.cutting};
    const size_t bytes = cscd_context_describe(c.mesh->context).bytes;
    memset(c.cutting, 0, sizeof c.cutting);
    expect_ok(published_cuts(c.mesh, c.shape.positions, c.equalized, (published_thresholds){0.1, growing},
                             &trace, c.regions, &c.region_count));
    assert_int_equal(cscd_context_describe(c.mesh->context).bytes, bytes);
    check_regions(c.mesh, c.regions, c.region_count);
}

/* The height at which an edge of the border between two regions lies; all of it has one. */
static double height_of_border(void) {
    double height = -1.0;
    for (uint32_t e = 0; e < c.mesh->edge_count; e++) {
        const uint32_t *star = c.mesh->edge_stars + c.mesh->edge_star_offsets[e], *ends = c.mesh->edges[e];
        if (c.regions[star[0]] == c.regions[star[1]]) continue;
        for (int k = 0; k < 2; k++) {
            const double z = c.shape.positions[ends[k] * 3 + 2];
            assert_true(height < 0.0 || height == z);
            height = z;
        }
    }
    return height;
}

/* ---- equalization -------------------------------------------------------------------------------------- */

/* Counts equation 3.18 naively. */
TEST(bins) {
    double density[TRIANGLES], found[TRIANGLES];
    open_plain_can();
    for (uint32_t i = 0; i < TRIANGLES; i++) density[i] = random_integer(-20, 300);
    density[7] = -20.0;
    density[70] = 300.0;
    density[71] = 299.0; /* the last bin has others than the highest */
    expect_ok(published_equalize(c.mesh, density, found));
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        double bin = fmin(floor((density[i] + 20.0) / 320.0 * 256.0), 255.0), below = 0.0;
        for (uint32_t j = 0; j < TRIANGLES; j++)
            below += fmin(floor((density[j] + 20.0) / 320.0 * 256.0), 255.0) <= bin;
        assert_true(found[i] == below / TRIANGLES);
    }
    for (uint32_t i = 0; i < TRIANGLES; i++) density[i] = 5.0;
    expect_ok(published_equalize(c.mesh, density, found));
    for (uint32_t i = 0; i < TRIANGLES; i++) assert_true(found[i] == 1.0);
    density[3] = -1.7e308;
    density[4] = 1.7e308;
    expect_ok(published_equalize(c.mesh, density, found));
    assert_true(found[3] == 1.0 / TRIANGLES && found[4] == 1.0);
    assert_true(found[5] == (TRIANGLES - 1.0) / TRIANGLES);
    density[2] = NAN;
    found[0] = 7.0;
    expect_invalid(c.mesh->context, published_equalize(c.mesh, density, found), "triangle 2");
    assert_true(found[0] == 7.0);
    close_can();
}

/* What is as high as the threshold is not below it; triangles that meet at a vertex only are apart. */
TEST(clusters_are_below_the_threshold) {
    clusters found;
    open_plain_can();
    lower_row(2, 3, 5);
    c.equalized[2 * ROW_TRIANGLES + 20] = 0.1;
    c.equalized[0] = c.equalized[2] = 0.05; /* with a vertex in common, but no edge */
    expect_ok(clusters_find(c.mesh, c.equalized, 0.1, &found));
    assert_int_equal(found.count, 3);
    assert_true(found.offsets[1] == 1 && found.offsets[2] == 2 && found.offsets[3] == 6);
    assert_int_equal(found.triangles[found.offsets[2]], 2 * ROW_TRIANGLES + 6);
    clusters_free(c.mesh, &found);
    c.mesh->obstacles = (bool[]){true}; /* an obstacle is not cut */
    expect_ok(clusters_find(c.mesh, c.equalized, 0.1, &found));
    assert_int_equal(found.count, 0);
    c.mesh->obstacles = NULL;
    clusters_free(c.mesh, &found);
    c.mesh->components[0].closed_manifold = false; /* nor is what is open */
    expect_ok(clusters_find(c.mesh, c.equalized, 0.1, &found));
    assert_int_equal(found.count, 0);
    c.mesh->components[0].closed_manifold = true;
    clusters_free(c.mesh, &found);
    close_can();
}

/* ---- one cluster --------------------------------------------------------------------------------------- */

static cutting_list list_of(uint32_t row, uint32_t from, uint32_t to) {
    cutting_list list;
    uint32_t cluster[ROW_TRIANGLES], count = 0;
    for (uint32_t j = 2 * from; j < 2 * to; j++) cluster[count++] = row * ROW_TRIANGLES + j;
    expect_ok(cutting_list_create(c.mesh, &list));
    cutting_list_begin(&list, cluster, count);
    return list;
}

/* A patch has one contour; it grows until its ring lies on two sides, and then has two. */
TEST(a_ring_splits) {
    open_plain_can();
    cutting_list list = list_of(3, 2, 8);
    cutting_list_trace(&list);
    assert_int_equal(list.contour_count, 1);
    assert_true(cutting_list_grow(&list));
    for (uint32_t j = 0; j < ROW_TRIANGLES; j++) assert_true(list.listed[3 * ROW_TRIANGLES + j]);
    for (uint32_t i = 0; i < list.count; i++) {
        const uint32_t row = list.triangles[i] / ROW_TRIANGLES;
        assert_true(row <= 6);
    }
    cutting_list_trace(&list);
    assert_int_equal(list.contour_count, 2);
    cutting_list_destroy(&list);
    close_can();
}

/* Around one end of the can no ring ever splits, and nothing is cut. */
TEST(no_ring_splits_at_a_tip) {
    open_plain_can();
    cutting_list list = list_of(ROWS, 0, COLUMNS / 2); /* the lower fan */
    assert_false(cutting_list_grow(&list));
    assert_int_equal(list.count, TRIANGLES);
    cutting_list_destroy(&list);
    for (uint32_t j = 0; j < COLUMNS; j++) c.equalized[ROWS * ROW_TRIANGLES + j] = 0.05;
    cut_can(0.0);
    assert_int_equal(c.region_count, 1);
    close_can();
}

/* Nobody but those on two contours stays, and they go once around. */
TEST(a_cluster_shrinks_to_cutting_triangles) {
    open_plain_can();
    for (uint32_t row = 2; row < 5; row++) lower_row(row, 0, COLUMNS);
    cut_can(0.1);
    assert_int_equal(c.region_count, 2);
    uint32_t count = 0;
    double turned = 0.0;
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        if (!c.cutting[t]) continue;
        count++;
        assert_true(t / ROW_TRIANGLES >= 2 && t / ROW_TRIANGLES < 5);
        double least = INFINITY, most = -INFINITY;
        const double *first = c.shape.positions + c.shape.triangles[t * 3] * 3;
        for (int k = 0; k < 3; k++) { /* angles from the first corner */
            const double *p = c.shape.positions + c.shape.triangles[t * 3 + (uint32_t)k] * 3;
            const double angle = atan2(first[0] * p[1] - first[1] * p[0], first[0] * p[0] + first[1] * p[1]);
            least = fmin(least, angle);
            most = fmax(most, angle);
        }
        turned += most - least;
    }
    assert_true(count >= COLUMNS && turned >= 2.0 * 3.14159265358979 - 1e-6);
    close_can();
}

/* A triangle on one contour goes, and its contour takes its other sides; one on two stays. */
TEST(contours_follow_what_goes) {
    open_plain_can();
    cutting_list list = list_of(4, 0, COLUMNS);
    cutting_list_trace(&list);
    assert_int_equal(list.contour_count, 2);
    cutting_list_shrink(&list);
    assert_true(list.count >= COLUMNS && list.count < ROW_TRIANGLES);
    uint32_t on[2] = {0, 0};
    for (uint32_t i = 0; i < list.count; i++) {
        const uint32_t *sides = list.side_contours[list.triangles[i]];
        bool both[2] = {false, false};
        for (int k = 0; k < 3; k++) {
            if (sides[k] == NO_CONTOUR) continue;
            both[sides[k]] = true;
            on[sides[k]]++;
        }
        assert_true(both[0] && both[1]);
    }
    assert_true(on[0] >= COLUMNS && on[1] >= COLUMNS);
    cutting_list_destroy(&list);
    close_can();
}

/* Of two contours the shorter one cuts, wherever it lies. */
TEST(the_shorter_contour_cuts) {
    for (int upwards = 0; upwards < 2; upwards++) {
        double radius[ROWS + 1];
        for (int i = 0; i <= ROWS; i++) radius[i] = 2.0 + 0.3 * (upwards ? i : ROWS - i);
        open_can(radius);
        lower_row(4, 0, COLUMNS);
        cut_can(0.1);
        assert_int_equal(c.region_count, 2);
        assert_true(height_of_border() == (upwards ? 4.0 : 5.0));
        close_can();
    }
}

/* Two sides of a triangle become the third. */
TEST(contours_are_smoothed) {
    open_plain_can();
    contour line;
    expect_ok(contour_create(c.mesh, &line));
    /* Along the upper ends of row 3, but around one triangle of row 4 */
    const uint32_t bump = 4 * ROW_TRIANGLES;
    for (uint32_t j = 0; j < COLUMNS; j++) {
        if (j == 0)
            for (int k = 1; k < 3; k++) contour_add(&line, c.mesh->triangle_edges[bump][k]);
        else
            contour_add(&line, c.mesh->triangle_edges[bump + 2 * j][0]);
    }
    const double before = contour_length(&line, c.shape.positions);
    contour_smooth(&line);
    assert_int_equal(line.count, COLUMNS);
    for (uint32_t j = 0; j < COLUMNS; j++) assert_true(line.on[c.mesh->triangle_edges[bump + 2 * j][0]]);
    assert_true(contour_length(&line, c.shape.positions) < before);
    const double around = COLUMNS * 4.0 * sin(3.14159265358979 / COLUMNS);
    assert_true(fabs(contour_length(&line, c.shape.positions) - around) < 1e-9);
    contour_destroy(&line);
    close_can();
}

/* ---- growing, islands ---------------------------------------------------------------------------------- */

/* The patch is 12 of 216 triangles. */
TEST(only_large_clusters_grow) {
    open_plain_can();
    lower_row(4, 0, 6);
    cut_can(12.0 / TRIANGLES);
    assert_int_equal(c.region_count, 1);
    cut_can(11.5 / TRIANGLES);
    assert_int_equal(c.region_count, 2);
    close_can();
}

/* A hole in a band is no way around the body, unless it is as large as what grows. */
TEST(islands_are_filled) {
    open_plain_can();
    for (uint32_t row = 2; row < 6; row++) lower_row(row, 0, COLUMNS);
    for (uint32_t i = 0; i < 2; i++) c.equalized[4 * ROW_TRIANGLES + 6 + i] = 1.0;
    cut_can(2.0 / TRIANGLES);
    assert_int_equal(c.region_count, 2);
    cut_can(1.0 / TRIANGLES);
    assert_int_equal(c.region_count, 3);
    close_can();
}
