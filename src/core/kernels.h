/* Kernels seen from outside: how many things they take at a time, and which table of them serves a context.
 *
 * A kernel is an inner loop that is compiled once per instruction set. Each room that has some puts pointers to
 * them into a table of a type of its own, one table per level, which SIMD_NAME of simd.h names. */
#pragma once

#include "cscd/cscd.h"

/* The width of all batches; a set of lanes is the low eight bits of an integer, bit i for lane i. */
enum { LANES = 8, ALL_LANES = 255 };

/* DECLARE_KERNELS(type) declares the tables that this build has, type_scalar and so on;
 * KERNELS_OF(context, type) is the address of the one for the context's level. */
#ifdef CSCD_WITH_AVX
#define DECLARE_KERNELS(type) extern const type type##_scalar, type##_avx2, type##_avx512
#define KERNELS_OF(context, type)                                                                            \
    ((context)->simd == CSCD_SIMD_AVX512 ? &type##_avx512                                                    \
     : (context)->simd == CSCD_SIMD_AVX2 ? &type##_avx2                                                      \
                                         : &type##_scalar)
#elif defined(CSCD_WITH_NEON)
#define DECLARE_KERNELS(type)     extern const type type##_scalar, type##_neon
#define KERNELS_OF(context, type) ((context)->simd == CSCD_SIMD_NEON ? &type##_neon : &type##_scalar)
#else
#define DECLARE_KERNELS(type)     extern const type type##_scalar
#define KERNELS_OF(context, type) ((void)(context), &type##_scalar)
#endif
