/* When cells are due for renewal: nothing at rest, areas that grow, edges that stretch, parts that bend. */
#include "sensors/renewal.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { ROUNDS = PACED(50, 5), WALKED_SCENES = PACED(240, 36) };

static scene renewed; /* large; one test at a time */
static double moved[SCENE_VERTICES_MAX * 3];
static uint32_t walked[SCENE_VERTICES_MAX];
static cscd_renewal renewals[SCENE_TRIANGLES_MAX];

static const double origin[3] = {0.0, 0.0, 0.0};
static const renewal_limits usual = {.area_factor = 2.0, .edge_length = 0.0};

/* The body's mesh with its workspaces. */
typedef struct renewal_bench {
    rig rig;
    sensor_partition *partition;
    sensor_renewal renewal;
} renewal_bench;

/* Makes the components the parts, with cells at body.x0, and begins the renewal there. */
static renewal_bench bench_create(uint32_t cells_max) {
    renewal_bench b = {.rig = rig_create(&renewed, 1, NULL)};
    b.partition = hand_partition_create(b.rig.mesh, renewed.x0, NULL, b.rig.mesh->component_count, cells_max);
    assert_int_equal(sensor_renewal_create(b.partition, &b.renewal), CSCD_OK);
    sensor_renewal_follow(&b.renewal, b.partition, renewed.x0);
    hand_partition_particles(b.partition, walked);
    return b;
}

static void bench_destroy(renewal_bench *b) {
    sensor_renewal_destroy(&b->renewal);
    sensor_renewal_destroy(&b->renewal);
    hand_partition_destroy(b->partition);
    rig_destroy(&b->rig);
}

/* Returns how many parts are due at the positions `moved`, by the limits. */
static uint32_t count_due(renewal_bench *b, const renewal_limits *limits) {
    return sensor_renewal_check(&b->renewal, b->partition, moved, walked, limits, renewals);
}

/* Undoes the half step that every second ring of a building block is turned by, which makes its quads fold
 * inwards. */
static void straighten_rings(uint32_t first_vertex, double middle, uint32_t rings, uint32_t segments) {
    double angle = -3.14159265358979323846 / segments;
    for (uint32_t i = 0; i < rings * segments; i++) {
        double *p = renewed.x0 + (size_t)(first_vertex + 1 + i) * 3, x = p[0] - middle, y = p[1];
        if (i / segments % 2 == 0) continue;
        p[0] = middle + x * cos(angle) - y * sin(angle);
        p[1] = x * sin(angle) + y * cos(angle);
    }
}

static void make_two_bodies(void) {
    scene_clear(&renewed);
    scene_add_sphere(&renewed, (double[3]){-4.0, 0.0, 0.0}, 0.5, 12, 16);
    straighten_rings(0, -4.0, 12, 16);
    uint32_t first_of_second = renewed.vertex_count;
    scene_add_capsule(&renewed, 6.0, 0.5, 24, 12);
    straighten_rings(first_of_second, 0.0, 24, 12);
}

/* Moves the second body's vertices, or all. */
static void move_vertices(bool all, void (*how)(const double at[3], double amount, double out[3]),
                          double amount) {
    uint32_t first_of_second = 0;
    while (renewed.x0[first_of_second * 3] < -2.0) first_of_second++;
    memcpy(moved, renewed.x0, sizeof moved);
    for (uint32_t v = all ? 0 : first_of_second; v < renewed.vertex_count; v++)
        how(renewed.x0 + (size_t)v * 3, amount, moved + (size_t)v * 3);
}

static void grow_point(const double at[3], double amount, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = at[k] * amount;
}

static void stretch_point(const double at[3], double amount, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = at[k] * (k == 2 ? amount : 1.0 / sqrt(amount));
}

static void turn_point(const double at[3], double amount, double out[3]) {
    double x = at[0] * cos(amount) - at[1] * sin(amount), z = at[2];
    out[0] = x * cos(2.0 * amount) - z * sin(2.0 * amount) + 100.0 * amount;
    out[1] = at[0] * sin(amount) + at[1] * cos(amount) - 7.0;
    out[2] = x * sin(2.0 * amount) + z * cos(2.0 * amount);
}

/* Bends the capsule's axis to an arc of this angle. */
static void bend_point(const double at[3], double amount, double out[3]) {
    double radius = 6.0 / amount, angle = at[2] / radius;
    out[0] = radius - (radius - at[0]) * cos(angle);
    out[1] = at[1];
    out[2] = (radius - at[0]) * sin(angle);
}

