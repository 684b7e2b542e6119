/* Stable sorts that allocate nothing: bottom-up merging between two buffers, and by digits. */
#include "src/core/sort.h"

#include <stdbool.h>
#include <string.h>

typedef struct sorted_run {
    const char *next, *end;
} sorted_run;

/* Merges two sorted runs that lie next to each other, first before second, to out. */
static void merge_runs(sorted_run first, sorted_run second, char *out, size_t size,
                       int (*compare)(const void *, const void *)) {
    while (first.next < first.end && second.next < second.end) {
        sorted_run *smaller = compare(first.next, second.next) <= 0 ? &first : &second;
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
            merge_runs((sorted_run){from + begin * size, from + middle * size},
                       (sorted_run){from + middle * size, from + end * size}, to + begin * size, size,
                       compare);
        }
        char *swap = from;
        from = to;
        to = swap;
    }
    if (from != items && count > 0) memcpy(items, from, count * size);
}

/* ---- by digits ----------------------------------------------------------------------------------------- */

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, NUMBER_BITS = 64, DIGITS_WORTH_IT = 512 };

static uint64_t number_of(const void *item) {
    uint64_t number;
    memcpy(&number, item, sizeof number);
    return number;
}

static int compare_numbers(const void *left, const void *right) {
    uint64_t l = number_of(left), r = number_of(right);
    return l < r ? -1 : l > r;
}

/* Returns whether anything was moved; nothing is if all items have the same digit. */
static inline bool sort_by_digit(const char *from, char *to, size_t count, size_t size, int shift) {
    size_t places[DIGITS] = {0}, place = 0;
    for (size_t i = 0; i < count; i++) places[number_of(from + i * size) >> shift & (DIGITS - 1)]++;
    if (places[number_of(from) >> shift & (DIGITS - 1)] == count) return false;
    for (uint32_t digit = 0; digit < DIGITS; digit++) {
        size_t next = place + places[digit];
        places[digit] = place;
        place = next;
    }
    for (size_t i = 0; i < count; i++) {
        const char *item = from + i * size;
        memcpy(to + places[number_of(item) >> shift & (DIGITS - 1)]++ * size, item, size);
    }
    return true;
}

void sort_by_number(void *items, void *scratch, size_t count, size_t size) {
    char *from = items, *to = scratch;
    if (count < DIGITS_WORTH_IT) {
        sort_items(items, scratch, count, size, compare_numbers);
        return;
    }
    for (int shift = 0; shift < NUMBER_BITS; shift += DIGIT_BITS) {
        bool moved = size == 8 ? sort_by_digit(from, to, count, 8, shift)
                               : sort_by_digit(from, to, count, 16, shift); /* compiled separately */
        if (!moved) continue;
        char *swapped = from;
        from = to;
        to = swapped;
    }
    if (from != items) memcpy(items, from, count * size);
}
