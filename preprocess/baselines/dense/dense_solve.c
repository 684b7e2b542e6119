/* Dense linear systems in double precision: LU with partial pivoting, by LAPACK and BLAS.
 *
 * The matrix is factored from left to right, panel by panel. When a panel is factored, every column to its
 * right is brought up to date: rows swapped, solved with the panel's triangle, and less the product of the
 * panel's lower part with what came out. That is a task for each panel to come, and panels depend on nothing
 * but the size, so the factors are the same whoever runs the tasks. The next panel's task factors it at once:
 * nobody else touches it, and the others need not wait for it. Between two rounds the solve can be
 * cancelled. */
#include "preprocess/baselines/dense/dense.h"

#include <lapacke.h>
#include <pthread.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/mman.h>

_Static_assert(sizeof(lapack_int) == sizeof(int32_t), "LAPACKE with 64-bit integers");

/* Measured: narrower panels make the products thin, wider ones leave few tasks. */
enum { PANEL_WIDTH = 256 };

/* BLAS by its Fortran names. GSL's own library has its C names (cblas_dgemm), and where that comes before OpenBLAS, those
 * would be found: right, but some seven times slower. */
void dgemm_(const char *transposes_a, const char *transposes_b, const lapack_int *m, const lapack_int *n,
            const lapack_int *k, const double *alpha, const double *a, const lapack_int *lda, const double *b,
            const lapack_int *ldb, const double *beta, double *c, const lapack_int *ldc);
void dtrsm_(const char *side, const char *triangle, const char *transposes, const char *diagonal,
            const lapack_int *m, const lapack_int *n, const double *alpha, const double *a,
            const lapack_int *lda, double *b, const lapack_int *ldb);

/* ---- OpenBLAS's threads and buffers ------------------------------------------------------------------- */

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

/* Each thread that computes in OpenBLAS takes a buffer of this size (BUFFER_SIZE of common_x86_64.h; less
 * elsewhere), which OpenBLAS then keeps. If the system has no room for it, as under `ulimit -v`, OpenBLAS
 * asks again and again, for ever. So we first reserve the buffers that it has not had room for before. */
static const size_t blas_buffer_size = (size_t)128 << 20;
static size_t buffers_wanted, buffers_had;

static bool buffers_fit(size_t workers) {
    if (buffers_wanted + workers <= buffers_had) return true;
    size_t more = buffers_wanted + workers - buffers_had;
    void *room =
        mmap(NULL, more * blas_buffer_size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) return false;
    munmap(room, more * blas_buffer_size);
    buffers_had += more;
    return true;
}

/* workers: the number of threads that will compute at a time. False: there is no room for their buffers. */
static bool begin_single_thread(size_t workers) {
    if (openblas_set_num_threads == NULL || openblas_get_num_threads == NULL) return true;
    pthread_mutex_lock(&blas_lock);
    bool fit = buffers_fit(workers);
    if (fit) buffers_wanted += workers;
    if (fit && blas_users++ == 0) {
        blas_threads_before = openblas_get_num_threads();
        openblas_set_num_threads(1);
    }
    pthread_mutex_unlock(&blas_lock);
    return fit;
}

static void end_single_thread(size_t workers) {
    if (openblas_set_num_threads == NULL || openblas_get_num_threads == NULL) return;
    pthread_mutex_lock(&blas_lock);
    buffers_wanted -= workers;
    if (--blas_users == 0) openblas_set_num_threads(blas_threads_before);
    pthread_mutex_unlock(&blas_lock);
}

/* ---- factors ------------------------------------------------------------------------------------------ */

typedef struct factoring {
    const dense_host *host;
    double *matrix;
    lapack_int *pivots; /* from 1, and until all are done, from the panel's first row on */
    uint32_t count;
    uint32_t begin, end; /* columns of the panel that is factored last */
    double done;         /* of the whole work */
} factoring;

static uint32_t smaller_count(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

static double *entry_at(const factoring *f, uint32_t row, uint32_t column) {
    return f->matrix + (size_t)column * f->count + row;
}

/* Factors the rows from `begin` on of columns begin to end - 1. The plain forms of LAPACKE would search the
 * whole matrix for NaN first, the _work forms do not. */
static void factor_panel(factoring *f, uint32_t begin, uint32_t end) {
    LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, (lapack_int)(f->count - begin), (lapack_int)(end - begin),
                        entry_at(f, begin, begin), (lapack_int)f->count, f->pivots + begin);
}

/* Swaps rows as the panel [begin, end) does, in columns first to last - 1. */
static void swap_rows(const factoring *f, uint32_t begin, uint32_t end, uint32_t first, uint32_t last) {
    LAPACKE_dlaswp_work(LAPACK_COL_MAJOR, (lapack_int)(last - first), entry_at(f, begin, first),
                        (lapack_int)f->count, 1, (lapack_int)(end - begin), f->pivots + begin, 1);
}

/* Brings columns first to last - 1, right of the panel, up to date. */
static void update_columns(const factoring *f, uint32_t first, uint32_t last) {
    uint32_t begin = f->begin, end = f->end;
    lapack_int n = (lapack_int)f->count, width = (lapack_int)(end - begin);
    lapack_int columns = (lapack_int)(last - first);
    swap_rows(f, begin, end, first, last);
    const double one = 1.0, minus_one = -1.0;
    lapack_int below = n - (lapack_int)end;
    dtrsm_("L", "L", "N", "U", &width, &columns, &one, entry_at(f, begin, begin), &n,
           entry_at(f, begin, first), &n);
    if (below == 0) return;
    dgemm_("N", "N", &below, &columns, &width, &minus_one, entry_at(f, end, begin), &n,
           entry_at(f, begin, first), &n, &one, entry_at(f, end, first), &n);
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

static uint32_t panels_of(uint32_t count) {
    return count / PANEL_WIDTH + (count % PANEL_WIDTH != 0);
}

static cscd_status factor_panels(factoring *f) {
    const dense_host *host = f->host;
    uint32_t panels = panels_of(f->count);
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

static cscd_status fail_without_room(const dense_host *host, uint32_t workers) {
    char sentence[256];
    snprintf(
        sentence, sizeof sentence,
        "charge: OpenBLAS needs %zu MiB of address space for buffers, one for each of %u threads, and a limit "
        "(ulimit -v) leaves less; raise it, or use fewer threads",
        workers * (blas_buffer_size >> 20), (unsigned)workers);
    host->explain(host->context, CSCD_OUT_OF_MEMORY, sentence);
    return CSCD_OUT_OF_MEMORY;
}

cscd_status dense_factor(const dense_host *host, double *matrix, uint32_t count, int32_t *pivots) {
    factoring f = {.host = host, .matrix = matrix, .pivots = pivots, .count = count};
    uint32_t workers = smaller_count(host->threads, panels_of(count));
    if (!begin_single_thread(workers)) return fail_without_room(host, workers);
    cscd_status status = factor_panels(&f);
    end_single_thread(workers);
    return status;
}

void dense_substitute(const double *factors, uint32_t count, const int32_t *pivots, double *vector) {
    lapack_int n = (lapack_int)count;
    begin_single_thread(0); /* there is a buffer since the factors were made */
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, factors, n, pivots, vector, n);
    end_single_thread(0);
}
