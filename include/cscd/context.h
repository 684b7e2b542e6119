/* The context: what everything is created from. It holds the allocator, the threads, the instruction set
 * and the sentence behind the last failure. Part of cscd/cscd.h, which says what holds for every function. */
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

/* How a call ended. Later versions may add values; cscd_status_string knows those of the library. */
typedef enum cscd_status {
    CSCD_OK = 0,
    CSCD_OUT_OF_MEMORY,    /* an allocation failed */
    CSCD_INVALID_ARGUMENT, /* NULL, out of range, not finite, or options that no _defaults() function made */
    CSCD_INVALID_MESH,     /* no triangle, too many, an index beyond vertex_count, a triangle with a vertex
                            * twice */
    CSCD_SYSTEM_ERROR, /* the system refused a thread, or there is no libcscd-baselines.so: CSCD_CHARGE_DENSE */
    CSCD_CANCELLED,    /* the callback in cscd_progress returned false, or cscd_context_cancel was called */
    CSCD_IN_CONTACT,   /* no step is free of contact, because the start is not: cscd_detector_max_step */
    CSCD_BUSY,         /* another call with this context is running: see the rules of callbacks */
    CSCD_NULL_OBJECT,   /* an object that the call needs is NULL. There may be no context then that could
                            * hold a sentence, so cscd_context_detail is what it was before */
    CSCD_LIST_TOO_LONG, /* there is more to list than longest_list allows (cscd_detector_options), or max_memory
                         * (cscd_intersection_options) */
    CSCD_STATUS_MAX_ENUM = 0x7fffffff
} cscd_status;

/* A short English phrase for a status, "unknown status" for any other value; static storage, never NULL. */
CSCD_API const char *cscd_status_string(cscd_status status);

/* The bytes that max_memory stands for where options have 0: a quarter of the memory that is free now, at least 1. */
CSCD_API size_t cscd_max_memory_default(void);

/* ---- context: allocator, threads, progress ---------------------------------------------------------- */

/* Allocator, threads, instruction set and the last failure's sentence. */
typedef struct cscd_context cscd_context;

/* What holds for callbacks: the allocator, parallel_for and its tasks, progress and ignore.
 *   calls     A call that creates, changes or uses an object of a context in which a call is running fails with
 *             CSCD_BUSY and changes nothing, whether it comes from a callback or from another thread. Functions of
 *             a mesh that return no status may be called at any time, from any thread
 *   destroy   A _destroy function may be called at any time; objects of a context in which a call is running live
 *             until that call ends
 *   floats    The library computes with rounding to nearest, without flushing to zero and without traps, whatever
 *             the caller's floating-point environment is. Every call gives the caller's back, flags included, and
 *             callbacks run in it; so do allocator calls on threads of the library. Tasks of parallel_for give the
 *             environment of the thread that runs them back
 *   failing   A callback must return: it throws no C++ exception, and does not call longjmp. One that cannot go on
 *             calls cscd_context_cancel() and returns: the call that it was called from then fails, and may be
 *             repeated. cscd/cscd.hpp and bindings do so when a callback throws
 *   forking   After fork(), the child has a copy of every object, and its calls run on the thread that makes them,
 *             with the same results: threads of the library stay in the parent. A context in which a call was
 *             running at that moment stays busy in the child, where destroying its objects does nothing. A child
 *             that a callback has forked must not return from it, and no thread may be making a plan with
 *             CSCD_CHARGE_DENSE at that moment. A host's own parallel_for is the host's affair */

/* The host's allocator. Set both functions, or neither for aligned_alloc and free. allocate returns NULL
 * when it fails; alignment is a power of two. release is given the size that was asked for. They are never
 * called from two threads at once, but from any thread: the context's own, and the one that destroys the last
 * object that keeps something of the context. That may be an object of another context, made from a mesh of
 * this one: the memory of a mesh is that of the context in which it was created. */
typedef struct cscd_allocator {
    void *(*allocate)(void *user, size_t size, size_t alignment);
    void (*release)(void *user, void *block, size_t size);
    void *user;
} cscd_allocator;

/* Which vector instructions are used. Results are the same on every level, bit for bit. Later versions may
 * add values. */
typedef enum cscd_simd {
    CSCD_SIMD_AUTO,   /* the best that the processor has */
    CSCD_SIMD_SCALAR, /* what every processor of the architecture has */
    CSCD_SIMD_AVX2,
    CSCD_SIMD_AVX512, /* AVX-512 F, VL, DQ and BW */
    CSCD_SIMD_NEON,   /* what every processor of aarch64 has */
    CSCD_SIMD_MAX_ENUM = 0x7fffffff
} cscd_simd;

