/* Tiles and what is done with them: sums, halves, labellings of low cost. */
#include "src/mesh/surface.h"
#include "tests/support/preprocess/tiled_body.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

TEST(tiles_add_up) {
    tiled_body *small = tiled_body_make(BODY_PAWN, 1000), *large = tiled_body_make(BODY_FIGURE, 6000);
    assert_int_equal(small->tile_count, 1000);
    assert_true(large->tile_count > 2000 && large->tile_count < 6000);
    check_sums(small);
    check_sums(large);
    tiled_body_free(small);
    tiled_body_free(large);
}

/* Marked tiles fall into pieces, and others stay as they are. */
TEST(halves_lie_in_their_tiles) {
    tiled_body *b = tiled_body_make(BODY_FIGURE, 6000);
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
    expect_ok(tiles_create(&b->surface, &b->component, b->tile_of, after, &b->g));
    check_sums(b);
    free(before);
    free(first);
    free(marked);
    tiled_body_free(b);
}

/* ---- labellings ------------------------------------------------------------------------------------------ */

static sight_point random_point(const tiled_body *b) {
    sight_point point = {.rest = {0.0}};
    const tile *t = &b->g.items[random_integer(0, (int)b->tile_count - 1)];
    const double depth = random_between(0.3, 1.2);
    for (int k = 0; k < 3; k++) point.rest[k] = depth * t->centroid[k];
    return point;
}

/* The regions that have tiles. */
static uint32_t count_regions(const tile_labelling *l) {
    bool used[REGIONS_MOST] = {false};
    uint32_t count = 0;
    for (uint32_t t = 0; t < l->g->count; t++) used[l->of_tile[t]] = true;
    for (uint32_t r = 0; r < REGIONS_MOST; r++) count += used[r];
    return count;
}

/* Without a price of its own a border costs nothing: what it costs is the difference. */
TEST(borders_are_parts_of_the_cost) {
    const labelling_prices prices = {0.01, 0.05};
    tiled_body *b = tiled_body_make(BODY_FIGURE, 1000);
    tile_labelling l;
    double borders = 0.0;
    random_seed(6);
    expect_ok(labelling_create(&b->g, &prices, &l));
    for (int i = 0; i < 4; i++) labelling_add(&l, &(sight_point){.rest = {0.0, 0.0, 0.1 * i}}, 0);
    assert_true(labelling_border(&l, 0, 1) == -1.0);
    for (uint32_t t = 0; t < b->tile_count; t++) {
        const uint32_t region = (uint32_t)random_integer(0, 4);
        labelling_give(&l, &t, 1, region);
    }
    for (uint32_t r = 0; r < 5; r++) {
        for (uint32_t other = 0; other < r; other++) {
            const double border = labelling_border(&l, r, other), back = labelling_border(&l, other, r);
            assert_true(border > 0.0 && fabs(border - back) < 1e-9 * border);
            borders += border;
        }
    }
    const double cost = labelling_cost(&l);
    l.prices.border = 0.0;
    assert_true(fabs(cost - labelling_cost(&l) - borders) < 1e-9 * cost);
    labelling_destroy(&l);
    tiled_body_free(b);
}

/* Against all labellings of twelve triangles with two regions. */
TEST(two_regions_cost_the_least) {
    random_seed(2);
    for (int round = 0; round < 40; round++) {
        const labelling_prices prices = {0.01, random_between(0.0, 0.5)};
        tiled_body *b = tiled_body_make(BODY_CUBE, 12);
        tile_labelling l;
        expect_ok(labelling_create(&b->g, &prices, &l));
        l.regions.points[0] = random_point(b);
        const sight_point point = random_point(b);
        labelling_add(&l, &point, 0);
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
        assert_int_equal(l.regions.count, count_regions(&l));
        labelling_destroy(&l);
        tiled_body_free(b);
    }
}

