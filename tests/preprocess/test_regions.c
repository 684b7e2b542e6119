/* Bodies are cut where one would expect it, and detector points see more after it. */
#include "preprocess/preprocess.h"
#include "preprocess/regions/regions.h"
#include "src/mesh/surface.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/preprocess/tiled_body.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The bodies up to the sphere. */
enum { TRIANGLES_MAX = 6000, REGIONS_MAX = 200, BODIES = BODY_SPHERE + 1 };

/* The charged bodies, made once. */
typedef struct charged {
    body shape;
    double density[TRIANGLES_MAX];
} charged;

static charged bodies[BODIES];

/* The regions that regions_from_charge finds, and how much of them is visible. */
typedef struct division {
    uint32_t count, regions[TRIANGLES_MAX];
    double share, points[REGIONS_MAX * 3];
} division;

static division found, other;

static int make_bodies(void **state) {
    (void)state;
    for (int kind = 0; kind < BODIES; kind++) {
        charged *c = &bodies[kind];
        double capacitance[1];
        c->shape = body_of((body_kind)kind, 2000);
        if (c->shape.triangle_count > TRIANGLES_MAX) return -1;
        cscd_mesh *mesh = body_mesh(&c->shape, 1);
        cscd_status status = charge_solve(mesh, c->shape.positions, &(charge_options){CSCD_CHARGE_TREE, 0},
                                          c->density, capacitance, NULL);
        body_mesh_destroy(mesh);
        if (status != CSCD_OK) return -1;
    }
    return 0;
}

static int free_bodies(void **state) {
    (void)state;
    for (int kind = 0; kind < BODIES; kind++) body_free(&bodies[kind].shape);
    return 0;
}

static double centroids_share(const cscd_mesh *mesh, const double *positions, division *d) {
    assert_true(d->count <= REGIONS_MAX);
    expect_ok(detector_points_from_regions(mesh, positions, d->regions, d->count, d->points));
    return visible_share(mesh, positions, d->regions, d->points);
}

static double single_share(const cscd_mesh *mesh, const double *positions) {
    static division single;
    expect_ok(regions_single(mesh, single.regions, &single.count));
    check_regions(mesh, single.regions, single.count);
    assert_int_equal(single.count, mesh->component_count);
    return centroids_share(mesh, positions, &single);
}

static void divide_with(const body *b, const double *density, const region_options *options, division *out) {
    cscd_mesh *mesh = body_mesh(b, 1);
    size_t bytes = cscd_context_describe(mesh->context).bytes;
    memset(out, 0xff, sizeof *out);
    assert_true(b->triangle_count <= TRIANGLES_MAX);
    double *points = NULL;
    cscd_status status =
        regions_from_charge(mesh, b->positions, density, options, out->regions, &out->count, &points);
    expect_ok(status);
    assert_true(out->count <= REGIONS_MAX);
    memcpy(out->points, points, out->count * sizeof(double[3]));
    out->share = visible_share(mesh, b->positions, out->regions, points);
    context_free(mesh->context, points);
    assert_int_equal(cscd_context_describe(mesh->context).bytes, bytes);
    check_regions(mesh, out->regions, out->count);
    assert_true(out->share >= single_share(mesh, b->positions));
    body_mesh_destroy(mesh);
}

static void divide_body(const body *b, const double *density, division *out) {
    divide_with(b, density, NULL, out);
}

/* Prints the mean and range of the visible shares over five seeds. */
static void print_shares(const body *b, const char *name, const division *d) {
    static double points[TRIANGLES_MAX * 3];
    double mean = 0.0, least = 1.0, most = 0.0;
    cscd_mesh *mesh = body_mesh(b, 1);
    for (uint32_t seed = 1; seed <= 5; seed++) {
        expect_ok(regions_kmeans(mesh, b->positions, d->count, seed, other.regions, &other.count, points));
        double share = visible_share(mesh, b->positions, other.regions, points);
        mean += share / 5.0;
        least = fmin(least, share);
        most = fmax(most, share);
    }
    print_message("  %s, %u triangles: %u regions; visible: charge %.3f, single %.3f, k-means %.3f (%.3f to "
                  "%.3f)\n",
                  name, b->triangle_count, d->count, d->share, single_share(mesh, b->positions), mean, least,
                  most);
    body_mesh_destroy(mesh);
}

static void assert_same(const division *a, const division *b) {
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->regions, b->regions, sizeof a->regions);
}

