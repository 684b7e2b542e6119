/* Checks the default mu: two parts that touch have two vertices nearer than mu at the start or at the end,
 * and no smaller bound would do. Also checks how far around them particles look. */
#include "sensors/sensors.h"
#include "tests/support/calls.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SEEDS = PACED(12, 2) };

static scene s; /* large; one test at a time */

static sensor_reach measure_reach(const sensor_rig *r) {
    const sensor_partition *p = &r->sensors->partition;
    const walk_areas areas = {p->cell_offsets, p->cell_vertices, p->cell_count};
    sensor_reach reach;
    assert_int_equal(sensor_reach_create(p, 0.0, &reach), CSCD_OK);
    sensor_reach_measure(&reach, p, &areas, s.x0, s.x1, 0.0);
    return reach;
}

static double vertex_distance(const double *x, uint32_t a, uint32_t b) {
    double sum = 0.0;
    for (uint32_t k = 0; k < 3; k++) sum += (x[a * 3 + k] - x[b * 3 + k]) * (x[a * 3 + k] - x[b * 3 + k]);
    return sqrt(sum);
}

/* The corners of both features; returns how many the second one has. */
static uint32_t corners_of(const cscd_mesh *mesh, const cscd_contact *c, uint32_t a[2], uint32_t b[3]) {
    if (c->kind == CSCD_CONTACT_VF) {
        a[0] = a[1] = c->a;
        cscd_mesh_triangle(mesh, c->b, b);
        return 3;
    }
    cscd_mesh_edge(mesh, c->a, a);
    cscd_mesh_edge(mesh, c->b, b);
    return 2;
}

/* The least distance of two corners in units of their parts' mu, at the start or at the end. */
static double nearest_in_mu(const sensor_rig *r, const sensor_reach *reach, const cscd_contact *c) {
    uint32_t a[2], b[3], count = corners_of(r->mesh, c, a, b);
    double least = INFINITY;
    for (uint32_t i = 0; i < 2; i++) {
        for (uint32_t k = 0; k < count; k++) {
            const uint32_t *parts = r->sensors->partition.vertex_parts;
            double nearer = fmin(vertex_distance(s.x0, a[i], b[k]), vertex_distance(s.x1, a[i], b[k]));
            least = fmin(least, nearer / sensor_reach_mu(reach, parts[a[i]], parts[b[k]]));
        }
    }
    return least;
}

static cscd_detector *detector_of(const sensor_rig *r) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    options.method = CSCD_METHOD_NONE;
    options.start = CSCD_START_UNKNOWN;
    assert_int_equal(detector_create_here(r->mesh, NULL, &options, &detector), CSCD_OK);
    return detector;
}

/* Returns the largest of these distances over a scene's contacts, and adds the number of contacts to *count. */
static double largest_in_mu(const sensor_rig *r, size_t *count) {
    sensor_reach reach = measure_reach(r);
    cscd_detector *detector = detector_of(r);
    cscd_contacts contacts;
    double largest = 0.0;
    assert_int_equal(step_packed(detector, s.x0, s.x1, &contacts), CSCD_OK);
    for (size_t i = 0; i < contacts.count; i++)
        largest = fmax(largest, nearest_in_mu(r, &reach, &contacts.items[i]));
    *count += contacts.count;
    cscd_detector_destroy(detector);
    sensor_reach_free(r->context, &reach);
    return largest;
}

TEST(what_touches_has_near_vertices) {
    size_t count = 0;
    double largest = 0.0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
            scene_make((scene_family)family, seed, &s);
            sensor_setup setup = {seed % 2 ? 6 : 0, NULL};
            sensor_rig r = sensor_rig_create(&s, &setup);
            largest = fmax(largest, largest_in_mu(&r, &count));
            sensor_rig_destroy(&r);
        }
    }
    print_message("%zu contacts, the nearest vertices of one at most %.3f mu apart\n", count, largest);
    assert_true(count > 100);
    assert_true(largest > 0.1 && largest < 1.0);
}

/* Two triangles with an edge of length 2 each, crossed in their middles, and no longer ones. The one moves
 * past the other, from as far before as behind. */
static void make_cross(double motion) {
    static const uint32_t triangles[6] = {0, 1, 2, 3, 4, 5};
    const double points[18] = {-1, 0, 0, 1, 0, 0, 0, 0, -1, 0, -1, 0, 0, 1, 0, 0, 0, 1};
    scene_clear(&s);
    s.vertex_count = 6;
    s.triangle_count = 2;
    memcpy(s.triangles, triangles, sizeof triangles);
    memcpy(s.x0, points, sizeof points);
    memcpy(s.x1, points, sizeof points);
    for (uint32_t v = 3; v < 6; v++) {
        s.x0[v * 3 + 2] += motion / 2.0;
        s.x1[v * 3 + 2] -= motion / 2.0;
    }
}

