/* Orders of elimination: each row once, and little fill. */
#include "runtime/untangle/fill_order.h"

#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <stdlib.h>
#include <string.h>

AROUND_ALL(open_levels, close_levels)

/* ---- graphs -------------------------------------------------------------------------------------------------- */

enum { PAIRS_MOST = 60000 };

typedef struct drawn_pairs {
    uint32_t row_count;
    size_t count;
    uint32_t pairs[PAIRS_MOST][2];
} drawn_pairs;

static drawn_pairs drawn; /* of the test at hand */

static void begin_pairs(uint32_t row_count) {
    drawn.row_count = row_count;
    drawn.count = 0;
}

static void draw_pair(uint32_t i, uint32_t j) {
    assert_true(drawn.count < PAIRS_MOST && i != j && i < drawn.row_count && j < drawn.row_count);
    drawn.pairs[drawn.count][0] = i;
    drawn.pairs[drawn.count++][1] = j;
}

typedef struct drawn_graph {
    size_t *begins;
    uint32_t *neighbours;
    row_graph graph;
} drawn_graph;

/* The graph of all pairs, none of which is repeated. */
static drawn_graph graph_of_pairs(void) {
    const uint32_t n = drawn.row_count;
    drawn_graph g = {.begins = calloc((size_t)n + 2, sizeof(size_t)),
                     .neighbours = malloc((2 * drawn.count + 1) * sizeof(uint32_t))};
    for (size_t k = 0; k < 2 * drawn.count; k++) g.begins[drawn.pairs[k / 2][k % 2] + 2]++;
    for (uint32_t i = 0; i < n; i++) g.begins[i + 2] += g.begins[i + 1];
    for (size_t k = 0; k < 2 * drawn.count; k++)
        g.neighbours[g.begins[drawn.pairs[k / 2][k % 2] + 1]++] = drawn.pairs[k / 2][1 - k % 2];
    g.graph = (row_graph){n, g.begins, g.neighbours};
    return g;
}

static void free_graph(drawn_graph *g) {
    free(g->begins);
    free(g->neighbours);
}

static void draw_random(random_stream *random, uint32_t row_count, uint32_t pairs) {
    bool *is_drawn = calloc((size_t)row_count * row_count + 1, sizeof *is_drawn);
    begin_pairs(row_count);
    for (uint32_t k = 0; k < pairs; k++) {
        const uint32_t i = stream_below(random, row_count), j = stream_below(random, row_count);
        if (i == j || is_drawn[i * row_count + j]) continue;
        is_drawn[i * row_count + j] = is_drawn[j * row_count + i] = true;
        draw_pair(i, j);
    }
    free(is_drawn);
}

/* With or without one diagonal a square; the numbers are shuffled. */
static void draw_grid(uint32_t side, bool diagonals) {
    random_stream random = stream_start(side);
    uint32_t *names = malloc((size_t)side * side * sizeof *names);
    for (uint32_t v = 0; v < side * side; v++) {
        const uint32_t other = stream_below(&random, v + 1);
        names[v] = names[other];
        names[other] = v;
    }
    begin_pairs(side * side);
    for (uint32_t v = 0; v < side * side; v++) {
        const bool right = v % side + 1 < side, up = v / side + 1 < side;
        if (right) draw_pair(names[v], names[v + 1]);
        if (up) draw_pair(names[v], names[v + side]);
        if (right && up && diagonals) draw_pair(names[v], names[v + side + 1]);
    }
    free(names);
}

/* ---- fill ---------------------------------------------------------------------------------------------------- */

/* Blocks of the factor, with the diagonal: each row reaches the columns on the paths from its earlier neighbours. */
static size_t count_fill(const row_graph *g, const uint32_t *order) {
    const uint32_t n = g->row_count;
    uint32_t *places = malloc((4 * (size_t)n + 1) * sizeof *places), *parents = places + n,
             *marks = parents + n;
    size_t fill = n;
    for (uint32_t k = 0; k < n; k++) places[k] = parents[k] = marks[k] = UINT32_MAX;
    for (uint32_t k = 0; k < n; k++) {
        assert_true(order[k] < n && places[order[k]] == UINT32_MAX);
        places[order[k]] = k;
    }
    for (uint32_t j = 0; j < n; j++) {
        marks[j] = j;
        for (size_t k = g->begins[order[j]]; k < g->begins[order[j] + 1]; k++) {
            uint32_t i = places[g->neighbours[k]];
            for (; i < j && marks[i] != j; i = parents[i]) {
                marks[i] = j;
                fill++;
                if (parents[i] == UINT32_MAX) parents[i] = j;
            }
        }
    }
    free(places);
    return fill;
}

/* The fill of an order that looks at all rows for the least degree, and keeps a table of all pairs. */
static size_t minimum_degree_fill(const row_graph *g) {
    const uint32_t n = g->row_count;
    bool *beside = calloc((size_t)n * n + 1, sizeof *beside),
         *is_gone = calloc((size_t)n + 1, sizeof *is_gone);
    size_t fill = 0;
    for (uint32_t i = 0; i < n; i++) {
        for (size_t k = g->begins[i]; k < g->begins[i + 1]; k++) beside[i * n + g->neighbours[k]] = true;
    }
    for (uint32_t step = 0; step < n; step++) {
        uint32_t best = n, least = n;
        for (uint32_t i = 0; i < n; i++) {
            uint32_t degree = 0;
            for (uint32_t j = 0; j < n; j++) degree += beside[i * n + j] && !is_gone[j];
            if (!is_gone[i] && degree < least) {
                least = degree;
                best = i;
            }
        }
        is_gone[best] = true;
        fill += least + 1;
        for (uint32_t i = 0; i < n; i++) {
            for (uint32_t j = 0; j < n; j++) {
                if (i != j && beside[best * n + i] && beside[best * n + j]) beside[i * n + j] = true;
            }
        }
    }
    free(beside);
    free(is_gone);
    return fill;
}