static uint32_t region_at(const body *b, const division *d, double x, double y, double z) {
    uint32_t nearest = 0;
    double least = INFINITY;
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const double *p = b->positions + (size_t)b->triangles[t * 3] * 3;
        double distance = hypot(hypot(p[0] - x, p[1] - y), p[2] - z);
        if (distance >= least) continue;
        least = distance;
        nearest = t;
    }
    return d->regions[nearest];
}

/* Foot, ring and head; two balls; head, arms, legs and trunk. */
TEST(bodies_are_divided) {
    static const struct expectation {
        uint32_t least, most;
        double share, apart[6][3]; /* points of different regions */
        uint32_t apart_count;
    } expected[BODIES] = {
        [BODY_PAWN] = {2, 4, 0.99, {{1.0, 0, 0.12}, {0, 0, 2.97}}, 2},
        [BODY_DUMBBELL] = {2, 3, 0.98, {{0, 0, -2.05}, {0, 0, 2.05}}, 2},
        [BODY_FIGURE] =
            {6,
             9,
             0.96,
             {{0, 0, 1.87}, {0, -0.16, 1.2}, {0.7, 0, 0.95}, {-0.7, 0, 0.95}, {0.3, 0, 0}, {-0.3, 0, 0}},
             6},
        [BODY_SPHERE] = {1, 1, 1.0, {{0, 0, 1}}, 1},
    };
    for (int kind = 0; kind < BODIES; kind++) {
        const body *b = &bodies[kind].shape;
        divide_body(b, bodies[kind].density, &found);
        print_shares(b, body_kind_name((body_kind)kind), &found);
        assert_true(found.count >= expected[kind].least && found.count <= expected[kind].most);
        assert_true(found.share >= expected[kind].share);
        for (uint32_t i = 0; i < expected[kind].apart_count; i++) {
            const double *p = expected[kind].apart[i];
            for (uint32_t j = 0; j < i; j++) {
                const double *q = expected[kind].apart[j];
                assert_true(region_at(b, &found, p[0], p[1], p[2]) != region_at(b, &found, q[0], q[1], q[2]));
            }
        }
    }
}

TEST(repeatable_regions) {
    const charged *c = &bodies[BODY_FIGURE];
    double capacitance[1], *density = malloc(c->shape.triangle_count * sizeof *density);
    divide_body(&c->shape, c->density, &found);
    cscd_mesh *mesh = body_mesh(&c->shape, 1);
    expect_ok(charge_solve(mesh, c->shape.positions, &(charge_options){CSCD_CHARGE_TREE, 0}, density,
                           capacitance, NULL));
    body_mesh_destroy(mesh);
    divide_body(&c->shape, density, &other);
    assert_same(&found, &other);
    free(density);
}

/* A scale of a power of two changes no rounding, the unit of charge no rank. */
TEST(units_do_not_matter) {
    const charged *c = &bodies[BODY_PAWN];
    divide_body(&c->shape, c->density, &found);
    for (int exponent = -290; exponent <= 290; exponent += 145) {
        body scaled = {0};
        double *density = malloc(c->shape.triangle_count * sizeof *density);
        body_append(&scaled, &c->shape, (double[3]){0, 0, 0});
        for (uint32_t i = 0; i < scaled.vertex_count * 3; i++)
            scaled.positions[i] = ldexp(scaled.positions[i], exponent);
        for (uint32_t t = 0; t < scaled.triangle_count; t++) density[t] = ldexp(c->density[t], -exponent);
        divide_body(&scaled, density, &other);
        assert_same(&found, &other);
        body_free(&scaled);
        free(density);
    }
}

/* Each component is divided as if it were alone. */
TEST(two_components) {
    const charged *a = &bodies[BODY_DUMBBELL], *b = &bodies[BODY_SPHERE];
    static charged both;
    both.shape = (body){0};
    body_append(&both.shape, &b->shape, (double[3]){0, 0, 0});
    body_append(&both.shape, &a->shape, (double[3]){5, 0, 0});
    uint32_t first = b->shape.triangle_count;
    assert_true(both.shape.triangle_count <= TRIANGLES_MAX);
    memcpy(both.density, b->density, first * sizeof *both.density);
    memcpy(both.density + first, a->density, a->shape.triangle_count * sizeof *both.density);
    divide_body(&a->shape, a->density, &other);
    divide_body(&both.shape, both.density, &found);
    assert_int_equal(found.count, other.count + 1);
    for (uint32_t t = 0; t < first; t++) assert_int_equal(found.regions[t], 0);
    for (uint32_t t = 0; t < a->shape.triangle_count; t++)
        assert_int_equal(found.regions[first + t], other.regions[t] + 1);
    body_free(&both.shape);
}