/* Neither of two points sees a side of a cube, a sixth of its area: the nearer one takes it. */
TEST(large_costs_are_compared) {
    const labelling_prices prices = {0.0, 0.0};
    tiled_body *b = tiled_body_make(BODY_CUBE, 12);
    for (uint32_t side = 0; side < 12; side++) {
        tile_labelling l;
        sight_point points[2] = {{.rest = {0.0}}, {.rest = {0.0}}};
        double least = 0.0;
        expect_ok(labelling_create(&b->g, &prices, &l));
        for (int i = 0; i < 2; i++)
            for (int k = 0; k < 3; k++)
                points[i].rest[k] = (i == 0 ? 3.0 : 1.5) * b->g.items[side].centroid[k];
        l.regions.points[0] = points[0];
        labelling_add(&l, &points[1], 0);
        for (uint32_t t = 0; t < 12; t++) {
            double costs[2];
            for (uint32_t i = 0; i < 2; i++) {
                labelling_give(&l, &t, 1, i);
                costs[i] = labelling_cost(&l);
            }
            labelling_give(&l, &t, 1, 0);
            if (t == 0) least = costs[0];
            least += fmin(costs[1] - costs[0], 0.0);
        }
        labelling_share_out(&l);
        assert_true(fabs(labelling_cost(&l) - least) <= 1e-9 * b->g.area);
        labelling_destroy(&l);
    }
    tiled_body_free(b);
}

TEST(costs_never_rise) {
    random_seed(3);
    for (int round = 0; round < 8; round++) {
        const labelling_prices prices = {0.01, random_between(0.0, 0.1)};
        tiled_body *b = tiled_body_make(round % 2 ? BODY_FIGURE : BODY_TORUS, 1000);
        tile_labelling l;
        expect_ok(labelling_create(&b->g, &prices, &l));
        l.regions.points[0] = random_point(b);
        for (int i = 0; i < 5; i++) {
            const sight_point point = random_point(b);
            labelling_add(&l, &point, 0);
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
        tiled_body_free(b);
    }
}

/* A region that has not changed itself takes tiles of one beside it, whose point has come to see nothing. */
TEST(neighbours_take_what_is_not_seen) {
    random_seed(5);
    for (int round = 0; round < 8; round++) {
        const labelling_prices prices = {0.01, random_between(0.0, 0.05)};
        tiled_body *b = tiled_body_make(round % 2 ? BODY_FIGURE : BODY_TORUS, 1000);
        tile_labelling l;
        expect_ok(labelling_create(&b->g, &prices, &l));
        l.regions.points[0] = random_point(b);
        for (int i = 0; i < 3; i++) {
            const sight_point point = random_point(b);
            labelling_add(&l, &point, 0);
        }
        for (uint32_t t = 0; t < b->tile_count; t++) {
            const uint32_t region = (uint32_t)random_integer(0, 3);
            labelling_give(&l, &t, 1, region);
        }
        double before, after = INFINITY;
        do {
            before = after;
            labelling_share_out(&l);
            after = labelling_cost(&l);
        } while (after < before);
        const uint32_t region = l.of_tile[0], first = 0;
        const uint32_t count = l.regions.count;
        for (int k = 0; k < 3; k++) l.regions.points[region].rest[k] = 1e3; /* far outside */
        labelling_give(&l, &first, 1, region);                              /* says that it has changed */
        before = labelling_cost(&l);
        labelling_share_out(&l);
        assert_true(count == 1 || labelling_cost(&l) < before - 1e-3 * b->g.area);
        labelling_destroy(&l);
        tiled_body_free(b);
    }
}

/* Borders that cost many times what the body's area does, as those of a needle do, are not made. */
TEST(no_price_is_too_high) {
    static const double heights[] = {1e6, 1e10, 1e30, 1e300};
    random_seed(4);
    for (int i = 0; i < 4; i++) {
        const labelling_prices prices = {0.01, heights[i]};
        tiled_body *b = tiled_body_make(BODY_TORUS, 1000);
        tile_labelling l;
        expect_ok(labelling_create(&b->g, &prices, &l));
        const sight_point point = random_point(b);
        labelling_add(&l, &point, 0);
        for (uint32_t t = 0; t < b->tile_count; t++) {
            const uint32_t region = (uint32_t)random_integer(0, 1);
            labelling_give(&l, &t, 1, region);
        }
        labelling_share_out(&l);
        assert_int_equal(l.regions.count, 1); /* which has no border */
        labelling_destroy(&l);
        tiled_body_free(b);
    }
}
