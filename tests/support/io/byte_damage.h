/* Random damage to the bytes of a file. */
#pragma once

#include "tests/support/random_stream.h"

#include <stddef.h>

/* How many bytes one fault may add. */
enum { DAMAGE_GROWTH_MAX = 64 };

/* Does one more fault to bytes, which have room for DAMAGE_GROWTH_MAX more, and returns their new size, never 0: a bit flipped, another
 * byte, a byte doubled or dropped, the end cut off, a piece copied over another, or a number that becomes an extreme one. size is not
 * 0. */
size_t damage_bytes(random_stream *random, unsigned char *bytes, size_t size);
