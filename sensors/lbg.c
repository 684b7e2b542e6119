/* Vector quantization by splitting (Linde, Buzo and Gray 1980): groups of near vectors and their means. */
#include "sensors/cells.h"

#include <math.h>
#include <string.h>

enum { D = LBG_DIMENSIONS, SQUARINGS = 12, NONE = UINT32_MAX };

static const double *vector_at(const lbg *l, uint32_t i) {
    return l->vectors + (size_t)i * D;
}

static double squared_distance(const double a[D], const double b[D]) {
    double sum = 0.0;
    for (int k = 0; k < D; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

/* Returns the mean distortion per dimension (3.10) over all vectors. */
static double mean_distortion(const lbg *l, uint32_t code_count) {
    double sum = 0.0;
    for (uint32_t c = 0; c < code_count; c++) sum += l->codes[c].distortion;
    return sum / D / l->vector_count;
}

static void report_codes(const lbg *l, uint32_t code_count) {
    if (l->observe != NULL) l->observe(l->user, code_count, mean_distortion(l, code_count));
}

/* ---- means --------------------------------------------------------------------------------------------- */

/* Sums differences to the first vector, so that the mean of equal vectors is that vector. */
static void add_to_sum(const lbg *l, uint32_t i) {
    lbg_code *code = &l->codes[l->labels[i]];
    if (!code->changed) return;
    if (code->count++ == 0) code->first = i;
    const double *v = vector_at(l, i), *first = vector_at(l, code->first);
    for (int k = 0; k < D; k++) code->sum[k] += v[k] - first[k];
}

/* Finds the means of the codes that have changed; a code without a vector keeps its mean. */
static void find_means(const lbg *l, uint32_t code_count) {
    for (uint32_t c = 0; c < code_count; c++) {
        lbg_code *code = &l->codes[c];
        if (!code->changed) continue;
        memset(code->sum, 0, sizeof code->sum);
        code->count = 0;
        code->distortion = 0.0;
        code->indivisible = false;
    }
    for (uint32_t i = 0; i < l->vector_count; i++) add_to_sum(l, i);
    for (uint32_t c = 0; c < code_count; c++) {
        lbg_code *code = &l->codes[c];
        if (!code->changed || code->count == 0) continue;
        double old[D];
        memcpy(old, code->mean, sizeof old);
        for (int k = 0; k < D; k++) code->mean[k] = vector_at(l, code->first)[k] + code->sum[k] / code->count;
        code->moved = code->moved || memcmp(old, code->mean, sizeof old) != 0;
    }
    for (uint32_t i = 0; i < l->vector_count; i++) {
        lbg_code *code = &l->codes[l->labels[i]];
        if (code->changed) code->distortion += squared_distance(vector_at(l, i), code->mean);
    }
    for (uint32_t c = 0; c < code_count; c++) l->codes[c].changed = false;
}

/* ---- the nearest code -------------------------------------------------------------------------------- */

/* Sorts vectors by codes, ascending in each; the vectors of code c end at codes[c].end. */
static void sort_by_code(const lbg *l, uint32_t code_count) {
    uint32_t begin = 0;
    for (uint32_t c = 0; c < code_count; c++) {
        l->codes[c].end = begin;
        begin += l->codes[c].count;
    }
    for (uint32_t i = 0; i < l->vector_count; i++) l->order[l->codes[l->labels[i]].end++] = i;
}

/* Lists the codes that may be as near to a vector of this code as its own. If this code has not moved, only
 * codes that have moved can be. By the triangle inequality none is farther off than twice the farthest
 * vector; the factor leaves room for rounding. */
static uint32_t find_candidates(const lbg *l, uint32_t code, uint32_t code_count) {
    const lbg_code *own = &l->codes[code];
    double farthest = 0.0;
    for (uint32_t i = own->end - own->count; i < own->end; i++) {
        double squared = squared_distance(vector_at(l, l->order[i]), own->mean);
        farthest = squared > farthest ? squared : farthest;
    }
    double limit = farthest * (4.0 + 1e-6);
    uint32_t count = 0;
    for (uint32_t c = 0; c < code_count; c++) {
        if (c == code || !(own->moved || l->codes[c].moved)) continue;
        if (squared_distance(l->codes[c].mean, own->mean) <= limit) l->candidates[count++] = c;
    }
    return count;
}

static uint32_t nearest_code(const lbg *l, uint32_t i, uint32_t candidate_count) {
    uint32_t nearest = l->labels[i];
    double least = squared_distance(vector_at(l, i), l->codes[nearest].mean);
    for (uint32_t j = 0; j < candidate_count; j++) {
        uint32_t c = l->candidates[j];
        double squared = squared_distance(vector_at(l, i), l->codes[c].mean);
        if (squared > least || (squared == least && c > nearest)) continue;
        least = squared;
        nearest = c;
    }
    return nearest;
}

/* Returns whether any vector found a nearer code. */
static bool assign_vectors(const lbg *l, uint32_t code_count) {
    bool any = false;
    sort_by_code(l, code_count);
    for (uint32_t c = 0; c < code_count; c++) {
        uint32_t candidate_count = find_candidates(l, c, code_count), end = l->codes[c].end;
        if (candidate_count == 0) continue;
        for (uint32_t i = end - l->codes[c].count; i < end; i++) {
            uint32_t nearest = nearest_code(l, l->order[i], candidate_count);
            if (nearest == c) continue;
            l->labels[l->order[i]] = nearest;
            l->codes[c].changed = l->codes[nearest].changed = any = true;
        }
    }
    for (uint32_t c = 0; c < code_count; c++) l->codes[c].moved = false;
    return any;
}

/* ---- splitting ----------------------------------------------------------------------------------------- */

static void scale_to_trace_one(double a[D][D]) {
    double trace = 0.0;
    for (int k = 0; k < D; k++) trace += a[k][k];
    for (int i = 0; i < D; i++) {
        for (int k = 0; k < D; k++) a[i][k] /= trace;
    }
}

static void find_covariance(const lbg *l, uint32_t code, double out[D][D]) {
    memset(out, 0, D * sizeof *out);
    for (uint32_t i = 0; i < l->vector_count; i++) {
        if (l->labels[i] != code) continue;
        double d[D];
        for (int k = 0; k < D; k++) d[k] = vector_at(l, i)[k] - l->codes[code].mean[k];
        for (int j = 0; j < D; j++) {
            for (int k = 0; k < D; k++) out[j][k] += d[j] * d[k];
        }
    }
}

/* Finds the direction of largest variance, of any length: powers of the covariance tend to the projection
 * onto it, or, if several directions have the largest variance, onto all of them. */
static void widest_direction(const lbg *l, uint32_t code, double out[D]) {
    double a[D][D], square[D][D];
    find_covariance(l, code, a);
    scale_to_trace_one(a);
    for (int squaring = 0; squaring < SQUARINGS; squaring++) {
        memset(square, 0, sizeof square);
        for (int i = 0; i < D; i++) {
            for (int j = 0; j < D; j++) {
                for (int k = 0; k < D; k++) square[i][j] += a[i][k] * a[k][j];
            }
        }
        memcpy(a, square, sizeof a);
        scale_to_trace_one(a);
    }
    int widest = 0;
    for (int k = 1; k < D; k++) widest = a[k][k] > a[widest][widest] ? k : widest;
    memcpy(out, a[widest], D * sizeof *out);
}

static double project_vector(const lbg *l, uint32_t i, uint32_t code, const double direction[D]) {
    double sum = 0.0;
    for (int k = 0; k < D; k++) sum += (vector_at(l, i)[k] - l->codes[code].mean[k]) * direction[k];
    return sum;
}

/* Gives the vectors of one side to the other code; the side of the first vector stays. Returns false when
 * rounding leaves all vectors on one side. */
static bool divide_code(const lbg *l, uint32_t code, uint32_t other) {
    double direction[D], low = INFINITY, high = -INFINITY;
    widest_direction(l, code, direction);
    for (uint32_t i = 0; i < l->vector_count; i++) {
        if (l->labels[i] != code) continue;
        double x = project_vector(l, i, code, direction);
        low = x < low ? x : low;
        high = x > high ? x : high;
    }
    if (!(low < high)) return false;
    double middle = low <= 0.0 && high > 0.0 ? 0.0 : low;
    bool side = project_vector(l, l->codes[code].first, code, direction) > middle;
    for (uint32_t i = 0; i < l->vector_count; i++) {
        if (l->labels[i] == code && (project_vector(l, i, code, direction) > middle) != side)
            l->labels[i] = other;
    }
    return true;
}

static uint32_t largest_distortion(const lbg *l, uint32_t code_count) {
    uint32_t largest = NONE;
    for (uint32_t c = 0; c < code_count; c++) {
        const lbg_code *code = &l->codes[c];
        if (code->indivisible || code->distortion == 0.0) continue;
        if (largest == NONE || code->distortion > l->codes[largest].distortion) largest = c;
    }
    return largest;
}

/* Fills an empty code with half of the code of largest distortion. Returns false when no code can be
 * split. */
static bool fill_code(const lbg *l, uint32_t empty, uint32_t code_count) {
    for (;;) {
        uint32_t largest = largest_distortion(l, code_count);
        if (largest == NONE) return false;
        if (divide_code(l, largest, empty)) {
            l->codes[largest].changed = l->codes[empty].changed = l->codes[empty].moved = true;
            return true;
        }
        l->codes[largest].indivisible = true;
    }
}

/* ---- the whole ----------------------------------------------------------------------------------------- */

static void fill_empty(const lbg *l, uint32_t code_count) {
    for (uint32_t c = 0; c < code_count; c++) {
        if (l->codes[c].count > 0) continue;
        if (!fill_code(l, c, code_count)) return;
        find_means(l, code_count);
    }
}

static void settle_codes(const lbg *l, uint32_t code_count) {
    double distortion = mean_distortion(l, code_count);
    for (int round = 0; round < LBG_ROUNDS_MAX && assign_vectors(l, code_count); round++) {
        find_means(l, code_count);
        fill_empty(l, code_count);
        report_codes(l, code_count);
        double before = distortion;
        distortion = mean_distortion(l, code_count);
        if (before - distortion <= l->epsilon * before) return;
    }
}

/* Drops the codes that nothing could fill; the others keep their order. */
static uint32_t drop_empty(const lbg *l, uint32_t code_count) {
    uint32_t kept = 0;
    for (uint32_t c = 0; c < code_count; c++) {
        if (l->codes[c].count == 0) continue;
        l->candidates[c] = kept;
        l->codes[kept++] = l->codes[c];
    }
    for (uint32_t i = 0; i < l->vector_count; i++) l->labels[i] = l->candidates[l->labels[i]];
    return kept;
}

uint32_t lbg_run(const lbg *l) {
    uint32_t code_count = 1;
    memset(l->labels, 0, l->vector_count * sizeof *l->labels);
    memset(l->codes, 0, l->codes_max * sizeof *l->codes);
    l->codes[0].changed = l->codes[0].moved = true;
    find_means(l, code_count);
    report_codes(l, code_count);
    while (code_count < l->codes_max && fill_code(l, code_count, code_count)) {
        find_means(l, ++code_count);
        report_codes(l, code_count);
        settle_codes(l, code_count);
    }
    return drop_empty(l, code_count);
}
