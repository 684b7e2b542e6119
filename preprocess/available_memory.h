/* How much memory the system would give us now. */
#pragma once

#include <stddef.h>

/* Bytes of physical memory that are free or can be freed without swapping, within the limit of the control
 * group (container) that the system shows; SIZE_MAX where the system does not tell. */
size_t available_memory(void);
