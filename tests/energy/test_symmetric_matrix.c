/* Eigenvectors of small symmetric matrices, also with eigenvalues that are equal, nearly equal, or far apart. */
#include "runtime/energy/energy.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* Entries of very different sizes, of which some are 0 and some are repeated. */
static double any_entry(random_stream *random, uint32_t style) {
    if (style == 0) return stream_between(random, -1.0, 1.0);
    if (style == 1) return (double)stream_below(random, 3) - 1.0;
    if (style == 2) return stream_below(random, 2) == 0 ? 0.0 : exp(stream_between(random, -60.0, 60.0));
    return 1.0 + (double)stream_below(random, 2) * 0x1p-50;
}

static void check_decomposition(const symmetric_matrix *was, const symmetric_matrix *now,
                                double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX]) {
    double largest = 0.0;
    for (int i = 0; i < was->size; i++) {
        for (int j = 0; j < was->size; j++) largest = fmax(largest, fabs(was->m[i][j]));
    }
    for (int i = 0; i < was->size; i++) {
        for (int j = 0; j < was->size; j++) {
            double sum = 0.0, product = 0.0;
            for (int e = 0; e < was->size; e++) {
                sum += now->m[e][e] * vectors[e][i] * vectors[e][j];
                product += vectors[i][e] * vectors[j][e];
            }
            assert_true(fabs(sum - was->m[i][j]) <= 3e-14 * largest);
            assert_true(fabs(product - (i == j)) <= 2e-14);
        }
    }
}

TEST(matrices_are_their_eigenvectors) {
    random_stream random = stream_start(1);
    for (int round = 0; round < NIGHTLY(4000, 100000); round++) {
        symmetric_matrix was = {.size = 1 + round % 9}, now;
        double vectors[SYMMETRIC_MAX][SYMMETRIC_MAX];
        for (int i = 0; i < was.size; i++) {
            for (int j = 0; j <= i; j++)
                was.m[i][j] = was.m[j][i] = any_entry(&random, (uint32_t)round / 9 % 4);
        }
        now = was;
        symmetric_diagonalize(&now, vectors);
        check_decomposition(&was, &now, vectors);
    }
}

/* What is left without the negative part must be positive, by the full decomposition. */
static void check_negative(const diagonal_and_square *m) {
    double values[2], vectors[2][SQUARE_MAX], all[SYMMETRIC_MAX][SYMMETRIC_MAX], largest = m->factor;
    symmetric_matrix whole = {.size = m->size}, found = {.size = m->size};
    for (int i = 0; i < m->size; i++) {
        largest = fmax(largest, fabs(m->diagonal[i]));
        for (int j = 0; j < m->size; j++)
            whole.m[i][j] = m->factor * m->vector[i] * m->vector[j] + (i == j ? m->diagonal[i] : 0.0);
    }
    int count = diagonal_and_square_negative(m, values, vectors);
    for (int e = 0; e < count; e++) {
        assert_true(values[e] < 0.0);
        for (int i = 0; i < m->size; i++) {
            for (int j = 0; j < m->size; j++) found.m[i][j] += values[e] * vectors[e][i] * vectors[e][j];
        }
    }
    symmetric_diagonalize(&whole, all);
    for (int i = 0; i < m->size; i++) {
        for (int j = 0; j < m->size; j++) {
            double negative = 0.0;
            for (int e = 0; e < m->size; e++) negative += fmin(whole.m[e][e], 0.0) * all[e][i] * all[e][j];
            if (fabs(negative - found.m[i][j]) > 1e-13 * largest)
                fail_msg("%g, not %g", found.m[i][j] / largest, negative / largest);
        }
    }
}

static diagonal_and_square random_square(random_stream *random, int style) {
    diagonal_and_square m = {.size = style % 2 == 0 ? 5 : 3,
                             .factor = exp(stream_between(random, -8.0, 8.0))};
    double length = 0.0, low = -exp(stream_between(random, -3.0, 3.0));
    m.diagonal[0] = low;
    m.diagonal[1] = exp(stream_between(random, -3.0, 3.0));
    m.diagonal[2] = style % 2 == 0 ? low * (1.0 + (style % 6 < 4 ? stream_between(random, 0.0, 2.0)
                                                                 : stream_between(random, -1.0, 1.0) * 1e-15))
                                   : 0.0;
    m.diagonal[3] = exp(stream_between(random, -3.0, 3.0));
    for (int i = 0; i < m.size; i++) {
        bool small = style % 5 == i;
        m.vector[i] =
            stream_between(random, -1.0, 1.0) * (small ? exp(stream_between(random, -60.0, 0.0)) : 1.0);
        if (small && style % 7 == 0) m.vector[i] = 0.0;
        length += m.vector[i] * m.vector[i];
    }
    for (int i = 0; i < m.size; i++) m.vector[i] /= sqrt(length);
    return m;
}

TEST(negative_parts_are_found_between_poles) {
    random_stream random = stream_start(2);
    for (int round = 0; round < NIGHTLY(20000, 1000000); round++) {
        diagonal_and_square m = random_square(&random, round);
        check_negative(&m);
        m.factor = 0.0;
        check_negative(&m);
    }
}
