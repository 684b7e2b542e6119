/* The loops of benchmarks/machine, compiled once per instruction set. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Sizes are in bytes, multiples of 1,024. Results are returned so that nothing is optimised away. */
typedef struct machine_kernels {
    const char *name;
    uint32_t f32_lanes, f64_lanes; /* numbers in the widest vector */
    uint64_t (*read)(const void *from, size_t size);
    void (*write)(void *to, size_t size, uint64_t value);
    void (*copy)(void *to, const void *from, size_t size);
    /* Does `steps` multiplications and additions in each of MACHINE_CHAINS accumulators. */
    double (*f32_one)(uint32_t steps), (*f64_one)(uint32_t steps);       /* on single numbers */
    double (*f32_vector)(uint32_t steps), (*f64_vector)(uint32_t steps); /* on vectors */
    /* Tests pairs of boxes of six floats, eight against one at a time as in traversal; returns the number
     * of overlapping pairs. */
    uint64_t (*boxes)(uint32_t steps);
} machine_kernels;

enum { MACHINE_CHAINS = 12, MACHINE_BOXES = 64 };

extern const machine_kernels machine_scalar;
#ifdef CSCD_WITH_AVX
extern const machine_kernels machine_avx2, machine_avx512;
#endif
#ifdef CSCD_WITH_NEON
extern const machine_kernels machine_neon;
#endif
