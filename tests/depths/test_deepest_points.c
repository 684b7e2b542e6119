/* The deepest points of surfaces: by hand where one sees them, else beside samples of the surface and the distance from all
 * triangles. And what has no depth, because surfaces only lie on each other. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SCENES = PACED(400, 30), PLATES = PACED(10, 2) };
enum { SAMPLES = 60 };

static body_rig rig; /* large; one test at a time */

/* ---- boxes ------------------------------------------------------------------------------------------------ */

/* Where a scene of boxes is put: its coordinates in another order, some of them mirrored, larger, and elsewhere. */
typedef struct placement {
    int axes[3];
    double signs[3], scale, offset;
} placement;

static const placement placements[] = {
    {{0, 1, 2}, {1, 1, 1}, 1.0, 0.0},     {{1, 2, 0}, {1, 1, 1}, 1.0, 0.0},
    {{2, 0, 1}, {1, 1, 1}, 0x1p-20, 0.0}, {{2, 1, 0}, {-1, 1, 1}, 1.0, 0.0},
    {{0, 1, 2}, {-1, -1, 1}, 1e6, 0.0},   {{1, 0, 2}, {1, -1, 1}, 1e-3, 0.0},
    {{0, 2, 1}, {1, 1, -1}, 1.0, 1024.0},
};
enum { PLACEMENTS = sizeof placements / sizeof *placements };

static void add_box(const placement *p, const double x[6]) {
    double low[3], size[3];
    for (int k = 0; k < 3; k++) {
        const double a = x[2 * p->axes[k]], b = x[2 * p->axes[k] + 1];
        const double from = (p->signs[k] < 0 ? -b : a) * p->scale + p->offset;
        const double to = (p->signs[k] < 0 ? -a : b) * p->scale + p->offset;
        low[k] = from;
        size[k] = to - from;
    }
    const uint32_t first = rig.all.vertex_count;
    body_rig_add_box(&rig, low, size);
    for (uint32_t v = 0; v < 8; v++) /* exactly there */
        for (int k = 0; k < 3; k++) {
            const int of = p->axes[k];
            const double far = p->signs[k] < 0 ? -x[2 * of] : x[2 * of + 1];
            if ((v >> k & 1) != 0) rig.all.x0[(first + v) * 3 + (uint32_t)k] = far * p->scale + p->offset;
        }
    body_rig_end_body(&rig);
}

static double deepest_of_all(double *bound) {
    const cscd_depths *d = rig.found.depths;
    double depth = 0.0;
    *bound = 0.0;
    for (size_t i = 0; i < d->count; i++) {
        depth = fmax(depth, d->items[i].depth);
        *bound = fmax(*bound, d->items[i].bound);
    }
    return depth;
}

typedef struct two_boxes {
    const char *name;
    double boxes[2][6], depth;
} two_boxes;