/* ---- nothing is due ------------------------------------------------------------------------------------ */

TEST(rest_and_rigid_motion_need_nothing) {
    random_seed(1);
    make_two_bodies();
    renewal_bench b = bench_create(12);
    renewal_limits narrow = {.area_factor = 1.0 + 1e-9, .edge_length = 0.0};
    for (int i = 0; i < ROUNDS; i++) {
        hand_partition_particles(b.partition, walked);
        memcpy(moved, renewed.x0, sizeof moved);
        assert_int_equal(count_due(&b, &narrow), 0);
        move_vertices(true, turn_point, random_unit());
        assert_int_equal(count_due(&b, &usual), 0);
    }
    for (uint32_t p = 0; p < 2; p++) assert_int_equal(renewals[p], CSCD_RENEWAL_NONE);
    bench_destroy(&b);
}

/* ---- one reason each ----------------------------------------------------------------------------------- */

TEST(growth_is_seen) {
    random_seed(2);
    make_two_bodies();
    renewal_bench b = bench_create(12);
    move_vertices(false, grow_point, 1.3);
    assert_int_equal(count_due(&b, &usual), 0);
    move_vertices(false, grow_point, 1.5);
    assert_int_equal(count_due(&b, &usual), 1);
    assert_int_equal(renewals[0], CSCD_RENEWAL_NONE);
    assert_int_equal(renewals[1], CSCD_RENEWAL_AREA);
    bench_destroy(&b);
}

/* Walks alone find growth, too. */
TEST(growth_is_estimated) {
    random_seed(3);
    make_two_bodies();
    renewal_bench b = bench_create(12);
    for (uint32_t p = 0; p < 2; p++) b.renewal.first[p].area = INFINITY;
    move_vertices(false, grow_point, 1.3);
    assert_int_equal(count_due(&b, &usual), 0);
    move_vertices(false, grow_point, 3.0);
    assert_int_equal(count_due(&b, &usual), 1);
    assert_int_equal(renewals[1], CSCD_RENEWAL_AREA);
    assert_int_equal(sensor_renewal_check(&b.renewal, b.partition, moved, NULL, &usual, renewals), 0);
    bench_destroy(&b);
}

TEST(long_edges_are_seen) {
    random_seed(4);
    make_two_bodies();
    renewal_bench b = bench_create(12);
    double longest = sqrt(b.renewal.first[1].edge_squared);
    renewal_limits limits = {.area_factor = 4.0, .edge_length = 1.2 * longest};
    assert_true(sqrt(b.renewal.first[0].edge_squared) < limits.edge_length);
    move_vertices(false, stretch_point, 1.1);
    assert_int_equal(count_due(&b, &limits), 0);
    move_vertices(false, stretch_point, 2.0);
    assert_int_equal(count_due(&b, &limits), 1);
    assert_int_equal(renewals[1], CSCD_RENEWAL_EDGE);
    limits.edge_length = 0.0;
    assert_int_equal(count_due(&b, &limits), 0);
    bench_destroy(&b);
}

/* A long edge stays long, and does not hide that new cells are due. */
TEST(bending_is_told_before_long_edges) {
    random_seed(10);
    make_two_bodies();
    renewal_bench b = bench_create(12);
    renewal_limits limits = {.area_factor = 4.0, .edge_length = 0.5 * sqrt(b.renewal.first[1].edge_squared)};
    move_vertices(false, bend_point, 0.05);
    count_due(&b, &limits);
    assert_int_equal(renewals[1], CSCD_RENEWAL_EDGE);
    move_vertices(false, bend_point, 3.0);
    count_due(&b, &limits);
    assert_int_equal(renewals[1], CSCD_RENEWAL_CONCAVE);
    bench_destroy(&b);
}

static void flip_triangles(void) {
    for (uint32_t t = 0; t < renewed.triangle_count; t++) {
        uint32_t corner = renewed.triangles[t * 3];
        renewed.triangles[t * 3] = renewed.triangles[t * 3 + 1];
        renewed.triangles[t * 3 + 1] = corner;
    }
}

