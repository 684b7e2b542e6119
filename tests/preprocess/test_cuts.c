/* Growth stops when the rest of the component falls apart, and only then; cuts through a band are shortest; of those that show as
 * much the cheapest is made. */
#include "preprocess/regions/cut.h"
#include "preprocess/regions/cut_selection.h"
#include "preprocess/regions/grow.h"
#include "src/mesh/surface.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/preprocess/region_check.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <string.h>

enum { TRIANGLES_MAX = SHAPE_TRIANGLES_MAX };

/* A mesh on which every triangle has area 1, and a growth on it. */
typedef struct field {
    cscd_context *context;
    cscd_mesh *mesh;
    dual_graph graph;
    growth growth;
    double areas[TRIANGLES_MAX];
    uint32_t cluster[TRIANGLES_MAX], cluster_size;
} field;

static field f;

static void open_field(const shape *s) {
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles[0]);
    memset(&f, 0, sizeof f);
    for (uint32_t t = 0; t < TRIANGLES_MAX; t++) f.areas[t] = 1.0;
    expect_ok(cscd_context_create(NULL, &f.context));
    expect_ok(cscd_mesh_create(f.context, &desc, 1, &f.mesh));
    expect_ok(dual_graph_build(f.mesh, &f.graph));
    expect_ok(growth_create(f.mesh, &f.graph, f.areas, &f.growth));
}

static void close_field(void) {
    growth_destroy(&f.growth);
    dual_graph_free(f.mesh, &f.graph);
    cscd_mesh_destroy(f.mesh);
    cscd_context_destroy(f.context);
}

/* Starts with rows x columns quads of a cylinder or torus; the triangles of quad (i, j) are
 * 2 (i columns + j) and the next one. */
static void open_grid(uint32_t rows, uint32_t columns, bool rows_close) {
    shape s = {0};
    shape_add_grid(&s, rows, columns, rows_close, true);
    open_field(&s);
}

/* A closed surface: a cylinder with a fan over either end, whose triangles come last. */
static void open_can(uint32_t rows, uint32_t columns) {
    shape s = {0};
    shape_add_grid(&s, rows, columns, false, true);
    uint32_t low = s.vertex_count, high = low + 1, last = rows * columns;
    for (uint32_t j = 0; j < columns; j++) shape_add_triangle(&s, low, (j + 1) % columns, j);
    for (uint32_t j = 0; j < columns; j++) shape_add_triangle(&s, high, last + j, last + (j + 1) % columns);
    open_field(&s);
    assert_true(f.mesh->components[0].closed_manifold);
}

static void add_quads(uint32_t columns, uint32_t row, uint32_t first, uint32_t count) {
    for (uint32_t j = first; j < first + count; j++) {
        f.cluster[f.cluster_size++] = 2 * (row * columns + j);
        f.cluster[f.cluster_size++] = 2 * (row * columns + j) + 1;
    }
}

static bool cluster_separates(bool may_grow, double relevant_area) {
    return growth_separates(&f.growth, f.cluster, f.cluster_size, may_grow, relevant_area);
}

static uint32_t part_size(uint32_t part) {
    uint32_t size = 0;
    for (uint32_t t = 0; t < f.mesh->triangle_count; t++) size += f.growth.parts[t] == part;
    return size;
}

TEST(belt_separates_at_once) {
    open_can(9, 10);
    add_quads(10, 6, 0, 10);
    for (int may_grow = 0; may_grow < 2; may_grow++) {
        assert_true(cluster_separates(may_grow, 5.0));
        assert_int_equal(f.growth.band_ring, 0);
        assert_int_equal(f.growth.part_count, 2);
        assert_int_equal(part_size(0), 20);
        assert_int_equal(part_size(f.growth.largest_part), 130);
        assert_int_equal(part_size(3 - f.growth.largest_part), 50);
    }
    assert_false(cluster_separates(false, 51.0)); /* then the smaller part is an island */
    close_field();
}

/* A belt with a gap: two contours in one, and the seed's ring in two once it has grown by one. */
TEST(gap_is_closed_by_growth) {
    open_can(9, 12);
    add_quads(12, 5, 0, 7);
    assert_false(cluster_separates(false, 5.0));
    assert_true(cluster_separates(true, 5.0));
    assert_true(f.growth.band_ring >= 2 && f.growth.band_ring <= 3);
    assert_int_equal(f.growth.part_count, 2);
    close_field();
}

/* A loop around a torus has two contours, and the seed's growing ring is in two pieces at once; but the rest
 * hangs together, and does so until nothing is left. */
TEST(loop_on_a_torus_does_not_separate) {
    open_grid(12, 8, true);
    add_quads(8, 3, 0, 8);
    assert_false(cluster_separates(false, 1.0));
    assert_false(cluster_separates(true, 1.0));
    add_quads(8, 9, 0, 8); /* a second loop, and a bridge between them */
    for (uint32_t row = 4; row < 9; row++) add_quads(8, row, 2, 1);
    assert_true(cluster_separates(false, 1.0));
    assert_int_equal(f.growth.part_count, 2);
    close_field();
}

