/* The order of items equals one by sorting, and is the same for any number of threads. */
#include "runtime/bvh/bvh_parts.h"
#include "src/core/kernels.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ITEMS_MAX = 150000, RUNS_MAX = 40, THREADS_MAX = 3 };

static placed_item first[ITEMS_MAX], items[ITEMS_MAX], expected[ITEMS_MAX];

static int seed_random(void **state) {
    (void)state;
    random_seed(20261126);
    return 0;
}

typedef enum item_family {
    ITEMS_SPREAD, /* in a long box */
    ITEMS_GRID,   /* many in one place, on one line, in one plane */
    ITEMS_ROWS,   /* sorted already, as meshes often are */
    ITEMS_POWERS, /* most of them crowded about the origin, closer than the least normal float */
    FAMILY_COUNT
} item_family;

static void make_items(item_family f, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        first[i].name = i;
        for (int k = 0; k < 3; k++) {
            double spread = random_unit() * (1.0 + 2.0 * k);
            double row = k == 0 ? i % 300 : k == 1 ? i / 300.0 : -0.0;
            double power = ldexp(random_unit() - 0.5, -random_integer(0, 160));
            first[i].centre[k] = (float)(f == ITEMS_GRID     ? random_integer(-3, 3)
                                         : f == ITEMS_ROWS   ? row
                                         : f == ITEMS_POWERS ? power
                                                             : spread);
        }
    }
}

/* ---- by sorting ----------------------------------------------------------------------------------------- */

static int sorted_axis;

static int compare_items(const void *a, const void *b) {
    const placed_item *p = a, *q = b;
    float x = p->centre[sorted_axis], y = q->centre[sorted_axis];
    if (x != y) return x < y ? -1 : 1;
    return p->name < q->name ? -1 : p->name > q->name;
}

static int compare_names(const void *a, const void *b) {
    const placed_item *p = a, *q = b;
    return p->name < q->name ? -1 : p->name > q->name;
}

static int longest_of(const placed_item *run, uint32_t count) {
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    int longest = 0;
    for (uint32_t i = 0; i < 3 * count; i++) {
        low[i % 3] = fminf(low[i % 3], run[i / 3].centre[i % 3]);
        high[i % 3] = fmaxf(high[i % 3], run[i / 3].centre[i % 3]);
    }
    for (int k = 1; k < 3; k++) longest = high[k] - low[k] > high[longest] - low[longest] ? k : longest;
    return longest;
}

static void sort_run(placed_item *run, uint32_t count) {
    if (count <= LANES) return;
    uint32_t half = 1;
    while (2 * half < count) half *= 2;
    sorted_axis = longest_of(run, count);
    qsort(run, count, sizeof *run, compare_items);
    sort_run(run, half);
    sort_run(run + half, count - half);
}

/* ---- comparing ------------------------------------------------------------------------------------------ */

static void sort_leaves(placed_item *run, uint32_t count) {
    for (uint32_t i = 0; i < count; i += LANES)
        qsort(run + i, count - i < LANES ? count - i : LANES, sizeof *run, compare_names);
}

static void order_with_threads(uint32_t threads, const item_runs *runs) {
    cscd_context *context;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = threads;
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    assert_true(bvh_order_runs(context, *runs));
    cscd_context_destroy(context);
}

static void compare_runs(uint32_t count, const uint32_t *offsets, uint32_t run_count) {
    assert_true(count <= ITEMS_MAX);
    if (count > ITEMS_MAX) return; /* the compiler does not know that the line before does not return */
    memcpy(expected, first, count * sizeof *first);
    for (uint32_t r = 0; r < run_count; r++) {
        sort_run(expected + offsets[r], offsets[r + 1] - offsets[r]);
        sort_leaves(expected + offsets[r], offsets[r + 1] - offsets[r]);
    }
    for (uint32_t threads = 1; threads <= THREADS_MAX; threads++) {
        const item_runs runs = {items, offsets, run_count};
        memcpy(items, first, count * sizeof *first);
        order_with_threads(threads, &runs);
        assert_memory_equal(expected, items, count * sizeof *items);
    }
}

TEST(large_runs) {
    for (item_family f = ITEMS_SPREAD; f < FAMILY_COUNT; f++) {
        const uint32_t whole[2] = {0, ITEMS_MAX}, parts[4] = {0, 16385, 81922, 100001};
        make_items(f, ITEMS_MAX);
        compare_runs(ITEMS_MAX, whole, 1);
        compare_runs(100001, parts, 3);
    }
}

TEST(small_runs) {
    for (int i = 0; i < 300; i++) {
        uint32_t offsets[RUNS_MAX + 1] = {0}, runs = (uint32_t)random_integer(1, RUNS_MAX);
        for (uint32_t r = 0; r < runs; r++)
            offsets[r + 1] = offsets[r] + (uint32_t)random_integer(0, r % 2 == 0 ? 20 : 400);
        make_items((item_family)(i % FAMILY_COUNT), offsets[runs] + 1);
        compare_runs(offsets[runs], offsets, runs);
    }
}

AROUND_EACH(seed_random, NULL)
