/* Vector quantization: it converges, its distortion falls, and any number of codes will do. */
#include "sensors/cells.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { D = LBG_DIMENSIONS, VECTORS_MAX = 400, TRACE_MAX = 20000 };

/* The reports of one run: codes and distortion after every round. */
typedef struct trace {
    uint32_t length, codes[TRACE_MAX];
    double distortions[TRACE_MAX];
} trace;

static trace told;
static double vectors[VECTORS_MAX * D];
static uint32_t labels[VECTORS_MAX], order[VECTORS_MAX], candidates[VECTORS_MAX];
static lbg_code codes[VECTORS_MAX];

static void observe_distortion(void *user, uint32_t code_count, double distortion) {
    trace *t = user;
    assert_true(t->length < TRACE_MAX);
    t->codes[t->length] = code_count;
    t->distortions[t->length++] = distortion;
}

static lbg run_of(uint32_t vector_count, uint32_t codes_max, double epsilon) {
    told.length = 0;
    return (lbg){vectors, vector_count, codes_max,          epsilon, labels, codes,
                 order,   candidates,   observe_distortion, &told};
}

static double squared_distance(const double *a, const double *b) {
    double sum = 0.0;
    for (int k = 0; k < D; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

/* Computes the distortion from the labels alone. */
static double distortion_of(uint32_t vector_count, uint32_t code_count) {
    double sum = 0.0;
    for (uint32_t c = 0; c < code_count; c++) {
        double mean[D] = {0}, count = 0.0;
        for (uint32_t i = 0; i < vector_count; i++) {
            for (int k = 0; k < D && labels[i] == c; k++) mean[k] += vectors[i * D + (uint32_t)k];
            count += labels[i] == c;
        }
        assert_true(count > 0.0);
        for (int k = 0; k < D; k++) mean[k] /= count;
        for (uint32_t i = 0; i < vector_count; i++)
            sum += labels[i] == c ? squared_distance(vectors + (size_t)i * D, mean) : 0.0;
    }
    return sum / D / vector_count;
}

static void check_falls(double rounding) {
    for (uint32_t i = 1; i < told.length; i++) {
        assert_true(told.distortions[i] <= told.distortions[i - 1] * (1.0 + 1e-12) + rounding);
        assert_true(told.codes[i] == told.codes[i - 1] || told.codes[i] == told.codes[i - 1] + 1);
    }
}

/* Asserts what holds for every result, and returns the number of codes. */
static uint32_t check_run(uint32_t vector_count, uint32_t codes_max, double epsilon) {
    lbg l = run_of(vector_count, codes_max, epsilon);
    uint32_t code_count = lbg_run(&l);
    assert_in_range(code_count, 1, codes_max);
    assert_true(told.length > 0 && told.codes[0] == 1);
    double scale = told.distortions[0] * 1e-14 + 1e-30;
    check_falls(scale);
    double distortion = told.distortions[told.length - 1];
    assert_true(fabs(distortion - distortion_of(vector_count, code_count)) <= 1e-12 * distortion + scale);
    for (uint32_t i = 0; i < vector_count; i++) assert_true(labels[i] < code_count);
    return code_count;
}

/* No vector is nearer to another code: with epsilon 0 the iteration goes on until nothing changes. */
static void check_nearest(uint32_t vector_count, uint32_t code_count) {
    for (uint32_t i = 0; i < vector_count; i++) {
        double own = squared_distance(vectors + (size_t)i * D, codes[labels[i]].mean);
        for (uint32_t c = 0; c < code_count; c++)
            assert_true(own <= squared_distance(vectors + (size_t)i * D, codes[c].mean) * (1.0 + 1e-12));
    }
}

static void scatter_vectors(uint32_t vector_count, int dimensions) {
    memset(vectors, 0, sizeof vectors);
    for (uint32_t i = 0; i < vector_count; i++) {
        for (int k = 0; k < dimensions; k++) vectors[i * D + (uint32_t)k] = random_unit();
    }
}

TEST(random_clouds) {
    random_seed(1);
    for (int n = 0; n < 400; n++) {
        uint32_t vector_count = (uint32_t)random_integer(1, VECTORS_MAX);
        uint32_t codes_max = (uint32_t)random_integer(1, (int)(vector_count < 50 ? vector_count : 50));
        scatter_vectors(vector_count, random_integer(1, D));
        uint32_t code_count = check_run(vector_count, codes_max, n % 2 == 0 ? 1e-3 : 0.0);
        assert_int_equal(code_count, codes_max);
        if (n % 2 != 0) check_nearest(vector_count, code_count);
    }
}

/* Rings, lines and lattices have many equal distances. */
TEST(regular_shapes) {
    random_seed(2);
    for (uint32_t codes_max = 1; codes_max <= 40; codes_max++) {
        memset(vectors, 0, sizeof vectors);
        for (uint32_t i = 0; i < 120; i++) {
            double angle = 2.0 * 3.14159265358979323846 * i / 120;
            vectors[i * D] = vectors[i * D + 3] = cos(angle);
            vectors[i * D + 1] = vectors[i * D + 4] = sin(angle);
        }
        assert_int_equal(check_run(120, codes_max, 1e-3), codes_max);
        for (uint32_t i = 0; i < 343; i++) {
            const uint32_t cell[3] = {i % 7, i / 7 % 7, i / 49};
            for (int k = 0; k < D; k++) vectors[i * D + (uint32_t)k] = k < 3 ? cell[k] : 0.0;
        }
        assert_int_equal(check_run(343, codes_max, 0.0), codes_max);
        for (uint32_t i = 0; i < VECTORS_MAX; i++) {
            for (int k = 0; k < D; k++) vectors[i * D + (uint32_t)k] = random_integer(0, 1);
        }
        assert_int_equal(check_run(VECTORS_MAX, codes_max, 0.0), codes_max);
    }
}

/* Splitting by (1 + epsilon) C finds no direction where C = 0. */
TEST(symmetric_about_the_origin) {
    for (uint32_t i = 0; i < 8; i++) {
        for (uint32_t k = 0; k < D; k++) vectors[i * D + k] = (i >> (k % 3) & 1) != 0 ? 1.0 : -1.0;
    }
    for (uint32_t codes_max = 1; codes_max <= 8; codes_max++)
        assert_int_equal(check_run(8, codes_max, 1e-3), codes_max);
    assert_true(told.distortions[told.length - 1] == 0.0);
}

TEST(equal_vectors) {
    for (uint32_t i = 0; i < 30 * D; i++) vectors[i] = 0.1 * (double)(1 + i % D);
    assert_int_equal(check_run(30, 12, 1e-3), 1);
    assert_true(told.distortions[0] == 0.0);
    for (uint32_t k = 0; k < D; k++) assert_true(codes[0].mean[k] == vectors[k]);
}

/* There are as many codes as different vectors and no more; equal vectors have one code. */
TEST(repeated_vectors) {
    random_seed(3);
    for (int n = 0; n < 50; n++) {
        uint32_t different = (uint32_t)random_integer(2, 20), count = different * 5;
        scatter_vectors(different, 6);
        for (uint32_t i = different; i < count; i++)
            memcpy(vectors + (size_t)i * D, vectors + (size_t)(i % different) * D, D * sizeof *vectors);
        assert_int_equal(check_run(count, count, 0.0), different);
        for (uint32_t i = 0; i < count; i++) assert_int_equal(labels[i], labels[i % different]);
        assert_true(told.distortions[told.length - 1] == 0.0);
    }
}

TEST(two_points) {
    scatter_vectors(2, 0);
    vectors[D + 2] = 1.0;
    assert_int_equal(check_run(2, 1, 1e-3), 1);
    assert_int_equal(check_run(2, 2, 1e-3), 2);
    assert_true(labels[0] == 0 && labels[1] == 1);
    vectors[D + 2] = 0x1p-1000; /* whose square is 0 */
    assert_int_equal(check_run(2, 2, 1e-3), 1);
    vectors[2] = 1.0;
    vectors[D + 2] = nextafter(1.0, 2.0);
    assert_int_equal(check_run(2, 2, 1e-3), 2);
}

TEST(a_code_for_every_vector) {
    random_seed(4);
    scatter_vectors(300, D);
    assert_int_equal(check_run(300, 300, 1e-3), 300);
    assert_true(told.distortions[told.length - 1] == 0.0);
}

/* The same vectors give the same bits again, also when they are scaled by a power of two. */
TEST(repeatable_and_scaled) {
    static uint32_t before[VECTORS_MAX];
    static double distortions[TRACE_MAX];
    random_seed(5);
    scatter_vectors(VECTORS_MAX, D);
    for (uint32_t codes_max = 1; codes_max < 40; codes_max += 3) {
        check_run(VECTORS_MAX, codes_max, 1e-3);
        memcpy(before, labels, sizeof labels);
        memcpy(distortions, told.distortions, sizeof distortions);
        for (uint32_t i = 0; i < VECTORS_MAX * D; i++) vectors[i] *= 0x1p20;
        check_run(VECTORS_MAX, codes_max, 1e-3);
        assert_memory_equal(before, labels, sizeof labels);
        for (uint32_t i = 0; i < told.length; i++)
            assert_true(told.distortions[i] == distortions[i] * 0x1p40);
        for (uint32_t i = 0; i < VECTORS_MAX * D; i++) vectors[i] *= 0x1p-20;
    }
}

/* Four far clusters are found with four codes. */
TEST(far_clusters) {
    random_seed(6);
    scatter_vectors(VECTORS_MAX, D);
    for (uint32_t i = 0; i < VECTORS_MAX; i++) vectors[i * D + i % 4] += 50.0;
    assert_int_equal(check_run(VECTORS_MAX, 4, 1e-3), 4);
    for (uint32_t i = 0; i < VECTORS_MAX; i++) assert_int_equal(labels[i], labels[i % 4]);
}

/* 3 is as near to the mean of the two 0 and itself as to 5: it stays with the code of the lower number. */
TEST(equally_near_codes) {
    static const double line[6] = {0, 0, 3, 5, 5, 5};
    scatter_vectors(6, 0);
    for (uint32_t i = 0; i < 6; i++) vectors[i * D] = line[i];
    assert_int_equal(check_run(6, 2, 0.0), 2);
    for (uint32_t i = 0; i < 6; i++) assert_int_equal(labels[i], i < 3 ? 0 : 1);
}

/* 22 and 33 cannot be told apart, because the square of their difference is 0, but either from 0. A code that has run empty is dropped. */
TEST(squares_that_vanish) {
    static const double line[6] = {22, 22, 0, 33, 33, 22};
    scatter_vectors(6, 0);
    for (uint32_t i = 0; i < 6; i++) vectors[i * D] = line[i] * 1e-163;
    assert_int_equal(check_run(6, 6, 0.01), 2);
    for (uint32_t i = 0; i < 6; i++) assert_int_equal(labels[i], line[i] == 0.0 ? labels[2] : 1 - labels[2]);
}
