/* The operations of src/core/simd.h behind plain arrays, compiled once per instruction set. */
#pragma once

#include <stdint.h>

enum { OPERATION_LANES = 8 };

/* Each operation takes eight numbers; those of f64w take as many at a time as a vector of the level holds. */
typedef struct simd_operations {
    int level;

    void (*f32_min)(const float *a, const float *b, float *out);
    void (*f32_max)(const float *a, const float *b, float *out);
    void (*f32_abs)(const float *a, float *out);
    void (*f32_sqrt)(const float *a, float *out);
    uint32_t (*f32_below)(const float *a, const float *b);
    float (*f32_least)(const float *a);
    float (*f32_greatest)(const float *a);
    void (*f32_transpose)(const float (*rows)[8], float (*out)[8]);

    uint32_t (*i32_negative)(const uint32_t *a);
    void (*i32_equal)(const uint32_t *a, const uint32_t *b, int32_t *out);
    void (*f32_above)(const float *a, const float *b, int32_t *out);

    void (*f64_min)(const double *a, const double *b, double *out);
    void (*f64_max)(const double *a, const double *b, double *out);
    void (*f64_abs)(const double *a, double *out);
    void (*f64_sqrt)(const double *a, double *out);
    uint32_t (*f64_below)(const double *a, const double *b);
    void (*to_f32)(const double *a, float *out);
    void (*to_f64)(const float *a, double *out);
    void (*f64_load_points)(const double *positions, const uint32_t *indices, double (*out)[8]);

    void (*f64w_min)(const double *a, const double *b, double *out);
    void (*f64w_max)(const double *a, const double *b, double *out);
    void (*f64w_abs)(const double *a, double *out);
    void (*f64w_sqrt)(const double *a, double *out);
    uint32_t (*f64w_below)(const double *a, const double *b);
    uint32_t (*f64w_at_most)(const double *a, const double *b);
    void (*f64w_select)(uint32_t lanes, const double *a, const double *b, double *out);
    void (*f64w_all)(double x, double *out);
    void (*f64w_load_points)(const double *positions, const uint32_t *indices, double (*out)[8]);
    void (*f64w_quads)(double (*rows)[4], double (*columns)[8], double (*back)[4]);
} simd_operations;

extern const simd_operations simd_operations_scalar;
#ifdef CSCD_WITH_AVX
extern const simd_operations simd_operations_avx2, simd_operations_avx512;
#endif
#ifdef CSCD_WITH_NEON
extern const simd_operations simd_operations_neon;
#endif
