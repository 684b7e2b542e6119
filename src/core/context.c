/* What all objects share: memory, threads, progress, and the sentence that explains the last failure. */
#include "src/core/context.h"

#include "src/core/processor.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { THREAD_COUNT_MAX = 256 };

cscd_context_options cscd_context_defaults(void) {
    cscd_context_options options = {
        .struct_size = sizeof options, .thread_count = 1, .allocator = memory_system_allocator()};
    return options;
}

static bool options_valid(const cscd_context_options *options) {
    bool both = (options->allocator.allocate == NULL) == (options->allocator.release == NULL);
    return options->struct_size == sizeof *options && both && options->thread_count <= THREAD_COUNT_MAX &&
           (unsigned)options->simd <= processor_best_simd();
}

cscd_status cscd_context_create(const cscd_context_options *options, cscd_context **out) {
    cscd_context_options chosen = options != NULL ? *options : cscd_context_defaults();
    if (out == NULL || !options_valid(&chosen)) return CSCD_INVALID_ARGUMENT;
    if (chosen.allocator.allocate == NULL) chosen.allocator = cscd_context_defaults().allocator;

    cscd_context *context =
        chosen.allocator.allocate(chosen.allocator.user, sizeof *context, MEMORY_ALIGNMENT);
    if (context == NULL) return CSCD_OUT_OF_MEMORY;
    memset(context, 0, sizeof *context);
    reference_begin(&context->references);
    context->progress = progress_of(chosen.progress);
    context->simd = chosen.simd != CSCD_SIMD_AUTO ? chosen.simd : processor_best_simd();
    if (!memory_begin(&context->memory, chosen.allocator)) {
        chosen.allocator.release(chosen.allocator.user, context, sizeof *context);
        return CSCD_SYSTEM_ERROR;
    }
    context->memory.bytes = sizeof *context;
    cscd_status status =
        parallel_create(&context->memory, chosen.thread_count, chosen.parallel_for, &context->threads);
    if (status != CSCD_OK) {
        cscd_context_destroy(context);
        return status;
    }
    *out = context;
    return CSCD_OK;
}

static void free_context(cscd_context *context) {
    parallel_destroy(&context->memory, context->threads);
    memory_end(&context->memory);
    cscd_allocator allocator = context->memory.allocator;
    allocator.release(allocator.user, context, sizeof *context);
}

void context_hold(cscd_context *context) {
    reference_add(&context->references);
}

void context_release(cscd_context *context) {
    if (reference_drop(&context->references)) free_context(context);
}

void cscd_context_destroy(cscd_context *context) {
    if (context != NULL && reference_destroy(&context->references)) free_context(context);
}

const char *cscd_context_detail(const cscd_context *context) {
    return context != NULL ? context->detail : "";
}

uint32_t cscd_context_thread_count(const cscd_context *context) {
    return parallel_thread_count(context->threads);
}

cscd_simd cscd_context_simd(const cscd_context *context) {
    return context->simd;
}

size_t cscd_context_bytes(const cscd_context *context) {
    return atomic_load_explicit(&context->memory.bytes, memory_order_relaxed);
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
                        cscd_context_bytes(context));
}

cscd_status context_progress_status(cscd_context *context) {
    const progress *p = &context->progress;
    if (!progress_cancelled(p)) return CSCD_OK;
    return context_fail(context, CSCD_CANCELLED,
                        "cancelled by the progress function, about %.0f %% through, in the stage \"%s\"; "
                        "the call may be repeated",
                        100.0 * p->reported, p->stage);
}

cscd_status context_explain(cscd_context *context, cscd_status status) {
    return status == CSCD_CANCELLED ? context_progress_status(context) : context_out_of_memory(context);
}
