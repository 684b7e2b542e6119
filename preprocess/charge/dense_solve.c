/* Dense linear systems in single precision: LU with partial pivoting, by LAPACK and BLAS.
 *
 * The matrix is factored from left to right, panel by panel. When a panel is factored, every column to its
 * right is brought up to date: rows swapped, solved with the panel's triangle, and less the product of the
 * panel's lower part with what came out. That is a task for each panel to come, and panels depend on nothing
 * but the size, so the factors are the same whoever runs the tasks. The next panel's task factors it at once:
 * nobody else touches it, and the others need not wait for it. Between two rounds the solve can be
 * cancelled. */
#include "preprocess/charge/dense_solve.h"

#include <cblas.h>
#include <lapacke.h>
#include <pthread.h>
#include <stddef.h>

_Static_assert(sizeof(lapack_int) == sizeof(int32_t), "LAPACKE with 64-bit integers");

/* Measured (docs/theory/charge.md): narrower panels make the products thin, wider ones leave few tasks. */
enum { PANEL_WIDTH = 256 };

/* ---- OpenBLAS's threads ------------------------------------------------------------------------------- */

/* OpenBLAS keeps one thread count for the whole process. While we are in it, on any thread, it is 1, since
 * the tasks are ours; the first to come stores the count and the last to go restores it. The lock is held for
 * these moments only: a host's loop may lend a thread that waits in the midst of a solve to another context's
 * solve, which would wait for ever for a lock held by the first. Weak: another BLAS may be linked, which then
 * runs with the threads it likes. */
__attribute__((weak)) void openblas_set_num_threads(int count);
__attribute__((weak)) int openblas_get_num_threads(void);
static pthread_mutex_t blas_lock = PTHREAD_MUTEX_INITIALIZER;
static uint32_t blas_users;
static int blas_threads_before;

static void begin_single_thread(void) {
    if (openblas_set_num_threads == NULL || openblas_get_num_threads == NULL) return;
    pthread_mutex_lock(&blas_lock);
    if (blas_users++ == 0) {
        blas_threads_before = openblas_get_num_threads();
        openblas_set_num_threads(1);
    }
    pthread_mutex_unlock(&blas_lock);
}

static void end_single_thread(void) {
    if (openblas_set_num_threads == NULL || openblas_get_num_threads == NULL) return;
    pthread_mutex_lock(&blas_lock);
    if (--blas_users == 0) openblas_set_num_threads(blas_threads_before);
    pthread_mutex_unlock(&blas_lock);
}

/* ---- factors ------------------------------------------------------------------------------------------ */

typedef struct factoring {
    const charge_host *host;
    float *matrix;
    lapack_int *pivots; /* from 1, and until all are done, from the panel's first row on */
    uint32_t count, zero_pivot;
    uint32_t begin, end; /* columns of the panel that is factored last */
    double done;         /* of the whole work */
} factoring;

static uint32_t smaller_count(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

static float *entry_at(const factoring *f, uint32_t row, uint32_t column) {
    return f->matrix + (size_t)column * f->count + row;
}

/* Factors the rows from `begin` on of columns begin to end - 1. The plain forms of LAPACKE would search the
 * whole matrix for NaN first, the _work forms do not. */
static void factor_panel(factoring *f, uint32_t begin, uint32_t end) {
    lapack_int info =
        LAPACKE_sgetrf_work(LAPACK_COL_MAJOR, (lapack_int)(f->count - begin), (lapack_int)(end - begin),
                            entry_at(f, begin, begin), (lapack_int)f->count, f->pivots + begin);
    if (info > 0 && f->zero_pivot == 0) f->zero_pivot = begin + (uint32_t)info;
}

/* Swaps rows as the panel [begin, end) does, in columns first to last - 1. */
static void swap_rows(const factoring *f, uint32_t begin, uint32_t end, uint32_t first, uint32_t last) {
    LAPACKE_slaswp_work(LAPACK_COL_MAJOR, (lapack_int)(last - first), entry_at(f, begin, first),
                        (lapack_int)f->count, 1, (lapack_int)(end - begin), f->pivots + begin, 1);
}

/* Brings columns first to last - 1, right of the panel, up to date. */
static void update_columns(const factoring *f, uint32_t first, uint32_t last) {
    uint32_t begin = f->begin, end = f->end;
    lapack_int n = (lapack_int)f->count, width = (lapack_int)(end - begin);
    lapack_int columns = (lapack_int)(last - first);
    swap_rows(f, begin, end, first, last);
    cblas_strsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, width, columns, 1.0f,
                entry_at(f, begin, begin), n, entry_at(f, begin, first), n);
    cblas_sgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n - (lapack_int)end, columns, width, -1.0f,
                entry_at(f, end, begin), n, entry_at(f, begin, first), n, 1.0f, entry_at(f, end, first), n);
}

/* A task: updates one of the panels to come; the next one is factored, too. */
static void advance_panel(void *data, uint32_t task) {
    factoring *f = data;
    uint32_t begin = f->end + task * PANEL_WIDTH, end = smaller_count(f->count, begin + PANEL_WIDTH);
    if (!f->host->go_on(f->host->context, f->done)) return;
    update_columns(f, begin, end);
    if (task == 0) factor_panel(f, begin, end);
}

/* A task: does the swaps of all panels on the right in the columns of one panel. */
static void swap_left(void *data, uint32_t task) {
    const factoring *f = data;
    uint32_t first = task * PANEL_WIDTH, last = first + PANEL_WIDTH;
    for (uint32_t begin = last; begin < f->count; begin += PANEL_WIDTH)
        swap_rows(f, begin, smaller_count(f->count, begin + PANEL_WIDTH), first, last);
}

/* The share of the work that is done: what is left of n columns costs the cube of their number. */
static double share_done(const factoring *f) {
    double left = 1.0 - (double)f->end / (double)f->count;
    return 1.0 - left * left * left;
}

static cscd_status factor_panels(factoring *f) {
    const charge_host *host = f->host;
    uint32_t panels = f->count / PANEL_WIDTH + (f->count % PANEL_WIDTH != 0);
    f->end = smaller_count(f->count, PANEL_WIDTH);
    factor_panel(f, 0, f->end);
    for (uint32_t left = panels - 1; left > 0; left--) {
        f->done = share_done(f);
        host->run(host->context, left, advance_panel, f);
        cscd_status status = host->progress(host->context);
        if (status != CSCD_OK) return status;
        f->begin = f->end;
        f->end = smaller_count(f->count, f->end + PANEL_WIDTH);
    }
    host->run(host->context, panels - 1, swap_left, f);
    for (uint32_t i = 0; i < f->count; i++) f->pivots[i] += (lapack_int)(i / PANEL_WIDTH * PANEL_WIDTH);
    return CSCD_OK;
}

cscd_status dense_factor(const charge_host *host, float *matrix, uint32_t count, int32_t *pivots,
                         uint32_t *zero_pivot) {
    factoring f = {.host = host, .matrix = matrix, .pivots = pivots, .count = count};
    begin_single_thread();
    cscd_status status = factor_panels(&f);
    end_single_thread();
    *zero_pivot = f.zero_pivot;
    return status;
}

void dense_substitute(const float *factors, uint32_t count, const int32_t *pivots, float *vector) {
    lapack_int n = (lapack_int)count;
    begin_single_thread();
    LAPACKE_sgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, factors, n, pivots, vector, n);
    end_single_thread();
}
