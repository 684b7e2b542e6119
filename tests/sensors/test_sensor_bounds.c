/* Certified bounds: never apart where brute force finds a contact, apart where there is room. */
#include "sensors/bounds.h"
#include "sensors/exact_check.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/sensors/hand_partition.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { MESHES = PACED(60, 60), INTERVALS_PER_MESH = PACED(120, 40), TOUCHES = PACED(5000, 1000) };

static scene interval; /* large; one test at a time */
static uint32_t centres[SCENE_VERTICES_MAX];

static const double origin[3] = {0.0, 0.0, 0.0};

/* A scene's mesh with its workspaces. */
typedef struct bounds_bench {
    rig rig;
    cscd_partition *partition;
    exact_check exact;
    sensor_bounds bounds;
} bounds_bench;

static bounds_bench bench_create(const uint32_t *triangle_parts, uint32_t part_count, uint32_t cells_max) {
    bounds_bench b = {.rig = rig_create(&interval, 1, NULL)};
    b.partition = hand_partition_create(b.rig.mesh, interval.x0, triangle_parts, part_count, cells_max);
    assert_int_equal(exact_check_create(b.rig.mesh, &b.exact), CSCD_OK);
    assert_int_equal(sensor_bounds_create(b.partition, &b.bounds), CSCD_OK);
    return b;
}

static void bench_destroy(bounds_bench *b) {
    exact_check_destroy(&b->exact);
    sensor_bounds_destroy(&b->bounds);
    hand_partition_destroy(b->partition);
    rig_destroy(&b->rig);
}

static bool bounds_apart(bounds_bench *b, bool *boxes) {
    sensor_bounds_update(&b->bounds, b->partition, interval.x0, interval.x1, centres);
    sensor_bounds_update_boxes(&b->bounds, b->partition, interval.x0, interval.x1);
    bool there = sensor_bounds_apart(&b->bounds, b->partition, 0, 1);
    assert_int_equal(sensor_bounds_apart(&b->bounds, b->partition, 1, 0), there);
    *boxes = sensor_bounds_boxes_apart(&b->bounds, 0, 1);
    return there;
}

static bool exact_contact(bounds_bench *b) {
    uint32_t cells[128];
    for (uint32_t c = 0; c < b->partition->cell_count; c++) cells[c] = c;
    uint32_t count = b->partition->parts[0].cell_count;
    area_query query = {interval.x0, interval.x1, cells, cells + count, count, 0};
    query.count_b = b->partition->cell_count - count;
    area_verdict verdict;
    assert_int_equal(exact_check_run(&b->exact, b->partition, &query, &verdict), CSCD_OK);
    return verdict.contact;
}

/* ---- random motions ------------------------------------------------------------------------------------ */

/* Places two small bodies anywhere, slow or fast, near the origin or far from it. */
static void move_bodies(const scene *rest, uint32_t first_of_second) {
    double far_away = random_integer(0, 2) == 0 ? 1e9 : 0.0, speed = random_integer(0, 1) ? 0.3 : 20.0;
    double centre[3], places[2][3], offsets[2][3];
    for (int k = 0; k < 3; k++) {
        centre[k] = far_away * random_unit();
        for (int i = 0; i < 2; i++) {
            double middle = 2.2 * random_unit();
            offsets[i][k] = speed * random_unit();
            places[i][k] = middle - 0.5 * offsets[i][k];
        }
    }
    for (uint32_t v = 0; v < rest->vertex_count; v++) {
        int body = v >= first_of_second;
        for (uint32_t k = 0; k < 3; k++) {
            double x = rest->x0[v * 3 + k] + places[body][k] + centre[k];
            interval.x0[v * 3 + k] = x + 0.02 * random_unit();
            interval.x1[v * 3 + k] = x + offsets[body][k] + 0.2 * random_unit();
        }
    }
}

TEST(never_apart_in_contact) {
    static scene rest;
    uint32_t found_apart = 0, contacts = 0, beyond_boxes = 0, by_middles = 0;
    random_seed(1);
    for (int i = 0; i < MESHES; i++) {
        scene_clear(&rest);
        scene_add_sphere(&rest, origin, random_between(0.3, 1.0), 3 + i % 2, 5);
        uint32_t first_of_second = rest.vertex_count;
        scene_add_torus(&rest, origin, random_between(0.4, 1.0), 0.2, 6, 3, i % 2 == 0);
        interval = rest;
        bounds_bench b = bench_create(NULL, 2, 8);
        for (int k = 0; k < INTERVALS_PER_MESH; k++) {
            bool boxes;
            move_bodies(&rest, first_of_second);
            hand_partition_particles(b.partition, centres);
            bool balls = bounds_apart(&b, &boxes), contact = exact_contact(&b);
            sensor_bounds_update(&b.bounds, b.partition, interval.x0, interval.x1, NULL);
            bool middles = sensor_bounds_apart(&b.bounds, b.partition, 0, 1);
            assert_false((balls || boxes || middles) && contact);
            by_middles += middles;
            found_apart += balls;
            contacts += contact;
            beyond_boxes += balls && !boxes;
        }
        bench_destroy(&b);
    }
    uint32_t all = MESHES * INTERVALS_PER_MESH;
    assert_true(contacts > all / 10 && found_apart > all / 10 && beyond_boxes > 0 &&
                by_middles > found_apart);
}

