/* Orders items in space, so that neighbours in the order are near each other. */
#include "runtime/bvh/bvh_parts.h"

#include "src/core/kernels.h"

#include <assert.h>
#include <string.h>

/* ---- the axis ------------------------------------------------------------------------------------------- */

/* The longest of the extents along the axes. */
typedef struct longest_extent {
    int axis;
    float least, greatest;
} longest_extent;

/* The name of an item is compared as if it were a float as well: four lanes take no longer than three. */
static longest_extent find_longest(const placed_item *items, uint32_t count) {
    float low[4], high[4], at[4];
    memcpy(low, items, sizeof low);
    memcpy(high, items, sizeof high);
    for (uint32_t i = 1; i < count; i++) {
        memcpy(at, &items[i], sizeof at);
        for (int k = 0; k < 4; k++) {
            low[k] = at[k] < low[k] ? at[k] : low[k];
            high[k] = at[k] > high[k] ? at[k] : high[k];
        }
    }
    int longest = 0;
    for (int k = 1; k < 3; k++) longest = high[k] - low[k] > high[longest] - low[longest] ? k : longest;
    return (longest_extent){longest, low[longest], high[longest]};
}

/* ---- the limit ------------------------------------------------------------------------------------------ */

/* The first items of an order are below this value; at_limit more of them are at the value itself. */
typedef struct order_limit {
    float value;
    uint32_t at_limit;
} order_limit;

/* The place of a float among all floats. Zeros of both signs have the same. */
static int32_t number_of_float(float value) {
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits < 0 ? INT32_MIN - bits : bits;
}