static const two_boxes by_hand[] = {
    {"corner in corner", {{0, 1, 0, 1, 0, 1}, {0.5, 1.5, 0.5, 1.5, 0.5, 1.5}}, 0.5},
    {"a rod inside", {{0, 1, 0, 1, 0, 1}, {0.01, 0.99, 0.49, 0.51, 0.49, 0.51}}, 0.49},
    {"a rod enters", {{0, 1, 0, 1, 0, 1}, {-0.5, 0.99, 0.49, 0.51, 0.49, 0.51}}, 0.49},
    {"a rod goes through", {{0, 1, 0, 1, 0, 1}, {-0.5, 1.5, 0.49, 0.51, 0.49, 0.51}}, 0.49},
    {"boxes a little off each other", {{-1, 1, -1, 1, -1, 1}, {0.8, 2.8, -0.99, 1.01, -0.98, 1.02}}, 0.2},
    {"a duct in a wall", {{-1, 1, -0.2, 0.2, -0.2, 0.2}, {-0.1, 0.1, -2.5, 2.5, -1.5, 1.5}}, 0.2},
    {"a wall's end in a wall, flush", {{0, 4, 0, 0.2, 0, 3}, {3.95, 8, 0, 0.2, 0, 3}}, 0.05},
    {"half of a cube, flush", {{0, 1, 0, 1, 0, 1}, {0.5, 1.5, 0, 1, 0, 1}}, 0.5},
    {"flush on two sides", {{0, 1, 0, 1, 0, 1}, {0.5, 1.5, 0, 1, 0.1, 0.9}}, 0.5},
    {"a slab within a cube, flush on five sides", {{0, 1, 0, 1, 0, 1}, {0, 1, 0.8, 1, 0, 1}}, 0.2},
    {"flush, and nearly apart", {{0, 1, 0, 1, 0, 1}, {1 - 0x1p-40, 2, 0, 1, 0, 1}}, 0x1p-40},
    {"side by side", {{0, 4, 0, 0.2, 0, 3}, {4, 8, 0, 0.2, 0, 3}}, 0.0},
    {"a crate on a floor", {{-4, 4, -4, 4, -1, 0}, {-1, 1, -1, 1, 0, 2}}, 0.0},
    {"bricks that share part of a face", {{0, 2, 0, 1, 0, 1}, {1, 3, 0.25, 1.25, 1, 2}}, 0.0},
    {"an edge on an edge", {{0, 1, 0, 1, 0, 1}, {1, 2, 1, 2, 0, 1}}, 0.0},
    {"a corner on a corner", {{0, 1, 0, 1, 0, 1}, {1, 2, 1, 2, 1, 2}}, 0.0},
    {"apart", {{0, 1, 0, 1, 0, 1}, {1.5, 2, 0, 1, 0, 1}}, 0.0},
};

TEST(boxes_by_hand) {
    for (size_t i = 0; i < sizeof by_hand / sizeof *by_hand; i++) {
        for (int p = 0; p < PLACEMENTS; p++) {
            for (int order = 0; order < 2; order++) {
                body_rig_begin(&rig);
                add_box(&placements[p], by_hand[i].boxes[order]);
                add_box(&placements[p], by_hand[i].boxes[1 - order]);
                body_rig_find_all(&rig);
                const double scale = placements[p].scale, truth = by_hand[i].depth * scale;
                const double room = 1e-15 * (8.0 * scale + placements[p].offset), grain = 1e6 * room;
                double bound, depth = deepest_of_all(&bound);
                const bool right = truth == 0.0 ? depth == 0.0 && bound <= grain
                                                : depth > 0.0 && depth <= truth + room &&
                                                      bound >= truth - room && bound <= 1.01 * depth + grain;
                if (!right)
                    print_error("%s, placed %d, order %d: %.17g to %.17g in place of %g\n", by_hand[i].name,
                                p, order, depth, bound, truth);
                assert_true(right);
            }
        }
    }
}

/* A rod from wall to wall of a cube is deepest in its middle, where no corner is, while one end of it has a corner that is nearly as
 * deep. Each long triangle has two corners beside each other, and one far away. */
TEST(a_rod_with_a_deep_corner) {
    static const double cube[6] = {0, 1, 0, 1, 0, 1}, around[3][2] = {{0, 0}, {0.02, 0}, {0, 0.02}};
    static const uint32_t triangles[][3] = {{1, 0, 3}, {3, 4, 1}, {2, 1, 4}, {4, 5, 2}, {0, 2, 5},
                                            {5, 3, 0}, {3, 5, 4}, {0, 1, 6}, {1, 2, 6}, {2, 0, 6}};
    double bound;
    body_rig_begin(&rig);
    add_box(&placements[0], cube);
    for (uint32_t v = 0; v < 7; v++, rig.all.vertex_count++) {
        double *x = rig.all.x0 + 3 * (size_t)rig.all.vertex_count;
        for (int k = 0; k < 3; k++)
            x[k] = v == 6 ? 0.4 : k == 0 ? (v < 3 ? 0.05 : 0.95) : 0.49 + around[v % 3][k - 1];
    }
    for (uint32_t i = 0; i < 30; i++) rig.all.triangles[36 + i] = 8 + triangles[i / 3][i % 3];
    rig.all.triangle_count += 10;
    body_rig_end_body(&rig);
    body_rig_find_all(&rig);
    const double depth = deepest_of_all(&bound);
    assert_true(depth > 0.49 * 0.99 && bound >= 0.49 && depth <= 0.5 && bound <= 1.01 * depth);
}

