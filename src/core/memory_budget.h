/* How much memory, and how much work, a call may take for what it finds. Counted is what lists need, by how long they are, and not what is
 * allocated: so what a call leaves out is the same for any number of threads, and whatever calls there were before. */
#pragma once

#include "src/core/memory.h"

/* A list that grows to twice its length needs so many times what it has until the old one is given back. */
enum { MEMORY_WHILE_DOUBLING = 3 };

typedef struct memory_budget {
    size_t most, taken; /* bytes */
    size_t
        wanted; /* so many were needed in all by the first one that did not fit, as far as it was counted */
    uint64_t most_work, work,
        wanted_work; /* the same; wanted_work is 0 unless it was work that did not fit */
    bool exceeded;   /* something did not fit, and has not been taken */
} memory_budget;

/* Takes count times size bytes. False if they do not fit: whoever asks then ends as if there were no memory, and gives back
 * what it has. NULL: there is no limit. */
static inline bool memory_budget_take(memory_budget *b, size_t count, size_t size) {
    if (b == NULL) return true;
    if (count > 0 && size > (b->most - b->taken) / count) {
        const size_t needed = size > SIZE_MAX / count ? SIZE_MAX : count * size;
        b->wanted = needed > SIZE_MAX - b->taken ? SIZE_MAX : b->taken + needed;
        b->exceeded = true;
        return false;
    }
    b->taken += count * size;
    return true;
}

/* The same for work, which later work needs beside it. */
static inline bool memory_budget_work(memory_budget *b, uint64_t count, uint64_t work) {
    if (b == NULL) return true;
    if (count > 0 && work > (b->most_work - b->work) / count) {
        b->wanted_work = work > (UINT64_MAX - b->work) / count ? UINT64_MAX : b->work + count * work;
        b->exceeded = true;
        return false;
    }
    b->work += count * work;
    return true;
}

/* The same for the arrays of a list. */
static inline bool memory_budget_take_all(memory_budget *b, array_list list) {
    return memory_budget_take(b, 1, memory_size_of_all(list));
}

/* So many items of this size would fit. */
static inline size_t memory_budget_room(const memory_budget *b, size_t size) {
    return b != NULL ? (b->most - b->taken) / size : SIZE_MAX;
}
