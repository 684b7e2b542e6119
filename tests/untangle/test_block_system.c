/* Systems of blocks against dense solutions, residuals, bits that stay, and what happens without memory. */
#include "runtime/untangle/block_system.h"

#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

AROUND_ALL(open_levels, close_levels)

/* ---- matrices as lists of terms ------------------------------------------------------------------------------ */

typedef struct block_term {
    uint32_t i, j;
    bool is_scalar;
    double block[9]; /* of a scalar the first */
} block_term;

typedef struct term_list {
    uint32_t row_count;
    size_t count, capacity;
    block_term *terms;
} term_list;

static block_term *add_term(term_list *l, uint32_t i, uint32_t j) {
    if (l->count == l->capacity) {
        l->capacity = 2 * l->capacity + 64;
        l->terms = realloc(l->terms, l->capacity * sizeof *l->terms);
        assert_non_null(l->terms);
    }
    l->terms[l->count] = (block_term){.i = i, .j = j};
    return &l->terms[l->count++];
}

static void add_scalar(term_list *l, uint32_t i, uint32_t j, double w) {
    block_term *t = add_term(l, i, j);
    t->is_scalar = true;
    t->block[0] = w;
}

/* Adds stiffness g g', where g has a weight times a direction for each of `count` rows. The direction turns from row to row, so that
 * blocks beside the diagonal are not symmetric. */
static void add_contact(term_list *l, const uint32_t *rows, const double *weights, int count,
                        const double direction[3], double stiffness) {
    for (int a = 0; a < count; a++) {
        for (int b = a; b < count; b++) {
            block_term *t = add_term(l, rows[a], rows[b]);
            for (int k = 0; k < 9; k++)
                t->block[k] =
                    stiffness * weights[a] * weights[b] * direction[(k / 3 + a) % 3] * direction[(k + b) % 3];
        }
    }
}

static void add_edge(term_list *l, uint32_t i, uint32_t j, double w) {
    add_scalar(l, i, i, w);
    add_scalar(l, j, j, w);
    add_scalar(l, i, j, -w);
}

static cscd_status factor_list(block_system *s, const term_list *l) {
    if (!block_system_begin(s, l->row_count) || !block_system_reserve(s, l->count)) return CSCD_OUT_OF_MEMORY;
    for (size_t k = 0; k < l->count; k++) {
        const block_term *t = &l->terms[k];
        if (t->is_scalar)
            block_system_add_scalar(s, t->i, t->j, t->block[0]);
        else
            block_system_add_block(s, t->i, t->j, t->block);
    }
    return block_system_factor(s);
}

/* y = A x, or of all magnitudes. */
static void multiply_list(const term_list *l, const double *x, double *y, bool magnitudes) {
    memset(y, 0, 3 * (size_t)l->row_count * sizeof *y);
    for (size_t k = 0; k < l->count; k++) {
        const block_term *t = &l->terms[k];
        for (uint32_t e = 0; e < 9; e++) {
            const uint32_t row = 3 * t->i + e / 3, column = 3 * t->j + e % 3;
            double v = t->is_scalar ? (e % 4 == 0 ? t->block[0] : 0.0) : t->block[e];
            if (magnitudes) v = fabs(v);
            y[row] += v * (magnitudes ? fabs(x[column]) : x[column]);
            if (t->i != t->j) y[column] += v * (magnitudes ? fabs(x[row]) : x[row]);
        }
    }
}

static double *random_vector(random_stream *random, uint32_t row_count) {
    double *x = malloc((3 * (size_t)row_count + 1) * sizeof *x);
    assert_non_null(x);
    for (size_t k = 0; k < 3 * (size_t)row_count; k++) x[k] = stream_between(random, -1.0, 1.0);
    return x;
}

/* The largest error of a row, relative to what its terms come to. */
static double backward_error(const term_list *l, const double *x, const double *b) {
    const size_t n = 3 * (size_t)l->row_count;
    double *y = malloc((2 * n + 1) * sizeof *y), worst = 0.0;
    multiply_list(l, x, y, false);
    multiply_list(l, x, y + n, true);
    for (size_t k = 0; k < n; k++) worst = fmax(worst, fabs(y[k] - b[k]) / (y[n + k] + fabs(b[k])));
    free(y);
    return worst;
}

