/* Points of curves without integers: the same bits as with integers, or none. */
#include "tests/support/random.h"
#include "tests/support/test.h"

#include "runtime/intersections/named_surface.h"
#include "src/mesh/mesh.h"

#include <math.h>
#include <string.h>

enum { POINTS = NIGHTLY(3000, 10000) };

/* Edge 0 belongs to the first triangle, and its points are the first two; the third one is used by nobody. */
typedef struct point_rig {
    cscd_context *context;
    cscd_mesh *mesh;
    double x[6][3];
} point_rig;

static int set_up(void **state) {
    static point_rig rig;
    static const uint32_t triangles[] = {0, 1, 5, 2, 3, 4};
    cscd_object_desc desc = cscd_object_of_triangles(6, 2, triangles);
    expect_ok(cscd_context_create(NULL, &rig.context));
    expect_ok(cscd_mesh_create(rig.context, &desc, 1, &rig.mesh));
    *state = &rig;
    return 0;
}

static int tear_down(void **state) {
    point_rig *r = *state;
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    return 0;
}

static bool compare_point(const point_rig *r) {
    const named_surface s = {.mesh = r->mesh, .positions = r->x[0]};
    const uint32_t edge = r->mesh->triangle_edges[0][0];
    const double *points[5] = {r->x[r->mesh->edges[edge][0]], r->x[r->mesh->edges[edge][1]], r->x[2], r->x[3],
                               r->x[4]};
    piercing_point truth, fast, either;
    memset(&truth, 0, sizeof truth);
    piercing_point_find_exactly(&s, (surface_piercing){edge, 1}, &truth);
    piercing_point_find(&s, (surface_piercing){edge, 1}, &either);
    assert_memory_equal(&either, &truth, sizeof truth);
    bool found = rounded_point_find(points, &fast);
    if (found) assert_memory_equal(&fast, &truth, sizeof truth);
    return found;
}

static void draw_points(point_rig *r, random_stream *random, double offset, double grid) {
    for (int k = 0; k < 15; k++) {
        double x = stream_between(random, -1.0, 1.0);
        r->x[k / 3][k % 3] = offset + (grid > 0.0 ? nearbyint(x * grid) / grid : x);
    }
}

/* Makes piercings of points that agree in so many leading bits, of so many bits in all; scaled by a power of two. */
static int compare_points(point_rig *r, uint64_t seed, double offset, double grid, double scale) {
    const surface_piercing piercing = {r->mesh->triangle_edges[0][0], 1};
    const named_surface s = {.mesh = r->mesh, .positions = r->x[0]};
    random_stream random = stream_start(seed);
    int found = 0;
    for (int i = 0; i < POINTS; i++) {
        do draw_points(r, &random, offset, grid);
        while (!surface_piercing_happens(&s, piercing));
        for (int k = 0; k < 15; k++) r->x[k / 3][k % 3] *= scale;
        found += compare_point(r);
    }
    return found;
}

TEST(points_are_those_of_integers) {
    point_rig *r = *state;
    assert_true(compare_points(r, 1, 0.0, 0.0, 1.0) > POINTS - POINTS / 1000);
    assert_true(compare_points(r, 2, 0.0, 0x1p20, 1.0) > POINTS - POINTS / 1000);
    assert_true(compare_points(r, 3, 1e6, 0.0, 1.0) > POINTS - POINTS / 1000);
    assert_true(compare_points(r, 4, 0x1p50, 0.0, 1.0) > 0);
    assert_true(compare_points(r, 5, 0.0, 3.0, 1.0) > 0);
    assert_true(compare_points(r, 6, 1.0, 0.0, 0x1p-100) > POINTS - POINTS / 1000);
    assert_true(compare_points(r, 7, 1.0, 0.0, 0x1p140) > POINTS - POINTS / 1000);
    assert_int_equal(compare_points(r, 8, 1.0, 0.0, 0x1p-290), 0);
    assert_int_equal(compare_points(r, 9, 4.0, 0.0, 0x1p290), 0);
}

/* The point is above the middle between two doubles by 2^-106, which two doubles do not hold: they round to even, below. */
TEST(points_near_the_middle_are_left) {
    point_rig *r = *state;
    const double x[5][3] = {{1.0, 0.0, -1.0 - 0x1p-52},
                            {1.0 + 0x1p-52, 0.0, 1.0},
                            {-1.0, -1.0, 0.0},
                            {3.0, -1.0, 0.0},
                            {1.0, 3.0, 0.0}};
    memcpy(r->x, x, sizeof x);
    assert_false(compare_point(r));
    piercing_point at;
    const named_surface s = {.mesh = r->mesh, .positions = r->x[0]};
    piercing_point_find(&s, (surface_piercing){r->mesh->triangle_edges[0][0], 1}, &at);
    assert_true(at.x[0] == 1.0 + 0x1p-52);
}

AROUND_ALL(set_up, tear_down)