static size_t order_fill(const row_graph *g) {
    uint32_t *order = malloc(((size_t)g->row_count + 1) * sizeof *order);
    expect_ok(fill_order_find(contexts[0], g, order));
    const size_t fill = count_fill(g, order);
    free(order);
    return fill;
}

TEST(fill_is_that_of_minimum_degree) {
    random_stream random = stream_start(1);
    size_t found = 0, expected = 0;
    for (int round = 0; round < NIGHTLY(150, 3000); round++) {
        const uint32_t rows = 1 + stream_below(&random, 60);
        draw_random(&random, rows, stream_below(&random, 4 * rows));
        drawn_graph g = graph_of_pairs();
        found += order_fill(&g.graph);
        expected += minimum_degree_fill(&g.graph);
        free_graph(&g);
    }
    print_message("%zu blocks, %zu by exact degrees\n", found, expected);
    assert_true((double)found <= 1.02 * (double)expected);
}

/* Bounds about a tenth above what is there: a grid eliminated row by row has 343,000 blocks. */
TEST(grids_have_little_fill) {
    draw_grid(70, false);
    drawn_graph plain = graph_of_pairs();
    draw_grid(70, true);
    drawn_graph triangles = graph_of_pairs();
    const size_t of_plain = order_fill(&plain.graph), of_triangles = order_fill(&triangles.graph);
    print_message("70 x 70: %zu blocks, %zu with diagonals\n", of_plain, of_triangles);
    assert_true(of_plain < 98000);
    assert_true(of_triangles < 143000);
    free_graph(&plain);
    free_graph(&triangles);
}

TEST(trees_have_no_fill) {
    random_stream random = stream_start(3);
    begin_pairs(5000);
    for (uint32_t v = 1; v < 5000; v++) {
        if (v % 7 != 0) draw_pair(v, v % 3 == 0 ? v - 1 : stream_below(&random, v)); /* a forest */
    }
    drawn_graph g = graph_of_pairs();
    assert_int_equal(order_fill(&g.graph), 5000 + drawn.count);
    free_graph(&g);
}

/* The middle of a star, which has more neighbours than 10 sqrt(n), comes last, and not when its neighbours are gone. */
TEST(dense_rows_are_last) {
    uint32_t order[900];
    begin_pairs(900);
    for (uint32_t v = 0; v < 900; v++) {
        if (v < 400) draw_pair(v, 400);
        for (uint32_t u = 850; u < v; u++) draw_pair(u, v);
    }
    drawn_graph g = graph_of_pairs();
    assert_int_equal(order_fill(&g.graph), 900 + drawn.count);
    expect_ok(fill_order_find(contexts[0], &g.graph, order));
    assert_int_equal(order[899], 400);
    free_graph(&g);
}

/* All rows of a clique are one node, and rows that hang on it are eliminated before it. */
TEST(rows_with_the_same_neighbours_stay_together) {
    uint32_t order[120];
    begin_pairs(120);
    for (uint32_t v = 0; v < 60; v++) {
        draw_pair(v, v + 60);
        for (uint32_t u = 0; u < v; u++) draw_pair(v + 60, u + 60);
    }
    drawn_graph g = graph_of_pairs();
    assert_int_equal(order_fill(&g.graph), 120 + drawn.count);
    expect_ok(fill_order_find(contexts[0], &g.graph, order));
    for (int k = 0; k < 50; k++) assert_true(order[k] < 60);
    free_graph(&g);
    begin_pairs(0);
    g = graph_of_pairs();
    assert_int_equal(order_fill(&g.graph), 0);
    free_graph(&g);
}

/* ---- failures ------------------------------------------------------------------------------------------------ */

TEST(an_order_is_whole_or_not_there) {
    counting_allocator counter = counting_allocator_start();
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context;
    options.allocator = counting_allocator_interface(&counter);
    expect_ok(cscd_context_create(&options, &context));
    draw_grid(30, true);
    drawn_graph g = graph_of_pairs();
    uint32_t order[900], again[900], untouched[900];
    expect_ok(fill_order_find(contexts[0], &g.graph, order));
    memset(untouched, 1, sizeof untouched);
    const size_t live = counter.live;
    cscd_status status = CSCD_OUT_OF_MEMORY;
    for (size_t fail = 0; status != CSCD_OK; fail++) {
        memset(again, 1, sizeof again);
        counter.fail_at = counter.calls + fail;
        status = fill_order_find(context, &g.graph, again);
        counter.fail_at = SIZE_MAX;
        assert_true(status == CSCD_OK || status == CSCD_OUT_OF_MEMORY);
        assert_memory_equal(again, status == CSCD_OK ? order : untouched, sizeof again);
        assert_int_equal(counter.live, live);
    }
    memset(again, 1, sizeof again);
    progress_cancel(&context->progress);
    assert_int_equal(fill_order_find(context, &g.graph, again), CSCD_CANCELLED);
    assert_memory_equal(again, untouched, sizeof again);
    assert_int_equal(counter.live, live);
    cscd_context_destroy(context);
    free_graph(&g);
}
