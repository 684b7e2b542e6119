/* Dense linear systems in double precision: LU with partial pivoting, by LAPACK and BLAS on the host's
 * threads. */
#pragma once

#include "preprocess/baselines/dense/dense_interface.h"

/* matrix: count x count, column after column, replaced by its factors, whose diagonal is 0 where a column depends on those before it;
 * pivots: count. CANCELLED, OUT_OF_MEMORY: they mean nothing. OUT_OF_MEMORY: the address space has no room for the buffers of the BLAS.
 * The bits of the factors depend on neither the number of threads nor who runs them. */
cscd_status dense_factor(const dense_host *host, double *matrix, uint32_t count, int32_t *pivots);

/* vector is replaced by the solution. No number on the diagonal of the factors is 0. */
void dense_substitute(const double *factors, uint32_t count, const int32_t *pivots, double *vector);
