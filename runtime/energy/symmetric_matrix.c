/* Eigenvalues and eigenvectors of small symmetric matrices. */
#include "runtime/energy/energy.h"

#include "src/core/floating.h"

#include <math.h>

/* Turns the rows and columns p < q by the angle that makes their entry 0 (Rutishauser 1966). */
static void rotate_pair(symmetric_matrix *a, double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX], int p, int q) {
    double entry = a->m[p][q], difference = a->m[q][q] - a->m[p][p];
    if (entry == 0.0) return;
    double tangent = 2.0 * entry / (fabs(difference) + sqrt(difference * difference + 4.0 * entry * entry));
    if (difference < 0.0) tangent = -tangent;
    double cosine = 1.0 / sqrt(1.0 + tangent * tangent), sine = tangent * cosine;
    a->m[p][p] -= tangent * entry;
    a->m[q][q] += tangent * entry;
    a->m[p][q] = a->m[q][p] = 0.0;
    for (int i = 0; i < a->size; i++) {
        double vp = vectors[i][p], vq = vectors[i][q];
        vectors[i][p] = cosine * vp - sine * vq;
        vectors[i][q] = sine * vp + cosine * vq;
        if (i == p || i == q) continue;
        double ap = a->m[i][p], aq = a->m[i][q];
        a->m[i][p] = a->m[p][i] = cosine * ap - sine * aq;
        a->m[i][q] = a->m[q][i] = sine * ap + cosine * aq;
    }
}

static double largest_entry(const symmetric_matrix *a) {
    double largest = 0.0;
    for (int i = 0; i < a->size; i++) {
        for (int j = 0; j <= i; j++) largest = max_of(largest, fabs(a->m[i][j]));
    }
    return largest;
}

static double largest_aside(const symmetric_matrix *a) {
    double largest = 0.0;
    for (int i = 0; i < a->size; i++) {
        for (int j = 0; j < i; j++) largest = max_of(largest, fabs(a->m[i][j]));
    }
    return largest;
}

/* Sweeps converge quadratically: matrices of nine rows need five or six. */
enum { SWEEPS_MOST = 30 };

void symmetric_diagonalize(symmetric_matrix *a, double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX]) {
    for (int i = 0; i < a->size; i++) {
        for (int j = 0; j < a->size; j++) vectors[i][j] = i == j;
    }
    double scale = largest_entry(a);
    if (!(scale > 0.0 && scale < INFINITY)) return;
    double power = power_of_two(2 - exponent_of(scale)); /* of a finite number this is one, too */
    for (int i = 0; i < a->size; i++) {
        for (int j = 0; j < a->size; j++) a->m[i][j] *= power;
    }
    for (int sweep = 0; sweep < SWEEPS_MOST && largest_aside(a) > 0x1p-53; sweep++) {
        for (int p = 0; p < a->size; p++) {
            for (int q = p + 1; q < a->size; q++) rotate_pair(a, vectors, p, q);
        }
    }
    for (int i = 0; i < a->size; i++) a->m[i][i] /= power;
}

/* ---- a diagonal plus a square ------------------------------------------------------------------------------ */

/* The eigenvalues of a diagonal d plus f z z^T are the roots of 1 + f sum z_i^2 / (d_i - x), one between each two neighbouring d_i
 * (Golub 1973). They are found by their distance from the nearer one, by the middle way (Li, LAPACK Working Note 89): it takes the
 * two neighbours as they are and all others as constant. */
typedef struct secular_equation {
    double poles[SQUARE_MAX], squares[SQUARE_MAX]; /* f z_i^2; ascending poles */
    int places[SQUARE_MAX];                        /* of the poles in the matrix */
    int size;
} secular_equation;

/* A square this small beside the largest is none: its pole is an eigenvalue. */
static const double least_square = 1e-32;

static secular_equation sort_poles(const diagonal_and_square *m) {
    secular_equation s = {.size = 0};
    for (int i = 0; i < m->size; i++) {
        double square = m->factor * m->vector[i] * m->vector[i];
        if (!(square > least_square * m->factor)) continue;
        int at = s.size++;
        for (; at > 0 && s.poles[at - 1] > m->diagonal[i]; at--) {
            s.poles[at] = s.poles[at - 1];
            s.squares[at] = s.squares[at - 1];
            s.places[at] = s.places[at - 1];
        }
        s.poles[at] = m->diagonal[i];
        s.squares[at] = square;
        s.places[at] = i;
    }
    return s;
}

/* The sums behind a step: the function, and the derivatives of its parts up to the lower neighbour and from the upper one on. */
typedef struct secular_sums {
    double value, size, below, above;
} secular_sums;

