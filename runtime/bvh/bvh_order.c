/* Orders items in space, so that neighbours in the order are near each other. */
#include "runtime/bvh/bvh_order.h"

#include "src/core/kernels.h"

#include <math.h>

/* ---- selection ------------------------------------------------------------------------------------------ */

static int longest_axis(const placed_item *items, uint32_t count) {
    float low[3], high[3];
    for (int k = 0; k < 3; k++) low[k] = high[k] = items[0].centre[k];
    for (uint32_t i = 1; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            float value = items[i].centre[k];
            low[k] = value < low[k] ? value : low[k];
            high[k] = value > high[k] ? value : high[k];
        }
    }
    int longest = 0;
    for (int k = 1; k < 3; k++) longest = high[k] - low[k] > high[longest] - low[longest] ? k : longest;
    return longest;
}

/* Items of one coordinate are told apart by their names, so that the order of any two is the same in every run. */
static bool comes_before(const placed_item *a, const placed_item *b, int axis) {
    float x = a->centre[axis], y = b->centre[axis];
    return (x < y) | ((x == y) & (a->name < b->name));
}

static void swap_items(placed_item *a, placed_item *b) {
    placed_item item = *a;
    *a = *b;
    *b = item;
}

enum { SAMPLE_MOST = 48, SORTED_MOST = 12 };

static void sort_few(placed_item *items, uint32_t count, int axis) {
    for (uint32_t i = 1; i < count; i++) {
        placed_item item = items[i];
        uint32_t j = i;
        for (; j > 0 && comes_before(&item, &items[j - 1], axis); j--) items[j] = items[j - 1];
        items[j] = item;
    }
}

/* Returns the place of an item that is probably near rank nth, on the side of it where more items lie: then what is left is
 * short, or a half whose end is near. */
static uint32_t choose_pivot(const placed_item *items, uint32_t count, uint32_t nth, int axis) {
    placed_item sample[SAMPLE_MOST];
    uint32_t size = count / 8 < 3             ? 3
                    : count / 8 < SAMPLE_MOST ? count / 8
                                              : SAMPLE_MOST,
             step = count / size;
    for (uint32_t i = 0; i < size; i++) {
        sample[i] = items[i * step + step / 2];
        sample[i].name = i * step + step / 2;
    }
    sort_few(sample, size, axis);
    uint32_t rank = (uint32_t)((uint64_t)nth * size / count), margin = size / 16;
    if (nth < count / 2)
        rank += margin + 1;
    else
        rank -= rank < margin + 1 ? rank : margin + 1;
    return sample[rank < size ? rank : size - 1].name;
}

/* Moves what comes before the pivot, an item of the run, to its front; returns how many these are. Without branches, because
 * they would be foretold wrong half of the time. */
static uint32_t part_items(placed_item *items, uint32_t count, uint32_t pivot, int axis) {
    swap_items(&items[pivot], &items[count - 1]);
    const placed_item last = items[count - 1];
    uint32_t front = 0;
    for (uint32_t i = 0; i + 1 < count; i++) {
        placed_item item = items[i];
        items[i] = items[front];
        items[front] = item;
        front += comes_before(&item, &last, axis);
    }
    swap_items(&items[front], &items[count - 1]);
    return front;
}

/* Moves the first nth items of the order along an axis to the front. */
static void select_nth(placed_item *items, uint32_t count, uint32_t nth, int axis) {
    while (count > SORTED_MOST) {
        uint32_t front = part_items(items, count, choose_pivot(items, count, nth, axis), axis);
        if (front == nth) return;
        if (nth < front) {
            count = front;
        } else {
            items += front + 1;
            count -= front + 1;
            nth -= front + 1;
        }
    }
    sort_few(items, count, axis);
}

/* ---- runs ----------------------------------------------------------------------------------------------- */

/* Returns the number of items in the first half of a run: the largest power of two below count. So runs of 8^k items
 * begin at multiples of 8^k, and all runs at multiples of their size. */
static uint32_t first_share(uint32_t count) {
    uint32_t share = 1;
    while (share < count - share) share *= 2;
    return share;
}

/* Returns where the second half begins. */
static uint32_t split_run(placed_item *items, uint32_t count) {
    uint32_t middle = first_share(count);
    select_nth(items, count, middle, longest_axis(items, count));
    return middle;
}

typedef struct item_run {
    uint32_t begin, end;
} item_run;

static void order_run(placed_item *items, item_run run) {
    item_run open[64];
    uint32_t depth = 0;
    open[depth++] = run;
    while (depth > 0) {
        item_run next = open[--depth];
        if (next.end - next.begin <= LANES) continue;
        uint32_t middle = next.begin + split_run(items + next.begin, next.end - next.begin);
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
    placed_item *items;
    item_run *long_runs, *halves, *tasks; /* halves: two of each long run */
    uint32_t long_count, task_count;
} order_work;

static void split_long_run(void *data, uint32_t index) {
    const order_work *work = data;
    item_run run = work->long_runs[index];
    uint32_t middle = run.begin + split_run(work->items + run.begin, run.end - run.begin);
    work->halves[2 * index] = (item_run){run.begin, middle};
    work->halves[2 * index + 1] = (item_run){middle, run.end};
}

static void order_task(void *data, uint32_t index) {
    const order_work *work = data;
    order_run(work->items, work->tasks[index]);
}

static void add_run(order_work *work, item_run run) {
    if (run.end - run.begin > TASK_ITEMS)
        work->long_runs[work->long_count++] = run;
    else if (run.end - run.begin > LANES)
        work->tasks[work->task_count++] = run;
}

static void order_all(order_work *work, parallel *threads, const uint32_t *offsets, uint32_t count) {
    for (uint32_t r = 0; r < count; r++) add_run(work, (item_run){offsets[r], offsets[r + 1]});
    while (work->long_count > 0) {
        uint32_t halves = 2 * work->long_count;
        parallel_run(threads, work->long_count, split_long_run, work);
        work->long_count = 0;
        for (uint32_t i = 0; i < halves; i++) add_run(work, work->halves[i]);
    }
    parallel_run(threads, work->task_count, order_task, work);
}

/* A long run has more than TASK_ITEMS items, and each split of one makes at most one task more. */
bool bvh_order_runs(cscd_context *context, item_runs runs) {
    order_work work = {.items = runs.items};
    size_t long_most = (runs.offsets[runs.count] - runs.offsets[0]) / TASK_ITEMS + 1;
    array_list lists = {{ARRAY(work.long_runs, long_most), ARRAY(work.halves, 2 * long_most),
                         ARRAY(work.tasks, runs.count + 2 * long_most)}};
    if (!context_allocate_all(context, lists)) return false;
    order_all(&work, context->threads, runs.offsets, runs.count);
    context_free_all(context, lists);
    return true;
}
