/* Whether JSON of strangers may be parsed: what it becomes in memory is bounded by its size. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* False: the text has more than an object in ten bytes, beside a thousand, which no program writes. Parsed, each takes a thousand
 * bytes, so that text of nothing but braces would become 350 times as large; what is left becomes 100 times as large at most. */
bool json_has_room(const char *text, size_t size);
