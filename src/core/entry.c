/* Entering and leaving the library: see entry.h. */
#include "src/core/entry.h"

#include "src/core/context.h"
#include "src/core/system.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

/* Flags of a mark, below the address of the first object that is to be freed. */
#define MARK_INSIDE ((uintptr_t)1)
#define MARK_BROKEN ((uintptr_t)2)
#define MARK_FLAGS  (MARK_INSIDE | MARK_BROKEN)

static const char *const sentences[] = {
    [HOST_ALLOCATOR] =
        "the allocator did not return to the library: it has thrown an exception or called longjmp, and "
        "the context cannot be used any more; destroy it",
    [HOST_PARALLEL_FOR] =
        "parallel_for did not return to the library: it has thrown an exception or called longjmp, "
        "and the context cannot be used any more; destroy it",
    [HOST_PROGRESS] =
        "the progress function did not return to the library: it has thrown an exception or called "
        "longjmp, and the context cannot be used any more; destroy it",
    [HOST_IGNORE] =
        "the function ignore did not return to the library: it has thrown an exception or called longjmp, "
        "and the context cannot be used any more; destroy it",
};

static uintptr_t this_thread(void) {
    return (uintptr_t)pthread_self();
}

/* ---- entering and leaving ------------------------------------------------------------------------------ */

/* Is an address on the stack that the system has given this thread, and not on one of a fiber? */
static bool on_thread_stack(uintptr_t address) {
    uintptr_t lowest = 0;
    size_t size = 0;
    return system_thread_stack(&lowest, &size) && address - lowest < size;
}

/* Has a callback of the call inside been left by longjmp? A frame that is alive lies above all that came after it; so a
 * callback's frame that does not lie above ours is gone. Stacks grow downwards wherever this library runs. */
static bool was_left(const entry_state *state, uintptr_t frame) {
    if (atomic_load_explicit(&state->thread, memory_order_relaxed) != this_thread()) return false;
    uintptr_t host_frame = atomic_load_explicit(&state->host_frame, memory_order_relaxed);
    return host_frame != 0 && frame >= host_frame && on_thread_stack(host_frame) && on_thread_stack(frame);
}

static cscd_status refuse_call(entry_state *state, uintptr_t mark, uintptr_t frame) {
    if ((mark & MARK_BROKEN) == 0) {
        if (!was_left(state, frame)) return CSCD_BUSY;
        entry_break(state, state->callback);
    }
    return CSCD_BROKEN;
}

/* On success the context is this thread's. */
static bool claim_context(cscd_context *context, context_entry *entry, uintptr_t frame) {
    entry_state *state = &context->entry;
    uintptr_t mark = 0;
    *entry = (context_entry){context, CSCD_OK};
    if (!atomic_compare_exchange_strong_explicit(&state->mark, &mark, MARK_INSIDE, memory_order_acquire,
                                                 memory_order_acquire)) {
        entry->status = refuse_call(state, mark, frame);
        return false;
    }
    atomic_store_explicit(&state->host_frame, 0, memory_order_relaxed);
    atomic_store_explicit(&state->thread, this_thread(), memory_order_relaxed);
    atomic_store_explicit(&state->half_made, NULL, memory_order_relaxed);
    return true;
}

#ifdef NDEBUG
static void check_objects(cscd_context *context) {
    (void)context;
}
#else
static void check_objects(cscd_context *context) {
    const char *fault = live_objects_fault(&context->live);
    if (fault == NULL) return;
    fprintf(stderr, "cscd: a structure was broken before this call: %s\n", fault);
    abort();
}
#endif

bool context_enter_at(cscd_context *context, context_entry *entry, uintptr_t frame) {
    if (!claim_context(context, entry, frame)) return false;
    context->entry.host = float_environment_begin();
    check_objects(context);
    context->detail[0] = '\0'; /* of an earlier call */
    progress_begin_call(&context->progress);
    parallel_begin_call(context->threads);
    return true;
}

/* True: nobody is inside any more. False: there are objects to be freed, or the context is broken. */
static bool take_mark_away(entry_state *state) {
    uintptr_t mark = MARK_INSIDE;
    return atomic_compare_exchange_strong_explicit(&state->mark, &mark, 0, memory_order_release,
                                                   memory_order_relaxed);
}

/* The mark of a freed object outlives it for a while, in debug builds long enough for most mistakes. */
static void free_object(reference_count *object) {
    object->alive = 0;
    object->free(object);
}

static void free_listed(entry_state *state) {
    uintptr_t mark = atomic_load(&state->mark);
    while (!atomic_compare_exchange_weak(&state->mark, &mark, mark & MARK_FLAGS)) {
    }
    reference_count *object = (reference_count *)(mark & ~MARK_FLAGS);
    while (object != NULL) {
        reference_count *next = object->next;
        free_object(object);
        object = next;
    }
}

