/* Entering and leaving the library: one call at a time in a context, the library's floating-point environment inside and
 * the host's in its callbacks.
 *
 *     cscd_status cscd_thing_change(cscd_thing *thing) {
 *         context_entry entry;
 *         if (!object_enter(thing, &entry)) return entry.status;
 *         return context_leave(&entry, change_thing(thing));
 *     }
 */
#pragma once

#include "cscd/cscd.h"
#include "src/core/float_environment.h"
#include "src/core/references.h"

#include <stdatomic.h>
#include <stdbool.h>

/* Of a context: the call that is inside. */
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
