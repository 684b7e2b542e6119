/* Compares the operations of src/core/simd.h with plain C on every level that this machine has, at the ends
 * of the ranges, for zeros of both signs and for NaN. */
#include "src/core/system.h"
#include "tests/core/simd_operations.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { LANES = OPERATION_LANES, ROUNDS = 5000 };

typedef struct numbers {
    double x[LANES];
} numbers;

typedef struct floats {
    float x[LANES];
} floats;

static double random_number(random_stream *random) {
    static const double edges[] = {0.0,        -0.0,          1.0,       -1.0,         DBL_MAX,
                                   -DBL_MAX,   DBL_MIN,       0x1p-1074, -0x1p-1074,   INFINITY,
                                   -INFINITY,  NAN,           FLT_MAX,   -FLT_MAX,     FLT_MIN,
                                   0x1p-149,   -0x1p-149,     0x1p-150,  0x1.000001p0, 0x1.000001000001p0,
                                   16777217.0, 0x1.ffffffp127};
    uint32_t count = sizeof edges / sizeof *edges, choice = stream_below(random, 2 * count);
    return choice < count ? edges[choice] : stream_between(random, -2.0, 2.0);
}

static numbers random_numbers(random_stream *random) {
    numbers out;
    for (int i = 0; i < LANES; i++) out.x[i] = random_number(random);
    return out;
}

/* About half of the lanes equal those of a, the others are random. */
static numbers half_equal_numbers(random_stream *random, numbers a) {
    for (int i = 0; i < LANES; i++) a.x[i] = stream_below(random, 2) == 0 ? a.x[i] : random_number(random);
    return a;
}

static floats to_floats(numbers a) {
    floats out;
    for (int i = 0; i < LANES; i++) out.x[i] = (float)a.x[i];
    return out;
}

/* Numbers agree bit for bit; NaN has many forms, and any of them will do. */
static void assert_number(double found, double expected) {
    assert_true(isnan(expected) ? isnan(found) : found == expected && signbit(found) == signbit(expected));
}

static bool lane_of(uint32_t lanes, int i) {
    return (lanes >> i & 1) != 0;
}

/* Calls `check` with the operations of every level. */
static void on_all_levels(void (*check)(const simd_operations *, random_stream *)) {
    const simd_operations *levels[SIMD_LAST] = {&simd_operations_scalar};
#ifdef CSCD_WITH_AVX
    levels[CSCD_SIMD_AVX2 - CSCD_SIMD_SCALAR] = &simd_operations_avx2;
    levels[CSCD_SIMD_AVX512 - CSCD_SIMD_SCALAR] = &simd_operations_avx512;
#endif
#ifdef CSCD_WITH_NEON
    levels[CSCD_SIMD_NEON - CSCD_SIMD_SCALAR] = &simd_operations_neon;
#endif
    for (int i = 0; i < SIMD_LAST; i++) {
        if (!processor_has_simd((cscd_simd)(CSCD_SIMD_SCALAR + i))) continue;
        random_stream random = stream_start(7);
        assert_int_equal(levels[i]->level, i);
        for (int round = 0; round < ROUNDS; round++) check(levels[i], &random);
    }
}

static void check_floats(const simd_operations *o, random_stream *random) {
    numbers wide = random_numbers(random);
    floats a = to_floats(wide), b = to_floats(half_equal_numbers(random, wide)), least, greatest, size, root;
    o->f32_min(a.x, b.x, least.x);
    o->f32_max(a.x, b.x, greatest.x);
    o->f32_abs(a.x, size.x);
    o->f32_sqrt(a.x, root.x);
    uint32_t below = o->f32_below(a.x, b.x);
    for (int i = 0; i < LANES; i++) {
        assert_number(least.x[i], a.x[i] < b.x[i] ? a.x[i] : b.x[i]);
        assert_number(greatest.x[i], a.x[i] > b.x[i] ? a.x[i] : b.x[i]);
        assert_number(size.x[i], fabsf(a.x[i]));
        assert_number(root.x[i], sqrtf(a.x[i]));
        assert_int_equal(lane_of(below, i), a.x[i] < b.x[i]);
    }
    assert_int_equal(below >> LANES, 0);
}

