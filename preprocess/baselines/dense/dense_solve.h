/* Dense linear systems in single precision: LU with partial pivoting, by LAPACK and BLAS on the host's
 * threads. */
#pragma once

#include "preprocess/baselines/dense/dense_interface.h"

/* matrix: count x count, column after column, replaced by its factors; pivots: count. *zero_pivot becomes 0,
 * or k when the k-th pivot (from 1) is exactly 0. CANCELLED, OUT_OF_MEMORY: neither means anything. OUT_OF_MEMORY: the
 * address space has no room for the buffers of the BLAS. The bits of the factors depend on neither the number of
 * threads nor who runs them. */
cscd_status dense_factor(const dense_host *host, float *matrix, uint32_t count, int32_t *pivots,
                         uint32_t *zero_pivot);

/* vector is replaced by the solution. */
void dense_substitute(const float *factors, uint32_t count, const int32_t *pivots, float *vector);
