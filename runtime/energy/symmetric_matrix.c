/* Eigenvalues and eigenvectors of small symmetric matrices. */
#include "runtime/energy/energy.h"

#include "src/core/floating.h"

#include <math.h>

/* ---- by reflections and rotations ---------------------------------------------------------------------- */

static double largest_entry(const symmetric_matrix *a) {
    double largest = 0.0;
    for (int i = 0; i < a->size; i++) {
        for (int j = 0; j <= i; j++) largest = max_of(largest, fabs(a->m[i][j]));
    }
    return largest;
}

/* A matrix with entries on the diagonal, and beside[i] between i and i + 1. */
typedef struct tridiagonal_matrix {
    double diagonal[SYMMETRIC_MAX], beside[SYMMETRIC_MAX];
} tridiagonal_matrix;

/* Reflects all behind `k` onto the axis k + 1, so that row k has one entry beside the diagonal (Householder 1958). Reflections of
 * `vectors` are those of their columns. */
static double reflect_row(symmetric_matrix *a, int k, double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX]) {
    const int n = a->size;
    double u[SYMMETRIC_MAX], image[SYMMETRIC_MAX] = {0.0}, behind = 0.0, half = 0.0;
    for (int i = k + 1; i < n; i++) {
        u[i] = a->m[i][k];
        if (i > k + 1) behind += u[i] * u[i];
    }
    const double entry = u[k + 1], square = behind + entry * entry;
    const double length = entry < 0.0 ? sqrt(square) : -sqrt(square);
    if (behind == 0.0) return entry;
    u[k + 1] -= length;
    const double factor = 1.0 / (square - entry * length); /* 2 / u^2 */
    for (int i = k + 1; i < n; i++) {
        for (int j = k + 1; j < n; j++) image[i] += a->m[i][j] * u[j];
        image[i] *= factor;
        half += 0.5 * factor * image[i] * u[i];
    }
    for (int i = k + 1; i < n; i++) image[i] -= half * u[i];
    for (int i = k + 1; i < n; i++) {
        for (int j = k + 1; j < n; j++) a->m[i][j] -= u[i] * image[j] + image[i] * u[j];
    }
    double along[SYMMETRIC_MAX] = {0.0};
    for (int i = k + 1; i < n; i++) {
        for (int j = 0; j < n; j++) along[j] += factor * u[i] * vectors[i][j];
    }
    for (int i = k + 1; i < n; i++) {
        for (int j = 0; j < n; j++) vectors[i][j] -= u[i] * along[j];
    }
    return length;
}

static void rotate_vectors(int size, double first[], double second[], double cosine, double sine) {
    for (int k = 0; k < size; k++) {
        const double kept = second[k];
        second[k] = sine * first[k] + cosine * kept;
        first[k] = cosine * first[k] - sine * kept;
    }
}

/* One sweep of rotations from `last` up to `first`, shifted by an eigenvalue of the first two rows (Wilkinson's QL, as in Bowdler,
 * Martin, Reinsch, Wilkinson 1968). */
static void sweep_up(tridiagonal_matrix *t, int size, int first, int last,
                     double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX]) {
    double *d = t->diagonal, *e = t->beside;
    double half = (d[first + 1] - d[first]) / (2.0 * e[first]), root = sqrt(half * half + 1.0);
    double g = d[last] - d[first] + e[first] / (half + (half < 0.0 ? -root : root));
    double sine = 1.0, cosine = 1.0, shift = 0.0;
    for (int i = last - 1; i >= first; i--) {
        const double f = sine * e[i], b = cosine * e[i], length = sqrt(f * f + g * g);
        e[i + 1] = length;
        if (length == 0.0) {
            d[i + 1] -= shift;
            e[last] = 0.0;
            return;
        }
        sine = f / length;
        cosine = g / length;
        const double left = d[i + 1] - shift, turned = (d[i] - left) * sine + 2.0 * cosine * b;
        shift = sine * turned;
        d[i + 1] = left + shift;
        g = cosine * turned - b;
        rotate_vectors(size, vectors[i], vectors[i + 1], cosine, sine);
    }
    d[first] -= shift;
    e[first] = g;
    e[last] = 0.0;
}

enum { SWEEPS_MOST = 60 };

void symmetric_diagonalize(symmetric_matrix *a, double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX]) {
    const int n = a->size;
    tridiagonal_matrix t;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) vectors[i][j] = i == j;
    }
    double scale = largest_entry(a);
    if (!(scale > 0.0 && scale < INFINITY)) return;
    double power = power_of_two(2 - exponent_of(scale)); /* of a finite number this is one, too */
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) a->m[i][j] *= power;
    }
    for (int k = 0; k + 2 < n; k++) t.beside[k] = reflect_row(a, k, vectors);
    if (n > 1) t.beside[n - 2] = a->m[n - 1][n - 2];
    t.beside[n - 1] = 0.0;
    for (int i = 0; i < n; i++) t.diagonal[i] = a->m[i][i];
    for (int first = 0; first < n; first++) {
        for (int sweep = 0; sweep < SWEEPS_MOST; sweep++) {
            int last = first;
            while (last + 1 < n &&
                   fabs(t.beside[last]) > 0x1p-53 * (fabs(t.diagonal[last]) + fabs(t.diagonal[last + 1])) &&
                   fabs(t.beside[last]) > 0x1p-60)
                last++;
            if (last == first) break;
            sweep_up(&t, n, first, last, vectors);
        }
    }
    for (int i = 0; i < n; i++) a->m[i][i] = t.diagonal[i] / power;
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
