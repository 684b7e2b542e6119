/* Status, allocator, threads, instruction sets. Part of cscd/cscd.h, which says what holds for every
 * function. */
#ifndef CSCD_CONTEXT_API_H
#define CSCD_CONTEXT_API_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifndef CSCD_API
#if defined(__GNUC__)
#define CSCD_API __attribute__((visibility("default")))
#else
#define CSCD_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum cscd_status {
    CSCD_OK = 0,
    CSCD_OUT_OF_MEMORY,    /* an allocation failed; every object is still valid, the call may be repeated */
    CSCD_INVALID_ARGUMENT, /* NULL, out of range, not finite, or options not made by _defaults() */
    CSCD_INVALID_MESH, /* empty, too large, an index past vertex_count, a triangle that repeats a vertex */
    CSCD_SYSTEM_ERROR, /* the system refused a thread */
    CSCD_CANCELLED,    /* cscd_progress said so; every object is still valid, the call may be repeated */
    CSCD_IN_CONTACT    /* no step is free of contact, for the start is not: cscd_detector_max_step */
} cscd_status;

/* One short English phrase, static storage, never NULL. */
CSCD_API const char *cscd_status_string(cscd_status status);

/* ---- context: allocator, threads, progress ---------------------------------------------------------- */

typedef struct cscd_context cscd_context;

/* Set both functions or neither. allocate returns NULL on failure; alignment is a power of two;
 * release gets the size that was asked for. Calls are serialised by the context. */
typedef struct cscd_allocator {
    void *(*allocate)(void *user, size_t size, size_t alignment);
    void (*release)(void *user, void *block, size_t size);
    void *user;
} cscd_allocator;

/* Vector instructions. Results are the same on every level, bit for bit. */
typedef enum cscd_simd {
    CSCD_SIMD_AUTO,   /* the best that the processor has */
    CSCD_SIMD_SCALAR, /* what the compiler takes for granted */
    CSCD_SIMD_AVX2,
    CSCD_SIMD_AVX512 /* F, VL, DQ and BW */
} cscd_simd;

/* "auto", "scalar", "avx2", "avx512"; static storage, never NULL. from_name leaves *out untouched when it
 * returns false. */
CSCD_API const char *cscd_simd_name(cscd_simd simd);
CSCD_API bool cscd_simd_from_name(const char *name, cscd_simd *out);

/* The host's own parallel loop, so that cscd starts no threads beside the host's: calls task(data, index) for
 * every index below task_count, each once, in any order, on any threads, and returns when all have returned.
 * Tasks never wait for each other, so one after the other will do. A thread that waits in run must not be
 * lent to another call into cscd with objects of the same context. */
typedef struct cscd_parallel_for {
    void (*run)(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index), void *data);
    void *user;
} cscd_parallel_for;

/* Called now and then, at most every few milliseconds, by functions that take long (cscd_plan_create,
 * of the detector _step, _check, _near and _max_step, of a line _begin, _near and _max_step), on the thread
 * that called them; a call that is sooner done is not heard of. stage is a word or two of static storage;
 * fraction, in [0,1], an estimate of how much of the call is done, which never falls during it. False cancels
 * the call, which then fails with CSCD_CANCELLED. It must not call cscd with objects of the same context. */
typedef struct cscd_progress {
    bool (*report)(void *user, const char *stage, double fraction);
    void *user;
} cscd_progress;

typedef struct cscd_context_options {
    uint32_t struct_size;           /* set by cscd_context_defaults */
    uint32_t thread_count;          /* 0 = one per processor; default 1; at most 256. With parallel_for: into
                                     * how many tasks long work is cut, so set it, too; no thread is started */
    cscd_simd simd;                 /* default AUTO; INVALID_ARGUMENT where the processor has it not */
    cscd_allocator allocator;       /* default: aligned_alloc and free */
    cscd_parallel_for parallel_for; /* default NULL: threads of the context's own */
    cscd_progress progress;         /* default NULL: none, and nothing can be cancelled */
} cscd_context_options;

CSCD_API cscd_context_options cscd_context_defaults(void);

/* Fails without a sentence, there being no context: INVALID_ARGUMENT, OUT_OF_MEMORY or SYSTEM_ERROR. */
CSCD_API cscd_status cscd_context_create(const cscd_context_options *options, cscd_context **out);

/* After all that was created from it. */
CSCD_API void cscd_context_destroy(cscd_context *context);

/* The sentence behind the last failure in this context, "" if none. Valid until the next call. */
CSCD_API const char *cscd_context_detail(const cscd_context *context);

CSCD_API uint32_t cscd_context_thread_count(const cscd_context *context);

/* The level in use, never AUTO. */
CSCD_API cscd_simd cscd_context_simd(const cscd_context *context);

/* Bytes now held through this context's allocator. */
CSCD_API size_t cscd_context_bytes(const cscd_context *context);

#ifdef __cplusplus
}
#endif

#endif
