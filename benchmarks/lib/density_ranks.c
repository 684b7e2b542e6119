/* The order of charge densities, and how far two solutions agree about it: cuts are made of nothing else. */
#include "benchmarks/lib/density_ranks.h"
#include "models/shapes/body.h"

#include <stdlib.h>

typedef struct ordered_density {
    double density;
    uint32_t triangle;
} ordered_density;

static int compare_densities(const void *left, const void *right) {
    const ordered_density *a = left, *b = right;
    if (a->density != b->density) return a->density < b->density ? -1 : 1;
    return a->triangle < b->triangle ? -1 : 1;
}

uint32_t *density_ranks(const double *density, uint32_t count) {
    ordered_density *sorted = body_allocate(count, sizeof *sorted);
    uint32_t *ranks = body_allocate(count, sizeof *ranks);
    for (uint32_t t = 0; t < count; t++) sorted[t] = (ordered_density){density[t], t};
    qsort(sorted, count, sizeof *sorted, compare_densities);
    for (uint32_t i = 0; i < count; i++) ranks[sorted[i].triangle] = i;
    free(sorted);
    return ranks;
}

rank_agreement density_ranks_compare(const double *a, const double *b, uint32_t count) {
    uint32_t *of_a = density_ranks(a, count), *of_b = density_ranks(b, count);
    const double n = count;
    double squares = 0.0, both = 0.0;
    for (uint32_t t = 0; t < count; t++) {
        const double d = (double)of_a[t] - (double)of_b[t];
        squares += d * d;
        both += of_a[t] < count / 10 && of_b[t] < count / 10;
    }
    free(of_a);
    free(of_b);
    return (rank_agreement){1.0 - 6.0 * squares / (n * (n * n - 1.0)), both / (count / 10)};
}
