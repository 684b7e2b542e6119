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
