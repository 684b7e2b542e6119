/* Dense Cholesky factorisation of fronts, and the sums of updates into their parents. */
#include "runtime/untangle/front_factor.h"

#include "runtime/untangle/front_simd.h"
#include "src/core/floating.h"

#include <math.h>
#include <string.h>

/* ---- pivots -------------------------------------------------------------------------------------------------- */

/* A pivot that is this much smaller than the diagonal of the matrix is rounding: Laplacians of up to 20,000 rows without a mass end with
 * pivots up to 2^-45 of it. */
static const double least_pivot = 0x1p-44;

/* Cholesky factorisation as modified for matrices that are not definite: a pivot of such a row is replaced by the largest magnitude in
 * it, or of its diagonal in the matrix. Then what the row takes off any other row is at most what it has there. */
static double replace_pivot(const double *row, size_t count, double diagonal) {
    double largest = fabs(diagonal);
    for (size_t c = 0; c < count; c++) largest = max_of(largest, fabs(row[c]));
    return largest > 0.0 ? largest : 1.0;
}

typedef struct front_work {
    const front_kernels *kernels;
    double *rows, *update; /* of the front at hand */
    size_t pivots, all, stride, update_stride;
    double *diagonal; /* of its pivots, as the matrix has it */
    size_t replaced;
} front_work;

/* Factorises rows that lack nothing but each other. Columns begin at the row's own; those behind the last are 0. */
static void factor_strip(front_work *w, size_t begin, size_t end) {
    for (size_t i = begin; i < end; i++) {
        double *row = w->rows + i * w->stride;
        for (size_t k = begin; k < i; k++) {
            const double *other = w->rows + k * w->stride;
            const double factor = other[i];
            for (size_t c = i; c < w->stride; c++) row[c] -= factor * other[c];
        }
        double pivot = row[i];
        if (!(pivot > 0.0 && pivot > least_pivot * w->diagonal[i])) {
            pivot = replace_pivot(row + i, w->all - i, w->diagonal[i]);
            w->replaced++;
        }
        const double inverse = 1.0 / sqrt(pivot);
        row[i] = inverse;
        for (size_t c = i + 1; c < w->stride; c++) row[c] *= inverse;
    }
}

/* ---- fronts -------------------------------------------------------------------------------------------------- */

/* Rows of pivots that are applied to all others at once, while they are in the cache. */
enum { PANEL = 64 };

static size_t smaller_size(size_t a, size_t b) {
    return a < b ? a : b;
}

static size_t align_down(size_t column) {
    return column / FRONT_ALIGNMENT * FRONT_ALIGNMENT;
}

/* Takes off what `count` pivots from `from` on do to a strip of later pivots. */
static void change_pivots(front_work *w, size_t from, size_t count, size_t begin, size_t end) {
    const size_t column = align_down(begin);
    const double *panel = w->rows + from * w->stride;
    w->kernels->subtract(w->rows + begin * w->stride + column, w->stride, panel + begin, panel + column,
                         w->stride, count, end - begin, w->stride - column);
}

static void change_update(front_work *w, size_t from, size_t count) {
    const double *panel = w->rows + from * w->stride + w->pivots;
    const size_t size = w->all - w->pivots;
    for (size_t begin = 0; begin < size; begin += FRONT_STRIP) {
        const size_t column = align_down(begin), height = smaller_size(FRONT_STRIP, size - begin);
        w->kernels->subtract(w->update + begin * w->update_stride + column, w->update_stride, panel + begin,
                             panel + column, w->stride, count, height, w->update_stride - column);
    }
}

static void factor_front(front_work *w) {
    for (size_t from = 0; from < w->pivots; from += PANEL) {
        const size_t end = smaller_size(from + PANEL, w->pivots);
        for (size_t begin = from; begin < w->pivots; begin += FRONT_STRIP) {
            const size_t behind = smaller_size(begin + FRONT_STRIP, w->pivots);
            const size_t before = smaller_size(begin, end) - from;
            if (before > 0) change_pivots(w, from, before, begin, behind);
            if (begin < end) factor_strip(w, begin, behind);
        }
        change_update(w, from, end - from);
    }
}