/* Crossed edges at rest need 0.71 edge lengths, and the motion adds half of its length to that. */
TEST(crossed_edges_need_it_all) {
    for (int i = 0; i < 2; i++) {
        size_t count = 0;
        make_cross(10.0 * i);
        sensor_rig r = sensor_rig_create(&s, NULL);
        sensor_reach reach = measure_reach(&r);
        assert_true(fabs(sensor_reach_mu(&reach, 0, 1) - (sqrt(2.0) + 5.0 * i)) < 1e-9);
        double largest = largest_in_mu(&r, &count);
        assert_true(count > 0);
        assert_true(largest < 1.0 && largest > (i == 0 ? 1.0 - 1e-9 : 0.8));
        sensor_reach_free(r.context, &reach);
        sensor_rig_destroy(&r);
    }
}

/* One corner alone moves: that is the motion of its part, and its longest side is the one at the end. */
TEST(any_corner_may_move_most) {
    for (uint32_t v = 3; v < 6; v++) {
        make_cross(0.0);
        s.x1[v * 3 + 2] -= 10.0;
        sensor_rig r = sensor_rig_create(&s, NULL);
        sensor_reach reach = measure_reach(&r);
        double longest = sqrt(v < 5 ? 1.0 + 11.0 * 11.0 : 1.0 + 9.0 * 9.0);
        assert_true(fabs(sensor_reach_mu(&reach, 0, 1) - (longest / sqrt(3.0) + 5.0)) < 1e-9);
        sensor_reach_free(r.context, &reach);
        sensor_rig_destroy(&r);
    }
}

/* Particles look as far as mu and the diameters of both triangles, each of which is one cell; the one is three times as
 * large. A diameter is twice the distance of a corner from the middle of the box, which is the square root of 1.25. */
TEST(both_diameters_count) {
    for (uint32_t large = 0; large < 2; large++) {
        cscd_sensor_options cells = cscd_sensor_defaults();
        cells.cells = 1;
        make_cross(0.0);
        for (uint32_t i = large * 9; i < large * 9 + 9; i++) s.x0[i] = s.x1[i] = 3.0 * s.x0[i];
        sensor_rig r = sensor_rig_create(&s, &(sensor_setup){0, &cells});
        sensor_reach reach = measure_reach(&r);
        assert_int_equal(r.sensors->partition.cell_count, 2);
        assert_true(fabs(reach.radius - reach.mu_most - 4.0 * 2.0 * sqrt(1.25)) < 1e-9);
        sensor_reach_free(r.context, &reach);
        sensor_rig_destroy(&r);
    }
}

/* ---- how far around particles look -------------------------------------------------------------------- */

/* Spheres that do not feel each other, and a large triangle below. */
static void make_spheres(bool floor) {
    const double corners[9] = {-900, -900, -20, 900, -900, -20, 0, 900, -20};
    scene_clear(&s);
    for (int i = 0; i < 10; i++)
        scene_add_sphere(&s, (double[3]){10.0 * (i % 4), 10.0 * (i / 4), 0.0}, 1.0, 6, 8);
    if (!floor) return;
    for (uint32_t k = 0; k < 3; k++) s.triangles[s.triangle_count * 3 + k] = s.vertex_count + k;
    memcpy(s.x0 + s.vertex_count * 3, corners, sizeof corners);
    memcpy(s.x1 + s.vertex_count * 3, corners, sizeof corners);
    s.vertex_count += 3;
    s.triangle_count++;
}

static uint64_t distances_with(bool floor) {
    cscd_sensor_options options = cscd_sensor_defaults();
    options.collision_distance = 0.5;
    options.effective_radius = 1.0;
    options.cells = 12;
    sensor_setup setup = {0, &options};
    make_spheres(floor);
    sensor_rig r = sensor_rig_create(&s, &setup);
    sensor_rig_step(&r, s.x0, s.x1);
    assert_true((r.sensors->reach.longest_edge > 100.0) == floor);
    assert_true(r.sensors->reach.longest_inside > 0.1 && r.sensors->reach.longest_inside < 2.0);
    uint64_t distances = r.sensors->particles.counters.distances;
    sensor_rig_destroy(&r);
    return distances;
}

/* No particle walks along the floor's sides, which lead from cell to cell. */
TEST(a_large_triangle_costs_nothing) {
    assert_int_equal(distances_with(true), distances_with(false));
}
