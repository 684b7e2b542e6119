/* Vector quantization by splitting (Linde, Buzo and Gray 1980): groups of near vectors and their means. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { LBG_DIMENSIONS = 6, LBG_ROUNDS_MAX = 200 };

/* A group of vectors; its mean is the code that stands for them. */
typedef struct lbg_code {
    double mean[LBG_DIMENSIONS], sum[LBG_DIMENSIONS];
    double distortion; /* the sum of squared distances to the mean */
    uint32_t first, count;
    uint32_t end;     /* where its vectors end in `order` */
    bool changed;     /* it got or lost a vector: its mean must be found again */
    bool moved;       /* its mean has changed: vectors must be compared with it */
    bool indivisible; /* until it changes */
} lbg_code;

/* The vectors, the parameters and the result. */
typedef struct lbg {
    const double *vectors;            /* LBG_DIMENSIONS each */
    uint32_t vector_count, codes_max; /* 1 or more each */
    double epsilon;                   /* another round while the distortion falls by more than this share */
    uint32_t *labels;                 /* out: the code of each vector */
    lbg_code *codes;                  /* out, codes_max */
    uint32_t *order, *candidates;     /* vector_count and codes_max, for its own use */

    /* NULL, or told the number of codes and the mean distortion per dimension (3.10) after every round. */
    void (*observe)(void *user, uint32_t code_count, double distortion);
    void *user;
} lbg;

/* The number of codes, none of them empty: codes_max, or fewer where there are fewer different vectors.
 *
 * From one code on, the code of largest distortion is split, one at a time, so any number of codes will do:
 * in two by the plane through its mean across the direction of its largest variance. That is where the
 * published C +- epsilon C, with a step in that direction instead of C, leads for any small epsilon; C itself
 * is no direction for a shape centred at the origin. Then every vector goes to its nearest code and every
 * code to its vectors' mean (3.7-3.9), until the distortion hardly falls (3.11). A code that runs empty takes
 * half of the code of largest distortion. The smaller number wins every tie. */
uint32_t lbg_run(const lbg *l);

/* Finds the codes of given labels, which are all below code_count; codes has room for them. */
void lbg_find_codes(const lbg *l, uint32_t code_count);

/* The mean distortion per dimension (3.10) of code_count codes over all vectors. */
double lbg_distortion(const lbg *l, uint32_t code_count);
