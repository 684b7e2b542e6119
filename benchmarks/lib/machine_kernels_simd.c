/* The loops of benchmarks/machine, compiled once per instruction set and without the compiler's own
 * vectors. */
#include "benchmarks/lib/machine_kernels.h"

#include "src/core/simd.h"

#if SIMD_LEVEL == SIMD_AVX512
enum { BYTES = 64 };
#elif SIMD_LEVEL == SIMD_AVX2
enum { BYTES = 32 };
#else
enum { BYTES = 16 };
#endif

typedef float f32_wide __attribute__((vector_size(BYTES)));
typedef double f64_wide __attribute__((vector_size(BYTES)));
typedef uint64_t u64_wide __attribute__((vector_size(BYTES)));

enum { UNROLLED = 8, F32_LANES = BYTES / 4, F64_LANES = BYTES / 8 };

/* ---- memory ------------------------------------------------------------------------------------------ */

static uint64_t read_all(const void *from, size_t size) {
    const u64_wide *p = from;
    u64_wide sums[UNROLLED] = {{0}};
    for (size_t i = 0; i < size / BYTES; i += UNROLLED) {
        for (size_t k = 0; k < UNROLLED; k++) sums[k] ^= p[i + k];
    }
    for (int k = 1; k < UNROLLED; k++) sums[0] ^= sums[k];
    return sums[0][0] ^ sums[0][1];
}

static void write_all(void *to, size_t size, uint64_t value) {
    u64_wide *p = to, v = {value, value};
    for (size_t i = 0; i < size / BYTES; i += UNROLLED) {
        for (size_t k = 0; k < UNROLLED; k++) p[i + k] = v;
    }
}

static void copy_all(void *to, const void *from, size_t size) {
    u64_wide *p = to;
    const u64_wide *q = from;
    for (size_t i = 0; i < size / BYTES; i += UNROLLED) {
        u64_wide loaded[UNROLLED];
        for (size_t k = 0; k < UNROLLED; k++) loaded[k] = q[i + k];
        for (size_t k = 0; k < UNROLLED; k++) p[i + k] = loaded[k];
    }
}

/* ---- arithmetic -------------------------------------------------------------------------------------- */

/* This many chains hide the latency of both operations. They are not fused, since the library has no fused
 * ones. */
#define CHAINS_OF(function, type, element, expand)                                                           \
    static double function(uint32_t steps) {                                                                 \
        type x[MACHINE_CHAINS], factor = expand((element)0.999), term = expand((element)0.001);              \
        for (int k = 0; k < MACHINE_CHAINS; k++) x[k] = expand((element)k);                                  \
        for (uint32_t i = 0; i < steps; i++) {                                                               \
            _Pragma("GCC unroll 12") for (int k = 0; k < MACHINE_CHAINS; k++) x[k] = x[k] * factor + term;   \
        }                                                                                                    \
        type sum = x[0];                                                                                     \
        for (int k = 1; k < MACHINE_CHAINS; k++) sum = sum + x[k];                                           \
        return first_of_##type(sum);                                                                         \
    }

static double first_of_float(float x) {
    return (double)x;
}

static double first_of_double(double x) {
    return x;
}

static double first_of_f32_wide(f32_wide x) {
    return (double)x[0];
}

static double first_of_f64_wide(f64_wide x) {
    return x[0];
}

#define ITSELF(x)     (x)
#define ALL_FLOAT(x)  (x - (f32_wide){0})
#define ALL_DOUBLE(x) (x - (f64_wide){0})

CHAINS_OF(chains_f32_one, float, float, ITSELF)
CHAINS_OF(chains_f64_one, double, double, ITSELF)
CHAINS_OF(chains_f32_vector, f32_wide, float, ALL_FLOAT)
CHAINS_OF(chains_f64_vector, f64_wide, double, ALL_DOUBLE)

/* ---- boxes ------------------------------------------------------------------------------------------- */

/* bounds[i] = -min, bounds[3 + i] = max of eight boxes, as columns; all in the first-level cache. */
typedef struct eight_boxes {
    f32x8 bounds[6];
} eight_boxes;

static void make_boxes(eight_boxes boxes[MACHINE_BOXES / LANES]) {
    for (int i = 0; i < MACHINE_BOXES; i++) {
        for (int k = 0; k < 3; k++) {
            float middle = (float)((i * (7 + 4 * k)) % MACHINE_BOXES);
            boxes[i / LANES].bounds[k][i % LANES] = 6.0f - middle;
            boxes[i / LANES].bounds[3 + k][i % LANES] = 6.0f + middle;
        }
    }
}

static uint64_t test_boxes(uint32_t steps) {
    eight_boxes boxes[MACHINE_BOXES / LANES];
    uint64_t found = 0;
    make_boxes(boxes);
    for (uint32_t i = 0; i < steps; i++) {
        const eight_boxes *a = &boxes[i % (MACHINE_BOXES / LANES)],
                          *b = &boxes[i / 8 % (MACHINE_BOXES / LANES)];
        for (int j = 0; j < LANES; j++) {
            uint32_t apart = 0;
            for (int k = 0; k < 3; k++) {
                apart |= f32x8_below(a->bounds[k] + f32x8_all(b->bounds[3 + k][j]), (f32x8){0});
                apart |= f32x8_below(a->bounds[3 + k] + f32x8_all(b->bounds[k][j]), (f32x8){0});
            }
            found += (uint64_t)__builtin_popcount(~apart & ALL_LANES);
        }
    }
    return found;
}

#define NAME_OF_LEVEL(level)                                                                                 \
    (level == SIMD_NEON ? "neon" : level == SIMD_AVX512 ? "avx512" : level == SIMD_AVX2 ? "avx2" : "scalar")

const machine_kernels SIMD_NAME(machine) = {.name = NAME_OF_LEVEL(SIMD_LEVEL),
                                            .f32_lanes = F32_LANES,
                                            .f64_lanes = F64_LANES,
                                            .read = read_all,
                                            .write = write_all,
                                            .copy = copy_all,
                                            .f32_one = chains_f32_one,
                                            .f64_one = chains_f64_one,
                                            .f32_vector = chains_f32_vector,
                                            .f64_vector = chains_f64_vector,
                                            .boxes = test_boxes};