TEST(floats_as_in_c) {
    on_all_levels(check_floats);
}

/* Compares numbers; all zeros are equal. */
static void check_across(const simd_operations *o, random_stream *random) {
    floats a = to_floats(random_numbers(random));
    float least = INFINITY, greatest = -INFINITY, rows[8][8], columns[8][8];
    for (int i = 0; i < LANES; i++) {
        if (isnan(a.x[i])) a.x[i] = (float)i;
        least = fminf(least, a.x[i]);
        greatest = fmaxf(greatest, a.x[i]);
    }
    assert_true(o->f32_least(a.x) == least && o->f32_greatest(a.x) == greatest);
    for (int i = 0; i < 64; i++) rows[i / 8][i % 8] = (float)random_number(random);
    o->f32_transpose((const float(*)[8])rows, columns);
    for (int i = 0; i < 64; i++) assert_number(columns[i % 8][i / 8], rows[i / 8][i % 8]);
}

TEST(across_lanes_as_in_c) {
    on_all_levels(check_across);
}

static void check_negative(const simd_operations *o, random_stream *random) {
    uint32_t a[LANES];
    for (int i = 0; i < LANES; i++) {
        static const uint32_t edges[] = {0, 1, UINT32_MAX, INT32_MAX, 0x80000000u};
        a[i] = stream_below(random, 2) == 0 ? edges[stream_below(random, 5)] : (uint32_t)stream_bits(random);
    }
    uint32_t negative = o->i32_negative(a);
    for (int i = 0; i < LANES; i++) assert_int_equal(lane_of(negative, i), a[i] > INT32_MAX);
    assert_int_equal(negative >> LANES, 0);
}

static void check_equal(const simd_operations *o, random_stream *random) {
    uint32_t a[LANES], b[LANES];
    int32_t equal[LANES];
    for (int i = 0; i < LANES; i++) {
        a[i] = (uint32_t)stream_bits(random);
        b[i] = stream_below(random, 2) == 0 ? a[i] : a[i] ^ 1u << stream_below(random, 32);
    }
    o->i32_equal(a, b, equal);
    for (int i = 0; i < LANES; i++) assert_int_equal(equal[i], a[i] == b[i] ? -1 : 0);
}

static void check_above(const simd_operations *o, random_stream *random) {
    numbers wide = random_numbers(random);
    floats a = to_floats(wide), b = to_floats(half_equal_numbers(random, wide));
    int32_t above[LANES];
    o->f32_above(a.x, b.x, above);
    for (int i = 0; i < LANES; i++) assert_int_equal(above[i], a.x[i] > b.x[i] ? -1 : 0);
}

TEST(integers_as_in_c) {
    on_all_levels(check_negative);
    on_all_levels(check_equal);
}

TEST(masks_as_in_c) {
    on_all_levels(check_above);
}

typedef void binary(const double *a, const double *b, double *out);
typedef uint32_t comparison(const double *a, const double *b);

static void check_min_max(binary *min, binary *max, comparison *below, numbers a, numbers b) {
    numbers least, greatest;
    min(a.x, b.x, least.x);
    max(a.x, b.x, greatest.x);
    uint32_t lanes = below(a.x, b.x);
    for (int i = 0; i < LANES; i++) {
        assert_number(least.x[i], a.x[i] < b.x[i] ? a.x[i] : b.x[i]);
        assert_number(greatest.x[i], a.x[i] > b.x[i] ? a.x[i] : b.x[i]);
        assert_int_equal(lane_of(lanes, i), a.x[i] < b.x[i]);
    }
    assert_int_equal(lanes >> LANES, 0);
}

