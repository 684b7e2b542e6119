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