static secular_sums sum_poles(const secular_equation *s, const double *from, int low, double x) {
    secular_sums sums = {1.0, 1.0, 0.0, 0.0};
    for (int i = 0; i < s->size; i++) {
        double inverse = 1.0 / (from[i] - x), part = s->squares[i] * inverse;
        sums.value += part;
        sums.size += fabs(part);
        if (i <= low)
            sums.below += part * inverse;
        else
            sums.above += part * inverse;
    }
    return sums;
}

enum { SECULAR_STEPS = 60 };

/* Writes the distances of all poles from the root above the pole `low`, which another pole follows. */
static void find_root(const secular_equation *s, int low, double distances[SQUARE_MAX]) {
    double middle = 0.5 * (s->poles[low + 1] - s->poles[low]), from[SQUARE_MAX];
    for (int i = 0; i < s->size; i++) from[i] = s->poles[i] - s->poles[low];
    secular_sums at = sum_poles(s, from, low, middle);
    double begin = 0.0, end = middle, x = middle;
    if (at.value < 0.0) { /* the upper pole is nearer */
        for (int i = 0; i < s->size; i++) from[i] = s->poles[i] - s->poles[low + 1];
        begin = x = -middle;
        end = 0.0;
    }
    for (int step = 0; step < SECULAR_STEPS && fabs(at.value) > 0x1p-51 * at.size; step++) {
        if (at.value < 0.0)
            begin = x;
        else
            end = x;
        double lower = from[low] - x, upper = from[low + 1] - x;
        double c = at.value - lower * at.below - upper * at.above;
        double a = (lower + upper) * at.value - lower * upper * (at.below + at.above),
               b = lower * upper * at.value;
        double root = sqrt(max_of(a * a - 4.0 * b * c, 0.0));
        double next = x + (a > 0.0 ? 2.0 * b / (a + root) : (a - root) / (2.0 * c));
        if (!(next > begin && next < end)) next = 0.5 * (begin + end);
        if (next == x) break;
        x = next;
        at = sum_poles(s, from, low, x);
    }
    for (int i = 0; i < s->size; i++) distances[i] = from[i] - x;
}

static void set_vector(const diagonal_and_square *m, const secular_equation *s, const double *distances,
                       double vector[SQUARE_MAX]) {
    double square = 0.0;
    for (int i = 0; i < m->size; i++) vector[i] = 0.0;
    for (int i = 0; i < s->size; i++) {
        double entry = m->vector[s->places[i]] / distances[i];
        vector[s->places[i]] = entry;
        square += entry * entry;
    }
    double length = 1.0 / sqrt(square);
    for (int i = 0; i < m->size; i++) vector[i] *= length;
}

/* Two poles that are one, up to rounding: the root between them is theirs. */
static void set_between(const diagonal_and_square *m, const secular_equation *s, int low,
                        double vector[SQUARE_MAX]) {
    double first = m->vector[s->places[low]], second = m->vector[s->places[low + 1]];
    double length = sqrt(first * first + second * second);
    for (int i = 0; i < m->size; i++) vector[i] = 0.0;
    vector[s->places[low]] = second / length;
    vector[s->places[low + 1]] = -first / length;
}

/* Makes the second vector orthogonal to the first, which equal eigenvalues do not by themselves. */
static void separate_vectors(int size, double vectors[2][SQUARE_MAX]) {
    double along = 0.0, square = 0.0;
    for (int i = 0; i < size; i++) along += vectors[0][i] * vectors[1][i];
    for (int i = 0; i < size; i++) vectors[1][i] -= along * vectors[0][i];
    for (int i = 0; i < size; i++) square += vectors[1][i] * vectors[1][i];
    for (int i = 0; i < size && square > 0.0; i++) vectors[1][i] /= sqrt(square);
}

int diagonal_and_square_negative(const diagonal_and_square *m, double values[2],
                                 double vectors[2][SQUARE_MAX]) {
    secular_equation s = sort_poles(m);
    bool has_square[SQUARE_MAX] = {false};
    int count = 0;
    for (int i = 0; i < s.size; i++) has_square[s.places[i]] = true;
    for (int i = 0; i < m->size && count < 2; i++) {
        if (has_square[i] || !(m->diagonal[i] < 0.0)) continue;
        values[count] = m->diagonal[i];
        for (int j = 0; j < m->size; j++) vectors[count][j] = i == j;
        count++;
    }
    for (int low = 0; low + 1 < s.size && s.poles[low] < 0.0 && count < 2; low++) {
        double distances[SQUARE_MAX] = {0.0};
        if (s.poles[low + 1] - s.poles[low] <= -0x1p-50 * s.poles[low]) {
            values[count] = s.poles[low];
            set_between(m, &s, low, vectors[count]);
        } else {
            find_root(&s, low, distances);
            values[count] = s.poles[low] - distances[low];
            if (!(values[count] < 0.0)) break;
            set_vector(m, &s, distances, vectors[count]);
        }
        count++;
    }
    if (count == 2) separate_vectors(m->size, vectors);
    return count;
}