/* Solves for a random right side, and returns the backward error. */
static double solve_list(const term_list *l, uint64_t seed) {
    random_stream random = stream_start(seed);
    block_system s = {.context = contexts[0]};
    expect_ok(factor_list(&s, l));
    assert_int_equal(s.replaced, 0);
    double *b = random_vector(&random, l->row_count), *x = random_vector(&random, l->row_count), worst = 0.0;
    for (int round = 0; round < 2; round++) {
        memcpy(x, b, 3 * (size_t)l->row_count * sizeof *x);
        block_system_solve(&s, x);
        worst = fmax(worst, backward_error(l, x, b));
        for (size_t k = 0; k < 3 * (size_t)l->row_count; k++) b[k] = stream_between(&random, -1.0, 1.0);
    }
    free(b);
    free(x);
    block_system_free(&s);
    return worst;
}

/* ---- shapes -------------------------------------------------------------------------------------------------- */

/* Triangles between the points of a grid whose numbers are shuffled, and a mass. */
static term_list grid_list(uint32_t width, uint32_t height, uint32_t *names, uint64_t seed) {
    random_stream random = stream_start(seed);
    term_list l = {.row_count = width * height};
    for (uint32_t v = 0; v < l.row_count; v++) {
        const uint32_t other = stream_below(&random, v + 1);
        names[v] = names[other];
        names[other] = v;
    }
    for (uint32_t v = 0; v < l.row_count; v++) {
        const uint32_t x = v % width, y = v / width;
        add_scalar(&l, names[v], names[v], 0.01);
        if (x + 1 < width) add_edge(&l, names[v], names[v + 1], stream_between(&random, 0.5, 2.0));
        if (y + 1 < height) add_edge(&l, names[v + width], names[v], stream_between(&random, 0.5, 2.0));
        if (x + 1 < width && y + 1 < height) add_edge(&l, names[v], names[v + width + 1], 0.3);
    }
    return l;
}

/* A sphere of rings around an axis, with a row at each pole, whose halves touch each other. */
static term_list sphere_list(uint32_t rings, uint32_t around, double stiffness) {
    random_stream random = stream_start(7);
    term_list l = {.row_count = rings * around + 2};
    for (uint32_t v = 0; v < rings * around; v++) {
        const uint32_t next = v % around + 1 < around ? v + 1 : v + 1 - around;
        add_scalar(&l, v, v, 0.02);
        add_edge(&l, v, next, 1.0);
        add_edge(&l, v, v < around ? rings * around : v - around, 0.7);
        if (v >= around) add_edge(&l, next - around, v, 0.4);
        if (v / around + 1 == rings) add_edge(&l, v, rings * around + 1, 0.7);
    }
    for (uint32_t k = 0; k < rings * around / 4; k++) {
        const uint32_t ring = stream_below(&random, rings / 2 - 1), a = stream_below(&random, around - 1);
        const uint32_t from = (rings - 1 - ring) * around + a;
        const uint32_t rows[4] = {ring * around + a, from, from + 1, from - around};
        double w[4] = {1.0, -stream_between(&random, 0.0, 0.5), -stream_between(&random, 0.0, 0.5), 0.0},
               normal[3];
        w[3] = -1.0 - w[1] - w[2];
        for (int i = 0; i < 3; i++) normal[i] = stream_between(&random, -1.0, 1.0);
        add_contact(&l, rows, w, 4, normal, stiffness * stream_between(&random, 0.1, 1.0));
    }
    return l;
}

/* ---- solutions ----------------------------------------------------------------------------------------------- */

