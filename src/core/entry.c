/* Entering and leaving the library, and the life of the objects that calls make. */
#include "src/core/entry.h"

#include "src/core/context.h"

#include <pthread.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- live objects -------------------------------------------------------------------------------------- */

bool live_objects_begin(live_objects *list) {
    list->first = NULL;
    return pthread_mutex_init(&list->mutex, NULL) == 0;
}

void live_objects_end(live_objects *list) {
    pthread_mutex_destroy(&list->mutex);
}

void live_objects_add(live_objects *list, reference_count *object,
                      const char *(*validate)(const reference_count *object)) {
    pthread_mutex_lock(&list->mutex);
    object->validate = validate;
    object->older = list->first;
    object->younger = NULL;
    if (list->first != NULL) list->first->younger = object;
    list->first = object;
    pthread_mutex_unlock(&list->mutex);
}

void live_objects_remove(live_objects *list, reference_count *object) {
    pthread_mutex_lock(&list->mutex);
    if (object->validate != NULL) {
        if (object->older != NULL) object->older->younger = object->younger;
        if (object->younger != NULL) object->younger->older = object->older;
        if (list->first == object) list->first = object->older;
        object->validate = NULL;
    }
    pthread_mutex_unlock(&list->mutex);
}

const char *live_objects_fault(live_objects *list) {
    const char *fault = NULL;
    pthread_mutex_lock(&list->mutex);
    for (reference_count *o = list->first; fault == NULL && o != NULL; o = o->older)
        fault = o->alive == REFERENCE_ALIVE ? o->validate(o) : "an object was freed that is still in use";
    pthread_mutex_unlock(&list->mutex);
    return fault;
}

/* The flag of a mark, below the address of the first object that is to be freed. */
#define MARK_INSIDE ((uintptr_t)1)

static uintptr_t this_thread(void) {
    return (uintptr_t)pthread_self();
}

/* ---- entering and leaving ------------------------------------------------------------------------------ */

/* On success the context is this thread's. */
static bool claim_context(cscd_context *context) {
    entry_state *state = &context->entry;
    uintptr_t mark = 0;
    if (!atomic_compare_exchange_strong_explicit(&state->mark, &mark, MARK_INSIDE, memory_order_acquire,
                                                 memory_order_relaxed))
        return false;
    atomic_store_explicit(&state->thread, this_thread(), memory_order_relaxed);
    state->in_callback = false;
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

static float_environment host_environment(const entry_state *state) {
    return atomic_load_explicit(&state->host, memory_order_relaxed);
}

static void keep_host_environment(entry_state *state, float_environment host) {
    atomic_store_explicit(&state->host, host, memory_order_relaxed);
}

bool context_enter(cscd_context *context, context_entry *entry) {
    *entry = (context_entry){context, CSCD_BUSY};
    if (!claim_context(context)) return false;
    entry->status = CSCD_OK;
    keep_host_environment(&context->entry, float_environment_begin());
    check_objects(context);
    context->detail[0] = '\0'; /* of an earlier call */
    progress_begin_call(&context->progress);
    parallel_begin_call(context->threads);
    return true;
}

/* True: nobody is inside any more. False: there are objects to be freed. */
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
    reference_count *object = (reference_count *)(atomic_exchange(&state->mark, MARK_INSIDE) & ~MARK_INSIDE);
    while (object != NULL) {
        reference_count *next = object->next;
        free_object(object);
        object = next;
    }
}

/* The last object may take the context with it. */
static void leave_claim(cscd_context *context) {
    entry_state *state = &context->entry;
    if (take_mark_away(state)) return;
    context_hold(context);
    do {
        free_listed(state);
    } while (!take_mark_away(state));
    context_release(context);
}

cscd_status context_leave(context_entry *entry, cscd_status status) {
    cscd_context *context = entry->context;
    if (status == CSCD_OK || status == CSCD_IN_CONTACT) {
        cscd_status loop = context_loop_status(context);
        if (loop != CSCD_OK) status = loop;
    }
    float_environment_set(host_environment(&context->entry));
    leave_claim(context);
    return status;
}

/* ---- freeing objects ----------------------------------------------------------------------------------- */

/* False: nobody is inside any more. */
static bool leave_to_call_inside(entry_state *state, reference_count *object) {
    uintptr_t mark = atomic_load(&state->mark);
    do {
        if (mark == 0) return false;
        object->next = (reference_count *)(mark & ~MARK_INSIDE);
    } while (!atomic_compare_exchange_weak(&state->mark, &mark, (uintptr_t)object | MARK_INSIDE));
    return true;
}

static void free_claimed(cscd_context *context, reference_count *object) {
    context_hold(context);
    keep_host_environment(&context->entry, float_environment_get());
    free_object(object);
    leave_claim(context);
    context_release(context);
}

void context_free_object(cscd_context *context, reference_count *object) {
    entry_state *state = &context->entry;
    /* In a child that fork made a call that was inside never ends, and another thread may have held the lock of the list. */
    if (parallel_is_of_parent(context->threads) && atomic_load(&state->mark) != 0) return;
    live_objects_remove(&context->live, object);
    while (!claim_context(context)) {
        if (leave_to_call_inside(state, object)) return;
    }
    free_claimed(context, object);
}

/* ---- calling the host ---------------------------------------------------------------------------------- */

host_call host_call_begin(entry_state *state) {
    host_call call = {.state = NULL};
    if (state == NULL || atomic_load_explicit(&state->mark, memory_order_relaxed) == 0) return call;
    call.state = state;
    bool own = atomic_load_explicit(&state->thread, memory_order_relaxed) == this_thread();
    call.first = own && !state->in_callback;
    if (call.first) state->in_callback = true;
    call.inside = float_environment_get();
    float_environment_set(host_environment(state));
    return call;
}

void host_call_end(const host_call *call) {
    entry_state *state = call->state;
    if (state == NULL) return;
    if (call->first) {
        keep_host_environment(state, float_environment_get());
        state->in_callback = false;
    }
    float_environment_set(call->inside);
}
