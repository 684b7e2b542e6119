/* An allocator for a context that counts how often it is asked for memory. */
#ifndef CSCD_MODELS_ALLOCATION_COUNT_H
#define CSCD_MODELS_ALLOCATION_COUNT_H

#include "cscd/cscd.h"

/* Counts on from what *count is; it outlives the context. */
cscd_allocator allocation_count_interface(uint64_t *count);

#endif
