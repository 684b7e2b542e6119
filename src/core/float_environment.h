/* The floating-point environment of a thread: how it rounds, whether it flushes small numbers to zero, which exceptions
 * trap, and which have occurred.
 *
 * Every bound in the library is derived for rounding to nearest with subnormal numbers, and exact arithmetic relies on
 * it. So every entry sets that environment and puts the host's back when it leaves, and while the host's own code runs
 * in a callback. The flags of the host come back as they were: what the library's arithmetic raises is no news to it. */
#pragma once

#include <stdint.h>

#if !defined(__SSE2__) && !defined(__aarch64__)
#include <fenv.h>
#endif

typedef struct float_environment {
    uint64_t bits; /* what they mean is the processor's affair; elsewhere only the rounding mode */
} float_environment;

#if defined(__SSE2__)

/* MXCSR: rounding to nearest, no FTZ, no DAZ, all exceptions masked. The lowest six bits are the flags. The x87 unit is
 * left alone, because nothing is computed there. */
#define FLOAT_DEFAULT 0x1f80u
#define FLOAT_FLAGS   0x3fu

static inline float_environment float_environment_get(void) {
    return (float_environment){__builtin_ia32_stmxcsr()};
}

static inline void float_environment_set(float_environment e) {
    __builtin_ia32_ldmxcsr((unsigned)e.bits);
}

#elif defined(__aarch64__)

/* FPCR in the lower half, where 0 is what we want, and FPSR, the flags, in the upper half. */
#define FLOAT_DEFAULT ((uint64_t)0)
#define FLOAT_FLAGS   ((uint64_t)0xffffffff << 32)

static inline float_environment float_environment_get(void) {
    uint64_t control, flags;
    __asm__ volatile("mrs %0, fpcr\n\tmrs %1, fpsr" : "=r"(control), "=r"(flags)::"memory");
    return (float_environment){flags << 32 | (uint32_t)control};
}

static inline void float_environment_set(float_environment e) {
    uint64_t control = (uint32_t)e.bits, flags = e.bits >> 32;
    __asm__ volatile("msr fpcr, %0\n\tmsr fpsr, %1" ::"r"(control), "r"(flags) : "memory");
}

#else

#define FLOAT_DEFAULT ((uint64_t)FE_TONEAREST)
#define FLOAT_FLAGS   ((uint64_t)0)

static inline float_environment float_environment_get(void) {
    return (float_environment){(uint64_t)fegetround()};
}

static inline void float_environment_set(float_environment e) {
    fesetround((int)e.bits);
}

#endif

/* Sets the library's environment and returns the one that was there. A register is written only if it must be. */
static inline float_environment float_environment_begin(void) {
    float_environment before = float_environment_get();
    if ((before.bits & ~FLOAT_FLAGS) != FLOAT_DEFAULT)
        float_environment_set((float_environment){FLOAT_DEFAULT});
    return before;
}
