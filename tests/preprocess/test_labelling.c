/* Tiles and what is done with them: sums, halves, labellings of low cost, connected regions. */
#include "preprocess/regions/cover.h"
#include "src/mesh/surface.h"
#include "tests/support/preprocess/region_check.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* A body of one component, its edges with random weights of up to their length, and its tiles. */
typedef struct tiled_body {
    body shape;
    cscd_mesh *mesh;
    dual_graph graph;
    double *weights;
    uint32_t *list, *tile_of, *scratch, tile_count;
    tile_surface surface;
    tile_component component;
    tile_graph g;
} tiled_body;

static tiled_body *make_tiled(body_kind kind, uint32_t triangle_count) {
    tiled_body *b = body_allocate(1, sizeof *b);
    b->shape = body_of(kind, triangle_count);
    b->mesh = body_mesh(&b->shape, 1);
    const uint32_t count = b->shape.triangle_count;
    assert_int_equal(dual_graph_build(b->mesh, &b->graph), CSCD_OK);
    b->weights = body_allocate(b->mesh->edge_count, sizeof *b->weights);
    for (uint32_t e = 0; e < b->mesh->edge_count; e++)
        b->weights[e] = surface_edge_length(b->mesh, b->shape.positions, e) * random_between(0.1, 1.0);
    b->list = body_allocate(count, sizeof *b->list);
    b->tile_of = body_allocate(count, sizeof *b->tile_of);
    b->scratch = body_allocate(count, sizeof *b->scratch);
    for (uint32_t t = 0; t < count; t++) b->list[t] = t;
    b->surface = (tile_surface){b->mesh, b->shape.positions, b->weights, &b->graph};
    b->component = tiles_component(&b->surface, b->list, count);
    b->tile_count = tiles_number(&b->surface, &b->component, b->tile_of, b->scratch);
    assert_int_equal(tiles_create(&b->surface, &b->component, b->tile_of, b->tile_count, &b->g), CSCD_OK);
    return b;
}

static void free_tiled(tiled_body *b) {
    tiles_destroy(&b->g);
    dual_graph_free(b->mesh, &b->graph);
    body_mesh_destroy(b->mesh);
    body_free(&b->shape);
    free(b->weights);
    free(b->list);
    free(b->tile_of);
    free(b->scratch);
    free(b);
}

/* ---- tiles ----------------------------------------------------------------------------------------------- */

/* Weights of links are those of the edges between different tiles, and areas those of all triangles. */
static void check_sums(const tiled_body *b) {
    double area = 0.0, between = 0.0, linked = 0.0;
    for (uint32_t t = 0; t < b->shape.triangle_count; t++)
        area += surface_area(b->mesh, b->shape.positions, t) * b->component.scale * b->component.scale;
    for (uint32_t e = 0; e < b->mesh->edge_count; e++) {
        const uint32_t *star = b->mesh->edge_stars + b->mesh->edge_star_offsets[e];
        if (b->tile_of[star[0]] != b->tile_of[star[1]]) between += b->weights[e] * b->component.scale;
    }
    for (uint32_t j = 0; j < b->g.flow.link_count; j++) {
        linked += 0.5 * b->g.weights[j];
        assert_int_equal(b->g.twins[b->g.twins[j]], j);
        assert_true(b->g.weights[j] == b->g.weights[b->g.twins[j]]);
    }
    assert_true(fabs(b->g.area - area) < 1e-12 * area);
    assert_true(fabs(linked - between) < 1e-12 * between);
}

static void tiles_add_up(void **state) {
    (void)state;
    tiled_body *small = make_tiled(BODY_PAWN, 1000), *large = make_tiled(BODY_FIGURE, 12000);
    assert_int_equal(small->tile_count, 1000);
    assert_true(large->tile_count > 2000 && large->tile_count < 6000);
    check_sums(small);
    check_sums(large);
    free_tiled(small);
    free_tiled(large);
}

/* Marked tiles fall into pieces, and others stay as they are. */
static void halves_lie_in_their_tiles(void **state) {
    (void)state;
    tiled_body *b = make_tiled(BODY_FIGURE, 12000);
    const uint32_t count = b->shape.triangle_count;
    uint32_t *before = body_allocate(count, sizeof *before), *first = body_allocate(count, sizeof *first);
    bool *marked = body_allocate(b->tile_count, sizeof *marked);
    for (uint32_t i = 0; i < b->tile_count; i++) marked[i] = random_integer(0, 3) == 0;
    memcpy(before, b->tile_of, count * sizeof *before);
    tiles_destroy(&b->g);
    const uint32_t after = tiles_halve(&b->surface, &b->component, marked, b->tile_of, b->scratch);
    assert_true(after > b->tile_count);
    memset(first, 0xff, count * sizeof *first);
    uint32_t whole = 0;
    for (uint32_t t = 0; t < count; t++) {
        uint32_t *from = &first[b->tile_of[t]];
        if (*from == UINT32_MAX) *from = before[t];
        assert_int_equal(*from, before[t]);
    }
    for (uint32_t i = 0; i < after; i++) whole += !marked[first[i]];
    for (uint32_t i = 0; i < b->tile_count; i++) whole -= !marked[i];
    assert_int_equal(whole, 0);
    b->tile_count = after;
    assert_int_equal(tiles_create(&b->surface, &b->component, b->tile_of, after, &b->g), CSCD_OK);
    check_sums(b);
    free(before);
    free(first);
    free(marked);
    free_tiled(b);
}