/* Where the depth is 0, the way out of a body is that of its surface outwards, also where its triangles look inwards. */
TEST(ways_out_of_what_touches) {
    static const double floor_box[6] = {-4, 4, -4, 4, -1, 0}, crate[6] = {-1, 1, -1, 1, 0, 2};
    for (int inverted = 0; inverted < 4; inverted++) {
        size_t faces = 0;
        body_rig_begin(&rig);
        add_box(&placements[0], floor_box);
        add_box(&placements[0], crate);
        for (int i = 0; i < 2; i++)
            if ((inverted >> i & 1) != 0) body_rig_turn(&rig, (uint32_t)i * 12, 12);
        body_rig_find_all(&rig);
        const cscd_depths *d = rig.found.depths;
        for (size_t i = d->vertex_count + d->edge_count; i < d->count; i++, faces++) {
            assert_true(d->items[i].depth == 0.0 && fabs(d->items[i].direction[2]) == 1.0);
            assert_int_equal(d->items[i].direction[2] > 0.0, d->items[i].body == 0);
        }
        assert_true(faces > 0);
    }
}

/* ---- beside samples ---------------------------------------------------------------------------------------- */

static double (*corner_of(uint32_t t, uint32_t i))[3] {
    return (double(*)[3])(rig.all.x0 + (size_t)rig.all.triangles[t * 3 + i] * 3);
}

static void sample_triangle(random_stream *random, uint32_t t, double out[3]) {
    double u = stream_between(random, 0, 1), v = stream_between(random, 0, 1);
    if (stream_below(random, 3) == 0) v = 0.0; /* on an edge */
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    for (int k = 0; k < 3; k++)
        out[k] = (*corner_of(t, 0))[k] + u * ((*corner_of(t, 1))[k] - (*corner_of(t, 0))[k]) +
                 v * ((*corner_of(t, 2))[k] - (*corner_of(t, 0))[k]);
}

static double greatest_bound(uint32_t body) {
    const cscd_depths *d = rig.found.depths;
    double bound = 0.0;
    for (size_t i = d->vertex_count + d->edge_count; i < d->count; i++)
        if (d->items[i].body == body) bound = fmax(bound, d->items[i].bound);
    return bound;
}

/* No sample that the other body contains is deeper than the bounds say. */
static size_t compare_samples(random_stream *random) {
    size_t buried = 0;
    for (uint32_t body = 0; body < 2; body++) {
        const body_part *own = &rig.bodies[1 - body];
        const double bound = greatest_bound(body);
        for (int i = 0; i < SAMPLES; i++) {
            double x[3];
            sample_triangle(random, own->first_triangle + stream_below(random, own->triangle_count), x);
            if (body_number(&rig, body, x) < 1) continue;
            assert_true(body_distance(&rig, body, x) <= bound + 1e-12);
            buried++;
        }
    }
    return buried;
}

static void compare_items(void) {
    const cscd_depths *d = rig.found.depths;
    for (size_t i = d->vertex_count + d->edge_count; i < d->count; i++) {
        const cscd_depth *at = &d->items[i];
        const double distance = body_distance(&rig, at->body, at->x);
        assert_true(at->vertex == UINT32_MAX && at->edge == UINT32_MAX);
        if (fabs(distance - at->depth) >= 1e-12)
            print_error("scene face %u body %u depth %.17g distance %.17g bound %g patch %d\n", at->face,
                        at->body, at->depth, distance, at->bound, (int)at->patch);
        assert_true(fabs(distance - at->depth) < 1e-12);
        assert_true(at->bound >= at->depth && at->bound <= 1.01 * at->depth + 1e-8);
        assert_true(cscd_mesh_vertex_object(rig.mesh, rig.all.triangles[at->face * 3]) != at->body);
        if (at->patch != UINT32_MAX) assert_int_equal(at->face < rig.bodies[1].first_triangle, at->body == 1);
    }
    for (size_t i = 0; i < d->patch_count; i++) {
        const cscd_depth *at = &d->items[d->patches[i].deepest];
        assert_true(at->patch == d->patches[i].patch && at->body == d->patches[i].body);
        for (size_t k = 0; k < d->vertex_count; k++)
            if (d->items[k].patch == at->patch && d->items[k].body == at->body)
                assert_true(d->items[k].depth <= at->bound);
    }
}

