/* An allocator for a context that counts how often it is asked for memory. */
#pragma once

#include "cscd/cscd.h"

/* Returns an allocator that counts on from *count, which outlives the context. */
cscd_allocator allocation_count_interface(uint64_t *count);