/* The last object may take the context with it. */
static cscd_status leave_claim(cscd_context *context, cscd_status status) {
    entry_state *state = &context->entry;
    if (take_mark_away(state)) return status;
    if (entry_broken(state)) return CSCD_BROKEN;
    context_hold(context);
    do {
        free_listed(state);
    } while (!take_mark_away(state) && !entry_broken(state));
    context_release(context);
    return status;
}

cscd_status context_leave(context_entry *entry, cscd_status status) {
    cscd_context *context = entry->context;
    if (status == CSCD_OK || status == CSCD_IN_CONTACT) {
        cscd_status loop = context_loop_status(context);
        if (loop != CSCD_OK) status = loop;
    }
    float_environment_set(context->entry.host);
    return leave_claim(context, status);
}

/* ---- freeing objects ----------------------------------------------------------------------------------- */

/* False: nobody is inside any more, or the context is broken. */
static bool leave_to_call_inside(entry_state *state, reference_count *object) {
    uintptr_t mark = atomic_load(&state->mark);
    do {
        if ((mark & MARK_FLAGS) != MARK_INSIDE) return false;
        object->next = (reference_count *)(mark & ~MARK_FLAGS);
    } while (!atomic_compare_exchange_weak(&state->mark, &mark, (uintptr_t)object | MARK_INSIDE));
    return true;
}

/* Also frees what the call that was left would have freed at its end. */
static void free_in_broken(cscd_context *context, reference_count *object) {
    entry_state *state = &context->entry;
    context_hold(context);
    reference_count *half_made = atomic_exchange(&state->half_made, NULL);
    if (half_made != NULL && reference_drop(half_made)) free_object(half_made);
    free_listed(state);
    free_object(object);
    context_release(context);
}

static void free_claimed(cscd_context *context, reference_count *object) {
    context_hold(context);
    context->entry.host = float_environment_get();
    free_object(object);
    leave_claim(context, CSCD_OK);
    context_release(context);
}

void context_free_object(cscd_context *context, reference_count *object) {
    context_entry entry;
    reference_count *half_made = object;
    /* In a child that fork made a call that was inside never ends, and another thread may have held the lock of the list. */
    if (parallel_is_of_parent(context->threads) && !entry_broken(&context->entry) &&
        atomic_load(&context->entry.mark) != 0)
        return;
    atomic_compare_exchange_strong(&context->entry.half_made, &half_made, NULL);
    live_objects_remove(&context->live, object);
    for (;;) {
        if (claim_context(context, &entry, FRAME_END())) {
            free_claimed(context, object);
            return;
        }
        if (entry.status == CSCD_BROKEN) {
            free_in_broken(context, object);
            return;
        }
        if (leave_to_call_inside(&context->entry, object)) return;
    }
}

/* ---- broken contexts ----------------------------------------------------------------------------------- */

bool entry_broken(const entry_state *state) {
    return (atomic_load_explicit(&state->mark, memory_order_acquire) & MARK_BROKEN) != 0;
}

void entry_break(entry_state *state, host_callback callback) {
    if (atomic_exchange(&state->breaking, true)) return;
    state->broken_by = sentences[callback];
    atomic_fetch_or(&state->mark, MARK_BROKEN);
}

/* ---- calling the host ---------------------------------------------------------------------------------- */

/* The threads of the context stand still while its caller is in the host's code: what they work on is on the caller's
 * stack, and may be gone if the host's code does not return. */
host_call host_call_begin(entry_state *state, host_callback callback, uintptr_t frame) {
    host_call call = {.state = NULL, .callback = callback};
    if (state == NULL || atomic_load_explicit(&state->mark, memory_order_relaxed) != MARK_INSIDE) return call;
    call.state = state;
    call.own = atomic_load_explicit(&state->thread, memory_order_relaxed) == this_thread();
    call.first = call.own && atomic_load_explicit(&state->host_frame, memory_order_relaxed) == 0;
    if (call.own) {
        call.outer = state->callback;
        state->callback = callback;
    }
    if (call.first) {
        parallel_pause(state->threads);
        atomic_store_explicit(&state->host_frame, frame, memory_order_relaxed);
    }
    call.inside = float_environment_get();
    float_environment_set(state->host);
    return call;
}

void host_call_end(host_call *call) {
    entry_state *state = call->state;
    if (state == NULL) return;
    call->state = NULL;
    if (call->first) state->host = float_environment_get();
    float_environment_set(call->inside);
    if (call->own) state->callback = call->outer;
    if (!call->first) return;
    atomic_store_explicit(&state->host_frame, 0, memory_order_relaxed);
    parallel_resume(state->threads);
}

void host_call_left(host_call *call) {
    if (call->state != NULL) entry_break(call->state, call->callback);
}
