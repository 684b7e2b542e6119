/* Stable sorts that allocate nothing: bottom-up merging between two buffers, and by digits. */
#include "src/sort.h"

#include <stdbool.h>
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

/* ---- by digits ----------------------------------------------------------------------------------------- */

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, KEY_BITS = 64, DIGITS_WORTH_IT = 512 };

static int compare_keys(const void *left, const void *right) {
    const sort_key *l = left, *r = right;
    return l->key < r->key ? -1 : l->key > r->key;
}

/* Returns whether anything was moved: not where all have the same digit. */
static bool sort_by_digit(const sort_key *from, sort_key *to, size_t count, int shift) {
    size_t places[DIGITS] = {0}, place = 0;
    for (size_t i = 0; i < count; i++) places[from[i].key >> shift & (DIGITS - 1)]++;
    if (places[from[0].key >> shift & (DIGITS - 1)] == count) return false;
    for (uint32_t digit = 0; digit < DIGITS; digit++) {
        size_t next = place + places[digit];
        places[digit] = place;
        place = next;
    }
    for (size_t i = 0; i < count; i++) to[places[from[i].key >> shift & (DIGITS - 1)]++] = from[i];
    return true;
}

void sort_keys(sort_key *keys, sort_key *scratch, size_t count) {
    sort_key *from = keys, *to = scratch;
    if (count < DIGITS_WORTH_IT) {
        sort_items(keys, scratch, count, sizeof *keys, compare_keys);
        return;
    }
    for (int shift = 0; shift < KEY_BITS; shift += DIGIT_BITS) {
        if (!sort_by_digit(from, to, count, shift)) continue;
        sort_key *swapped = from;
        from = to;
        to = swapped;
    }
    if (from != keys) memcpy(keys, from, count * sizeof *keys);
}
