/* A stable sort that allocates nothing: bottom-up merging between two buffers. */
#include "src/sort.h"

#include <string.h>

typedef struct run {
    const char *next, *end;
} run;

/* Merges two sorted runs that lie next to each other, first before second, to out. */
static void merge(run first, run second, char *out, size_t size, int (*compare)(const void *, const void *)) {
    while (first.next < first.end && second.next < second.end) {
        run *smaller = compare(first.next, second.next) <= 0 ? &first : &second;
        memcpy(out, smaller->next, size);
        smaller->next += size;
        out += size;
    }
    size_t rest = (size_t)(first.end - first.next);
    memcpy(out, first.next, rest);
    memcpy(out + rest, second.next, (size_t)(second.end - second.next));
}

void sort_items(void *items, void *scratch, size_t count, size_t size,
                int (*compare)(const void *, const void *)) {
    char *from = items, *to = scratch;
    for (size_t width = 1; width < count; width *= 2) {
        for (size_t begin = 0; begin < count; begin += 2 * width) {
            size_t middle = begin + width < count ? begin + width : count;
            size_t end = middle + width < count ? middle + width : count;
            merge((run){from + begin * size, from + middle * size},
                  (run){from + middle * size, from + end * size}, to + begin * size, size, compare);
        }
        char *swap = from;
        from = to;
        to = swap;
    }
    if (from != items && count > 0) memcpy(items, from, count * size);
}

/* ---- by all threads ---------------------------------------------------------------------------------- */

/* Runs are sorted one by one, and then merged in pairs; of each merged pair, one task writes a part. */
enum {
    RUN_COUNT = 16, /* 2^4: after four rounds of merging all is back in its place */
    PART_COUNT = RUN_COUNT,
    TOGETHER_MIN = 4096
};

typedef struct joint_sort {
    char *from, *to;
    size_t count, size;
    int (*compare)(const void *, const void *);
    size_t width; /* of the runs that are merged, in runs of the beginning */
} joint_sort;

static size_t run_begin(const joint_sort *s, size_t index) {
    return s->count * index / RUN_COUNT;
}

static void sort_run(void *data, uint32_t index) {
    const joint_sort *s = data;
    size_t begin = run_begin(s, index), end = run_begin(s, index + 1);
    sort_items(s->from + begin * s->size, s->to + begin * s->size, end - begin, s->size, s->compare);
}

/* How many of the first `taken` items of two merged runs come from the first one. */
static size_t split(const joint_sort *s, run first, run second, size_t taken) {
    size_t first_count = (size_t)(first.end - first.next) / s->size;
    size_t second_count = (size_t)(second.end - second.next) / s->size;
    size_t low = taken > second_count ? taken - second_count : 0;
    size_t high = taken < first_count ? taken : first_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const char *a = first.next + middle * s->size, *b = second.next + (taken - middle - 1) * s->size;
        if (s->compare(a, b) <= 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void merge_part(void *data, uint32_t index) {
    const joint_sort *s = data;
    size_t parts = PART_COUNT * 2 * s->width / RUN_COUNT, pair = index / parts, part = index % parts;
    size_t begin = run_begin(s, pair * 2 * s->width), end = run_begin(s, (pair + 1) * 2 * s->width);
    size_t middle = run_begin(s, (2 * pair + 1) * s->width);
    run first = {s->from + begin * s->size, s->from + middle * s->size};
    run second = {s->from + middle * s->size, s->from + end * s->size};
    size_t low = (end - begin) * part / parts, high = (end - begin) * (part + 1) / parts;
    size_t low_first = split(s, first, second, low), high_first = split(s, first, second, high);
    merge((run){first.next + low_first * s->size, first.next + high_first * s->size},
          (run){second.next + (low - low_first) * s->size, second.next + (high - high_first) * s->size},
          s->to + (begin + low) * s->size, s->size, s->compare);
}

void sort_items_together(parallel *threads, void *items, void *scratch, size_t count, size_t size,
                         int (*compare)(const void *, const void *)) {
    joint_sort s = {items, scratch, count, size, compare, 1};
    if (parallel_thread_count(threads) == 1 || count < TOGETHER_MIN) {
        sort_items(items, scratch, count, size, compare);
        return;
    }
    parallel_run(threads, RUN_COUNT, sort_run, &s);
    for (; s.width < RUN_COUNT; s.width *= 2) {
        parallel_run(threads, PART_COUNT, merge_part, &s);
        char *swap = s.from;
        s.from = s.to;
        s.to = swap;
    }
}
