/* Vertices of very many triangles: the same contacts and intersections as of all pairs, and in near-linear time. */
#include "runtime/bvh/bvh_parts.h"
#include "src/core/vec3.h"
#include "src/mesh/mesh.h"
#include "src/mesh/predicates.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SEGMENTS = HUB_TRIANGLES + 4, SEEDS = 3 };

static scene shape; /* large; one test at a time */

typedef enum cone_kind { CONE_OPEN, CONE_CLOSED, CONE_FLAT, CONE_BOOK, CONE_KINDS } cone_kind;

static const double turn = 6.283185307179586;

/* ---- shapes -------------------------------------------------------------------------------------------- */

static void place_vertex(double *x, uint32_t vertex, double a, double b, double c) {
    x[vertex * 3] = a;
    x[vertex * 3 + 1] = b;
    x[vertex * 3 + 2] = c;
}

static uint32_t vertices_of(cone_kind kind, uint32_t segments) {
    return segments + (kind == CONE_CLOSED || kind == CONE_BOOK ? 2 : 1);
}

static uint32_t triangles_of(cone_kind kind, uint32_t segments) {
    return kind == CONE_CLOSED ? 2 * segments : kind == CONE_FLAT ? segments - 1 : segments;
}

/* An apex, 0, over a ring of corners; closed: there is a centre of the ring's floor as well. The ring of a flat one is no
 * circle around its apex, which lies on it. A book has its pages around the edge from the apex to a vertex below. */
static void write_cone(cone_kind kind, uint32_t segments, double *x, uint32_t *triangles) {
    const bool flat = kind == CONE_FLAT;
    place_vertex(x, 0, flat ? -1.0 : 0.0, 0.0, flat ? 0.0 : 1.0);
    for (uint32_t i = 0; i < segments; i++) {
        const double angle = flat ? turn * ((i + 0.5) / segments - 0.5) : turn * i / segments;
        const uint32_t next = 1 + (i + 1) % segments, below = 1 + segments;
        const uint32_t t[] = {0, 1 + i, kind == CONE_BOOK ? below : next, below, next, 1 + i};
        place_vertex(x, 1 + i, cos(angle), sin(angle), 0.0);
        if (i < triangles_of(kind, segments)) memcpy(triangles + 3 * i, t, 3 * sizeof *t);
        if (kind == CONE_CLOSED) memcpy(triangles + 3 * (segments + i), t + 3, 3 * sizeof *t);
    }
    if (kind == CONE_CLOSED) place_vertex(x, 1 + segments, 0.0, 0.0, 0.0);
    if (kind == CONE_BOOK) place_vertex(x, 1 + segments, 0.0, 0.0, -1.0);
}

/* Waves at both ends, a fold, a spin of up to half a turn, and a tip that may go through the floor. */
static void make_motion(cone_kind kind, uint64_t seed) {
    random_stream random = stream_start(seed * 3 + kind);
    const double spin = seed % 2 == 0 ? 0.0 : stream_between(&random, -3.0, 3.0);
    const double fold = stream_between(&random, 0.0, 1.5), wave = stream_between(&random, 0.01, 0.4);
    scene_clear(&shape);
    shape.vertex_count = vertices_of(kind, SEGMENTS);
    shape.triangle_count = triangles_of(kind, SEGMENTS);
    write_cone(kind, SEGMENTS, shape.x0, shape.triangles);
    for (uint32_t v = 0; v < shape.vertex_count; v++) {
        double *p = shape.x0 + 3 * v, *q = shape.x1 + 3 * v;
        for (int k = 0; k < 3; k++) p[k] += seed % 3 == 0 ? 0.0 : stream_between(&random, -0.02, 0.02);
        place_vertex(shape.x1, v, p[0] * cos(spin) - p[1] * sin(spin), p[0] * sin(spin) + p[1] * cos(spin),
                     p[2]);
        q[0] += wave * sin(5.0 * p[1]);
        q[2] += fold * fabs(p[0]) + wave * cos(9.0 * p[0]);
    }
    shape.x1[2] -= stream_between(&random, 0.0, 2.5);
}

/* ---- directions ------------------------------------------------------------------------------------------ */

static void move_vertex(random_stream *random, uint32_t vertex) {
    for (uint32_t k = 3 * vertex; k < 3 * vertex + 3; k++) {
        shape.x0[k] = stream_between(random, -1.0, 1.0);
        shape.x1[k] = shape.x0[k] + stream_between(random, -1.0, 1.0);
    }
}

static void difference_at(double t, uint32_t from, uint32_t to, double out[3]) {
    for (uint32_t k = 0; k < 3; k++)
        out[k] = (1.0 - t) * (shape.x0[3 * to + k] - shape.x0[3 * from + k]) +
                 t * (shape.x1[3 * to + k] - shape.x1[3 * from + k]);
}