/* Bending is found also when all triangles face inwards. */
TEST(bending_is_seen) {
    for (int flipped = 0; flipped < 2; flipped++) {
        random_seed(5);
        make_two_bodies();
        if (flipped != 0) flip_triangles();
        renewal_bench b = bench_create(12);
        assert_true(b.renewal.first[1].concave < 0.01);
        move_vertices(false, bend_point, 0.05);
        assert_int_equal(count_due(&b, &usual), 0);
        move_vertices(false, bend_point, 0.8); /* a twelfth of its inner edges is concave now */
        assert_int_equal(count_due(&b, &usual), 0);
        assert_true(b.renewal.now[1].concave > 0.05);
        move_vertices(false, bend_point, 3.0);
        assert_int_equal(count_due(&b, &usual), 1);
        assert_int_equal(renewals[1], CSCD_RENEWAL_CONCAVE);
        bench_destroy(&b);
    }
}

/* Renewed cells are measured again; those of another part stay due. */
TEST(renewal_settles_one_part) {
    random_seed(6);
    make_two_bodies();
    renewal_bench b = bench_create(12);
    move_vertices(true, grow_point, 2.0);
    assert_int_equal(count_due(&b, &usual), 2);
    b.partition->generation++;
    b.partition->part_generations[1] = b.partition->generation;
    sensor_renewal_follow(&b.renewal, b.partition, moved);
    assert_int_equal(count_due(&b, &usual), 1);
    assert_int_equal(renewals[0], CSCD_RENEWAL_AREA);
    assert_int_equal(renewals[1], CSCD_RENEWAL_NONE);
    bench_destroy(&b);
}

/* ---- walks --------------------------------------------------------------------------------------------- */

/* A flat fan of four about vertex 0: the walks go along its spokes, 1 and 2 long one way, 3 and 4 the other.
 */
static void make_cross(void) {
    const uint32_t triangles[12] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1};
    const double points[15] = {0, 0, 0, 1, 0, 0, 0, 2, 0, -3, 0, 0, 0, -4, 0};
    scene_clear(&renewed);
    renewed.vertex_count = 5;
    renewed.triangle_count = 4;
    memcpy(renewed.triangles, triangles, sizeof triangles);
    memcpy(renewed.x0, points, sizeof points);
}

TEST(estimates_are_rectangles) {
    random_seed(7);
    make_cross();
    renewal_bench b = bench_create(1);
    assert_true(fabs(sensor_renewal_estimate(b.partition, renewed.x0, 0) - 24.0) < 1e-12);
    for (uint32_t v = 1; v < 5; v++) b.partition->vertex_cells[v] = 1; /* the edge out of a cell counts */
    assert_true(fabs(sensor_renewal_estimate(b.partition, renewed.x0, 0) - 24.0) < 1e-12);
    assert_true(fabs(b.renewal.first[0].area - 12.0) < 1e-12);
    bench_destroy(&b);
}

/* Estimates the area of one of a sphere's dozen cells, and of a whole sphere that is one cell. */
TEST(estimates_are_near_areas) {
    random_seed(8);
    scene_clear(&renewed);
    scene_add_sphere(&renewed, origin, 1.0, 24, 32);
    for (uint32_t cells = 1; cells <= 12; cells += 11) {
        renewal_bench b = bench_create(cells);
        double sum = 0.0, area = 12.566 / b.partition->cell_count;
        for (uint32_t v = 0; v < renewed.vertex_count; v++)
            sum += sensor_renewal_estimate(b.partition, renewed.x0, v) / renewed.vertex_count;
        assert_in_range((unsigned long)(100.0 * sum / area), 50, 250);
        bench_destroy(&b);
    }
}

/* Walks end on every mesh, even when the motion has flattened, scattered or inflated it. */
TEST(walks_end_on_any_mesh) {
    random_seed(9);
    for (int i = 0; i < WALKED_SCENES; i++) {
        scene_make((scene_family)(i % SCENE_FAMILY_COUNT), (uint64_t)i, &renewed);
        renewal_bench b = bench_create((uint32_t)random_integer(1, 6));
        for (uint32_t k = 0; k < renewed.vertex_count * 3; k++) {
            double x = renewed.x1[k];
            moved[k] = i % 4 == 0 ? 0.0 : i % 4 == 1 ? round(x) : i % 4 == 2 ? x + random_unit() : x * 1e200;
        }
        for (uint32_t v = 0; v < renewed.vertex_count; v++) {
            double estimate = sensor_renewal_estimate(b.partition, moved, v);
            assert_true(i % 4 == 3 || (estimate >= 0.0 && isfinite(estimate)));
        }
        count_due(&b, &usual);
        bench_destroy(&b);
    }
}
