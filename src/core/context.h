/* The context that all objects share: memory, threads, progress, and the sentence that explains the last
 * failure. */
#pragma once

#include "src/core/entry.h"
#include "src/core/memory.h"
#include "src/core/parallel.h"
#include "src/core/progress.h"

/* A context lives, with its allocator and threads, until the caller has destroyed it and the last object that was
 * made from it is gone. */
struct cscd_context {
    reference_count handle;     /* the caller's, an object of the context like others */
    reference_count references; /* the objects */
    entry_state entry;
    host_memory memory;
    parallel *threads;
    progress progress;
    live_objects live;
    cscd_simd simd; /* never AUTO */
    char detail[512];
};

void context_hold(cscd_context *context);
void context_release(cscd_context *context);

/* Begins the references of a new object, which holds the context. free lets go of it last, because the memory of the
 * context goes with it, and before that of all that the object holds by now. */
void context_add_object(cscd_context *context, reference_count *object,
                        void (*free)(reference_count *object));

/* The object is whole; from now on debug builds check it at every call. See live_objects_add. */
void context_list_object(cscd_context *context, reference_count *object,
                         const char *(*validate)(const reference_count *object));

/* One who holds the object lets go; or its owner does, in its _destroy function. */
void context_drop_object(cscd_context *context, reference_count *object);
void context_destroy_object(cscd_context *context, reference_count *object);

/* These pass on to the functions of memory.h. */

static inline void *context_allocate(cscd_context *context, size_t count, size_t size) {
    return memory_allocate(&context->memory, count, size);
}

static inline void *context_reserve(cscd_context *context, size_t count, size_t size) {
    return memory_reserve(&context->memory, count, size);
}

static inline void *context_grow(cscd_context *context, void *block, size_t old_count, size_t new_count,
                                 size_t size) {
    return memory_grow(&context->memory, block, old_count, new_count, size);
}

static inline void context_free(cscd_context *context, void *block) {
    memory_free(&context->memory, block);
}

static inline bool context_allocate_all(cscd_context *context, array_list list) {
    return memory_allocate_all(&context->memory, list);
}

static inline bool context_reserve_all(cscd_context *context, array_list list) {
    return memory_reserve_all(&context->memory, list);
}

static inline bool context_copy_all(cscd_context *context, array_list list) {
    return memory_copy_all(&context->memory, list);
}

static inline void context_free_all(cscd_context *context, array_list list) {
    memory_free_all(&context->memory, list);
}

/* A list with this number of items is long: it has little room to spare, and is not kept twice. */
enum { LONG_LIST = 1 << 18 };

/* The items to allocate where count are needed now and perhaps more in later calls: never 0. */
static inline size_t room_with_spare(size_t count) {
    if (count < LONG_LIST) return 2 * count + 16;
    return count < SIZE_MAX - count / 16 ? count + count / 16 : SIZE_MAX;
}

/* Makes sure that the arrays of a list have room for count items. The list is one of room_with_spare(count)
 * items. If there is no array yet, or *capacity is less than count, new arrays replace the old ones and their
 * contents. False: no memory, and *capacity is 0. */
bool context_renew_all(cscd_context *context, array_list list, size_t *capacity, size_t count);

/* Sets the detail and returns status, so that a function can end with it. */
cscd_status context_fail(cscd_context *context, cscd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Fails a call of the API that needs an object and was given NULL, before it has entered the context. context: NULL if there is
 * none that could keep the sentence. */
cscd_status context_lacks(cscd_context *context, const char *function, const char *object);

/* Sets the sentence of a failed allocation, and returns CSCD_OUT_OF_MEMORY. */
cscd_status context_out_of_memory(cscd_context *context);

/* Returns CSCD_OK, or with its sentence CSCD_CANCELLED, or INVALID_ARGUMENT if the host's loop has not run every task
 * once. Results of tasks count only after this has returned CSCD_OK. */
cscd_status context_progress_status(cscd_context *context);

/* Returns CSCD_OK, or INVALID_ARGUMENT if the host's loop has not run every task once in this call. */
cscd_status context_loop_status(cscd_context *context);

/* Sets the sentence of a status that has none yet, CSCD_CANCELLED or a failed allocation, and returns
 * the status. */
cscd_status context_explain(cscd_context *context, cscd_status status);

/* ---- options and other structs that callers fill ------------------------------------------------------- */

/* They are as large as the caller's header says, which may be older or newer
 * than the library. */

/* Writes as much of the default options as the caller's struct holds, and 0 to members that the library does not know. The first
 * member, a uint32_t, becomes the caller's size. */
void struct_give_options(void *out, size_t out_size, const void *from, size_t size);

/* Overwrites the beginning of `into`, which holds the defaults, with the caller's struct. least_size: the
 * struct's LEAST_SIZE. INVALID_ARGUMENT: the caller's struct is smaller than that, or has members that this
 * library does not know and that are not 0; the sentence calls the struct `name`. The known members have been
 * copied then. */
cscd_status struct_take(cscd_context *context, void *into, size_t size, size_t least_size, const void *from,
                        size_t from_size, const char *name);

/* The same for options, whose size is their first member, a uint32_t. maker: the name of their _defaults() function. */
cscd_status struct_take_options(cscd_context *context, void *into, size_t size, size_t least_size,
                                const void *from, const char *maker);