/* ---- assembly ------------------------------------------------------------------------------------------------ */

/* Rows that a child's update is added to; their first column is that of the front's local row `begin`. */
typedef struct front_rows {
    double *rows;
    size_t stride, begin;
} front_rows;

static void add_row(const front_rows *to, size_t row, const double *from, const uint32_t *locals,
                    size_t count, size_t unit) {
    double *out = to->rows + row * to->stride;
    if (unit == 1) {
        for (size_t k = 0; k < count; k++) out[locals[k] - to->begin] += from[k];
        return;
    }
    for (size_t k = 0; k < count; k++) {
        double *at = out + 3 * (locals[k] - to->begin);
        for (size_t c = 0; c < 3; c++) at[c] += from[3 * k + c];
    }
}

/* Adds numbers times the identity to a row of blocks. */
static void add_identities(const front_rows *to, size_t row, const double *from, const uint32_t *locals,
                           size_t count) {
    for (size_t k = 0; k < count; k++) {
        double *at = to->rows + row * to->stride + 3 * (locals[k] - to->begin);
        at[0] += from[k];
        at[to->stride + 1] += from[k];
        at[2 * to->stride + 2] += from[k];
    }
}

/* Adds the update of a child. locals: its later rows within the parent, which ascend, as do the later rows. */
static void add_child(front_work *w, const matrix_front *front, const matrix_front *child,
                      const double *update, const uint32_t *locals) {
    const front_rows pivots = {w->rows, w->stride, 0},
                     later = {w->update, w->update_stride, front->pivot_count};
    const uint32_t count = child->row_count - child->pivot_count;
    const size_t unit = child->unit;
    for (uint32_t i = 0; i < count; i++) {
        const front_rows *to = locals[i] < front->pivot_count ? &pivots : &later;
        const size_t row = front->unit * (locals[i] - to->begin);
        for (size_t r = 0; r < unit; r++) {
            const double *from = update + (unit * i + r) * child->update_stride + unit * i;
            if (unit < front->unit)
                add_identities(to, row, from, locals + i, count - i);
            else
                add_row(to, row + r, from, locals + i, count - i, unit);
        }
    }
}

/* Adds the updates of all children, the last one first. */
static void add_children(const front_factors *f, const front_tree *t, front_work *w, uint32_t number) {
    uint32_t *locals = f->locals, *found = f->locals + t->row_count;
    const matrix_front *front = &t->fronts[number];
    const uint32_t first = number - front->descendants;
    for (uint32_t k = 0; k < front->pivot_count; k++) locals[front->first + k] = k;
    for (uint32_t k = front->pivot_count; k < front->row_count; k++)
        locals[t->lists[front->list + k - front->pivot_count]] = k;
    for (uint32_t c = number; c > first; c -= t->fronts[c - 1].descendants + 1) {
        const matrix_front *child = &t->fronts[c - 1];
        for (uint32_t k = 0; k < child->row_count - child->pivot_count; k++)
            found[k] = locals[t->lists[child->list + k]];
        add_child(w, front, child, f->updates + child->update, found);
    }
}

/* Of an update's square the rows above the diagonal are used, from where groups of numbers begin. */
static void clear_update(const front_work *w) {
    for (size_t i = 0; i < w->all - w->pivots; i++) {
        const size_t column = align_down(i);
        memset(w->update + i * w->update_stride + column, 0, (w->update_stride - column) * sizeof *w->update);
    }
}

/* Towards lower addresses, row after row, so that no row is overwritten before its turn. */
static void move_update(const front_work *w, double *to) {
    for (size_t i = 0; i < w->all - w->pivots && to != w->update; i++) {
        const size_t at = i * w->update_stride + align_down(i);
        memmove(to + at, w->update + at, (w->update_stride - align_down(i)) * sizeof *to);
    }
}

void front_factors_begin(front_factors *f) {
    f->height = f->replaced = 0;
}