static void check_normals(const hub_volume *v, uint32_t corner) {
    for (int i = 0; i <= 16; i++) {
        double edge[3], side[3], normal[3];
        difference_at(i / 16.0, v->hub, v->other, edge);
        difference_at(i / 16.0, v->hub, corner, side);
        vec3_cross(edge, side, normal);
        const double length = sqrt(vec3_dot(normal, normal));
        for (int k = 0; k < 3; k++) assert_true(normal[k] >= v->low[k] * length - 1e-12);
        for (int k = 0; k < 3; k++) assert_true(normal[k] <= v->high[k] * length + 1e-12);
    }
}

/* A book in any motion, all pages of a leaf in the same one: whenever they are looked at, their normal is in the leaf's box. */
TEST(normals_of_pages_stay_in_their_box) {
    random_stream random = stream_start(17);
    size_t known = 0;
    bvh_rig r;
    make_motion(CONE_BOOK, 0);
    assert_true(bvh_rig_create(&shape, (bvh_setup){CSCD_SIMD_AUTO, 1, BOX_AXES, 1}, &r));
    const bvh_level *lowest = &r.bvh.levels[0];
    for (int round = 0; round < 1000; round++) {
        move_vertex(&random, 0);
        move_vertex(&random, 1 + SEGMENTS);
        for (uint32_t slot = 0; slot < r.bvh.leaf_count * LANES; slot++) {
            const uint32_t page = bvh_triangle(&r.bvh, slot);
            const uint32_t first = bvh_triangle(&r.bvh, slot / LANES * LANES);
            if (page == UINT32_MAX) continue;
            if (page == first) move_vertex(&random, 1 + page);
            memcpy(shape.x0 + 3 * (1 + page), shape.x0 + 3 * (1 + first), sizeof(double[3]));
            memcpy(shape.x1 + 3 * (1 + page), shape.x1 + 3 * (1 + first), sizeof(double[3]));
        }
        bvh_refit(&r.bvh, shape.x0, shape.x1, uniform_growth(0.0));
        for (uint32_t i = 0; i < lowest->block_count * LANES; i++) {
            const hub_volume *v = &lowest->child_hubs[i];
            if ((lowest->flags[i / LANES].used >> i % LANES & 1) == 0 || v->hub == NO_HUB) continue;
            const uint32_t leaf = lowest->first_children[i / LANES] + i % LANES;
            check_normals(v, 1 + bvh_triangle(&r.bvh, leaf * LANES));
            known++;
        }
    }
    print_message("  %zu pages have a box\n", known);
    assert_true(known > 1000);
    bvh_rig_destroy(&r);
}

/* ---- the same answers ------------------------------------------------------------------------------------ */

static size_t compare_step(const oracle_list *truth, const cscd_detector_options *options) {
    rig r = rig_create(&shape, 1, options);
    const cscd_contacts found = rig_step(&r, &shape);
    oracle_expect(truth, &found);
    rig_destroy(&r);
    return truth->count;
}

TEST(contacts_equal_brute_force) {
    oracle_list truth = {0};
    size_t contacts = 0, without = 0;
    for (cone_kind kind = 0; kind < CONE_KINDS; kind++) {
        for (uint64_t seed = 1; seed < SEEDS; seed++) {
            cscd_detector_options options = cscd_detector_defaults();
            make_motion(kind, seed);
            oracle_find(&shape, &truth);
            for (int method = 0; method < 2; method++) {
                options.method = method == 0 ? CSCD_METHOD_NONE : CSCD_METHOD_SINGLE;
                contacts += compare_step(&truth, &options);
            }
            without += truth.count == 0;
        }
    }
    print_message("  %zu contacts, %zu intervals without\n", contacts, without);
    assert_true(contacts > 10000);
    oracle_free(&truth);
}

/* Features that are near each other around the hub are found as well. */
TEST(distances_equal_brute_force) {
    oracle_list truth = {0};
    size_t contacts = 0;
    for (cone_kind kind = 0; kind < CONE_KINDS; kind++) {
        cscd_detector_options options = cscd_detector_defaults();
        const separation limit = {kind == CONE_FLAT ? 0.01 : 0.04, kind == CONE_FLAT ? 1e-8 : 4e-8};
        options.method = CSCD_METHOD_NONE;
        options.min_separation = limit.distance;
        make_motion(kind, 2);
        for (uint32_t i = 0; i < 3 * shape.vertex_count; i++) /* a short way, along which no side turns far */
            shape.x1[i] = shape.x0[i] + 0.02 * (shape.x1[i] - shape.x0[i]);
        oracle_find_within(&shape, &limit, &truth);
        contacts += compare_step(&truth, &options);
    }
    print_message("  %zu pairs within the distance\n", contacts);
    assert_true(contacts > 1000);
    oracle_free(&truth);
}

static size_t count_intersecting(const double *x) {
    const uint32_t(*t)[3] = (const uint32_t(*)[3])shape.triangles;
    size_t count = 0;
    for (uint32_t a = 0; a < shape.triangle_count; a++)
        for (uint32_t b = 0; b < a; b++) count += triangles_intersect(t[a], t[b], x);
    return count;
}