/* The names are "auto", "scalar", "avx2", "avx512" and "neon"; static storage, never NULL. cscd_simd_from_name
 * returns false for any other text and then leaves *out untouched. */
CSCD_API const char *cscd_simd_name(cscd_simd simd);
CSCD_API bool cscd_simd_from_name(const char *name, cscd_simd *out);

/* The host's own parallel loop, for hosts that have a thread pool: cscd then starts no threads. run calls
 * task(data, index) once for every index below task_count, in any order, on any threads, and returns when
 * all of these calls have returned. Tasks never wait for each other, so calling them one after the other
 * is correct. A call whose tasks were left out, repeated, or still running when run returned fails with
 * INVALID_ARGUMENT and their numbers; it may be repeated. While a thread waits in run, the pool may give it
 * work that calls cscd with objects of other contexts. Tasks throw nothing. */
typedef struct cscd_parallel_for {
    void (*run)(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index), void *data);
    void *user;
} cscd_parallel_for;

/* A callback that shows how far a long call is, and may cancel it. cscd_plan_create, cscd_line_search_begin,
 * and the calls that find something for a detector or a line search call it every few milliseconds, on
 * the thread that called them; calls that end sooner do not call it at all. stage: a word or two, static
 * storage. fraction: an estimate in [0,1] of how much of the call is done, which never falls during a
 * call. When report returns false, the call ends with CSCD_CANCELLED. */
typedef struct cscd_progress {
    bool (*report)(void *user, const char *stage, double fraction);
    void *user;
} cscd_progress;

/* Options of a context; start from cscd_context_defaults. */
typedef struct cscd_context_options {
    uint32_t struct_size;           /* set by cscd_context_defaults */
    uint32_t thread_count;          /* 1 by default, 256 at most; 0: one per processor. With parallel_for
                                     * no thread is started, and this says into how many tasks long work is
                                     * cut */
    cscd_simd simd;                 /* AUTO by default; a level that the processor lacks is
                                     * INVALID_ARGUMENT */
    cscd_allocator allocator;       /* aligned_alloc and free by default */
    cscd_parallel_for parallel_for; /* none by default: the context has its own threads */
    cscd_progress progress;         /* none by default: nothing is shown, and nothing can be cancelled */
    char *reason;                   /* where the sentence of a failed cscd_context_create is written, because
                                     * there is no context then that could hold it; NULL by default */
    size_t reason_size; /* bytes that fit there, the 0 at the end included; a longer sentence is cut */
} cscd_context_options;

/* The default options. */
CSCD_API void cscd_context_defaults_sized(cscd_context_options *out, size_t size);
static inline cscd_context_options cscd_context_defaults(void) {
    cscd_context_options options;
    cscd_context_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates a context; options may be NULL. SYSTEM_ERROR: the system refused a thread. The sentence of a
 * failure is written where the options say. */
CSCD_API cscd_status cscd_context_create(const cscd_context_options *options, cscd_context **out);

/* Gives the context back. Objects that were created from it go on working, with its allocator and its
 * threads, until the last of them is destroyed; it frees the memory and ends the threads. The sentences of
 * their failures can no longer be read. */
CSCD_API void cscd_context_destroy(cscd_context *context);

/* Why the last call with an object of the context failed, "" if it succeeded. The sentence lives until the
 * next such call. */
CSCD_API const char *cscd_context_detail(const cscd_context *context);

/* Ends the call that is running in the context with CSCD_CANCELLED, as soon as it can and with nothing written,
 * unless it is done already or is none that says CANCELLED of itself; without a call it does nothing. Any
 * callback may call this, and any thread, which may come too late, though, and then meet the call that comes
 * next. NULL is allowed. An example, a function `ignore` that asks a host in another language:
 *
 *     static bool ignore(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
 *         binding *host = user;
 *         if (!host->failed && !ask_host(host, kind, a, b)) { // it has thrown, and we have caught
 *             host->failed = true;                           // to be thrown again after the call
 *             cscd_context_cancel(host->context);
 *         }
 *         return !host->failed && host->answer;
 *     }
 */
CSCD_API void cscd_context_cancel(cscd_context *context);

/* The number of threads, or with parallel_for of tasks, that long work is shared by. */
CSCD_API uint32_t cscd_context_thread_count(const cscd_context *context);

/* The instruction set in use, never AUTO. */
CSCD_API cscd_simd cscd_context_simd(const cscd_context *context);

/* How many bytes the context and its objects hold at present through the allocator. */
CSCD_API size_t cscd_context_bytes(const cscd_context *context);

#ifdef __cplusplus
}
#endif

#endif
