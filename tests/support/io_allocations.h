/* Allocations of the readers and writers that fail when a test wants it. The linker puts this in place of their io_realloc (--wrap). */
#pragma once

#include <stdbool.h>

extern long io_allocations_left;  /* so many succeed before one fails; negative: none fails */
extern bool io_allocation_failed; /* one did, since a test has cleared it */

/* for (long place = 0; io_allocations_go_on(place); place++): the first allocation fails in the first round, the second one in the
 * second, and so on, until a round had none to fail. */
bool io_allocations_go_on(long place);