TEST(growth_over_everything) {
    open_can(8, 10);
    for (uint32_t j = 0; j < 10; j++) f.cluster[f.cluster_size++] = 160 + j; /* the lower fan */
    assert_false(cluster_separates(true, 1.0));
    assert_int_equal(f.growth.reached_count, f.mesh->triangle_count);
    for (uint32_t t = 0; t < f.mesh->triangle_count; t++) f.cluster[t] = t; /* nothing left from the start */
    f.cluster_size = f.mesh->triangle_count;
    assert_false(cluster_separates(true, 1.0));
    assert_false(cluster_separates(false, 1.0));
    close_field();
}

/* A hole in the cluster belongs to the band, unless it is as large as a part. */
TEST(islands_of_band) {
    open_can(9, 10);
    for (uint32_t row = 3; row < 6; row++) add_quads(10, row, 0, row == 4 ? 8 : 10);
    assert_true(cluster_separates(false, 5.0));
    assert_int_equal(f.growth.part_count, 2);
    assert_int_equal(part_size(0), 60);
    assert_true(cluster_separates(false, 4.0));
    assert_int_equal(f.growth.part_count, 3);
    assert_int_equal(part_size(0), 56);
    f.cluster_size = 0; /* a frame around an island, on one side */
    for (uint32_t row = 3; row < 6; row++) add_quads(10, row, 2, row == 4 ? 1 : 3);
    add_quads(10, 4, 4, 1);
    assert_false(cluster_separates(false, 3.0));
    assert_true(cluster_separates(false, 2.0));
    close_field();
}

static void cuts_of_all_parts(uint32_t *owners) {
    int64_t *capacities = context_allocate(f.context, f.graph.link_count, sizeof *capacities);
    for (uint32_t i = 0; i < f.graph.link_count; i++) capacities[i] = 1;
    cutter c;
    uint32_t band[TRIANGLES_MAX], side[TRIANGLES_MAX], band_size = 0;
    expect_ok(cutter_create(f.mesh, &f.graph, capacities, &c));
    for (uint32_t t = 0; t < f.mesh->triangle_count; t++) {
        owners[t] = f.growth.parts[t];
        if (owners[t] == 0) band[band_size++] = t;
    }
    for (uint32_t part = 1; part <= f.growth.part_count; part++) {
        uint32_t size = cutter_separate(&c, f.growth.parts, band, band_size, part, side);
        assert_true(c.cut.cost > 0);
        for (uint32_t i = 0; i < size; i++) {
            assert_int_equal(owners[side[i]], 0); /* no other part has it */
            owners[side[i]] = part;
        }
    }
    cutter_destroy(&c);
    context_free(f.context, capacities);
}

/* The rest falls into three parts at once, like a body with two legs. */
TEST(more_than_two_parts) {
    uint32_t owners[TRIANGLES_MAX];
    open_can(11, 8);
    add_quads(8, 3, 0, 8);
    add_quads(8, 7, 0, 8);
    for (uint32_t row = 4; row < 7; row++) add_quads(8, row, 2, 1);
    assert_true(cluster_separates(false, 5.0));
    assert_int_equal(f.growth.part_count, 3);
    cuts_of_all_parts(owners);
    close_field();
}

/* Two arms come off together, although the second alone would come off a little later than the first. */
TEST(a_little_further_for_more_parts) {
    open_can(18, 6);
    add_quads(6, 4, 0, 4);
    for (uint32_t row = 5; row < 13; row++) add_quads(6, row, 2, 1);
    add_quads(6, 13, 1, 2);
    assert_true(cluster_separates(true, 4.0));
    assert_int_equal(f.growth.part_count, 3);
    assert_int_equal(f.growth.relevant_counts[f.growth.band_ring - 1], 2);
    close_field();
}

TEST(other_components_take_no_part) {
    shape s = {0};
    shape_add_grid(&s, 6, 6, false, true);
    shape_add_tetrahedron(&s, s.vertex_count, s.vertex_count + 1, s.vertex_count + 2, s.vertex_count + 3);
    open_field(&s);
    add_quads(6, 2, 0, 6);
    assert_true(cluster_separates(true, 5.0));
    assert_int_equal(f.growth.reached_count, 72);
    for (uint32_t t = 72; t < 76; t++) assert_int_equal(f.growth.rings[t], UINT32_MAX);
    for (uint32_t i = 0; i < 4; i++) f.cluster[i] = 72 + i;
    f.cluster_size = 4;
    assert_false(cluster_separates(true, 0.0));
    assert_int_equal(f.growth.reached_count, 4);
    close_field();
}

/* The band's triangles in `set` stay with part 1. */
static int64_t cost_of(const int64_t *capacities, const uint32_t *parts, const uint32_t *places,
                       uint32_t set) {
    int64_t cost = 0;
    for (uint32_t t = 0; t < f.mesh->triangle_count; t++) {
        bool ours = parts[t] == 0 ? set >> places[t] & 1 : parts[t] == 1;
        for (uint32_t i = f.graph.offsets[t]; ours && i < f.graph.offsets[t + 1]; i++) {
            uint32_t other = f.graph.neighbours[i];
            bool theirs = parts[other] == 0 ? !(set >> places[other] & 1) : parts[other] != 1;
            if (theirs) cost += capacities[i];
        }
    }
    return cost;
}

