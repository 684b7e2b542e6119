/* Dense linear systems in single precision: LU with partial pivoting, by LAPACK. */
#ifndef CSCD_DENSE_SOLVE_H
#define CSCD_DENSE_SOLVE_H

#include <stdint.h>

/* matrix: count x count, column after column, replaced by its factors; pivots: count. Returns 0, or k when
 * the k-th pivot (from 1) is exactly 0. */
uint32_t dense_factor(float *matrix, uint32_t count, int32_t *pivots, uint32_t thread_count);

/* vector is replaced by the solution. */
void dense_substitute(const float *factors, uint32_t count, const int32_t *pivots, float *vector,
                      uint32_t thread_count);

#endif