/* ---- labellings ------------------------------------------------------------------------------------------ */

static void random_point(const tiled_body *b, double point[3]) {
    const tile *t = &b->g.items[random_integer(0, (int)b->tile_count - 1)];
    const double depth = random_between(0.3, 1.2);
    for (int k = 0; k < 3; k++) point[k] = depth * t->centroid[k];
}

/* Against all labellings of twelve triangles with two regions. */
static void two_regions_cost_the_least(void **state) {
    (void)state;
    random_seed(2);
    for (int round = 0; round < 40; round++) {
        const labelling_prices prices = {0.01, random_between(0.0, 0.5)};
        tiled_body *b = make_tiled(BODY_CUBE, 12);
        tile_labelling l;
        double point[3];
        assert_int_equal(labelling_create(&b->g, &prices, &l), CSCD_OK);
        random_point(b, l.regions.points[0]);
        random_point(b, point);
        labelling_add(&l, point);
        tile_labelling all = l;
        uint32_t labels[12];
        double least = INFINITY;
        all.of_tile = labels;
        for (uint32_t set = 0; set < 1u << 12; set++) {
            for (uint32_t t = 0; t < 12; t++) labels[t] = set >> t & 1;
            least = fmin(least, labelling_cost(&all));
        }
        labelling_share_out(&l);
        const double without =
            (2 - l.regions.count) * prices.region * b->g.area; /* an empty region is left out */
        assert_true(fabs(labelling_cost(&l) + without - least) <= 1e-9 * b->g.area);
        labelling_destroy(&l);
        free_tiled(b);
    }
}

static void costs_never_rise(void **state) {
    (void)state;
    random_seed(3);
    for (int round = 0; round < 20; round++) {
        const labelling_prices prices = {0.01, random_between(0.0, 0.1)};
        tiled_body *b = make_tiled(round % 2 ? BODY_FIGURE : BODY_TORUS, 1000);
        tile_labelling l;
        double point[3];
        assert_int_equal(labelling_create(&b->g, &prices, &l), CSCD_OK);
        random_point(b, l.regions.points[0]);
        for (int i = 0; i < 5; i++) {
            random_point(b, point);
            labelling_add(&l, point);
        }
        for (uint32_t t = 0; t < b->tile_count; t++) {
            const uint32_t region = (uint32_t)random_integer(0, 5);
            labelling_give(&l, &t, 1, region);
        }
        const double before = labelling_cost(&l);
        labelling_share_out(&l);
        const double after = labelling_cost(&l);
        assert_true(after <= before);
        for (uint32_t t = 0; t < b->tile_count;
             t++) { /* no tile alone can make it better by more than roundings */
            const uint32_t own = l.of_tile[t];
            for (uint32_t r = 0; r < l.regions.count && round < 4; r++) {
                l.of_tile[t] = r;
                assert_true(labelling_cost(&l) >= after - 1e-9 * b->g.area);
            }
            l.of_tile[t] = own;
        }
        labelling_destroy(&l);
        free_tiled(b);
    }
}

static void regions_become_connected(void **state) {
    (void)state;
    random_seed(4);
    for (int round = 0; round < 10; round++) {
        const labelling_prices prices = {0.01, 0.01};
        tiled_body *b = make_tiled(BODY_FIGURE, 1000);
        tile_labelling l;
        assert_int_equal(labelling_create(&b->g, &prices, &l), CSCD_OK);
        for (int i = 0; i < 3; i++) labelling_add(&l, (double[3]){0.0, 0.0, 0.1 * i});
        for (uint32_t t = 0; t < b->tile_count; t++) { /* stripes, so that each region has several pieces */
            const double *p = b->g.items[t].centroid;
            const uint32_t region = (uint32_t)(40.0 * (p[0] + 0.3 * round * p[2] + 2.0)) % 4;
            labelling_give(&l, &t, 1, region);
        }
        labelling_connect(&l);
        uint32_t *pieces = body_allocate(b->tile_count, sizeof *pieces), region_pieces[REGIONS_MOST] = {0};
        const uint32_t count =
            dual_graph_pieces(&b->graph, b->list, b->tile_count, l.of_tile, pieces, b->scratch);
        for (uint32_t i = 0, seen = 0; i < b->tile_count; i++)
            if (pieces[i] == seen) region_pieces[l.of_tile[i]]++, seen++;
        for (uint32_t r = 0; r < l.regions.count; r++) assert_int_equal(region_pieces[r], 1);
        assert_int_equal(count, l.regions.count);
        free(pieces);
        labelling_destroy(&l);
        free_tiled(b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_add_up),
        cmocka_unit_test(halves_lie_in_their_tiles),
        cmocka_unit_test(two_regions_cost_the_least),
        cmocka_unit_test(costs_never_rise),
        cmocka_unit_test(regions_become_connected),
    };
    return cmocka_run_group_tests_name("labelling", tests, NULL, NULL);
}
