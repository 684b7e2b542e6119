/* What every object shares: the allocator, the threads, progress, the sentence behind the last failure. */
#pragma once

#include "cscd/cscd.h"
#include "src/core/parallel.h"
#include "src/core/progress.h"

#include <pthread.h>

struct cscd_context {
    cscd_allocator allocator;
    pthread_mutex_t allocator_lock;
    size_t bytes;
    parallel *threads;
    progress progress;
    cscd_simd simd; /* never AUTO */
    char detail[512];
};

/* Zeroed memory for count elements of size bytes, 64-byte aligned; NULL when count * size overflows or the
 * allocator refuses. count 0 gives a block too. Any thread may call it. */
void *context_allocate(cscd_context *context, size_t count, size_t size);

/* A block of new_count elements that begins with the first old_count of block; block is then freed, or,
 * when NULL is returned, still valid. */
void *context_grow(cscd_context *context, void *block, size_t old_count, size_t new_count, size_t size);

/* NULL does nothing. */
void context_free(cscd_context *context, void *block);

/* Sets the detail and returns status, so that a function can end with it. */
cscd_status context_fail(cscd_context *context, cscd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The same words for every allocation that failed. */
cscd_status context_out_of_memory(cscd_context *context);

/* For functions below which nobody wrote a sentence: status is CANCELLED, or an allocation failed. */
cscd_status context_explain(cscd_context *context, cscd_status status);