/* ---- touches that are exact ---------------------------------------------------------------------------- */

/* Two triangles whose cells' balls touch in their common corner, at time t, and then again with a gap, all of
 * integers: only rounding outwards can tell these. */
static void make_touch(double offset, double gap) {
    static const int triples[4][4] = {{3, 4, 0, 5}, {2, 3, 6, 7}, {1, 4, 8, 9}, {5, 0, 12, 13}};
    static const int across[4][3] = {{4, -3, 9}, {3, -2, 0}, {4, -1, 0}, {12, 7, -5}};
    int which = random_integer(0, 3);
    const int *n = triples[which], *w = across[which];
    double t = random_integer(0, 4) / 4.0, speed = 4.0 * random_integer(0, 1000);
    int reach_a = random_integer(1, 1000), reach_b = random_integer(1, 1000);
    for (uint32_t k = 0; k < 3; k++) {
        double corner[2] = {offset, offset + gap * n[k]}, sides[2] = {-1.0 * reach_a, 1.0 * reach_b};
        for (uint32_t i = 0; i < 2; i++) {
            double travel = i == 0 ? 0.0 : speed * w[k];
            double points[3] = {corner[i] + sides[i] * n[k], corner[i], corner[i] + 0.5 * sides[i] * n[k]};
            points[2] += k == 0 ? 0.25 * sides[i] : 0.0;
            for (uint32_t c = 0; c < 3; c++) {
                interval.x0[(i * 3 + c) * 3 + k] = points[c] - t * travel;
                interval.x1[(i * 3 + c) * 3 + k] = points[c] + (1.0 - t) * travel;
            }
        }
    }
}

TEST(exact_touches_are_not_apart) {
    const uint32_t triangles[6] = {0, 1, 2, 3, 4, 5};
    scene_clear(&interval);
    interval.vertex_count = 6;
    interval.triangle_count = 2;
    memcpy(interval.triangles, triangles, sizeof triangles);
    random_seed(2);
    bounds_bench b = bench_create(NULL, 2, 1);
    centres[0] = 0;
    centres[1] = 3;
    for (int i = 0; i < TOUCHES; i++) {
        bool boxes;
        double offset = i % 2 == 0 ? 0.0 : ldexp(1.0, random_integer(10, 40)) * random_integer(-1, 1);
        make_touch(offset, 0.0);
        assert_true(exact_contact(&b));
        assert_false(bounds_apart(&b, &boxes));
        assert_false(boxes);
        make_touch(offset, offset == 0.0 ? 0x1p-30 : 0x1p-10);
        assert_true(bounds_apart(&b, &boxes));
    }
    bench_destroy(&b);
}

/* ---- other cases --------------------------------------------------------------------------------------- */

/* Bodies are far from each other; some fly one behind the other through each other's boxes. */
TEST(far_bodies_are_apart) {
    scene_clear(&interval);
    scene_add_sphere(&interval, origin, 1.0, 5, 8);
    scene_add_sphere(&interval, (double[3]){9.0, 0.0, 0.0}, 1.0, 5, 8);
    memcpy(interval.x1, interval.x0, sizeof interval.x1);
    bounds_bench b = bench_create(NULL, 2, 12);
    bool boxes;
    hand_partition_particles(b.partition, centres);
    assert_true(bounds_apart(&b, &boxes));
    assert_true(boxes);
    for (uint32_t v = 0; v < interval.vertex_count; v++) interval.x1[v * 3] = interval.x0[v * 3] + 20.0;
    assert_true(bounds_apart(&b, &boxes));
    assert_false(boxes);
    bench_destroy(&b);
}

/* Bodies that are in each other at one end of the interval, and on the line through their middles far from each other at the
 * other one. */
