/* The context that all objects share: memory, threads, progress, and the sentence that explains the last
 * failure. */
#include "src/core/context.h"

#include "src/core/least_sizes.h"
#include "src/core/system.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { THREAD_COUNT_MAX = 256 };

static cscd_context_options default_options(void) {
    return (cscd_context_options){.thread_count = 1};
}

void cscd_context_defaults_sized(cscd_context_options *out, size_t size) {
    cscd_context_options options = default_options();
    struct_give_options(out, size, &options, sizeof options);
}

static void free_context(reference_count *references) {
    cscd_context *context = (cscd_context *)((char *)references - offsetof(cscd_context, references));
    parallel_destroy(&context->memory, context->threads);
    memory_end(&context->memory);
    live_objects_end(&context->live);
    cscd_allocator allocator = context->memory.allocator;
    allocator.release(allocator.user, context, sizeof *context);
}

static void free_handle(reference_count *handle) {
    context_release((cscd_context *)handle);
}

/* Explains in `context`, which only has a place for the sentence. */
static cscd_status check_options(cscd_context *context, const cscd_context_options *options) {
    if ((options->allocator.allocate == NULL) != (options->allocator.release == NULL))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "allocator has only one of allocate and release: set both, or neither");
    if (options->thread_count > THREAD_COUNT_MAX)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "thread_count is %u, expected at most %d",
                            options->thread_count, THREAD_COUNT_MAX);
    if ((unsigned)options->simd > SIMD_LAST)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown simd %d", (int)options->simd);
    if (options->simd != CSCD_SIMD_AUTO && !processor_has_simd(options->simd))
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "simd is %s, which this processor has not; the best that it has is %s: use CSCD_SIMD_AUTO",
            cscd_name(CSCD_SIMDS, options->simd), cscd_name(CSCD_SIMDS, processor_best_simd()));
    return CSCD_OK;
}

static cscd_status create_parts(cscd_context *context, const cscd_context_options *options) {
    context->progress = progress_of(options->progress, &context->entry);
    context->simd = options->simd != CSCD_SIMD_AUTO ? options->simd : processor_best_simd();
    if (!memory_begin(&context->memory, options->allocator, &context->entry))
        return context_fail(context, CSCD_SYSTEM_ERROR, "the system refused a mutex");
    if (!live_objects_begin(&context->live)) {
        memory_end(&context->memory);
        return context_fail(context, CSCD_SYSTEM_ERROR, "the system refused a mutex");
    }
    context->memory.bytes = sizeof *context;
    cscd_status status =
        parallel_create(&context->memory, options->thread_count, options->parallel_for, &context->threads);
    if (status == CSCD_OK) return CSCD_OK;
    live_objects_end(&context->live);
    memory_end(&context->memory);
    return context_fail(context, status, "%s for %u threads",
                        status == CSCD_OUT_OF_MEMORY ? "out of memory" : "the system refused threads",
                        options->thread_count);
}

/* explained: a place for the sentence of a failure. */
static cscd_status create_context(const cscd_context_options *options, cscd_context *explained,
                                  cscd_context **out) {
    cscd_allocator allocator = options->allocator;
    cscd_context *context = allocator.allocate(allocator.user, sizeof *context, MEMORY_ALIGNMENT);
    if (context == NULL)
        return context_fail(explained, CSCD_OUT_OF_MEMORY, "out of memory: the allocator refused %zu bytes",
                            sizeof *context);
    memset(context, 0, sizeof *context);
    reference_begin(&context->references, free_context);
    reference_begin(&context->handle, free_handle);
    cscd_status status = create_parts(context, options);
    if (status == CSCD_OK) {
        *out = context;
        return CSCD_OK;
    }
    memcpy(explained->detail, context->detail, sizeof context->detail);
    allocator.release(allocator.user, context, sizeof *context);
    return status;
}

cscd_status cscd_context_create(const cscd_context_options *options, cscd_context **out) {
    cscd_context explained = {.detail = ""};
    cscd_context_options chosen = default_options();
    cscd_status status = CSCD_OK;
    if (options != NULL)
        status = struct_take_options(&explained, &chosen, sizeof chosen, LEAST_SIZE(cscd_context_options),
                                     options, "cscd_context_defaults");
    if (status == CSCD_OK && out == NULL)
        status = context_fail(&explained, CSCD_INVALID_ARGUMENT, "cscd_context_create: out is NULL");
    if (status == CSCD_OK) status = check_options(&explained, &chosen);
    if (chosen.allocator.allocate == NULL) chosen.allocator = memory_system_allocator();
    if (status == CSCD_OK) status = create_context(&chosen, &explained, out);
    bool refused =
        status != CSCD_OK && options != NULL && options->struct_size >= LEAST_SIZE(cscd_context_options);
    if (refused && options->reason != NULL && options->reason_size > 0)
        snprintf(options->reason, options->reason_size, "%s", explained.detail);
    return status;
}

void context_hold(cscd_context *context) {
    reference_add(&context->references);
}

void context_release(cscd_context *context) {
    if (reference_drop(&context->references)) context->references.free(&context->references);
}

void cscd_context_destroy(cscd_context *context) {
    if (context != NULL) context_destroy_object(context, &context->handle);
}

