/* How many hold an object: the caller who made it, and every object that was made from it. The last one to let
 * go frees it, on whatever thread that happens. */
#pragma once

#include <assert.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define REFERENCE_ALIVE 0x600DC0DEu

/* The first member of an object. */
typedef struct reference_count {
    atomic_uint holders;
    atomic_bool destroyed;        /* the caller has let go, which it may do once */
    struct reference_count *next; /* in a list of objects that are to be freed */
    void (*free)(struct reference_count *object);
    const char *(*validate)(const struct reference_count *object); /* see live_objects.h; NULL: not listed */
    struct reference_count *older, *younger;                       /* in the list of live objects */
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
