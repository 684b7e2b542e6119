/* Dense linear systems in single precision: LU with partial pivoting, by LAPACK. */
#include "preprocess/dense_solve.h"

#include <lapacke.h>
#include <pthread.h>
#include <stddef.h>

_Static_assert(sizeof(lapack_int) == sizeof(int32_t), "LAPACKE with 64-bit integers");

/* OpenBLAS keeps one thread count for the whole process. It is set for the call and then put back, and one
 * call at a time does so. Weak: another BLAS may be linked, which then runs with the threads it likes. */
__attribute__((weak)) void openblas_set_num_threads(int count);
__attribute__((weak)) int openblas_get_num_threads(void);
static pthread_mutex_t blas_lock = PTHREAD_MUTEX_INITIALIZER;

/* Returns what to give to end_threads. */
static int begin_threads(uint32_t count) {
    pthread_mutex_lock(&blas_lock);
    if (openblas_set_num_threads == NULL || openblas_get_num_threads == NULL) return 0;
    int before = openblas_get_num_threads();
    openblas_set_num_threads((int)count);
    return before;
}

static void end_threads(int before) {
    if (before > 0) openblas_set_num_threads(before);
    pthread_mutex_unlock(&blas_lock);
}

/* The _work forms: the plain ones would look for NaN in the whole matrix first. */
uint32_t dense_factor(float *matrix, uint32_t count, int32_t *pivots, uint32_t thread_count) {
    lapack_int n = (lapack_int)count;
    int before = begin_threads(thread_count);
    lapack_int info = LAPACKE_sgetrf_work(LAPACK_COL_MAJOR, n, n, matrix, n, pivots);
    end_threads(before);
    return info > 0 ? (uint32_t)info : 0;
}

void dense_substitute(const float *factors, uint32_t count, const int32_t *pivots, float *vector,
                      uint32_t thread_count) {
    lapack_int n = (lapack_int)count;
    int before = begin_threads(thread_count);
    LAPACKE_sgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, factors, n, pivots, vector, n);
    end_threads(before);
}