/* Solves by Gaussian elimination with pivots by column. */
static void solve_dense(const term_list *l, double *x) {
    const size_t n = 3 * (size_t)l->row_count;
    double *m = calloc(n * n + 1, sizeof *m), *unit = calloc(n + 1, sizeof *unit),
           *column = calloc(n + 1, sizeof *column);
    for (size_t j = 0; j < n; j++) {
        unit[j] = 1.0;
        multiply_list(l, unit, column, false);
        unit[j] = 0.0;
        for (size_t i = 0; i < n; i++) m[i * n + j] = column[i];
    }
    for (size_t k = 0; k < n; k++) {
        size_t best = k;
        for (size_t i = k + 1; i < n; i++) best = fabs(m[i * n + k]) > fabs(m[best * n + k]) ? i : best;
        for (size_t j = 0; j <= n; j++) {
            double *a = j < n ? &m[k * n + j] : &x[k], *b = j < n ? &m[best * n + j] : &x[best], kept = *a;
            *a = *b;
            *b = kept;
        }
        for (size_t i = k + 1; i < n; i++) {
            const double factor = m[i * n + k] / m[k * n + k];
            for (size_t j = k; j < n; j++) m[i * n + j] -= factor * m[k * n + j];
            x[i] -= factor * x[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++) x[k] -= m[k * n + j] * x[j];
        x[k] /= m[k * n + k];
    }
    free(m);
    free(unit);
    free(column);
}

/* A definite matrix of edges and contacts between any rows. */
static term_list random_list(random_stream *random, uint32_t rows) {
    term_list l = {.row_count = rows};
    const uint32_t edges = stream_below(random, 3 * rows + 1), contacts = stream_below(random, rows + 1);
    for (uint32_t v = 0; v < rows; v++) add_scalar(&l, v, v, stream_between(random, 0.1, 1.0));
    for (uint32_t e = 0; e < edges; e++) {
        const uint32_t i = stream_below(random, rows), j = stream_below(random, rows);
        if (i != j) add_edge(&l, i, j, stream_between(random, 0.0, 2.0));
    }
    for (uint32_t c = 0; c < contacts && rows >= 3; c++) {
        const uint32_t a = stream_below(random, rows - 2);
        const uint32_t three[3] = {a + 2, a, a + 1};
        const double weights[3] = {1.0, -0.3, -0.7},
                     direction[3] = {0.5, stream_between(random, -1.0, 1.0), 0.2};
        add_contact(&l, three, weights, 3, direction, exp(stream_between(random, -2.0, 4.0)));
    }
    return l;
}

TEST(solutions_are_those_of_dense_elimination) {
    random_stream random = stream_start(1);
    block_system s = {.context = contexts[0]};
    for (int round = 0; round < NIGHTLY(200, 5000); round++) {
        const uint32_t rows = 1 + (uint32_t)round % 35;
        term_list l = random_list(&random, rows);
        double *x = random_vector(&random, rows), *expected = random_vector(&random, rows), largest = 0.0;
        memcpy(expected, x, 3 * (size_t)rows * sizeof *x);
        expect_ok(factor_list(&s, &l));
        assert_int_equal(s.replaced, 0);
        block_system_solve(&s, x);
        solve_dense(&l, expected);
        for (uint32_t k = 0; k < 3 * rows; k++) largest = fmax(largest, fabs(expected[k]));
        for (uint32_t k = 0; k < 3 * rows; k++) {
            if (!(fabs(x[k] - expected[k]) <= 1e-10 * largest))
                fail_msg("round %d, number %u: %.17g, not %.17g", round, k, x[k], expected[k]);
        }
        free(x);
        free(expected);
        free(l.terms);
    }
    block_system_free(&s);
}

TEST(residuals_are_rounding) {
    uint32_t *names = malloc(70 * 70 * sizeof *names);
    for (uint32_t side = 1; side <= 70; side += 23) {
        term_list l = grid_list(side, side + (side < 70), names, side);
        assert_true(solve_list(&l, side) < 1e-13);
        free(l.terms);
    }
    free(names);
    for (double stiffness = 1.0; stiffness <= 1e8; stiffness *= 100.0) {
        term_list l = sphere_list(24, 40, stiffness);
        const double error = solve_list(&l, 3);
        if (!(error < 1e-12)) fail_msg("stiffness %g: backward error %g", stiffness, error);
        free(l.terms);
    }
}

TEST(any_graph_is_solved) {
    term_list l = {.row_count = 0};
    solve_list(&l, 1); /* no rows */
    l.row_count = 40;
    for (uint32_t v = 0; v < 40; v++) add_scalar(&l, v, v, 1.0 + v); /* rows without neighbours */
    assert_true(solve_list(&l, 2) < 1e-14);
    for (uint32_t v = 20; v < 39; v++) add_edge(&l, v, v + 1, 1.0); /* and a path of its own */
    assert_true(solve_list(&l, 3) < 1e-14);
    for (uint32_t v = 0; v < 40; v++) {
        for (uint32_t u = 0; u < v; u++) add_edge(&l, u, v, 1.0); /* all with all */
    }
    assert_true(solve_list(&l, 4) < 1e-14);
    l = (term_list){.row_count = 3000, .count = 0, .capacity = l.capacity, .terms = l.terms};
    for (uint32_t v = 0; v < 3000; v++) {
        add_scalar(&l, v, v, 1.0);
        if (v != 17) add_edge(&l, v, 17, 0.1); /* one with all */
        if (v > 0) add_edge(&l, v, v - 1, 1.0);
    }
    assert_true(solve_list(&l, 5) < 1e-13);
    free(l.terms);
    l = (term_list){.row_count = 1};
    const double direction[3] = {1.0, 2.0, 3.0}, weight = 1.0;
    const uint32_t row = 0;
    add_scalar(&l, 0, 0, 2.0);
    add_contact(&l, &row, &weight, 1, direction, 5.0);
    assert_true(solve_list(&l, 6) < 1e-14);
    free(l.terms);
}

/* ---- bits ---------------------------------------------------------------------------------------------------- */

static void expect_bits(block_system *s, const term_list *l, const double *b, const double *expected) {
    const size_t size = 3 * (size_t)l->row_count * sizeof *b;
    double *x = malloc(size);
    expect_ok(factor_list(s, l));
    memcpy(x, b, size);
    block_system_solve(s, x);
    assert_memory_equal(x, expected, size);
    free(x);
}

TEST(bits_depend_on_the_entries_alone) {
    term_list l = sphere_list(16, 30, 1e5), other = sphere_list(8, 12, 10.0);
    random_stream random = stream_start(9);
    double *b = random_vector(&random, l.row_count), *x = random_vector(&random, l.row_count);
    block_system first = {.context = contexts[0]}, s = {.context = contexts[0]};
    expect_ok(factor_list(&first, &l));
    memcpy(x, b, 3 * (size_t)l.row_count * sizeof *x);
    block_system_solve(&first, x);
    expect_bits(&first, &l, b, x); /* the pattern is kept */
    for (size_t k = 0; k < l.count; k++) l.terms[k].block[0] *= 2.0;
    expect_ok(factor_list(&s, &l)); /* other numbers in the same places */
    for (size_t k = 0; k < l.count; k++) l.terms[k].block[0] *= 0.5;
    const uint32_t *places = s.tree.places;
    expect_bits(&s, &l, b, x);
    assert_ptr_equal(s.tree.places, places);
    expect_ok(factor_list(&s, &other));
    expect_bits(&s, &l, b, x);
    l.terms[l.count - 1].i ^= 1; /* as many entries, and one in another place */
    block_system changed = {.context = contexts[0]};
    expect_ok(factor_list(&changed, &l));
    memcpy(x, b, 3 * (size_t)l.row_count * sizeof *x);
    block_system_solve(&changed, x);
    expect_bits(&s, &l, b, x);
    block_system_free(&changed);
    for (int level = 1; level < LEVEL_COUNT; level++) {
        block_system here = {.context = contexts[level]};
        if (contexts[level] == NULL) continue;
        expect_bits(&here, &l, b, x);
        block_system_free(&here);
    }
    block_system_free(&first);
    block_system_free(&s);
    free(b);
    free(x);
    free(l.terms);
    free(other.terms);
}

/* ---- matrices that are not definite -------------------------------------------------------------------------- */

static void expect_descent(block_system *s, const term_list *l, random_stream *random) {
    double *b = random_vector(random, l->row_count), *x = random_vector(random, l->row_count), slope = 0.0;
    memcpy(x, b, 3 * (size_t)l->row_count * sizeof *x);
    block_system_solve(s, x);
    for (uint32_t k = 0; k < 3 * l->row_count; k++) slope += x[k] * b[k];
    if (!(slope > 0.0 && slope < 1e300)) fail_msg("%u rows: the slope is %g", l->row_count, slope);
    free(b);
    free(x);
}

TEST(directions_descend_in_any_case) {
    random_stream random = stream_start(11);
    block_system s = {.context = contexts[0]};
    for (int round = 0; round < NIGHTLY(300, 10000); round++) {
        term_list l = random_list(&random, 1 + (uint32_t)round % 30);
        for (size_t k = 0; k < l.count; k++) {
            double scale = round % 3 == 0 ? -1.0 : stream_between(&random, -1.0, 1.0);
            for (int e = 0; e < 9; e++) l.terms[k].block[e] *= scale;
        }
        expect_ok(factor_list(&s, &l));
        if (round % 3 == 0) assert_true(s.replaced > 0 && s.replaced <= 3 * (size_t)l.row_count);
        expect_descent(&s, &l, &random);
        free(l.terms);
    }
    term_list nothing = {.row_count = 5};
    expect_ok(factor_list(&s, &nothing));
    assert_int_equal(s.replaced, 15);
    expect_descent(&s, &nothing, &random);
    block_system_free(&s);
}

/* A path without a mass is singular, so the last of its pivots are rounding: they are replaced by about what stood there. */
TEST(a_replaced_pivot_is_as_large_as_its_row) {
    random_stream random = stream_start(12);
    block_system s = {.context = contexts[0]};
    for (int round = 0; round < 30; round++) {
        term_list l = {.row_count = 50};
        for (uint32_t v = 0; v + 1 < 50; v++) add_edge(&l, v, v + 1, stream_between(&random, 1.0, 4.0));
        expect_ok(factor_list(&s, &l));
        assert_int_equal(s.replaced, 3);
        double *x = random_vector(&random, 50);
        block_system_solve(&s, x);
        for (int k = 0; k < 150; k++) assert_true(fabs(x[k]) < 1e3);
        free(x);
        free(l.terms);
    }
    block_system_free(&s);
}

/* ---- failures ------------------------------------------------------------------------------------------------ */

TEST(without_memory_the_system_stays_usable) {
    counting_allocator counter = counting_allocator_start();
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context;
    options.allocator = counting_allocator_interface(&counter);
    expect_ok(cscd_context_create(&options, &context));
    const term_list small = sphere_list(6, 8, 10.0), large = sphere_list(12, 20, 1e4);
    random_stream random = stream_start(5);
    double *b = random_vector(&random, large.row_count), *x = random_vector(&random, large.row_count);
    block_system s = {.context = contexts[0]};
    expect_ok(factor_list(&s, &large));
    memcpy(x, b, 3 * (size_t)large.row_count * sizeof *x);
    block_system_solve(&s, x);
    block_system_free(&s);
    const size_t live = counter.live;
    bool failed = true;
    for (size_t fail = 0; failed; fail++) {
        s = (block_system){.context = context};
        if (fail % 2 == 0) expect_ok(factor_list(&s, &small));
        counter.fail_at = counter.calls + fail / 2;
        const cscd_status status = factor_list(&s, &large);
        counter.fail_at = SIZE_MAX;
        failed = status != CSCD_OK || fail % 2 == 0;
        if (status != CSCD_OK) assert_int_equal(status, CSCD_OUT_OF_MEMORY);
        expect_bits(&s, &large, b, x);
        block_system_free(&s);
        assert_int_equal(counter.live, live);
    }
    cscd_context_destroy(context);
    free(b);
    free(x);
    free(small.terms);
    free(large.terms);
}

TEST(a_cancelled_factorisation_can_be_repeated) {
    const term_list l = sphere_list(12, 20, 1e4);
    random_stream random = stream_start(6);
    double *b = random_vector(&random, l.row_count), *x = random_vector(&random, l.row_count);
    block_system s = {.context = contexts[0]};
    progress_cancel(&contexts[0]->progress);
    assert_int_equal(factor_list(&s, &l), CSCD_CANCELLED);
    progress_begin_call(&contexts[0]->progress);
    expect_ok(factor_list(&s, &l));
    memcpy(x, b, 3 * (size_t)l.row_count * sizeof *x);
    block_system_solve(&s, x);
    progress_cancel(&contexts[0]->progress);
    assert_int_equal(block_system_factor(&s), CSCD_CANCELLED); /* with a tree */
    progress_begin_call(&contexts[0]->progress);
    expect_bits(&s, &l, b, x);
    block_system_free(&s);
    free(b);
    free(x);
    free(l.terms);
}

/* Room for one term after the other: none is written beyond it, and what was there stays. */
TEST(rooms_grow_with_blocks) {
    const term_list l = sphere_list(12, 20, 1e4);
    block_system s = {.context = contexts[0]};
    assert_true(block_system_begin(&s, l.row_count));
    for (size_t k = 0; k < l.count; k++) {
        assert_true(block_system_reserve(&s, 1));
        assert_true(s.entry_capacity > s.entry_count && s.value_capacity >= s.value_count + 9);
        block_system_add_block(&s, l.terms[k].i, l.terms[k].j, l.terms[k].block);
    }
    for (size_t k = 0; k < l.count; k++) assert_true(s.values[9 * k] == l.terms[k].block[0]);
    block_system_free(&s);
    free(l.terms);
}