/* ---- objects of the context ---------------------------------------------------------------------------- */

void context_add_object(cscd_context *context, reference_count *object, void (*free)(reference_count *)) {
    reference_begin(object, free);
    context_hold(context);
}

void context_list_object(cscd_context *context, reference_count *object,
                         const char *(*validate)(const reference_count *object)) {
    live_objects_add(&context->live, object, validate);
}

void context_drop_object(cscd_context *context, reference_count *object) {
    if (reference_drop(object)) context_free_object(context, object);
}

void context_destroy_object(cscd_context *context, reference_count *object) {
    if (reference_destroy(object)) context_free_object(context, object);
}

const char *cscd_context_detail(const cscd_context *context) {
    return context != NULL ? context->detail : "";
}

void cscd_context_cancel(cscd_context *context) {
    if (context != NULL) progress_cancel(&context->progress);
}

cscd_context_info cscd_context_describe(const cscd_context *context) {
    return (cscd_context_info){.thread_count = parallel_thread_count(context->threads),
                               .simd = context->simd,
                               .bytes = memory_bytes(&context->memory)};
}

size_t cscd_context_memory_share(const cscd_context *context) {
    (void)context;
    return memory_share();
}

bool context_renew_all(cscd_context *context, array_list list, size_t *capacity, size_t count) {
    if (*capacity > 0 && count <= *capacity) return true;
    context_free_all(context, list);
    *capacity = 0;
    if (!context_allocate_all(context, list)) return false;
    *capacity = room_with_spare(count);
    return true;
}

cscd_status context_fail(cscd_context *context, cscd_status status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(context->detail, sizeof context->detail, format, arguments);
    va_end(arguments);
    return status;
}

cscd_status context_out_of_memory(cscd_context *context) {
    return context_fail(context, CSCD_OUT_OF_MEMORY,
                        "out of memory with %zu bytes in use; nothing was changed",
                        memory_bytes(&context->memory));
}

cscd_status context_loop_status(cscd_context *context) {
    loop_faults f = parallel_faults(context->threads);
    if (f.left_out == 0 && f.repeated == 0 && f.unfinished == 0) return CSCD_OK;
    return context_fail(
        context, CSCD_INVALID_ARGUMENT,
        "of %llu tasks, parallel_for left out %u, ran %u again, and returned before %u had ended; "
        "it must run every task once, so the call has failed",
        (unsigned long long)f.tasks, f.left_out, f.repeated, f.unfinished);
}

cscd_status context_lacks(cscd_context *context, const char *function, const char *object) {
    context_entry entry;
    if (context == NULL) return CSCD_NULL_OBJECT;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, context_fail(context, CSCD_NULL_OBJECT, "%s: %s is NULL", function, object));
}

cscd_status context_progress_status(cscd_context *context) {
    const progress *p = &context->progress;
    if (!progress_cancelled(p)) return context_loop_status(context);
    if (!p->by_report)
        return context_fail(context, CSCD_CANCELLED,
                            "cancelled by cscd_context_cancel; the call may be repeated");
    const bool named = p->stage[0] != '\0';
    return context_fail(
        context, CSCD_CANCELLED,
        "cancelled by the progress function, about %.0f %% through%s%s%s; the call may be repeated",
        100.0 * p->reported, named ? ", in the stage \"" : "", p->stage, named ? "\"" : "");
}

cscd_status context_explain(cscd_context *context, cscd_status status) {
    if (status == CSCD_OUT_OF_MEMORY) return context_out_of_memory(context);
    return status == CSCD_CANCELLED ? context_progress_status(context) : status;
}

/* ---- options and other structs that callers fill ------------------------------------------------------- */

static size_t smaller_of(size_t a, size_t b) {
    return a < b ? a : b;
}

void struct_give_options(void *out, size_t out_size, const void *from, size_t size) {
    const uint32_t own_size = (uint32_t)out_size;
    const size_t known = smaller_of(out_size, size);
    memcpy(out, from, known);
    memset((char *)out + known, 0, out_size - known);
    memcpy(out, &own_size, sizeof own_size);
}

cscd_status struct_take(cscd_context *context, void *into, size_t size, size_t least_size, const void *from,
                        size_t from_size, const char *name) {
    if (from_size < least_size)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%s: its size is %zu, expected at least %zu",
                            name, from_size, least_size);
    memcpy(into, from, smaller_of(from_size, size));
    const char *bytes = from;
    for (size_t i = size; i < from_size; i++) {
        if (bytes[i] == 0) continue;
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "%s: the member at byte %zu is not 0, and this library, version %s, does not know it: "
            "set it to 0, or use a newer library",
            name, i, cscd_version_string());
    }
    return CSCD_OK;
}

cscd_status struct_take_options(cscd_context *context, void *into, size_t size, size_t least_size,
                                const void *from, const char *maker) {
    uint32_t from_size;
    memcpy(&from_size, from, sizeof from_size);
    if (from_size < least_size)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "the options were not made by %s: struct_size is %u, expected at least %zu",
                            maker, from_size, least_size);
    return struct_take(context, into, size, least_size, from, from_size, maker);
}