/* The band is two rows of a cylinder; all 65,536 ways to cut it are tried, once per seed. */
TEST(shortest_of_all_cuts) {
    int64_t capacities[TRIANGLES_MAX * 4];
    uint32_t parts[TRIANGLES_MAX], places[TRIANGLES_MAX] = {0}, band[16], side[16], band_size = 0;
    open_grid(4, 4, false);
    for (uint32_t t = 0; t < 32; t++) {
        parts[t] = t < 8 ? 1 : t >= 24 ? 2 : 0;
        if (parts[t] == 0) places[t] = band_size, band[band_size++] = t;
    }
    cutter c;
    expect_ok(cutter_create(f.mesh, &f.graph, capacities, &c));
    for (uint64_t seed = 0; seed < 12; seed++) {
        random_seed(seed);
        for (uint32_t i = 0; i < f.graph.link_count; i++)
            capacities[i] = capacities[f.graph.twins[i]] = random_integer(0, seed % 2 == 0 ? 3 : 1000000);
        uint32_t size = cutter_separate(&c, parts, band, band_size, 1, side), found = 0;
        for (uint32_t i = 0; i < size; i++) found |= 1u << places[side[i]];
        int64_t least = INT64_MAX;
        uint32_t smallest = 0;
        for (uint32_t set = 0; set < 1u << 16; set++) {
            int64_t cost = cost_of(capacities, parts, places, set);
            uint32_t members = (uint32_t)__builtin_popcount(set);
            if (cost < least || (cost == least && members < smallest)) smallest = members;
            if (cost < least) least = cost;
        }
        assert_true(c.cut.cost == least && cost_of(capacities, parts, places, found) == least);
        assert_int_equal(size, smallest);
    }
    cutter_destroy(&c);
    close_field();
}

TEST(pieces_by_label) {
    open_grid(6, 5, false);
    static const uint32_t expected[6] = {0, 1, 2, 2, 3, 4}; /* by row */
    uint32_t labels[60], scratch[60], list[60];
    for (uint32_t t = 0; t < 60; t++) {
        list[t] = t;
        labels[t] = t / 10 == 1 || t / 10 == 4 ? 9 : 4;
    }
    assert_int_equal(dual_graph_pieces(&f.graph, list, 60, labels, labels, scratch), 5);
    for (uint32_t t = 0; t < 60; t++) assert_int_equal(labels[t], expected[t / 10]);
    close_field();
}

static double height_of(const body *b, uint32_t triangle) {
    double sum = 0.0;
    for (uint32_t k = 0; k < 3; k++) sum += b->positions[(size_t)b->triangles[triangle * 3 + k] * 3 + 2];
    return sum / 3.0;
}

/* A dumbbell is cut once: below, at or above the middle of its rod, where it costs least. */
TEST(the_cheapest_of_cuts_that_show_as_much) {
    enum { CUTS = 3, COUNT = 2000 };
    static const double heights[CUTS] = {-0.3, 0.0, 0.3};
    static const int64_t costs[CUTS][CUTS] = {{1, 2, 3}, {2, 1, 3}, {3, 2, 1}};
    body b = body_of(BODY_DUMBBELL, COUNT);
    cscd_mesh *mesh = body_mesh(&b, 1);
    uint32_t triangles[CUTS * COUNT], regions[COUNT], used = 0;
    size_t offsets[CUTS + 1] = {0};
    double areas[COUNT];
    dual_graph graph;
    assert_int_equal(b.triangle_count, COUNT);
    expect_ok(dual_graph_build(mesh, &graph));
    for (uint32_t t = 0; t < b.triangle_count; t++) areas[t] = surface_area(mesh, b.positions, t);
    for (int i = 0; i < CUTS; i++) {
        for (uint32_t t = 0; t < b.triangle_count; t++)
            if (height_of(&b, t) > heights[i]) triangles[used++] = t;
        offsets[i + 1] = used;
    }
    for (int cheapest = 0; cheapest < CUTS; cheapest++) {
        int64_t own[CUTS];
        memcpy(own, costs[cheapest], sizeof own);
        const cut_list cuts = {.count = CUTS, .offsets = offsets, .costs = own, .triangles = triangles};
        expect_ok(select_cuts(mesh, &graph, b.positions, areas, &cuts, 0.05, 0.1, regions));
        const uint32_t low = regions[0];
        for (uint32_t t = 0; t < b.triangle_count; t++)
            assert_int_equal(regions[t] == low, (height_of(&b, t) > heights[cheapest]) ==
                                                    (height_of(&b, 0) > heights[cheapest]));
    }
    dual_graph_free(mesh, &graph);
    body_mesh_destroy(mesh);
    body_free(&b);
}