static void turn_body(random_stream *random, uint32_t first) {
    const double shift = stream_between(random, 0.9, 1.1);
    const double a = stream_between(random, 0, 6.3), b = stream_between(random, 0, 6.3);
    for (uint32_t v = first; v < rig.all.vertex_count; v++) {
        double *x = rig.all.x0 + (size_t)v * 3, y[3] = {x[0], x[1], x[2]};
        x[0] = cos(a) * y[0] - sin(a) * y[1];
        x[1] = sin(a) * y[0] + cos(a) * y[1];
        memcpy(y, x, sizeof y);
        x[1] = cos(b) * y[1] - sin(b) * y[2];
        x[2] = sin(b) * y[1] + cos(b) * y[2];
        for (int k = 0; k < 3; k++) x[k] += 0.25 * (k + 1) * shift;
    }
}

TEST(random_bodies) {
    random_stream random = stream_start(19);
    const char *asked = getenv("SCENES"); /* so many instead, such as 20000 */
    const size_t scenes = asked != NULL ? strtoul(asked, NULL, 10) : SCENES;
    size_t buried = 0, faces = 0;
    for (size_t scene_number = 0; scene_number < scenes; scene_number++) {
        body_rig_begin(&rig);
        for (int i = 0; i < 2; i++) {
            const uint32_t first = rig.all.vertex_count;
            double low[3], size[3];
            for (int k = 0; k < 3; k++) {
                low[k] = stream_between(&random, -0.5, 0.2);
                size[k] = pow(10.0, stream_between(&random, -1.5, 0.3));
            }
            const double origin[3] = {0.2, 0.1, 0.3};
            if (i == 1 && stream_below(&random, 2) == 0)
                scene_add_sphere(&rig.all, origin, stream_between(&random, 0.1, 0.8), 4, 7);
            else
                body_rig_add_box(&rig, low, size);
            turn_body(&random, first);
            body_rig_end_body(&rig);
        }
        body_rig_find_all(&rig);
        buried += compare_samples(&random);
        compare_items();
        faces += rig.found.depths->count - rig.found.depths->vertex_count - rig.found.depths->edge_count;
    }
    print_message("  %zu samples, %zu deepest points\n", buried, faces);
    assert_true(buried > 5 * scenes && faces > scenes);
}

/* Below the bumps of a disc: the plate is of few triangles, so much of it may have the deepest point, and not all of that fits in the
 * queue at once. */
TEST(a_plate_below_bumps) {
    random_stream random = stream_start(23);
    const double centre[3] = {0, 0, 0}, low[3] = {-0.6, -0.6, 0.9}, size[3] = {1.2, 1.2, 0.01};
    enum { SIDE = 40 };
    for (int plate = 0; plate < PLATES; plate++) {
        body_rig_begin(&rig);
        scene_add_sphere(&rig.all, centre, 1.0, 16, 27);
        for (uint32_t v = 0; v < rig.all.vertex_count; v++) {
            double *z = &rig.all.x0[(size_t)v * 3 + 2];
            *z = fmax(-1.0, fmin(1.0, 4.0 * *z));
            if (*z == 1.0) *z += v % 2 == 0 ? stream_between(&random, 0.0, 0.1) : 0.0;
        }
        body_rig_end_body(&rig);
        body_rig_box(&rig, low, size);
        body_rig_find_all(&rig);
        const double bound = greatest_bound(0);
        for (int i = 0; i <= SIDE; i++) {
            for (int j = 0; j <= SIDE; j++) {
                const double x[3] = {low[0] + size[0] * i / SIDE, low[1] + size[1] * j / SIDE, low[2]};
                assert_true(body_distance(&rig, 0, x) <= bound + 1e-12);
            }
        }
        compare_items();
    }
}

