/* What all objects share: memory, threads, progress, and the sentence that explains the last failure. */
#include "src/core/context.h"

#include "src/core/processor.h"
#include "src/core/struct_size.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { THREAD_COUNT_MAX = 256 };

static cscd_context_options default_options(void) {
    return (cscd_context_options){.thread_count = 1, .allocator = memory_system_allocator()};
}

void cscd_context_defaults_sized(cscd_context_options *out, size_t size) {
    cscd_context_options options = default_options();
    struct_give_options(out, size, &options, sizeof options);
}

/* Explains in `context`, which only has a place for the sentence. */
static cscd_status check_options(cscd_context *context, const cscd_context_options *options) {
    if ((options->allocator.allocate == NULL) != (options->allocator.release == NULL))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "allocator has only one of allocate and release: set both, or neither");
    if (options->thread_count > THREAD_COUNT_MAX)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "thread_count is %u, expected at most %d",
                            options->thread_count, THREAD_COUNT_MAX);
    if ((unsigned)options->simd > CSCD_SIMD_AVX512)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown simd %d", (int)options->simd);
    if (options->simd > processor_best_simd())
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "simd is %s, but the best that this processor has is %s: use CSCD_SIMD_AUTO",
                            cscd_simd_name(options->simd), cscd_simd_name(processor_best_simd()));
    return CSCD_OK;
}

static cscd_status create_parts(cscd_context *context, const cscd_context_options *options) {
    context->progress = progress_of(options->progress);
    context->simd = options->simd != CSCD_SIMD_AUTO ? options->simd : processor_best_simd();
    if (!memory_begin(&context->memory, options->allocator))
        return context_fail(context, CSCD_SYSTEM_ERROR, "the system refused a mutex");
    context->memory.bytes = sizeof *context;
    cscd_status status =
        parallel_create(&context->memory, options->thread_count, options->parallel_for, &context->threads);
    if (status == CSCD_OK) return CSCD_OK;
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
    reference_begin(&context->references);
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
        status = struct_take_options(&explained, &chosen, sizeof chosen, sizeof chosen, options,
                                     "cscd_context_defaults");
    if (status == CSCD_OK && out == NULL)
        status = context_fail(&explained, CSCD_INVALID_ARGUMENT, "cscd_context_create: out is NULL");
    if (status == CSCD_OK) status = check_options(&explained, &chosen);
    if (chosen.allocator.allocate == NULL) chosen.allocator = memory_system_allocator();
    if (status == CSCD_OK) status = create_context(&chosen, &explained, out);
    if (status != CSCD_OK && chosen.reason != NULL && chosen.reason_size > 0)
        snprintf(chosen.reason, chosen.reason_size, "%s", explained.detail);
    return status;
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