TEST(bodies_that_part_are_not_apart) {
    scene_clear(&interval);
    scene_add_sphere(&interval, origin, 1.0, 5, 8);
    uint32_t first_of_second = interval.vertex_count;
    scene_add_sphere(&interval, (double[3]){1.5, 0.0, 0.0}, 1.0, 5, 8);
    for (uint32_t end = 0; end < 2; end++) {
        bool boxes;
        memcpy(interval.x1, interval.x0, sizeof interval.x1);
        bounds_bench b = bench_create(NULL, 2, 1);
        double *far = end == 0 ? interval.x0 : interval.x1;
        for (uint32_t v = first_of_second; v < interval.vertex_count; v++) far[v * 3] += 20.0;
        hand_partition_particles(b.partition, centres);
        assert_true(exact_contact(&b));
        assert_false(bounds_apart(&b, &boxes));
        assert_false(boxes);
        for (uint32_t v = first_of_second; v < interval.vertex_count; v++) far[v * 3] -= 20.0;
        bench_destroy(&b);
    }
}

/* The bounds never claim that parts are apart where squares or differences exceed the range of doubles. */
TEST(extreme_lengths_are_safe) {
    const double scales[] = {1e-320, 1e-200, 1e-160, 1e160, 1e200, 1e307};
    static scene rest;
    scene_make(SCENE_LINKED_TORI, 1, &rest);
    interval = rest;
    bounds_bench b = bench_create(NULL, 2, 6);
    random_seed(3);
    for (int i = 0; i < 6; i++) {
        bool boxes;
        for (uint32_t k = 0; k < rest.vertex_count * 3; k++) {
            interval.x0[k] = rest.x0[k] * scales[i];
            interval.x1[k] = rest.x1[k] * scales[i];
        }
        hand_partition_particles(b.partition, centres);
        assert_false(bounds_apart(&b, &boxes));
    }
    bench_destroy(&b);
}

/* Parts any triangle of which may be without a corner of its own, and a part without a cell: balls must hold
 * every triangle's corners at any time, and nothing is said without balls. */
TEST(every_triangle_is_held) {
    static uint32_t triangle_parts[SCENE_TRIANGLES_MAX];
    random_seed(4);
    for (int i = 0; i < 40; i++) {
        scene_make((scene_family)(i % SCENE_FAMILY_COUNT), (uint64_t)i, &interval);
        for (uint32_t t = 0; t < interval.triangle_count; t++)
            triangle_parts[t] = (uint32_t)random_integer(0, 4);
        bounds_bench b = bench_create(triangle_parts, 6, 5);
        hand_partition_particles(b.partition, centres);
        sensor_bounds_update(&b.bounds, b.partition, interval.x0, interval.x1, centres);
        for (uint32_t t = 0; t < interval.triangle_count; t++) {
            uint32_t home = b.bounds.homes[t];
            assert_int_equal(home == PARTITION_NONE, b.bounds.unbounded[triangle_parts[t]]);
            if (home == PARTITION_NONE) continue;
            uint32_t centre = centres[home];
            assert_int_equal(b.partition->cell_parts[home], triangle_parts[t]);
            for (int k = 0; k < 3; k++) {
                uint32_t corner = interval.triangles[t * 3 + (uint32_t)k];
                const double *x = random_integer(0, 1) == 0 ? interval.x0 : interval.x1;
                double d[3];
                for (uint32_t j = 0; j < 3; j++) d[j] = x[corner * 3 + j] - x[centre * 3 + j];
                assert_true(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) <= b.bounds.balls[home].radius);
            }
        }
        bench_destroy(&b);
    }
}

/* The tip of a fan in a part of its own: its corners are those of the first triangles. */
TEST(parts_without_cells_are_never_apart) {
    const uint32_t triangles[12] = {0, 1, 2, 2, 1, 3, 3, 0, 2, 4, 5, 6}, parts[4] = {0, 1, 2, 3};
    scene_clear(&interval);
    interval.vertex_count = 7;
    interval.triangle_count = 4;
    memcpy(interval.triangles, triangles, sizeof triangles);
    for (uint32_t v = 0; v < 7; v++) interval.x0[v * 3] = interval.x1[v * 3] = v >= 4 ? 100.0 : v;
    bounds_bench b = bench_create(parts, 4, 4);
    assert_int_equal(b.partition->parts[2].cell_count, 0);
    for (uint32_t c = 0; c < b.partition->cell_count; c++)
        centres[c] = b.partition->cell_vertices[b.partition->cell_offsets[c]];
    sensor_bounds_update(&b.bounds, b.partition, interval.x0, interval.x1, centres);
    sensor_bounds_update_boxes(&b.bounds, b.partition, interval.x0, interval.x1);
    assert_true(sensor_bounds_apart(&b.bounds, b.partition, 0, 3));
    assert_false(sensor_bounds_apart(&b.bounds, b.partition, 2, 3));
    assert_false(sensor_bounds_boxes_apart(&b.bounds, 3, 2));
    bench_destroy(&b);
}
