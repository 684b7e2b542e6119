/* Options and other structs that callers fill are as large as the caller's header says, which may be older or newer
 * than the library. */
#pragma once

#include "src/core/context.h"
#include "src/core/least_sizes.h"

/* Writes as much of the default options as the caller's struct holds, and 0 to members that the library does not know. The first
 * member, a uint32_t, becomes the caller's size. */
void struct_give_options(void *out, size_t out_size, const void *from, size_t size);

/* Overwrites the beginning of `into`, which holds the defaults, with the caller's struct. least_size: the struct's
 * LEAST_SIZE. INVALID_ARGUMENT: the caller's struct is smaller than that, or has members that this library does not know and that
 * are not 0; the sentence calls the struct `name`. What is known has been copied then. */
cscd_status struct_take(cscd_context *context, void *into, size_t size, size_t least_size, const void *from,
                        size_t from_size, const char *name);

/* The same for options, whose size is their first member, a uint32_t. maker: the name of their _defaults() function. */
cscd_status struct_take_options(cscd_context *context, void *into, size_t size, size_t least_size,
                                const void *from, const char *maker);