/* Whatever the density, a ball stays whole: clusters of noise grow over everything, and no cut would pay. */
TEST(noise_does_not_cut_a_ball) {
    const body *b = &bodies[BODY_SPHERE].shape;
    double *density = malloc(b->triangle_count * sizeof *density);
    for (int round = 0; round < 10; round++) {
        random_seed((uint64_t)round);
        for (uint32_t t = 0; t < b->triangle_count; t++) {
            double z = b->positions[b->triangles[t * 3] * 3 + 2];
            density[t] = round == 0 ? 1.0 : round == 1 ? z : round == 2 ? fabs(z) : random_unit();
        }
        divide_body(b, density, &found);
        assert_int_equal(found.count, 1);
    }
    free(density);
}

/* The detector points never see less than a single one would, whatever waves of density suggest. */
TEST(never_less_than_single) {
    region_options options = region_options_defaults();
    options.threshold = 0.2;
    double *density = malloc(TRIANGLES_MAX * sizeof *density);
    uint32_t cut = 0;
    for (int round = 0; round < NIGHTLY(9, 90); round++) {
        const body *b = &bodies[round % 3].shape;
        random_seed((uint64_t)round);
        double waves[3] = {4.0 * random_unit(), 4.0 * random_unit(), 4.0 * random_unit()},
               phase = random_unit();
        for (uint32_t t = 0; t < b->triangle_count; t++) {
            const double *p = b->positions + (size_t)b->triangles[t * 3] * 3;
            density[t] = sin(waves[0] * p[0] + waves[1] * p[1] + waves[2] * p[2] + 4.0 * phase);
        }
        divide_with(b, density, &options, &found);
        cut += found.count > 1;
    }
    assert_true(cut >= 3);
    free(density);
}

/* A hole changes little, and a body that is inside out is still divided. */
TEST(open_and_inside_out) {
    body b = {0};
    const charged *c = &bodies[BODY_DUMBBELL];
    body_append(&b, &c->shape, (double[3]){0, 0, 0});
    b.triangle_count -= 5;
    divide_body(&b, c->density, &found);
    assert_int_equal(found.count, 2);
    b.triangle_count += 5;
    for (uint32_t t = 0; t < b.triangle_count; t++) {
        uint32_t swap = b.triangles[t * 3];
        b.triangles[t * 3] = b.triangles[t * 3 + 1];
        b.triangles[t * 3 + 1] = swap;
    }
    cscd_mesh *mesh = body_mesh(&b, 1);
    double *points = NULL;
    expect_ok(regions_from_charge(mesh, b.positions, c->density, NULL, other.regions, &other.count, &points));
    assert_int_equal(other.count, 2);
    context_free(mesh->context, points);
    body_mesh_destroy(mesh);
    body_free(&b);
}

/* Two cones that share a tip, a fin on an edge, a triangle alone: a region each, or what can be cut off. */
TEST(odd_meshes) {
    const double positions[][3] = {{0, 0, 0},  {1, 0, 1},    {0, 1, 1}, {-1, -1, 1}, {1, 0, -1},
                                   {0, 1, -1}, {-1, -1, -1}, {5, 5, 5}, {6, 5, 5},   {5, 6, 5}};
    const uint32_t triangles[][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 5, 4}, {0, 6, 5},
                                     {0, 4, 6}, {1, 2, 4}, {7, 8, 9}, {7, 8, 0}};
    for (uint32_t count = 1; count <= 9; count++) {
        body b = {0};
        double density[9];
        for (int i = 0; i < 10; i++) body_add_vertex(&b, positions[i][0], positions[i][1], positions[i][2]);
        for (uint32_t t = 0; t < count; t++) {
            body_add_triangle(&b, triangles[t][0], triangles[t][1], triangles[t][2]);
            density[t] = (double)(t * 5 % 7);
        }
        divide_body(&b, density, &found);
        region_options options = region_options_defaults();
        options.threshold = 0.3;
        divide_with(&b, density, &options, &other);
        body_free(&b);
    }
}

TEST(refuses_bad_options) {
    const charged *c = &bodies[BODY_PAWN];
    cscd_mesh *mesh = body_mesh(&c->shape, 1);
    uint32_t count = 77, regions[1] = {78};
    double *points = NULL;
    const double bad[] = {-0.1, 1.1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        region_options options = region_options_defaults();
        options.threshold = bad[i];
        expect_invalid(
            mesh->context,
            regions_from_charge(mesh, c->shape.positions, c->density, &options, regions, &count, &points),
            "threshold");
    }
    assert_true(count == 77 && regions[0] == 78 && points == NULL);
    body_mesh_destroy(mesh);
}

AROUND_ALL(make_bodies, free_bodies)
