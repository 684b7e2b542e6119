/* Entering and leaving the library: one call at a time in a context, the library's floating-point environment inside and
 * the host's in its callbacks, and a mark on contexts that a callback has left without returning.
 *
 *     cscd_status cscd_thing_change(cscd_thing *thing) {
 *         context_entry entry;
 *         if (!object_enter(thing, &entry)) return entry.status;
 *         return context_leave(&entry, change_thing(thing));
 *     }
 *
 * What is left without returning: a callback may throw a C++ exception, or call longjmp, through the library. Then the
 * call inside never ends, and what it was changing stays as it was at that moment. An exception runs the cleanup of
 * host_call, which marks the context as broken. A longjmp runs nothing; it is noticed when the same thread calls again:
 * if the new call lies higher on the thread's stack than the callback did, then the callback's frame is gone. Where this
 * cannot be told - another thread, another stack, a call that lies deeper - the context counts as busy. */
#pragma once

#include "cscd/cscd.h"
#include "src/core/float_environment.h"
#include "src/core/references.h"

#include <stdatomic.h>
#include <stdbool.h>

struct parallel;

/* What the host has given us to call. */
typedef enum host_callback { HOST_ALLOCATOR, HOST_PARALLEL_FOR, HOST_PROGRESS, HOST_IGNORE } host_callback;

/* Of a context: the call that is inside. */
typedef struct entry_state {
    atomic_uintptr_t mark;       /* 0: nobody is inside. Else flags, and a list of objects: see entry.c */
    atomic_uintptr_t thread;     /* who has made the call */
    atomic_uintptr_t host_frame; /* where on its stack it has called the host; 0: it has not */
    float_environment host;      /* that thread's, outside */
    host_callback callback;      /* that it is in, if it is in one */
    atomic_bool breaking;
    const char *broken_by;                /* a sentence; once the mark says that the context is broken */
    _Atomic(reference_count *) half_made; /* the object that the call creates; NULL: none */
    struct parallel *threads;             /* who stand still while the host's code runs; NULL: none yet */
} entry_state;

typedef struct context_entry {
    cscd_context *context;
    cscd_status status; /* why the call may not enter */
} context_entry;

/* The upper end of this function's frame, which is where its frame address lies but for gcc on some processors, as aarch64: there it
 * is the lower end, and a second call whose frame is larger would look deeper than what the first has called. */
#if defined(__GNUC__) && !defined(__clang__)
#define FRAME_END() ((uintptr_t)__builtin_dwarf_cfa())
#else
#define FRAME_END() ((uintptr_t)__builtin_frame_address(0))
#endif

/* Begins a call. False: it must return entry->status, and has changed nothing: CSCD_BUSY if another call is inside,
 * CSCD_BROKEN if a callback has left one. */
#define context_enter(context, entry) context_enter_at(context, entry, FRAME_END())
bool context_enter_at(cscd_context *context, context_entry *entry, uintptr_t frame);

/* The same for a call with an object of the context, of which debug builds notice that it was freed. */
#define object_enter(object, entry)                                                                          \
    (assert((object)->references.alive == REFERENCE_ALIVE && "an object is used after it was freed"),        \
     context_enter((object)->context, entry))

/* Ends a call, and returns how it ended. */
cscd_status context_leave(context_entry *entry, cscd_status status);

/* Frees an object of the context that nobody holds as soon as nobody is inside: now, or when the present call leaves. Any
 * thread may call this. In a broken context the object is told at once, and only lets go of what it holds: memory goes
 * with the context. */
void context_free_object(cscd_context *context, reference_count *object);

bool entry_broken(const entry_state *state);

/* ---- calling the host ---------------------------------------------------------------------------------- */

/* While this exists, the host's code runs, in its own floating-point environment:
 *
 *     HOST_CALL(call, state, HOST_PROGRESS);
 *     bool go_on = report(...);
 *     host_call_end(&call);
 */
typedef struct host_call {
    entry_state *state; /* NULL: it has returned, or no call is inside */
    host_callback callback, outer;
    bool own, first; /* on the thread of the call inside; and not within another callback */
    float_environment inside;
} host_call;

/* Cleanups need the routine with which a C++ runtime unwinds C. Whoever throws has that runtime, and whoever does not
 * shall not need its library: so both references are weak, and without it nothing is unwound. (Windows unwinds by itself.) */
#ifdef __ELF__
__asm__(".weak __gcc_personality_v0\n\t.weak _Unwind_Resume");
#endif

#define HOST_CALL(name, state, callback)                                                                     \
    __attribute__((cleanup(host_call_left))) host_call name =                                                \
        host_call_begin(state, callback, (uintptr_t)__builtin_frame_address(0))

/* state: NULL, or no call is inside: nothing is done. */
host_call host_call_begin(entry_state *state, host_callback callback, uintptr_t frame);
void host_call_end(host_call *call);
void host_call_left(host_call *call); /* without host_call_end, by an exception */

/* The context is left in the midst of a call, by this callback. */
void entry_break(entry_state *state, host_callback callback);
