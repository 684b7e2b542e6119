/* Entering and leaving the library: one call at a time in a context, the library's floating-point environment inside and
 * the host's in its callbacks; and the life of the objects that calls make.
 *
 *     cscd_status cscd_thing_change(cscd_thing *thing) {
 *         context_entry entry;
 *         if (!object_enter(thing, &entry)) return entry.status;
 *         return context_leave(&entry, change_thing(thing));
 *     }
 */
#pragma once

#include "cscd/cscd.h"

#include <assert.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#if !defined(__SSE2__) && !defined(__aarch64__)
#include <fenv.h>
#endif

/* ---- the floating-point environment -------------------------------------------------------------------- */

/* The floating-point environment of a thread: how it rounds, whether it flushes small numbers to zero, which exceptions
 * trap, and which have occurred.
 *
 * Every bound in the library is derived for rounding to nearest with subnormal numbers, and exact arithmetic relies on
 * it. So every entry sets that environment and puts the host's back when it leaves, and while the host's own code runs
 * in a callback. The flags of the host come back as they were: what the library's arithmetic raises is no news to it. */
typedef struct float_environment {
    uint64_t bits; /* in the form of the processor; elsewhere in that of C */
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

/* The rounding mode, and the flags in the upper half. */
#define FLOAT_DEFAULT ((uint64_t)FE_TONEAREST)
#define FLOAT_FLAGS   ((uint64_t)0xffffffff << 32)

static inline float_environment float_environment_get(void) {
    return (float_environment){(uint64_t)(uint32_t)fetestexcept(FE_ALL_EXCEPT) << 32 |
                               (uint32_t)fegetround()};
}

static inline void float_environment_set(float_environment e) {
    fesetround((int)(uint32_t)e.bits);
    feclearexcept(FE_ALL_EXCEPT);
    if (e.bits >> 32 != 0) feraiseexcept((int)(e.bits >> 32));
}

#endif

/* Sets the library's environment and returns the one that was there. A register is written only if it must be. */
static inline float_environment float_environment_begin(void) {
    float_environment before = float_environment_get();
    if ((before.bits & ~FLOAT_FLAGS) != FLOAT_DEFAULT)
        float_environment_set((float_environment){FLOAT_DEFAULT});
    return before;
}

/* ---- references ---------------------------------------------------------------------------------------- */

/* An object counts its holders: the caller who made it, and every object that was made from it. The last
 * holder to let go frees it, on whatever thread that happens. */
#define REFERENCE_ALIVE 0x600DC0DEu

/* The first member of an object. */
typedef struct reference_count {
    atomic_uint holders;
    atomic_bool destroyed;        /* the caller has let go, which it may do once */
    struct reference_count *next; /* in a list of objects that are to be freed */
    void (*free)(struct reference_count *object);
    const char *(*validate)(
        const struct reference_count *object); /* see live_objects_add; NULL: not listed */
    struct reference_count *older, *younger;   /* in the list of live objects */
    uint32_t alive; /* REFERENCE_ALIVE until it is freed, so that debug builds notice its use afterwards */
} reference_count;

/* The caller is the first holder. */
static inline void reference_begin(reference_count *r, void (*free)(reference_count *object)) {
    *r = (reference_count){.free = free, .alive = REFERENCE_ALIVE};
    atomic_init(&r->holders, 1);
    atomic_init(&r->destroyed, false);
}

/* Whoever adds a holder is one, or was given the object by one: the count is not 0. */
static inline void reference_add(reference_count *r) {
    unsigned before = atomic_fetch_add_explicit(&r->holders, 1, memory_order_relaxed);
    assert(before > 0 && r->alive == REFERENCE_ALIVE);
    (void)before;
}

/* An object that was made from this one lets go of it. True: it was the last holder, sees everything that the others
 * have written, and frees the object. */
static inline bool reference_drop(reference_count *r) {
    assert(r->alive == REFERENCE_ALIVE && "an object is used after it was freed");
    unsigned before = atomic_fetch_sub_explicit(&r->holders, 1, memory_order_acq_rel);
    assert(before > 0);
    return before == 1;
}

/* The caller lets go: the first thing that a _destroy function does. An object that is still held remembers it, so
 * that debug builds notice a second _destroy. */
static inline bool reference_destroy(reference_count *r) {
    bool again = atomic_exchange_explicit(&r->destroyed, true, memory_order_relaxed);
    assert(!again && "an object was destroyed twice");
    (void)again;
    return reference_drop(r);
}

/* ---- live objects -------------------------------------------------------------------------------------- */

/* Debug builds check all whole objects of a context whenever a call enters it, so that a stray write, or a fault of ours, is
 * found by the next call, and not by a wrong result much later. Threads that drop the last reference of a shared mesh take it from the list while another one is in a call. */
typedef struct live_objects {
    pthread_mutex_t mutex;
    reference_count *first;
} live_objects;

/* False: the system refused a mutex. */
bool live_objects_begin(live_objects *list);
void live_objects_end(live_objects *list);

/* Adds an object, once all of its parts are made. validate returns the first fault of an object as a sentence, or NULL;
 * it reads only what no other thread writes while the context is entered. */
void live_objects_add(live_objects *list, reference_count *object,
                      const char *(*validate)(const reference_count *object));

/* Takes an object from the list before it is freed; does nothing if it is not in it. */
void live_objects_remove(live_objects *list, reference_count *object);

/* The first fault of an object in the list, or NULL. */
const char *live_objects_fault(live_objects *list);

/* ---- calls --------------------------------------------------------------------------------------------- */

/* The call that is inside a context. */
typedef struct entry_state {
    atomic_uintptr_t mark;   /* 0: nobody is inside. Else a flag, and a list of objects: see entry.c */
    atomic_uintptr_t thread; /* who has made the call */
    bool in_callback;        /* that thread is in code of the host; no other thread reads this */
    /* That thread's, outside. Its callbacks may change it while other threads read it. */
    _Atomic(float_environment) host;
} entry_state;

typedef struct context_entry {
    cscd_context *context;
    cscd_status status; /* why the call may not enter */
} context_entry;

/* Begins a call. False: another call is inside, so this one must return entry->status, CSCD_BUSY, and has changed nothing. */
bool context_enter(cscd_context *context, context_entry *entry);

/* The same for a call with an object of the context, of which debug builds notice that it was freed. */
#define object_enter(object, entry)                                                                          \
    (assert((object)->references.alive == REFERENCE_ALIVE && "an object is used after it was freed"),        \
     context_enter((object)->context, entry))

/* Ends a call, and returns how it ended. */
cscd_status context_leave(context_entry *entry, cscd_status status);

/* Frees an object of the context that nobody holds as soon as nobody is inside: now, or when the present call leaves. Any
 * thread may call this. */
void context_free_object(cscd_context *context, reference_count *object);

/* ---- calling the host ---------------------------------------------------------------------------------- */

/* While this exists, the host's code runs, in its own floating-point environment:
 *
 *     host_call call = host_call_begin(state);
 *     bool go_on = report(...);
 *     host_call_end(&call);
 */
typedef struct host_call {
    entry_state *state; /* NULL: no call is inside */
    bool first;         /* on the thread of the call inside, and not within another callback */
    float_environment inside;
} host_call;

/* state: NULL, or no call is inside: nothing is done. */
host_call host_call_begin(entry_state *state);
void host_call_end(const host_call *call);