/* ---- a limit ------------------------------------------------------------------------------------------------ */

/* The depth of a tilted box in a box is 0.49 to the last digits of its bounds; a limit within them decides. */
TEST(a_limit_is_decided) {
    random_stream random = stream_start(5);
    body_rig_begin(&rig);
    const double low[3] = {-1, -1, -1}, size[3] = {2, 2, 2}, thin[3] = {0.9, 0.3, 0.2}, origin[3] = {0, 0, 0};
    body_rig_box(&rig, low, size);
    body_rig_add_box(&rig, origin, thin);
    turn_body(&random, 8);
    body_rig_end_body(&rig);
    body_rig_create(&rig, NULL, 1);
    body_rig_find(&rig);
    double bound, depth = deepest_of_all(&bound);
    assert_true(bound > depth);
    cscd_intersection_options options = cscd_intersection_defaults();
    options.depths = true;
    for (int i = 0; i <= 20; i++) {
        options.depth_limit = depth + (bound - depth) * i / 20.0;
        assert_int_equal(cscd_detector_find_intersections(rig.detector,
                                                          CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count),
                                                          &options, &rig.found),
                         CSCD_OK);
        double most, least = deepest_of_all(&most);
        assert_true(least > options.depth_limit || most <= options.depth_limit);
    }
    options.depth_limit = -1.0;
    assert_int_equal(cscd_detector_find_intersections(
                         rig.detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count), &options, &rig.found),
                     CSCD_INVALID_ARGUMENT);
    options.depth_limit = (double)NAN;
    assert_int_equal(cscd_detector_find_intersections(
                         rig.detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count), &options, &rig.found),
                     CSCD_INVALID_ARGUMENT);
}

/* ---- edges ------------------------------------------------------------------------------------------------- */

/* An edge of a box lies between two of its curves in another body, and its first triangle has no area. */
TEST(an_edge_whose_first_triangle_has_no_area) {
    static const double low[3] = {0, 0, 0}, size[3] = {4, 1, 1}, wall[3] = {1.5, -1, -1},
                        thick[3] = {1, 3, 3};
    for (int flat = 0; flat < 2; flat++) {
        body_rig_begin(&rig);
        body_rig_add_box(&rig, low, size);
        if (flat !=
            0) { /* a vertex on the edge from 0 to 1, and a triangle without area between the halves */
            const uint32_t needle[3] = {0, 8, 1};
            for (uint32_t t = rig.all.triangle_count; t-- > 0;) {
                uint32_t *c = rig.all.triangles + (size_t)t * 3;
                for (int k = 0; k < 3; k++) /* what runs from 0 to 1 gets the needle's other sides */
                    if (c[k] == 0 && c[(k + 1) % 3] == 1) {
                        const uint32_t apex = c[(k + 2) % 3];
                        const uint32_t halves[2][3] = {{0, 8, apex}, {8, 1, apex}};
                        memcpy(c, halves[0], sizeof halves[0]);
                        memcpy(rig.all.triangles + (size_t)rig.all.triangle_count++ * 3, halves[1],
                               sizeof halves[1]);
                    }
            }
            memmove(rig.all.triangles + 3, rig.all.triangles,
                    (size_t)rig.all.triangle_count++ * 3 * sizeof needle[0]);
            const uint32_t turned[3] = {needle[0], needle[2], needle[1]};
            memcpy(rig.all.triangles, turned, sizeof turned);
            rig.all.x0[24] = 0.5;
            rig.all.x0[25] = rig.all.x0[26] = 0.0;
            rig.all.vertex_count++;
        }
        body_rig_end_body(&rig);
        body_rig_box(&rig, wall, thick);
        body_rig_find_all(&rig);
        const cscd_depths *d = rig.found.depths;
        size_t along = 0;
        for (size_t i = d->vertex_count; i < d->vertex_count + d->edge_count; i++)
            along +=
                d->items[i].x[1] == 0.0 && d->items[i].x[2] == 0.0 && fabs(d->items[i].depth - 0.5) < 1e-5;
        assert_true(along >= 1);
    }
}

AROUND_EACH(NULL, body_rigs_free)
