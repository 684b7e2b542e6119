/* The times at which two moving features can begin to touch. */
#include "runtime/candidate_times.h"

#include "runtime/cubic.h"

#include <math.h>

static void add(candidate_times *times, double t) {
    times->t[times->count++] = t;
}

/* Point p meets point q in coordinate k. */
static void add_meeting(candidate_times *times, const elementary_query *query, int p, int q, int k) {
    double start = query->x0[p][k] - query->x0[q][k], end = query->x1[p][k] - query->x1[q][k];
    double roots[2];
    int count = quadratic_roots(0.0, end - start, start, roots);
    for (int i = 0; i < count; i++) add(times, roots[i]);
}

/* Points p, q, r turn neither way in the coordinate plane (k, l): (q - p) x (r - p) is a quadratic in t. */
static void add_alignment(candidate_times *times, const elementary_query *query, const int corners[3], int k,
                          int l) {
    int p = corners[0], q = corners[1], r = corners[2];
    double at[3]; /* the cross products of the ends with themselves, and the mixed one */
    const double(*x[2])[3] = {query->x0, query->x1};
    double side[2][2], other[2][2];
    for (int end = 0; end < 2; end++) {
        side[end][0] = x[end][q][k] - x[end][p][k];
        side[end][1] = x[end][q][l] - x[end][p][l];
        other[end][0] = x[end][r][k] - x[end][p][k];
        other[end][1] = x[end][r][l] - x[end][p][l];
    }
    at[0] = side[0][0] * other[0][1] - side[0][1] * other[0][0];
    at[1] = side[0][0] * other[1][1] - side[0][1] * other[1][0] + side[1][0] * other[0][1] -
            side[1][1] * other[0][0];
    at[2] = side[1][0] * other[1][1] - side[1][1] * other[1][0];
    double roots[2];
    int count = quadratic_roots(at[0] - at[1] + at[2], at[1] - 2.0 * at[0], at[0], roots);
    for (int i = 0; i < count; i++) add(times, roots[i]);
}

static bool flat(const coplanarity *f) {
    for (int i = 0; i < 4; i++) {
        if (fabs(f->b[i]) > f->error) return false;
    }
    return true;
}

static void sort(candidate_times *times) {
    for (int i = 1; i < times->count; i++) {
        double t = times->t[i];
        int j = i;
        for (; j > 0 && times->t[j - 1] > t; j--) times->t[j] = times->t[j - 1];
        times->t[j] = t;
    }
}

static void collect(const elementary_query *query, const coplanarity *f, const int alignments[4][3],
                    int alignment_count, const int meetings[4][2], int meeting_count, candidate_times *out) {
    out->count = 0;
    if (!flat(f)) {
        out->count = cubic_roots(f->b, f->error, out->t);
        return;
    }
    add(out, 0.0);
    add(out, 1.0);
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < alignment_count; i++)
            add_alignment(out, query, alignments[i], (axis + 1) % 3, (axis + 2) % 3);
        for (int i = 0; i < meeting_count; i++) add_meeting(out, query, meetings[i][0], meetings[i][1], axis);
    }
    sort(out);
}

void candidate_times_vf(const elementary_query *query, const coplanarity *f, candidate_times *out) {
    static const int alignments[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
    static const int meetings[4][2] = {{0, 1}, {0, 2}, {0, 3}};
    collect(query, f, alignments, 3, meetings, 3, out);
}

void candidate_times_ee(const elementary_query *query, const coplanarity *f, candidate_times *out) {
    static const int alignments[4][3] = {{0, 2, 3}, {1, 2, 3}, {2, 0, 1}, {3, 0, 1}};
    static const int meetings[4][2] = {{0, 2}, {0, 3}, {1, 2}, {1, 3}};
    collect(query, f, alignments, 4, meetings, 4, out);
}