void front_factors_add(front_factors *f, const cscd_context *context, const front_tree *tree,
                       uint32_t number) {
    const matrix_front *front = &tree->fronts[number];
    front_work w = {.kernels = KERNELS_OF(context, front_kernels),
                    .rows = f->factors + front->factor,
                    .update = f->updates + f->height,
                    .pivots = (size_t)front->unit * front->pivot_count,
                    .all = (size_t)front->unit * front->row_count,
                    .stride = front->stride,
                    .update_stride = front->update_stride,
                    .diagonal = f->scratch};
    for (size_t k = 0; k < w.pivots; k++) w.diagonal[k] = w.rows[k * w.stride + k];
    clear_update(&w);
    if (front->descendants > 0) add_children(f, tree, &w, number);
    factor_front(&w);
    move_update(&w, f->updates + front->update);
    f->height = front->update + (w.all - w.pivots) * w.update_stride;
    f->replaced += front->unit == 1 ? 3 * w.replaced : w.replaced; /* the number stands for three */
}

/* ---- solution ------------------------------------------------------------------------------------------------ */

/* A sum by eight partial sums, which have an order that vectors can keep. */
static double dot_of(const double *a, const double *b, size_t count) {
    double sums[8] = {0.0};
    size_t k = 0;
    for (; k + 8 <= count; k += 8) {
        for (size_t l = 0; l < 8; l++) sums[l] += a[k + l] * b[k + l];
    }
    for (; k < count; k++) sums[k % 8] += a[k] * b[k];
    return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

/* The numbers of a front's rows: one vector of all, or where its unit is 1 three, one behind the other. */
static void gather_rows(const front_tree *t, const matrix_front *front, const double *x, double *out) {
    const size_t along = front->unit == 3 ? 3 : 1, across = front->unit == 3 ? 1 : front->row_count;
    for (uint32_t k = 0; k < front->row_count; k++) {
        const uint32_t place =
            k < front->pivot_count ? front->first + k : t->lists[front->list + k - front->pivot_count];
        for (size_t c = 0; c < 3; c++) out[along * k + across * c] = x[3 * (size_t)place + c];
    }
}

static void scatter_rows(const front_tree *t, const matrix_front *front, double *x, const double *from,
                         uint32_t count) {
    const size_t along = front->unit == 3 ? 3 : 1, across = front->unit == 3 ? 1 : front->row_count;
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t place =
            k < front->pivot_count ? front->first + k : t->lists[front->list + k - front->pivot_count];
        for (size_t c = 0; c < 3; c++) x[3 * (size_t)place + c] = from[along * k + across * c];
    }
}

static void solve_forward(const matrix_front *front, const double *rows, double *x) {
    const size_t pivots = (size_t)front->unit * front->pivot_count,
                 all = (size_t)front->unit * front->row_count;
    for (size_t i = 0; i < pivots; i++) {
        const double *row = rows + i * front->stride;
        const double y = x[i] *= row[i];
        for (size_t c = i + 1; c < all; c++) x[c] -= row[c] * y;
    }
}

static void solve_back(const matrix_front *front, const double *rows, double *x) {
    const size_t pivots = (size_t)front->unit * front->pivot_count,
                 all = (size_t)front->unit * front->row_count;
    for (size_t i = pivots; i-- > 0;) {
        const double *row = rows + i * front->stride;
        x[i] = (x[i] - dot_of(row + i + 1, x + i + 1, all - i - 1)) * row[i];
    }
}

void front_factors_solve(const front_factors *f, const front_tree *tree, double *x) {
    double *scratch = f->scratch;
    for (uint32_t i = 0; i < tree->front_count; i++) {
        const matrix_front *front = &tree->fronts[i];
        gather_rows(tree, front, x, scratch);
        for (size_t c = 0; c < 3; c += front->unit)
            solve_forward(front, f->factors + front->factor, scratch + c * front->row_count);
        scatter_rows(tree, front, x, scratch, front->row_count);
    }
    for (uint32_t i = tree->front_count; i-- > 0;) {
        const matrix_front *front = &tree->fronts[i];
        gather_rows(tree, front, x, scratch);
        for (size_t c = 0; c < 3; c += front->unit)
            solve_back(front, f->factors + front->factor, scratch + c * front->row_count);
        scatter_rows(tree, front, x, scratch, front->pivot_count);
    }
}
