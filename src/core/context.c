/* What every object shares: the allocator, the threads, progress, the sentence behind the last failure. */
#include "src/core/context.h"

#include "src/core/processor.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_ALIGNMENT = 64, THREAD_COUNT_MAX = 256 };

/* Precedes each block and fills one alignment unit, so that the block itself is aligned. */
typedef struct block_header {
    size_t size; /* of the whole, header included */
} block_header;

static void *system_allocate(void *user, size_t size, size_t alignment) {
    (void)user;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void system_release(void *user, void *block, size_t size) {
    (void)user;
    (void)size;
    free(block);
}

cscd_context_options cscd_context_defaults(void) {
    cscd_context_options options = {.struct_size = sizeof options,
                                    .thread_count = 1,
                                    .allocator = {system_allocate, system_release, NULL}};
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
        chosen.allocator.allocate(chosen.allocator.user, sizeof *context, BLOCK_ALIGNMENT);
    if (context == NULL) return CSCD_OUT_OF_MEMORY;
    memset(context, 0, sizeof *context);
    context->allocator = chosen.allocator;
    context->bytes = sizeof *context;
    context->progress = progress_of(chosen.progress);
    context->simd = chosen.simd != CSCD_SIMD_AUTO ? chosen.simd : processor_best_simd();
    if (pthread_mutex_init(&context->allocator_lock, NULL) != 0) {
        chosen.allocator.release(chosen.allocator.user, context, sizeof *context);
        return CSCD_SYSTEM_ERROR;
    }
    cscd_status status =
        parallel_create(context, chosen.thread_count, chosen.parallel_for, &context->threads);
    if (status != CSCD_OK) {
        cscd_context_destroy(context);
        return status;
    }
    *out = context;
    return CSCD_OK;
}

void cscd_context_destroy(cscd_context *context) {
    if (context == NULL) return;
    parallel_destroy(context, context->threads);
    pthread_mutex_destroy(&context->allocator_lock);
    cscd_allocator allocator = context->allocator;
    allocator.release(allocator.user, context, sizeof *context);
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
    return context->bytes;
}

void *context_allocate(cscd_context *context, size_t count, size_t size) {
    if (size != 0 && count > (SIZE_MAX / 2 - BLOCK_ALIGNMENT) / size) return NULL;
    size_t whole = count * size + BLOCK_ALIGNMENT;
    pthread_mutex_lock(&context->allocator_lock);
    char *memory = context->allocator.allocate(context->allocator.user, whole, BLOCK_ALIGNMENT);
    if (memory != NULL) context->bytes += whole;
    pthread_mutex_unlock(&context->allocator_lock);
    if (memory == NULL) return NULL;
    memset(memory, 0, whole);
    ((block_header *)memory)->size = whole;
    return memory + BLOCK_ALIGNMENT;
}

void *context_grow(cscd_context *context, void *block, size_t old_count, size_t new_count, size_t size) {
    void *grown = context_allocate(context, new_count, size);
    if (grown == NULL) return NULL;
    if (block != NULL) memcpy(grown, block, old_count * size);
    context_free(context, block);
    return grown;
}

void context_free(cscd_context *context, void *block) {
    if (block == NULL) return;
    char *memory = (char *)block - BLOCK_ALIGNMENT;
    size_t whole = ((block_header *)memory)->size;
    pthread_mutex_lock(&context->allocator_lock);
    context->bytes -= whole;
    context->allocator.release(context->allocator.user, memory, whole);
    pthread_mutex_unlock(&context->allocator_lock);
}

/* Pointers of different types are written as bytes. */
static void set_pointer(void *pointer, void *value) {
    memcpy(pointer, &value, sizeof value);
}

void context_free_all(cscd_context *context, array_list list) {
    for (const array_block *block = list.blocks; block->pointer != NULL; block++) {
        void *memory;
        memcpy(&memory, block->pointer, sizeof memory);
        context_free(context, memory);
        set_pointer(block->pointer, NULL);
    }
}

bool context_allocate_all(cscd_context *context, array_list list) {
    for (const array_block *block = list.blocks; block->pointer != NULL; block++)
        set_pointer(block->pointer, NULL);
    for (const array_block *block = list.blocks; block->pointer != NULL; block++) {
        if (block->size == 0) continue;
        void *memory = context_allocate(context, block->count, block->size);
        if (memory == NULL) {
            context_free_all(context, list);
            return false;
        }
        set_pointer(block->pointer, memory);
    }
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
                        "out of memory with %zu bytes in use; nothing was changed", context->bytes);
}

cscd_status context_explain(cscd_context *context, cscd_status status) {
    return status == CSCD_CANCELLED ? progress_status(context) : context_out_of_memory(context);
}
