/* Dense linear systems for the tests on Windows, which has no LAPACKE: plain elimination with partial pivoting, on
 * one thread. The tree is compared with it, which makes plans by charge there. */
#include "preprocess/baselines/dense/blas_choice.h"
#include "preprocess/baselines/dense/dense.h"
#include "src/core/baseline_library.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* No BLAS is linked here. */
const char *blas_choice_name(void) {
    return NULL;
}

const char *blas_choice_better(void) {
    return NULL;
}

static void swap_rows(double *matrix, uint32_t count, uint32_t a, uint32_t b) {
    for (uint32_t column = 0; a != b && column < count; column++) {
        double *of_column = matrix + (size_t)column * count;
        const double kept = of_column[a];
        of_column[a] = of_column[b];
        of_column[b] = kept;
    }
}

static uint32_t find_pivot(const double *column, uint32_t begin, uint32_t count) {
    uint32_t best = begin;
    for (uint32_t row = begin + 1; row < count; row++)
        if (fabs(column[row]) > fabs(column[best])) best = row;
    return best;
}

/* Columns that stay near the processor while all others pass by. */
enum { PANEL = 32 };

/* Takes column k, which is done, out of another one. */
static void subtract_column(const double *matrix, uint32_t count, uint32_t k, double *other) {
    const double *column = matrix + (size_t)k * count;
    const double factor = other[k];
    if (column[k] == 0.0) return;
    for (uint32_t row = k + 1; row < count; row++) other[row] -= column[row] * factor;
}

/* Its pivot, and what is below it. */
static void finish_column(double *matrix, uint32_t count, uint32_t k, int32_t *pivots) {
    double *column = matrix + (size_t)k * count;
    const uint32_t pivot = find_pivot(column, k, count);
    pivots[k] = (int32_t)pivot;
    swap_rows(matrix, count, k, pivot);
    if (column[k] == 0.0) return;
    for (uint32_t row = k + 1; row < count; row++) column[row] /= column[k];
}

cscd_status dense_factor(const dense_host *host, double *matrix, uint32_t count, int32_t *pivots) {
    for (uint32_t begin = 0; begin < count; begin += PANEL) {
        const uint32_t end = count - begin < PANEL ? count : begin + PANEL;
        for (uint32_t k = begin; k < end; k++) {
            if (!host->go_on(host->context, (double)k / count)) return host->progress(host->context);
            finish_column(matrix, count, k, pivots);
            for (uint32_t j = k + 1; j < end; j++)
                subtract_column(matrix, count, k, matrix + (size_t)j * count);
        }
        for (uint32_t j = end; j < count; j++)
            for (uint32_t k = begin; k < end; k++)
                subtract_column(matrix, count, k, matrix + (size_t)j * count);
    }
    return host->progress(host->context);
}

void dense_substitute(const double *factors, uint32_t count, const int32_t *pivots, double *vector) {
    for (uint32_t k = 0; k < count; k++) {
        const double kept = vector[k];
        vector[k] = vector[pivots[k]];
        vector[pivots[k]] = kept;
    }
    for (uint32_t k = 0; k < count; k++)
        for (uint32_t row = k + 1; row < count; row++)
            vector[row] -= factors[(size_t)k * count + row] * vector[k];
    for (uint32_t k = count; k-- > 0;) {
        vector[k] /= factors[(size_t)k * count + k];
        for (uint32_t row = 0; row < k; row++) vector[row] -= factors[(size_t)k * count + row] * vector[k];
    }
}

/* ---- in the place of the library ----------------------------------------------------------------------- */

/* Stands in the place of libcscd-baselines in the tests on Windows and in WebAssembly, which have none. */
cscd_status baseline_library_find(cscd_context *context, const char *entry_name, uint32_t interface,
                                  const char *what, const void **out) {
    *out = strcmp(entry_name, DENSE_ENTRY) == 0 ? dense_functions_of(interface) : NULL;
    return *out != NULL ? CSCD_OK : context_fail(context, CSCD_SYSTEM_ERROR, "%s is not there", what);
}