static float float_of_number(int32_t number) {
    int32_t bits = number < 0 ? INT32_MIN - number : number;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t count_below(const float *values, uint32_t count, float limit) {
    uint32_t below = 0;
    for (uint32_t i = 0; i < count; i++) below += values[i] < limit;
    return below;
}

/* A limit that is too low or too high, and how many values are below it. */
typedef struct limit_bound {
    int32_t number;
    uint32_t below;
} limit_bound;

/* Returns a limit between two bounds, which are not neighbours: where it is by their counts, or half way between them in the order
 * of floats. */
static int32_t guess_limit(limit_bound low, limit_bound high, uint32_t first, bool half_way) {
    int32_t middle = (int32_t)(((int64_t)low.number + high.number) >> 1);
    if (half_way) return middle;
    float from = float_of_number(low.number), to = float_of_number(high.number);
    float share = (float)(first - low.below) / (float)(high.below - low.below);
    int32_t guess = number_of_float(from + (to - from) * share);
    return guess > low.number && guess < high.number ? guess : middle;
}

enum { GUESSES_PER_HALVING = 4 };

/* Finds the limit of the first values by counting, which takes less time than moving them. Two to nine rounds are usual; the
 * halvings among them end it after 128. */
static order_limit find_limit(const float *values, uint32_t count, uint32_t first, longest_extent extent) {
    limit_bound low = {number_of_float(extent.least), 0},
                high = {number_of_float(extent.greatest) + 1, count};
    for (int round = 1; high.number - (int64_t)low.number > 1; round++) {
        int32_t number = guess_limit(low, high, first, round % GUESSES_PER_HALVING == 0);
        uint32_t below = count_below(values, count, float_of_number(number));
        if (below == first) return (order_limit){float_of_number(number), 0};
        *(below < first ? &low : &high) = (limit_bound){number, below};
    }
    return (order_limit){float_of_number(low.number), first - low.below};
}

/* ---- moving --------------------------------------------------------------------------------------------- */

/* Without branches, because they would be foretold wrong half of the time: an item goes to both sides, and the next one
 * overwrites it on one of them. */
static inline uint32_t part_items(placed_item *items, placed_item *spare, uint32_t count, order_limit limit,
                                  const int axis, const bool any_at_limit) {
    uint32_t front = 0, at_limit = limit.at_limit;
    for (uint32_t i = 0; i < count; i++) {
        placed_item item = items[i];
        bool first = item.centre[axis] < limit.value;
        if (any_at_limit) {
            bool taken = (item.centre[axis] == limit.value) & (at_limit > 0);
            at_limit -= taken;
            first |= taken;
        }
        items[front] = item;
        spare[i - front] = item;
        front += first;
    }
    return front;
}

/* Moves what is below the limit to the front, and the others behind it; both keep their order. */
static uint32_t move_items(placed_item *items, placed_item *spare, uint32_t count, int axis,
                           order_limit limit) {
    uint32_t front = limit.at_limit > 0 ? part_items(items, spare, count, limit, axis, true)
                     : axis == 0        ? part_items(items, spare, count, limit, 0, false)
                     : axis == 1        ? part_items(items, spare, count, limit, 1, false)
                                        : part_items(items, spare, count, limit, 2, false);
    memcpy(items + front, spare, (count - front) * sizeof *items);
    return front;
}

/* ---- runs ----------------------------------------------------------------------------------------------- */

/* Returns the number of items in the first half of a run: the largest power of two below count. So runs of 8^k items
 * begin at multiples of 8^k, and all runs at multiples of their size. */
static uint32_t first_share(uint32_t count) {
    uint32_t share = 1;
    while (share < count - share) share *= 2;
    return share;
}

/* Returns where the second half begins. There is room for as many spare items, which hold the coordinates first. */
static uint32_t split_run(placed_item *items, placed_item *spare, uint32_t count) {
    uint32_t middle = first_share(count);
    longest_extent extent = find_longest(items, count);
    float *values = (float *)spare;
    for (uint32_t i = 0; i < count; i++) values[i] = items[i].centre[extent.axis];
    uint32_t front = move_items(items, spare, count, extent.axis, find_limit(values, count, middle, extent));
    assert(front == middle);
    (void)front;
    return middle;
}

typedef struct item_run {
    uint32_t begin, end;
} item_run;

static void order_run(placed_item *items, placed_item *spare, item_run run) {
    item_run open[64];
    uint32_t depth = 0;
    open[depth++] = run;
    while (depth > 0) {
        item_run next = open[--depth];
        if (next.end - next.begin <= LANES) continue;
        uint32_t middle =
            next.begin + split_run(items + next.begin, spare + next.begin, next.end - next.begin);
        /* The longer side is pushed first, so the stack holds at most one side per halving. */
        item_run sides[2] = {{next.begin, middle}, {middle, next.end}};
        bool first_longer = middle - next.begin > next.end - middle;
        open[depth++] = sides[first_longer ? 0 : 1];
        open[depth++] = sides[first_longer ? 1 : 0];
    }
}

/* ---- all threads ---------------------------------------------------------------------------------------- */

/* Longer runs are split once in each round, all of them at once; the others are tasks for the end. */
enum { TASK_ITEMS = 1 << 14 };

typedef struct order_work {
    progress *
        progress; /* of the call, which may be cancelled between two splits of long runs and between two tasks */
    placed_item *items, *spare;
    item_run *long_runs, *halves, *tasks; /* halves: two of each long run */
    uint32_t long_count, task_count;
} order_work;

static void split_long_run(void *data, uint32_t index) {
    const order_work *work = data;
    item_run run = work->long_runs[index];
    if (!progress_go_on(work->progress, 0.0)) return;
    uint32_t middle =
        run.begin + split_run(work->items + run.begin, work->spare + run.begin, run.end - run.begin);
    work->halves[2 * index] = (item_run){run.begin, middle};
    work->halves[2 * index + 1] = (item_run){middle, run.end};
}

static void order_task(void *data, uint32_t index) {
    const order_work *work = data;
    if (progress_go_on(work->progress, 0.0)) order_run(work->items, work->spare, work->tasks[index]);
}

static void add_run(order_work *work, item_run run) {
    if (run.end - run.begin > TASK_ITEMS)
        work->long_runs[work->long_count++] = run;
    else if (run.end - run.begin > LANES)
        work->tasks[work->task_count++] = run;
}

/* False: the call is cancelled. */
static bool order_all(order_work *work, parallel *threads, const uint32_t *offsets, uint32_t count) {
    for (uint32_t r = 0; r < count; r++) add_run(work, (item_run){offsets[r], offsets[r + 1]});
    while (work->long_count > 0) {
        uint32_t halves = 2 * work->long_count;
        parallel_run(threads, work->long_count, split_long_run, work);
        if (progress_cancelled(work->progress)) return false;
        work->long_count = 0;
        for (uint32_t i = 0; i < halves; i++) add_run(work, work->halves[i]);
    }
    parallel_run(threads, work->task_count, order_task, work);
    return !progress_cancelled(work->progress);
}

/* A long run has more than TASK_ITEMS items, and each split of one makes at most one task more. */
bool bvh_order_runs(cscd_context *context, item_runs runs) {
    uint32_t end = runs.offsets[runs.count];
    order_work work = {.progress = &context->progress,
                       .items = runs.items,
                       .spare = context_reserve(context, end, sizeof *work.spare)};
    size_t long_most = (end - runs.offsets[0]) / TASK_ITEMS + 1;
    array_list lists = {{ARRAY(work.long_runs, long_most), ARRAY(work.halves, 2 * long_most),
                         ARRAY(work.tasks, runs.count + 2 * long_most)}};
    bool enough = work.spare != NULL && context_allocate_all(context, lists);
    if (enough) {
        enough = order_all(&work, context->threads, runs.offsets, runs.count);
        context_free_all(context, lists);
    }
    context_free(context, work.spare);
    return enough;
}