/* Returns how many pairs intersect. */
static size_t compare_check(const rig *r, const double *x) {
    cscd_intersections found;
    const size_t expected = count_intersecting(x);
    assert_int_equal(check_packed(r->detector, x, &found), CSCD_OK);
    assert_int_equal(found.count, expected);
    for (size_t i = 1; i < found.count; i++) /* each pair once */
        assert_true(memcmp(&found.items[i - 1], &found.items[i], sizeof *found.items) != 0);
    return expected;
}

TEST(intersections_equal_all_pairs) {
    size_t pairs = 0, without = 0;
    for (cone_kind kind = 0; kind < CONE_KINDS; kind++) {
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            make_motion(kind, seed);
            rig r = rig_create(&shape, 1, NULL);
            for (int end = 0; end < 2; end++) {
                const size_t expected = compare_check(&r, end == 0 ? shape.x0 : shape.x1);
                pairs += expected;
                without += expected == 0;
            }
            rig_destroy(&r);
        }
    }
    print_message("  %zu pairs intersect, %zu moments without\n", pairs, without);
    assert_true(pairs > 500 && without > 3);
}

/* Neighbours intersect only where they lie in one plane, folded over their common edge. */
TEST(folded_neighbours_are_found) {
    make_motion(CONE_FLAT, 1);
    for (uint32_t v = 0; v < shape.vertex_count; v++) shape.x0[3 * v + 2] = 0.0;
    rig r = rig_create(&shape, 1, NULL);
    assert_true(compare_check(&r, shape.x0) > 100);
    rig_destroy(&r);
}

/* Between two directions that differ much, a triangle lies in directions that no box around the two holds: slivers around
 * the x-axis cross eight triangles there, whose corners are far from it. */
TEST(wide_triangles_bulge) {
    enum { SLIVERS = HUB_TRIANGLES, WIDE = 8 };
    const double wide = 25.0 / 360.0 * turn;
    scene_clear(&shape);
    shape.vertex_count = 1 + SLIVERS + 2 * WIDE;
    shape.triangle_count = SLIVERS + WIDE;
    write_cone(CONE_OPEN, SLIVERS, shape.x0, shape.triangles);
    place_vertex(shape.x0, 0, 0.0, 0.0, 0.0);
    for (uint32_t i = 0; i < SLIVERS; i++)
        place_vertex(shape.x0, 1 + i, 1.0, 0.02 * cos(turn * i / SLIVERS), 0.02 * sin(turn * i / SLIVERS));
    for (uint32_t i = 0; i < WIDE; i++) {
        const uint32_t t[3] = {0, 1 + SLIVERS + 2 * i, 2 + SLIVERS + 2 * i};
        memcpy(shape.triangles + 3 * (SLIVERS + i), t, sizeof t);
        place_vertex(shape.x0, t[1], 10.0 * cos(wide), 10.0 * sin(wide), 0.001 * i);
        place_vertex(shape.x0, t[2], 10.0 * cos(wide), -10.0 * sin(wide), -0.002 * i);
    }
    rig r = rig_create(&shape, 1, NULL);
    assert_true(compare_check(&r, shape.x0) >= 2 * WIDE);
    rig_destroy(&r);
}

/* ---- cost ------------------------------------------------------------------------------------------------ */

/* Returns how many pairs of volumes a step compares in which the cone leans over. */
static double count_boxes(cone_kind kind, uint32_t segments) {
    const uint32_t vertices = vertices_of(kind, segments), count = triangles_of(kind, segments);
    double *x0 = malloc(vertices * 3 * sizeof *x0), *x1 = malloc(vertices * 3 * sizeof *x1);
    uint32_t *triangles = malloc(count * 3 * sizeof *triangles);
    assert_true(x0 != NULL && x1 != NULL && triangles != NULL);
    write_cone(kind, segments, x0, triangles);
    for (uint32_t v = 0; v < vertices; v++)
        place_vertex(x1, v, x0[3 * v] + 0.01 * x0[3 * v + 2], x0[3 * v + 1], x0[3 * v + 2]);
    cscd_contacts found;
    cscd_detector_options options = cscd_detector_defaults();
    const cscd_object_desc desc = cscd_object_of_triangles(vertices, count, triangles);
    options.method = CSCD_METHOD_NONE;
    rig r = rig_of_objects(context_of(0, NULL), &desc, 1, NULL, &options);
    assert_int_equal(step_packed(r.detector, x0, x1, &found), CSCD_OK);
    assert_int_equal(found.count, 0);
    const cscd_counters counters = cscd_detector_counters(r.detector);
    rig_destroy(&r);
    free(x0);
    free(x1);
    free(triangles);
    return (double)counters.boxes_tested;
}

TEST(four_times_the_triangles_take_no_sixteenfold) {
    for (cone_kind kind = 0; kind < CONE_KINDS; kind++) {
        const double few = count_boxes(kind, 2000), many = count_boxes(kind, 8000);
        print_message("  kind %d: %.0f and %.0f pairs of volumes\n", (int)kind, few, many);
        assert_true(many < fmax(6.0 * few, 15.0 * 8000)); /* without hubs 16 times, and 4,000 a triangle */
    }
}