static void check_doubles(const simd_operations *o, random_stream *random) {
    numbers a = random_numbers(random), b = half_equal_numbers(random, a), size, wide_size, root, wide_root,
            chosen, same;
    uint32_t lanes = (uint32_t)stream_bits(random) & 255, at_most = o->f64w_at_most(a.x, b.x);
    check_min_max(o->f64_min, o->f64_max, o->f64_below, a, b);
    check_min_max(o->f64w_min, o->f64w_max, o->f64w_below, a, b);
    o->f64_abs(a.x, size.x);
    o->f64w_abs(a.x, wide_size.x);
    o->f64_sqrt(a.x, root.x);
    o->f64w_sqrt(a.x, wide_root.x);
    o->f64w_select(lanes, a.x, b.x, chosen.x);
    o->f64w_all(a.x[0], same.x);
    for (int i = 0; i < LANES; i++) {
        assert_number(size.x[i], fabs(a.x[i]));
        assert_number(wide_size.x[i], fabs(a.x[i]));
        assert_number(root.x[i], sqrt(a.x[i]));
        assert_number(wide_root.x[i], sqrt(a.x[i]));
        assert_number(chosen.x[i], lane_of(lanes, i) ? a.x[i] : b.x[i]);
        assert_number(same.x[i], a.x[0]);
        assert_int_equal(lane_of(at_most, i), a.x[i] <= b.x[i]);
    }
    assert_int_equal(at_most >> LANES, 0);
}

TEST(doubles_as_in_c) {
    on_all_levels(check_doubles);
}

static void check_conversions(const simd_operations *o, random_stream *random) {
    numbers a = random_numbers(random), back;
    floats rounded;
    o->to_f32(a.x, rounded.x);
    o->to_f64(rounded.x, back.x);
    for (int i = 0; i < LANES; i++) {
        assert_number(rounded.x[i], (float)a.x[i]);
        assert_number(back.x[i], (double)(float)a.x[i]);
    }
}

TEST(conversions_as_in_c) {
    on_all_levels(check_conversions);
}

static void check_quads(const simd_operations *o, random_stream *random) {
    double rows[LANES][4], columns[4][LANES], back[LANES][4];
    for (int i = 0; i < 4 * LANES; i++) rows[i / 4][i % 4] = random_number(random);
    o->f64w_quads(rows, columns, back);
    for (int i = 0; i < 4 * LANES; i++) {
        assert_number(columns[i % 4][i / 4], rows[i / 4][i % 4]);
        assert_number(back[i / 4][i % 4], rows[i / 4][i % 4]);
    }
}

TEST(rows_of_four_become_columns_and_rows_again) {
    on_all_levels(check_quads);
}

enum { POINTS = 20 };
static double *positions; /* the page behind the last of them cannot be read */

static void check_points(const simd_operations *o, random_stream *random) {
    uint32_t indices[LANES];
    double points[3][LANES], points_x8[3][LANES];
    for (int i = 0; i < 3 * POINTS; i++) positions[i] = random_number(random);
    for (int i = 0; i < LANES; i++)
        indices[i] = stream_below(random, 2) == 0 ? POINTS - 1 : stream_below(random, POINTS);
    o->f64_load_points(positions, indices, points);
    o->f64w_load_points(positions, indices, points_x8);
    for (int i = 0; i < 3 * LANES; i++) {
        double expected = positions[(size_t)indices[i / 3] * 3 + (size_t)i % 3];
        assert_number(points[i % 3][i / 3], expected);
        assert_number(points_x8[i % 3][i / 3], expected);
    }
}

TEST(points_and_no_more_are_read) {
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    char *pages = mmap(NULL, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(pages != MAP_FAILED);
    assert_int_equal(mprotect(pages + page, page, PROT_NONE), 0);
    positions = (double *)(void *)(pages + page) - (ptrdiff_t)(3 * POINTS);
    on_all_levels(check_points);
    munmap(pages, 2 * page);
}
