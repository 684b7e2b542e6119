/* The order of charge densities, and how far two solutions agree about it: cuts are made of nothing else. */
#pragma once

#include <stdint.h>

typedef struct rank_agreement {
    double correlation; /* Spearman's, of the ranks */
    double overlap;     /* the share of the lowest tenth that is the other's lowest tenth, too */
} rank_agreement;

/* Returns the rank of each triangle, from 0 for the lowest density, to be freed. Ties go by number. */
uint32_t *density_ranks(const double *density, uint32_t count);

/* At least ten triangles. */
rank_agreement density_ranks_compare(const double *a, const double *b, uint32_t count);
